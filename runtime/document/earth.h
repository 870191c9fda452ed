// Earth and water that an event moves: a slide takes soil from one place and lays it at another, a flood wets
// the ground below a level. Source: Call of Duty talk, "Large Map Events".
#pragma once

#include <string>

#include <glm/vec2.hpp>

#include "runtime/base/rect.h"

namespace loam {

// A lump of soil: a hollow where it was and a heap where it lies, both h (1 - rho^2)^3 over a disc, so that
// the heap has the hollow's volume, pi r^2 h / 4, whatever becomes of its radius on the way.
struct Slide {
    double x_m = 0, y_m = 0;  // where it breaks away
    double radius_m = 10;     // there, 0.1 … 2000
    glm::dvec2 to_m{0, 0};    // where it comes to rest
    double to_radius_m = 15;  // there, 0.1 … 2000
    double volume_m3 = 100;   // 0 … 1e9
    double way = 1;           // 0: still in its place, which changes nothing; 1: at rest
    bool operator==(const Slide&) const = default;
};
// Of the lump on its way; it gathers speed and slows down.
[[nodiscard]] glm::dvec2 place_of(const Slide& slide);
[[nodiscard]] double radius_of(const Slide& slide);
[[nodiscard]] WorldRect hollow_of(const Slide& slide);
[[nodiscard]] WorldRect heap_of(const Slide& slide);

// The ground below a level, within a circle: darker, glossy, and of another layer where one is named. What
// lies below it is wet whether or not water could run there.
struct Flood {
    double x_m = 0, y_m = 0;
    double radius_m = 200;      // 1 … 5000
    double level_m = 0;         // of the water, when it has risen
    double from_m = 0;          // where it rises from
    std::string layer;          // of the wet ground; empty: as it was
    double way = 1;             // 0: at from_m; 1: at level_m
    uint16_t layer_number = 0;  // of `layer`; the document sets it
    bool operator==(const Flood& o) const {
        return x_m == o.x_m && y_m == o.y_m && radius_m == o.radius_m && level_m == o.level_m &&
               from_m == o.from_m && layer == o.layer && way == o.way;
    }
};
[[nodiscard]] double height_of(const Flood& flood);  // of the water now, metres
[[nodiscard]] WorldRect bounds_of(const Flood& flood);

}  // namespace loam
