// What a frame is asked to look like; the same for the window, the command line and benches.
#pragma once

#include <glm/vec2.hpp>

namespace loam {

// direct: the reference's per-pixel evaluation; direct_texels: the same at the texels that pages would have,
// trilinear between them, so that only paging is between it and the virtual texture.
enum class Shading { virtual_texture, direct, direct_texels };
// mips: of the page shown; indirection: the texel as a colour. Numbered as in shaders/frame/debug_view.glsl.
enum class DebugView { none, mips, sectors, normals, occlusion, indirection, shadow, albedo };

struct FrameSettings {
    Shading shading = Shading::virtual_texture;
    DebugView debug = DebugView::none;
    float render_scale = 1.0f;  // share of the picture's width and height that is shaded
    bool fine_filter = true;    // trilinear between page mips and so on; off while moving on software devices
    glm::dvec2 jitter_px{0, 0};
    float footprint_bias = 0;  // direct shading: log2, negative leaves filtering to supersampling
    int page_budget = -1;      // overrides RendererDesc::page_budget when >= 0
};

}  // namespace loam
