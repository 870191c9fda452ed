// One map of a material as numbers: read, mended, resampled.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

inline constexpr int kMaxMapSide = 16384;  // pixels

// One channel; row 0 is south.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> v;
    [[nodiscard]] float at(int x, int y) const {
        return v[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
    }
};

struct MapImage {
    std::vector<Plane> channels;   // at most 4; integers divided by their largest value, floats as they are
    bool has_alpha = false;        // the last of 2 or 4 channels
    bool is_float = false;         // linear by custom
    bool says_linear = false;      // the file itself
    bool channels_differ = false;  // red, green and blue are not equal everywhere

    [[nodiscard]] int width() const { return channels[0].width; }
    [[nodiscard]] int height() const { return channels[0].height; }
    [[nodiscard]] int color_channels() const {
        return static_cast<int>(channels.size()) - (has_alpha ? 1 : 0);
    }
};

// Samples that are NaN or infinite become the mean of the channel's others, and a warning counts them; a map
// without a finite sample is refused.
[[nodiscard]] Result<MapImage> read_map(const std::filesystem::path& file,
                                        std::vector<std::string>& warnings);

// To a square of `size` texels: the plane repeated in each direction, with a tent of one texel's width (of
// the coarser grid), over the edges. Equal sizes give equal numbers.
[[nodiscard]] Plane resampled(const Plane& plane, int repeat_x, int repeat_y, int size);

}  // namespace loam
