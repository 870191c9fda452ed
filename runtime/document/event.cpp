#include "runtime/document/event.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

#include "runtime/base/check.h"
#include "runtime/base/ramp.h"
#include "runtime/document/operator.h"
#include "shaders/document/noise_math.h"

namespace loam {

namespace {

constexpr std::array<std::string_view, kEventKinds> kNames = {"crater", "crater_line", "barrage",
                                                              "crash",  "landslide",   "flood"};
constexpr double kTnt_j = 4.184e6;  // a kilogram
constexpr double kTurn_rad = 2 * std::numbers::pi;

// One number after another from a seed, each in [0, 1).
class Dice {
  public:
    explicit Dice(uint32_t seed) : state_(shared::noise_hash(seed + 101u)) {}
    uint32_t hash() { return state_ = shared::noise_hash(state_ + 1u); }
    double share() { return double(shared::noise_share(hash())); }
    double between(double low, double high) { return low + (high - low) * share(); }
    glm::dvec2 in_disc() {
        const double r = std::sqrt(share()), angle = between(0, kTurn_rad);
        return {r * std::cos(angle), r * std::sin(angle)};
    }

  private:
    uint32_t state_;
};

struct Parts {
    const Operator& whole;
    const Event& event;
    std::vector<Operator>& out;

    void add(OperatorShape shape, const Life& life) const {
        Operator part{.id = whole.id,
                      .order = whole.order,
                      .enabled = whole.enabled,
                      .shape = std::move(shape),
                      .life = life,
                      .part = uint32_t(out.size()) + 1};
        prepare(part);
        out.push_back(std::move(part));
    }
    void impact(glm::dvec2 at_m, double energy_j, double at_s, double rise_s, uint32_t seed) const {
        add(
            Crater{
                .x_m = at_m.x, .y_m = at_m.y, .radius_m = crater_radius_m(energy_j), .seed = seed, .heat = 1},
            {.from_s = at_s, .rise_s = rise_s, .cool_s = event.cool_s, .weather_s = event.weather_s});
    }
    [[nodiscard]] glm::dvec2 from_m() const { return {event.x_m, event.y_m}; }
    [[nodiscard]] glm::dvec2 to_m() const { return event.to_m.value_or(from_m()); }

    void crater() const { impact(from_m(), event.energy_j, event.start_s, event.duration_s, event.seed); }

    void crater_line() const {
        Dice dice(event.seed);
        const glm::dvec2 along = to_m() - from_m();
        const double stray_m = 0.5 * crater_radius_m(event.energy_j);
        for (int i = 0; i < event.count; ++i) {
            const double share = event.count > 1 ? double(i) / (event.count - 1) : 0;
            const glm::dvec2 at = from_m() + along * share + stray_m * dice.in_disc();
            const double energy_j = event.energy_j * dice.between(0.5, 1);
            impact(at, energy_j, event.start_s + event.duration_s * share, 0, dice.hash());
        }
    }

    // Cell by cell, row by row, so that parts that come together lie together.
    void barrage() const {
        Dice dice(event.seed);
        const int rows = int(std::ceil(std::sqrt(double(event.count))));
        const double cell_m = 2 * event.radius_m / rows;
        for (int i = 0; i < event.count; ++i) {
            // Spread over all cells when there are more of those than impacts.
            const int cell = int(int64_t(i) * rows * rows / event.count);
            const glm::dvec2 corner =
                from_m() - event.radius_m + cell_m * glm::dvec2(cell % rows, cell / rows);
            const glm::dvec2 at = corner + cell_m * glm::dvec2(dice.share(), dice.share());
            // Many small ones, few large: a hundredth of the energy to all of it.
            const double energy_j = std::max(event.energy_j * std::pow(10.0, -2 * dice.share()), 1.0e5);
            const double at_s = event.start_s + event.duration_s * dice.share();
            impact(at, energy_j, at_s, 0, dice.hash());
        }
    }

