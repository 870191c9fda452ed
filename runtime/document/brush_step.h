// Steps that the brushes share: where a dab lies in a map's samples and how much it weighs there.
#pragma once

#include <algorithm>
#include <cmath>

#include <glm/vec2.hpp>

#include "runtime/base/rect.h"
#include "runtime/document/base_map.h"
#include "runtime/document/command.h"

namespace loam {

// A dab in units of a map's samples. A brush finer than the map reaches at least 0.75 spacings (the nearest
// sample is never farther than 0.71), so that no dab inside the map does silently nothing.
struct DabFootprint {
    double x = 0, y = 0, radius = 0;
    int nearest_x = -1, nearest_y = -1;  // -1: the dab's centre is not near a sample of the map
    TexelRect rect;                      // samples within the radius, clipped to the map
};

[[nodiscard]] inline DabFootprint dab_footprint(const MapShape& shape, glm::dvec2 center_m, double radius_m) {
    DabFootprint dab;
    dab.x = center_m.x / shape.spacing_m;
    dab.y = center_m.y / shape.spacing_m;
    dab.radius = std::max(radius_m / shape.spacing_m, 0.75);
    const auto whole = [](double v) { return int(std::clamp(v, -1.0e9, 1.0e9)); };
    dab.rect = intersected(
        TexelRect{whole(std::ceil(dab.x - dab.radius)), whole(std::ceil(dab.y - dab.radius)),
                  whole(std::floor(dab.x + dab.radius)) + 1, whole(std::floor(dab.y + dab.radius)) + 1},
        TexelRect{0, 0, shape.samples_x, shape.samples_y});
    const int nearest_x = whole(std::floor(dab.x + 0.5)), nearest_y = whole(std::floor(dab.y + 0.5));
    if (nearest_x >= 0 && nearest_x < shape.samples_x && nearest_y >= 0 && nearest_y < shape.samples_y) {
        dab.nearest_x = nearest_x;
        dab.nearest_y = nearest_y;
    }
    return dab;
}

// Calls visit(page_x, page_y, samples of the page in the dab's rectangle) for the pages under a dab; stops at
// an error.
template <typename Visit>
Status for_each_page_under(const TexelRect& rect, Visit&& visit) {
    if (rect.empty()) return {};
    for (int page_y = rect.y0 / kBasePageSide; page_y <= (rect.y1 - 1) / kBasePageSide; ++page_y)
        for (int page_x = rect.x0 / kBasePageSide; page_x <= (rect.x1 - 1) / kBasePageSide; ++page_x) {
            const TexelRect page{page_x * kBasePageSide, page_y * kBasePageSide, (page_x + 1) * kBasePageSide,
                                 (page_y + 1) * kBasePageSide};
            LOAM_TRY(visit(page_x, page_y, intersected(rect, page)));
        }
    return {};
}

}  // namespace loam
