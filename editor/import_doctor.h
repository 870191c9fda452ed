// The import doctor: what a height picture is like, in plain words. Pure functions of the samples, so that
// every finding has a test.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "editor/image_file.h"

namespace loam {

inline constexpr int kMaxImportSide = 16384;  // samples

// How samples become metres: height = offset_m + sample * step_m.
struct HeightScale {
    double offset_m = 0, step_m = 1;
    [[nodiscard]] double height_m(double sample) const { return offset_m + sample * step_m; }
};

struct ScaleRequest {
    bool has_range = false, has_step = false;
    double range_low_m = 0,
           range_high_m =
               0;  // of the integer type's smallest and largest value; of a float picture's own extremes
    double offset_m = 0, step_m = 1;
};

struct SampleSurvey {
    float min = 0, max = 0;    // of the finite samples
    uint64_t bad_count = 0;    // NaN or infinite
    int bad_x = 0, bad_y = 0;  // the first of them, from the upper left corner
    uint32_t distinct = 0;     // different values, integers only
    double smallest_step =
        0;  // between two values that occur, integers only; 1 when all codes between are in use
};

struct Diagnosis {
    std::vector<std::string> notes;     // said, nothing to worry about
    std::vector<std::string> warnings;  // works, but a person may want to do something
};

[[nodiscard]] SampleSurvey survey_samples(const SampleImage& image);
// Refuses what cannot be a height map, and says which option is missing.
[[nodiscard]] Result<HeightScale> choose_scale(const SampleImage& image, const SampleSurvey& survey,
                                               const ScaleRequest& request);
[[nodiscard]] Status check_importable(const SampleImage& image, const SampleSurvey& survey, double spacing_m,
                                      bool fill_nan);
[[nodiscard]] Diagnosis diagnose(const SampleImage& image, const SampleSurvey& survey,
                                 const HeightScale& scale, double spacing_m);

}  // namespace loam
