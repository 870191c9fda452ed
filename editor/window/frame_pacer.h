// What the next frame is for. Pure: a state machine over what happened and what the renderer said.
//
//                   change                          quiet for kQuiet_s, pages there
//     resting ───────────────▶ moving ──────────────────────────────────────────▶ refining ──settled──▶ resting
//        ▲                        ▲───────────────────── change ──────────────────────┘
//
// Moving: adapted render scale, coarse filter. Refining: full resolution, fine filter, until the renderer has had
// nothing to do for a few frames (what a frame asks for is known three frames later). Refining never falls back to
// moving by itself: at full resolution finer pages are asked for, and going back would begin again for ever.
#pragma once

namespace loam::window {

class FramePacer {
  public:
    enum class Phase { moving, refining, resting };

    // Something in the scene changed: camera, terrain, settings, size of the picture.
    void changed(double now_s);
    // Before a frame is decided upon.
    void advance(double now_s);
    // A frame of the current phase was drawn.
    void drawn(bool settled);

    [[nodiscard]] Phase phase() const { return phase_; }
    // A new picture is worth drawing now.
    [[nodiscard]] bool due() const;
    // When to look again although nothing is due; infinite when only a change helps.
    [[nodiscard]] double wake_s() const;

    static constexpr double kQuiet_s = 0.2;     // a stroke's mouse rests for shorter times than this
    static constexpr double kLoading_s = 3.0;   // pages may hold the coarse picture for so long
    static constexpr int kSettledFrames = 4;    // feedback comes back three frames later
    static constexpr int kRefiningFrames = 400; // a cache too small for the view would never settle

  private:
    Phase phase_ = Phase::moving;
    double changed_s_ = 0;
    bool dirty_ = true;
    int settled_frames_ = 0, refining_frames_ = 0;
};

} // namespace loam::window
