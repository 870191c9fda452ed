// One alpha mask a layer, the baseline that the index map took the place of, through the same composer:
// memory, time and picture. Source: Call of Duty talk, "Layer Masks".
#include <algorithm>
#include <cmath>
#include <cstring>

#include "editor/bench/stage.h"

namespace loam::bench {

namespace {

constexpr double kMap_m = 512, kMosaic_m = 4;
constexpr PageId kPage{{true, 1, 1}, 3, 3, 4};  // 8 m
constexpr double kWhole_m = 16'384;
constexpr double kIndexMapBytes = 2.5;  // a texel: 16-bit index and BC1 tint

// Each layer's share of a square of vertices around each: 0 is the index map itself, more is a soft brush's
// overlap.
std::vector<std::vector<uint8_t>> masks_of(const IndexTexel* texels, int layers, int radius) {
    const auto at = [](int x, int y) {
        return static_cast<size_t>(std::clamp(y, 0, kIndexTexels - 1)) * kIndexTexels +
               static_cast<size_t>(std::clamp(x, 0, kIndexTexels - 1));
    };
    std::vector<std::vector<uint8_t>> masks(static_cast<size_t>(layers),
                                            std::vector<uint8_t>(size_t(kIndexTexels) * kIndexTexels));
    const int count = (2 * radius + 1) * (2 * radius + 1);
    std::vector<int> seen(static_cast<size_t>(layers));
    for (int y = 0; y < kIndexTexels; ++y)
        for (int x = 0; x < kIndexTexels; ++x) {
            std::fill(seen.begin(), seen.end(), 0);
            for (int j = -radius; j <= radius; ++j)
                for (int i = -radius; i <= radius; ++i)
                    ++seen[std::min<size_t>(texels[at(x + i, y + j)].layer, seen.size() - 1)];
            for (size_t k = 0; k < seen.size(); ++k)
                masks[k][at(x, y)] = static_cast<uint8_t>((255 * seen[k] + count / 2) / count);
        }
    return masks;
}

// Layers whose mask is not 0 at a texel of the page, on the average.
double lookups(const std::vector<std::vector<uint8_t>>& masks, const Stage& stage, const ComposeJob& job) {
    const WorldRect square = texture_layout(stage.document.bounds()).square(job.page);
    const WorldRect index_square = stage.index->map().page_rect(job.index_page);
    const double spacing_m = stage.index->map().spacing_m(job.index_page.level);
    const int x0 = int((square.min_x - index_square.min_x) / spacing_m) + kIndexBorder;
    const int y0 = int((square.min_y - index_square.min_y) / spacing_m) + kIndexBorder;
    const int side = int(square.width() / spacing_m);
    double sum = 0;
    for (int y = y0; y < y0 + side; ++y)
        for (int x = x0; x < x0 + side; ++x)
            for (const auto& mask : masks) {
                const size_t at = static_cast<size_t>(y) * kIndexTexels + static_cast<size_t>(x);
                sum += mask[at] + mask[at + 1] + mask[at + kIndexTexels] + mask[at + kIndexTexels + 1] > 0;
            }
    return sum / (side * side);
}

Result<LayerMasks> upload(Stage& stage, const MapPage& page, const std::vector<std::vector<uint8_t>>& masks) {
    auto image = gpu::Image::create(stage.device,
                                    {.name = "layer masks",
                                     .format = VK_FORMAT_R8_UNORM,
                                     .width = kIndexTexels,
                                     .height = kIndexTexels,
                                     .layer_count = static_cast<uint32_t>(masks.size()),
                                     .array_view = true,
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    if (!image) return image.error();
    LayerMasks out{std::move(*image), page};
    auto done = stage.timed_frame([&](gpu::Commands& commands) -> Status {
        const uint64_t bytes = uint64_t(kIndexTexels) * kIndexTexels;
        commands.use({{out.pages, gpu::Access::copy_target}});
        for (size_t k = 0; k < masks.size(); ++k) {
            const gpu::UploadSlice slice = stage.ring->upload(bytes);
            std::memcpy(slice.data, masks[k].data(), bytes);
            const VkBufferImageCopy region{
                .bufferOffset = slice.offset,
                .bufferRowLength = 0,
                .bufferImageHeight = 0,
                .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, static_cast<uint32_t>(k), 1},
                .imageOffset = {},
                .imageExtent = {kIndexTexels, kIndexTexels, 1}};
            vkCmdCopyBufferToImage(commands.handle(), slice.buffer->handle(), out.pages.handle(),
                                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
        }
        return {};
    });
    if (!done) return done.error();
    return out;
}

}  // namespace

Status add_masks(const BenchRequest& request, gpu::Device& device, BenchTable& table) {
    for (const int layers : request.quick ? std::vector{4} : std::vector{4, 8, 16, kMostMasks}) {
        auto project = TemporaryProject::create_part({.of = request.project,
                                                      .part_m = kMap_m,
                                                      .side_m = kMap_m,
                                                      .layers = layers,
                                                      .mosaic_m = kMosaic_m});
        if (!project) return project.error();
        auto document = Document::open(project->path(), OpenMode::read_only);
        if (!document) return document.error();
        auto stage = Stage::create(device, **document);
        if (!stage) return stage.error();
        auto maker = stage->page_maker(PageFormat::rgba8, {}, 1, 1, false);
        if (!maker) return maker.error();
        auto job = stage->whole_page(kPage);
        if (!job) return job.error();
        const int repeats = request.quick ? 3 : 15;
        auto index = stage->composed(*maker, *job, repeats);
        if (!index) return index.error();
        const IndexTexel* texels = stage->index->resident_page(job->index_page);
        const double page_bytes = double(kIndexTexels) * kIndexTexels, slots = IndexMapDesc{}.slot_count;
        const double whole = std::pow(kWhole_m / (*document)->settings().index_spacing_m, 2);
        for (const int radius : {0, 4, 12}) {
            const auto masks = masks_of(texels, layers, radius);
            auto pages = upload(*stage, job->index_page, masks);
            if (!pages) return pages.error();
            LOAM_TRY(maker->composer->use_masks(&*pages));
            auto masked = stage->composed(*maker, *job, repeats);
            LOAM_TRY(maker->composer->use_masks(nullptr));
            if (!masked) return masked.error();
            table.rows.push_back(
                {{"layers", layers},
                 {"kind", radius == 0 ? "hard" : fmt::format("soft, {} m", radius)},
                 {"layers a texel", rounded(lookups(masks, *stage, *job), 2)},
                 {"index map ms", rounded(index->ms, 2)},
                 {"masks ms", rounded(masked->ms, 2)},
                 {"rms between, of 255", rounded(albedo_rms(index->albedo, masked->albedo), 2)},
                 {"cache MB, index map", rounded(page_bytes * slots * kIndexMapBytes / 1e6, 1)},
                 {"cache MB, masks", rounded(page_bytes * slots * layers / 1e6, 1)},
                 {"16 km MB, index map", rounded(whole * kIndexMapBytes / 1e6, 0)},
                 {"16 km MB, masks", rounded(whole * layers / 1e6, 0)}});
        }
    }
    return {};
}

}  // namespace loam::bench
