// The sRGB curve (IEC 61966-2-1). What is beyond 0 … 1 is clamped.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>

namespace loam {

template <std::floating_point T>
[[nodiscard]] T srgb_of_linear(T linear) {
    const T c = std::clamp(linear, T(0), T(1));
    return c <= T(0.0031308) ? c * T(12.92) : T(1.055) * std::pow(c, T(1) / T(2.4)) - T(0.055);
}

template <std::floating_point T>
[[nodiscard]] T linear_of_srgb(T srgb) {
    const T c = std::clamp(srgb, T(0), T(1));
    return c <= T(0.04045) ? c / T(12.92) : std::pow((c + T(0.055)) / T(1.055), T(2.4));
}

// Of a byte, by a table.
[[nodiscard]] inline double linear_of_srgb8(uint8_t srgb) {
    static const std::array<double, 256> table = [] {
        std::array<double, 256> t{};
        for (size_t i = 0; i < t.size(); ++i) t[i] = linear_of_srgb(double(i) / 255);
        return t;
    }();
    return table[srgb];
}

[[nodiscard]] inline uint8_t srgb8_of_linear(double linear) {
    return uint8_t(std::lround(srgb_of_linear(linear) * 255));
}

}  // namespace loam
