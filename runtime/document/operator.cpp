#include "runtime/document/operator.h"

#include <algorithm>
#include <cmath>

#include "shaders/document/crater_math.h"
#include "shaders/document/footprint_math.h"

namespace loam {

namespace {

using glm::vec2;

WorldRect square(double x_m, double y_m, double half_m) {
    return {x_m - half_m, y_m - half_m, x_m + half_m, y_m + half_m};
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
        height += crater.radius_m * double(shared::crater_height(local, depth, crater.seed));
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

}  // namespace

WorldRect Operator::height_bounds() const {
    if (const auto* crater = std::get_if<Crater>(&shape))
        return square(crater->x_m, crater->y_m, crater->radius_m * double(kCraterHeightReach));
    const auto& print = std::get<Footprint>(shape);
    return square(print.x_m, print.y_m, print.length_m * double(kFootprintReach));
}

WorldRect Operator::index_bounds() const {
    if (const auto* crater = std::get_if<Crater>(&shape))
        return square(crater->x_m, crater->y_m, crater->radius_m * double(kCraterMarkReach));
    return {};
}

WorldRect Operator::texture_bounds() const {
    if (const auto* crater = std::get_if<Crater>(&shape))
        return square(crater->x_m, crater->y_m, crater->radius_m * double(kCraterMarkReach));
    const auto& print = std::get<Footprint>(shape);
    return square(print.x_m, print.y_m, print.length_m * double(kFootprintReach));
}

void apply_height(const Operator& op, const SampleGrid<double>& heights_m) {
    if (const auto* crater = std::get_if<Crater>(&op.shape))
        apply_crater_height(*crater, op.height_bounds(), heights_m);
    else
        apply_footprint_height(std::get<Footprint>(op.shape), op.height_bounds(), heights_m);
}

void apply_index(const Operator& op, const ResolvedRoles& roles, const SampleGrid<IndexTexel>& texels) {
    const auto* crater = std::get_if<Crater>(&op.shape);
    if (!crater) return;
    for_each_sample(texels, op.index_bounds(), crater->x_m, crater->y_m,
                    [&](IndexTexel& texel, double dx, double dy) {
                        const vec2 local(float(dx / crater->radius_m), float(dy / crater->radius_m));
                        const int zone = shared::crater_zone(local, crater->seed);
                        if (zone != 0) texel.layer = zone == 1 ? roles.scorched : roles.broken;
                        const float factor = (1.0f - 0.62f * shared::crater_scorch(local, crater->seed)) *
                                             (1.0f - 0.3f * shared::crater_rays(local, crater->seed));
                        for (uint8_t& channel : texel.tint) channel = scaled(channel, factor);
                    });
}

}  // namespace loam
