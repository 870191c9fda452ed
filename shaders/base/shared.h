// Prelude of every header that GLSL and C++ both include. C++ sees GLSL's names through GLM; functions are
// `LOAM_INLINE`. GPU structs use members of 4 bytes only (float, int, uint and vectors and matrices of them), so
// that scalar layout has no padding; a test compares SPIR-V offsets with offsetof.
#ifndef LOAM_SHADERS_BASE_SHARED_H
#define LOAM_SHADERS_BASE_SHARED_H

#ifdef __cplusplus

#include <cmath>
#include <cstdint>

#include <glm/glm.hpp>

#define LOAM_INLINE inline
#define LOAM_BEGIN_SHARED namespace loam::shared {
#define LOAM_END_SHARED }

namespace loam::shared {
using glm::ivec2;
using glm::ivec4;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;
using uint = uint32_t;
using glm::abs;
using glm::clamp;
using glm::cross;
using glm::dot;
using glm::exp2;
using glm::floor;
using glm::fract;
using glm::length;
using glm::log2;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::smoothstep;
using glm::sqrt;
using std::atan2;
using std::cos;
using std::exp;
using std::sin;
} // namespace loam::shared

#else

#define LOAM_INLINE
#define LOAM_BEGIN_SHARED
#define LOAM_END_SHARED
#define atan2(y, x) atan(y, x)

#endif

#endif
