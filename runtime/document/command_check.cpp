// The ranges of commands, for those from JSON and those made in C++ alike.
#include <cmath>

#include "runtime/base/units.h"
#include "runtime/document/command.h"

namespace loam {

namespace {

constexpr double kFarthest_m = 1.0e6;  // of any coordinate; the map may be left, not the world
constexpr size_t kMaxDabs = 100'000, kMaxPrints = 100'000;
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

Status check(const PaintCommand& c) {
    LOAM_TRY(dabs_ok(c.dabs));
    if (!c.layer && !c.tint) return error("paint needs a layer or a tint");
    LOAM_TRY(in_range("radius_m", c.radius_m, 0.01, 5000));
    LOAM_TRY(in_range("strength", c.strength, 0, 1));
    LOAM_TRY(in_range("hardness", c.hardness, 0, 1));
    LOAM_TRY(in_range("min_slope_rad", c.min_slope_rad, 0, kRightAngle_rad + 1e-4));
    LOAM_TRY(in_range("max_slope_rad", c.max_slope_rad, 0, kRightAngle_rad + 1e-4));
    if (c.tint)
        for (int channel = 0; channel < 3; ++channel) LOAM_TRY(in_range("tint", (*c.tint)[channel], 0, 1));
    return {};
}

Status check(const CraterCommand& c) {
    LOAM_TRY(place_ok("the crater", c.crater.x_m, c.crater.y_m));
    LOAM_TRY(in_range("radius_m", c.crater.radius_m, 0.1, 2000));
    LOAM_TRY(in_range("depth_m", c.crater.depth_m, 0, 4000));
    return in_range("heat", c.crater.heat, 0, 1);
}

Status check(const FootprintsCommand& c) {
    if (c.prints.size() > kMaxPrints)
        return error("{} prints, the limit is {} a command", c.prints.size(), kMaxPrints);
    for (const Footprint& print : c.prints) {
        LOAM_TRY(place_ok("a print", print.x_m, print.y_m));
        LOAM_TRY(in_range("heading_rad", print.heading_rad, -1000, 1000));
        LOAM_TRY(in_range("length_m", print.length_m, 0.05, 5));
        LOAM_TRY(in_range("depth_m", print.depth_m, 0, 2));
        if (print.foot != 0 && print.foot != 1)
            return error("foot is {}, must be 0 (left) or 1 (right)", print.foot);
    }
    return {};
}

template <typename Other>
Status check(const Other&) {
    return {};
}

}  // namespace

Status check_command(const Command& command) {
    return std::visit([](const auto& body) { return check(body); }, command.body);
}

}  // namespace loam
