// A picture that stamps lay on the ground: a file a stamp, made from any picture by import.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

constexpr int kMaxStampTexels = 4096;  // a side

// Rows from the south; texel i's centre is at (i + 0.5) / width.
struct StampImage {
    int width = 0, height = 0;
    std::vector<uint16_t> heights;  // 0 black … 65535 white
    std::vector<uint8_t> colors;    // sRGB-encoded RGB a texel; empty: has none
    std::vector<uint8_t> cover;     // how much of the stamp there is, 0 … 255; empty: all of it everywhere
};

[[nodiscard]] Status save_stamp(const std::filesystem::path& file, const StampImage& image);
[[nodiscard]] Result<StampImage> load_stamp(const std::filesystem::path& file);

}  // namespace loam
