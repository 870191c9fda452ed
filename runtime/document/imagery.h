// Imagery over the map as texels of the index map's own grid, twice as fine: level L has texels of
// index_spacing_m / 2 · 2^L, so that an index page and its imagery are one square. Source: Leadwerks' virtual
// texture talk ("base map").
#pragma once

#include <cstdint>
#include <filesystem>
#include <list>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/imagery_file.h"
#include "runtime/store/project.h"

namespace loam {

// The shape that imagery of a map has whose source's texels are source_m wide: as fine, and no finer than the
// grid's level 0.
[[nodiscard]] ImageryShape imagery_shape(const ProjectSettings& settings, double source_m);

class Imagery {
  public:
    // Refuses a file made for another map.
    [[nodiscard]] static Result<std::unique_ptr<Imagery>> open(const std::filesystem::path& file,
                                                               const ProjectSettings& settings);
    [[nodiscard]] const ImageryShape& shape() const { return file_->shape(); }
    // Texels of a level: red, green, blue (sRGB-encoded) and cover, low byte first; beyond the map the
    // nearest inside. Where the file is coarser than the level they are interpolated. A tile that cannot be
    // read has no cover, and is said once. Any thread.
    void read(int level, int x0, int y0, int width, int height, uint32_t* rgba) const;

  private:
    using TileKey = std::tuple<int, int, int>;  // level, x, y
    using Tile = std::shared_ptr<const std::vector<uint8_t>>;
    explicit Imagery(std::unique_ptr<ImageryFile> file) : file_(std::move(file)) {}
    [[nodiscard]] Tile tile(const TileKey& key) const;
    void read_file_level(int level, int x0, int y0, int width, int height, uint32_t* rgba) const;
    void read_finer(int octaves, int x0, int y0, int width, int height, uint32_t* rgba) const;

    std::unique_ptr<ImageryFile> file_;
    int first_level_ = 0;  // of the grid: the file's level 0
    mutable std::mutex mutex_;
    mutable std::list<std::pair<TileKey, Tile>> tiles_;  // newest first
    mutable bool failed_ = false;
};

}  // namespace loam
