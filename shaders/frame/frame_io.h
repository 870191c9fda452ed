// What every pass of the frame knows. Camera-relative throughout: positions are metres from the camera, axes as the world's.
#ifndef LOAM_FRAME_IO_H
#define LOAM_FRAME_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// G-buffer (RGBA16F): x, y normal of the height field (z is positive), z log2 of the pixel footprint's long axis on the ground plane in metres,
// w log2 of its short axis in metres. Footprints are of the terrain's x, y coordinates, as the virtual texture is projected from above.
// Beside it (RG8): x ambient occlusion, y direction of the long axis (shaders/geometry/pixel_ellipse_math.h).

#define kCascadeCount 4

struct FrameUniforms {
    mat4 clip_from_rel;      // camera-relative metres to clip, reversed Z, infinite far plane
    mat4 rel_from_clip;
    vec4 sun_direction;      // to the sun, w: cosine of its angular radius
    vec4 sun_irradiance;     // linear RGB on a surface facing the sun, w: exposure
    vec4 sun_above;          // linear RGB above the atmosphere (scales sky_radiance), w: unused
    vec4 sky_ambient;        // linear RGB irradiance / pi of the open sky on level ground, w: haze extinction 1/m at the eye's height
    vec4 ground_bounce;      // linear RGB irradiance / pi from below, w: haze scale height m
    vec4 haze_color;         // linear RGB radiance of thick haze away from the sun, w: unused
    vec4 haze_sunward;       // linear RGB added around the sun, w: unused
    vec2 picture_px;         // size of the picture rendered
    vec2 inv_picture_px;
    uint frame;
    uint flags;
    vec4 light_x, light_y, light_z;  // rows of the light's axes (x, y across, z to the sun); w: unused
    vec4 cascade[kCascadeCount];     // camera-relative centre in light space x, y; 1 / half size; depth of l.z = 0
    vec4 cascade_depth[kCascadeCount]; // depth per metre of l.z; texel m; bias m along the normal; 1 if valid
};

LOAM_END_SHARED
#endif
