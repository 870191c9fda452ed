// The share of the picture's width and height that is shaded while things move, chosen so that a frame meets a
// time goal. Pure arithmetic over measured frame times.
//
// A frame costs a + b · scale² milliseconds with a and b unknown. The median of a few frames at one scale decides, so
// that a single late frame changes nothing. Shrinking assumes that all of the time scales (a too small step, repeated);
// growing assumes the same (a too large estimate, so a step up never overshoots the goal). Between "grow" and
// "shrink" lies a band in which the scale rests: it cannot oscillate.
#pragma once

#include <vector>

namespace loam::window {

struct RenderScaleDesc {
    double goal_ms = 33;
    float smallest = 0.3f, largest = 1.0f;
    float start = 0.6f;
};

class RenderScale {
  public:
    explicit RenderScale(const RenderScaleDesc& desc);

    [[nodiscard]] float scale() const { return scale_; }
    [[nodiscard]] double goal_ms() const { return desc_.goal_ms; }
    // A frame drawn at scale() took so long. Times that are not finite or not positive are left out.
    void add_frame(double ms);
    // Forgets the times (not the scale): after a pause, a change of size, a change of view.
    void restart() { times_.clear(); }

  private:
    [[nodiscard]] double median() const;
    void change_to(double scale);
    RenderScaleDesc desc_;
    float scale_;
    std::vector<double> times_;
};

} // namespace loam::window