    // The furrow is dug as fast as it is passed, evenly slowed down to a halt at its end.
    void crash() const {
        Dice dice(event.seed);
        const double width_m = event.width_m;
        const glm::dvec2 way = to_m() - from_m();
        const double length_m = glm::length(way);
        const glm::dvec2 ahead = length_m > 0 ? way / length_m : glm::dvec2(0, 1);
        const glm::dvec2 right(ahead.y, -ahead.x);
        const double heading_rad = std::atan2(ahead.x, ahead.y);
        const auto passed_s = [&](double share) {
            return event.start_s + event.duration_s * (1 - std::sqrt(std::max(1 - share, 0.0)));
        };
        const double halt_s = passed_s(1);

        const double piece_m = width_m / kTrackWidth;
        const int steps = std::clamp(int(std::round(2 * length_m / piece_m)), 1, 2000);
        for (int i = 0; i <= steps; ++i) {
            const double share = double(i) / steps;
            const glm::dvec2 at = from_m() + way * share;
            Footprint furrow{.x_m = at.x, .y_m = at.y, .heading_rad = heading_rad, .foot = kFurrow};
            furrow.length_m = 2 * length_m / steps;
            furrow.depth_m = 0.25 * width_m * ramp(std::min(share / 0.35, 1.0));
            furrow.seed = event.seed;
            add(furrow, {.from_s = passed_s(share)});
        }
        add(Crater{.x_m = to_m().x,
                   .y_m = to_m().y,
                   .radius_m = 1.1 * width_m,
                   .depth_m = 0.35 * width_m,
                   .seed = dice.hash(),
                   .heat = 1},
            {.from_s = halt_s, .cool_s = event.cool_s, .weather_s = event.weather_s});
        for (int i = 0; i < 6; ++i) {
            const double share = dice.between(0.55, 1.05);
            const glm::dvec2 at = from_m() + way * share + right * (width_m * dice.between(-0.8, 0.8));
            TerrainDecal scorch{.x_m = at.x, .y_m = at.y, .outline = DecalOutline::ellipse};
            scorch.half_m = width_m * glm::dvec2(dice.between(0.8, 1.6), dice.between(1.2, 2.6));
            scorch.heading_rad = heading_rad + dice.between(-0.5, 0.5);
            scorch.material = {
                .colour = {0.16, 0.15, 0.14}, .gloss = 0.1, .opacity = 0.75, .edge = 0.7, .rough = 0.7};
            scorch.material.seed = dice.hash();
            scorch.material.channels.normal = 0;
            add(scorch, {.from_s = passed_s(std::min(share, 1.0)), .rise_s = 3});
        }
        for (int i = 0; i < event.count; ++i) {
            const double thrown_m = width_m * (0.6 + 7 * dice.share() * dice.share());
            const double turn_rad = dice.between(-1.2, 1.2);
            const glm::dvec2 to = ahead * std::cos(turn_rad) + right * std::sin(turn_rad);
            const glm::dvec2 at = to_m() + to * thrown_m;
            const Life landed{.from_s = halt_s + thrown_m / 25};
            const double half_m = width_m * (0.03 + 0.12 * dice.share() * dice.share());
            if (i % 3 == 0)
                add(Crater{.x_m = at.x,
                           .y_m = at.y,
                           .radius_m = std::max(1.6 * half_m, 0.1),
                           .depth_m = 0.3 * half_m,
                           .seed = dice.hash()},
                    landed);
            TerrainDecal piece{.x_m = at.x, .y_m = at.y};
            piece.half_m = {half_m, half_m * dice.between(0.4, 1)};
            piece.heading_rad = dice.between(0, kTurn_rad);
            const double grey = dice.between(0.35, 0.7);
            piece.material = {.colour = {grey, grey, 1.03 * grey},
                              .gloss = 0.55,
                              .metalness = 0.8,
                              .edge = 0.1,
                              .rough = 0.5};
            piece.material.seed = dice.hash();
            add(piece, landed);
        }
    }

    void landslide() const {
        constexpr int kLumps = 24;
        Dice dice(event.seed);
        std::array<double, kLumps> weights;
        double sum = 0;
        for (double& weight : weights) sum += weight = dice.between(0.4, 1);
        for (const double weight : weights) {
            const glm::dvec2 from = from_m() + 0.6 * event.radius_m * dice.in_disc();
            const glm::dvec2 to = to_m() + 0.9 * event.radius_m * dice.in_disc();
            const double delay = dice.between(0, 0.35);
            add(Slide{.x_m = from.x,
                      .y_m = from.y,
                      .radius_m = event.radius_m * dice.between(0.35, 0.55),
                      .to_m = to,
                      .to_radius_m = event.radius_m * dice.between(0.4, 0.75),
                      .volume_m3 = event.volume_m3 * weight / sum},
                {.from_s = event.start_s + delay * event.duration_s,
                 .rise_s = (1 - delay) * event.duration_s});
        }
    }

    void flood() const {
        add(Flood{.x_m = event.x_m,
                  .y_m = event.y_m,
                  .radius_m = event.radius_m,
                  .level_m = event.level_m,
                  .from_m = event.from_m,
                  .layer = event.layer,
                  .layer_number = event.layer_number},
            {.from_s = event.start_s, .rise_s = event.duration_s});
    }
};

}  // namespace

std::string_view name_of(EventKind kind) {
    return kNames[size_t(kind)];
}

Event default_event(EventKind kind) {
    Event event{.kind = kind};
    switch (kind) {
        case EventKind::crater:
            event.energy_j = 6.5e10;
            break;
        case EventKind::crater_line:
            event.energy_j = 4.0e9;
            event.count = 8;
            event.duration_s = 2;
            break;
        case EventKind::barrage:
            event.energy_j = 2.0e10;
            event.radius_m = 500;
            event.count = 1200;
            event.duration_s = 20;
            break;
        case EventKind::crash:
            event.count = 60;
            event.duration_s = 4;
            break;
        case EventKind::landslide:
            event.radius_m = 30;
            event.volume_m3 = 4000;
            event.duration_s = 8;
            break;
        case EventKind::flood:
            event.radius_m = 400;
            event.duration_s = 20;
            break;
    }
    return event;
}

double crater_radius_m(double energy_j) {
    return 0.4 * std::cbrt(energy_j / kTnt_j);
}
double crater_energy_j(double radius_m) {
    return kTnt_j * std::pow(radius_m / 0.4, 3);
}

std::vector<Operator> parts_of(const Operator& whole) {
    const Event& event = std::get<Event>(whole.shape);
    std::vector<Operator> out;
    const Parts parts{whole, event, out};
    switch (event.kind) {
        case EventKind::crater:
            parts.crater();
            break;
        case EventKind::crater_line:
            parts.crater_line();
            break;
        case EventKind::barrage:
            parts.barrage();
            break;
        case EventKind::crash:
            parts.crash();
            break;
        case EventKind::landslide:
            parts.landslide();
            break;
        case EventKind::flood:
            parts.flood();
            break;
    }
    return out;
}

double end_s(const Event& event) {
    const double moved_s = event.start_s + event.duration_s;
    switch (event.kind) {
        case EventKind::landslide:
        case EventKind::flood:
            return moved_s;
        case EventKind::crash:
            return moved_s + std::max({event.cool_s, event.weather_s, 8 * event.width_m / 25});
        default:
            return moved_s + std::max(event.cool_s, event.weather_s);
    }
}

}  // namespace loam
