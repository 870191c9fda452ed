#include "editor/recipe/erosion.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "editor/recipe/noise.h"
#include "runtime/base/job_queue.h"

namespace loam::recipe {

namespace {

constexpr int kDx[8] = {1, 0, -1, 0, 1, -1, -1, 1};
constexpr int kDy[8] = {0, 1, 0, -1, 1, 1, -1, -1};
constexpr float kDistance[8] = {1, 1, 1, 1, 1.41421356f, 1.41421356f, 1.41421356f, 1.41421356f};

bool inside(int i, int j, int size) {
    return i >= 0 && j >= 0 && i < size && j < size;
}

}  // namespace

Drainage route(const Grid& height_m, double spacing_m, Outlets outlets, uint32_t wander) {
    const int n = height_m.size;
    const size_t count = height_m.v.size();
    Drainage d;
    d.order.reserve(count);
    d.receiver.resize(count);
    d.filled_m = height_m;
    d.area_m2 = Grid(n, static_cast<float>(spacing_m * spacing_m));

    // Priority flood: the lowest open sample next; ties by index, so that the order is defined.
    using Open = std::pair<float, uint32_t>;
    std::vector<Open> storage;
    storage.reserve(count / 8 + 64);
    std::priority_queue<Open, std::vector<Open>, std::greater<>> open(std::greater<>{}, std::move(storage));
    std::vector<uint8_t> seen(count, 0);
    const auto begin_at = [&](uint32_t c) {
        if (seen[c]) return;
        seen[c] = 1;
        d.receiver[c] = c;
        open.emplace(d.filled_m.v[c], c);
    };
    uint32_t lowest = 0;
    for (int k = 0; k < n; ++k)
        for (const uint32_t c : {static_cast<uint32_t>(k), static_cast<uint32_t>((n - 1) * n + k),
                                 static_cast<uint32_t>(k * n), static_cast<uint32_t>(k * n + n - 1)}) {
            if (outlets == Outlets::all_edges) begin_at(c);
            if (height_m.v[c] < height_m.v[lowest] || (k == 0 && lowest == 0)) lowest = c;
        }
    if (outlets == Outlets::lowest_of_edge) begin_at(lowest);

    while (!open.empty()) {
        const auto [level, c] = open.top();
        open.pop();
        d.order.push_back(c);
        const int i = static_cast<int>(c) % n, j = static_cast<int>(c) / n;
        for (int k = 0; k < 8; ++k) {
            const int x = i + kDx[k], y = j + kDy[k];
            if (!inside(x, y, n)) continue;
            const uint32_t other = static_cast<uint32_t>(y * n + x);
            if (seen[other]) continue;
            seen[other] = 1;
            d.receiver[other] = c;
            // 1 mm above the sample that it spills to: enough to order heights of some kilometres in float.
            if (d.filled_m.v[other] <= level) d.filled_m.v[other] = level + 0.001f;
            open.emplace(d.filled_m.v[other], other);
        }
    }
    // Where there is a steeper way down than the one the flood came, take that.
    parallel_ranges(n, 32, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < n; ++i) {
                const uint32_t c = static_cast<uint32_t>(j * n + i);
                if (d.receiver[c] == c) continue;
                float best = 0;
                for (int k = 0; k < 8; ++k) {
                    const int x = i + kDx[k], y = j + kDy[k];
                    if (!inside(x, y, n)) continue;
                    const uint32_t other = static_cast<uint32_t>(y * n + x);
                    float steep = (d.filled_m.v[c] - d.filled_m.v[other]) / kDistance[k];
                    if (wander)
                        steep *=
                            0.55f + 0.9f * unit_from_hash(hash(c * 8 + static_cast<uint32_t>(k), wander));
                    if (steep > best) best = steep, d.receiver[c] = other;
                }
            }
    });
    for (size_t k = count; k-- > 0;) {
        const uint32_t c = d.order[k];
        if (d.receiver[c] != c) d.area_m2.v[d.receiver[c]] += d.area_m2.v[c];
    }
    return d;
}

void incise(Grid& height_m, const Drainage& d, double spacing_m, const Incision& in) {
    const int n = height_m.size;
    const float dx = static_cast<float>(spacing_m);
    for (const uint32_t c : d.order) {
        const uint32_t r = d.receiver[c];
        if (r == c) continue;
        const int apart = std::abs(static_cast<int>(c) - static_cast<int>(r));
        const float distance = apart == 1 || apart == n ? dx : dx * 1.41421356f;
        const float strength = in.strength ? in.strength->v[c] : 1.0f;
        const float raised = height_m.v[c] + in.uplift_m * (in.uplift_share ? in.uplift_share->v[c] : 1.0f);
        const float f = in.rate / strength * std::sqrt(d.area_m2.v[c]) / distance;
        const float below = height_m.v[r];
        float h =
            raised > below ? (raised + f * below) / (1 + f) : below + 0.001f;  // a pit is filled to its spill
        h = std::min(h, below + in.steepest * strength * distance);
        height_m.v[c] = h;
    }
}

