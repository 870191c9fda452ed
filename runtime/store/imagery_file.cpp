// | bytes | meaning |
// | --- | --- |
// | 0–7 | "LOAMIMG1" |
// | 8–23 | width and height in texels; spacing in metres, a double; all little endian |
// | then | tiles in the order they were finished, each a zstd frame: red, green, blue, cover one after the
// other, each byte less | |      | its neighbour on the left | | then | the table, a zstd frame: 8 bytes of
// place and 4 of length a tile; level after level, rows from the south | | last 20 | place (8) and length (4)
// of the table, "LOAMIMG1" |
#include "runtime/store/imagery_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "runtime/base/check.h"
#include "runtime/base/srgb.h"
#include "runtime/store/packed_file.h"
#include "runtime/store/zstd_frame.h"

namespace loam {

namespace {

constexpr char kMagic[] = "LOAMIMG1";
constexpr size_t kHeadBytes = 24, kTailBytes = 20, kEntryBytes = 12;
constexpr size_t kTileTexels = size_t(kImageryTile) * kImageryTile, kTileBytes = 4 * kTileTexels;
constexpr int kZstdLevel = 3;  // higher ones gain 2 % on photographs

void append_u64(uint64_t value, std::vector<uint8_t>& bytes) {
    append_u32(uint32_t(value), bytes);
    append_u32(uint32_t(value >> 32), bytes);
}

uint64_t read_u64(const uint8_t* bytes) {
    return uint64_t(read_u32(bytes)) | uint64_t(read_u32(bytes + 4)) << 32;
}

int tiles_across(int texels) {
    return (texels + kImageryTile - 1) / kImageryTile;
}

// Where each level's tiles begin in the table; at the end, how many there are.
std::vector<size_t> level_offsets(const ImageryShape& shape) {
    std::vector<size_t> offsets{0};
    for (int level = 0; level < shape.level_count(); ++level)
        offsets.push_back(offsets.back() + size_t(tiles_across(shape.width_at(level))) *
                                               size_t(tiles_across(shape.height_at(level))));
    return offsets;
}

Status check_shape(const ImageryShape& shape) {
    if (shape.width < 1 || shape.height < 1 || shape.width > kMaxImageryTexels ||
        shape.height > kMaxImageryTexels)
        return error("its size is {} x {} texels, must be 1 to {} a side", shape.width, shape.height,
                     kMaxImageryTexels);
    if (!std::isfinite(shape.spacing_m) || shape.spacing_m <= 0)
        return error("its texels are {} m wide", shape.spacing_m);
    return {};
}

void planes_of(std::span<const uint8_t> rgba, std::span<uint8_t> planes) {
    for (size_t c = 0; c < 4; ++c)
        for (size_t i = 0; i < kTileTexels; ++i)
            planes[c * kTileTexels + i] =
                uint8_t(rgba[4 * i + c] - (i % kImageryTile == 0 ? 0 : rgba[4 * (i - 1) + c]));
}

void texels_of(std::span<const uint8_t> planes, std::span<uint8_t> rgba) {
    for (size_t c = 0; c < 4; ++c)
        for (size_t i = 0; i < kTileTexels; ++i)
            rgba[4 * i + c] =
                uint8_t(planes[c * kTileTexels + i] + (i % kImageryTile == 0 ? 0 : rgba[4 * (i - 1) + c]));
}

// Within a tenth of a byte's step of the curve.
uint8_t srgb8_by_table(float linear) {
    constexpr int kSteps = 16383;
    static const std::vector<uint8_t> table = [] {
        std::vector<uint8_t> t;
        for (int i = 0; i <= kSteps; ++i) t.push_back(srgb8_of_linear(double(i) / kSteps));
        return t;
    }();
    return table[size_t(std::clamp(linear, 0.0f, 1.0f) * kSteps + 0.5f)];
}

void encode_texel(const glm::vec4& texel, uint8_t* rgba) {
    const float cover = std::clamp(texel.w, 0.0f, 1.0f);
    for (int c = 0; c < 3; ++c) rgba[c] = cover > 0 ? srgb8_by_table(texel[c] / cover) : 0;
    rgba[3] = uint8_t(std::lround(cover * 255));
}

}  // namespace

int ImageryShape::level_count() const {
    int count = 1;
    while (std::max(width_at(count - 1), height_at(count - 1)) > kImageryTile) ++count;
    return count;
}

struct ImageryWriter::Impl {
    explicit Impl(ReplacedFile replaced) : file(std::move(replaced)) {}

