// Operators: live, parametric changes on top of the base maps. They are evaluated whenever a page they
// overlap is composed and never burnt in, so that moving, switching off or deleting one is only dirt. Source:
// Call of Duty talk, "Large Map Events", "Dynamic Decals".
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "runtime/base/rect.h"
#include "runtime/base/result.h"
#include "runtime/document/cutout.h"
#include "runtime/document/earth.h"
#include "runtime/document/event.h"
#include "runtime/document/ground_decal.h"
#include "runtime/document/life.h"
#include "runtime/document/stamp.h"
#include "runtime/store/index_texel.h"

namespace loam {

struct Crater {
    double x_m = 0, y_m = 0;  // centre
    double radius_m = 10;     // of the rim's crest, 0.1 … 2000
    double depth_m = 0;       // bowl below the old ground; 0: radius * 0.4
    uint32_t seed = 0;        // irregular rim, rays, scorch pattern
    double heat = 0;          // 0 … 1: embers on the floor, in the thermal and emissive channels of the texture
    double age = 0;           // 0 fresh … 1 weathered: shallower, smoother, without rays
    double strength = 1;      // of its marks; its life sets it
};

struct Footprint {
    double x_m = 0, y_m = 0;
    double heading_rad = 0;  // clockwise from north, where the toes point
    double length_m = 0.3;   // 0.05 … 50
    double depth_m = 0.03;   // of the dent in the height map
    int foot = 0;            // 0 left, 1 right, kTyre, kFurrow
    uint32_t seed = 0;
    double strength = 1;  // of its marks; its life sets it
};
// Pieces of a track, which make up an even one when they lie half their length apart; it is kTrackWidth of a
// piece's length wide.
inline constexpr int kTyre = 2, kFurrow = 3;
inline constexpr double kTrackWidth = 0.37;
// A turned box, and the world rectangle around it: outside either a print changes nothing.
[[nodiscard]] std::array<glm::dvec2, 4> box_of(const Footprint& print);
[[nodiscard]] WorldRect bounds_of(const Footprint& print);

// Across what is drawn of it, at its narrowest: it fades where that is less than a texel.
[[nodiscard]] double size_m(const Crater& crater);
[[nodiscard]] double size_m(const Footprint& print);
[[nodiscard]] double size_m(const TerrainDecal& decal);
[[nodiscard]] double size_m(const SplineDecal& spline);
[[nodiscard]] double size_m(const VolumeDecal& volume);
[[nodiscard]] double size_m(const Stamp& stamp);  // 0: it draws nothing
[[nodiscard]] double size_m(const Cutout& cutout);
[[nodiscard]] double size_m(const Slide& slide);
[[nodiscard]] double size_m(const Flood& flood);
[[nodiscard]] double size_m(const Event& event);

// What is drawn of a flood: the ground below its level, glossy.
[[nodiscard]] VolumeDecal surface_of(const Flood& flood);
inline constexpr double kFloodShore_m = 0.4;  // over which its wetness fades below the level

using OperatorShape = std::variant<Crater, Footprint, TerrainDecal, SplineDecal, VolumeDecal, Stamp, Cutout,
                                   Slide, Flood, Event>;
// What is shown in a state of its life. Cutouts have no half measures: they are there or not.
[[nodiscard]] OperatorShape shape_in(const OperatorShape& shape, const LifeState& state);
[[nodiscard]] const DecalMaterial* material_of(const OperatorShape& shape);  // null: has none

struct Operator {
    uint64_t id = 0;     // unique in the document, never reused
    uint64_t order = 0;  // evaluated in ascending (order, id)
    bool enabled = true;
    OperatorShape shape;
    Life life;
    uint32_t part = 0;  // of an event, in order of evaluation; 0: an operator of its own

    // The world rectangle outside which the operator changes nothing in that map; empty where it does not
    // touch it.
    [[nodiscard]] WorldRect height_bounds() const;
    [[nodiscard]] WorldRect index_bounds() const;
    [[nodiscard]] WorldRect texture_bounds() const;
    // The same as rectangles that together hold all of it: a spline's lie along it, the rest have one or
    // none.
    [[nodiscard]] std::vector<WorldRect> height_rects() const;
    [[nodiscard]] std::vector<WorldRect> index_rects() const;
    [[nodiscard]] std::vector<WorldRect> texture_rects() const;
    [[nodiscard]] std::vector<WorldRect> cutout_rects() const;
    // Of what is drawn into the texture: from texels twice as wide on none of it shows. 0: draws nothing.
    [[nodiscard]] double texture_size_m() const;
    // Of all maps and, of an event, of all its parts at any time.
    [[nodiscard]] WorldRect extent() const;
};
// Ascending (order, id, part).
[[nodiscard]] bool evaluated_before(const Operator& a, const Operator& b);

// Works out what is kept beside an operator's parameters (a spline's path, a hull's planes). Every operator
// of a document has been through it.
void prepare(Operator& op);

// A grid of samples to change in place: sample (i, j) is at (x0 + i*step, y0 + j*step) metres.
template <typename T>
struct SampleGrid {
    T* data = nullptr;
    int width = 0, height = 0, stride = 0;
    double x0_m = 0, y0_m = 0, step_m = 1;
    [[nodiscard]] T& at(int i, int j) const { return data[j * stride + i]; }
};

struct ResolvedRoles {  // LayerRoles as indices
    uint16_t scorched = 0, broken = 0;
};

// Footprints change heights and are drawn into the texture; craters change heights, layers and tint, and may
// be drawn too; splines are drawn and may carve heights; terrain decals are drawn and may displace them;
// volume decals are drawn; stamps change heights, layers and tint; cutouts cut (maps/cutout_map.h); slides
// change heights and layers; floods change layers and tint and are drawn; an event does nothing itself, its
// parts do. The mathematics of craters and footprints is in shaders/document/crater_math.h and
// footprint_math.h, for shaders as well.
//
// Heights in metres. A sample's result depends on the sample's position only, never on the grid it is part
// of: pages of every level must agree.
void apply_height(const Operator& op, const SampleGrid<double>& heights_m);
// `ground_m`: the composed heights at the texels, which floods ask for; empty where there is none over them.
void apply_index(const Operator& op, const ResolvedRoles& roles, const SampleGrid<IndexTexel>& texels,
                 std::span<const double> ground_m);

}  // namespace loam
