// Imagery as the far look of the ground: how a page of it lies in an index page.
#ifndef LOAM_TEXTURE_IMAGERY_H
#define LOAM_TEXTURE_IMAGERY_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kImageryDensity 2 // imagery texels an index texel; they cover squares, index texels stand at corners
#define kImageryPageTexels 528

LOAM_END_SHARED
#endif
