// What a frame is asked to look like; the same for the window, the command line and benches.
#pragma once

#include <optional>

#include <glm/vec2.hpp>

#include "runtime/texture/filter.h"

namespace loam {

// direct: the reference's per-pixel evaluation; direct_texels: the same at the texels that pages would have,
// trilinear between them, so that only paging is between it and the virtual texture.
enum class Shading { virtual_texture, direct, direct_texels };
// Numbered as in shaders/frame/debug_io.h; what each shows: debug_views.h.
enum class DebugView {
    none,
    mips,
    sectors,
    normals,
    occlusion,
    indirection,
    shadow,
    albedo,
    wanted,
    coarser,
    age,
    requests,
    dirt,
    cost,
    decals,
    heights,
    atlas,
    indirection_map,
    thermal,
    count
};

struct FrameSettings {
    Shading shading = Shading::virtual_texture;
    DebugView debug = DebugView::none;
    float render_scale = 1.0f;  // share of the picture's width and height that is shaded
    // Nothing moves and nobody works: no frame time is kept, so that shadows are exact and every pixel gets
    // its page.
    bool at_rest = true;
    std::optional<Filter>
        filter;  // of the virtual texture; none: what the device does best at rest, cheaply in motion
    int most_taps = kMaxTaps;  // anisotropic_tiles: 2, 4 or 8
    glm::dvec2 jitter_px{0, 0};
    float footprint_bias = 0;  // direct shading: log2; supersampling sets it (supersample_bias)
    int parallax_steps = 16;  // of the search for what lies under the surface (shaders/frame/parallax_math.h)
    int page_budget = -1;      // overrides RendererDesc::page_budget when >= 0
};

}  // namespace loam
