// A texel takes the layer when a number hashed from its coordinates and the seed is below strength * falloff:
// strokes of one seed agree on which texels those are, so that more dabs fill a disc no further than its
// weight says. Tint is blended by strength * falloff a dab.
#include "runtime/document/paint.h"

#include <cmath>

#include "runtime/document/brush_step.h"
#include "shaders/document/noise_math.h"

namespace loam {

namespace {

struct SlopeRange {
    double min_tangent2 = 0, max_tangent2 = INFINITY;
    bool any = true;  // no limit: slopes need not be read
};

SlopeRange slope_range(const PaintCommand& command) {
    constexpr double kUpright_rad = 1.5707;  // a little below a right angle: vertical ground counts as that
    SlopeRange range;
    const double low = std::tan(std::min(command.min_slope_rad, kUpright_rad));
    const double high = std::tan(std::min(command.max_slope_rad, kUpright_rad));
    range.min_tangent2 = low * low;
    if (command.max_slope_rad < kUpright_rad) range.max_tangent2 = high * high;
    range.any = command.min_slope_rad <= 0 && command.max_slope_rad >= kUpright_rad;
    return range;
}

void blend_tint(IndexTexel& texel, const glm::dvec3& tint, double weight) {
    for (int channel = 0; channel < 3; ++channel) {
        const double old = texel.tint[channel];
        texel.tint[channel] = uint8_t(old + (tint[channel] * 255 - old) * weight + 0.5);
    }
}

// A brush finer than the map paints the one texel nearest to it wholly; at full hardness a disc has no soft
// rim.
double paint_falloff(const PaintCommand& command, const DabFootprint& dab, bool finer_than_map, int x,
                     int y) {
    if (finer_than_map) return x == dab.nearest_x && y == dab.nearest_y ? 1 : 0;
    const double dx = x - dab.x, dy = y - dab.y;
    const double t = std::sqrt(dx * dx + dy * dy) / dab.radius;
    if (command.hardness >= 1) return t <= 1 ? 1 : 0;
    return brush_falloff(t, command.hardness);
}

}  // namespace

Status paint(const PaintCommand& command, uint16_t layer, const std::vector<Transition>& transitions,
             SlopeReader& slopes, PageEdits<IndexTexel>& edits) {
    const SlopeRange slope = slope_range(command);
    const MapShape& shape = edits.shape();
    const bool finer_than_map = command.radius_m < 0.75 * shape.spacing_m;
    const auto paint_texel = [&](IndexTexel& texel, const DabFootprint& dab, int x, int y) -> Status {
        const double weight = command.strength * paint_falloff(command, dab, finer_than_map, x, y);
        if (weight <= 0) return {};
        if (!slope.any) {
            const auto tangent2 = slopes.tangent_squared(x * shape.spacing_m, y * shape.spacing_m);
            if (!tangent2.ok()) return tangent2.error();
            if (*tangent2 < slope.min_tangent2 || *tangent2 > slope.max_tangent2) return {};
        }
        if (command.tint) blend_tint(texel, *command.tint, weight);
        if (command.layer && double(shared::noise_share(shared::noise_cell(x, y, command.seed))) < weight)
            texel.layer = layer;
        return {};
    };
    for (const glm::dvec2& center : command.dabs) {
        const DabFootprint dab = dab_footprint(shape, center, command.radius_m);
        LOAM_TRY(for_each_page_under(dab.rect, [&](int page_x, int page_y, const TexelRect& part) -> Status {
            const auto page = edits.page(page_x, page_y);
            if (!page.ok()) return page.error();
            for (int y = part.y0; y < part.y1; ++y)
                for (int x = part.x0; x < part.x1; ++x)
                    LOAM_TRY(paint_texel(
                        (*page)[(y - page_y * kBasePageSide) * kBasePageSide + x - page_x * kBasePageSide],
                        dab, x, y));
            return {};
        }));
    }
    for (const glm::dvec2& center : command.dabs)
        LOAM_TRY(place_transitions(transitions, dab_footprint(shape, center, command.radius_m).rect, edits));
    return {};
}

}  // namespace loam
