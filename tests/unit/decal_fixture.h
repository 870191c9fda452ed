// Random operators: decals, splines and volumes, cutouts, earth, events, and lives for them.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/document/operator.h"

namespace loam::test {

inline DecalMaterial random_material(std::mt19937& random) {
    const auto share = [&] { return std::uniform_real_distribution<double>(0, 1)(random); };
    DecalMaterial m;
    const char* const layers[] = {"", "grass", "dirt", "scree"};
    m.layer = layers[random() % 4];
    m.colour = {share(), share(), share()};
    m.gloss = share();
    m.metalness = share();
    if (random() % 2) m.tile_m = 0.5 + 4 * share();
    m.opacity = share();
    m.edge = share();
    m.rough = share();
    m.seed = uint32_t(random());
    if (random() % 2) m.channels = {share(), share(), share(), share(), share()};
    constexpr const char* kFunctions[] = {"cracks", "frost", "gravel", "oil"};
    if (random() % 4 == 0) m.function = kFunctions[random() % 4];
    if (m.function == "cracks") m.parameters = {{"curl", share()}, {"plate", 0.1 + share()}};
    return m;
}

// Of any of the three kinds, around a place; `size_m`: about as large.
inline OperatorShape random_decal(std::mt19937& random, glm::dvec2 at, double size_m) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const auto half = [&] { return real(0.1, 1) * size_m * (random() % 4 ? 1 : -1); };
    const auto outline = random() % 2 ? DecalOutline::ellipse : DecalOutline::rectangle;
    switch (random() % 3) {
        case 0:
            return TerrainDecal{at.x,
                                at.y,
                                {half(), half()},
                                real(-7, 7),
                                outline,
                                random() % 3 == 0 ? real(-0.2, 0.2) * std::min(size_m, 20.0) : 0,
                                random_material(random)};
        case 1:
            return VolumeDecal{{at, real(-2, 20)},
                               {half(), half(), real(0.5, 3) * size_m},
                               {real(-1, 1), real(-1, 1), real(-1, -0.1)},
                               real(-4, 4),
                               outline,
                               random_material(random)};
        default: {
            SplineDecal spline;
            for (uint64_t i = 0, count = 4 + 3 * (random() % 3); i < count; ++i)
                spline.points.push_back({at.x + real(-2, 2) * size_m, at.y + real(-2, 2) * size_m,
                                         real(-5, 20), real(0.05, 1) * size_m,
                                         random() % 2 ? real(-0.6, 0.6) : 0});
            if (random() % 3 == 0) spline.points[1] = spline.points[0];  // a cusp's beginning
            spline.carve = random() % 2 ? real(0, 1) : 0;
            spline.shoulder_m = real(0, 1) * size_m;
            spline.fade_m = random() % 2 ? real(0, 2) * size_m : 0;
            spline.material = random_material(random);
            return spline;
        }
    }
}

// Of any form, around a place; `ground_m`: about how high the ground is there.
inline Cutout random_cutout(std::mt19937& random, glm::dvec2 at, double ground_m, double size_m) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    Cutout c{.form = CutoutForm(random() % 4)};
    c.fill = random() % 4 == 0;
    c.center_m = {at, ground_m + real(-0.5, 0.5) * size_m};
    c.half_m = {real(0.2, 1) * size_m, real(0.2, 1) * size_m, real(0.2, 1) * size_m};
    c.direction = {real(-1, 1), real(-1, 1), real(-1, 1)};
    c.roll_rad = real(-4, 4);
    c.radius_m = real(0.2, 0.7) * size_m;
    for (uint64_t i = 0, count = 1 + random() % 20; i < count; ++i)
        c.dabs.push_back(at + glm::dvec2(real(-2, 2), real(-2, 2)) * size_m);
    for (uint64_t i = 0, count = 4 + random() % 8; i < count; ++i)
        c.corners.push_back(c.center_m + glm::dvec3(real(-1, 1), real(-1, 1), real(-1, 1)) * size_m);
    // What its form has not is not written down.
    if (c.form != CutoutForm::brush) c.dabs.clear(), c.radius_m = Cutout{}.radius_m;
    if (c.form != CutoutForm::convex) c.corners.clear();
    if (c.form == CutoutForm::brush || c.form == CutoutForm::convex) {
        const Cutout none;
        c.center_m = none.center_m;
        c.half_m = none.half_m;
        c.direction = none.direction;
        c.roll_rad = none.roll_rad;
    }
    return c;
}

