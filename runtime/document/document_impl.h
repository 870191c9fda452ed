// What a Document holds. Internal to this folder.
//
// Committing: a change is computed on copies of pages, written in a transaction, and only then, under the
// exclusive lock, committed and shown to readers. If anything fails before that, memory has nothing to take
// back.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <vector>

#include "runtime/document/base_map.h"
#include "runtime/document/document.h"
#include "runtime/document/function_library.h"
#include "runtime/document/imagery.h"
#include "runtime/document/journal_images.h"
#include "runtime/document/operator_nodes.h"
#include "runtime/document/operator_set.h"
#include "runtime/document/page_edits.h"
#include "runtime/document/paint.h"
#include "runtime/document/stamp_library.h"
#include "runtime/store/page_store.h"
#include "runtime/store/writer_lock.h"

namespace loam {

inline constexpr size_t kPageCacheBytes = size_t(256) << 20;
inline constexpr const char* kTimeMeta = "time_s";  // bits of a double
inline constexpr size_t kMostRemembered = 16'384;   // changes of operators, for who lists them
inline constexpr size_t kMaxStrokeRects = 8, kMaxOperatorRects = 64;

// terrain.db's copy of what its pages were made with.
Status write_identity(PageStore& store, const ProjectSettings& settings);
Status check_identity(PageStore& store, const ProjectSettings& settings);

[[nodiscard]] inline IndexTexel default_texel(const ProjectSettings& settings) {
    IndexTexel texel;
    texel.layer = settings.default_layer;
    return texel;
}

struct Document::Impl {
    std::filesystem::path folder;
    ProjectSettings settings;
    OpenMode mode = OpenMode::read_write;
    MapShape height, index;
    WriterLock lock;
    PageStore store;  // the writing connection; not open in a read-only document
    std::unique_ptr<BasePages> pages;
    OperatorSet operators;                 // those that are always held
    OperatorGrids grids;
    std::unique_ptr<OperatorNodes> nodes;  // the others
    std::unique_ptr<StampLibrary> stamps;
    std::unique_ptr<FunctionLibrary> functions;
    std::shared_ptr<const Imagery> imagery;     // null: none, or its file could not be opened
    std::vector<PageStore::JournalHead> heads;  // ascending; the applied ones come first
    uint64_t next_operator = 1, next_sequence = 1, next_group = 1;
    PageBalance page_count;
    std::atomic<uint64_t> revision{1};
    struct Changed {
        uint64_t revision, id;
    };
    std::deque<Changed> changed_operators;  // ascending
    uint64_t forgotten_revision = 1;        // up to which changes are not in the list
    mutable std::shared_mutex mutex;  // exclusive while a change becomes visible
    // Held by a writer that waits for `mutex`, so that readers who come one after another cannot keep it out.
    // Readers wait here for a while only: a thread that already holds a ReadLock must get its second one.
    mutable std::timed_mutex gate;
    bool bulk_writing = false;

    // Exclusive access, for showing a change.
    struct Exclusive {
        explicit Exclusive(Impl& impl) : gate(impl.gate), lock(impl.mutex) {}
        std::lock_guard<std::timed_mutex> gate;
        std::lock_guard<std::shared_mutex> lock;
    };

    Status load();
    Status load_operators(PageStore& reader);
    // Rows of a database of the first format, which were all read, are given their nodes.
    Status give_nodes();
    [[nodiscard]] Result<Operator> read_operator(const PageStore::OperatorRow& row);
    [[nodiscard]] std::vector<Operator> read_node(int64_t node);
    // A copy, whether it is held or not.
    [[nodiscard]] std::optional<Operator> find_operator(uint64_t id);
    Status may_write() const;
    [[nodiscard]] size_t applied_count() const;

    // --- commands (document_apply.cpp) ---
    struct Change {
        std::vector<RowImage> images;  // new rows; after the swap, the old ones
        std::map<uint64_t, std::optional<Operator>> operators;  // their new states
        std::optional<PageEdits<int32_t>> heights;
        std::optional<PageEdits<IndexTexel>> texels;
        std::vector<PageChange> height_changes, index_changes;
        Dirt dirt;  // of the base maps; what operators show depends on the time
        uint64_t next_operator = 0;
        std::optional<ProjectSettings> settings;  // the transitions' change
    };
    Status compute(const SculptCommand& command, Change& change);
    Status compute(const PaintCommand& command, Change& change);
    Status compute(const FillCommand& command, Change& change);
    template <typename PaintingCommand, typename Run>
    Status compute_paint(const PaintingCommand& command, PaintLayers layers, Change& change, Run&& run);
    [[nodiscard]] Result<uint16_t> layer_number(const std::string& name) const;
    Status compute(const CraterCommand& command, Change& change);
    Status compute(const FootprintsCommand& command, Change& change);
    Status compute(const AddOperatorCommand& command, Change& change);
    Status compute(const EditOperatorCommand& command, Change& change);
    Status compute(const ReorderCommand& command, Change& change);
    Status compute(const SetOperatorCommand& command, Change& change);
    Status compute(const RemoveOperatorCommand& command, Change& change);
    Status compute(const TransitionCommand& command, Change& change);
    Status compute(const TimeCommand&, Change&) { return error("the time is not a command of the journal"); }
    Status compute(const FunctionCommand&, Change&) {
        return error("a function is not a command of the journal");
    }
    Status compute(const UndoCommand&, Change&) { return error("undo is not a command of the journal"); }
    Status compute(const RedoCommand&, Change&) { return error("redo is not a command of the journal"); }
    void change_operator(uint64_t id, std::optional<Operator> op, Change& change);
    void add_operator(OperatorShape shape, const Life& life, Change& change);
    [[nodiscard]] Status known_layer(const std::string& name) const;
    [[nodiscard]] Status known_parts(
        const OperatorShape& shape) const;  // the layer and picture it is made of
    // A stamp's picture and the number of a layer that is laid; an error leaves it without.
    Status give_parts(Operator& op);
    Status complete(OperatorShape& shape);  // what a command may leave to the document
    // The function of a decal; one of an operator that had just the same stays, whatever became of its text.
    Status known_function(const OperatorShape& shape, const OperatorShape* before);
    // Where a landslide without an end runs to.
    [[nodiscard]] Result<glm::dvec2> run_out(const Event& landslide);
    // The index follows the ground where a flood lies on it.
    void follow_heights(Dirt& dirt) const;
    Result<Dirt> set_time(double time_s);
    // Where decals show the functions.
    Dirt function_dirt(const std::vector<std::string>& names);
    Status write_change(Change& change, const JournalRow& row, const PageBalance& before);
    // Under the exclusive lock, before the commit: what is about to change is read from what was.
    void wake_operators(const Change& change);
    // Under the exclusive lock, after it: the operators' new states, and where they show or did.
    void show_operators(Change& change);
    Result<Dirt> commit_change(Change& change, const Command& command);
    // Swaps the rows of the journal heads [first, end), the direction that `applied` names, in one
    // transaction.
    Result<Dirt> swap_commands(size_t first, size_t end, bool applied);
    // project.toml beside a transaction that is about to be committed, and back when that fails.
    Status save_settings(const Change& change);
    void take_back_settings(const Change& change);
    void tidy_log();
    Status write_swaps(size_t first, size_t end, bool applied, Change& change, PageBalance& balance);
};

}  // namespace loam
