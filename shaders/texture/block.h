// What the block encoders share. A block's texels are an array, row by row from the lowest address, values 0…1; what is not a number
// counts as 0 and what lies outside is clamped.
#ifndef LOAM_TEXTURE_BLOCK_H
#define LOAM_TEXTURE_BLOCK_H
#include "shaders/base/shared.h"
// Arrays as parameters, in both languages.
// LOAM_STATE … LOAM_END_STATE: variables and functions that use them; members of a struct in C++, globals in GLSL, where passing large
// arrays would copy them, element by element, at every call.
// LOAM_ROLLED: a loop that a shader compiler should leave one.
#ifdef __cplusplus
#define LOAM_ARRAY_IN(type, name, count) const type(&name)[count]
#define LOAM_STATE(name) struct name {
#define LOAM_STATE_WITH(name, base) struct name : base {
#define LOAM_END_STATE };
#define LOAM_ROLLED
#else
#define LOAM_ARRAY_IN(type, name, count) in type name[count]
#define LOAM_STATE(name)
#define LOAM_STATE_WITH(name, base)
#define LOAM_END_STATE
#define LOAM_ROLLED [[dont_unroll]]
#endif
LOAM_BEGIN_SHARED

// The comparison is false for what is not a number.
LOAM_INLINE float block_unit(float x) {
    return x > 0.0f ? min(x, 1.0f) : 0.0f;
}
LOAM_INLINE vec3 block_unit3(vec3 c) {
    return vec3(block_unit(c.x), block_unit(c.y), block_unit(c.z));
}

LOAM_END_SHARED
#endif
