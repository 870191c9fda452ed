// | bytes | meaning |
// | --- | --- |
// | 0–7 | "LOAMSTP1" |
// | 8–19 | width, height, and what it has (bit 0 colours, bit 1 cover), little endian |
// | then | parts (packed_file.h): heights of 2 bytes, colours of 3, cover of 1 a texel |
#include "runtime/store/stamp_file.h"

#include <cstring>

#include "runtime/base/check.h"
#include "runtime/store/packed_file.h"

namespace loam {

namespace {

constexpr char kMagic[] = "LOAMSTP1";
constexpr size_t kHeadBytes = 20;
constexpr uint32_t kHasColors = 1, kHasCover = 2;

Result<StampImage> read_stamp(PartReader& file) {
    uint8_t head[kHeadBytes];
    if (!file.read(head).ok() || std::memcmp(head, kMagic, 8) != 0) return error("not a stamp file");
    const uint32_t width = read_u32(head + 8), height = read_u32(head + 12), has = read_u32(head + 16);
    if (width < 1 || height < 1 || width > kMaxStampTexels || height > kMaxStampTexels)
        return error("its size is {} x {} texels, must be 1 to {} a side", width, height, kMaxStampTexels);
    if (has > (kHasColors | kHasCover)) return error("it is of a newer version");
    StampImage image{.width = int(width), .height = int(height), .heights = {}, .colors = {}, .cover = {}};
    const size_t texels = size_t(width) * height;
    std::vector<uint8_t> pairs(2 * texels);
    LOAM_TRY(file.read_part(pairs));
    image.heights.resize(texels);
    for (size_t i = 0; i < texels; ++i) image.heights[i] = uint16_t(pairs[2 * i] | pairs[2 * i + 1] << 8);
    if (has & kHasColors) {
        image.colors.resize(3 * texels);
        LOAM_TRY(file.read_part(image.colors));
    }
    if (has & kHasCover) {
        image.cover.resize(texels);
        LOAM_TRY(file.read_part(image.cover));
    }
    if (file.rest_bytes() > 0) return error("{} bytes too many at the end", file.rest_bytes());
    return image;
}

}  // namespace

Status save_stamp(const std::filesystem::path& file, const StampImage& image) {
    const size_t texels = size_t(image.width) * size_t(image.height);
    LOAM_CHECK(image.heights.size() == texels &&
                   (image.colors.empty() || image.colors.size() == 3 * texels) &&
                   (image.cover.empty() || image.cover.size() == texels),
               "a stamp's arrays are of its size");
    std::vector<uint8_t> bytes(kMagic, kMagic + 8);
    append_u32(uint32_t(image.width), bytes);
    append_u32(uint32_t(image.height), bytes);
    append_u32((image.colors.empty() ? 0 : kHasColors) | (image.cover.empty() ? 0 : kHasCover), bytes);
    std::vector<uint8_t> pairs;
    pairs.reserve(2 * texels);
    for (const uint16_t height : image.heights) {
        pairs.push_back(uint8_t(height & 255));
        pairs.push_back(uint8_t(height >> 8));
    }
    append_part(pairs, bytes);
    if (!image.colors.empty()) append_part(image.colors, bytes);
    if (!image.cover.empty()) append_part(image.cover, bytes);
    return replace_file(file, bytes);
}

Result<StampImage> load_stamp(const std::filesystem::path& file) {
    auto reader = PartReader::open(file);
    if (!reader.ok()) return reader.error();
    auto image = read_stamp(*reader);
    if (!image.ok()) return error("{}: {}", file.string(), image.message());
    return image;
}

}  // namespace loam
