#include "editor/recipe/grid.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/job_queue.h"

namespace loam::recipe {

float Grid::bilinear(float x, float y) const {
    const float top = static_cast<float>(size - 1);
    x = std::clamp(x, 0.0f, top), y = std::clamp(y, 0.0f, top);
    const int i = std::min(static_cast<int>(x), std::max(size - 2, 0)),
              j = std::min(static_cast<int>(y), std::max(size - 2, 0));
    const int i1 = std::min(i + 1, size - 1), j1 = std::min(j + 1, size - 1);
    const float u = x - static_cast<float>(i), w = y - static_cast<float>(j);
    return (at(i, j) * (1 - u) + at(i1, j) * u) * (1 - w) + (at(i, j1) * (1 - u) + at(i1, j1) * u) * w;
}

Grid resampled_linear(const Grid& source, int size) {
    Grid out(size);
    const float scale = size > 1 ? static_cast<float>(source.size - 1) / static_cast<float>(size - 1) : 0.0f;
    parallel_ranges(size, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < size; ++i)
                out.at(i, j) = source.bilinear(static_cast<float>(i) * scale, static_cast<float>(j) * scale);
    });
    return out;
}

Grid resampled(const Grid& source, int size) {
    if (size == source.size) return source;
    Grid out(size);
    const double scale = size > 1 ? static_cast<double>(source.size - 1) / (size - 1) : 0.0;
    struct Tap {
        int at[4];
        float weight[4];
    };
    std::vector<Tap> taps(static_cast<size_t>(size));
    for (int i = 0; i < size; ++i) {
        const double x = i * scale;
        const int base = std::min(static_cast<int>(x), source.size - 1);
        const float t = static_cast<float>(x - base), t2 = t * t, t3 = t2 * t;
        Tap& tap = taps[static_cast<size_t>(i)];
        for (int k = 0; k < 4; ++k) tap.at[k] = std::clamp(base + k - 1, 0, source.size - 1);
        tap.weight[0] = 0.5f * (-t3 + 2 * t2 - t);
        tap.weight[1] = 0.5f * (3 * t3 - 5 * t2 + 2);
        tap.weight[2] = 0.5f * (-3 * t3 + 4 * t2 + t);
        tap.weight[3] = 0.5f * (t3 - t2);
    }
    parallel_ranges(size, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j) {
            const Tap& ty = taps[static_cast<size_t>(j)];
            for (int i = 0; i < size; ++i) {
                const Tap& tx = taps[static_cast<size_t>(i)];
                float sum = 0;
                for (int b = 0; b < 4; ++b) {
                    float row = 0;
                    for (int a = 0; a < 4; ++a) row += tx.weight[a] * source.at(tx.at[a], ty.at[b]);
                    sum += ty.weight[b] * row;
                }
                out.at(i, j) = sum;
            }
        }
    });
    return out;
}

Grid slope_of(const Grid& h, double spacing_m) {
    Grid out(h.size);
    const int last = h.size - 1;
    parallel_ranges(h.size, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < h.size; ++i) {
                const int w = std::max(i - 1, 0), e = std::min(i + 1, last), s = std::max(j - 1, 0),
                          n = std::min(j + 1, last);
                const double dx = (h.at(e, j) - h.at(w, j)) / (std::max(e - w, 1) * spacing_m);
                const double dy = (h.at(i, n) - h.at(i, s)) / (std::max(n - s, 1) * spacing_m);
                out.at(i, j) = static_cast<float>(std::sqrt(dx * dx + dy * dy));
            }
    });
    return out;
}

Grid curvature_of(const Grid& h, double spacing_m) {
    Grid out(h.size);
    const int last = h.size - 1;
    const float scale = static_cast<float>(1.0 / (spacing_m * spacing_m));
    parallel_ranges(h.size, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < h.size; ++i) {
                const float around = h.at(std::max(i - 1, 0), j) + h.at(std::min(i + 1, last), j) +
                                     h.at(i, std::max(j - 1, 0)) + h.at(i, std::min(j + 1, last));
                out.at(i, j) = (around - 4 * h.at(i, j)) * scale;
            }
    });
    return out;
}

Grid blurred(const Grid& source, int radius, int passes) {
    Grid a = source, b(source.size);
    const int n = source.size;
    // One pass is rows of `a` into columns of `b`, twice: each output is its own sum, begun afresh a row, so
    // that the rounding does not depend on the split.
    const auto rows_transposed = [&](const Grid& from, Grid& to) {
        parallel_ranges(n, 16, [&](int begin, int end) {
            for (int j = begin; j < end; ++j) {
                double sum = 0;
                int low = 0, high = -1;
                for (int i = 0; i < n; ++i) {
                    while (high < std::min(i + radius, n - 1)) sum += from.at(++high, j);
                    while (low < i - radius) sum -= from.at(low++, j);
                    to.at(j, i) = static_cast<float>(sum / (high - low + 1));
                }
            }
        });
    };
    for (int p = 0; p < passes; ++p) {
        rows_transposed(a, b);
        rows_transposed(b, a);
    }
    return a;
}

}  // namespace loam::recipe
