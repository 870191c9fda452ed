// Vista UVs: ground that is seen from afar looks its textures up a second time, magnified, so that it keeps a structure where the
// plain lookup has become one colour.
// Source: Call of Duty talk, "Vista UVs" and "Vista UVs & VT Don't Mix": albedo and normal are sampled again with scaled-down UVs and
// blended in by the camera's distance; a page knows no camera, so the mip stands for the distance: the finest is meant for up to 5 feet,
// each next one for twice that.
#ifndef LOAM_TEXTURE_VISTA_H
#define LOAM_TEXTURE_VISTA_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kVistaDistance 1524.0f // metres from which a texel of one metre is meant to be seen: 5 feet for one of a millimetre
#define kVistaOctaves 2.0f     // from the distance where the magnified lookup begins to where only it is seen, log2

// Of a texel of 2^log2_texel metres; `log2_begin`: log2 of the largest texel without the magnified lookup.
LOAM_INLINE float vista_weight(float log2_texel, float log2_begin) {
    return clamp((log2_texel - log2_begin) * (1.0f / kVistaOctaves), 0.0f, 1.0f);
}

LOAM_END_SHARED
#endif
