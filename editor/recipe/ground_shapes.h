// One function a recipe; ground.cpp chooses among them.
#pragma once

#include "editor/recipe/erosion.h"
#include "editor/recipe/progress.h"

namespace loam::recipe {

struct Shape {
    Grid height_m, deposit_m;
};
struct ShapeRequest {
    int size = 0;
    double spacing_m = 1;
    uint32_t seed = 1;
    [[nodiscard]] double side_m() const { return (size - 1) * spacing_m; }
};

Result<Shape> shape_valley(const ShapeRequest& request, const Progress& progress);
Result<Shape> shape_ridge(const ShapeRequest& request, const Progress& progress);
Result<Shape> shape_hills(const ShapeRequest& request, const Progress& progress);
Result<Shape> shape_dunes(const ShapeRequest& request, const Progress& progress);
Result<Shape> shape_plain(const ShapeRequest& request, const Progress& progress);

// Bends the ground sideways by up to some 3 % of the map: streams that grew along the eight directions of a
// coarse grid become curves, and the finer grid's incision puts them in order again.
void bend(Grid& height_m, uint32_t seed, float strength);

// Fills a grid with f(u, v), u and v in 0 … 1 across the map.
template <typename F>
Grid filled_by(int size, F&& f);

}  // namespace loam::recipe

#include "runtime/base/job_queue.h"

namespace loam::recipe {

template <typename F>
Grid filled_by(int size, F&& f) {
    Grid out(size);
    const float scale = 1.0f / static_cast<float>(size > 1 ? size - 1 : 1);
    parallel_ranges(size, 16, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < size; ++i)
                out.at(i, j) = f(static_cast<float>(i) * scale, static_cast<float>(j) * scale);
    });
    return out;
}

}  // namespace loam::recipe
