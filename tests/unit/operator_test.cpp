// Operators: the shape of craters and prints, independence of the grid, the spatial index.
#include "document_fixture.h"
#include "runtime/document/operator_index.h"
#include "runtime/store/stamp_file.h"
#include "shaders/document/crater_math.h"
#include "shaders/document/footprint_math.h"

using namespace loam;
using namespace loam::test;
using glm::vec2;

namespace {

constexpr float kPi = 3.14159265f;

vec2 on_ray(float r, float angle) {
    return vec2(r * std::cos(angle), r * std::sin(angle));
}

}  // namespace

TEST(crater, has_a_bowl_a_rim_and_ends_in_nothing) {
    for (uint32_t seed = 0; seed < 20; ++seed) {
        EXPECT_NEAR(shared::crater_height(vec2(0, 0), 0.4f, seed, 0), -0.4f, 0.05f);
        float rim = 0;
        for (float angle = 0; angle < 2 * kPi; angle += 0.1f) {
            float highest = -1, at = 0;
            for (float r = 0; r < 3; r += 0.01f) {
                const float h = shared::crater_height(on_ray(r, angle), 0.4f, seed, 0);
                ASSERT_TRUE(std::isfinite(h));
                if (h > highest) highest = h, at = r;
                if (r >= kCraterHeightReach) {
                    ASSERT_EQ(h, 0.0f);
                }
            }
            EXPECT_GT(at, 0.8f) << "the crest wanders by 10 %, and the roughness moves its highest point";
            EXPECT_LT(at, 1.25f);
            rim += highest / 63;
        }
        EXPECT_NEAR(rim, 0.14f, 0.03f) << "Pike: 0.07 of the diameter";
    }
}

TEST(crater, height_has_no_steps_and_no_kinks) {
    // C1: the slope may change between steps by no more than a bound on the curvature times the step.
    const float step = 2e-3f;
    for (uint32_t seed : {1u, 7u, 99u})
        for (float angle = 0.05f; angle < 6; angle += 0.37f) {
            double before = 0, slope_before = 0;
            for (int i = 0; float(i) * step < 2.8f; ++i) {
                const double h = double(shared::crater_height(on_ray(float(i) * step, angle), 0.4f, seed, 0));
                const double slope = (h - before) / step;
                if (i > 0) {
                    ASSERT_LT(std::abs(slope), 2.0) << "at " << float(i) * step;
                }
                if (i > 1) {
                    ASSERT_LT(std::abs(slope - slope_before), 12.0 * step + 1e-3) << "at " << float(i) * step;
                }
                before = h;
                slope_before = slope;
            }
        }
}

TEST(crater, marks_lie_in_range_and_end) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-4, 4);
    int zones[3] = {0, 0, 0};
    float most_rays = 0;
    for (int i = 0; i < 100000; ++i) {
        const vec2 p(place(random), place(random));
        const float rays = shared::crater_rays(p, 5, 0), scorch = shared::crater_scorch(p, 5, 0);
        const int zone = shared::crater_zone(p, 5, 0);
        ASSERT_TRUE(rays >= 0 && rays <= 1 && scorch >= 0 && scorch <= 1 && zone >= 0 && zone <= 2);
        if (std::hypot(p.x, p.y) >= kCraterMarkReach) {
            ASSERT_TRUE(rays == 0 && scorch == 0 && zone == 0);
        }
        ++zones[zone];
        most_rays = std::max(most_rays, rays);
    }
    EXPECT_GT(zones[1], 1000);
    EXPECT_GT(zones[2], 4000);
    EXPECT_GT(most_rays, 0.5f);
    EXPECT_EQ(shared::crater_scorch(vec2(0, 0), 5, 0), 1.0f);
    EXPECT_EQ(shared::crater_zone(vec2(0, 0), 5, 0), 1);
}

TEST(noise, slope_is_the_derivative) {
    for (int i = 0; i < 500; ++i) {
        const vec2 p(float(i) * 0.173f - 40.0f, float(i) * 0.091f + 3.0f);
        const glm::vec3 n = shared::noise_value_slope(p, 7);
        ASSERT_EQ(n.x, shared::noise_value(p, 7));
        constexpr float kStep = 1.0f / 256;
        const auto along = [&](vec2 d) {
            return (shared::noise_value(p + d, 7) - shared::noise_value(p - d, 7)) / (2 * kStep);
        };
        ASSERT_NEAR(n.y, along({kStep, 0}), 2e-3);
        ASSERT_NEAR(n.z, along({0, kStep}), 2e-3);
    }
}

