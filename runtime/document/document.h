// The Document: base maps, operators, journal. The only way to change it is `apply`; everybody else reads.
//
// Invariants (but for the time, which is a way of looking, not a change)
//  1. A command is one transaction of terrain.db: after a crash every command whose `apply` returned is
//  there, and
//     nothing half-done.
//  2. `undo` then `redo` (and the other way) restore pages, operators and journal bit for bit.
//  3. A mip-m sample of a base map equals the mip-0 sample at the same place.
//  4. Reads may come from any thread; `apply`, `undo`, `redo` and `BulkWriter` from one thread at a time. A
//  reader sees the
//     state before or after a command, never between (hold a ReadLock over several reads that must agree).
//     While a command is made visible readers wait; hold a ReadLock for milliseconds, not for a frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <shared_mutex>
#include <span>
#include <vector>

#include "runtime/base/rect.h"
#include "runtime/base/result.h"
#include "runtime/document/command.h"
#include "runtime/document/operator.h"
#include "runtime/store/project.h"

namespace loam {

// World rectangles that a change touched, per map: at most 64, 8 for a stroke, possibly overlapping.
// Everything that interpolates base samples as described here and lies outside of them is as before.
//  - height: the changed samples grown by 2 base spacings, as the height map interpolates bicubically (4x4
//  samples).
//  - index: the changed texels grown by 1 spacing (nearest or bilinear).
//  - where a changed sample lies on the map's edge the rectangle goes on 65,536 m outwards, as all reads
//  beyond the edge give
//    the nearest sample inside.
//  - operators: their bounds in the map (operator.h), exactly.
// `texture` holds what is drawn into the texture only (decals), the widest of which is texture_size_m across
// (Operator::texture_size_m); what follows from index or height is derived by the layers that read them.
struct Dirt {
    std::vector<WorldRect> height, index, texture;
    std::vector<WorldRect> cutout;  // volumes also follow heights: not in here
    double texture_size_m = 0;
    bool layers = false;  // the layer list is another one: all that shows layers (Renderer::settings_changed)
    [[nodiscard]] bool empty() const {
        return height.empty() && index.empty() && texture.empty() && cutout.empty() && !layers;
    }
};

enum class OpenMode { read_write, read_only };

class FunctionLibrary;

class Document {
  public:
    static Result<std::unique_ptr<Document>> create(const std::filesystem::path& folder,
                                                    const ProjectSettings& settings);
    static Result<std::unique_ptr<Document>> open(const std::filesystem::path& folder,
                                                  OpenMode mode = OpenMode::read_write);
    ~Document();
    Document(const Document&) = delete;

    [[nodiscard]] const std::filesystem::path& folder() const;
    [[nodiscard]] const ProjectSettings& settings() const;
    [[nodiscard]] WorldRect bounds() const { return settings().bounds(); }
    [[nodiscard]] uint64_t revision() const;  // grows with every change
    // Operators with a life and events are shown as they are at this time; TimeCommand moves it. In seconds,
    // kept with the project.
    [[nodiscard]] double time_s() const;

    // Undo and redo commands are applied by `apply` as well.
    Result<Dirt> apply(const Command& command);
    Result<Dirt> undo();  // error "nothing to undo" when there is nothing
    Result<Dirt> redo();
    [[nodiscard]] bool can_undo() const;
    [[nodiscard]] bool can_redo() const;
    struct HistoryEntry {
        uint64_t sequence = 0, group = 0;
        bool applied = true;
        std::string json;  // the command
    };
    [[nodiscard]] Result<std::vector<HistoryEntry>> history(int newest_count) const;  // newest first
    [[nodiscard]] uint64_t next_group();  // a fresh group number for a stroke

    // Settings that may change later (sun, haze, layer list): writes project.toml.
    Status change_settings(const ProjectSettings& settings);
    [[nodiscard]] Status check_writable() const;
    // Shows texts of decals' functions that another program has saved meanwhile; call it now and then.
    Dirt poll_functions();

