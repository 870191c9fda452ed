// Pictures in and out of files. The only place that knows OpenImageIO; its exceptions and messages end here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

enum class SampleKind { unsigned_8, unsigned_16, signed_16, floating };

// The value that is white, or whole.
[[nodiscard]] float white_of(SampleKind kind);

// What is kept of a picture: heights are its first channel, materials need all of them.
enum class KeptChannels { first, up_to_four };

// Samples of a picture as they lie in the file: row 0 is the top (north), integers keep their values.
struct SampleImage {
    int width = 0, height = 0;
    int channel_count = 1;       // of the file
    int kept_channel_count = 1;  // of `samples`, interleaved
    bool channels_differ =
        false;  // some pixel's red, green and blue are not equal (an alpha channel is not counted)
    SampleKind kind = SampleKind::unsigned_16;
    bool was_double = false;  // 64-bit floats, read as 32-bit ones
    std::string format;       // "png", "tiff", "openexr", …
    std::string color_space;  // as the file states it ("sRGB", "Linear", …), may be empty
    std::vector<float> samples;
};

// Refuses a missing file, text, an unknown format, a file that is cut short, inks (CMYK), more than
// `max_side` pixels a side.
[[nodiscard]] Result<SampleImage> read_samples(const std::filesystem::path& file, int max_side,
                                               KeptChannels keep = KeptChannels::first);

// A picture's rows from the top (north), a few of them in memory at a time, so that pictures may have any
// size.
class ImageRows {
  public:
    // Refuses what read_samples refuses, but for the size.
    [[nodiscard]] static Result<std::unique_ptr<ImageRows>> open(const std::filesystem::path& file);
    ~ImageRows();
    [[nodiscard]] int width() const;
    [[nodiscard]] int height() const;
    [[nodiscard]] int channel_count() const;  // of the file and of a row, interleaved
    [[nodiscard]] int alpha_channel() const;  // -1: none
    [[nodiscard]] SampleKind kind() const;
    [[nodiscard]] const std::string& color_space() const;
    // The next row, integers with their values; valid until the next call.
    [[nodiscard]] Result<std::span<const float>> next();

  private:
    ImageRows();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

// Eight bits a channel as in the file, no colour conversion; grey is repeated, missing alpha is 255.
struct RgbaImage {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;
};
[[nodiscard]] Result<RgbaImage> read_rgba8(const std::filesystem::path& file, int max_side);

// Row 0 is the top. The format follows from the file's extension (png, tif, tiff, exr).
[[nodiscard]] Status write_samples_u16(const std::filesystem::path& file, int width, int height,
                                       std::span<const uint16_t> samples);
[[nodiscard]] Status write_samples_float(const std::filesystem::path& file, int width, int height,
                                         std::span<const float> samples);
[[nodiscard]] Status write_rgba8_png(const std::filesystem::path& file, int width, int height,
                                     std::span<const uint8_t> rgba);

}  // namespace loam
