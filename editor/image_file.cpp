#include "editor/image_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>
#include <memory>
#include <optional>
#include <type_traits>

#include <OpenImageIO/imageio.h>

namespace loam {

namespace {

// OpenImageIO's messages span lines and end with stops; ours are one sentence.
std::string one_line(std::string text) {
    for (char& c : text)
        if (c == '\n' || c == '\r') c = ' ';
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text.empty() ? "no reason given" : text;
}

bool looks_like_text(std::span<const unsigned char> head) {
    return std::all_of(head.begin(), head.end(), [](unsigned char c) {
        return c >= 32 || c == '\n' || c == '\r' || c == '\t' || c == '\f';
    });
}

Status check_readable(const std::filesystem::path& file) {
    std::error_code code;
    if (!std::filesystem::exists(file, code)) return error("{} does not exist", file.string());
    if (std::filesystem::is_directory(file, code))
        return error("{} is a folder, expected a picture", file.string());
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return error("{} cannot be read: no permission", file.string());
    std::array<unsigned char, 512> head{};
    stream.read(reinterpret_cast<char*>(head.data()), head.size());
    const auto length = static_cast<size_t>(stream.gcount());
    if (length == 0) return error("{} is empty", file.string());
    if (looks_like_text({head.data(), length}))
        return error("{} is a text file, expected a PNG, TIFF or EXR picture", file.string());
    return {};
}

// A PNG is a signature and chunks: length, name, data, checksum, up to IEND. Walking them finds a file that
// is cut short, or has no pixels, before libpng does, which would print a line of its own.
Status check_png_chunks(const std::filesystem::path& file) {
    constexpr std::array<unsigned char, 8> kSignature = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    std::ifstream stream(file, std::ios::binary);
    std::array<unsigned char, 8> head{};
    stream.read(reinterpret_cast<char*>(head.data()), head.size());
    if (!stream || head != kSignature) return {};
    std::error_code code;
    const uint64_t size = std::filesystem::file_size(file, code);
    for (uint64_t at = head.size(); at + 12 <= size;) {
        stream.seekg(static_cast<std::streamoff>(at));
        stream.read(reinterpret_cast<char*>(head.data()), head.size());
        const uint64_t length =
            uint64_t{head[0]} << 24 | uint64_t{head[1]} << 16 | uint64_t{head[2]} << 8 | head[3];
        if (!stream || at + 12 + length > size) break;
        if (std::equal(head.begin() + 4, head.end(), "IEND")) return {};
        if (std::equal(head.begin() + 4, head.end(), "IHDR")) {  // width and height come first
            stream.read(reinterpret_cast<char*>(head.data()), head.size());
            const auto is_zero = [](unsigned char c) { return c == 0; };
            if (std::all_of(head.begin(), head.begin() + 4, is_zero) ||
                std::all_of(head.begin() + 4, head.end(), is_zero))
                return error("{} is damaged: it says that it has no pixels", file.string());
        }
        at += 12 + length;
    }
    return error("{} is cut short: its {} bytes end before the end of the picture", file.string(), size);
}

// A JPEG is marker segments, then compressed rows whose only markers are restarts, up to the end marker.
// libjpeg fills the rows that are missing with grey and says nothing that reaches us.
Status check_jpeg_end(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    const auto at = [&](size_t i) { return static_cast<unsigned char>(bytes[i]); };
    if (bytes.size() < 3 || at(0) != 0xff || at(1) != 0xd8 || at(2) != 0xff) return {};
    size_t i = 2;
    while (i + 1 < bytes.size()) {
        if (at(i) != 0xff || at(i + 1) == 0 || at(i + 1) == 0xff ||
            (at(i + 1) >= 0xd0 && at(i + 1) <= 0xd7)) {
            ++i;  // compressed data, fill bytes, restarts
            continue;
        }
        if (at(i + 1) == 0xd9) return {};
        if (i + 3 >= bytes.size()) break;
        i += 2 + (size_t{at(i + 2)} << 8 | at(i + 3));
    }
    return error("{} is cut short: its {} bytes end before the end of the picture", file.string(),
                 bytes.size());
}

// Keeps the first channels of `count` pixels as floats.
template <typename T>
void keep_pixels(const T* pixels, size_t count, size_t channels, float* target, SampleImage& out) {
    const auto kept = static_cast<size_t>(out.kept_channel_count);
    const size_t color_channels = channels < 3 ? 1 : 3;  // 2: grey and alpha, 4: RGBA
    for (size_t i = 0; i < count; ++i) {
        const T* pixel = pixels + i * channels;
        for (size_t c = 0; c < kept; ++c) target[i * kept + c] = static_cast<float>(pixel[c]);
        for (size_t c = 1; c < color_channels; ++c)
            out.channels_differ = out.channels_differ || pixel[c] != pixel[0];
    }
}

// Reads all channels in the file's own type.
template <typename T>
bool read_rows(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, SampleImage& out) {
    const auto channels = static_cast<size_t>(spec.nchannels);
    const auto width = static_cast<size_t>(spec.width);
    constexpr int kRows = 64;
    std::vector<T> rows(width * channels * kRows);
    for (int y = 0; y < spec.height; y += kRows) {
        const int end = std::min(spec.height, y + kRows);
        if (!input.read_scanlines(0, 0, spec.y + y, spec.y + end, spec.z, 0, spec.nchannels, type,
                                  rows.data()))
            return false;
        const size_t from = static_cast<size_t>(y) * width * static_cast<size_t>(out.kept_channel_count);
        keep_pixels(rows.data(), width * static_cast<size_t>(end - y), channels, out.samples.data() + from,
                    out);
    }
    return true;
}

template <typename T>
bool read_tiled(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, SampleImage& out) {
    const auto channels = static_cast<size_t>(spec.nchannels);
    const size_t pixels = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
    std::vector<T> all(pixels * channels);
    if (!input.read_image(0, 0, 0, spec.nchannels, type, all.data())) return false;
    keep_pixels(all.data(), pixels, channels, out.samples.data(), out);
    return true;
}

template <typename T>
bool read_as(OIIO::ImageInput& input, const OIIO::ImageSpec& spec, OIIO::TypeDesc type, SampleImage& out) {
    return spec.tile_width > 0 ? read_tiled<T>(input, spec, type, out) : read_rows<T>(input, spec, type, out);
}

// OpenImageIO turns inks into red, green and blue by arithmetic that no printer knows.
bool is_inks(const OIIO::ImageSpec& spec) {
    for (const char* name : {"jpeg:ColorSpace", "tiff:ColorSpace", "oiio:ColorSpace"}) {
        const std::string space = spec.get_string_attribute(name);
        if (space == "CMYK" || space == "YCbCrK" || space == "YCCK" || space == "color separated")
            return true;
    }
    return false;
}

// A flat picture of numbers that are kept as they are.
Result<std::unique_ptr<OIIO::ImageInput>> open_with_oiio(const std::filesystem::path& file) {
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);  // leave the samples alone
    auto input = OIIO::ImageInput::open(file.string(), &hints);
    if (!input)
        return error("{} is not a picture that can be read: {}", file.string(), one_line(OIIO::geterror()));
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        return error("{} has {}x{}x{} pixels of {} channels, expected a flat picture", file.string(),
                     spec.width, spec.height, spec.depth, spec.nchannels);
    if (is_inks(spec))
        return error("{} is made of inks (CMYK), expected grey or red, green and blue: convert it first",
                     file.string());
    return input;
}

std::optional<SampleKind> kind_of(const OIIO::ImageSpec& spec) {
    switch (spec.format.basetype) {
        case OIIO::TypeDesc::UINT8:
            return SampleKind::unsigned_8;
        case OIIO::TypeDesc::UINT16:
            return SampleKind::unsigned_16;
        case OIIO::TypeDesc::INT16:
            return SampleKind::signed_16;
        case OIIO::TypeDesc::HALF:
        case OIIO::TypeDesc::FLOAT:
        case OIIO::TypeDesc::DOUBLE:
            return SampleKind::floating;
        default:
            return {};
    }
}

Error unknown_samples(const std::filesystem::path& file, const OIIO::ImageSpec& spec) {
    return error("{} has samples of type {}, expected 8 or 16-bit integers or floats", file.string(),
                 spec.format.c_str());
}

Result<SampleImage> read_with_oiio(const std::filesystem::path& file, int max_side, KeptChannels keep) {
    auto opened = open_with_oiio(file);
    if (!opened.ok()) return opened.error();
    auto& input = *opened;
    const OIIO::ImageSpec spec = input->spec();
    if (spec.width > max_side || spec.height > max_side)
        return error("{} is too large: {}x{} samples, at most {} a side", file.string(), spec.width,
                     spec.height, max_side);
    const auto kind = kind_of(spec);
    if (!kind) return unknown_samples(file, spec);

    SampleImage out;
    out.width = spec.width;
    out.height = spec.height;
    out.channel_count = spec.nchannels;
    out.format = input->format_name();
    out.color_space = spec.get_string_attribute("oiio:ColorSpace");
    if (keep == KeptChannels::up_to_four) out.kept_channel_count = std::min(4, spec.nchannels);
    out.samples.resize(static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height) *
                       static_cast<size_t>(out.kept_channel_count));
    out.kind = *kind;
    out.was_double = spec.format.basetype == OIIO::TypeDesc::DOUBLE;
    bool ok = false;
    switch (out.kind) {
        case SampleKind::unsigned_8:
            ok = read_as<uint8_t>(*input, spec, OIIO::TypeDesc::UINT8, out);
            break;
        case SampleKind::unsigned_16:
            ok = read_as<uint16_t>(*input, spec, OIIO::TypeDesc::UINT16, out);
            break;
        case SampleKind::signed_16:
            ok = read_as<int16_t>(*input, spec, OIIO::TypeDesc::INT16, out);
            break;
        case SampleKind::floating:
            ok = read_as<float>(*input, spec, OIIO::TypeDesc::FLOAT, out);
            break;
    }
    const std::string reason = input->geterror();
    if (!ok || !reason.empty())
        return error("{} is damaged or cut short: {}", file.string(), one_line(reason));
    return out;
}

