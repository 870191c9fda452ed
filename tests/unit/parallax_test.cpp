#include "shaders/frame/parallax_math.h"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace loam::shared {
namespace {

vec3 unit(float x, float y, float z) {
    return glm::normalize(vec3(x, y, z));
}

TEST(parallax, level_ground_below_is_met_at_its_depth) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> real(-1, 1);
    for (int i = 0; i < 2000; ++i) {
        const vec3 ground = unit(real(random), real(random), 1.2f),
                   down = unit(real(random), real(random), -0.6f);
        const ParallaxRay ray = parallax_ray(down, ground, kParallaxDepth_m);
        const float depth = 0.125f + 0.125f * real(random);
        const float hit = parallax_hit(ray, depth, 1 + int(random() % 32), [&](vec2) { return depth; });
        EXPECT_NEAR(hit, std::min(depth, ray.deepest), 2e-6f);
    }
    const ParallaxRay straight = parallax_ray({0, 0, -1}, {0, 0, 1}, kParallaxDepth_m);
    EXPECT_EQ(straight.deepest, kParallaxDepth_m);
    EXPECT_EQ(length(straight.per_m), 0.0f) << "from above nothing moves";
    const ParallaxRay slanting = parallax_ray(unit(1, 0, -1), {0, 0, 1}, kParallaxDepth_m);
    EXPECT_NEAR(slanting.per_m.x, 1, 1e-6) << "at 45 degrees as far as deep";
}

// A plane that falls or rises under the surface is met exactly, however few the steps, unless it is steeper
// than the ray.
TEST(parallax, slopes_below_are_met_in_closed_form) {
    for (const float slope : {-0.5f, -0.1f, 0.0f, 0.2f, 0.7f})
        for (const int steps : {1, 3, 16}) {
            const ParallaxRay ray = parallax_ray(unit(0.6f, 0.2f, -1), {0, 0, 1}, kParallaxDepth_m);
            const auto depth = [&](vec2 moved) { return 0.08f + slope * moved.x; };
            const float met = 0.08f / (1 - slope * ray.per_m.x);
            EXPECT_NEAR(parallax_hit(ray, 0.08f, steps, depth), met, 1e-6f) << slope;
        }
}

TEST(parallax, ends_where_it_must) {
    const auto deep = [](vec2) { return 1.0f; };
    const ParallaxRay bounded = parallax_ray(unit(1, 0, -1), {0, 0, 1}, 0.05f);
    EXPECT_EQ(bounded.deepest, 0.05f);
    EXPECT_EQ(parallax_hit(parallax_ray(unit(1, 0, -1), {0, 0, 1}, 0), 1, 16, deep), 0) << "no layer asks";
    const ParallaxRay ray = parallax_ray(unit(1, 0, -1), {0, 0, 1}, kParallaxDepth_m);
    EXPECT_EQ(parallax_hit(ray, 1, 16, deep), ray.deepest) << "deeper than it goes";
    EXPECT_EQ(parallax_hit(ray, 0, 16, deep), 0) << "nothing lies above the surface";
    EXPECT_EQ(parallax_hit(ray, NAN, 16, deep), 0);
    // At grazing angles the place moves no farther than the reach; along the surface and from below it stays.
    for (const float z : {-0.5f, -0.1f, -1e-2f, -1e-3f}) {
        const ParallaxRay grazing = parallax_ray(unit(1, 0, z), {0, 0, 1}, kParallaxDepth_m);
        EXPECT_LE(length(grazing.per_m) * grazing.deepest, kParallaxReach_m * 1.0001f);
        EXPECT_GT(grazing.deepest, 0);
    }
    for (const vec3 down : {unit(1, 0, 0), unit(0, 0, 1), unit(1, 1, -1e-6f), vec3(NAN), vec3(INFINITY)}) {
        const ParallaxRay none = parallax_ray(down, {0, 0, 1}, kParallaxDepth_m);
        EXPECT_EQ(none.deepest, 0);
        EXPECT_EQ(none.per_m, vec2(0));
        EXPECT_EQ(parallax_hit(none, 1, 16, deep), 0);
    }
}

// Speed against error: a step is a fetch. docs/measurements.md has the table of pictures.
TEST(parallax, more_steps_err_less) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> real(0, 1);
    double last = 1e9;
    for (const int steps : {4, 8, 16, 32, 64}) {
        double sum = 0;
        random.seed(7);
        for (int i = 0; i < 4000; ++i) {
            const vec2 phase(real(random) * 6, real(random) * 6);
            const ParallaxRay ray = parallax_ray(unit(real(random) * 2, real(random), -1), {0, 0, 1}, kParallaxDepth_m);
            const auto depth = [&](vec2 at) {
                return 0.12f + 0.06f * std::sin(21 * at.x + phase.x) +
                       0.05f * std::sin(33 * at.y + 17 * at.x + phase.y);
            };
            const float exact = parallax_hit(ray, depth(vec2(0)), 4096, depth);
            sum += std::abs(parallax_hit(ray, depth(vec2(0)), steps, depth) - exact);
        }
        EXPECT_LT(sum, last);
        last = sum;
        if (steps == 16) {
            EXPECT_LT(sum / 4000, 0.0015) << "metres";
        }
    }
}

}  // namespace
}  // namespace loam::shared
