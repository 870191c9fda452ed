#include "editor/import_doctor.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

namespace loam {
namespace {

SampleImage image_of(int width, int height, SampleKind kind, const std::function<float(int, int)>& sample) {
    SampleImage image;
    image.width = width;
    image.height = height;
    image.kind = kind;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.samples.push_back(sample(x, y));
    return image;
}

bool any_contains(const std::vector<std::string>& texts, const std::string& part) {
    for (const std::string& text : texts)
        if (text.find(part) != std::string::npos) return true;
    return false;
}

Diagnosis diagnosis_of(const SampleImage& image, const HeightScale& scale = {}, double spacing_m = 1) {
    return diagnose(image, survey_samples(image), scale, spacing_m);
}

const auto kRamp = [](int x, int y) { return static_cast<float>(x * 997 + y); };

TEST(ImportDoctor, a_good_picture_gets_no_warning) {
    const SampleImage image = image_of(65, 65, SampleKind::unsigned_16, kRamp);
    const Diagnosis d = diagnosis_of(image, {0, 0.001});
    EXPECT_TRUE(d.warnings.empty()) << d.warnings[0];
    EXPECT_TRUE(any_contains(d.notes, "2^n + 1"));
    EXPECT_FALSE(any_contains(d.notes, "not square"));
}

TEST(ImportDoctor, bad_samples_are_counted_and_the_first_is_located) {
    SampleImage image = image_of(30, 20, SampleKind::floating, [](int, int) { return 5.0f; });
    image.samples[7 * 30 + 11] = std::numeric_limits<float>::quiet_NaN();
    image.samples[9 * 30 + 2] = -std::numeric_limits<float>::infinity();
    const SampleSurvey survey = survey_samples(image);
    EXPECT_EQ(survey.bad_count, 2u);
    EXPECT_EQ(survey.bad_x, 11);
    EXPECT_EQ(survey.bad_y, 7);
    EXPECT_EQ(survey.min, 5);
    const Status status = check_importable(image, survey, 1, false);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.message().find("2 of 600"), std::string::npos);
    EXPECT_TRUE(check_importable(image, survey, 1, true).ok());
}

TEST(ImportDoctor, nothing_but_nan_cannot_be_filled) {
    const SampleImage image = image_of(4, 4, SampleKind::floating, [](int, int) { return std::nanf(""); });
    EXPECT_FALSE(check_importable(image, survey_samples(image), 1, true).ok());
}

TEST(ImportDoctor, eight_bits_narrow_ranges_and_coarse_sources_are_said) {
    EXPECT_TRUE(any_contains(
        diagnosis_of(image_of(64, 32, SampleKind::unsigned_8, [](int x, int) { return float(x); })).warnings,
        "8 bits"));
    EXPECT_TRUE(any_contains(
        diagnosis_of(image_of(64, 64, SampleKind::unsigned_16, [](int x, int) { return float(x * 10); }))
            .warnings,
        "% of 16 bits"));
    EXPECT_TRUE(any_contains(
        diagnosis_of(image_of(64, 64, SampleKind::unsigned_16, [](int x, int) { return float(x * 257); }))
            .warnings,
        "257 units"));
    EXPECT_TRUE(any_contains(
        diagnosis_of(image_of(64, 64, SampleKind::unsigned_16, kRamp), {0, 2.5}, 1000).warnings, "terraces"));
}

TEST(ImportDoctor, shape_and_size_are_judged) {
    EXPECT_TRUE(
        any_contains(diagnosis_of(image_of(64, 32, SampleKind::floating, kRamp)).notes, "not square"));
    SampleImage wide = image_of(2, 2, SampleKind::floating, kRamp);
    wide.width = kMaxImportSide + 1;
    EXPECT_FALSE(check_importable(wide, survey_samples(wide), 0.1, false).ok());
    wide.width = 1000;
    EXPECT_TRUE(check_importable(wide, survey_samples(wide), 16.8, false).ok());
    EXPECT_FALSE(check_importable(wide, survey_samples(wide), 16.9, false).ok());
    wide.channels_differ = true;
    EXPECT_FALSE(check_importable(wide, survey_samples(wide), 1, false).ok());
}

TEST(ImportDoctor, scales_follow_the_request) {
    const SampleImage grey = image_of(2, 2, SampleKind::unsigned_16, kRamp);
    const SampleSurvey survey = survey_samples(grey);
    EXPECT_FALSE(choose_scale(grey, survey, {}).ok()) << "integers have no metres of their own";
    const auto range =
        choose_scale(grey, survey, {.has_range = true, .range_low_m = -10, .range_high_m = 90});
    ASSERT_TRUE(range.ok());
    EXPECT_DOUBLE_EQ(range->height_m(0), -10);
    EXPECT_DOUBLE_EQ(range->height_m(65535), 90);
    const auto step = choose_scale(grey, survey, {.has_step = true, .offset_m = 187, .step_m = 0.01});
    ASSERT_TRUE(step.ok());
    EXPECT_DOUBLE_EQ(step->height_m(100), 188);
    EXPECT_FALSE(choose_scale(grey, survey, {.has_range = true, .range_low_m = 5, .range_high_m = 5}).ok());
    EXPECT_FALSE(choose_scale(grey, survey, {.has_range = true, .has_step = true, .range_high_m = 5}).ok());

    const SampleImage metres =
        image_of(2, 2, SampleKind::floating, [](int x, int) { return x ? 300.0f : 100.0f; });
    EXPECT_DOUBLE_EQ(choose_scale(metres, survey_samples(metres), {})->height_m(123.5), 123.5);
    const auto stretched = choose_scale(metres, survey_samples(metres),
                                        {.has_range = true, .range_low_m = 0, .range_high_m = 50});
    ASSERT_TRUE(stretched.ok());
    EXPECT_DOUBLE_EQ(stretched->height_m(100), 0);
    EXPECT_DOUBLE_EQ(stretched->height_m(300), 50);
}

}  // namespace
}  // namespace loam
