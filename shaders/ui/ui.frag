#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/ui/ui_io.h"

// 1: pictures, sampled with filtering. 0: shapes, lines, glyphs; the atlas is fetched texel by texel. Two pipelines,
// because branches alone save nothing on a software device.
layout(constant_id = 0) const uint kImages = 0u;

layout(set = 0, binding = 1) uniform sampler2D image;

layout(location = 0) in vec2 in_position;
layout(location = 1) in vec2 in_uv;
layout(location = 2) flat in vec4 in_rect;
layout(location = 3) flat in vec4 in_fill;
layout(location = 4) flat in vec4 in_border;
layout(location = 5) flat in vec2 in_shape;
layout(location = 6) flat in uint in_kind;

layout(location = 0) out vec4 out_color; // premultiplied, sRGB-encoded

// Signed distance to a rounded rectangle, negative inside.
float rounded_rect(vec2 p, vec4 rect, float radius) {
    const vec2 half_size = (rect.zw - rect.xy) * 0.5;
    const vec2 d = abs(p - (rect.xy + rect.zw) * 0.5) - half_size + radius;
    return length(max(d, 0.0)) + min(max(d.x, d.y), 0.0) - radius;
}

float capsule(vec2 p, vec4 ends, float radius) {
    const vec2 d = ends.zw - ends.xy, q = p - ends.xy;
    const float t = clamp(dot(q, d) / max(dot(d, d), 1e-6), 0.0, 1.0);
    return length(q - d * t) - radius;
}

vec4 premultiplied(vec4 c, float coverage) {
    const float a = c.a * coverage;
    return vec4(c.rgb * a, a);
}

void main() {
    if (kImages != 0u) {
        const float inside = clamp(0.5 - rounded_rect(in_position, in_rect, in_shape.x), 0.0, 1.0);
        out_color = premultiplied(texture(image, in_uv) * in_fill, inside);
        return;
    }
    if (in_kind == kQuadGlyph) {
        out_color = premultiplied(in_fill, texelFetch(image, ivec2(in_uv), 0).r);
        return;
    }
    if (in_kind == kQuadLine) {
        out_color = premultiplied(in_fill, clamp(0.5 - capsule(in_position, in_rect, in_shape.x), 0.0, 1.0));
        return;
    }
    const float d = rounded_rect(in_position, in_rect, in_shape.x);
    if (in_kind == kQuadShadow) {
        const float t = clamp(0.5 - d / (2.0 * in_shape.y), 0.0, 1.0);
        out_color = premultiplied(in_fill, t * t * (3.0 - 2.0 * t));
        return;
    }
    const float outer = clamp(0.5 - d, 0.0, 1.0);
    const float inner = in_shape.y > 0.0 ? clamp(0.5 - (d + in_shape.y), 0.0, 1.0) : outer;
    out_color = premultiplied(in_fill, inner) + premultiplied(in_border, max(outer - inner, 0.0));
}
