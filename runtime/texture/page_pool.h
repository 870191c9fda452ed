// The places of the physical texture and what is in them.
//
//   free ──take──▶ composed ──next frame──▶ usable ──retire──▶ resting ──take, after 3 frames──▶ composed
//   (another page)
//                                             ▲                   │
//                                             └─────revive────────┘ requested again, still clean
//
// Invariants
//  1. A page is in at most one place, a place holds at most one page.
//  2. A page is in its quad tree exactly while its place is usable; it becomes usable in the frame after it
//  was composed.
//  3. A place is not taken until kRestFrames frames after its page left the tree: no frame in flight reads a
//  page that
//     is being replaced.
//  4. Of the places that may be taken, the one whose page was requested longest ago is taken first.
//  5. Pinned places (the default root, roots of live sectors) are never retired.
//  6. Dirt reaches a page in every state but free, so a resting page that is revived has missed no edit.
//  7. A place's generation is the number of pages it has held: who remembers a place by its generation sees
//  that it has been recycled.
// Source: Call of Duty talk, "Virtual Image Quad Tree", "Composition Manager".
#pragma once

#include <cstdint>
#include <functional>
#include <unordered_map>
#include <vector>

#include "runtime/base/rect.h"
#include "runtime/texture/page_id.h"

namespace loam {

struct PagePoolRules {
    int age_frames = 3;  // a page not requested for this long may be retired
    // Between compositions of a page that lacks inputs: the first wait, doubled up to the last.
    int first_retry_frames = 15, last_retry_frames = 60;
};

class PagePool {
  public:
    static constexpr int kRestFrames = 3;
    enum class State : uint8_t { free, composed, usable, resting };
    struct Place {
        PageId page;
        State state = State::free;
        bool pinned = false;
        uint64_t last_requested = 0;
        uint64_t changed = 0;  // frame of the last change of state
        TexelRect dirty;       // of the page with border
        uint32_t generation = 0;
        // Composed from coarser inputs than it should be: again at `retry_frame`, and so on at growing
        // intervals.
        bool low_res = false;
        int input_level = 0;  // of the index page it was composed from
        int retry_wait = 0;   // frames
        uint64_t retry_frame = 0;
    };

    // Place 0 is kept for the default root.
    explicit PagePool(int pages_per_side, const PagePoolRules& rules = {});

    [[nodiscard]] int place_count() const { return int(places_.size()); }
    [[nodiscard]] int used_count() const { return int(by_page_.size()); }
    [[nodiscard]] int pages_per_side() const { return pages_per_side_; }
    [[nodiscard]] const Place& place(int index) const { return places_[size_t(index)]; }
    [[nodiscard]] const std::vector<Place>& places() const { return places_; }
    [[nodiscard]] int find(const PageId& page) const;  // -1: absent

    void touch(int index, uint64_t frame);  // requested in this frame
    void pin(int index, bool pinned) { places_[size_t(index)].pinned = pinned; }
    // A place for a page that is absent; -1 when every place is in use or resting. Its page before is
    // forgotten.
    int take(const PageId& page, uint64_t frame);
    // The place of the page that `take` would choose is available now.
    [[nodiscard]] int takeable_count(uint64_t frame) const;
    // Pages composed in an earlier frame become usable; `visit` puts them into the trees.
    void promote(uint64_t frame, const std::function<void(int index)>& visit);
    void retire(int index, uint64_t frame);
    void revive(int index, uint64_t frame);  // resting and clean
    // Usable places, unpinned, not requested for PagePoolRules::age_frames, oldest first.
    [[nodiscard]] std::vector<int> retirable(uint64_t frame) const;

    void mark_dirty(int index, const TexelRect& rect);
    void clear_dirty(int index) { places_[size_t(index)].dirty = {}; }

    // Composed just now from inputs of this level, which it should not be: again after 15, 30, 60, 60 …
    // frames.
    void mark_low_res(int index, int input_level, uint64_t frame);
    // Composed from inputs of another level meanwhile, as it was edited.
    void set_input_level(int index, int level) { places_[size_t(index)].input_level = level; }
    void clear_low_res(int index) { places_[size_t(index)].low_res = false; }

  private:
    int pages_per_side_;
    PagePoolRules rules_;
    std::vector<Place> places_;
    std::unordered_map<PageId, int, PageIdHash> by_page_;
};

}  // namespace loam