SedimentBalance carry_sediment(Grid& height_m, Grid& deposit_m, const Drainage& d, double spacing_m,
                               const Transport& t) {
    const int n = height_m.size;
    const double cell = spacing_m * spacing_m;
    Grid area(n, static_cast<float>(cell)), load(n);
    SedimentBalance balance;
    for (size_t at = d.order.size(); at-- > 0;) {
        const uint32_t c = d.order[at];
        const int i = static_cast<int>(c) % n, j = static_cast<int>(c) / n;
        float weight[8] = {}, whole = 0, slope = 0, drop = 1e9f;
        for (int k = 0; k < 8; ++k) {
            const int x = i + kDx[k], y = j + kDy[k];
            if (!inside(x, y, n)) continue;
            const uint32_t other = static_cast<uint32_t>(y * n + x);
            const float fall = d.filled_m.v[c] - d.filled_m.v[other];
            if (fall <= 0) continue;
            const float steep = fall / (kDistance[k] * static_cast<float>(spacing_m));
            weight[k] = steep * std::sqrt(steep) *
                        (k < 4 ? 0.5f : 0.354f);  // Freeman's exponent, his contour lengths
            whole += weight[k];
            slope = std::max(slope, steep);
            drop = std::min(drop, std::max(height_m.v[c] - height_m.v[other], 0.0f));
        }
        if (whole <= 0) {  // an outlet: what arrives leaves the map
            balance.exported_m3 += load.v[c];
            continue;
        }
        const float capacity = t.capacity * std::pow(area.v[c], 0.6f) * slope;
        float& h = height_m.v[c];
        float carried = load.v[c];
        if (carried > capacity) {
            // Never higher than the pit's spill, and not above what the step allows.
            const float room = std::max(d.filled_m.v[c] - h, 0.0f) + t.deepest_m;
            const float layer = std::min(static_cast<float>((carried - capacity) / cell), room);
            h += layer;
            deposit_m.v[c] += layer;
            balance.deposited_m3 += layer * cell;
            carried -= static_cast<float>(layer * cell);
        } else {
            const float layer = std::min(
                {static_cast<float>((capacity - carried) * t.pick_up / cell), t.deepest_m, drop * 0.5f});
            h -= layer;
            deposit_m.v[c] = std::max(deposit_m.v[c] - layer, 0.0f);
            balance.eroded_m3 += layer * cell;
            carried += static_cast<float>(layer * cell);
        }
        for (int k = 0; k < 8; ++k) {
            if (weight[k] <= 0) continue;
            const uint32_t other = static_cast<uint32_t>((j + kDy[k]) * n + i + kDx[k]);
            load.v[other] += carried * weight[k] / whole;
            area.v[other] += area.v[c] * weight[k] / whole;
        }
    }
    return balance;
}

void fill_valleys(Grid& height_m, Grid& deposit_m, const Drainage& d, double spacing_m, float depth_m,
                  float smallest_area_m2) {
    const int n = height_m.size;
    // Up the tree: level of the stream that each sample reaches first, raised by the fill of that stream.
    Grid floor_m(n, -1e9f);
    for (const uint32_t c : d.order) {
        const uint32_t r = d.receiver[c];
        const float area = d.area_m2.v[c];
        if (area >= smallest_area_m2 || r == c)
            floor_m.v[c] = height_m.v[c] + depth_m * std::min(std::pow(area * 1e-6f, 0.35f), 3.0f) *
                                               smooth_step(smallest_area_m2, 6 * smallest_area_m2, area);
        else
            floor_m.v[c] =
                floor_m.v[r] + 0.03f * static_cast<float>(spacing_m);  // rises 3 % away from the stream
    }
    const Grid level = blurred(floor_m, 2, 2);  // neighbours may reach the stream at different places
    parallel_ranges(static_cast<int>(height_m.v.size()), 4096, [&](int begin, int end) {
        for (int c = begin; c < end; ++c) {
            // Smooth maximum over a quarter of the fill: the floor meets the slope in a concave foot.
            const float a = height_m.v[static_cast<size_t>(c)], b = level.v[static_cast<size_t>(c)];
            const float k = depth_m * 0.35f;
            const float t = std::max(k - std::fabs(a - b), 0.0f) / k;
            const float h = std::max(std::max(a, b) + t * t * k * 0.25f, a);
            deposit_m.v[static_cast<size_t>(c)] += h - a;
            height_m.v[static_cast<size_t>(c)] = h;
        }
    });
}

}  // namespace loam::recipe
