#include "runtime/document/slope.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/units.h"

namespace loam {

Result<double> SlopeReader::sample_m(int x, int y) {
    const int page_x = x / kBasePageSide, page_y = y / kBasePageSide;
    if (page_x != page_x_ || page_y != page_y_) {
        auto page = pages_.load<int32_t>({shape_.map, 0, page_x, page_y});
        if (!page.ok()) return page.error();
        page_ = *page;
        page_x_ = page_x;
        page_y_ = page_y;
    }
    return height_m_from_mm(page_ ? (*page_)[size_t(y % kBasePageSide * kBasePageSide + x % kBasePageSide)]
                                  : fallback_mm_);
}

Result<SlopeReader::Patch> SlopeReader::patch(double x_m, double y_m) {
    const double x = std::clamp(x_m / shape_.spacing_m, 0.0, double(shape_.samples_x - 1));
    const double y = std::clamp(y_m / shape_.spacing_m, 0.0, double(shape_.samples_y - 1));
    const int i = std::min(int(x), shape_.samples_x - 2), j = std::min(int(y), shape_.samples_y - 2);
    Patch patch{.corner_m = {}, .u = x - i, .v = y - j};
    for (int k = 0; k < 4; ++k) {
        const auto height = sample_m(i + k % 2, j + k / 2);
        if (!height.ok()) return height.error();
        patch.corner_m[k] = *height;
    }
    return patch;
}

Result<double> SlopeReader::tangent_squared(double x_m, double y_m) {
    const auto p = patch(x_m, y_m);
    if (!p.ok()) return p.error();
    const double* c = p->corner_m;
    const double east = ((c[1] - c[0]) * (1 - p->v) + (c[3] - c[2]) * p->v) / shape_.spacing_m;
    const double north = ((c[2] - c[0]) * (1 - p->u) + (c[3] - c[1]) * p->u) / shape_.spacing_m;
    return east * east + north * north;
}

Result<double> SlopeReader::height_m(double x_m, double y_m) {
    const auto p = patch(x_m, y_m);
    if (!p.ok()) return p.error();
    return std::lerp(std::lerp(p->corner_m[0], p->corner_m[1], p->u),
                     std::lerp(p->corner_m[2], p->corner_m[3], p->u), p->v);
}

}  // namespace loam
