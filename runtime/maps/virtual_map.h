// The one mechanism behind every virtual map that is composed on the CPU: a fixed cache of square pages, a
// page table, requests with priority, hysteresis, and dirt. It knows nothing of what a page holds: HeightMap
// and IndexMap add their composer and their formats. Source: Call of Duty talk, "Virtual Height Map": 64x64
// pages with 2 of border, 144 pages, prioritised by distance, the cache is always filled, pages in it are
// harder to eject.
//
// Invariants
//  1. A slot holds at most one page; a page is in at most one slot.
//  2. A page taken out of the table is not overwritten for kSlotRestFrames frames.
//  3. The root page (the coarsest level) is resident from the first update on and never ejected.
//  4. A resident page with an empty dirty rectangle equals compose(page) from nothing, bit for bit.
//
// Page p's texel t, 0 <= t < page_texels(), is sample payload * p + t - border of its level, at world (sample
// * spacing).
//
//   absent ──request, slot free or less wanted──▶ composing ──next update──▶ resident ──invalidate──▶
//   resident + dirty
//      ▲                                                                         │                        │
//      recomposed rect └───────────────────── ejected (rests 3 frames)
//      ◀─────────────────────────┘◀───────────────────────┘
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/base/rect.h"

namespace loam {

inline constexpr int kSlotRestFrames = 3;

// A square of the world: level 0 is finest, x and y count pages of that level from the map's south-west
// corner.
struct MapPage {
    int level = 0, x = 0, y = 0;
    bool operator==(const MapPage&) const = default;
};
struct MapPageHash {
    size_t operator()(const MapPage& p) const {
        uint64_t h = (uint64_t(p.level) << 56) ^ (uint64_t(uint32_t(p.y)) << 28) ^ uint32_t(p.x);
        h ^= h >> 31;
        h *= 0x9E3779B97F4A7C15ull;
        return size_t(h ^ (h >> 29));
    }
};

struct VirtualMapDesc {
    int payload_texels = 64;  // a page without border
    int border_texels = 2;
    int slot_count = 144;
    int level_count = 1;
    double spacing_m = 1;      // between samples of level 0
    WorldRect bounds;          // pages that do not overlap it do not exist
    float hysteresis = 0.25f;  // a resident page counts this share more
};

class VirtualMap {
  public:
    explicit VirtualMap(const VirtualMapDesc& desc);

    [[nodiscard]] const VirtualMapDesc& desc() const { return desc_; }
    [[nodiscard]] int page_texels() const { return desc_.payload_texels + 2 * desc_.border_texels; }
    [[nodiscard]] double page_size_m(int level) const { return spacing_m(level) * desc_.payload_texels; }
    [[nodiscard]] double spacing_m(int level) const { return desc_.spacing_m * double(int64_t(1) << level); }
    [[nodiscard]] WorldRect page_rect(const MapPage& page) const;  // payload only
    [[nodiscard]] bool exists(const MapPage& page) const;
    [[nodiscard]] MapPage root() const { return {desc_.level_count - 1, 0, 0}; }

    [[nodiscard]] int slot_of(const MapPage& page) const;  // -1: not resident
    [[nodiscard]] TexelRect dirty_of(
        int slot) const;  // of the page in the slot; what is being composed included
    // The texels of a page whose samples lie in a rectangle, not clipped to the page.
    [[nodiscard]] TexelRect texels_in(const MapPage& page, const WorldRect& rect) const;
    // The page itself if resident, else its nearest resident ancestor.
    [[nodiscard]] MapPage finest_resident(MapPage page) const;

    // --- one frame ---
    void request(const MapPage& page,
                 float priority);  // larger is more wanted; the maximum of a frame's requests counts
    struct Work {
        MapPage page;
        int slot = 0;
        TexelRect rect;      // in texels of the page with border, [0, page_texels())
        bool whole = false;  // new in its slot (not yet in the table until `finish`)
    };
    // Chooses at most `new_pages` pages to compose, most wanted first, ejecting the least wanted where
    // needed, and all dirty rectangles of resident pages that are among this frame's requests (the others
    // keep their dirt). The cache is always filled. Work of the last plan that was not finished is dropped:
    // its slot is free again, its rectangle dirty again.
    [[nodiscard]] std::vector<Work> plan(uint64_t frame, int new_pages);
    // The work has been composed and its upload recorded: the page is in the table from now on, its dirt is
    // cleared (but for what was invalidated since `plan`).
    void finish(const Work& work);

    // Texels of every resident page whose samples lie in `rect` become dirty. Returns the number of pages
    // touched. `grow_texels`: by so many texels of each page's own level more, for composers that look at
    // neighbouring texels.
    int invalidate(const WorldRect& rect, int grow_texels = 0);

    // Requested pages absent or requested pages dirty, as of the last plan: one more frame is worth drawing.
    // A page that is wanted less than everything in a full cache does not count.
    [[nodiscard]] bool has_work() const;
    struct Counters {
        uint64_t pages_composed = 0, texels_composed = 0, pages_dirtied = 0, ejected = 0;
    };
    [[nodiscard]] const Counters& counters() const { return counters_; }
    void for_each_resident(
        const std::function<void(const MapPage&, int slot, const TexelRect& dirty)>& visit) const;

    // Changes to the GPU's page table since the last call: (entry index, slot or kNoSlot). Entries of level L
    // start at level_offset(L), row-major, pages_x(L) wide.
    static constexpr uint16_t kNoSlot = 0xffff;
    struct TableChange {
        uint32_t entry;
        uint16_t slot;
    };
    [[nodiscard]] std::vector<TableChange> take_table_changes();
    [[nodiscard]] uint32_t table_entry_count() const;
    [[nodiscard]] uint32_t level_offset(int level) const { return level_offsets_[size_t(level)]; }
    [[nodiscard]] int pages_x(int level) const;
    [[nodiscard]] int pages_y(int level) const;

  private:
    struct Slot {
        MapPage page;
        bool used = false, in_table = false;
        TexelRect dirty;
        TexelRect planned;   // handed out by the last plan, not finished yet
        float priority = 0;  // of this frame, 0 when not requested
        uint64_t last_requested = 0;
        uint64_t free_from_frame = 0;  // rests until then
    };
    void drop_unfinished();
    [[nodiscard]] std::vector<std::pair<MapPage, float>> take_requests(size_t missing_limit,
                                                                       size_t& missing_count);
    [[nodiscard]] int least_wanted_slot() const;
    void eject(int slot);
    [[nodiscard]] uint32_t table_entry(const MapPage& page) const;

    VirtualMapDesc desc_;
    std::vector<Slot> slots_;
    std::unordered_map<MapPage, int, MapPageHash> table_;
    std::unordered_map<MapPage, float, MapPageHash> requests_;
    std::vector<uint32_t> level_offsets_;
    std::vector<TableChange> table_changes_;
    Counters counters_;
    bool has_work_ = true;
    uint64_t frame_ = 0;
};

}  // namespace loam
