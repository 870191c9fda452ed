// Debug views of the virtual texture's own textures, drawn over the whole picture: the physical texture (left: albedo; right:
// normal and gloss, metalness and occlusion), or the indirection texture, each texel as a colour.
// Source: Call of Duty talk, "Indirection Texture In Action": "the 32 bits indirection pixel interpreted as an albedo color".
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define VT_FIRST_SLOT 5
#include "shaders/frame/resolve_common.glsl"
#include "shaders/texture/vt_sample.glsl"
#include "shaders/frame/debug_view.glsl"

layout(binding = kDebugSquaresSlot, scalar) readonly buffer Squares { VtImageSquare squares[]; };

const vec3 kBackground = vec3(0.11, 0.12, 0.13);

// Position in a square of the picture; outside 0 … 1: not in it.
vec2 in_square(vec2 corner_px, float side_px) {
    return (gl_FragCoord.xy - corner_px) / side_px;
}

bool inside(vec2 at) {
    return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(1.0)));
}

vec3 atlas_color(vec2 at, int part, float side_px) {
    float pages = 1.0 / vt.inv_atlas_pages;
    vec2 page = at * pages;
    ivec2 cell = ivec2(page);
    VtPlaceFacts f = place_facts[cell.y * int(pages + 0.5) + cell.x];
    vec2 in_page = page - vec2(cell);
    float line_px = min(min(in_page.x, in_page.y), min(1.0 - in_page.x, 1.0 - in_page.y)) * side_px / pages;
    if (f.state == kPlaceFree)
        return mod(gl_FragCoord.x + gl_FragCoord.y, 8.0) < 1.0 ? vec3(0.3) : kBackground;
    VtMaterial m = vt_decode(vt_fetch(at, 1.0));
    vec3 color = sqrt(m.albedo);
    if (part == 1) color = vec3(m.normal * 0.5 + 0.5, m.gloss);
    if (part == 2) color = vec3(m.metalness, m.occlusion, 0.0);
    if (f.state == kPlaceResting) color *= 0.3;
    vec3 frame = f.state == kPlaceComposed ? vec3(1.0) : f.popularity > 0u ? vec3(0.2, 0.75, 0.3) : vec3(0.25);
    frame = mix(frame, debug_ramp_color(1.0), f.dirt);
    return line_px < 1.5 ? frame : color;
}

vec3 indirection_color(vec2 at) {
    int side = vt.indirection_size;
    ivec2 texel = ivec2(at * float(side));
    int level = 0;
    if (texel.x >= side) {
        level = 1;
        while (level < 10 && texel.y >= side - (side >> level)) ++level;
        texel -= vt_level_origin(level, side);
        if (texel.x >= side >> level) return kBackground;
    }
    // Outside of the images nothing is defined, so nothing is shown.
    for (int i = 0; squares[i].size > 0; ++i) {
        VtImageSquare square = squares[i];
        int size = square.size >> level;
        ivec2 in_image = texel - (ivec2(square.x, square.y) >> level);
        if (size == 0 || min(in_image.x, in_image.y) < 0 || max(in_image.x, in_image.y) >= size) continue;
        bool rim = min(in_image.x, in_image.y) == 0 || max(in_image.x, in_image.y) == size - 1;
        uint word = texelFetch(vt_indirection, vt_level_origin(level, side) + texel, 0).r;
        vec3 color = word == kNoPage ? vec3(0.0) : hashed_color(word);
        return rim && size > 8 ? mix(color, vec3(1.0), 0.6) : color;
    }
    return kBackground;
}

void main() {
    vec2 size = u.picture_px;
    vec3 color = kBackground;
    float side = min(size.x, size.y);
    if (push.debug_view == kDebugIndirectionMap) {
        float high = min(side, size.x / 1.5);
        vec2 at = in_square(0.5 * (size - vec2(1.5, 1.0) * high), high);
        if (inside(at * vec2(1.0 / 1.5, 1.0))) color = indirection_color(vec2(at.x, 1.0 - at.y));
    } else {
        // The first texture as large as it goes, the others beside it.
        float large = min(side, size.x / 1.5), small = 0.5 * large - 2.0;
        vec2 corner = vec2(0.5 * (size.x - 1.5 * large), 0.5 * (size.y - large));
        vec2 at = in_square(corner, large);
        vec2 upper = in_square(corner + vec2(large + 4.0, 0.0), small);
        vec2 lower = in_square(corner + vec2(large + 4.0, 0.5 * large + 2.0), small);
        if (inside(at)) color = atlas_color(at, 0, large);
        if (inside(upper)) color = atlas_color(upper, 1, small);
        if (inside(lower)) color = atlas_color(lower, 2, small);
    }
    out_color = vec4(color, 1.0);
}