    struct Level {
        int next_row = 0;                // from the north: height - 1 … 0; -1: done
        std::vector<uint8_t> rows;       // of the row of tiles that is being filled, sRGB and cover
        std::vector<glm::vec4> waiting;  // an odd row that waits for the even one south of it
    };
    Status take(int level, std::span<const glm::vec4> texels);
    Status write_tiles(int level, int tile_y);

    ReplacedFile file;
    ImageryShape shape;
    std::vector<Level> levels;
    std::vector<size_t> offsets;
    std::vector<std::pair<uint64_t, uint32_t>> table;  // place, length
};

ImageryWriter::ImageryWriter() = default;
ImageryWriter::~ImageryWriter() = default;

Result<std::unique_ptr<ImageryWriter>> ImageryWriter::create(const std::filesystem::path& file,
                                                             const ImageryShape& shape) {
    if (const Status status = check_shape(shape); !status.ok())
        return error("{}: {}", file.string(), status.message());
    auto replaced = ReplacedFile::create(file);
    if (!replaced.ok()) return replaced.error();
    std::unique_ptr<ImageryWriter> writer(new ImageryWriter);
    writer->impl_ = std::make_unique<Impl>(std::move(*replaced));
    Impl& w = *writer->impl_;
    w.shape = shape;
    w.offsets = level_offsets(shape);
    w.table.resize(w.offsets.back());
    w.levels.resize(size_t(shape.level_count()));
    for (int level = 0; level < shape.level_count(); ++level) {
        w.levels[size_t(level)].next_row = shape.height_at(level) - 1;
        w.levels[size_t(level)].rows.resize(size_t(tiles_across(shape.width_at(level))) * kTileBytes);
    }
    std::vector<uint8_t> head(kMagic, kMagic + 8);
    append_u32(uint32_t(shape.width), head);
    append_u32(uint32_t(shape.height), head);
    append_u64(std::bit_cast<uint64_t>(shape.spacing_m), head);
    LOAM_TRY(w.file.append(head));
    return writer;
}

Status ImageryWriter::append_row(std::span<const glm::vec4> texels) {
    LOAM_CHECK(int(texels.size()) == impl_->shape.width && impl_->levels[0].next_row >= 0,
               "rows of imagery are as wide as its shape, and as many as it is high");
    return impl_->take(0, texels);
}

Status ImageryWriter::Impl::take(int level, std::span<const glm::vec4> texels) {
    Level& l = levels[size_t(level)];
    const int row = l.next_row--;
    const size_t row_texels = size_t(tiles_across(shape.width_at(level))) * kImageryTile;
    uint8_t* out = &l.rows[size_t(row % kImageryTile) * row_texels * 4];
    for (size_t i = 0; i < texels.size(); ++i) encode_texel(texels[i], out + 4 * i);
    if (row % kImageryTile == 0) LOAM_TRY(write_tiles(level, row / kImageryTile));
    if (level + 1 == int(levels.size())) return {};

    if (row % 2 == 1) {
        l.waiting.assign(texels.begin(), texels.end());
        return {};
    }
    // The northernmost row of an odd number, and the easternmost column, stand for themselves.
    const std::span<const glm::vec4> north = l.waiting.empty() ? texels : l.waiting;
    std::vector<glm::vec4> coarse(size_t(shape.width_at(level + 1)));
    for (size_t i = 0; i < coarse.size(); ++i) {
        const size_t west = 2 * i, east = std::min(2 * i + 1, texels.size() - 1);
        coarse[i] = 0.25f * (texels[west] + texels[east] + north[west] + north[east]);
    }
    l.waiting.clear();
    return take(level + 1, coarse);
}

Status ImageryWriter::Impl::write_tiles(int level, int tile_y) {
    Level& l = levels[size_t(level)];
    const int across = tiles_across(shape.width_at(level));
    std::vector<uint8_t> tile(kTileBytes), planes(kTileBytes), frame;
    for (int x = 0; x < across; ++x) {
        for (int y = 0; y < kImageryTile; ++y)
            std::memcpy(&tile[size_t(y) * kImageryTile * 4],
                        &l.rows[(size_t(y) * size_t(across) + size_t(x)) * kImageryTile * 4],
                        kImageryTile * 4);
        planes_of(tile, planes);
        frame.clear();
        append_zstd_frame(planes, kZstdLevel, frame);
        table[offsets[size_t(level)] + size_t(tile_y) * size_t(across) + size_t(x)] = {
            file.size_bytes(), uint32_t(frame.size())};
        LOAM_TRY(file.append(frame));
    }
    std::fill(l.rows.begin(), l.rows.end(), uint8_t(0));
    return {};
}

Status ImageryWriter::finish() {
    Impl& w = *impl_;
    LOAM_CHECK(w.levels[0].next_row < 0, "imagery is finished after its last row");
    std::vector<uint8_t> entries, frame, tail;
    for (const auto& [place, length] : w.table) {
        append_u64(place, entries);
        append_u32(length, entries);
    }
    append_zstd_frame(entries, kZstdLevel, frame);
    append_u64(w.file.size_bytes(), tail);
    append_u32(uint32_t(frame.size()), tail);
    tail.insert(tail.end(), kMagic, kMagic + 8);
    LOAM_TRY(w.file.append(frame));
    LOAM_TRY(w.file.append(tail));
    return w.file.commit();
}

uint64_t ImageryWriter::size_bytes() const {
    return impl_->file.size_bytes();
}

struct ImageryFile::Impl {
    ~Impl() {
        if (descriptor >= 0) ::close(descriptor);
    }
    Status read(uint64_t place, std::span<uint8_t> bytes) const {
        while (!bytes.empty()) {
            const ssize_t got = ::pread(descriptor, bytes.data(), bytes.size(), off_t(place));
            if (got < 0 && errno == EINTR) continue;
            if (got < 0) return error("{} cannot be read: {}", path.string(), std::strerror(errno));
            if (got == 0) return error("{} is cut short", path.string());
            bytes = bytes.subspan(size_t(got));
            place += uint64_t(got);
        }
        return {};
    }
    Status load();

