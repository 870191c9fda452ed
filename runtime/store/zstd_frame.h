// One zstd frame with content size and checksum. Contexts are kept a thread, as making one costs more than a
// page.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

// Appends the frame of `bytes` to `out`.
void append_zstd_frame(std::span<const uint8_t> bytes, int level, std::vector<uint8_t>& out);
// `frame` must be exactly one frame with a checksum that holds exactly bytes.size() bytes. On an error
// `bytes` is undefined.
[[nodiscard]] Status read_zstd_frame(std::span<const uint8_t> frame, std::span<uint8_t> bytes);

}  // namespace loam
