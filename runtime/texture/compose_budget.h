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

// What composing a page costs in a frame: the slope of frame times over texels composed, by least squares in
// which a frame counts half as much as one some 14 frames later. Timestamps would be simpler but are wrong on
// software devices.
class ComposePrice {
  public:
    static constexpr double kUnknown_ms = 4;  // between software (3–8) and anything else (0.1)

    void frame_took(double frame_ms, int64_t composed_texels) {
        if (frame_ms <= 0) return;
        // A stall says nothing: a pipeline compiled, a window was dragged.
        if (weight_ > 4 && frame_ms > 6 * y_ / weight_) return;
        const double x = double(composed_texels) / double(ComposeBudget::kPage);
        for (double* sum : {&weight_, &x_, &y_, &xx_, &xy_}) *sum *= kForget;
        weight_ += 1, x_ += x, y_ += frame_ms, xx_ += x * x, xy_ += x * frame_ms;
    }
    [[nodiscard]] double page_ms() const {
        const double spread = weight_ * xx_ - x_ * x_;
        if (weight_ < 4 || spread < 0.05 * weight_ * weight_) return known_ms_;
        known_ms_ = std::clamp((weight_ * xy_ - x_ * y_) / spread, 0.02, 100.0);
        return known_ms_;
    }

  private:
    static constexpr double kForget = 0.95;
    double weight_ = 0, x_ = 0, y_ = 0, xx_ = 0, xy_ = 0;
    mutable double known_ms_ = kUnknown_ms;  // kept while nothing varies
};

}  // namespace loam
