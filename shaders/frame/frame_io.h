// What every pass of the frame knows. Camera-relative throughout: positions are metres from the camera, axes as the world's.
#ifndef LOAM_FRAME_IO_H
#define LOAM_FRAME_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// G-buffer (RGBA16F): x, y normal of the height field (z is positive), z log2 of the pixel footprint's long axis on the ground plane in metres,
// w log2 of its short axis in metres. Footprints are of the terrain's x, y coordinates, as the virtual texture is projected from above.

struct FrameUniforms {
    mat4 clip_from_rel;      // camera-relative metres to clip, reversed Z, infinite far plane
    mat4 rel_from_clip;
    vec4 sun_direction;      // to the sun, w: cosine of its angular radius
    vec4 sun_radiance;       // linear RGB of direct sunlight, w: exposure
    vec4 sky_zenith;         // linear RGB, w: haze extinction 1/m at sea level
    vec4 sky_horizon;        // linear RGB, w: haze scale height m
    vec4 sky_sunward;        // linear RGB added towards the sun, w: unused
    vec4 ground_bounce;      // linear RGB of light from below, w: unused
    vec2 picture_px;         // size of the picture rendered
    vec2 inv_picture_px;
    float camera_z_m;        // height of the camera above 0
    float near_m;
    uint frame;
    uint flags;
    mat4 shadow_from_rel[4]; // camera-relative metres to the cascade's square of the shadow atlas, z depth
    vec4 shadow_scale[4];    // x: metres a texel, y: bias m, z: 1 if the cascade is valid, w: half size m
};

LOAM_END_SHARED
#endif