    std::filesystem::path path;
    int descriptor = -1;
    ImageryShape shape;
    std::vector<size_t> offsets;
    std::vector<uint8_t> table;
};

ImageryFile::ImageryFile() = default;
ImageryFile::~ImageryFile() = default;

Status ImageryFile::Impl::load() {
    const off_t size = ::lseek(descriptor, 0, SEEK_END);
    std::vector<uint8_t> head(kHeadBytes), tail(kTailBytes);
    if (size < off_t(kHeadBytes + kTailBytes)) return error("{} is no imagery file", path.string());
    LOAM_TRY(read(0, head));
    LOAM_TRY(read(uint64_t(size) - kTailBytes, tail));
    if (std::memcmp(head.data(), kMagic, 8) != 0) return error("{} is no imagery file", path.string());
    if (std::memcmp(tail.data() + 12, kMagic, 8) != 0) return error("{} is cut short", path.string());
    shape = {int(read_u32(head.data() + 8)), int(read_u32(head.data() + 12)),
             std::bit_cast<double>(read_u64(head.data() + 16))};
    if (const Status status = check_shape(shape); !status.ok())
        return error("{}: {}", path.string(), status.message());
    offsets = level_offsets(shape);
    const uint64_t place = read_u64(tail.data());
    const uint32_t length = read_u32(tail.data() + 8);
    if (place > uint64_t(size) || length > uint64_t(size) - place)
        return error("{} is damaged: its table lies outside", path.string());
    std::vector<uint8_t> frame(length);
    LOAM_TRY(read(place, frame));
    table.resize(offsets.back() * kEntryBytes);
    if (const Status status = read_zstd_frame(frame, table); !status.ok())
        return error("{}: {}", path.string(), status.message());
    return {};
}

Result<std::unique_ptr<ImageryFile>> ImageryFile::open(const std::filesystem::path& file) {
    std::unique_ptr<ImageryFile> opened(new ImageryFile);
    opened->impl_ = std::make_unique<Impl>();
    Impl& f = *opened->impl_;
    f.path = file;
    f.descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (f.descriptor < 0) return error("{} cannot be read: {}", file.string(), std::strerror(errno));
    LOAM_TRY(f.load());
    return opened;
}

const ImageryShape& ImageryFile::shape() const {
    return impl_->shape;
}

Status ImageryFile::read_tile(int level, int x, int y, std::span<uint8_t> rgba) const {
    const Impl& f = *impl_;
    const int across = tiles_across(f.shape.width_at(level));
    LOAM_CHECK(rgba.size() == kTileBytes && x >= 0 && x < across && y >= 0 &&
                   y < tiles_across(f.shape.height_at(level)),
               "a tile of the imagery");
    const uint8_t* entry =
        &f.table[(f.offsets[size_t(level)] + size_t(y) * size_t(across) + size_t(x)) * kEntryBytes];
    const uint32_t length = read_u32(entry + 8);
    if (length > 2 * kTileBytes) return error("{} is damaged: a tile of {} bytes", f.path.string(), length);
    std::vector<uint8_t> frame(length), planes(kTileBytes);
    LOAM_TRY(f.read(read_u64(entry), frame));
    if (const Status status = read_zstd_frame(frame, planes); !status.ok())
        return error("{}, tile {}, {} of level {}: {}", f.path.string(), x, y, level, status.message());
    texels_of(planes, rgba);
    return {};
}

}  // namespace loam
