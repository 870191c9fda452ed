// Points, rectangles and colours of the interface. Positions are physical pixels, X right, Y down, origin at
// the top left of the window. Rectangles are half open. Colours are sRGB-encoded with straight alpha.
#pragma once

#include <algorithm>
#include <cstdint>

namespace loam::ui {

struct Vec2 {
    float x = 0, y = 0;
    bool operator==(const Vec2&) const = default;
};
[[nodiscard]] constexpr Vec2 operator+(Vec2 a, Vec2 b) {
    return {a.x + b.x, a.y + b.y};
}
[[nodiscard]] constexpr Vec2 operator-(Vec2 a, Vec2 b) {
    return {a.x - b.x, a.y - b.y};
}
[[nodiscard]] constexpr Vec2 operator*(Vec2 a, float s) {
    return {a.x * s, a.y * s};
}

struct Rect {
    float x = 0, y = 0, w = 0, h = 0;

    [[nodiscard]] constexpr float right() const { return x + w; }
    [[nodiscard]] constexpr float bottom() const { return y + h; }
    [[nodiscard]] constexpr Vec2 center() const { return {x + w * 0.5f, y + h * 0.5f}; }
    [[nodiscard]] constexpr bool empty() const { return !(w > 0 && h > 0); }
    [[nodiscard]] constexpr bool contains(Vec2 p) const {
        return p.x >= x && p.x < right() && p.y >= y && p.y < bottom();
    }
    [[nodiscard]] constexpr Rect inset(float dx, float dy) const {
        return {x + dx, y + dy, std::max(0.0f, w - 2 * dx), std::max(0.0f, h - 2 * dy)};
    }
    [[nodiscard]] constexpr Rect inset(float d) const { return inset(d, d); }
    [[nodiscard]] constexpr Rect grown(float d) const { return {x - d, y - d, w + 2 * d, h + 2 * d}; }
    bool operator==(const Rect&) const = default;
};

[[nodiscard]] constexpr Rect intersected(const Rect& a, const Rect& b) {
    const float x0 = std::max(a.x, b.x), y0 = std::max(a.y, b.y);
    const float x1 = std::min(a.right(), b.right()), y1 = std::min(a.bottom(), b.bottom());
    return {x0, y0, std::max(0.0f, x1 - x0), std::max(0.0f, y1 - y0)};
}

enum class Edge { left, right, top, bottom };

// Cuts a strip off `area` and returns it; the strip is never larger than what is there.
constexpr Rect cut(Rect& area, Edge edge, float size) {
    Rect strip = area;
    if (edge == Edge::left || edge == Edge::right) {
        strip.w = std::clamp(size, 0.0f, std::max(0.0f, area.w));
        if (edge == Edge::right) strip.x = area.right() - strip.w;
        if (edge == Edge::left) area.x += strip.w;
        area.w -= strip.w;
    } else {
        strip.h = std::clamp(size, 0.0f, std::max(0.0f, area.h));
        if (edge == Edge::bottom) strip.y = area.bottom() - strip.h;
        if (edge == Edge::top) area.y += strip.h;
        area.h -= strip.h;
    }
    return strip;
}

struct Color {
    uint8_t r = 0, g = 0, b = 0, a = 255;

    [[nodiscard]] static constexpr Color hex(uint32_t rgb, uint8_t alpha = 255) {
        return {uint8_t(rgb >> 16), uint8_t(rgb >> 8), uint8_t(rgb), alpha};
    }
    // Little-endian RGBA8, what unpackUnorm4x8 reads.
    [[nodiscard]] constexpr uint32_t packed() const {
        return uint32_t(r) | uint32_t(g) << 8 | uint32_t(b) << 16 | uint32_t(a) << 24;
    }
    [[nodiscard]] constexpr Color faded(float opacity) const {
        return {r, g, b, uint8_t(float(a) * std::clamp(opacity, 0.0f, 1.0f) + 0.5f)};
    }
    bool operator==(const Color&) const = default;
};
inline constexpr Color kTransparent{0, 0, 0, 0};

}  // namespace loam::ui
