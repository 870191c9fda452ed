#include "editor/packer/error_metrics.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "runtime/base/check.h"
#include "runtime/base/srgb.h"

namespace loam {

namespace {

constexpr double kEqual_dB = 99;

// CIE 15: L*a*b* under D65.
glm::vec3 lab_of(glm::vec3 srgb) {
    const glm::vec3 c(linear_of_srgb(srgb.x), linear_of_srgb(srgb.y), linear_of_srgb(srgb.z));
    const glm::vec3 xyz((0.4124564f * c.x + 0.3575761f * c.y + 0.1804375f * c.z) / 0.95047f,
                        0.2126729f * c.x + 0.7151522f * c.y + 0.0721750f * c.z,
                        (0.0193339f * c.x + 0.1191920f * c.y + 0.9503041f * c.z) / 1.08883f);
    const auto f = [](float t) { return t > 216.0f / 24389 ? std::cbrt(t) : (24389.0f / 27 * t + 16) / 116; };
    const float x = f(xyz.x), y = f(xyz.y), z = f(xyz.z);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

}  // namespace

float delta_e(glm::vec3 srgb_a, glm::vec3 srgb_b) {
    return glm::length(lab_of(srgb_a) - lab_of(srgb_b));
}

float angle_deg(glm::vec3 a, glm::vec3 b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 57.29577951f;
}

double psnr_of(std::span<const float> squares) {
    double sum = 0;
    for (const float s : squares) sum += s;
    if (sum <= 0) return kEqual_dB;
    return std::min(kEqual_dB, -10 * std::log10(sum / static_cast<double>(squares.size())));
}

ChannelError summary_of(std::vector<float> errors) {
    LOAM_CHECK(!errors.empty(), "no errors to sum up");
    double sum = 0;
    for (const float e : errors) sum += e;
    const auto at95 =
        errors.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(errors.size() - 1));
    std::nth_element(errors.begin(), at95, errors.end());
    return {.mean = sum / static_cast<double>(errors.size()),
            .p95 = *at95,
            .max = *std::max_element(at95, errors.end())};
}

}  // namespace loam
