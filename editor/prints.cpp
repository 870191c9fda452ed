#include "editor/prints.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "editor/session.h"
#include "runtime/document/dirt.h"

namespace loam {

namespace {

constexpr double kLeap_m = 20;
// At most this many lie in one command: what a journal row is good for.
constexpr size_t kMostAtOnce = 50'000;

bool finite(glm::dvec2 v) {
    return std::isfinite(v.x) && std::isfinite(v.y);
}

}  // namespace

double sinkage_m(double softness, double weight_kg, double area_m2) {
    constexpr double kGravity = 9.81, kStanding_pa = 26'000, kUnderMan_m = 0.16, kDeepest_m = 0.25;
    const double pressure_pa = weight_kg * kGravity / area_m2;
    return std::min(softness * kUnderMan_m * pressure_pa / kStanding_pa, kDeepest_m);
}

Result<double> Prints::softness_at(glm::dvec2 at_m) {
    const auto texel = session_.layer_at(at_m.x, at_m.y);
    if (!texel) return texel.error();
    const auto& layers = session_.document().settings().layers;
    if (texel->layer >= layers.size()) return LayerEntry{}.softness;
    const LayerEntry& layer = layers[texel->layer];
    if (!layer.blend) return layer.softness;
    double sum = 0;
    for (const LayerEntry& side : layers)
        if (side.name == layer.blend->from || side.name == layer.blend->to) sum += 0.5 * side.softness;
    return sum;
}

Result<bool> Prints::lay(Footprint print, double weight_kg, double area_m2) {
    const auto softness = softness_at({print.x_m, print.y_m});
    if (!softness) return softness.error();
    print.depth_m = sinkage_m(*softness, weight_kg, area_m2);
    print.seed = count_;
    constexpr double kShallowest_m = 0.002;
    if (print.depth_m < kShallowest_m) return false;
    ++count_;
    if (settings.lifetime_s > 0 && settings.keep > 0 && waiting_.size() >= settings.keep)
        waiting_.pop_front();
    waiting_.push_back(print);
    return true;
}

Result<bool> Prints::step(uint64_t, int foot, glm::dvec2 at_m, double heading_rad, const FootDesc& desc) {
    if (foot != 0 && foot != 1) return error("foot is {}, must be 0 (left) or 1 (right)", foot);
    if (!finite(at_m) || !std::isfinite(heading_rad)) return error("a step must be at a finite place");
    if (!(desc.length_m >= 0.05 && desc.length_m <= 50))
        return error("the length of a foot is {}, must be 0.05 … 50 m", desc.length_m);
    if (!(desc.weight_kg >= 0 && desc.weight_kg <= 1e6))
        return error("the weight on a foot is {}, must be 0 … 1000000 kg", desc.weight_kg);
    const Footprint print{.x_m = at_m.x,
                          .y_m = at_m.y,
                          .heading_rad = std::remainder(heading_rad, 6.283185307179586),
                          .length_m = desc.length_m,
                          .foot = foot};
    return lay(print, desc.weight_kg, desc.length_m * desc.length_m / 3);
}

Result<int> Prints::tread(uint64_t actor, glm::dvec2 at_m, const TreadDesc& desc) {
    if (!finite(at_m)) return error("a tread must be at a finite place");
    if (!(desc.width_m >= 0.02 && desc.width_m <= 18))
        return error("the width of a tyre is {}, must be 0.02 … 18 m", desc.width_m);
    if (!(desc.gauge_m >= 0 && desc.gauge_m <= 100))
        return error("the gauge of a tread is {}, must be 0 … 100 m", desc.gauge_m);
    if (!(desc.weight_kg >= 0 && desc.weight_kg <= 1e6))
        return error("the weight on a wheel is {}, must be 0 … 1000000 kg", desc.weight_kg);
    const auto [found, fresh] = wheels_.try_emplace(actor, Wheel{.at_m = at_m});
    Wheel& wheel = found->second;
    const glm::dvec2 way = at_m - wheel.at_m;
    const double length_m = glm::length(way);
    if (fresh || length_m > kLeap_m) {
        wheel = {.at_m = at_m};
        return 0;
    }
    if (length_m == 0) return 0;
    const double piece_m = desc.width_m / kTrackWidth, spacing_m = piece_m / 2;
    const glm::dvec2 ahead = way / length_m, right(ahead.y, -ahead.x);
    int laid = 0;
    double along_m = spacing_m - wheel.carry_m;
    for (; along_m <= length_m; along_m += spacing_m) {
        const glm::dvec2 middle = wheel.at_m + ahead * along_m;
        for (int side = desc.gauge_m > 0 ? -1 : 0; side <= 1; side += 2) {
            const glm::dvec2 at = middle + right * (desc.gauge_m / 2 * side);
            const Footprint print{.x_m = at.x,
                                  .y_m = at.y,
                                  .heading_rad = std::atan2(ahead.x, ahead.y),
                                  .length_m = piece_m,
                                  .foot = kTyre};
            const auto done = lay(print, desc.weight_kg, desc.width_m * 0.25);
            if (!done) return done.error();
            laid += *done;
        }
    }
    wheel.carry_m = length_m - (along_m - spacing_m);
    wheel.at_m = at_m;
    return laid;
}

void Prints::lift(uint64_t actor) {
    wheels_.erase(actor);
}

Result<Dirt> Prints::flush() {
    return flush(waiting_.size());
}

Result<Dirt> Prints::flush_for_frame() {
    return flush(settings.a_frame > 0 ? std::min<size_t>(waiting_.size(), settings.a_frame)
                                      : waiting_.size());
}

Result<Dirt> Prints::flush(size_t count) {
    Dirt all;
    Document& document = session_.document();
    while (count > 0) {
        FootprintsCommand command;
        const auto end = waiting_.begin() + ptrdiff_t(std::min(count, kMostAtOnce));
        command.prints.assign(waiting_.begin(), end);
        waiting_.erase(waiting_.begin(), end);
        count -= command.prints.size();
        command.life.from_s = document.time_s();
        if (settings.lifetime_s > 0) {
            command.life.until_s = document.time_s() + settings.lifetime_s;
            command.life.fade_s = std::min(settings.fade_s, settings.lifetime_s);
            command.keep = settings.keep;
        }
        if (group_ == 0 || document.revision() != revision_) group_ = document.next_group();
        auto dirt = session_.apply({command, group_});
        if (!dirt) return dirt;
        append_dirt(all, *dirt);
        revision_ = document.revision();
    }
    return all;
}

}  // namespace loam
