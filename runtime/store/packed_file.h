// Files of the project that hold arrays: a head, then parts, each a length and a zstd frame with checksum, so
// that a cut or changed byte is found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

// Little endian.
void append_u32(uint32_t value, std::vector<uint8_t>& bytes);
[[nodiscard]] uint32_t read_u32(const uint8_t* bytes);

void append_part(std::span<const uint8_t> part, std::vector<uint8_t>& bytes);
// Takes the part off the front of `rest`; it must hold exactly out.size() bytes.
[[nodiscard]] Status read_part(std::span<const uint8_t>& rest, std::span<uint8_t> out);

// Written beside the old file, then put in its place: whatever happens, one of both is there whole.
[[nodiscard]] Status replace_file(const std::filesystem::path& file, std::span<const uint8_t> bytes);
[[nodiscard]] Result<std::vector<uint8_t>> read_file(const std::filesystem::path& file);

}  // namespace loam
