// A picture's rows made those of a map, a few in memory at a time: means where the picture is finer, between
// its pixels where it is coarser.
#pragma once

#include <deque>
#include <functional>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "editor/image_file.h"
#include "runtime/base/result.h"

namespace loam {

// What one place of an axis is made of: pixels from `first` on and their weights, which sum to 1.
struct PixelMix {
    int first = 0;
    std::vector<float> weights;
};

// The mean of [from, to], in pixels from the picture's edge; where that is less than a pixel, between the
// centres of two. Beyond the picture the last pixel counts.
[[nodiscard]] PixelMix mix_between(double from, double to, int pixels);

class RowMixer {
  public:
    using Decode = std::function<glm::vec4(const float* pixel)>;
    // `rows`: of each row that is wanted, from the top; their first pixels must not go back up.
    RowMixer(ImageRows& picture, std::vector<PixelMix> columns, std::vector<PixelMix> rows, Decode decode);
    // The next one, as wide as `columns`; valid until the next call.
    [[nodiscard]] Result<std::span<const glm::vec4>> next();
    // Reads what is left: a picture that is cut short says so in its last rows.
    [[nodiscard]] Status finish();

  private:
    Status hold_next();
    ImageRows& picture_;
    std::vector<PixelMix> columns_, rows_;
    Decode decode_;
    std::deque<std::vector<glm::vec4>> held_;  // rows of the picture, as wide as `columns`
    int first_held_ = 0;
    size_t next_ = 0;
    std::vector<glm::vec4> decoded_, mixed_;
};

}  // namespace loam
