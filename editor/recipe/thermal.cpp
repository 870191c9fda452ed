// Slow work on slopes: crumbling rock, sliding debris, creeping soil (erosion.h). Each step reads the state
// before it and gathers, so that rows may run in any order.
#include <algorithm>
#include <cmath>

#include "editor/recipe/erosion.h"
#include "runtime/base/job_queue.h"

namespace loam::recipe {

namespace {

constexpr int kDx[8] = {1, 0, -1, 0, 1, -1, -1, 1};
constexpr int kDy[8] = {0, 1, 0, -1, 1, 1, -1, -1};
constexpr float kDistance[8] = {1, 1, 1, 1, 1.41421356f, 1.41421356f, 1.41421356f, 1.41421356f};

// One step of debris sliding: of each sample, a share of the largest excess over the angle of repose goes to
// the lower neighbours in proportion to their excess. `share[c]` is metres sent a metre of excess.
void slide(Grid& height, Grid* debris, float spacing, float repose, Grid& share, Grid& next) {
    const int n = height.size;
    const auto excess = [&](int i, int j, int k) {
        return height.at(i, j) - height.at(i + kDx[k], j + kDy[k]) - repose * spacing * kDistance[k];
    };
    const auto inside = [n](int i, int j) { return i >= 0 && j >= 0 && i < n && j < n; };
    parallel_ranges(n, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < n; ++i) {
                float sum = 0, most = 0;
                for (int k = 0; k < 8; ++k) {
                    if (!inside(i + kDx[k], j + kDy[k])) continue;
                    const float e = excess(i, j, k);
                    if (e > 0) sum += e, most = std::max(most, e);
                }
                float moved =
                    0.25f * most;  // a quarter: the sender falls as the receiver rises, without overshoot
                if (debris) moved = std::min(moved, debris->at(i, j));
                share.at(i, j) = sum > 0 ? moved / sum : 0.0f;
            }
    });
    parallel_ranges(n, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < n; ++i) {
                float change = 0;
                for (int k = 0; k < 8; ++k) {
                    const int x = i + kDx[k], y = j + kDy[k];
                    if (!inside(x, y)) continue;
                    const float fall = height.at(i, j) - height.at(x, y),
                                limit = repose * spacing * kDistance[k];
                    if (fall > limit)
                        change -= share.at(i, j) * (fall - limit);
                    else if (-fall > limit)
                        change += share.at(x, y) * (-fall - limit);
                }
                next.at(i, j) = change;
            }
    });
    parallel_ranges(n, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < n; ++i) {
                height.at(i, j) += next.at(i, j);
                if (debris) debris->at(i, j) = std::max(debris->at(i, j) + next.at(i, j), 0.0f);
            }
    });
}

}  // namespace

void settle(Grid& height_m, double spacing_m, float repose, int steps) {
    Grid share(height_m.size), next(height_m.size);
    for (int s = 0; s < steps; ++s)
        slide(height_m, nullptr, static_cast<float>(spacing_m), repose, share, next);
}

void weather(Grid& height_m, Grid& debris_m, double spacing_m, const Weathering& w, int steps) {
    const int n = height_m.size;
    Grid share(n), next(n);
    const float dx = static_cast<float>(spacing_m);
    for (int s = 0; s < steps; ++s) {
        // Rock that stands too steep turns to debris where it is (no change of height); debris covers and
        // protects it.
        parallel_ranges(n, 32, [&](int begin, int end) {
            for (int j = begin; j < end; ++j)
                for (int i = 0; i < n; ++i) {
                    const float limit = w.rock_limit * (w.strength ? w.strength->at(i, j) : 1.0f) * dx;
                    float most = 0;
                    for (int k = 0; k < 8; ++k) {
                        const int x = i + kDx[k], y = j + kDy[k];
                        if (x < 0 || y < 0 || x >= n || y >= n) continue;
                        most = std::max(most, height_m.at(i, j) - height_m.at(x, y) - limit * kDistance[k]);
                    }
                    debris_m.at(i, j) += std::max(w.crumble * most - debris_m.at(i, j), 0.0f);
                }
        });
        slide(height_m, &debris_m, dx, w.repose, share, next);
    }
}

void creep(Grid& height_m, double spacing_m, float diffusivity_m2) {
    const float whole = static_cast<float>(diffusivity_m2 / (spacing_m * spacing_m));
    const int steps =
        std::max(1, static_cast<int>(std::ceil(whole / 0.2f)));  // 0.25 is where it becomes unstable
    const float rate = whole / static_cast<float>(steps);
    Grid next(height_m.size);
    for (int s = 0; s < steps; ++s) {
        const int last = height_m.size - 1;
        parallel_ranges(height_m.size, 32, [&](int begin, int end) {
            for (int j = begin; j < end; ++j)
                for (int i = 0; i <= last; ++i) {
                    const float around =
                        height_m.at(std::max(i - 1, 0), j) + height_m.at(std::min(i + 1, last), j) +
                        height_m.at(i, std::max(j - 1, 0)) + height_m.at(i, std::min(j + 1, last));
                    next.at(i, j) = height_m.at(i, j) + rate * (around - 4 * height_m.at(i, j));
                }
        });
        std::swap(height_m.v, next.v);
    }
}

}  // namespace loam::recipe
