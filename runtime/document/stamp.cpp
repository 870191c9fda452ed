#include "runtime/document/stamp.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/ramp.h"
#include "runtime/store/stamp_file.h"

namespace loam {

namespace {

// Four texels of a line and their weights, repeated at its ends.
struct Taps {
    std::array<int, 4> at;
    std::array<double, 4> cubic, linear;
};

Taps taps(double u, int count) {
    const double texel = u * count - 0.5, first = std::floor(texel), t = texel - first;
    Taps taps;
    for (int i = 0; i < 4; ++i) taps.at[size_t(i)] = std::clamp(int(first) + i - 1, 0, count - 1);
    taps.cubic = {((-0.5 * t + 1) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1, ((-1.5 * t + 2) * t + 0.5) * t,
                  (0.5 * t - 0.5) * t * t};
    taps.linear = {0, 1 - t, t, 0};
    return taps;
}

template <typename Sample>
double filtered(const Taps& x, const Taps& y, bool cubic, int width, const Sample* samples, int stride,
                double whole) {
    const auto &wx = cubic ? x.cubic : x.linear, &wy = cubic ? y.cubic : y.linear;
    double sum = 0;
    for (size_t j = 0; j < 4; ++j) {
        double row = 0;
        for (size_t i = 0; i < 4; ++i)
            row += wx[i] * samples[(size_t(y.at[j]) * size_t(width) + size_t(x.at[i])) * size_t(stride)];
        sum += wy[j] * row;
    }
    return std::clamp(sum / whole, 0.0, 1.0);
}

}  // namespace

StampSampler::StampSampler(const Stamp& stamp)
    : stamp_(stamp), sin_(std::sin(stamp.heading_rad)), cos_(std::cos(stamp.heading_rad)) {}

StampSample StampSampler::operator()(double dx_m, double dy_m) const {
    const Stamp& stamp = stamp_;
    StampSample sample;
    if (!stamp.picture) return sample;
    const StampImage& image = *stamp.picture;
    const double px = (dx_m * cos_ - dy_m * sin_) / stamp.half_m.x,
                 py = (dx_m * sin_ + dy_m * cos_) / stamp.half_m.y;
    if (!(std::abs(px) <= 1 && std::abs(py) <= 1)) return sample;
    const Taps x = taps(px * 0.5 + 0.5, image.width), y = taps(py * 0.5 + 0.5, image.height);
    sample.height = filtered(x, y, true, image.width, image.heights.data(), 1, 65535);
    sample.weight = image.cover.empty() ? 1 : filtered(x, y, false, image.width, image.cover.data(), 1, 255);
    const glm::dvec2 half(std::abs(stamp.half_m.x), std::abs(stamp.half_m.y));
    if (stamp.edge > 0) {
        const double inside_m = std::min((1 - std::abs(px)) * half.x, (1 - std::abs(py)) * half.y);
        sample.weight *= ramp(inside_m / (stamp.edge * std::min(half.x, half.y)));
    }
    if (stamp.colour && !image.colors.empty())
        for (int channel = 0; channel < 3; ++channel)
            sample.color[channel] = filtered(x, y, false, image.width, image.colors.data() + channel, 3, 255);
    return sample;
}

double StampSampler::stamped_m(double ground_m, double dx_m, double dy_m) const {
    const Stamp& stamp = stamp_;
    const StampSample sample = (*this)(dx_m, dy_m);
    const double weight = sample.weight * stamp.strength;
    const double raised_m = sample.height * stamp.height_m, own_m = stamp.base_m + raised_m;
    switch (stamp.mode) {
        case StampMode::add:
            return ground_m + weight * raised_m;
        case StampMode::max:
            return ground_m + weight * (std::max(ground_m, own_m) - ground_m);
        case StampMode::min:
            return ground_m + weight * (std::min(ground_m, own_m) - ground_m);
        case StampMode::blend:
            return ground_m + weight * (own_m - ground_m);
    }
    return ground_m;
}

bool changes_heights(const Stamp& stamp) {
    return stamp.picture && stamp.strength > 0 && (stamp.mode != StampMode::add || stamp.height_m != 0);
}

bool changes_index(const Stamp& stamp) {
    return stamp.picture && (!stamp.layer.empty() || (stamp.colour && !stamp.picture->colors.empty()));
}

}  // namespace loam
