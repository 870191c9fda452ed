// Files of the project that hold arrays: a head, then parts, each a length and a zstd frame with checksum, so
// that a cut or changed byte is found.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

// Little endian.
void append_u32(uint32_t value, std::vector<uint8_t>& bytes);
[[nodiscard]] uint32_t read_u32(const uint8_t* bytes);

void append_part(std::span<const uint8_t> part, std::vector<uint8_t>& bytes);

// A file read from front to back. Its sentences leave out its name, which the caller knows.
class PartReader {
  public:
    [[nodiscard]] static Result<PartReader> open(const std::filesystem::path& file);
    [[nodiscard]] Status read(std::span<uint8_t> out);
    // The next part; it must hold exactly out.size() bytes.
    [[nodiscard]] Status read_part(std::span<uint8_t> out);
    [[nodiscard]] Status skip_part();  // without reading what is in it
    [[nodiscard]] uint64_t rest_bytes() const { return rest_; }

  private:
    Result<uint32_t> part_length();
    std::ifstream stream_;
    uint64_t rest_ = 0;
};

// A file written beside the old one, then put in its place: whatever happens, one of both is there whole.
class ReplacedFile {
  public:
    [[nodiscard]] static Result<ReplacedFile> create(const std::filesystem::path& file);
    ReplacedFile(ReplacedFile&& other) noexcept;
    ReplacedFile& operator=(ReplacedFile&&) = delete;
    ~ReplacedFile();  // without `commit` nothing is left of it

    [[nodiscard]] Status append(std::span<const uint8_t> bytes);
    [[nodiscard]] uint64_t size_bytes() const { return size_bytes_; }
    // On the disk when it returns.
    [[nodiscard]] Status commit();

  private:
    ReplacedFile(std::filesystem::path file, int descriptor);
    std::filesystem::path file_, temporary_;
    int descriptor_ = -1;
    uint64_t size_bytes_ = 0;
};
[[nodiscard]] Status replace_file(const std::filesystem::path& file, std::span<const uint8_t> bytes);

}  // namespace loam
