// Half floats from floats, round to nearest even. Values beyond a half's range become infinity; NaN stays
// NaN. Source: Fabian Giesen, "float->half variants" (public domain), the variant that lets the FPU round
// denormals.
#pragma once

#include <bit>
#include <cstdint>

namespace loam {

[[nodiscard]] inline uint16_t half_from_float(float value) {
    constexpr uint32_t kInfinity32 = 255u << 23, kOverflow16 = (127u + 16u) << 23;
    constexpr uint32_t kDenormalMagic = ((127u - 15u) + (23u - 10u) + 1u) << 23;
    uint32_t bits = std::bit_cast<uint32_t>(value);
    const uint32_t sign = bits & 0x80000000u;
    bits ^= sign;
    uint32_t half;
    if (bits >= kOverflow16) {
        half = bits > kInfinity32 ? 0x7e00u : 0x7c00u;
    } else if (bits < (113u << 23)) {
        const float rounded = std::bit_cast<float>(bits) + std::bit_cast<float>(kDenormalMagic);
        half = std::bit_cast<uint32_t>(rounded) - kDenormalMagic;
    } else {
        const uint32_t odd = (bits >> 13) & 1u;
        half = (bits + (uint32_t(15 - 127) << 23) + 0xfffu + odd) >> 13;
    }
    return static_cast<uint16_t>(half | (sign >> 16));
}

[[nodiscard]] inline float float_from_half(uint16_t half) {
    const uint32_t sign = uint32_t(half & 0x8000u) << 16;
    uint32_t bits = uint32_t(half & 0x7fffu) << 13;
    const uint32_t exponent = bits & (0x7c00u << 13);
    bits += (127u - 15u) << 23;
    if (exponent == (0x7c00u << 13)) {
        bits += (128u - 16u) << 23;  // infinity, NaN
    } else if (exponent == 0) {
        bits += 1u << 23;
        bits = std::bit_cast<uint32_t>(std::bit_cast<float>(bits) - std::bit_cast<float>(113u << 23));
    }
    return std::bit_cast<float>(bits | sign);
}

}  // namespace loam
