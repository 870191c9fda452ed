// How many texels of dirt and of new pages a frame composes, so that frames stay near a goal while someone
// works. It follows the time that frames with much to compose took: the price of a texel differs by device,
// layers and page format, and is not known.
#pragma once

#include <algorithm>
#include <cstdint>

#include "shaders/texture/texture_io.h"

namespace loam {

class ComposeBudget {
  public:
    static constexpr int64_t kPage = int64_t(kPageTexels) * kPageTexels;
    static constexpr int64_t kLeast = kPage / 2;  // a dab that covers a page is done in two frames at worst
    static constexpr int64_t kMost = 4 * kPage;   // 10–30 ms on software devices

    [[nodiscard]] int64_t texels() const { return texels_; }
    // After each frame. frame_ms 0: unknown; goal_ms 0: nobody waits for frames.
    void frame_took(double frame_ms, double goal_ms, int64_t composed_texels) {
        if (goal_ms <= 0) {
            texels_ = kMost;
            return;
        }
        // A frame that composed little says nothing about the price of more.
        if (frame_ms <= 0 || composed_texels * 2 < texels_) return;
        const double room = goal_ms / frame_ms;
        if (room < 0.95 || room > 1.2)
            texels_ = std::clamp(int64_t(double(texels_) * std::clamp(room, 0.5, 1.25)), kLeast, kMost);
    }

  private:
    int64_t texels_ = kMost;
};

}  // namespace loam
