#include "runtime/document/slope.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/units.h"

namespace loam {

Result<double> SlopeReader::height_m(int x, int y) {
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

Result<double> SlopeReader::tangent_squared(double x_m, double y_m) {
    const double x = std::clamp(x_m / shape_.spacing_m, 0.0, double(shape_.samples_x - 1));
    const double y = std::clamp(y_m / shape_.spacing_m, 0.0, double(shape_.samples_y - 1));
    const int i = std::min(int(x), shape_.samples_x - 2), j = std::min(int(y), shape_.samples_y - 2);
    const double u = x - i, v = y - j;
    double corner[4];
    for (int k = 0; k < 4; ++k) {
        const auto height = height_m(i + k % 2, j + k / 2);
        if (!height.ok()) return height.error();
        corner[k] = *height;
    }
    const double east = ((corner[1] - corner[0]) * (1 - v) + (corner[3] - corner[2]) * v) / shape_.spacing_m;
    const double north = ((corner[2] - corner[0]) * (1 - u) + (corner[3] - corner[1]) * u) / shape_.spacing_m;
    return east * east + north * north;
}

}  // namespace loam
