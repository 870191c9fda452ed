// Quality of the page encoder: pages of the project through it, against the same pages uncompressed, beside
// the encoders that are installed: libsquish (range fit, cluster fit) and stb_dxt in its high quality.
#include <array>
#include <cmath>
#include <cstring>

#include "editor/bench/stage.h"
#include "runtime/texture/composer.h"
#include "shaders/texture/bc1.h"

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

constexpr int kAtlasPages = 4;  // a side
constexpr int kAtlasTexels = kAtlasPages * kPageTexels;
using Texels = std::vector<uint8_t>;  // RGBA8 of an atlas
using Blocks = std::vector<glm::uvec2>;

struct Encoder {
    const char* name;
    std::function<glm::uvec2(const uint8_t* rgba)> encode;
};

// Pages of several sizes over the map: texels of 26 cm, 3 cm and 4 mm.
Result<std::vector<ComposeJob>> pages_of(Stage& stage, const TextureLayout& layout) {
    std::vector<ComposeJob> jobs;
    const int width = 1 << layout.default_log2_width;
    const WorldRect bounds = stage.document.bounds();
    for (int i = 0; i < kAtlasPages * kAtlasPages; ++i) {
        ComposeJob job;
        const double share_x = (i % kAtlasPages + 0.5) / kAtlasPages,
                     share_y = (i / kAtlasPages + 0.5) / kAtlasPages;
        const glm::dvec2 at = glm::dvec2(bounds.width() * share_x, bounds.height() * share_y) / 64.0;
        const int depth = i % 4 == 1 ? 3 : 6;
        job.page = i % 4 < 1 || i % 4 == 3
                       ? PageId{{},
                                layout.default_log2_width,
                                std::min(int(at.x), width - 1),
                                std::min(int(at.y), width - 1)}
                       : PageId{{true, int(at.x), int(at.y)}, depth, (1 << depth) / 2, (1 << depth) / 2};
        job.rect = {0, 0, kPageTexels, kPageTexels};
        job.target = {i % kAtlasPages, i / kAtlasPages};
        const WorldRect square = layout.square(job.page);
        job.index_page =
            stage.index->page_for_square(square.min_x, square.min_y, layout.page_side_m(job.page));
        if (!stage.index->map().exists(job.index_page)) continue;
        LOAM_TRY(stage.make_resident(job.index_page));
        jobs.push_back(job);
    }
    for (ComposeJob& job : jobs) {
        LOAM_TRY(stage.make_resident(job.index_page));
        job.index_slot = stage.index->map().slot_of(job.index_page);
    }
    return jobs;
}

Result<std::array<Texels, 3>> composed(Stage& stage, const TextureLayout& layout, PageFormat format,
                                       const std::vector<ComposeJob>& jobs) {
    auto atlas = make_page_atlas(stage.device, page_textures(format), kAtlasPages, kAtlasPages);
    if (!atlas) return atlas.error();
    auto composer = Composer::create(stage.device, stage.document, *stage.index, *stage.layers, layout,
                                     page_textures(format), true);
    if (!composer) return composer.error();
    std::array<Texels, 3> bytes;
    auto ms = stage.timed_frame([&](gpu::Commands& commands) -> Status {
        LOAM_TRY((*composer)->cmd_compose(*stage.ring, commands, jobs, *atlas));
        for (size_t which = 0; which < 3; ++which)
            stage.ring->read_back(commands, (*atlas)[which], [&bytes, which](std::span<const std::byte> got) {
                bytes[which].resize(got.size());
                std::memcpy(bytes[which].data(), got.data(), got.size());
            });
        return {};
    });
    if (!ms) return ms.error();
    return bytes;
}

// Other encoders also use the mode of three colours and black.
glm::vec3 decoded(glm::uvec2 block, int i) {
    const uint32_t c0 = block.x & 0xffffu, c1 = block.x >> 16u, index = block.y >> uint32_t(i * 2) & 3u;
    if (c0 > c1 || index < 2) return shared::bc1_decode(block, i);
    return index == 2 ? (shared::bc1_unpack565(c0) + shared::bc1_unpack565(c1)) * 0.5f : glm::vec3(0);
}

