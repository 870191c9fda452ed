// The sky behind everything: pixels without the terrain's stencil.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/frame/frame_io.h"
#include "shaders/scene/sky_math.h"
#include "shaders/frame/lighting.glsl"

layout(binding = 0, scalar) readonly buffer Frame { FrameUniforms u; };
layout(location = 0) out vec4 out_color;

void main() {
    vec2 ndc = gl_FragCoord.xy * u.inv_picture_px * 2.0 - 1.0;
    // A point on the near plane: finite for any direction, whereas the far plane is not.
    vec4 near = u.rel_from_clip * vec4(ndc, 1.0, 1.0);
    vec3 direction = normalize(near.xyz / near.w);
    vec3 color = sky_radiance(direction, u.sun_direction.xyz) * u.sun_above.rgb;
    float cos_sun = dot(direction, u.sun_direction.xyz);
    float disc = smoothstep(u.sun_direction.w - 4e-5, u.sun_direction.w, cos_sun);
    color += u.sun_irradiance.rgb * (disc * 30.0);
    // Below the horizon, beyond the map's edge: haze over a ground too far to see, darker the less air lies before it.
    vec3 haze = u.haze_color.rgb + u.haze_sunward.rgb * sunward_lobe(cos_sun);
    vec3 below = mix(haze, u.ground_bounce.rgb * 0.8 + haze * 0.12, smoothstep(0.0, 0.5, -direction.z));
    color = mix(color, below, smoothstep(0.004, -0.012, direction.z));
    out_color = vec4(to_screen(u, color), 1.0);
}
