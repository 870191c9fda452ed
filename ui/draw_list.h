// What to draw, as plain data: instanced quads (shaders/ui/ui_io.h) and runs of them that share a texture. No
// GPU here.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "shaders/ui/ui_io.h"
#include "ui/geometry.h"
#include "ui/text.h"

namespace loam::ui {

using TextureId = uint32_t;
inline constexpr TextureId kAtlasTexture = 0;  // also shapes and lines

struct DrawRun {
    TextureId texture = kAtlasTexture;
    uint32_t first = 0, count = 0;
};

class DrawList {
  public:
    void clear(const Rect& whole);  // `whole` is the lowest clip
    void append(const DrawList& over);

    // Clips nest: the new one is cut to the one below.
    void push_clip(const Rect& rect);
    void pop_clip();
    [[nodiscard]] const Rect& clip() const { return clips_.back(); }
    [[nodiscard]] size_t clip_depth() const { return clips_.size(); }

    void rect(const Rect& r, Color fill, float radius = 0);
    void rect(const Rect& r, Color fill, float radius, Color border, float border_width);
    void shadow(const Rect& r, Color color, float radius, float blur);
    void circle(Vec2 center, float radius, Color fill);
    void line(Vec2 a, Vec2 b, Color color, float width);
    void image(const Rect& r, TextureId texture, const Rect& uv = {0, 0, 1, 1},
               Color tint = {255, 255, 255, 255}, float radius = 0);
    // `baseline` is where the first pen stands; returns the width.
    float text(Text& engine, Vec2 baseline, std::string_view utf8, TextStyle style, Color color);
    void icon(Text& engine, Icon icon, Vec2 center, float size_px, Color color);

    [[nodiscard]] std::span<const UiQuad> quads() const { return quads_; }
    [[nodiscard]] std::span<const DrawRun> runs() const { return runs_; }
    // Equal for equal pictures: lets the application skip presenting the same picture again.
    [[nodiscard]] uint64_t hash() const;

  private:
    void add(TextureId texture, UiQuad quad, float margin);
    std::vector<UiQuad> quads_;
    std::vector<DrawRun> runs_;
    std::vector<Rect> clips_{Rect{}};
};

}  // namespace loam::ui
