// Cutouts: parts of the ground that are not there, for caves and buildings. A vertex of the base height map
// is cut where it lies in a volume, or under a brush's dab; maps/cutout_map.h bakes them into one bit a
// vertex. Source: Call of Duty talk, "Cutout Volumes", "Virtual Cutout Map".
#pragma once

#include <memory>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "runtime/base/rect.h"
#include "runtime/base/result.h"

namespace loam {

enum class CutoutForm { box, cylinder, convex, brush };

struct Cutout {
    CutoutForm form = CutoutForm::box;
    // Box and cylinder, which stands along its own z (half_m.x and half_m.y may differ): placed as a volume
    // decal.
    glm::dvec3 center_m{0};
    glm::dvec3 half_m{2, 2, 2};
    glm::dvec3 direction{0, 0, -1};  // its own -z
    double roll_rad = 0;
    std::vector<glm::dvec3> corners;  // convex: the hull of 4 … 32 points, in the world
    // Brush: discs seen from above, whatever the height.
    std::vector<glm::dvec2> dabs;
    double radius_m = 5;
    bool fill = false;  // closes what cutouts before it opened

    // Of the corners: dot(xyz, p) <= w inside; set by `prepare` (operator.h).
    std::shared_ptr<const std::vector<glm::dvec4>> planes;

    bool operator==(const Cutout& o) const {
        return form == o.form && center_m == o.center_m && half_m == o.half_m && direction == o.direction &&
               roll_rad == o.roll_rad && corners == o.corners && dabs == o.dabs && radius_m == o.radius_m &&
               fill == o.fill;
    }
};

inline constexpr size_t kMaxCutoutCorners = 32;

// Whether its bits follow the ground's height.
[[nodiscard]] inline bool looks_at_heights(const Cutout& cutout) {
    return cutout.form != CutoutForm::brush;
}
// The world rectangles outside which it cuts nothing.
[[nodiscard]] std::vector<WorldRect> rects_of(const Cutout& cutout);
// Whether a place of the ground lies in it, its surface included.
[[nodiscard]] bool holds(const Cutout& cutout, const glm::dvec3& place_m);
// Of a brush's one dab.
[[nodiscard]] WorldRect disc_rect(const Cutout& cutout, const glm::dvec2& dab);
[[nodiscard]] bool disc_holds(const Cutout& cutout, const glm::dvec2& dab, const glm::dvec3& place_m);
// Of the hull of a convex one's corners; an error where they span no volume.
[[nodiscard]] Result<std::vector<glm::dvec4>> hull_planes(const std::vector<glm::dvec3>& corners);

}  // namespace loam
