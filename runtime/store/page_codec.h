// Lossless codec of base pages: 64 x 64 samples to a blob and back.
//
// | byte | constant page | packed page |
// | --- | --- | --- |
// | 0 | 1 height, 2 index | 3 height, 4 index |
// | 1 … | the one value (4 or 5 bytes, little endian), FNV-1a of all bytes before (4 bytes) | one zstd frame
// with content checksum |
//
// Height planes: residual of the median edge detector predictor (left, up, left + up - upleft: LOCO-I,
// Weinberger 2000), zigzag, split in 4 byte planes so that the planes of small residuals are runs of zeros.
// Index planes: layer low, layer high, red, green, blue; zstd finds the runs by itself. The same samples
// always give the same blob (one level, one library, no dictionary). Decoders check every bound and refuse
// whatever is cut, changed or longer than it should be; a blob is untrusted input.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/index_texel.h"

namespace loam {

inline constexpr int kBasePageSide = 64;
inline constexpr int kBasePageSamples = kBasePageSide * kBasePageSide;

[[nodiscard]] std::vector<uint8_t> encode_height_page(std::span<const int32_t, kBasePageSamples> mm);
[[nodiscard]] Status decode_height_page(std::span<const uint8_t> blob,
                                        std::span<int32_t, kBasePageSamples> mm);

// `unused` of the texels must be 0.
[[nodiscard]] std::vector<uint8_t> encode_index_page(std::span<const IndexTexel, kBasePageSamples> texels);
[[nodiscard]] Status decode_index_page(std::span<const uint8_t> blob,
                                       std::span<IndexTexel, kBasePageSamples> texels);

}  // namespace loam
