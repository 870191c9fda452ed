// Height and slope of the base height map at any place, from the bilinear patch around it.
#pragma once

#include "runtime/base/result.h"
#include "runtime/document/base_map.h"

namespace loam {

class SlopeReader {
  public:
    SlopeReader(BasePages& pages, const MapShape& shape, int32_t fallback_mm)
        : pages_(pages), shape_(shape), fallback_mm_(fallback_mm) {}
    // Tangent of the steepest angle at a place in metres, squared.
    Result<double> tangent_squared(double x_m, double y_m);
    Result<double> height_m(double x_m, double y_m);

  private:
    struct Patch {
        double corner_m[4], u, v;
    };
    Result<Patch> patch(double x_m, double y_m);
    Result<double> sample_m(int x, int y);

    BasePages& pages_;
    const MapShape shape_;
    const int32_t fallback_mm_;
    PageHandle<int32_t> page_;  // the last one read
    int page_x_ = -1, page_y_ = -1;
};

}  // namespace loam
