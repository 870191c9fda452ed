// What debug views show of every place of the physical texture beside what the pool knows: edits and work of
// the last frames. A few words a place, written when something happens; they are summed up only for a view.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "runtime/texture/page_pool.h"
#include "shaders/frame/debug_io.h"

namespace loam {

class PageFacts {
  public:
    static constexpr double kDirtFrames = 120;  // an edit has faded from the view of dirt
    static constexpr double kCostFrames = 64;   // work counts half

    explicit PageFacts(int place_count) : places_(size_t(place_count)) {}

    void dirtied(int place, uint64_t frame) { places_[size_t(place)].dirtied = frame; }
    void composed(int place, int64_t texels, uint64_t frame) {
        Place& p = places_[size_t(place)];
        p.cost_pages = cost(p, frame) + double(texels) / (double(kPageTexels) * kPageTexels);
        p.composed = frame;
    }
    void taken(int place) { places_[size_t(place)] = {}; }

    [[nodiscard]] float dirt(int place, const PagePool::Place& page, uint64_t frame) const {
        if (!page.dirty.empty()) return 1.0f;
        const Place& p = places_[size_t(place)];
        if (p.dirtied == 0) return 0.0f;
        return float(std::max(0.0, 1.0 - double(frame - p.dirtied) / kDirtFrames));
    }
    [[nodiscard]] float cost_pages(int place, uint64_t frame) const {
        return float(cost(places_[size_t(place)], frame));
    }

  private:
    struct Place {
        uint64_t dirtied = 0;   // frame of the newest edit; 0: none
        uint64_t composed = 0;  // frame of the newest work
        double cost_pages = 0;  // up to then
    };
    static double cost(const Place& p, uint64_t frame) {
        return p.cost_pages * std::exp2(-double(frame - p.composed) / kCostFrames);
    }
    std::vector<Place> places_;
};

}  // namespace loam
