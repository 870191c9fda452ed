// Little-endian bytes out and in. The reader never leaves its span: past the end it gives zeros and is no
// longer ok().
#pragma once

#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace loam {

class ByteWriter {
  public:
    void u8(uint8_t value) { bytes_.push_back(value); }
    void u32(uint32_t value) {
        for (int i = 0; i < 4; ++i) bytes_.push_back(uint8_t(value >> (8 * i)));
    }
    void u64(uint64_t value) {
        for (int i = 0; i < 8; ++i) bytes_.push_back(uint8_t(value >> (8 * i)));
    }
    void real(double value) { u64(std::bit_cast<uint64_t>(value)); }
    void bytes(std::span<const uint8_t> more) { bytes_.insert(bytes_.end(), more.begin(), more.end()); }
    [[nodiscard]] std::vector<uint8_t> take() { return std::move(bytes_); }

  private:
    std::vector<uint8_t> bytes_;
};

class ByteReader {
  public:
    explicit ByteReader(std::span<const uint8_t> bytes) : rest_(bytes) {}

    uint8_t u8() { return uint8_t(number(1)); }
    uint32_t u32() { return uint32_t(number(4)); }
    uint64_t u64() { return number(8); }
    double real() { return std::bit_cast<double>(number(8)); }
    std::span<const uint8_t> bytes(size_t count) {
        ok_ = ok_ && count <= rest_.size();
        if (!ok_) return {};
        const auto result = rest_.first(count);
        rest_ = rest_.subspan(count);
        return result;
    }
    [[nodiscard]] bool ok() const { return ok_; }
    [[nodiscard]] bool at_end() const { return ok_ && rest_.empty(); }

  private:
    uint64_t number(size_t count) {
        uint64_t value = 0;
        int shift = 0;
        for (const uint8_t byte : bytes(count)) {
            value |= uint64_t(byte) << shift;
            shift += 8;
        }
        return value;
    }
    std::span<const uint8_t> rest_;
    bool ok_ = true;
};

}  // namespace loam
