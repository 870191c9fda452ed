// What a pixel covers, which texel it wants and where its taps lie: shaders/geometry/pixel_ellipse_math.h,
// shaders/texture/filter_math.h.
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "runtime/texture/filter.h"
#include "shaders/geometry/pixel_ellipse_math.h"
#include "shaders/texture/texture_io.h"

namespace {

using namespace loam;
using namespace loam::shared;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// The Jacobian of an ellipse: axes long and short, the long one at `angle`, seen in a picture turned by
// `turn`.
struct Columns {
    vec2 x, y;
};
Columns jacobian(double long_m, double short_m, double angle, double turn) {
    const double c = std::cos(angle), s = std::sin(angle), ct = std::cos(turn), st = std::sin(turn);
    // R(angle) · diag(long, short) · R(turn)
    return {vec2(float(c * long_m * ct - s * short_m * st), float(s * long_m * ct + c * short_m * st)),
            vec2(float(-c * long_m * st - s * short_m * ct), float(-s * long_m * st + c * short_m * ct))};
}

TEST(PixelEllipse, AxesAndDirectionAreThoseOfTheJacobian) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> any(0, 1);
    double worst_rad = 0;
    for (int i = 0; i < 20'000; ++i) {
        const double short_m = std::exp2(-12 + 12 * any(random)), ratio = 1.05 + 30 * any(random);
        const double angle = 6.3 * any(random);
        Columns j = jacobian(short_m * ratio, short_m, angle, 6.3 * any(random));
        if (i % 2) j.y = -j.y, j.x = -j.x;
        const PixelEllipse e = pixel_ellipse(j.x, j.y);
        ASSERT_NEAR(e.log2_long, std::log2(short_m * ratio), 1e-4);
        ASSERT_NEAR(e.log2_short, std::log2(short_m), 1e-2);
        const vec2 axis = decode_axis(std::round(encode_axis(e.axis_twice) * 255) / 255);
        ASSERT_NEAR(length(axis), 1, 1e-3);
        worst_rad = std::max(worst_rad,
                             std::abs(double(axis.x) * std::sin(angle) - double(axis.y) * std::cos(angle)));
    }
    EXPECT_LT(worst_rad, 0.0095) << "half a step of eight bits";
    EXPECT_GT(worst_rad, 0.001);
}

TEST(PixelEllipse, AMirroredPictureHasTheSameAxes) {
    const Columns j = jacobian(0.7, 0.1, 0.5, 1.1);
    const PixelEllipse a = pixel_ellipse(j.x, j.y), b = pixel_ellipse(-j.x, j.y);
    EXPECT_NEAR(a.log2_long, b.log2_long, 1e-4);
    EXPECT_NEAR(a.log2_short, b.log2_short, 1e-3);
    const vec2 p = decode_axis(encode_axis(a.axis_twice)), q = decode_axis(encode_axis(b.axis_twice));
    EXPECT_NEAR(std::abs(p.x * q.x + p.y * q.y), 1, 1e-3);
}

TEST(PixelEllipse, HardNumbersEndAtALimit) {
    const float hard[] = {0, 1e-30f, 1e-38f, 1e19f, 3e38f, kInfinity, -kInfinity, kNan};
    for (const float a : hard)
        for (const float b : hard)
            for (const float c : hard)
                for (const float d : hard) {
                    const PixelEllipse e = pixel_ellipse(vec2(a, b), vec2(c, d));
                    ASSERT_TRUE(e.log2_long >= kLeastAxisLog2 && e.log2_long <= kMostAxisLog2);
                    ASSERT_TRUE(e.log2_short >= kLeastAxisLog2 && e.log2_short <= e.log2_long);
                    const vec2 axis = decode_axis(encode_axis(e.axis_twice));
                    ASSERT_NEAR(length(axis), 1, 1e-3);
                    if (std::isnan(a + b + c + d)) {
                        ASSERT_EQ(e.log2_long, kMostAxisLog2)
                            << "a place that nobody knows wants the coarsest";
                    }
                }
    EXPECT_EQ(pixel_ellipse(vec2(0), vec2(0)).log2_long, kLeastAxisLog2);
}

