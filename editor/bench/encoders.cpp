// Quality and speed of the block encoders beside those that are installed, a table a format: PSNR of the
// albedo of each page, of all of them together, and of the other textures with the weights that live pages
// use.
#include <cmath>

#include "editor/bench/encoder_pages.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/upload.h"
#include "runtime/texture/block_decoder.h"
#include "runtime/texture/composer.h"

namespace loam::bench {

namespace {

struct OwnEncoder {
    const char* name;
    BlockFormat format;
    int repeats;  // within a frame that is timed
};
constexpr OwnEncoder kOwn[] = {{"Loam, live", BlockFormat::bc1, 8}, {"Loam, fine", BlockFormat::bc1_fine, 1},
                               {"Loam", BlockFormat::bc3, 8},       {"Loam", BlockFormat::bc4, 8},
                               {"Loam", BlockFormat::astc4x4, 1},   {"Loam", BlockFormat::astc6x6, 1}};
constexpr const char* kTitles[] = {"BC1", "BC3: albedo, gloss as alpha", "BC4: gloss", "ASTC 4x4",
                                   "ASTC 6x6"};

size_t title_of(BlockFormat format) {
    switch (format) {
        case BlockFormat::bc1:
        case BlockFormat::bc1_fine:
            return 0;
        case BlockFormat::bc3:
            return 1;
        case BlockFormat::bc4:
            return 2;
        case BlockFormat::astc4x4:
            return 3;
        case BlockFormat::astc6x6:
            return 4;
    }
    return 0;
}

// Compresses pages on the device. A page's time is that of a frame that encodes it several times less one's
// that does so once, so that what a frame costs anyway falls out; the least of three.
class OnDevice {
  public:
    static Result<OnDevice> create(gpu::Device& device, const OwnEncoder& own) {
        OnDevice made(device, own);
        auto encoder = BlockEncoder::create(device, own.format);
        if (!encoder) return encoder.error();
        made.encoder_ = std::move(*encoder);
        auto ring = gpu::FrameRing::create(device, 2);
        if (!ring) return ring.error();
        made.ring_ = std::move(*ring);
        auto image = gpu::Image::create(device, {.name = "page",
                                                 .format = VK_FORMAT_R8G8B8A8_UNORM,
                                                 .width = kPageTexels,
                                                 .height = kPageTexels,
                                                 .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
        if (!image) return image.error();
        made.image_ = std::move(*image);
        auto buffer =
            gpu::Buffer::create(device, {.name = "blocks",
                                         .size_bytes = made.encoder_.bytes_of(glm::ivec2(kPageTexels)),
                                         .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
        if (!buffer) return buffer.error();
        made.buffer_ = std::move(*buffer);
        return made;
    }
    Result<PageResult> run(const Texels& page, glm::vec3 weights) {
        std::vector<uint8_t> blocks(encoder_.bytes_of(glm::ivec2(kPageTexels)));
        double least[2] = {1e30, 1e30};
        for (int repeat = 0; repeat < 3; ++repeat)
            for (const bool several : {false, true}) {
                auto ms = frame_ms(page, weights, several ? 1 + own_.repeats : 1, blocks);
                if (!ms) return ms.error();
                least[several] = std::min(least[several], *ms);
            }
        return PageResult{mean_square_errors(own_.format, blocks, page, glm::ivec2(kPageTexels)),
                          std::max(least[1] - least[0], 0.0) / own_.repeats};
    }

  private:
    OnDevice(gpu::Device&, const OwnEncoder& own) : own_(own) {}
    Result<double> frame_ms(const Texels& page, glm::vec3 weights, int times, std::vector<uint8_t>& blocks) {
        auto frame = ring_->begin();
        if (!frame) return frame.error();
        gpu::upload_to_image(*ring_, (*frame)->commands, image_, 0, 0, 0, 0, kPageTexels, kPageTexels,
                             std::as_bytes(std::span(page)));
        for (int i = 0; i < times; ++i)
            encoder_.cmd_encode((*frame)->commands, image_, glm::ivec2(kPageTexels), buffer_, weights);
        ring_->read_back((*frame)->commands, buffer_, 0, blocks.size(),
                         [&blocks](std::span<const std::byte> got) {
                             std::copy(got.begin(), got.end(), reinterpret_cast<std::byte*>(blocks.data()));
                         });
        const double start_ms = now_ms();
        LOAM_TRY(ring_->finish(**frame));
        return now_ms() - start_ms;
    }
    OwnEncoder own_;
    BlockEncoder encoder_;
    std::unique_ptr<gpu::FrameRing> ring_;
    gpu::Image image_;
    gpu::Buffer buffer_;
};

// The first texture as a format takes it: BC3 has the second texture's red as alpha, BC4 it alone.
Texels first_texture(const EncoderPage& page, BlockFormat format) {
    Texels texels = page.textures[0];
    const Texels& gloss = page.textures[1].empty() ? page.textures[0] : page.textures[1];
    for (size_t i = 0; i < texels.size(); i += 4) {
        if (format == BlockFormat::bc3) texels[i + 3] = gloss[i];
        if (format == BlockFormat::bc4) texels[i] = gloss[i];
    }
    return texels;
}

double weighted(glm::dvec4 mean_square, glm::vec3 weights, BlockFormat format) {
    if (format == BlockFormat::bc4) return mean_square.x;
    const glm::dvec4 w(weights, format == BlockFormat::bc3 ? 1 : 0);
    return glm::dot(mean_square, w) / (w.x + w.y + w.z + w.w);
}

Result<Json> row_of(const OtherEncoder& encoder, const std::vector<EncoderPage>& pages) {
    static constexpr const char* kOthers[3] = {"", "gloss, normal x, occlusion", "metalness, normal y"};
    Json row{{"encoder", encoder.name}};
    double sums[3] = {}, ms = 0;
    int runs = 0;
    const bool one_texture = pages[0].textures[1].empty() || encoder.format == BlockFormat::bc3 ||
                             encoder.format == BlockFormat::bc4;
    for (const EncoderPage& page : pages)
        for (size_t which = 0; which < (one_texture ? 1u : 3u); ++which) {
            const glm::vec3 weights = which == 0 ? glm::vec3(1) : glm::vec3(Composer::kRowWeights[which]);
            auto result =
                encoder.run(which == 0 ? first_texture(page, encoder.format) : page.textures[which], weights);
            if (!result) return result.error();
            const double error = weighted(result->mean_square, weights, encoder.format);
            sums[which] += error / double(pages.size());
            if (which == 0) row[page.name] = rounded(decibels(error), 2);
            ms += result->ms;
            ++runs;
        }
    row["all"] = rounded(decibels(sums[0]), 2);
    for (size_t which = 1; which < 3 && !one_texture; ++which)
        row[kOthers[which]] = rounded(decibels(sums[which]), 2);
    ms /= runs;
    const double side = shape_of(encoder.format).side_texels,
                 blocks = std::pow(std::ceil(kPageTexels / side), 2);
    row["ms a page"] = rounded(ms, 2);
    row["blocks a second"] = ms > 0 ? Json(std::round(blocks / ms * 1000)) : Json();
    return row;
}

Result<BenchReport> tables_of(gpu::Device& device, const std::vector<EncoderPage>& pages,
                              const std::string& of, bool quick) {
    BenchReport report;
    for (const char* title : kTitles) report.push_back({fmt::format("{}, {}", title, of), {}});
    for (const OwnEncoder& own : kOwn) {
        auto on_device = OnDevice::create(device, own);
        if (!on_device) return on_device.error();
        const OtherEncoder encoder{own.name, own.format, [&](const Texels& page, glm::vec3 weights) {
                                       return on_device->run(page, weights);
                                   }};
        auto row = row_of(encoder, pages);
        if (!row) return row.error();
        report[title_of(own.format)].rows.push_back(*row);
    }
    for (const OtherEncoder& encoder : other_encoders()) {
        if (quick && encoder.name.find("cluster") != std::string::npos) continue;
        auto row = row_of(encoder, pages);
        if (!row) return row.error();
        report[title_of(encoder.format)].rows.push_back(*row);
    }
    return report;
}

}  // namespace

Result<BenchReport> bench_encoders(const BenchRequest& request) {
    auto device = gpu::Device::create(request.session.device);
    if (!device) return device.error();
    auto pages = composed_pages(**device, request.project);
    if (!pages) return pages.error();
    if (request.quick) pages->erase(pages->begin() + 1, pages->end() - 1);
    auto report = tables_of(**device, *pages, "PSNR of composed pages in dB", request.quick);
    if (!report || request.images.empty()) return report;
    auto photographs = photograph_pages(request.images);
    if (!photographs) return photographs.error();
    auto more = tables_of(**device, *photographs, "PSNR of photographs in dB", request.quick);
    if (!more) return more.error();
    report->insert(report->end(), more->begin(), more->end());
    return report;
}

}  // namespace loam::bench