// A mark's slope is the heights', and nothing is left of it outside the box that is drawn.
TEST(footprint, mark_has_the_slope_of_the_heights_and_stays_in_its_box) {
    for (const float reach : {0.005f, 0.03f, 0.5f}) {
        double error = 0, size = 0;
        for (float y = -0.8f; y <= 0.8f; y += 0.007f)
            for (float x = -0.8f; x <= 0.8f; x += 0.007f) {
                const vec2 at(x, y);
                const auto mark = shared::footprint_mark(at, 1, 9, reach);
                ASSERT_TRUE(std::isfinite(mark.slope.x) && std::isfinite(mark.slope.y));
                if (std::abs(x) > kFootprintHalfWidth || std::abs(y) > kFootprintHalfLength) {
                    ASSERT_TRUE(mark.around == 0 && mark.pressed == 0 && mark.slope == vec2(0));
                    continue;
                }
                const auto height = [&](float dx, float dy) {
                    return shared::footprint_height(at + vec2(dx, dy), 1, 9);
                };
                const vec2 slope((height(reach, 0) - height(-reach, 0)) / (2 * reach),
                                 (height(0, reach) - height(0, -reach)) / (2 * reach));
                error += double(glm::dot(slope - mark.slope, slope - mark.slope));
                size += double(glm::dot(slope, slope));
            }
        // The unevenness goes straight between the places: a texel of a whole print shows none of it.
        EXPECT_LT(std::sqrt(error / size), reach < 0.1f ? 0.02 : 0.3) << reach;
    }
    const auto pressed = shared::footprint_mark(vec2(0, 0.2f), 0, 3, 0.005f);
    EXPECT_EQ(pressed.around, 1.0f);
    EXPECT_GT(pressed.pressed, 0.5f);
}

TEST(footprint, is_a_dent_with_a_rim_and_mirrors) {
    float low = 0, high = 0;
    for (float y = -0.8f; y <= 0.8f; y += 0.01f)
        for (float x = -0.8f; x <= 0.8f; x += 0.01f) {
            const float h = shared::footprint_height(vec2(x, y), 0, 3);
            low = std::min(low, h);
            high = std::max(high, h);
            if (std::hypot(x, y) >= kFootprintReach) {
                ASSERT_EQ(h, 0.0f);
            }
            if (std::hypot(x, y) > kFootprintReach - 0.02f) {
                ASSERT_EQ(h, 0.0f) << "fades out before the reach";
            }
            if (std::abs(x) >= kFootprintHalfWidth || std::abs(y) >= kFootprintHalfLength) {
                ASSERT_EQ(h, 0.0f) << "fits its box";
                ASSERT_LE(shared::footprint_sole(vec2(x, y), 0), -kFootprintRim) << x << ", " << y;
            }
            ASSERT_EQ(shared::footprint_sole(vec2(x, y), 0), shared::footprint_sole(vec2(-x, y), 1));
        }
    EXPECT_EQ(low, -1.0f);
    EXPECT_GT(high, 0.08f);
    EXPECT_LT(high, 0.21f);
    const vec2 east =
        shared::footprint_local(vec2(1, 0), vec2(1, 0));  // heading east: toes at +x of the world
    EXPECT_NEAR(east.y, 1, 1e-6);
    EXPECT_NEAR(shared::footprint_local(vec2(0, 1), vec2(0, 1)).y, 1, 1e-6);
    EXPECT_NEAR(shared::footprint_local(vec2(1, 0), vec2(0, 1)).x, 1, 1e-6);
}