TEST(Filter, TheTexelWantedLiesBetweenTheAxes) {
    for (const Filter filter : {Filter::bilinear, Filter::trilinear, Filter::anisotropic_tiles})
        for (const int taps : {2, 4, 8}) {
            const FilterRule rule = filter_rule(filter, taps);
            float last = -100;
            for (float ratio = 0; ratio <= 8; ratio += 0.01f) {
                const float wanted = filter_log2_texel(-3 + ratio, -3, rule.short_share, rule.log2_taps);
                ASSERT_GE(wanted, -3.00001f);
                ASSERT_LE(wanted, -3 + ratio + 1e-5f);
                ASSERT_GE(wanted, last - 1e-5f) << "continuous and rising";
                if (last > -50) {
                    ASSERT_LE(wanted, last + 0.0101f);
                }
                last = wanted;
                if (is_anisotropic(filter)) {
                    ASSERT_NEAR(wanted, std::max(-3.0f, -3 + ratio - std::log2(float(taps))), 1e-5);
                } else {
                    ASSERT_NEAR(wanted, -3 + ratio / 2, 1e-5);
                }
            }
        }
}

TEST(Filter, WhatIsNotANumberStaysOne) {
    for (const Filter filter : {Filter::bilinear, Filter::anisotropic_tiles}) {
        const FilterRule rule = filter_rule(filter, 8);
        const auto wanted = [&](float a, float b) {
            return filter_log2_texel(a, b, rule.short_share, rule.log2_taps);
        };
        EXPECT_TRUE(std::isnan(wanted(kNan, 0)));
        EXPECT_TRUE(std::isnan(wanted(0, kNan)));
        EXPECT_TRUE(std::isnan(wanted(kInfinity, 0)));
        EXPECT_TRUE(std::isnan(wanted(kInfinity, kInfinity)));
        EXPECT_EQ(wanted(kLeastAxisLog2, kLeastAxisLog2), kLeastAxisLog2);
        EXPECT_EQ(wanted(kMostAxisLog2, kMostAxisLog2), kMostAxisLog2);
    }
    EXPECT_EQ(filter_class(kNan), 0);
}

// Taps of one texel's width, side by side, against a box as long as the axis: the same variance with any
// number of taps.
TEST(Filter, MoreTapsThanNeededFilterTheSame) {
    const float log2_texel = -7;
    for (float log2_ratio = 0; log2_ratio <= 3; log2_ratio += 0.05f) {
        const double texel_m = std::exp2(log2_texel), long_m = std::exp2(log2_texel + log2_ratio);
        for (int taps = 1 << filter_class(log2_ratio); taps <= kMaxTaps; taps *= 2) {
            if (taps == 1) continue;
            const double d = filter_spacing_m(log2_texel + log2_ratio, log2_texel, taps);
            double variance = 0;
            for (int i = 0; i < taps; ++i) variance += std::pow((i - (taps - 1) / 2.0) * d, 2) / taps;
            ASSERT_NEAR(variance / (texel_m * texel_m), (long_m * long_m / texel_m / texel_m - 1) / 12, 1e-3);
            ASSERT_LE(d, texel_m * 1.0001) << "no gap between taps";
        }
    }
}

// No tap reads a texel of another page: neither mip of the page, at any ratio, in any class.
TEST(Filter, TapsStayWithinThePagesBorder) {
    double farthest[2] = {0, 0}, unlimited = 0;
    for (float finer = 0; finer <= 6; finer += 0.01f)  // log2 of the texel wanted to the page's first
        for (float log2_ratio = 0; log2_ratio <= 3; log2_ratio += 0.01f)
            for (int taps = 1; taps <= kMaxTaps; taps *= 2) {
                const double d = filter_spacing_m(finer + log2_ratio, finer, taps);
                const int in_page = std::min(taps, kProbeTaps);
                const double reach = (in_page - 1) / 2.0;
                for (int mip = 0; mip < 2; ++mip)
                    farthest[mip] =
                        std::max(farthest[mip], reach * std::min(d, double(kTapReach)) + (mip ? 1.0 : 0.5));
                // As the classes choose the taps and the page is the wanted one, the limit binds nothing.
                if (finer < 0.98f && taps >= 1 << filter_class(log2_ratio) && taps > 1) {
                    ASSERT_LT(d, kTapReach);
                }
                unlimited = std::max(unlimited, reach * d + 0.5);
            }
    EXPECT_LE(farthest[0], kPageBorder);
    EXPECT_LE(farthest[1], kPageBorder);
    EXPECT_GT(farthest[1], kPageBorder - 0.1) << "and use what there is";
    EXPECT_GT(unlimited, kPageBorder) << "without the limit they would";
}

}  // namespace
