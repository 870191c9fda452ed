// Rectangles. World rectangles are in metres (X east, Y north), closed; texel rectangles are half open.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/vec2.hpp>

namespace loam {

struct WorldRect {
    double min_x = 0, min_y = 0, max_x = -1, max_y = -1; // empty by default

    [[nodiscard]] bool empty() const { return !(min_x <= max_x && min_y <= max_y); }
    [[nodiscard]] double width() const { return max_x - min_x; }
    [[nodiscard]] double height() const { return max_y - min_y; }
    [[nodiscard]] glm::dvec2 center() const { return {(min_x + max_x) * 0.5, (min_y + max_y) * 0.5}; }
    [[nodiscard]] WorldRect grown(double by_m) const {
        return {min_x - by_m, min_y - by_m, max_x + by_m, max_y + by_m};
    }
    [[nodiscard]] bool overlaps(const WorldRect& o) const {
        return !empty() && !o.empty() && min_x <= o.max_x && o.min_x <= max_x && min_y <= o.max_y && o.min_y <= max_y;
    }
    [[nodiscard]] bool contains(double x, double y) const {
        return x >= min_x && x <= max_x && y >= min_y && y <= max_y;
    }
    // Distance from a point to the rectangle, 0 inside.
    [[nodiscard]] double distance(double x, double y) const {
        const double dx = std::max({min_x - x, 0.0, x - max_x});
        const double dy = std::max({min_y - y, 0.0, y - max_y});
        return std::sqrt(dx * dx + dy * dy);
    }
    bool operator==(const WorldRect&) const = default;
};

[[nodiscard]] inline WorldRect united(const WorldRect& a, const WorldRect& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.min_x, b.min_x), std::min(a.min_y, b.min_y), std::max(a.max_x, b.max_x),
            std::max(a.max_y, b.max_y)};
}

[[nodiscard]] inline WorldRect intersected(const WorldRect& a, const WorldRect& b) {
    return {std::max(a.min_x, b.min_x), std::max(a.min_y, b.min_y), std::min(a.max_x, b.max_x),
            std::min(a.max_y, b.max_y)};
}

struct TexelRect {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0; // half open

    [[nodiscard]] bool empty() const { return x1 <= x0 || y1 <= y0; }
    [[nodiscard]] int width() const { return x1 - x0; }
    [[nodiscard]] int height() const { return y1 - y0; }
    [[nodiscard]] int64_t area() const { return empty() ? 0 : int64_t(width()) * height(); }
    bool operator==(const TexelRect&) const = default;
};

[[nodiscard]] inline TexelRect united(const TexelRect& a, const TexelRect& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    return {std::min(a.x0, b.x0), std::min(a.y0, b.y0), std::max(a.x1, b.x1), std::max(a.y1, b.y1)};
}

[[nodiscard]] inline TexelRect intersected(const TexelRect& a, const TexelRect& b) {
    return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

// Grown outwards to multiples of `step` (blocks, tiles), then clipped to [0, size)².
[[nodiscard]] inline TexelRect aligned_out(const TexelRect& r, int step, int size) {
    const auto down = [step](int v) { return v >= 0 ? v / step * step : -((-v + step - 1) / step * step); };
    const auto up = [&](int v) { return -down(-v); };
    return intersected(TexelRect{down(r.x0), down(r.y0), up(r.x1), up(r.y1)}, TexelRect{0, 0, size, size});
}

} // namespace loam
