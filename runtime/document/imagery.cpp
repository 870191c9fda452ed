#include "runtime/document/imagery.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "runtime/base/log.h"

namespace loam {

namespace {

constexpr size_t kTilesKept = 64;  // 16 MB
constexpr size_t kTileBytes = size_t(4) * kImageryTile * kImageryTile;

}  // namespace

ImageryShape imagery_shape(const ProjectSettings& settings, double source_m) {
    const WorldRect bounds = settings.bounds();
    ImageryShape shape{.width = 0, .height = 0, .spacing_m = settings.index_spacing_m / 2};
    const double extent_m = std::max(bounds.max_x, bounds.max_y);
    while (2 * shape.spacing_m <= source_m && 2 * shape.spacing_m < extent_m) shape.spacing_m *= 2;
    const auto texels = [&](double metres) {
        return std::max(1, int(std::ceil(metres / shape.spacing_m - 1e-6)));
    };
    shape.width = texels(bounds.max_x);
    shape.height = texels(bounds.max_y);
    return shape;
}

Result<std::unique_ptr<Imagery>> Imagery::open(const std::filesystem::path& file,
                                               const ProjectSettings& settings) {
    auto opened = ImageryFile::open(file);
    if (!opened.ok()) return opened.error();
    const ImageryShape& shape = (*opened)->shape();
    if (shape != imagery_shape(settings, shape.spacing_m))
        return error("{} was made for another map: {} x {} texels of {} m; import the picture again",
                     file.string(), shape.width, shape.height, shape.spacing_m);
    std::unique_ptr<Imagery> imagery(new Imagery(std::move(*opened)));
    imagery->first_level_ = int(std::lround(std::log2(shape.spacing_m / (settings.index_spacing_m / 2))));
    return imagery;
}

Imagery::Tile Imagery::tile(const TileKey& key) const {
    {
        const std::lock_guard lock(mutex_);
        for (auto at = tiles_.begin(); at != tiles_.end(); ++at)
            if (at->first == key) {
                tiles_.splice(tiles_.begin(), tiles_, at);
                return at->second;
            }
    }
    auto bytes = std::make_shared<std::vector<uint8_t>>(kTileBytes);
    const auto& [level, x, y] = key;
    const Status read = file_->read_tile(level, x, y, *bytes);
    const std::lock_guard lock(mutex_);
    if (!read.ok()) {
        std::fill(bytes->begin(), bytes->end(), uint8_t(0));
        if (!failed_) log(LogLevel::error, "imagery is not shown everywhere: {}", read.message());
        failed_ = true;
    }
    tiles_.emplace_front(key, bytes);
    if (tiles_.size() > kTilesKept) tiles_.pop_back();
    return bytes;
}

void Imagery::read_file_level(int level, int x0, int y0, int width, int height, uint32_t* rgba) const {
    // A level coarser than the file's last one has a texel of that wherever one of its own begins.
    const int octaves = std::max(0, level - (shape().level_count() - 1));
    level -= octaves;
    const int last_x = shape().width_at(level) - 1, last_y = shape().height_at(level) - 1;
    Tile held;
    TileKey held_key{-1, 0, 0};
    for (int j = 0; j < height; ++j) {
        const int y = std::clamp((y0 + j) << octaves, 0, last_y);
        for (int i = 0; i < width; ++i) {
            const int x = std::clamp((x0 + i) << octaves, 0, last_x);
            const TileKey key{level, x / kImageryTile, y / kImageryTile};
            if (key != held_key) held = tile(held_key = key);
            const size_t at = size_t(y % kImageryTile) * kImageryTile + size_t(x % kImageryTile);
            std::memcpy(rgba++, held->data() + 4 * at, 4);
        }
    }
}

// Level 0 of the file between its texels' centres, as encoded, weighted by cover.
void Imagery::read_finer(int octaves, int x0, int y0, int width, int height, uint32_t* rgba) const {
    const double scale = std::exp2(-octaves);
    const auto low = [&](int at) { return int(std::floor((at + 0.5) * scale - 0.5)); };
    const int from_x = low(x0), from_y = low(y0);
    const int columns = low(x0 + width - 1) + 2 - from_x, rows = low(y0 + height - 1) + 2 - from_y;
    std::vector<uint32_t> coarse(size_t(columns) * size_t(rows));
    read_file_level(0, from_x, from_y, columns, rows, coarse.data());
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            const double x = (x0 + i + 0.5) * scale - 0.5 - from_x, y = (y0 + j + 0.5) * scale - 0.5 - from_y;
            const double fx = x - std::floor(x), fy = y - std::floor(y);
            const uint32_t* at = &coarse[size_t(std::floor(y)) * size_t(columns) + size_t(std::floor(x))];
            std::array<double, 3> sum{};
            double cover = 0;
            for (size_t k = 0; k < 4; ++k) {
                const uint32_t texel = at[(k >> 1) * size_t(columns) + (k & 1)];
                const double weight = (k & 1 ? fx : 1 - fx) * (k & 2 ? fy : 1 - fy) * (texel >> 24);
                cover += weight;
                for (size_t c = 0; c < 3; ++c) sum[c] += weight * (texel >> (8 * c) & 0xff);
            }
            uint32_t out = uint32_t(std::lround(cover)) << 24;
            for (size_t c = 0; cover > 0 && c < 3; ++c)
                out |= uint32_t(std::lround(sum[c] / cover)) << (8 * c);
            *rgba++ = out;
        }
}

void Imagery::read(int level, int x0, int y0, int width, int height, uint32_t* rgba) const {
    if (level >= first_level_)
        read_file_level(level - first_level_, x0, y0, width, height, rgba);
    else
        read_finer(first_level_ - level, x0, y0, width, height, rgba);
}

}  // namespace loam
