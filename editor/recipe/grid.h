// A square grid of floats, row 0 south, and the few operations every recipe needs on it.
#pragma once

#include <cstddef>
#include <vector>

namespace loam::recipe {

struct Grid {
    int size = 0;
    std::vector<float> v;

    Grid() = default;
    explicit Grid(int size_, float value = 0) : size(size_), v(static_cast<size_t>(size_) * size_, value) {}
    [[nodiscard]] float& at(int i, int j) { return v[static_cast<size_t>(j) * size + i]; }
    [[nodiscard]] float at(int i, int j) const { return v[static_cast<size_t>(j) * size + i]; }
    // Bilinear at a place in samples; outside the grid the nearest place inside.
    [[nodiscard]] float bilinear(float x, float y) const;
};

// The same square of the world with other samples: Catmull-Rom, which goes through the old samples and has no
// creases at them. Point-samples when going down.
[[nodiscard]] Grid resampled(const Grid& source, int size);
[[nodiscard]] Grid resampled_linear(const Grid& source, int size);  // never beyond the old extremes

// Slope (rise over run, ≥ 0) and curvature (Laplacian, 1/m; > 0 in hollows) by central differences.
[[nodiscard]] Grid slope_of(const Grid& height_m, double spacing_m);
[[nodiscard]] Grid curvature_of(const Grid& height_m, double spacing_m);

// Mean over a (2 radius + 1)² square cut off at the edges, `passes` times: three passes are close to a
// Gaussian.
[[nodiscard]] Grid blurred(const Grid& source, int radius, int passes = 2);

}  // namespace loam::recipe
