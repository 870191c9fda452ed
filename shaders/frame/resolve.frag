// Every pixel with the terrain's stencil, shaded from the virtual texture.
// Source: Call of Duty talk, "Terrain Rendering": the opaque pass is a full-screen quad over the prepass' stencil.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define VT_FIRST_SLOT 5
#include "shaders/frame/resolve_common.glsl"
#include "shaders/texture/vt_sample.glsl"
#include "shaders/frame/vt_parallax.glsl"

void main() {
    Pixel p = read_pixel();
    ivec2 sector;
    vec2 offset_m;
    vt_split(vt_parallax_place(p), sector, offset_m);
    VtSample t = vt_sample(sector, offset_m, p.log2_long, p.log2_short, p.axis);
    VtMaterial m = t.material;
    Surface s = Surface(m.albedo, bent_normal(p.ground, m.normal), m.gloss, m.occlusion, m.metalness);
    out_color = vec4(lit_pixel(p, s, m.channels, vt.camera_sector + sector, offset_m), 1.0);
}