Result<RgbaImage> read_rgba8_with_oiio(const std::filesystem::path& file, int max_side) {
    OIIO::ImageSpec hints;
    hints.attribute("oiio:UnassociatedAlpha", 1);
    auto input = OIIO::ImageInput::open(file.string(), &hints);
    if (!input)
        return error("{} is not a picture that can be read: {}", file.string(), one_line(OIIO::geterror()));
    const OIIO::ImageSpec spec = input->spec();
    if (spec.width < 1 || spec.height < 1 || spec.depth > 1 || spec.nchannels < 1)
        return error("{} has no pixels", file.string());
    if (spec.width > max_side || spec.height > max_side)
        return error("{} has {} x {} pixels, at most {} a side are possible", file.string(), spec.width,
                     spec.height, max_side);
    const auto count = static_cast<size_t>(spec.width) * static_cast<size_t>(spec.height);
    const int channels = std::min(spec.nchannels, 4);
    std::vector<uint8_t> in(count * static_cast<size_t>(channels));
    if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::UINT8, in.data()))
        return error("{} is damaged or cut short: {}", file.string(), one_line(input->geterror()));
    RgbaImage image{spec.width, spec.height, std::vector<uint8_t>(count * 4)};
    for (size_t i = 0; i < count; ++i) {
        const uint8_t* from = &in[i * static_cast<size_t>(channels)];
        uint8_t* to = &image.rgba[i * 4];
        for (int c = 0; c < 3; ++c) to[c] = from[channels < 3 ? 0 : c];
        to[3] = channels == 2 ? from[1] : channels == 4 ? from[3] : uint8_t{255};
    }
    return image;
}