    // --- reads ---
    using ReadLock = std::shared_lock<std::shared_mutex>;
    [[nodiscard]] ReadLock read_lock() const;
    // Base samples of a mip, coordinates in that mip's samples; outside the map the nearest sample inside.
    // The caller holds a ReadLock.
    void read_heights_mm(int mip, int x0, int y0, int width, int height, int32_t* out) const;
    void read_index(int mip, int x0, int y0, int width, int height, IndexTexel* out) const;
    // Of the imagery's grid (imagery.h); without imagery no texel has cover. The caller holds a ReadLock.
    void read_imagery(int level, int x0, int y0, int width, int height, uint32_t* rgba) const;
    [[nodiscard]] int height_mip_count() const;  // down to one page
    [[nodiscard]] int index_mip_count() const;
    // Of mip 0. Texel (i, j) stands at world (i, j) * index_spacing_m, as height samples do; the last ones at
    // or beyond bounds().
    [[nodiscard]] glm::ivec2 index_size_texels() const;
    [[nodiscard]] TexelRect fill_texels(const FillCommand& command) const;  // that it looks at
    // Enabled operators whose bounds in the map overlap, in order of evaluation. Valid while the ReadLock is
    // held. Most are read when first asked for (operator_nodes.h): what cannot be read is left out, and the
    // log and `verify` say so.
    // Those that a grid with samples at multiples of this step sees, or more; 0: all. It is
    // finest_height_spacing or the index map's spacing, times a power of two.
    void operators_over_height(const WorldRect& rect, double step_m, std::vector<const Operator*>& out) const;
    void operators_over_index(const WorldRect& rect, double step_m, std::vector<const Operator*>& out) const;
    // Those that texels of this size show, or more; 0: all.
    void operators_over_texture(const WorldRect& rect, double texel_m,
                                std::vector<const Operator*>& out) const;
    void operators_over_cutout(const WorldRect& rect, std::vector<const Operator*>& out) const;
    // Those over the texture that look at the ground's heights: volumes and floods.
    void operators_over_ground(const WorldRect& rect, std::vector<const Operator*>& out) const;
    // A shape of every kind that is drawn somewhere, with the function it shows; nothing else of it counts.
    [[nodiscard]] std::vector<OperatorShape> drawn_kinds() const;
    [[nodiscard]] std::vector<Operator> operators() const;        // a copy of all, in order: reads them all
    [[nodiscard]] std::vector<Operator> timed_operators() const;  // events and those with a life, in order
    // Ids of those added, changed or removed since a revision; none: so many that `operators` has to be
    // asked.
    [[nodiscard]] std::optional<std::vector<uint64_t>> changed_operators(uint64_t since_revision) const;
    // Forgets operators that nobody has looked at for long, when there are many: once a frame, without a
    // ReadLock.
    static constexpr size_t kMostLoadedOperators = 100'000;  // about 100 MB
    void trim_operators(size_t most = kMostLoadedOperators);
    [[nodiscard]] std::optional<Operator> find_operator(uint64_t id) const;
    [[nodiscard]] ResolvedRoles roles() const;
    [[nodiscard]] std::vector<std::string> stamps() const;       // in the project's folder, sorted
    // Functions of decals; FunctionCommand and poll_functions change them.
    [[nodiscard]] FunctionLibrary& functions() const;
    [[nodiscard]] int layer_index(std::string_view name) const;  // -1: no such layer

    struct EventCost {
        size_t stored_bytes = 0;  // the parameters, in terrain.db
        size_t parts = 0;         // that they stand for
        size_t memory_bytes = 0;  // of the parts while the project is open
    };
    [[nodiscard]] EventCost event_cost(uint64_t id) const;

    struct Statistics {
        uint64_t height_pages = 0, index_pages = 0, database_bytes = 0, operators = 0, commands = 0;
        uint64_t loaded_operators = 0, operator_nodes = 0, loaded_nodes = 0, node_reads = 0;
        uint64_t cached_pages = 0, cache_bytes = 0;
    };
    [[nodiscard]] Statistics statistics() const;

    // Every page, every operator and the journal read and checked; one sentence a fault.
    [[nodiscard]] static Result<std::vector<std::string>> verify(const std::filesystem::path& folder);
    // A digest of all base pages and operators, for tests: equal digests, equal documents.
    [[nodiscard]] Result<uint64_t> content_digest() const;

  private:
    friend class BulkWriter;
    struct Impl;
    explicit Document(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

// Writes whole maps (import, recipes) without journal: rows south to north, any number at a time, from row 0
// to the last; a map of which no row was given stays as it is. `finish` builds the mips and commits. Commands
// are refused meanwhile. Dropped without `finish`: nothing changed. Refused when the journal holds edits of
// the maps (they could not be undone).
class BulkWriter {
  public:
    explicit BulkWriter(Document& document);
    ~BulkWriter();
    Status write_height_rows(int first_row, int row_count, std::span<const int32_t> mm);
    Status write_index_rows(int first_row, int row_count, std::span<const IndexTexel> texels);
    Status finish();

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace loam
