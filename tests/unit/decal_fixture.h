// Random decals, splines and volumes, and cutouts.
#pragma once

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
            return TerrainDecal{at.x, at.y, {half(), half()}, real(-7, 7), outline, random_material(random)};
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
                                         real(-5, 20), real(0.05, 1) * size_m});
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

}  // namespace loam::test