// A lump of soil on its way, or a flood around a level.
inline OperatorShape random_earth(std::mt19937& random, glm::dvec2 at, double ground_m, double size_m) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    if (random() % 2)
        return Slide{.x_m = at.x,
                     .y_m = at.y,
                     .radius_m = real(0.3, 1) * size_m,
                     .to_m = at + glm::dvec2(real(-4, 4), real(-4, 4)) * size_m,
                     .to_radius_m = real(0.3, 2) * size_m,
                     .volume_m3 = real(0, 0.3) * size_m * size_m * size_m,
                     .way = real(0, 1)};
    return Flood{.x_m = at.x,
                 .y_m = at.y,
                 .radius_m = std::max(real(1, 5) * size_m, 1.0),
                 .level_m = ground_m + real(-1, 1) * size_m,
                 .from_m = ground_m - size_m,
                 .layer = random() % 2 ? "dirt" : "",
                 .way = real(0, 1)};
}

inline constexpr double kRandomTimes_s = 100;  // lives and events begin in this time

inline Life random_life(std::mt19937& random) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    Life life;
    if (random() % 3 == 0) return life;
    life.from_s = real(0, kRandomTimes_s);
    if (random() % 2) life.rise_s = real(0, 20);
    if (random() % 2) life.cool_s = real(0, 50);
    if (random() % 2) life.weather_s = real(0, 50);
    if (random() % 2) life.until_s = life.from_s + real(1, 60);
    if (random() % 2 && life.until_s < Life::kEver_s) life.fade_s = real(0, 30);
    return life;
}

inline Event random_event(std::mt19937& random, glm::dvec2 at, double ground_m, double size_m) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    Event e = default_event(EventKind(random() % kEventKinds));
    e.x_m = at.x;
    e.y_m = at.y;
    const double turn = real(0, 6.3);
    if (e.kind == EventKind::crater_line || e.kind == EventKind::crash || e.kind == EventKind::landslide)
        e.to_m = at + glm::dvec2(std::cos(turn), std::sin(turn)) * (real(2, 5) * size_m);
    const double energy_j = 4.184e6 * std::pow(size_m * 0.6 / 0.4, 3);
    if (e.kind == EventKind::crater || e.kind == EventKind::crater_line || e.kind == EventKind::barrage) {
        e.energy_j = std::max(energy_j * real(0.1, 1), 1e5);
        e.weather_s = random() % 2 ? real(1, 60) : 0;
        e.cool_s = random() % 2 ? real(1, 60) : 0;
    }
    if (e.count > 0) e.count = int(random() % 12) + 1;
    if (e.kind == EventKind::barrage || e.kind == EventKind::flood) e.radius_m = std::max(2 * size_m, 1.0);
    if (e.kind == EventKind::crash) e.width_m = std::max(0.4 * size_m, 0.5);
    if (e.kind == EventKind::landslide) {
        e.radius_m = std::max(size_m, 1.0);
        e.volume_m3 = real(0, 1) * size_m * size_m * size_m;
        if (random() % 3 == 0) e.to_m.reset();
    }
    if (e.kind == EventKind::flood) {
        e.level_m = ground_m + real(-1, 1) * size_m;
        e.from_m = ground_m - size_m;
    }
    e.start_s = real(0, kRandomTimes_s);
    e.duration_s = real(0, 20);
    e.seed = uint32_t(random());
    return e;
}

}  // namespace loam::test