TEST(operators, change_samples_by_position_only_and_within_bounds) {
    auto picture = std::make_shared<StampImage>();
    picture->width = 9;
    picture->height = 5;
    for (uint16_t i = 0; i < 45; ++i) {
        picture->heights.push_back(uint16_t(i * 5501));
        for (uint16_t c = 0; c < 3; ++c) picture->colors.push_back(uint8_t(i * 37 + c));
    }
    Stamp stamp{.image = "any", .x_m = 101.3, .y_m = 97.9, .half_m = {11, -7}, .heading_rad = 0.6};
    stamp.layer = "any";
    stamp.layer_number = 3;
    stamp.colour = true;
    stamp.picture = picture;
    const Operator ops[] = {{1, 1, true, Crater{103.7, 98.1, 12.5, 0, 7}},
                            {2, 2, true, Footprint{100.2, 99.4, 0.7, 2.0, 0.2, 1, 4}},
                            {3, 3, true, stamp}};
    const ResolvedRoles roles{1, 2};
    for (const Operator& op : ops) {
        const double spacing = 0.3;
        const auto compose = [&](int i0, int j0, int size) {
            std::vector<double> heights(size_t(size * size), 50.0);
            apply_height(op, {heights.data(), size, size, size, i0 * spacing, j0 * spacing, spacing});
            return heights;
        };
        const auto texels_of = [&](int i0, int j0, int size) {
            std::vector<IndexTexel> texels(size_t(size * size));
            apply_index(op, roles, {texels.data(), size, size, size, i0 * spacing, j0 * spacing, spacing},
                        {});
            return texels;
        };
        const auto whole = compose(150, 150, 400);
        const auto whole_texels = texels_of(150, 150, 400);
        const WorldRect bounds = op.height_bounds(), index_bounds = op.index_bounds();
        int changed = 0;
        for (int j = 0; j < 400; ++j)
            for (int i = 0; i < 400; ++i) {
                const double x = (150 + i) * spacing, y = (150 + j) * spacing;
                const bool differs = whole[size_t(j * 400 + i)] != 50.0;
                changed += differs;
                if (!bounds.grown(1e-4).contains(x, y)) {
                    ASSERT_FALSE(differs);
                }
                if (!index_bounds.grown(1e-4).contains(x, y)) {
                    ASSERT_TRUE(whole_texels[size_t(j * 400 + i)] == IndexTexel{});
                }
            }
        EXPECT_GT(changed, 10);
        for (const auto& [i0, j0] : {std::pair{317, 303}, {290, 341}, {333, 333}}) {
            const auto part = compose(i0, j0, 31);
            const auto part_texels = texels_of(i0, j0, 31);
            for (int j = 0; j < 31; ++j)
                for (int i = 0; i < 31; ++i) {
                    const size_t at = size_t((j + j0 - 150) * 400 + i + i0 - 150);
                    ASSERT_EQ(part[size_t(j * 31 + i)], whole[at]);
                    ASSERT_TRUE(part_texels[size_t(j * 31 + i)] == whole_texels[at]);
                }
        }
    }
}

TEST(operator_index, agrees_with_looking_at_all) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> place(-500, 5000), size(-2.5, 3.2);
    std::vector<std::unique_ptr<Operator>> all;
    std::vector<WorldRect> bounds;
    OperatorIndex index;
    for (uint64_t i = 0; i < 3000; ++i) {
        all.push_back(std::make_unique<Operator>());
        *all.back() = {i + 1, random() % 100, random() % 5 != 0, Crater{}};
        const double x = place(random), y = place(random), s = std::pow(10, size(random));
        bounds.push_back({x, y, x + s, y + s * 0.7});
        index.add(all.back().get(), bounds.back());
    }
    std::vector<bool> removed(all.size());
    std::vector<const Operator*> found;
    for (int round = 0; round < 2000; ++round) {
        if (round % 4 == 0) {
            const size_t which = random() % all.size();
            if (removed[which])
                index.add(all[which].get(), bounds[which]);
            else
                index.remove(all[which].get(), bounds[which]);
            removed[which] = !removed[which];
        }
        const double x = place(random), y = place(random), s = std::pow(10, size(random));
        const WorldRect rect{x, y, x + s, y + s};
        index.query(rect, found);
        std::vector<const Operator*> expected;
        for (size_t i = 0; i < all.size(); ++i)
            if (!removed[i] && all[i]->enabled && bounds[i].overlaps(rect)) expected.push_back(all[i].get());
        std::sort(expected.begin(), expected.end(), [](const Operator* a, const Operator* b) {
            return std::pair(a->order, a->id) < std::pair(b->order, b->id);
        });
        ASSERT_EQ(found, expected);
    }
}
