#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "editor/bench/encoder_pages.h"
#include "editor/image_file.h"
#include "runtime/texture/block_decoder.h"

#ifdef LOAM_HAVE_SQUISH
#include <squish.h>
#endif
#ifdef LOAM_HAVE_STB_DXT
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STB_DXT_STATIC
#define STB_DXT_IMPLEMENTATION
#include <stb/stb_dxt.h>
#pragma GCC diagnostic pop
#endif

namespace loam::bench {

namespace {

using EncodeBlock = std::function<void(const uint8_t* rgba, glm::vec3 weights, uint8_t* out)>;

[[maybe_unused]] OtherEncoder by_blocks(std::string name, BlockFormat format, EncodeBlock encode) {
    return {
        std::move(name), format,
        [format, encode](const Texels& page, glm::vec3 weights) -> Result<PageResult> {
            constexpr int kBlocks = kPageTexels / 4;
            const auto bytes = static_cast<size_t>(shape_of(format).bytes);
            std::vector<uint8_t> blocks(size_t{kBlocks} * kBlocks * bytes);
            const double start_ms = now_ms();
            std::array<uint8_t, 64> block;
            for (int by = 0; by < kBlocks; ++by)
                for (int bx = 0; bx < kBlocks; ++bx) {
                    for (int y = 0; y < 4; ++y)
                        std::memcpy(&block[static_cast<size_t>(16 * y)],
                                    &page[static_cast<size_t>((by * 4 + y) * kPageTexels + bx * 4) * 4], 16);
                    encode(block.data(), weights, &blocks[static_cast<size_t>(by * kBlocks + bx) * bytes]);
                }
            const double ms = now_ms() - start_ms;
            return PageResult{mean_square_errors(format, blocks, page, glm::ivec2(kPageTexels)), ms};
        }};
}

void add_stb([[maybe_unused]] std::vector<OtherEncoder>& list) {
#ifdef LOAM_HAVE_STB_DXT
    for (const bool high : {false, true})
        for (const BlockFormat format : {BlockFormat::bc1, BlockFormat::bc3})
            list.push_back(by_blocks(high ? "stb_dxt, high quality" : "stb_dxt", format,
                                     [high, format](const uint8_t* rgba, glm::vec3, uint8_t* out) {
                                         stb_compress_dxt_block(out, rgba, format == BlockFormat::bc3,
                                                                high ? STB_DXT_HIGHQUAL : STB_DXT_NORMAL);
                                     }));
    list.push_back(by_blocks("stb_dxt", BlockFormat::bc4, [](const uint8_t* rgba, glm::vec3, uint8_t* out) {
        uint8_t reds[16];
        for (int i = 0; i < 16; ++i) reds[i] = rgba[i * 4];
        stb_compress_bc4_block(out, reds);
    }));
#endif
}

void add_squish([[maybe_unused]] std::vector<OtherEncoder>& list) {
#ifdef LOAM_HAVE_SQUISH
    for (const bool cluster : {false, true})
        for (const BlockFormat format : {BlockFormat::bc1, BlockFormat::bc3, BlockFormat::bc4}) {
            if (format == BlockFormat::bc4 && cluster) continue;
            const int kind = format == BlockFormat::bc1   ? squish::kDxt1
                             : format == BlockFormat::bc3 ? squish::kDxt5
                                                          : squish::kBc4;
            const char* name = format == BlockFormat::bc4 ? "libsquish"
                               : cluster                  ? "libsquish, cluster fit"
                                                          : "libsquish, range fit";
            list.push_back(by_blocks(
                name, format, [cluster, kind](const uint8_t* rgba, glm::vec3 weights, uint8_t* out) {
                    float metric[3] = {weights.x, weights.y, weights.z};
                    squish::Compress(rgba, out,
                                     kind | (cluster ? squish::kColourClusterFit : squish::kColourRangeFit),
                                     metric);
                }));
        }
#endif
}

// What a command prints, or nothing where it fails.
std::optional<std::string> output_of(const std::string& command) {
    FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
    if (!pipe) return std::nullopt;
    std::string text;
    std::array<char, 512> part;
    while (const size_t got = std::fread(part.data(), 1, part.size(), pipe)) text.append(part.data(), got);
    return ::pclose(pipe) == 0 ? std::optional(text) : std::nullopt;
}

// Arm's encoder as a program: it decodes its own blocks, and prints how long coding took.
Result<PageResult> run_astcenc(const std::string& program, const char* shape, const char* effort,
                               const Texels& page) {
    std::string folder = (std::filesystem::temp_directory_path() / "loam-astcenc-XXXXXX").string();
    if (!::mkdtemp(folder.data())) return error("cannot create a temporary folder for astcenc");
    const std::filesystem::path in = std::filesystem::path(folder) / "in.png",
                                out = std::filesystem::path(folder) / "out.png";
    Status written = write_rgba8_png(in, kPageTexels, kPageTexels, page);
    std::optional<std::string> said;
    if (written.ok())
        said =
            output_of(program + " -tl '" + in.string() + "' '" + out.string() + "' " + shape + " -" + effort);
    auto image = read_rgba8(out, kPageTexels);
    std::error_code code;
    std::filesystem::remove_all(folder, code);
    LOAM_TRY(written);
    if (!said) return error("{} failed", program);
    if (!image) return image.error();
    PageResult result;
    for (size_t i = 0; i < page.size(); ++i) {
        const double d = double(image->rgba[i]) - double(page[i]);
        result.mean_square[static_cast<int>(i % 4)] += d * d / (double(kPageTexels) * kPageTexels);
    }
    const size_t at = said->find("Coding time:");
    if (at != std::string::npos)
        result.ms = std::atof(said->c_str() + at + std::strlen("Coding time:")) * 1000;
    return result;
}

void add_astcenc(std::vector<OtherEncoder>& list) {
    for (const char* program : {"astcenc", "astcenc-avx2", "astcenc-sse4.1", "astcenc-sse2"}) {
        if (!output_of(std::string(program) + " -version")) continue;
        for (const char* effort : {"fast", "medium"})
            for (const BlockFormat format : {BlockFormat::astc4x4, BlockFormat::astc6x6})
                list.push_back({std::string("astcenc -") + effort, format,
                                [program, effort, format](const Texels& page, glm::vec3) {
                                    return run_astcenc(program,
                                                       format == BlockFormat::astc4x4 ? "4x4" : "6x6", effort,
                                                       page);
                                }});
        return;
    }
}

}  // namespace

std::vector<OtherEncoder> other_encoders() {
    std::vector<OtherEncoder> list;
    add_stb(list);
    add_squish(list);
    add_astcenc(list);
    return list;
}

}  // namespace loam::bench
