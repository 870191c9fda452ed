// How the picture filters the virtual texture. The arithmetic is shaders/texture/filter_math.h.
#pragma once

#include <cmath>

#include "shaders/texture/filter_math.h"

namespace loam {

// bilinear: the nearer mip of the page; trilinear: both; anisotropic_tiles: up to eight taps along a
// footprint's long axis, by classes of 8x8 pixels; anisotropic_hardware: by the sampler.
enum class Filter { bilinear, trilinear, anisotropic_tiles, anisotropic_hardware };

[[nodiscard]] constexpr bool is_anisotropic(Filter filter) {
    return filter == Filter::anisotropic_tiles || filter == Filter::anisotropic_hardware;
}

// What filter_log2_texel() takes beside the footprint.
struct FilterRule {
    float short_share = 0.5f;  // one tap: as the talk's mipBias, 0 is blurry and 1 aliased
    float log2_taps = 64;      // no bound
};
[[nodiscard]] inline FilterRule filter_rule(Filter filter, int most_taps) {
    if (!is_anisotropic(filter)) return {};
    return {1, std::log2(float(most_taps))};
}

}  // namespace loam
