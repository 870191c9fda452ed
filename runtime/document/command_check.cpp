// The ranges of commands, for those from JSON and those made in C++ alike.
#include <cmath>

#include <glm/geometric.hpp>

#include "runtime/base/units.h"
#include "runtime/document/command.h"
#include "runtime/document/decal_function.h"
#include "runtime/document/stamp_library.h"

namespace loam {

namespace {

constexpr double kFarthest_m = 1.0e6;  // of any coordinate; the map may be left, not the world
constexpr double kLongestTime_s = 1.0e9;
constexpr size_t kMaxDabs = 100'000, kMaxPrints = 100'000;
constexpr size_t kMaxControlPoints = 10'000;
constexpr double kHighest_m = 20'000, kSmallestHalf_m = 0.01, kLargestHalf_m = 5000,
                 kLongestSpline_m = 200'000;
constexpr double kRightAngle_rad = 1.5707963267948966;

Status in_range(std::string_view name, double value, double low, double high) {
    if (std::isfinite(value) && value >= low && value <= high) return {};
    return error("{} is {}, must be {} … {}", name, value, low, high);
}

Status place_ok(std::string_view name, double x_m, double y_m) {
    if (std::isfinite(x_m) && std::isfinite(y_m) && std::abs(x_m) <= kFarthest_m &&
        std::abs(y_m) <= kFarthest_m)
        return {};
    return error("{} is at ({}, {}), coordinates must be numbers within ±{} m", name, x_m, y_m, kFarthest_m);
}

Status dabs_ok(const std::vector<glm::dvec2>& dabs) {
    if (dabs.size() > kMaxDabs) return error("{} dabs, the limit is {} a command", dabs.size(), kMaxDabs);
    for (size_t i = 0; i < dabs.size(); ++i)
        LOAM_TRY(place_ok(fmt::format("dab {}", i), dabs[i].x, dabs[i].y));
    return {};
}

Status check(const SculptCommand& c) {
    LOAM_TRY(dabs_ok(c.dabs));
    LOAM_TRY(in_range("radius_m", c.radius_m, 0.01, 5000));
    LOAM_TRY(in_range("hardness", c.hardness, 0, 1));
    if (c.mode == SculptMode::raise || c.mode == SculptMode::lower)
        return in_range("strength_m", c.strength, 0, 32768);
    LOAM_TRY(
        in_range("target_m", c.target_m, -kHeightLimit_mm * kHeightStep_m, kHeightLimit_mm * kHeightStep_m));
    return in_range("strength", c.strength, 0, 1);
}

Status check(const GroundMask& mask) {
    LOAM_TRY(in_range("min_slope_rad", mask.min_slope_rad, 0, kRightAngle_rad + 1e-4));
    LOAM_TRY(in_range("max_slope_rad", mask.max_slope_rad, 0, kRightAngle_rad + 1e-4));
    constexpr double kHighest_m = GroundMask::kHighest_m;
    LOAM_TRY(in_range("min_height_m", mask.min_height_m, -kHighest_m, kHighest_m));
    LOAM_TRY(in_range("max_height_m", mask.max_height_m, -kHighest_m, kHighest_m));
    LOAM_TRY(in_range("noise", mask.noise, 0, 1));
    return in_range("noise_size_m", mask.noise_size_m, 0.5, 5000);
}

Status tint_ok(const std::optional<glm::dvec3>& tint) {
    for (int channel = 0; tint && channel < 3; ++channel) LOAM_TRY(in_range("tint", (*tint)[channel], 0, 1));
    return {};
}

Status check(const FillCommand& c) {
    if (!c.layer && !c.tint) return error("fill needs a layer or a tint");
    if (c.rect) {
        const WorldRect& r = *c.rect;
        if (!std::isfinite(r.min_x) || !std::isfinite(r.min_y) || !std::isfinite(r.max_x) ||
            !std::isfinite(r.max_y) || r.min_x >= r.max_x || r.min_y >= r.max_y)
            return error("fill: \"rect\" must be [x0, y0, x1, y1] with x0 < x1 and y0 < y1");
    }
    LOAM_TRY(in_range("strength", c.strength, 0, 1));
    LOAM_TRY(check(c.mask));
    return tint_ok(c.tint);
}

Status check(const PaintCommand& c) {
    LOAM_TRY(dabs_ok(c.dabs));
    if (!c.layer && !c.tint) return error("paint needs a layer or a tint");
    LOAM_TRY(in_range("radius_m", c.radius_m, 0.01, 5000));
    LOAM_TRY(in_range("strength", c.strength, 0, 1));
    LOAM_TRY(in_range("hardness", c.hardness, 0, 1));
    LOAM_TRY(check(c.mask));
    return tint_ok(c.tint);
}

Status check(const Crater& c) {
    LOAM_TRY(place_ok("the crater", c.x_m, c.y_m));
    LOAM_TRY(in_range("radius_m", c.radius_m, 0.1, 2000));
    LOAM_TRY(in_range("depth_m", c.depth_m, 0, 4000));
    LOAM_TRY(in_range("age", c.age, 0, 1));
    return in_range("heat", c.heat, 0, 1);
}

Status check(const Footprint& print) {
    LOAM_TRY(place_ok("a print", print.x_m, print.y_m));
    LOAM_TRY(in_range("heading_rad", print.heading_rad, -1000, 1000));
    LOAM_TRY(in_range("length_m", print.length_m, 0.05, 50));
    LOAM_TRY(in_range("depth_m", print.depth_m, 0, 10));
    if (print.foot < 0 || print.foot > kFurrow)
        return error("foot is {}, must be 0 (left), 1 (right), 2 (tyre) or 3 (furrow)", print.foot);
    return {};
}

Status check(const DecalMaterial& m) {
    for (int channel = 0; channel < 3; ++channel) LOAM_TRY(in_range("colour", m.colour[channel], 0, 1));
    const DecalChannels& c = m.channels;
    for (const auto& [name, value] : {std::pair("gloss", m.gloss),
                                      {"metalness", m.metalness},
                                      {"opacity", m.opacity},
                                      {"edge", m.edge},
                                      {"rough", m.rough},
                                      {"channel albedo", c.albedo},
                                      {"channel normal", c.normal},
                                      {"channel gloss", c.gloss},
                                      {"channel metalness", c.metalness},
                                      {"channel occlusion", c.occlusion}})
        LOAM_TRY(in_range(name, value, 0, 1));
    if (m.tile_m != 0) LOAM_TRY(in_range("tile_m", m.tile_m, 0.05, 5000));
    if (!m.function.empty()) LOAM_TRY(check_function_name(m.function));
    if (m.function.empty() && !m.parameters.empty()) return error("\"parameters\" need a \"function\"");
    if (m.parameters.size() > kMostFunctionParameters)
        return error("{} parameters of a function, the limit is {}", m.parameters.size(),
                     kMostFunctionParameters);
    for (const auto& [name, value] : m.parameters) LOAM_TRY(in_range(name, value, -1.0e6, 1.0e6));
    return {};
}

// Either sign; 0 is the singular case.
Status half_ok(double half_m, double low_m) {
    const Status status = in_range("half_m", std::abs(half_m), kSmallestHalf_m, kLargestHalf_m);
    if (status.ok() && half_m >= low_m) return {};
    return error("half_m is {}, must be {}{} … {} m", half_m, low_m < 0 ? "±" : "", kSmallestHalf_m,
                 kLargestHalf_m);
}

Status check(const TerrainDecal& d) {
    LOAM_TRY(place_ok("the decal", d.x_m, d.y_m));
    for (int axis = 0; axis < 2; ++axis) LOAM_TRY(half_ok(d.half_m[axis], -kLargestHalf_m));
    LOAM_TRY(in_range("heading_rad", d.heading_rad, -1000, 1000));
    LOAM_TRY(in_range("displacement_m", d.displacement_m, -50, 50));
    return check(d.material);
}

Status check_axes(std::string_view what, const glm::dvec3& center_m, const glm::dvec3& direction,
                  double roll_rad) {
    LOAM_TRY(place_ok(fmt::format("the {}", what), center_m.x, center_m.y));
    LOAM_TRY(in_range(fmt::format("the {}'s z", what), center_m.z, -kHighest_m, kHighest_m));
    for (int axis = 0; axis < 3; ++axis)
        LOAM_TRY(in_range("direction", direction[axis], -kFarthest_m, kFarthest_m));
    if (!(glm::dot(direction, direction) > 1e-12))
        return error("the direction of a {0} has no length, it must point where the {0} projects", what);
    return in_range("roll_rad", roll_rad, -1000, 1000);
}

Status check(const VolumeDecal& v) {
    LOAM_TRY(check_axes("volume", v.center_m, v.direction, v.roll_rad));
    for (int axis = 0; axis < 3; ++axis) LOAM_TRY(half_ok(v.half_m[axis], axis < 2 ? -kLargestHalf_m : 0));
    LOAM_TRY(in_range("deep_edge", v.deep_edge, 1e-4, 1));
    return check(v.material);
}

Status check(const SplineDecal& s) {
    if (s.points.size() < 4 || s.points.size() % 3 != 1)
        return error("a spline has {} control points, must be 4, 7, 10 … (three a piece and one)",
                     s.points.size());
    if (s.points.size() > kMaxControlPoints)
        return error("a spline has {} control points, the limit is {}", s.points.size(), kMaxControlPoints);
    double polygon_m = 0;
    for (size_t i = 0; i < s.points.size(); ++i) {
        const SplinePoint& p = s.points[i];
        LOAM_TRY(place_ok(fmt::format("control point {}", i), p.x_m, p.y_m));
        LOAM_TRY(in_range(fmt::format("z of control point {}", i), p.z_m, -kHighest_m, kHighest_m));
        LOAM_TRY(in_range(fmt::format("the width at control point {}", i), p.width_m, 0.02, 1000));
        LOAM_TRY(in_range(fmt::format("the roll at control point {}", i), p.roll_rad, -1.2, 1.2));
        if (i > 0) polygon_m += std::hypot(p.x_m - s.points[i - 1].x_m, p.y_m - s.points[i - 1].y_m);
    }
    if (polygon_m < 0.01) return error("the control points of a spline all lie at one place");
    if (polygon_m > kLongestSpline_m)
        return error("the control points of a spline span {:.0f} m, the limit is {} m", polygon_m,
                     kLongestSpline_m);
    LOAM_TRY(in_range("fade_m", s.fade_m, 0, 10'000));
    LOAM_TRY(in_range("carve", s.carve, 0, 1));
    LOAM_TRY(in_range("shoulder_m", s.shoulder_m, 0, 1000));
    return check(s.material);
}

Status check(const Stamp& s) {
    LOAM_TRY(check_stamp_name(s.image));
    LOAM_TRY(place_ok("the stamp", s.x_m, s.y_m));
    for (int axis = 0; axis < 2; ++axis) LOAM_TRY(half_ok(s.half_m[axis], -kLargestHalf_m));
    LOAM_TRY(in_range("heading_rad", s.heading_rad, -1000, 1000));
    LOAM_TRY(in_range("height_m", s.height_m, -kHighest_m, kHighest_m));
    LOAM_TRY(in_range("base_m", s.base_m, -kHighest_m, kHighest_m));
    LOAM_TRY(in_range("strength", s.strength, 0, 1));
    LOAM_TRY(in_range("edge", s.edge, 0, 1));
    return in_range("layer_from", s.layer_from, 0, 1);
}

Status check(const Cutout& c) {
    if (c.form == CutoutForm::brush) {
        LOAM_TRY(dabs_ok(c.dabs));
        return in_range("radius_m", c.radius_m, 0.01, kLargestHalf_m);
    }
    if (c.form == CutoutForm::convex) {
        if (c.corners.size() < 4 || c.corners.size() > kMaxCutoutCorners)
            return error("a convex cutout has {} corners, must be 4 … {}", c.corners.size(),
                         kMaxCutoutCorners);
        for (size_t i = 0; i < c.corners.size(); ++i) {
            LOAM_TRY(place_ok(fmt::format("corner {}", i), c.corners[i].x, c.corners[i].y));
            LOAM_TRY(in_range(fmt::format("z of corner {}", i), c.corners[i].z, -kHighest_m, kHighest_m));
        }
        const auto planes = hull_planes(c.corners);
        return planes.ok() ? Status() : planes.error();
    }
    for (int axis = 0; axis < 3; ++axis) LOAM_TRY(half_ok(c.half_m[axis], 0));
    return check_axes("cutout", c.center_m, c.direction, c.roll_rad);
}

Status check(const Slide& s) {
    LOAM_TRY(place_ok("the slide", s.x_m, s.y_m));
    LOAM_TRY(place_ok("the slide's end", s.to_m.x, s.to_m.y));
    LOAM_TRY(in_range("radius_m", s.radius_m, 0.1, 2000));
    LOAM_TRY(in_range("to_radius_m", s.to_radius_m, 0.1, 2000));
    LOAM_TRY(in_range("volume_m3", s.volume_m3, 0, 1e9));
    return in_range("way", s.way, 0, 1);
}

Status check(const Flood& f) {
    LOAM_TRY(place_ok("the flood", f.x_m, f.y_m));
    LOAM_TRY(in_range("radius_m", f.radius_m, 1, kLargestHalf_m));
    LOAM_TRY(in_range("level_m", f.level_m, -kHighest_m, kHighest_m));
    LOAM_TRY(in_range("from_m", f.from_m, -kHighest_m, kHighest_m));
    return in_range("way", f.way, 0, 1);
}

Status check(const Event& e) {
    LOAM_TRY(place_ok("the event", e.x_m, e.y_m));
    if (e.to_m) LOAM_TRY(place_ok("the event's end", e.to_m->x, e.to_m->y));
    const double length_m = e.to_m ? std::hypot(e.to_m->x - e.x_m, e.to_m->y - e.y_m) : 0;
    LOAM_TRY(in_range("start_s", e.start_s, -kLongestTime_s, kLongestTime_s));
    LOAM_TRY(in_range("duration_s", e.duration_s, 0, kLongestTime_s));
    LOAM_TRY(in_range("cool_s", e.cool_s, 0, kLongestTime_s));
    LOAM_TRY(in_range("weather_s", e.weather_s, 0, kLongestTime_s));
    LOAM_TRY(in_range("energy_j", e.energy_j, 1e5, 1e17));
    LOAM_TRY(in_range("count", e.count,
                      e.kind == EventKind::crater_line || e.kind == EventKind::barrage ? 1 : 0,
                      kMostEventParts / 2));
    LOAM_TRY(in_range("width_m", e.width_m, 0.5, 100));
    LOAM_TRY(in_range("volume_m3", e.volume_m3, 0, 1e9));
    LOAM_TRY(in_range("level_m", e.level_m, -kHighest_m, kHighest_m));
    LOAM_TRY(in_range("from_m", e.from_m, -kHighest_m, kHighest_m));
    if (e.kind == EventKind::barrage || e.kind == EventKind::landslide || e.kind == EventKind::flood)
        LOAM_TRY(in_range("radius_m", e.radius_m, 1, e.kind == EventKind::landslide ? 2000 : kLargestHalf_m));
    if (e.kind == EventKind::crash && !(length_m >= e.width_m))
        return error("the furrow of a crash is {:.2f} m long, must be at least as long as it is wide ({} m)",
                     length_m, e.width_m);
    return in_range("the length of the event, metres,", length_m, 0, 50'000);
}

Status check(const CraterCommand& c) {
    LOAM_TRY(check_life(c.life));
    return check(c.crater);
}

Status check(const FootprintsCommand& c) {
    if (c.prints.size() > kMaxPrints)
        return error("{} prints, the limit is {} a command", c.prints.size(), kMaxPrints);
    for (const Footprint& print : c.prints) LOAM_TRY(check(print));
    return check_life(c.life);
}

Status check(const AddOperatorCommand& c) {
    if (std::holds_alternative<Footprint>(c.shape)) return error("prints are laid by the command footprints");
    LOAM_TRY(check_life(c.life));
    return check_shape(c.shape);
}

Status check(const FunctionCommand& c) {
    return check_function_name(c.name);
}

Status check(const TimeCommand& c) {
    return in_range("time_s", c.time_s, -kLongestTime_s, kLongestTime_s);
}

Status check(const EditOperatorCommand& c) {
    if (c.life) LOAM_TRY(check_life(*c.life));
    return check_shape(c.shape);
}

Status check(const TransitionCommand& c) {
    if (c.name.empty()) return error("a transition needs a name");
    if (c.remove && (!c.from.empty() || !c.to.empty() || c.threshold))
        return error("\"remove\" of a transition stands alone: no from, to or threshold");
    return c.threshold ? in_range("threshold", *c.threshold, 0, 1) : Status();
}

template <typename Other>
Status check(const Other&) {
    return {};
}

}  // namespace

Status check_shape(const OperatorShape& shape) {
    return std::visit([](const auto& kind) { return check(kind); }, shape);
}

Status check_life(const Life& life) {
    for (const auto& [name, value] : {std::pair("rise_s", life.rise_s),
                                      {"fade_s", life.fade_s},
                                      {"cool_s", life.cool_s},
                                      {"weather_s", life.weather_s}})
        LOAM_TRY(in_range(name, value, 0, kLongestTime_s));
    const bool begins = std::isfinite(life.from_s), ends = std::isfinite(life.until_s);
    if (begins || life.from_s > 0 || std::isnan(life.from_s))
        LOAM_TRY(in_range("from_s", life.from_s, -kLongestTime_s, kLongestTime_s));
    if (ends || life.until_s < 0 || std::isnan(life.until_s))
        LOAM_TRY(in_range("until_s", life.until_s, -kLongestTime_s, kLongestTime_s));
    if (life.from_s >= life.until_s)
        return error("a life from {} s until {} s has no time in it", life.from_s, life.until_s);
    if (!begins && (life.rise_s > 0 || life.cool_s > 0 || life.weather_s > 0))
        return error("a life that rises, cools or weathers needs \"from_s\", when that begins");
    if (!ends && life.fade_s > 0) return error("a life that fades needs \"until_s\", when that ends");
    return {};
}

Status check_command(const Command& command) {
    return std::visit([](const auto& body) { return check(body); }, command.body);
}

}  // namespace loam
