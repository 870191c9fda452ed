// Decals that lay a material on the ground: terrain decals (a rectangle seen from above), splined decals
// (along a Bezier curve, with an optional carve of the height) and volume decals (a box that projects along
// any direction). Source: Call of Duty talk, "Decal Rendering".
//
// Composition draws the kinds in the talk's order: layers, splines, terrain decals with the marks of craters
// and footprints, volumes; within a kind in the user's order. Heights follow the user's order alone, so that
// a road laid after a crater fills it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace loam {

class SplinePath;

// How strongly each channel of the ground gives way, 0 … 1.
struct DecalChannels {
    double albedo = 1, normal = 1, gloss = 1, metalness = 1, occlusion = 1;
    bool operator==(const DecalChannels&) const = default;
};

struct DecalMaterial {
    std::string layer;                  // of the project; empty: a flat colour
    glm::dvec3 colour{1, 1, 1};         // sRGB-encoded 0 … 1; multiplies the layer's albedo
    double gloss = 0.2, metalness = 0;  // of a flat colour
    double tile_m = 0;                  // size of a repeat of the layer; 0: the layer's own
    double opacity = 1;
    double edge = 0.2;  // share of the smaller half size over which it fades
    double rough = 0;   // how far noise eats into the edge, 0 … 1
    uint32_t seed = 0;
    DecalChannels channels;
    std::string function;  // that makes it (decal_function.h); empty: none
    // Of the function; those that are not here are as its text has them.
    std::map<std::string, double> parameters;
    bool operator==(const DecalMaterial&) const = default;
};

enum class DecalOutline { rectangle, ellipse };

struct TerrainDecal {
    double x_m = 0, y_m = 0;
    glm::dvec2 half_m{2, 2};  // ±0.01 … ±5000; a negative one mirrors
    double heading_rad = 0;   // clockwise from north, where the decal's +y points
    DecalOutline outline = DecalOutline::rectangle;
    // By which the ground rises where the decal covers it, as its edge has it: ±50; its opacity does not
    // count.
    double displacement_m = 0;
    DecalMaterial material;
    bool operator==(const TerrainDecal&) const = default;
};

struct SplinePoint {
    double x_m = 0, y_m = 0;
    double z_m = 0;  // of the carved profile
    double width_m = 4;
    double roll_rad =
        0;  // of the carved profile around its middle line, ±1.2; positive lowers the right side
    bool operator==(const SplinePoint&) const = default;
};

// Roll is not kept: a carved profile is level across.
struct SplineDecal {
    std::vector<SplinePoint> points;         // control points of cubic pieces: 4, 7, 10, …
    double fade_m = 0;                       // over which both ends fade
    double carve = 0;                        // 0: heights stay; 1: the ground lies on the profile
    double shoulder_m = 3;                   // beyond the width, back to the old ground
    DecalMaterial material;                  // edge: share of the half width
    std::shared_ptr<const SplinePath> path;  // of the points; set by `prepare` (operator.h)
    bool operator==(const SplineDecal& o) const {
        return points == o.points && fade_m == o.fade_m && carve == o.carve && shoulder_m == o.shoulder_m &&
               material == o.material;
    }
};

struct VolumeDecal {
    glm::dvec3 center_m{0};
    glm::dvec3 half_m{2, 2, 2};      // x and y as a terrain decal's, z along the direction
    glm::dvec3 direction{0, 0, -1};  // it projects along, any length but zero
    double roll_rad = 0;             // around the direction
    DecalOutline outline = DecalOutline::rectangle;
    DecalMaterial material;
    double deep_edge = 0.2;  // share of z's half size over which it fades, 0.0001 … 1
    bool operator==(const VolumeDecal&) const = default;
};

// Axes of a volume's box in the world: x, y across, z against the direction. Seen from straight above x is
// east; else x is level.
struct VolumeAxes {
    glm::dvec3 x, y, z;
};
[[nodiscard]] VolumeAxes axes_of(const glm::dvec3& direction, double roll_rad);
[[nodiscard]] inline VolumeAxes axes_of(const VolumeDecal& volume) {
    return axes_of(volume.direction, volume.roll_rad);
}

}  // namespace loam
