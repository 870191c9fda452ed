// Satellite or ortho imagery over a whole map: one file, a pyramid of compressed tiles that are read one by
// one, so that any size of picture is shown with a few of them in memory.
//
// Texel (i, j) of level L covers the square from (i, j) · spacing · 2^L to (i + 1, j + 1) · spacing · 2^L of
// the map, from its south-west corner; level 0 is finest, each next one the mean of two by two in linear
// light, down to one tile.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec4.hpp>

#include "runtime/base/result.h"

namespace loam {

inline constexpr int kImageryTile = 256;           // texels a side
inline constexpr int kMaxImageryTexels = 1 << 18;  // 0.125 m over the largest map

struct ImageryShape {
    int width = 0, height = 0;  // texels of level 0
    double spacing_m = 1;
    [[nodiscard]] int level_count() const;
    [[nodiscard]] int width_at(int level) const { return ((width - 1) >> level) + 1; }
    [[nodiscard]] int height_at(int level) const { return ((height - 1) >> level) + 1; }
    bool operator==(const ImageryShape&) const = default;
};

// Takes rows one at a time and keeps a row of tiles of each level in memory.
class ImageryWriter {
  public:
    [[nodiscard]] static Result<std::unique_ptr<ImageryWriter>> create(const std::filesystem::path& file,
                                                                       const ImageryShape& shape);
    ~ImageryWriter();
    // From the north (row height - 1) to the south. Red, green and blue in linear light times cover, and
    // cover (0: no imagery there), each 0 … 1.
    [[nodiscard]] Status append_row(std::span<const glm::vec4> texels);
    // After the last row. Before it there is no such file, or the old one.
    [[nodiscard]] Status finish();
    [[nodiscard]] uint64_t size_bytes() const;  // written so far

  private:
    ImageryWriter();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

class ImageryFile {
  public:
    [[nodiscard]] static Result<std::unique_ptr<ImageryFile>> open(const std::filesystem::path& file);
    ~ImageryFile();
    [[nodiscard]] const ImageryShape& shape() const;
    // A tile's 256 x 256 texels, rows from the south: red, green and blue sRGB-encoded, and cover. What lies
    // beyond the level is 0. Any thread.
    [[nodiscard]] Status read_tile(int level, int x, int y, std::span<uint8_t> rgba) const;

  private:
    ImageryFile();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace loam