Status write_with_oiio(const std::filesystem::path& file, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                       const void* data) {
    auto output = OIIO::ImageOutput::create(file.string());
    if (!output) return error("cannot write {}: {}", file.string(), one_line(OIIO::geterror()));
    if (!output->open(file.string(), spec) || !output->write_image(type, data) || !output->close())
        return error("cannot write {}: {}", file.string(), one_line(output->geterror()));
    return {};
}

Status write_caught(const std::filesystem::path& file, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                    const void* data) {
    try {
        return write_with_oiio(file, spec, type, data);
    } catch (const std::exception& exception) {
        return error("cannot write {}: {}", file.string(), one_line(exception.what()));
    }
}

}  // namespace

float white_of(SampleKind kind) {
    switch (kind) {
        case SampleKind::unsigned_8:
            return 255;
        case SampleKind::unsigned_16:
            return 65535;
        case SampleKind::signed_16:
            return 32767;
        case SampleKind::floating:
            break;
    }
    return 1;
}

Result<SampleImage> read_samples(const std::filesystem::path& file, int max_side, KeptChannels keep) {
    LOAM_TRY(check_readable(file));
    LOAM_TRY(check_png_chunks(file));
    LOAM_TRY(check_jpeg_end(file));
    try {
        return read_with_oiio(file, max_side, keep);
    } catch (const std::exception& exception) {
        return error("{} cannot be read: {}", file.string(), one_line(exception.what()));
    }
}

struct ImageRows::Impl {
    std::filesystem::path file;
    std::unique_ptr<OIIO::ImageInput> input;
    OIIO::ImageSpec spec;
    SampleKind kind{};
    std::string color_space;
    int next = 0, held_from = 0, held_to = 0;  // rows from the top
    std::vector<float> held;
    std::vector<uint16_t> integers;
    std::vector<int16_t> signed_integers;