// Mean of the channels' squared errors, weighted, as PSNR, over the pages composed.
double psnr_db_of(const Texels& texels, const Blocks& blocks, const std::vector<ComposeJob>& jobs,
                  glm::vec3 weights) {
    constexpr int kBlocks = kAtlasTexels / 4, kPageBlocks = kPageTexels / 4;
    double sum = 0;
    for (const ComposeJob& job : jobs)
        for (int y = 0; y < kPageBlocks; ++y)
            for (int x = 0; x < kPageBlocks; ++x) {
                const int bx = job.target.x * kPageBlocks + x, by = job.target.y * kPageBlocks + y;
                for (int i = 0; i < 16; ++i) {
                    const glm::vec3 got = decoded(blocks[size_t(by * kBlocks + bx)], i) * 255.0f;
                    const size_t at = (size_t(by * 4 + i / 4) * kAtlasTexels + size_t(bx * 4 + i % 4)) * 4;
                    const glm::vec3 d = got - glm::vec3(texels[at], texels[at + 1], texels[at + 2]);
                    sum += double(glm::dot(d * d, weights));
                }
            }
    const double mean =
        sum / (double(jobs.size()) * kPageTexels * kPageTexels * double(weights.x + weights.y + weights.z));
    return 10 * std::log10(255.0 * 255.0 / std::max(mean, 1e-9));
}

Blocks encode_all(const Texels& texels, const Encoder& encoder) {
    constexpr int kBlocks = kAtlasTexels / 4;
    Blocks blocks(size_t(kBlocks) * kBlocks);
    uint8_t block[64];
    for (int by = 0; by < kBlocks; ++by)
        for (int bx = 0; bx < kBlocks; ++bx) {
            for (int y = 0; y < 4; ++y)
                std::memcpy(block + 16 * y, &texels[(size_t(by * 4 + y) * kAtlasTexels + size_t(bx * 4)) * 4],
                            16);
            blocks[size_t(by * kBlocks + bx)] = encoder.encode(block);
        }
    return blocks;
}

std::vector<Encoder> encoders_for([[maybe_unused]] glm::vec3 weights) {
    std::vector<Encoder> list;
#ifdef LOAM_HAVE_STB_DXT
    list.push_back({"stb_dxt, high quality", [](const uint8_t* rgba) {
                        glm::uvec2 block;
                        stb_compress_dxt_block(reinterpret_cast<unsigned char*>(&block), rgba, 0,
                                               STB_DXT_HIGHQUAL);
                        return block;
                    }});
#endif
#ifdef LOAM_HAVE_SQUISH
    for (const bool cluster : {false, true})
        list.push_back({cluster ? "libsquish, cluster fit" : "libsquish, range fit",
                        [cluster, weights](const uint8_t* rgba) {
                            glm::uvec2 block;
                            float metric[3] = {weights.x, weights.y, weights.z};
                            squish::Compress(rgba, &block,
                                             squish::kDxt1 | (cluster ? squish::kColourClusterFit
                                                                      : squish::kColourRangeFit),
                                             metric);
                            return block;
                        }});
#endif
    return list;
}

}  // namespace

Result<BenchReport> bench_encoders(const BenchRequest& request) {
    auto document = Document::open(request.project, OpenMode::read_only);
    if (!document) return document.error();
    auto device = gpu::Device::create(request.session.device);
    if (!device) return device.error();
    if (!(*device)->caps().bc) return error("the device {} has no block compression", (*device)->caps().name);
    auto stage = Stage::create(**device, **document);
    if (!stage) return stage.error();
    const TextureLayout layout = texture_layout((*document)->bounds());
    auto jobs = pages_of(*stage, layout);
    if (!jobs) return jobs.error();
    auto plain = composed(*stage, layout, PageFormat::rgba8, *jobs);
    if (!plain) return plain.error();
    auto packed = composed(*stage, layout, PageFormat::bc1x3, *jobs);
    if (!packed) return packed.error();

    static constexpr const char* kTextures[3] = {"albedo dB", "gloss, normal x, occlusion dB",
                                                 "metalness, normal y dB"};
    std::vector<Json> rows{{{"encoder", "page encoder"}}};
    for (const Encoder& encoder : encoders_for({})) rows.push_back({{"encoder", encoder.name}});
    for (size_t which = 0; which < 3; ++which) {
        const glm::vec3 weights(Composer::kRowWeights[which]);
        Blocks blocks((*packed)[which].size() / 8);
        std::memcpy(blocks.data(), (*packed)[which].data(), (*packed)[which].size());
        rows[0][kTextures[which]] = rounded(psnr_db_of((*plain)[which], blocks, *jobs, weights), 2);
        const std::vector<Encoder> others = encoders_for(weights);
        for (size_t i = 0; i < others.size(); ++i)
            rows[i + 1][kTextures[which]] = rounded(
                psnr_db_of((*plain)[which], encode_all((*plain)[which], others[i]), *jobs, weights), 2);
    }
    return BenchReport{
        {fmt::format("BC1 of {} pages, PSNR with the encoder's channel weights", jobs->size()), rows}};
}

}  // namespace loam::bench
