#include "runtime/document/operator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "runtime/base/check.h"
#include "runtime/base/ramp.h"
#include "runtime/document/spline_path.h"
#include "shaders/document/crater_math.h"
#include "shaders/document/footprint_math.h"
#include "shaders/document/noise_math.h"

namespace loam {

static_assert(kTyre == kFootTyre && kFurrow == kFootFurrow);

namespace {

using glm::vec2;

WorldRect around(double x_m, double y_m, double half_x_m, double half_y_m) {
    return {x_m - half_x_m, y_m - half_y_m, x_m + half_x_m, y_m + half_y_m};
}

WorldRect square(double x_m, double y_m, double half_m) {
    return around(x_m, y_m, half_m, half_m);
}

// Grids of different pages reach one place by different sums: their positions may differ in the last bit.
// Rounded to 2^-20 m they are equal. Adding and taking away 1.5 * 2^32 rounds a double to just that step.
double settled(double metres) {
    constexpr double kRound = 6442450944.0;
    return (metres + kRound) - kRound;
}

// Samples of a grid that lie in a rectangle: half open index ranges.
struct GridRange {
    int i0, j0, i1, j1;
};
template <typename T>
GridRange samples_in(const SampleGrid<T>& grid, const WorldRect& rect) {
    const auto first = [&](double low, double origin, int count) {
        return int(std::clamp(std::ceil((low - origin) / grid.step_m - 1e-6), 0.0, double(count)));
    };
    const auto end = [&](double high, double origin, int count) {
        return int(std::clamp(std::floor((high - origin) / grid.step_m + 1e-6) + 1, 0.0, double(count)));
    };
    return {first(rect.min_x, grid.x0_m, grid.width), first(rect.min_y, grid.y0_m, grid.height),
            end(rect.max_x, grid.x0_m, grid.width), end(rect.max_y, grid.y0_m, grid.height)};
}

// Calls visit(sample, offset of its position from the centre in metres) for the samples in the rectangle.
template <typename T, typename Visit>
void for_each_sample(const SampleGrid<T>& grid, const WorldRect& rect, double x_m, double y_m,
                     Visit&& visit) {
    const GridRange range = samples_in(grid, rect);
    for (int j = range.j0; j < range.j1; ++j) {
        const double dy = settled(grid.y0_m + j * grid.step_m) - y_m;
        for (int i = range.i0; i < range.i1; ++i)
            visit(grid.at(i, j), settled(grid.x0_m + i * grid.step_m) - x_m, dy);
    }
}

// Of a box turned by a heading.
WorldRect turned_box(double x_m, double y_m, glm::dvec2 half_m, double heading_rad) {
    const double c = std::abs(std::cos(heading_rad)), s = std::abs(std::sin(heading_rad));
    return around(x_m, y_m, c * half_m.x + s * half_m.y, s * half_m.x + c * half_m.y);
}

double depth_of(const Crater& crater) {
    return crater.depth_m > 0 ? crater.depth_m : crater.radius_m * 0.4;
}

uint8_t scaled(uint8_t value, float factor) {
    return uint8_t(float(value) * factor + 0.5f);
}

void apply_crater_height(const Crater& crater, const WorldRect& rect, const SampleGrid<double>& heights) {
    const float depth = float(depth_of(crater) / crater.radius_m);
    for_each_sample(heights, rect, crater.x_m, crater.y_m, [&](double& height, double dx, double dy) {
        const vec2 local(float(dx / crater.radius_m), float(dy / crater.radius_m));
        height +=
            crater.radius_m * double(shared::crater_height(local, depth, crater.seed, float(crater.age)));
    });
}

void apply_footprint_height(const Footprint& print, const WorldRect& rect,
                            const SampleGrid<double>& heights) {
    const vec2 heading(float(std::sin(print.heading_rad)), float(std::cos(print.heading_rad)));
    for_each_sample(heights, rect, print.x_m, print.y_m, [&](double& height, double dx, double dy) {
        const vec2 offset(float(dx / print.length_m), float(dy / print.length_m));
        const vec2 local = shared::footprint_local(offset, heading);
        height += print.depth_m * double(shared::footprint_height(local, print.foot, print.seed));
    });
}

const SplinePath& path_of(const SplineDecal& spline) {
    LOAM_CHECK(spline.path, "an operator of a document has been prepared");
    return *spline.path;
}

double carve_reach_m(const SplineDecal& spline) {
    return path_of(spline).half_width_m() + spline.shoulder_m;
}

// The nearest segment to each sample decides. Which others are looked at makes no difference: one that may be
// the nearest within reach is always among them, and of equally near ones the first counts.
void apply_carve(const SplineDecal& spline, const SampleGrid<double>& heights) {
    const SplinePath& path = path_of(spline);
    const double reach_m = carve_reach_m(spline);
    struct Nearest {
        double squared_m = INFINITY, along_m = 0, across_m = 0;  // to the right
        uint32_t segment = 0;
    };
    thread_local std::vector<Nearest> nearest;
    nearest.clear();
    const WorldRect grid{heights.x0_m, heights.y0_m, heights.x0_m + (heights.width - 1) * heights.step_m,
                         heights.y0_m + (heights.height - 1) * heights.step_m};
    for (const SplinePiece& piece : path.pieces()) {
        if (!piece.line.grown(reach_m).overlaps(grid.grown(heights.step_m))) continue;
        if (nearest.empty()) nearest.resize(size_t(heights.width) * size_t(heights.height));
        for (uint32_t k = piece.first; k < piece.first + piece.count; ++k) {
            const SplineSegment& s = path.segments()[k];
            const glm::dvec2 to = s.from_m + s.direction * s.length_m;
            const WorldRect box{std::min(s.from_m.x, to.x), std::min(s.from_m.y, to.y),
                                std::max(s.from_m.x, to.x), std::max(s.from_m.y, to.y)};
            const GridRange range = samples_in(heights, box.grown(reach_m));
            for (int j = range.j0; j < range.j1; ++j)
                for (int i = range.i0; i < range.i1; ++i) {
                    const double dx = settled(heights.x0_m + i * heights.step_m) - s.from_m.x;
                    const double dy = settled(heights.y0_m + j * heights.step_m) - s.from_m.y;
                    const double along = std::clamp(dx * s.direction.x + dy * s.direction.y, 0.0, s.length_m);
                    const double ax = dx - along * s.direction.x, ay = dy - along * s.direction.y;
                    const double squared = ax * ax + ay * ay;
                    Nearest& n = nearest[size_t(j) * size_t(heights.width) + size_t(i)];
                    if (squared < n.squared_m)
                        n = {squared, along, dx * s.direction.y - dy * s.direction.x, k};
                }
        }
    }
    if (nearest.empty()) return;
    for (int j = 0; j < heights.height; ++j)
        for (int i = 0; i < heights.width; ++i) {
            const Nearest& n = nearest[size_t(j) * size_t(heights.width) + size_t(i)];
            if (!(n.squared_m < reach_m * reach_m)) continue;
            const SplineSegment& s = path.segments()[n.segment];
            const double share = n.along_m / s.length_m, at_m = s.start_m + n.along_m;
            const double half_m = s.half_from_m + share * (s.half_to_m - s.half_from_m);
            const double beyond_m = std::sqrt(n.squared_m) - half_m;
            double weight = spline.carve;
            if (beyond_m > 0)
                weight *= spline.shoulder_m > 0 ? 1.0 - ramp(beyond_m / spline.shoulder_m) : 0.0;
            if (spline.fade_m > 0)
                weight *= ramp(at_m / spline.fade_m) * ramp((path.length_m() - at_m) / spline.fade_m);
            // The shoulders go on from the edges.
            const double bank = s.bank_from + share * (s.bank_to - s.bank_from);
            const double profile_m =
                s.z_from_m + share * (s.z_to_m - s.z_from_m) - bank * std::clamp(n.across_m, -half_m, half_m);
            double& height = heights.at(i, j);
            height += weight * (profile_m - height);
        }
}

// World rectangles around a spline's pieces.
std::vector<WorldRect> rects_along(const SplineDecal& spline, double reach_m) {
    std::vector<WorldRect> rects;
    for (const SplinePiece& piece : path_of(spline).pieces()) rects.push_back(piece.line.grown(reach_m));
    return rects;
}

WorldRect all_of(const std::vector<WorldRect>& rects) {
    WorldRect all;
    for (const WorldRect& rect : rects) all = united(all, rect);
    return all;
}

WorldRect box_of(const TerrainDecal& decal) {
    return turned_box(decal.x_m, decal.y_m, glm::abs(decal.half_m), decal.heading_rad);
}

// As paint_outline and paint_edge of shaders/texture/paint_shade.glsl have it for texels that are fine
// enough.
double cover_of(const TerrainDecal& decal, glm::dvec2 local_m) {
    const glm::dvec2 half_m = glm::abs(decal.half_m), share = glm::abs(local_m) / half_m;
    const double smaller_m = std::min(half_m.x, half_m.y);
    const glm::dvec2 beside_m = (1.0 - share) * half_m;
    const double inside_m = decal.outline == DecalOutline::ellipse ? (1 - glm::length(share)) * smaller_m
                                                                   : std::min(beside_m.x, beside_m.y);
    if (inside_m <= 0) return 0;
    const DecalMaterial& m = decal.material;
    double eaten_m = inside_m;
    if (m.rough > 0) {
        const vec2 q(local_m / smaller_m);
        const float uneven = 0.65f * shared::noise_value(q * 2.0f, shared::noise_hash(m.seed + 61u)) +
                             0.35f * shared::noise_value(q * 8.0f, shared::noise_hash(m.seed + 62u));
        eaten_m -= m.rough * smaller_m * (0.3 + 0.3 * double(uneven));
    }
    if (eaten_m <= 0) return 0;
    const double soft_m = m.edge * smaller_m;
    return eaten_m >= soft_m ? 1 : ramp(eaten_m / soft_m);
}

void apply_decal_height(const TerrainDecal& decal, const SampleGrid<double>& heights_m) {
    const double s = std::sin(decal.heading_rad), c = std::cos(decal.heading_rad);
    const glm::dvec2 sign(decal.half_m.x < 0 ? -1 : 1, decal.half_m.y < 0 ? -1 : 1);
    for_each_sample(heights_m, box_of(decal), decal.x_m, decal.y_m,
                    [&](double& height, double dx, double dy) {
                        const glm::dvec2 local_m = sign * glm::dvec2(c * dx - s * dy, s * dx + c * dy);
                        height += decal.displacement_m * cover_of(decal, local_m);
                    });
}

WorldRect box_of(const Stamp& stamp) {
    return turned_box(stamp.x_m, stamp.y_m, glm::abs(stamp.half_m), stamp.heading_rad);
}

void apply_crater_index(const Crater& crater, const WorldRect& rect, const ResolvedRoles& roles,
                        const SampleGrid<IndexTexel>& texels) {
    for_each_sample(texels, rect, crater.x_m, crater.y_m, [&](IndexTexel& texel, double dx, double dy) {
        const vec2 local(float(dx / crater.radius_m), float(dy / crater.radius_m));
        const float age = float(crater.age), strength = float(crater.strength);
        // A layer has no half measures: it comes with half of the crater.
        const int zone = strength < 0.5f ? 0 : shared::crater_zone(local, crater.seed, age);
        if (zone != 0) texel.layer = zone == 1 ? roles.scorched : roles.broken;
        const float factor = (1.0f - 0.62f * strength * shared::crater_scorch(local, crater.seed, age)) *
                             (1.0f - 0.3f * strength * shared::crater_rays(local, crater.seed, age));
        for (uint8_t& channel : texel.tint) channel = scaled(channel, factor);
    });
}

// A layer has no half measures: it is laid where the stamp counts by half or more.
void apply_stamp_index(const Stamp& stamp, const WorldRect& rect, const SampleGrid<IndexTexel>& texels) {
    const StampSampler at(stamp);
    for_each_sample(texels, rect, stamp.x_m, stamp.y_m, [&](IndexTexel& texel, double dx, double dy) {
        const StampSample sample = at(dx, dy);
        if (!stamp.layer.empty() && sample.weight >= 0.5 && sample.height >= stamp.layer_from)
            texel.layer = stamp.layer_number;
        for (size_t channel = 0; channel < 3; ++channel) {
            const double factor = 1 + sample.weight * (sample.color[int(channel)] - 1);
            texel.tint[channel] = scaled(texel.tint[channel], float(factor));
        }
    });
}

WorldRect disc_rect(glm::dvec2 at_m, double radius_m) {
    return square(at_m.x, at_m.y, radius_m);
}

// Calls visit(sample, share of the hollow's or heap's height there) within a disc.
template <typename T, typename Visit>
void for_each_in_lump(const SampleGrid<T>& grid, glm::dvec2 at_m, double radius_m, Visit&& visit) {
    for_each_sample(grid, disc_rect(at_m, radius_m), at_m.x, at_m.y, [&](T& sample, double dx, double dy) {
        const double rest = 1 - (dx * dx + dy * dy) / (radius_m * radius_m);
        if (rest > 0) visit(sample, rest * rest * rest);
    });
}

double lump_height_m(double volume_m3, double radius_m) {
    return 4 * volume_m3 / (std::numbers::pi * radius_m * radius_m);
}

bool changes_anything(const Slide& slide) {
    return slide.way > 0 && slide.volume_m3 > 0;
}

void apply_slide_height(const Slide& slide, const SampleGrid<double>& heights_m) {
    const auto lay = [&](glm::dvec2 at_m, double radius_m, double volume_m3) {
        const double high_m = lump_height_m(volume_m3, radius_m);
        for_each_in_lump(heights_m, at_m, radius_m,
                         [&](double& height, double share) { height += high_m * share; });
    };
    lay({slide.x_m, slide.y_m}, slide.radius_m, -slide.volume_m3);
    lay(place_of(slide), radius_of(slide), slide.volume_m3);
}

// Bare where more than a tenth of the lump's height went or came.
void apply_slide_index(const Slide& slide, const ResolvedRoles& roles, const SampleGrid<IndexTexel>& texels) {
    const auto lay = [&](glm::dvec2 at_m, double radius_m) {
        for_each_in_lump(texels, at_m, radius_m, [&](IndexTexel& texel, double share) {
            if (share > 0.1) texel.layer = roles.broken;
        });
    };
    lay({slide.x_m, slide.y_m}, slide.radius_m);
    lay(place_of(slide), radius_of(slide));
}

void apply_flood_index(const Flood& flood, const SampleGrid<IndexTexel>& texels,
                       std::span<const double> ground_m) {
    LOAM_CHECK(ground_m.size() == size_t(texels.width) * size_t(texels.height),
               "a flood needs the ground under the texels");
    const double level_m = height_of(flood);
    for_each_sample(
        texels, bounds_of(flood), flood.x_m, flood.y_m, [&](IndexTexel& texel, double dx, double dy) {
            const ptrdiff_t at = &texel - texels.data;
            const double below_m =
                level_m - ground_m[size_t(at / texels.stride * texels.width + at % texels.stride)];
            if (below_m <= 0 || dx * dx + dy * dy > flood.radius_m * flood.radius_m) return;
            if (!flood.layer.empty()) texel.layer = flood.layer_number;
            const float factor = float(1 - 0.35 * ramp(std::min(below_m / kFloodShore_m, 1.0)));
            for (uint8_t& channel : texel.tint) channel = scaled(channel, factor);
        });
}

// What an operator does to each map, a set of overloads a kind.
struct HeightRects {
    using Rects = std::vector<WorldRect>;
    Rects operator()(const Crater& c) const {
        return {square(c.x_m, c.y_m, c.radius_m * double(kCraterHeightReach))};
    }
    Rects operator()(const Footprint& f) const { return {bounds_of(f)}; }
    Rects operator()(const SplineDecal& s) const {
        return s.carve > 0 ? rects_along(s, carve_reach_m(s)) : Rects{};
    }
    Rects operator()(const TerrainDecal& d) const {
        return d.displacement_m != 0 ? Rects{box_of(d)} : Rects{};
    }
    Rects operator()(const VolumeDecal&) const { return {}; }
    Rects operator()(const Stamp& s) const { return changes_heights(s) ? Rects{box_of(s)} : Rects{}; }
    Rects operator()(const Cutout&) const { return {}; }
    Rects operator()(const Slide& s) const {
        return changes_anything(s) ? Rects{hollow_of(s), heap_of(s)} : Rects{};
    }
    Rects operator()(const Flood&) const { return {}; }
    Rects operator()(const Event&) const { return {}; }
};

struct IndexRects {
    using Rects = std::vector<WorldRect>;
    Rects operator()(const Crater& c) const {
        return {square(c.x_m, c.y_m, c.radius_m * double(kCraterMarkReach))};
    }
    Rects operator()(const Stamp& s) const { return changes_index(s) ? Rects{box_of(s)} : Rects{}; }
    Rects operator()(const Slide& s) const { return HeightRects{}(s); }
    Rects operator()(const Flood& f) const { return {bounds_of(f)}; }
    template <typename Other>
    Rects operator()(const Other&) const {
        return {};
    }
};

struct TextureRects {
    using Rects = std::vector<WorldRect>;
    Rects operator()(const Crater& c) const {
        return {square(c.x_m, c.y_m, c.radius_m * double(kCraterMarkReach))};
    }
    Rects operator()(const Footprint& f) const { return {bounds_of(f)}; }
    Rects operator()(const SplineDecal& s) const { return rects_along(s, path_of(s).half_width_m()); }
    Rects operator()(const TerrainDecal& d) const { return {box_of(d)}; }
    Rects operator()(const VolumeDecal& v) const {
        const VolumeAxes axes = axes_of(v);
        const glm::dvec3 half =
            glm::abs(axes.x * v.half_m.x) + glm::abs(axes.y * v.half_m.y) + glm::abs(axes.z * v.half_m.z);
        return {around(v.center_m.x, v.center_m.y, half.x, half.y)};
    }
    Rects operator()(const Stamp&) const { return {}; }
    Rects operator()(const Cutout&) const { return {}; }
    Rects operator()(const Slide&) const { return {}; }
    Rects operator()(const Flood& f) const { return {bounds_of(f)}; }
    Rects operator()(const Event&) const { return {}; }
};

struct ApplyHeight {
    const SampleGrid<double>& heights_m;
    void operator()(const Crater& c) const { apply_crater_height(c, HeightRects{}(c)[0], heights_m); }
    void operator()(const Footprint& f) const { apply_footprint_height(f, HeightRects{}(f)[0], heights_m); }
    void operator()(const SplineDecal& s) const {
        if (s.carve > 0) apply_carve(s, heights_m);
    }
    void operator()(const TerrainDecal& d) const {
        if (d.displacement_m != 0) apply_decal_height(d, heights_m);
    }
    void operator()(const VolumeDecal&) const {}
    void operator()(const Cutout&) const {}
    void operator()(const Flood&) const {}
    void operator()(const Event&) const {}
    void operator()(const Slide& s) const {
        if (changes_anything(s)) apply_slide_height(s, heights_m);
    }
    void operator()(const Stamp& s) const {
        if (!changes_heights(s)) return;
        const StampSampler at(s);
        for_each_sample(heights_m, box_of(s), s.x_m, s.y_m,
                        [&](double& height, double dx, double dy) { height = at.stamped_m(height, dx, dy); });
    }
};

// An operator's shape in a state of its life, a call a kind.
struct InState {
    const LifeState& state;
    void operator()(Crater& c) const {
        if (state.strength != 1) c.depth_m = depth_of(c) * state.strength;
        c.heat *= state.heat * state.strength;
        c.age = 1 - (1 - c.age) * (1 - state.age);
        c.strength *= state.strength;
    }
    void operator()(Footprint& f) const {
        f.depth_m *= state.strength;
        f.strength *= state.strength;
    }
    void operator()(TerrainDecal& d) const {
        d.material.opacity *= state.strength;
        d.displacement_m *= state.strength;
    }
    void operator()(SplineDecal& s) const {
        s.material.opacity *= state.strength;
        s.carve *= state.strength;
    }
    void operator()(VolumeDecal& v) const { v.material.opacity *= state.strength; }
    void operator()(Stamp& s) const { s.strength *= state.strength; }
    void operator()(Slide& s) const { s.way *= state.strength; }
    void operator()(Flood& f) const { f.way *= state.strength; }
    void operator()(Cutout&) const {}
    void operator()(Event&) const {}
};

}  // namespace

OperatorShape shape_in(const OperatorShape& shape, const LifeState& state) {
    OperatorShape shown = shape;
    std::visit(InState{state}, shown);
    return shown;
}

glm::dvec2 place_of(const Slide& slide) {
    const glm::dvec2 from(slide.x_m, slide.y_m);
    return from + (slide.to_m - from) * ramp(slide.way);
}
double radius_of(const Slide& slide) {
    return slide.radius_m + (slide.to_radius_m - slide.radius_m) * ramp(slide.way);
}
WorldRect hollow_of(const Slide& slide) {
    return square(slide.x_m, slide.y_m, slide.radius_m);
}
WorldRect heap_of(const Slide& slide) {
    return disc_rect(place_of(slide), radius_of(slide));
}

double height_of(const Flood& flood) {
    return flood.from_m + (flood.level_m - flood.from_m) * flood.way;
}
WorldRect bounds_of(const Flood& flood) {
    return square(flood.x_m, flood.y_m, flood.radius_m);
}
VolumeDecal surface_of(const Flood& flood) {
    constexpr double kDeep_m = 500;
    VolumeDecal volume;
    volume.center_m = {flood.x_m, flood.y_m, height_of(flood) - kDeep_m};
    volume.half_m = {flood.radius_m, flood.radius_m, kDeep_m};
    volume.deep_edge = kFloodShore_m / kDeep_m;
    volume.outline = DecalOutline::ellipse;
    volume.material = {.colour = {0.3, 0.31, 0.29}, .gloss = 0.85, .opacity = 0.5, .edge = 0};
    volume.material.channels.normal = 0.7;
    return volume;
}

const DecalMaterial* material_of(const OperatorShape& shape) {
    if (const auto* decal = std::get_if<TerrainDecal>(&shape)) return &decal->material;
    if (const auto* spline = std::get_if<SplineDecal>(&shape)) return &spline->material;
    if (const auto* volume = std::get_if<VolumeDecal>(&shape)) return &volume->material;
    return nullptr;
}

VolumeAxes axes_of(const glm::dvec3& direction, double roll_rad) {
    const glm::dvec3 z = -glm::normalize(direction);
    const double level = std::hypot(z.x, z.y);
    const glm::dvec3 x = level > 1e-9 ? glm::dvec3(-z.y / level, z.x / level, 0) : glm::dvec3(1, 0, 0);
    const glm::dvec3 y = glm::cross(z, x);
    const double c = std::cos(roll_rad), s = std::sin(roll_rad);
    return {x * c + y * s, y * c - x * s, z};
}

std::array<glm::dvec2, 4> box_of(const Footprint& print) {
    const double s = std::sin(print.heading_rad), c = std::cos(print.heading_rad);
    const glm::dvec2 at(print.x_m, print.y_m);
    const glm::dvec2 right = glm::dvec2(c, -s) * (print.length_m * double(kFootprintHalfWidth));
    const glm::dvec2 ahead = glm::dvec2(s, c) * (print.length_m * double(kFootprintHalfLength));
    return {at - right - ahead, at + right - ahead, at + right + ahead, at - right + ahead};
}

WorldRect bounds_of(const Footprint& print) {
    WorldRect bounds;
    for (const glm::dvec2& corner : box_of(print))
        bounds = united(bounds, {corner.x, corner.y, corner.x, corner.y});
    return bounds;
}

double size_m(const Crater& crater) {
    return 2 * crater.radius_m;
}
double size_m(const Footprint& print) {
    return 0.6 * print.length_m;
}
double size_m(const TerrainDecal& decal) {
    return 2 * std::min(std::abs(decal.half_m.x), std::abs(decal.half_m.y));
}
double size_m(const SplineDecal& spline) {
    return 2 * path_of(spline).half_width_m();
}
double size_m(const VolumeDecal& volume) {
    return 2 * std::min(std::abs(volume.half_m.x), std::abs(volume.half_m.y));
}
double size_m(const Stamp&) {
    return 0;
}
double size_m(const Cutout&) {
    return 0;
}
double size_m(const Slide&) {
    return 0;
}
double size_m(const Flood& flood) {
    return 2 * flood.radius_m;
}
double size_m(const Event&) {
    return 0;
}

void prepare(Operator& op) {
    if (auto* spline = std::get_if<SplineDecal>(&op.shape))
        spline->path = std::make_shared<SplinePath>(spline->points);
    if (auto* cutout = std::get_if<Cutout>(&op.shape); cutout && cutout->form == CutoutForm::convex) {
        auto planes = hull_planes(cutout->corners);
        LOAM_CHECK(planes.ok(), "a command was checked before its operator is prepared");
        cutout->planes = std::make_shared<const std::vector<glm::dvec4>>(std::move(*planes));
    }
}

std::vector<WorldRect> Operator::height_rects() const {
    return std::visit(HeightRects{}, shape);
}

std::vector<WorldRect> Operator::texture_rects() const {
    return std::visit(TextureRects{}, shape);
}

WorldRect Operator::height_bounds() const {
    return all_of(height_rects());
}

std::vector<WorldRect> Operator::index_rects() const {
    return std::visit(IndexRects{}, shape);
}

WorldRect Operator::index_bounds() const {
    return all_of(index_rects());
}

std::vector<WorldRect> Operator::cutout_rects() const {
    const auto* cutout = std::get_if<Cutout>(&shape);
    return cutout ? rects_of(*cutout) : std::vector<WorldRect>();
}

WorldRect Operator::texture_bounds() const {
    return all_of(texture_rects());
}

double Operator::texture_size_m() const {
    return std::visit([](const auto& kind) { return size_m(kind); }, shape);
}

void apply_height(const Operator& op, const SampleGrid<double>& heights_m) {
    std::visit(ApplyHeight{heights_m}, op.shape);
}

void apply_index(const Operator& op, const ResolvedRoles& roles, const SampleGrid<IndexTexel>& texels,
                 std::span<const double> ground_m) {
    if (const auto* crater = std::get_if<Crater>(&op.shape))
        apply_crater_index(*crater, op.index_bounds(), roles, texels);
    if (const auto* stamp = std::get_if<Stamp>(&op.shape); stamp && changes_index(*stamp))
        apply_stamp_index(*stamp, op.index_bounds(), texels);
    if (const auto* slide = std::get_if<Slide>(&op.shape); slide && changes_anything(*slide))
        apply_slide_index(*slide, roles, texels);
    if (const auto* flood = std::get_if<Flood>(&op.shape)) apply_flood_index(*flood, texels, ground_m);
}

WorldRect Operator::extent() const {
    if (std::holds_alternative<Event>(shape)) {
        WorldRect all;
        for (const Operator& each : parts_of(*this)) all = united(all, each.extent());
        return all;
    }
    return united(united(height_bounds(), index_bounds()), united(texture_bounds(), all_of(cutout_rects())));
}

bool evaluated_before(const Operator& a, const Operator& b) {
    return std::tie(a.order, a.id, a.part) < std::tie(b.order, b.id, b.part);
}

}  // namespace loam
