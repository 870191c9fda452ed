#include "editor/window/stroke.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace loam::window {

void StrokeSpacer::begin(glm::dvec2 at_m) {
    last_ = at_m;
    until_next_m_ = 0;
}

void StrokeSpacer::extend(glm::dvec2 to_m, double spacing_m, std::vector<glm::dvec2>& dabs) {
    if (!last_) begin(to_m);
    const glm::dvec2 from = *last_, way = to_m - from;
    const double length = glm::length(way);
    const double spacing = std::max(spacing_m, length / kMostDabs);
    double at = until_next_m_;
    for (; at <= length && dabs.size() < size_t(kMostDabs) * 2; at += spacing)
        dabs.push_back(length > 0 ? from + way * (at / length) : from);
    until_next_m_ = std::max(0.0, at - length);
    last_ = to_m;
}

void Gait::begin(glm::dvec2 at_m) {
    last_ = at_m;
    heading_ = {0, 0};
    until_next_m_ = 0;
    count_ = 0;
}

void Gait::extend(glm::dvec2 to_m, const GaitDesc& desc, uint32_t seed, std::vector<Footprint>& prints) {
    if (!last_) begin(to_m);
    const double step = desc.length_m * desc.step_share;
    // The first print waits for a direction.
    if (count_ == 0 && until_next_m_ == 0) until_next_m_ = step * 0.25;
    const glm::dvec2 from = *last_, way = to_m - from;
    const double length = glm::length(way);
    if (length <= 0) return;
    const glm::dvec2 direction = way / length;
    double walked = 0;
    const auto walk = [&](double distance) {
        const double keep = std::exp(-distance / (step * 0.5));
        heading_ = heading_ * keep + direction * (1 - keep);
        walked += distance;
    };
    while (walked + until_next_m_ <= length && prints.size() < size_t(StrokeSpacer::kMostDabs)) {
        walk(until_next_m_);
        const double sure = glm::length(heading_);
        const glm::dvec2 ahead = sure > 1e-6 ? heading_ / sure : direction;
        const int foot = count_ % 2;
        const double side = (foot == 0 ? -1 : 1) * desc.width_share * desc.length_m; // right is clockwise
        const glm::dvec2 at = from + direction * walked + glm::dvec2(ahead.y, -ahead.x) * side;
        prints.push_back({.x_m = at.x,
                          .y_m = at.y,
                          .heading_rad = std::atan2(ahead.x, ahead.y),
                          .length_m = desc.length_m,
                          .depth_m = desc.depth_m,
                          .foot = foot,
                          .seed = seed + uint32_t(count_)});
        ++count_;
        until_next_m_ = step;
    }
    const double rest = length - walked;
    walk(rest);
    until_next_m_ = std::max(0.0, until_next_m_ - rest);
    last_ = to_m;
}

Footprint Gait::single(const GaitDesc& desc, double heading_rad, uint32_t seed) const {
    const glm::dvec2 at = last_.value_or(glm::dvec2(0));
    return {.x_m = at.x, .y_m = at.y, .heading_rad = heading_rad, .length_m = desc.length_m, .depth_m = desc.depth_m,
            .foot = 0, .seed = seed};
}

} // namespace loam::window