    // OpenImageIO would scale integers to 0 … 1.
    template <typename T>
    bool read_block(OIIO::TypeDesc type, std::vector<T>& block) {
        block.resize(held.size());
        const bool ok =
            spec.tile_width > 0
                ? input->read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + held_from, spec.y + held_to,
                                    spec.z, spec.z + 1, 0, spec.nchannels, type, block.data())
                : input->read_scanlines(0, 0, spec.y + held_from, spec.y + held_to, spec.z, 0, spec.nchannels,
                                        type, block.data());
        if constexpr (!std::is_same_v<T, float>) std::copy(block.begin(), block.end(), held.begin());
        return ok;
    }
    Status load_block() {
        const int rows = spec.tile_width > 0 ? std::max(spec.tile_height, 1) : 16;
        held_from = next;
        held_to = std::min(spec.height, held_from + rows);
        held.resize(size_t(spec.width) * size_t(held_to - held_from) * size_t(spec.nchannels));
        bool ok = false;
        switch (kind) {
            case SampleKind::unsigned_8: {
                std::vector<uint8_t> bytes;
                ok = read_block(OIIO::TypeDesc::UINT8, bytes);
                break;
            }
            case SampleKind::unsigned_16:
                ok = read_block(OIIO::TypeDesc::UINT16, integers);
                break;
            case SampleKind::signed_16:
                ok = read_block(OIIO::TypeDesc::INT16, signed_integers);
                break;
            case SampleKind::floating:
                ok = read_block(OIIO::TypeDesc::FLOAT, held);
                break;
        }
        const std::string reason = input->geterror();
        if (!ok || !reason.empty())
            return error("{} is damaged or cut short: {}", file.string(), one_line(reason));
        return {};
    }
};

ImageRows::ImageRows() : impl_(std::make_unique<Impl>()) {}
ImageRows::~ImageRows() = default;

Result<std::unique_ptr<ImageRows>> ImageRows::open(const std::filesystem::path& file) {
    LOAM_TRY(check_readable(file));
    LOAM_TRY(check_png_chunks(file));
    LOAM_TRY(check_jpeg_end(file));
    try {
        auto input = open_with_oiio(file);
        if (!input.ok()) return input.error();
        std::unique_ptr<ImageRows> rows(new ImageRows);
        Impl& r = *rows->impl_;
        r.file = file;
        r.input = std::move(*input);
        r.spec = r.input->spec();
        const auto kind = kind_of(r.spec);
        if (!kind) return unknown_samples(file, r.spec);
        r.kind = *kind;
        r.color_space = r.spec.get_string_attribute("oiio:ColorSpace");
        return rows;
    } catch (const std::exception& exception) {
        return error("{} cannot be read: {}", file.string(), one_line(exception.what()));
    }
}

int ImageRows::width() const {
    return impl_->spec.width;
}
int ImageRows::height() const {
    return impl_->spec.height;
}
int ImageRows::channel_count() const {
    return impl_->spec.nchannels;
}
int ImageRows::alpha_channel() const {
    return impl_->spec.alpha_channel;
}
SampleKind ImageRows::kind() const {
    return impl_->kind;
}
const std::string& ImageRows::color_space() const {
    return impl_->color_space;
}

Result<std::span<const float>> ImageRows::next() {
    Impl& r = *impl_;
    if (r.next >= r.held_to) {
        try {
            LOAM_TRY(r.load_block());
        } catch (const std::exception& exception) {
            return error("{} cannot be read: {}", r.file.string(), one_line(exception.what()));
        }
    }
    const size_t row = size_t(r.spec.width) * size_t(r.spec.nchannels);
    return std::span<const float>(r.held).subspan(size_t(r.next++ - r.held_from) * row, row);
}

Result<RgbaImage> read_rgba8(const std::filesystem::path& file, int max_side) {
    LOAM_TRY(check_readable(file));
    LOAM_TRY(check_png_chunks(file));
    LOAM_TRY(check_jpeg_end(file));
    try {
        return read_rgba8_with_oiio(file, max_side);
    } catch (const std::exception& exception) {
        return error("{} cannot be read: {}", file.string(), one_line(exception.what()));
    }
}

Status write_samples_u16(const std::filesystem::path& file, int width, int height,
                         std::span<const uint16_t> samples) {
    return write_caught(file, OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::UINT16),
                        OIIO::TypeDesc::UINT16, samples.data());
}

Status write_samples_float(const std::filesystem::path& file, int width, int height,
                           std::span<const float> samples) {
    return write_caught(file, OIIO::ImageSpec(width, height, 1, OIIO::TypeDesc::FLOAT), OIIO::TypeDesc::FLOAT,
                        samples.data());
}

Status write_rgba8_png(const std::filesystem::path& file, int width, int height,
                       std::span<const uint8_t> rgba) {
    OIIO::ImageSpec spec(width, height, 4, OIIO::TypeDesc::UINT8);
    spec.attribute("oiio:ColorSpace", "sRGB");
    spec.attribute("oiio:UnassociatedAlpha", 1);
    return write_caught(file, spec, OIIO::TypeDesc::UINT8, rgba.data());
}

}  // namespace loam
