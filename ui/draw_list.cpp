#include "ui/draw_list.h"

#include <cmath>
#include <cstring>

#include "runtime/base/check.h"

namespace loam::ui {
namespace {

UiQuad quad(const Rect& r, Color fill, uint32_t kind) {
    UiQuad q{};
    q.x0 = r.x, q.y0 = r.y, q.x1 = r.right(), q.y1 = r.bottom();
    q.fill = fill.packed();
    q.kind = kind;
    return q;
}

}  // namespace

void DrawList::clear(const Rect& whole) {
    quads_.clear();
    runs_.clear();
    clips_.assign(1, whole);
}

void DrawList::append(const DrawList& over) {
    const auto base = uint32_t(quads_.size());
    quads_.insert(quads_.end(), over.quads_.begin(), over.quads_.end());
    for (DrawRun run : over.runs_) {
        run.first += base;
        if (!runs_.empty() && runs_.back().texture == run.texture)
            runs_.back().count += run.count;
        else
            runs_.push_back(run);
    }
}

void DrawList::push_clip(const Rect& rect) {
    clips_.push_back(intersected(clips_.back(), rect));
}

void DrawList::pop_clip() {
    LOAM_CHECK(clips_.size() > 1, "pop_clip without push_clip");
    clips_.pop_back();
}

void DrawList::add(TextureId texture, UiQuad q, float margin) {
    const Rect& c = clips_.back();
    const bool outside = q.x1 + margin <= c.x || q.y1 + margin <= c.y || q.x0 - margin >= c.right() ||
                         q.y0 - margin >= c.bottom();
    if (outside || c.empty() || !std::isfinite(q.x0 + q.x1 + q.y0 + q.y1)) return;
    q.clip_x0 = c.x, q.clip_y0 = c.y, q.clip_x1 = c.right(), q.clip_y1 = c.bottom();
    if (runs_.empty() || runs_.back().texture != texture)
        runs_.push_back({texture, uint32_t(quads_.size()), 0});
    quads_.push_back(q);
    ++runs_.back().count;
}

void DrawList::rect(const Rect& r, Color fill, float radius) {
    rect(r, fill, radius, kTransparent, 0);
}

void DrawList::rect(const Rect& r, Color fill, float radius, Color border, float border_width) {
    if (r.empty()) return;
    UiQuad q = quad(r, fill, kQuadShape);
    q.radius = std::min(radius, std::min(r.w, r.h) * 0.5f);
    q.border = border.packed();
    q.border_width = border_width;
    add(kAtlasTexture, q, 1);
}

void DrawList::shadow(const Rect& r, Color color, float radius, float blur) {
    if (r.empty() || blur <= 0) return;
    UiQuad q = quad(r, color, kQuadShadow);
    q.radius = std::min(radius, std::min(r.w, r.h) * 0.5f);
    q.border_width = blur;
    add(kAtlasTexture, q, blur + 1);
}

void DrawList::circle(Vec2 c, float radius, Color fill) {
    rect({c.x - radius, c.y - radius, 2 * radius, 2 * radius}, fill, radius);
}

void DrawList::line(Vec2 a, Vec2 b, Color color, float width) {
    const float r = width * 0.5f;
    const float x0 = std::min(a.x, b.x) - r, y0 = std::min(a.y, b.y) - r;
    UiQuad q = quad({x0, y0, std::max(a.x, b.x) + r - x0, std::max(a.y, b.y) + r - y0}, color, kQuadLine);
    q.uv_x0 = a.x, q.uv_y0 = a.y, q.uv_x1 = b.x, q.uv_y1 = b.y;
    q.radius = r;
    add(kAtlasTexture, q, 1);
}

void DrawList::image(const Rect& r, TextureId texture, const Rect& uv, Color tint, float radius) {
    if (r.empty()) return;
    LOAM_CHECK(texture != kAtlasTexture, "texture 0 is the glyph atlas");
    UiQuad q = quad(r, tint, kQuadImage);
    q.uv_x0 = uv.x, q.uv_y0 = uv.y, q.uv_x1 = uv.right(), q.uv_y1 = uv.bottom();
    q.radius = std::min(radius, std::min(r.w, r.h) * 0.5f);
    add(texture, q, 1);
}

float DrawList::text(Text& engine, Vec2 baseline, std::string_view utf8, TextStyle style, Color color) {
    const ShapedText& shaped = engine.shape(utf8, style);
    const float base_y = std::round(baseline.y);
    for (const ShapedGlyph& g : shaped.glyphs) {
        const float pen = std::round((baseline.x + g.x) * 4.0f) / 4.0f;
        if (g.face < 0) {
            const float size = style.size_px;
            rect({std::round(pen + size * 0.06f), std::round(base_y - size * 0.7f),
                  std::round(g.advance - size * 0.12f), std::round(size * 0.7f)},
                 kTransparent, 1, color, 1);
            continue;
        }
        const float whole = std::floor(pen);
        const AtlasSlot slot = engine.glyph_slot(g, style, int((pen - whole) * 4.0f));
        if (slot.texels.empty()) continue;
        UiQuad q = quad({whole + float(slot.left), base_y + std::round(g.y) - float(slot.top),
                         float(slot.texels.width()), float(slot.texels.height())},
                        color, kQuadGlyph);
        q.uv_x0 = float(slot.texels.x0), q.uv_y0 = float(slot.texels.y0);
        q.uv_x1 = float(slot.texels.x1), q.uv_y1 = float(slot.texels.y1);
        add(kAtlasTexture, q, 0);
    }
    return shaped.width;
}

void DrawList::icon(Text& engine, Icon icon, Vec2 center, float size_px, Color color) {
    const int size = std::max(1, int(std::lround(size_px)));
    const AtlasSlot slot = engine.icon_slot(icon, size);
    if (slot.texels.empty()) return;
    UiQuad q = quad({std::round(center.x - float(size) * 0.5f), std::round(center.y - float(size) * 0.5f),
                     float(size), float(size)},
                    color, kQuadGlyph);
    q.uv_x0 = float(slot.texels.x0), q.uv_y0 = float(slot.texels.y0);
    q.uv_x1 = float(slot.texels.x1), q.uv_y1 = float(slot.texels.y1);
    add(kAtlasTexture, q, 0);
}

uint64_t DrawList::hash() const {
    uint64_t h = 1469598103934665603ull;  // FNV-1a, a word at a time
    const auto mix = [&h](const void* data, size_t bytes) {
        for (size_t i = 0; i + 4 <= bytes; i += 4) {
            uint32_t word;
            std::memcpy(&word, static_cast<const char*>(data) + i, 4);
            h = (h ^ word) * 1099511628211ull;
        }
    };
    mix(quads_.data(), quads_.size() * sizeof(UiQuad));
    mix(runs_.data(), runs_.size() * sizeof(DrawRun));
    return h;
}

}  // namespace loam::ui
