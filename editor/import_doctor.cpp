#include "editor/import_doctor.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "runtime/base/units.h"

namespace loam {

namespace {

constexpr double kFullCode = 65535.0;         // largest 16-bit sample
constexpr double kUsedShareToMention = 0.25;  // a picture that uses less of its codes wastes two bits
constexpr double kCoarseStep_m = 1.0;         // steps above this are seen as terraces

bool is_integer(SampleKind kind) {
    return kind != SampleKind::floating;
}

// Distinct values by a bitmap over all 16-bit codes (signed ones shifted).
void survey_codes(const SampleImage& image, SampleSurvey& survey) {
    std::vector<bool> used(size_t{1} << 16);
    for (const float sample : image.samples)
        used[static_cast<size_t>(static_cast<int>(sample) + 32768) & 0xffffu] = true;
    // Unsigned codes from 32768 on wrap to the start: order them by value.
    const int low = image.kind == SampleKind::signed_16 ? -32768 : 0;
    int previous = std::numeric_limits<int>::min(), smallest = 0;
    for (int code = low; code < low + 65536; ++code) {
        if (!used[static_cast<size_t>(code + 32768) & 0xffffu]) continue;
        ++survey.distinct;
        if (previous != std::numeric_limits<int>::min())
            smallest = smallest == 0 ? code - previous : std::min(smallest, code - previous);
        previous = code;
    }
    survey.smallest_step = smallest;
}

std::string side_note(int side) {
    if (std::has_single_bit(static_cast<unsigned>(side))) return "2^n";
    if (std::has_single_bit(static_cast<unsigned>(side - 1))) return "2^n + 1";
    return "";
}

}  // namespace

SampleSurvey survey_samples(const SampleImage& image) {
    SampleSurvey survey;
    survey.min = std::numeric_limits<float>::infinity();
    survey.max = -std::numeric_limits<float>::infinity();
    for (size_t i = 0; i < image.samples.size(); ++i) {
        const float sample = image.samples[i];
        if (!std::isfinite(sample)) {
            if (survey.bad_count++ == 0) {
                survey.bad_x = static_cast<int>(i % static_cast<size_t>(image.width));
                survey.bad_y = static_cast<int>(i / static_cast<size_t>(image.width));
            }
            continue;
        }
        survey.min = std::min(survey.min, sample);
        survey.max = std::max(survey.max, sample);
    }
    if (is_integer(image.kind)) survey_codes(image, survey);
    return survey;
}

Status check_importable(const SampleImage& image, const SampleSurvey& survey, double spacing_m,
                        bool fill_nan) {
    if (image.channels_differ)
        return error(
            "the picture has {} channels that differ: it looks like a colour picture, expected one channel "
            "of heights",
            image.channel_count);
    if (image.width < 2 || image.height < 2)
        return error("the picture has {}x{} samples, expected at least 2x2", image.width, image.height);
    if (image.width > kMaxImportSide || image.height > kMaxImportSide)
        return error("the picture has {}x{} samples, at most {} a side", image.width, image.height,
                     kMaxImportSide);
    const double side_m = (std::max(image.width, image.height) - 1) * spacing_m;
    if (side_m > kMaxMapSize_m)
        return error(
            "{} samples at {} m are {:.0f} m, more than the {:.0f} m a map may have: use a smaller --spacing "
            "or --crop",
            std::max(image.width, image.height), spacing_m, side_m, kMaxMapSize_m);
    if (survey.bad_count == image.samples.size()) return error("no sample of the picture is a finite number");
    if (survey.bad_count > 0 && !fill_nan)
        return error(
            "{} of {} samples are NaN or infinite, the first at column {}, row {}: give them a height with "
            "--fill-nan M",
            survey.bad_count, image.samples.size(), survey.bad_x, survey.bad_y);
    return {};
}

Result<HeightScale> choose_scale(const SampleImage& image, const SampleSurvey& survey,
                                 const ScaleRequest& request) {
    if (request.has_range && request.has_step) return error("--range and --step exclude each other");
    if (request.has_step) {
        if (request.step_m == 0) return error("--step 0 would make the ground flat");
        return HeightScale{request.offset_m, request.step_m};
    }
    if (!request.has_range) {
        if (image.kind == SampleKind::floating || image.kind == SampleKind::signed_16)
            return HeightScale{0, 1};
        return error(
            "integer samples need a scale: give --range LOW HIGH (metres of black and white) or --step M "
            "--offset M");
    }
    if (!(request.range_low_m < request.range_high_m))
        return error("--range {} {} is empty, expected LOW below HIGH", request.range_low_m,
                     request.range_high_m);
    const double span_m = request.range_high_m - request.range_low_m;
    double low = 0, high = kFullCode;
    if (image.kind == SampleKind::unsigned_8) high = 255;
    if (image.kind == SampleKind::signed_16) low = -32768, high = 32767;
    if (image.kind == SampleKind::floating) {
        low = survey.min;
        high = survey.max;
        if (low == high) return error("all samples are {}: --range has nothing to stretch", low);
    }
    const double step_m = span_m / (high - low);
    return HeightScale{request.range_low_m - low * step_m, step_m};
}

Diagnosis diagnose(const SampleImage& image, const SampleSurvey& survey, const HeightScale& scale,
                   double spacing_m) {
    Diagnosis d;
    const double low_m = std::min(scale.height_m(survey.min), scale.height_m(survey.max));
    const double high_m = std::max(scale.height_m(survey.min), scale.height_m(survey.max));
    d.notes.push_back(fmt::format("{}x{} samples every {} m, {:.1f} x {:.1f} m, heights {:.3f} … {:.3f} m",
                                  image.width, image.height, spacing_m, (image.width - 1) * spacing_m,
                                  (image.height - 1) * spacing_m, low_m, high_m));
    if (image.width != image.height) d.notes.push_back("the map is not square, which is fine");
    const std::string kind = side_note(image.width);
    if (!kind.empty() && image.width == image.height)
        d.notes.push_back(fmt::format("the side of {} samples is {}, that is {} cells", image.width, kind,
                                      image.width - 1));
    if (image.channel_count > 1)
        d.notes.push_back(
            fmt::format("the picture has {} channels, the first one is used", image.channel_count));
    if (image.was_double) d.notes.push_back("64-bit samples are read as 32-bit floats, which keep 7 digits");

    if (image.kind == SampleKind::unsigned_8)
        d.warnings.push_back(
            fmt::format("the picture has 8 bits: 256 heights, {:.3f} m apart, will show as terraces; use a "
                        "16-bit picture",
                        std::abs(scale.step_m)));
    if (image.kind == SampleKind::unsigned_16) {
        const double share = (static_cast<double>(survey.max) - survey.min + 1) / (kFullCode + 1);
        if (share < kUsedShareToMention)
            d.warnings.push_back(fmt::format(
                "the samples {} … {} use {:.1f} % of 16 bits; a narrower range would keep finer steps",
                survey.min, survey.max, 100 * share));
    }
    if (is_integer(image.kind) && survey.distinct > 1) {
        const double step_m = survey.smallest_step * std::abs(scale.step_m);
        if (survey.smallest_step > 1)
            d.warnings.push_back(fmt::format(
                "heights change in steps of {:.0f} units ({:.3f} m): the picture was made from coarser data",
                survey.smallest_step, step_m));
        else if (step_m > kCoarseStep_m)
            d.warnings.push_back(fmt::format("one unit is {:.2f} m: slopes will show terraces", step_m));
    }
    if (survey.min == survey.max) d.warnings.push_back("all samples are equal: the ground is flat");
    if (high_m > height_m_from_mm(kHeightLimit_mm) || low_m < -height_m_from_mm(kHeightLimit_mm))
        d.warnings.push_back(
            fmt::format("heights beyond ±{:.0f} m are cut off", height_m_from_mm(kHeightLimit_mm)));
    if (survey.bad_count > 0)
        d.warnings.push_back(
            fmt::format("{} samples are NaN or infinite and get the height of --fill-nan", survey.bad_count));
    const double relief = (high_m - low_m) / ((std::max(image.width, image.height) - 1) * spacing_m);
    if (relief > 1.0)
        d.warnings.push_back(fmt::format(
            "the ground is {:.1f} times as high as it is wide: is --spacing or the scale wrong?", relief));
    return d;
}

}  // namespace loam
