#include "editor/window/frame_pacer.h"

#include <limits>

namespace loam::window {

void FramePacer::changed(double now_s) {
    phase_ = Phase::moving;
    changed_s_ = now_s;
    dirty_ = true;
    settled_frames_ = 0;
}

void FramePacer::advance(double now_s) {
    if (phase_ != Phase::moving || dirty_) return;
    const double quiet_s = now_s - changed_s_;
    if (quiet_s < kQuiet_s || (settled_frames_ < kSettledFrames && quiet_s < kLoading_s)) return;
    phase_ = Phase::refining;
    settled_frames_ = refining_frames_ = 0;
}

void FramePacer::drawn(bool settled) {
    dirty_ = false;
    settled_frames_ = settled ? settled_frames_ + 1 : 0;
    if (phase_ != Phase::refining) return;
    ++refining_frames_;
    if (settled_frames_ >= kSettledFrames || refining_frames_ >= kRefiningFrames) phase_ = Phase::resting;
}

bool FramePacer::due() const {
    if (phase_ == Phase::resting) return false;
    return phase_ == Phase::refining || dirty_ || settled_frames_ < kSettledFrames;
}

double FramePacer::wake_s() const {
    if (phase_ != Phase::moving || due()) return std::numeric_limits<double>::infinity();
    return changed_s_ + kQuiet_s;
}

} // namespace loam::window
