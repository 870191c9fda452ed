// The interface's one instance format, shared by shaders/ui/* and ui/draw_list.h. Scalar layout, 4-byte
// members. A quad covers `rect` (grown by a pixel for antialiasing, or by the blur of a shadow), cut to
// `clip`.
#ifndef LOAM_SHADERS_UI_UI_IO_H
#define LOAM_SHADERS_UI_UI_IO_H

#ifdef __cplusplus
#include <cstdint>
namespace loam::ui {
using uint = uint32_t;
#endif

const uint kQuadShape = 0u;   // rounded rectangle: fill and inner border
const uint kQuadGlyph = 1u;   // coverage of the atlas at uv (texels) × fill; rect lies on whole pixels
const uint kQuadLine = 2u;    // capsule from (uv_x0, uv_y0) to (uv_x1, uv_y1), half width `radius`
const uint kQuadShadow = 3u;  // rounded rectangle with its edge blurred over `border_width` pixels
const uint kQuadImage = 4u;   // picture at uv (0 … 1) × fill, corners rounded

struct UiQuad {
    float x0, y0, x1, y1;  // physical pixels
    float clip_x0, clip_y0, clip_x1, clip_y1;
    float uv_x0, uv_y0, uv_x1, uv_y1;  // by kind
    uint fill;                         // RGBA8, sRGB-encoded, straight alpha
    uint border;                       // the same, for the border
    float radius;                      // pixels
    float border_width;                // pixels; shadow: blur
    uint kind;                         // kQuad…
};

struct UiPush {
    float scale_x, scale_y;  // pixels → clip space: 2 / size
};

const uint kUiQuadSlot = 0u;   // storage buffer of UiQuad
const uint kUiImageSlot = 1u;  // atlas or picture

#ifdef __cplusplus
}  // namespace loam::ui
#endif
#endif
