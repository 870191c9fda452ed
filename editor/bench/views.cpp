// The three views that pictures are compared in.
#include <algorithm>
#include <cmath>

#include "editor/bench/bench.h"

namespace loam::bench {

Result<std::vector<View>> views_of(const BenchRequest& request, Session& session) {
    if (request.camera) return std::vector<View>{{"camera", *request.camera}};
    const WorldRect bounds = session.document().bounds();
    const glm::dvec2 c = bounds.center();
    auto ground = session.height_m(c.x, c.y);
    if (!ground) return ground.error();
    std::vector<View> views{
        {"close ground", Camera::look_at({c.x, c.y - 4, *ground + 2}, {c.x, c.y, *ground})}};
    if (request.quick) return views;

    constexpr int kGrid = 48;
    constexpr double kWantedSlope = 0.6;  // rise over run
    double best = 1e9, highest_m = -1e9;
    glm::dvec3 slope_at{0}, slope_normal{0, 0, 1}, top{0};
    for (int j = kGrid / 4; j < kGrid * 3 / 4; ++j)
        for (int i = kGrid / 4; i < kGrid * 3 / 4; ++i) {
            const glm::dvec2 at = glm::dvec2(bounds.width() * i, bounds.height() * j) / double(kGrid);
            auto height = session.height_m(at.x, at.y);
            auto normal = session.normal(at.x, at.y);
            if (!height) return height.error();
            if (!normal) return normal.error();
            if (*height > highest_m) {
                highest_m = *height;
                top = {at, *height};
            }
            const double slope = std::hypot(normal->x, normal->y) / std::max(normal->z, 1e-3);
            if (std::abs(slope - kWantedSlope) >= best) continue;
            best = std::abs(slope - kWantedSlope);
            slope_at = {at, *height};
            slope_normal = *normal;
        }
    const glm::dvec3 along =
        glm::normalize(glm::dvec3(-slope_normal.y, slope_normal.x, 0) + glm::dvec3(1e-9, 0, 0));
    views.push_back(
        {"hillside, grazing", Camera::look_at(slope_at + slope_normal * 3.0, slope_at + along * 30.0, 0.8)});
    const glm::dvec2 far(top.x < c.x ? bounds.max_x : bounds.min_x,
                         top.y < c.y ? bounds.max_y : bounds.min_y);
    auto far_m = session.height_m(far.x, far.y);
    if (!far_m) return far_m.error();
    views.push_back(
        {"vista", Camera::look_at(top + glm::dvec3(0, 0, 0.01 * bounds.width()), {far, *far_m}, 0.8)});
    return views;
}

}  // namespace loam::bench
