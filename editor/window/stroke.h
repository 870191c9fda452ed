// Strokes as plain geometry: where along a drag dabs and footprints fall.
#pragma once

#include <optional>
#include <vector>

#include <glm/vec2.hpp>

#include "runtime/document/operator.h"

namespace loam::window {

// Dabs at equal distances along the path, the first where it begins. Distances carry over from one piece of the path to
// the next, so the dabs do not depend on how the drag was cut into frames.
class StrokeSpacer {
  public:
    void begin(glm::dvec2 at_m);
    // Appends the dabs of the piece from the last point to `to_m`. At most kMostDabs a call: a longer piece gets them
    // farther apart instead of stalling the frame.
    void extend(glm::dvec2 to_m, double spacing_m, std::vector<glm::dvec2>& dabs);
    [[nodiscard]] bool begun() const { return last_.has_value(); }
    void end() { last_.reset(); }

    static constexpr int kMostDabs = 128;

  private:
    std::optional<glm::dvec2> last_;
    double until_next_m_ = 0;
};

// Somebody walking along the path: prints a step apart, left and right of it in turn, toes along the way. The way is
// smoothed over half a step, so that a trembling hand does not turn the feet.
struct GaitDesc {
    double length_m = 0.3; // of a foot
    double depth_m = 0.03;
    double step_share = 2.5;   // of the foot's length: 0.75 m for a foot of 0.3 m (a walking adult)
    double width_share = 0.33; // from the line of travel to the middle of a foot
};

class Gait {
  public:
    void begin(glm::dvec2 at_m);
    void extend(glm::dvec2 to_m, const GaitDesc& desc, uint32_t seed, std::vector<Footprint>& prints);
    [[nodiscard]] bool begun() const { return last_.has_value(); }
    // Nothing was printed: a click. One foot where it was, with this heading.
    [[nodiscard]] Footprint single(const GaitDesc& desc, double heading_rad, uint32_t seed) const;
    [[nodiscard]] int print_count() const { return count_; }
    void end() { last_.reset(); }

  private:
    std::optional<glm::dvec2> last_;
    glm::dvec2 heading_{0, 0}; // not normalised: its length says how sure it is
    double until_next_m_ = 0;
    int count_ = 0;
};

} // namespace loam::window
