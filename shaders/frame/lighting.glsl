// Light on a surface: sun with shadow, sky and bounce light with occlusion, haze, and the way to the screen.
// Used by every resolve (virtual texture, direct), so that they differ in the material only.
#ifndef LOAM_FRAME_LIGHTING_GLSL
#define LOAM_FRAME_LIGHTING_GLSL

struct Surface {
    vec3 albedo;   // linear
    vec3 normal;
    float gloss;   // 1 - roughness
    float occlusion;
    float metalness;
};

// 1 lit, 0 in shadow. `fine`: five taps instead of one (each tap filters 2x2 in hardware).
float sun_visibility(FrameUniforms u, sampler2DShadow shadow_atlas, vec3 rel_m, vec3 normal, bool fine) {
    vec3 light = vec3(dot(u.light_x.xyz, rel_m), dot(u.light_y.xyz, rel_m), dot(u.light_z.xyz, rel_m));
    vec3 tilt = vec3(dot(u.light_x.xyz, normal), dot(u.light_y.xyz, normal), dot(u.light_z.xyz, normal));
    vec3 away = tilt * length(tilt.xy);
    // The finest cascade that contains the point; selects instead of branches, as branches skip no work on SIMD.
    vec3 best = vec3(0.0, 0.0, 1.0);
    vec2 origin = vec2(0.0);
    float valid = 0.0;
    for (int i = kCascadeCount - 1; i >= 0; --i) {
        vec3 moved = light + away * u.cascade_depth[i].z;
        vec2 p = (moved.xy - u.cascade[i].xy) * u.cascade[i].z;
        bool inside = max(abs(p.x), abs(p.y)) < 0.985 && u.cascade_depth[i].w > 0.0;
        best = inside ? vec3(p * 0.5 + 0.5, moved.z * u.cascade_depth[i].x + u.cascade[i].w) : best;
        origin = inside ? vec2(float(i & 1), float(i >> 1)) : origin;
        valid = inside ? 1.0 : valid;
    }
    vec2 uv = (best.xy + origin) * 0.5;
    float lit = texture(shadow_atlas, vec3(uv, best.z));
    if (fine) {
        vec2 texel = 1.2 / vec2(textureSize(shadow_atlas, 0));
        lit += texture(shadow_atlas, vec3(uv + texel * vec2(1.0, 0.4), best.z));
        lit += texture(shadow_atlas, vec3(uv + texel * vec2(-0.4, 1.0), best.z));
        lit += texture(shadow_atlas, vec3(uv + texel * vec2(-1.0, -0.4), best.z));
        lit += texture(shadow_atlas, vec3(uv + texel * vec2(0.4, -1.0), best.z));
        lit *= 0.2;
    }
    return mix(1.0, lit, valid);
}

vec3 shade(FrameUniforms u, Surface s, vec3 to_eye, float visibility, float sky_open) {
    vec3 to_sun = u.sun_direction.xyz;
    float n_l = max(dot(s.normal, to_sun), 0.0);
    float n_v = max(dot(s.normal, to_eye), 1e-3);
    vec3 half_way = normalize(to_sun + to_eye);
    float n_h = max(dot(s.normal, half_way), 0.0);
    float v_h = max(dot(to_eye, half_way), 0.0);
    float roughness = clamp(1.0 - s.gloss, 0.06, 1.0);
    float a2 = roughness * roughness * roughness * roughness;
    float d = n_h * n_h * (a2 - 1.0) + 1.0;
    float k = roughness * roughness * 0.5;
    // GGX with Smith's shadowing in Schlick's form.
    float specular = a2 / (3.1415927 * d * d) * 0.25 / ((n_l * (1.0 - k) + k) * (n_v * (1.0 - k) + k));
    vec3 f0 = mix(vec3(0.04), s.albedo, s.metalness);
    float fresnel = exp2((-5.55473 * v_h - 6.98316) * v_h);
    vec3 reflected = f0 + (1.0 - f0) * fresnel;
    vec3 diffuse = s.albedo * (1.0 - s.metalness) * 0.31830989;
    vec3 sun = u.sun_irradiance.rgb * (n_l * visibility) * (diffuse + reflected * min(specular, 8.0));

    float open = s.occlusion * sky_open;
    vec3 around = mix(u.ground_bounce.rgb, u.sky_ambient.rgb, clamp(0.5 + 0.5 * s.normal.z, 0.0, 1.0));
    // Light between neighbouring ground: bright ground is darkened less (Jimenez et al. 2016, multi-bounce occlusion).
    vec3 bounce = vec3(open) + (1.0 - open) * 0.45 * s.albedo;
    vec3 ambient = around * bounce * (s.albedo * (1.0 - s.metalness) + f0 * 0.5 * s.gloss * open);
    return sun + ambient;
}

// Light that haze adds around the sun: a lobe of the sixth power.
float sunward_lobe(float cos_sun) {
    float c = max(cos_sun, 0.0);
    return c * c * c * (c * c * c);
}

// Haze between the surface and the eye: extinction that falls off exponentially with height, integrated along the
// ray (its part at the eye's height comes with the uniforms, as it is one for the picture). Blue leaves the view sooner and
// arrives sooner, so that far hills turn blue.
vec3 apply_haze(FrameUniforms u, vec3 color, vec3 rel_m) {
    float distance_m = max(length(rel_m), 1e-4);
    float rise = clamp(rel_m.z / u.ground_bounce.w, -20.0, 20.0);
    float mean = abs(rise) > 1e-3 ? (1.0 - exp(-rise)) / rise : 1.0 - 0.5 * rise;
    vec3 t = exp(-min(u.sky_ambient.w * mean * distance_m, 60.0) * vec3(0.75, 1.0, 1.4));
    float cos_sun = dot(rel_m, u.sun_direction.xyz) / distance_m;
    vec3 haze = u.haze_color.rgb + u.haze_sunward.rgb * sunward_lobe(cos_sun);
    return color * t + haze * (1.0 - t);
}

// Exposure, a filmic curve (Narkowicz 2015, fit of the ACES reference), sRGB encoding. The encoding's power is a sum of square
// roots, which are cheap where powers are not: fitted by least squares, largest error 0.008 of 1/255.
vec3 to_screen(FrameUniforms u, vec3 radiance) {
    vec3 x = max(radiance * (u.sun_irradiance.w * 0.62), 0.0);
    vec3 c = clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
    vec3 s1 = sqrt(c), s2 = sqrt(s1), s3 = sqrt(s2);
    vec3 curve = 0.65398832 * s1 + 0.68870513 * s2 - 0.31846734 * s3 - 0.02018848 * c - 0.00406894;
    return mix(curve, 12.92 * c, lessThan(c, vec3(0.0031308)));
}

#endif
