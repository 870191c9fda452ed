#include "editor/window/render_scale.h"

#include <algorithm>
#include <cmath>

namespace loam::window {

namespace {

constexpr double kStep = 0.05;          // scales are multiples of this: few picture sizes, no shimmer
constexpr size_t kFramesToShrink = 3;   // two of three frames late: 0.1 s at the goal of a software device
constexpr size_t kFramesToGrow = 9;
constexpr double kShrinkAbove = 1.06;   // shares of the goal
constexpr double kShrinkTo = 0.94;
constexpr double kGrowBelow = 0.92;     // of the time expected after the step

} // namespace

RenderScale::RenderScale(const RenderScaleDesc& desc)
    : desc_(desc), scale_(std::clamp(desc.start, desc.smallest, desc.largest)) {}

double RenderScale::median() const {
    std::vector<double> sorted = times_;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return *middle;
}

void RenderScale::change_to(double scale) {
    const float next = std::clamp(static_cast<float>(scale), desc_.smallest, desc_.largest);
    if (next == scale_) return;
    scale_ = next;
    times_.clear();
}

void RenderScale::add_frame(double ms) {
    if (!std::isfinite(ms) || ms <= 0) return;
    times_.push_back(ms);
    if (times_.size() > kFramesToGrow) times_.erase(times_.begin());
    if (times_.size() < kFramesToShrink) return;

    // Only the newest frames decide about shrinking: a load that starts is followed at once.
    std::vector<double> newest(times_.end() - kFramesToShrink, times_.end());
    std::nth_element(newest.begin(), newest.begin() + kFramesToShrink / 2, newest.end());
    const double recent_ms = newest[kFramesToShrink / 2];
    if (recent_ms > desc_.goal_ms * kShrinkAbove) {
        const double wanted = scale_ * std::sqrt(desc_.goal_ms * kShrinkTo / recent_ms);
        change_to(std::min(scale_ - kStep, std::floor(wanted / kStep + 1e-6) * kStep));
        return;
    }
    if (times_.size() < kFramesToGrow || scale_ >= desc_.largest) return;
    const double wanted = scale_ * std::sqrt(desc_.goal_ms * kGrowBelow / median());
    const double next = std::floor(wanted / kStep + 1e-6) * kStep;
    if (next > scale_ + kStep * 0.5) change_to(next);
}

} // namespace loam::window
