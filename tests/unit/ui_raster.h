// The fragment shader of the interface once more, on the CPU: pictures without a device, and what the GPU is
// compared with. Pictures of textures other than the atlas are drawn as their tint.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "ui/draw_list.h"

namespace loam::ui {

struct Canvas {
    int width = 0, height = 0;
    std::vector<float> rgb;  // sRGB-encoded

    Canvas(int w, int h, Color clear) : width(w), height(h) {
        for (int i = 0; i < w * h; ++i)
            rgb.insert(rgb.end(), {float(clear.r) / 255, float(clear.g) / 255, float(clear.b) / 255});
    }
    [[nodiscard]] std::vector<uint8_t> bytes() const {
        std::vector<uint8_t> out;
        for (const float v : rgb) out.push_back(uint8_t(std::clamp(v, 0.0f, 1.0f) * 255.0f + 0.5f));
        return out;
    }
};

inline float rounded_rect_distance(Vec2 p, const UiQuad& q) {
    const float dx = std::abs(p.x - (q.x0 + q.x1) * 0.5f) - (q.x1 - q.x0) * 0.5f + q.radius;
    const float dy = std::abs(p.y - (q.y0 + q.y1) * 0.5f) - (q.y1 - q.y0) * 0.5f + q.radius;
    return std::hypot(std::max(dx, 0.0f), std::max(dy, 0.0f)) + std::min(std::max(dx, dy), 0.0f) - q.radius;
}

inline float capsule_distance(Vec2 p, const UiQuad& q) {
    const Vec2 d{q.uv_x1 - q.uv_x0, q.uv_y1 - q.uv_y0}, a{p.x - q.uv_x0, p.y - q.uv_y0};
    const float t = std::clamp((a.x * d.x + a.y * d.y) / std::max(d.x * d.x + d.y * d.y, 1e-6f), 0.0f, 1.0f);
    return std::hypot(a.x - d.x * t, a.y - d.y * t) - q.radius;
}

inline void rasterise(const DrawList& list, const GlyphAtlas& atlas, Canvas& canvas) {
    for (const UiQuad& q : list.quads()) {
        const float grow = q.kind == kQuadGlyph ? 0.0f : q.kind == kQuadShadow ? q.border_width + 1 : 1.0f;
        const float x0 = std::max(q.x0 - grow, q.clip_x0), x1 = std::min(q.x1 + grow, q.clip_x1);
        const float y0 = std::max(q.y0 - grow, q.clip_y0), y1 = std::min(q.y1 + grow, q.clip_y1);
        for (int y = std::max(0, int(std::ceil(y0 - 0.5f))); y < canvas.height && float(y) + 0.5f < y1; ++y)
            for (int x = std::max(0, int(std::ceil(x0 - 0.5f))); x < canvas.width && float(x) + 0.5f < x1;
                 ++x) {
                const Vec2 p{float(x) + 0.5f, float(y) + 0.5f};
                float inner = 0, outer = 0;
                if (q.kind == kQuadGlyph) {
                    const int u = int(q.uv_x0 + p.x - q.x0), v = int(q.uv_y0 + p.y - q.y0);
                    inner = outer =
                        float(atlas.pixels()[size_t(v) * size_t(atlas.width()) + size_t(u)]) / 255.0f;
                } else if (q.kind == kQuadLine) {
                    inner = outer = std::clamp(0.5f - capsule_distance(p, q), 0.0f, 1.0f);
                } else if (q.kind == kQuadShadow) {
                    const float t =
                        std::clamp(0.5f - rounded_rect_distance(p, q) / (2 * q.border_width), 0.0f, 1.0f);
                    inner = outer = t * t * (3 - 2 * t);
                } else {
                    const float d = rounded_rect_distance(p, q);
                    outer = std::clamp(0.5f - d, 0.0f, 1.0f);
                    inner = q.kind == kQuadShape && q.border_width > 0
                                ? std::clamp(0.5f - (d + q.border_width), 0.0f, 1.0f)
                                : outer;
                }
                const float fill = float(q.fill >> 24) / 255.0f * inner;
                const float border = float(q.border >> 24) / 255.0f * std::max(outer - inner, 0.0f);
                for (int c = 0; c < 3; ++c) {
                    float& to = canvas.rgb[(size_t(y) * size_t(canvas.width) + size_t(x)) * 3 + size_t(c)];
                    to = float(q.fill >> (8 * c) & 255u) / 255.0f * fill +
                         float(q.border >> (8 * c) & 255u) / 255.0f * border + to * (1 - fill - border);
                }
            }
    }
}

}  // namespace loam::ui
