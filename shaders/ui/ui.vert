#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/ui/ui_io.h"

layout(scalar, set = 0, binding = 0) readonly buffer Quads { UiQuad quads[]; };
layout(scalar, push_constant) uniform Push { UiPush push; };

layout(location = 0) out vec2 out_position;   // pixels
layout(location = 1) out vec2 out_uv;
layout(location = 2) flat out vec4 out_rect;  // pixels; line: its end points
layout(location = 3) flat out vec4 out_fill;
layout(location = 4) flat out vec4 out_border;
layout(location = 5) flat out vec2 out_shape; // radius, border width
layout(location = 6) flat out uint out_kind;

void main() {
    const UiQuad q = quads[gl_InstanceIndex];
    const vec4 rect = vec4(q.x0, q.y0, q.x1, q.y1);
    const float grow = q.kind == kQuadGlyph ? 0.0 : q.kind == kQuadShadow ? q.border_width + 1.0 : 1.0;
    const uint corner = gl_VertexIndex; // strip: 0 1 2 3
    const vec2 unit = vec2(corner & 1u, corner >> 1u);
    // Clipping moves the corners, so no pixel outside is ever shaded.
    const vec2 clip_min = vec2(q.clip_x0, q.clip_y0), clip_max = max(clip_min, vec2(q.clip_x1, q.clip_y1));
    const vec2 position = clamp(mix(rect.xy - grow, rect.zw + grow, unit), clip_min, clip_max);

    out_position = position;
    const vec2 size = max(rect.zw - rect.xy, vec2(1e-6));
    out_uv = mix(vec2(q.uv_x0, q.uv_y0), vec2(q.uv_x1, q.uv_y1), (position - rect.xy) / size);
    out_rect = q.kind == kQuadLine ? vec4(q.uv_x0, q.uv_y0, q.uv_x1, q.uv_y1) : rect;
    out_fill = unpackUnorm4x8(q.fill);
    out_border = unpackUnorm4x8(q.border);
    out_shape = vec2(q.radius, q.border_width);
    out_kind = q.kind;
    gl_Position = vec4(position * vec2(push.scale_x, push.scale_y) - 1.0, 0.0, 1.0);
}
