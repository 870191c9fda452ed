// Block compression of a whole image: formats and parameters of encode_image.comp.
#ifndef LOAM_TEXTURE_ENCODE_IO_H
#define LOAM_TEXTURE_ENCODE_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// | format | texels a side | bytes | channels |
#define kEncodeBc1 0     // 4, 8, rgb
#define kEncodeBc1Fine 1 // 4, 8, rgb: for baking
#define kEncodeBc3 2     // 4, 16, rgba
#define kEncodeBc4 3     // 4, 8, r
#define kEncodeAstc4x4 4 // 4, 16, rgba
#define kEncodeAstc6x6 5 // 6, 16, rgba

struct EncodeImagePush {
    ivec2 size;   // texels; blocks that reach over the edge repeat its texels
    ivec2 blocks; // a row, a column
    vec3 weights; // of the colour channels' squared errors
};

LOAM_END_SHARED
#endif
