#include "runtime/store/page_codec.h"

#include <algorithm>
#include <array>

#include "runtime/base/check.h"
#include "runtime/store/zstd_frame.h"

namespace loam {

namespace {

enum BlobFormat : uint8_t { kConstantHeight = 1, kConstantIndex = 2, kPackedHeight = 3, kPackedIndex = 4 };

// Level 1 of zstd: a page in about 40 us; level 3 takes twice as long for 3 % less on eroded ridges.
constexpr int kZstdLevel = 1;
constexpr int kSide = kBasePageSide;
constexpr int kSamples = kBasePageSamples;

uint32_t fnv1a(std::span<const uint8_t> bytes) {
    uint32_t hash = 2166136261u;
    for (const uint8_t byte : bytes) hash = (hash ^ byte) * 16777619u;
    return hash;
}

void append_u32(std::vector<uint8_t>& out, uint32_t value) {
    for (int i = 0; i < 4; ++i) out.push_back(uint8_t(value >> (8 * i)));
}

uint32_t read_u32(const uint8_t* bytes) {
    return uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8 | uint32_t(bytes[2]) << 16 | uint32_t(bytes[3]) << 24;
}

std::vector<uint8_t> constant_blob(BlobFormat format, std::span<const uint8_t> value) {
    std::vector<uint8_t> blob;
    blob.reserve(1 + value.size() + 4);
    blob.push_back(format);
    for (const uint8_t byte : value) blob.push_back(byte);
    append_u32(blob, fnv1a(blob));
    return blob;
}

// The value's bytes, or an error.
Result<std::span<const uint8_t>> read_constant(std::span<const uint8_t> blob, size_t value_bytes) {
    if (blob.size() != 1 + value_bytes + 4)
        return error("damaged page: {} bytes, {} expected", blob.size(), 1 + value_bytes + 4);
    if (fnv1a(blob.first(1 + value_bytes)) != read_u32(blob.data() + 1 + value_bytes))
        return error("damaged page: wrong checksum");
    return blob.subspan(1, value_bytes);
}

// Median edge detector on wrapping 32-bit numbers; exact for any input as encoder and decoder compute the
// same.
uint32_t predict(uint32_t left, uint32_t up, uint32_t up_left) {
    const int32_t a = int32_t(left), b = int32_t(up), c = int32_t(up_left);
    const int32_t low = std::min(a, b), high = std::max(a, b);
    if (c >= high) return uint32_t(low);
    if (c <= low) return uint32_t(high);
    return left + up - up_left;
}

uint32_t predict_at(const int32_t* mm, int x, int y) {
    const int32_t* at = mm + y * kSide + x;
    if (x == 0) return y == 0 ? 0u : uint32_t(at[-kSide]);
    if (y == 0) return uint32_t(at[-1]);
    return predict(uint32_t(at[-1]), uint32_t(at[-kSide]), uint32_t(at[-kSide - 1]));
}

uint32_t zigzag(uint32_t v) {
    return (v << 1) ^ (v >> 31 ? 0xffffffffu : 0u);
}
uint32_t unzigzag(uint32_t v) {
    return (v >> 1) ^ (v & 1 ? 0xffffffffu : 0u);
}

}  // namespace

std::vector<uint8_t> encode_height_page(std::span<const int32_t, kBasePageSamples> mm) {
    if (std::all_of(mm.begin(), mm.end(), [&](int32_t v) { return v == mm[0]; })) {
        std::vector<uint8_t> value;
        append_u32(value, uint32_t(mm[0]));
        return constant_blob(kConstantHeight, value);
    }
    std::array<uint8_t, 4 * kSamples> planes;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const int i = y * kSide + x;
            const uint32_t code = zigzag(uint32_t(mm[i]) - predict_at(mm.data(), x, y));
            for (int plane = 0; plane < 4; ++plane)
                planes[plane * kSamples + i] = uint8_t(code >> (8 * plane));
        }
    std::vector<uint8_t> blob{kPackedHeight};
    append_zstd_frame(planes, kZstdLevel, blob);
    return blob;
}

Status decode_height_page(std::span<const uint8_t> blob, std::span<int32_t, kBasePageSamples> mm) {
    if (blob.empty()) return error("damaged page: empty");
    if (blob[0] == kConstantHeight) {
        const auto value = read_constant(blob, 4);
        if (!value.ok()) return value.error();
        std::fill(mm.begin(), mm.end(), int32_t(read_u32(value->data())));
        return {};
    }
    if (blob[0] != kPackedHeight) return error("damaged page: unknown height format {}", blob[0]);
    std::array<uint8_t, 4 * kSamples> planes;
    LOAM_TRY(read_zstd_frame(blob.subspan(1), planes));
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const int i = y * kSide + x;
            uint32_t code = 0;
            for (int plane = 0; plane < 4; ++plane)
                code |= uint32_t(planes[plane * kSamples + i]) << (8 * plane);
            mm[i] = int32_t(predict_at(mm.data(), x, y) + unzigzag(code));
        }
    return {};
}

std::vector<uint8_t> encode_index_page(std::span<const IndexTexel, kBasePageSamples> texels) {
    const auto bytes_of = [](const IndexTexel& t) {
        return std::array<uint8_t, 5>{uint8_t(t.layer), uint8_t(t.layer >> 8), t.tint[0], t.tint[1],
                                      t.tint[2]};
    };
    LOAM_CHECK(std::all_of(texels.begin(), texels.end(), [](const IndexTexel& t) { return t.unused == 0; }),
               "the unused byte of an index texel must be 0");
    if (std::all_of(texels.begin(), texels.end(), [&](const IndexTexel& t) { return t == texels[0]; }))
        return constant_blob(kConstantIndex, bytes_of(texels[0]));
    std::array<uint8_t, 5 * kSamples> planes;
    for (int i = 0; i < kSamples; ++i) {
        const auto bytes = bytes_of(texels[i]);
        for (int plane = 0; plane < 5; ++plane) planes[plane * kSamples + i] = bytes[plane];
    }
    std::vector<uint8_t> blob{kPackedIndex};
    append_zstd_frame(planes, kZstdLevel, blob);
    return blob;
}

Status decode_index_page(std::span<const uint8_t> blob, std::span<IndexTexel, kBasePageSamples> texels) {
    const auto texel_of = [](const uint8_t* bytes, int stride) {
        IndexTexel texel;
        texel.layer = uint16_t(bytes[0] | bytes[stride] << 8);
        for (int channel = 0; channel < 3; ++channel) texel.tint[channel] = bytes[(2 + channel) * stride];
        return texel;
    };
    if (blob.empty()) return error("damaged page: empty");
    if (blob[0] == kConstantIndex) {
        const auto value = read_constant(blob, 5);
        if (!value.ok()) return value.error();
        std::fill(texels.begin(), texels.end(), texel_of(value->data(), 1));
        return {};
    }
    if (blob[0] != kPackedIndex) return error("damaged page: unknown index format {}", blob[0]);
    std::array<uint8_t, 5 * kSamples> planes;
    LOAM_TRY(read_zstd_frame(blob.subspan(1), planes));
    for (int i = 0; i < kSamples; ++i) texels[i] = texel_of(planes.data() + i, kSamples);
    return {};
}

}  // namespace loam
