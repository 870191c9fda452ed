// Layers of different sizes meet at the largest size among them, at most kMaxLayerTexels: a larger one drops
// its finest mips, a smaller one is repeated (tile scale adjusted, so its texels keep their size in the
// world).
#include "runtime/texture/layer_set.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include "runtime/base/check.h"
#include "runtime/base/job_queue.h"
#include "runtime/document/document.h"
#include "runtime/store/layer_file.h"
#include "runtime/texture/distortion.h"
#include "shaders/texture/compose_io.h"

namespace loam {

namespace {

constexpr int kMaxLayerTexels = 2048;  // 8 layers of it are 360 MB: enough for texels of 1 mm on a 2 m tile
constexpr int kThumbnail = 64;

LayerTextures flat_grey() {
    LayerTextures t;
    t.size_texels = 4;
    t.albedo_reveal.resize(1);
    t.normal_gloss_occlusion.resize(1);
    t.metalness.resize(1);
    for (int i = 0; i < 16; ++i) {
        t.albedo_reveal[0].insert(t.albedo_reveal[0].end(), {128, 128, 128, 128});
        t.normal_gloss_occlusion[0].insert(t.normal_gloss_occlusion[0].end(), {128, 128, 64, 255});
        t.metalness[0].push_back(0);
    }
    build_layer_mips(t);
    return t;
}

Result<std::vector<LayerTextures>> load_all(const Document& document) {
    const auto& entries = document.settings().layers;
    std::vector<LayerTextures> loaded(entries.size());
    std::vector<std::string> failures(entries.size());
    parallel_ranges(int(entries.size()), 1, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            auto layer = load_layer(document.folder() / entries[size_t(i)].file);
            if (layer.ok())
                loaded[size_t(i)] = std::move(*layer);
            else
                failures[size_t(i)] = layer.message();
        }
    });
    for (size_t i = 0; i < entries.size(); ++i)
        if (!failures[i].empty())
            return error("cannot load layer \"{}\" from {}: {}", entries[i].name,
                         (document.folder() / entries[i].file).string(), failures[i]);
    return loaded;
}

// Row 0 north; nearest texel of the mip that is just large enough.
std::vector<uint8_t> make_thumbnail(const LayerTextures& layer) {
    size_t mip = 0;
    int size = layer.size_texels;
    for (; size / 2 >= kThumbnail && mip + 1 < layer.albedo_reveal.size(); size /= 2) ++mip;
    std::vector<uint8_t> out(size_t(kThumbnail) * kThumbnail * 4, 255);
    for (int y = 0; y < kThumbnail; ++y)
        for (int x = 0; x < kThumbnail; ++x) {
            const size_t from = size_t((kThumbnail - 1 - y) * size / kThumbnail) * size_t(size) +
                                size_t(x * size / kThumbnail);
            std::memcpy(&out[size_t(y * kThumbnail + x) * 4], &layer.albedo_reveal[mip][from * 4], 3);
        }
    return out;
}

using Mips = std::vector<std::vector<uint8_t>>;

// Mip `level` of the common size out of a layer's own mips. 1x1 mips are reached by repetition, too: a
// smaller layer repeats `size` times, so its coarsest mips stay at its own 1x1.
void fill_mip(const Mips& mips, int own_size, int size, int level, int texel_bytes, uint8_t* out) {
    const int side = std::max(1, size >> level);
    // The texels keep their size in the world: level 0 of the set is level `skip` of the layer.
    const int skip = std::max(0, int(std::lround(std::log2(double(own_size) / size))));
    const size_t own_level = std::min(mips.size() - 1, size_t(level + skip));
    const int own_side = std::max(1, own_size >> own_level);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; x += own_side) {
            const int run = std::min(own_side, side - x);
            std::memcpy(out + size_t(y * side + x) * size_t(texel_bytes),
                        &mips[own_level][size_t(y % own_side) * size_t(own_side) * size_t(texel_bytes)],
                        size_t(run) * size_t(texel_bytes));
        }
}

struct Target {
    gpu::Image* image;
    std::vector<Mips*> layers;
    int size, texel_bytes;
    uint64_t offset = 0;
};

}  // namespace

Result<std::unique_ptr<LayerSet>> LayerSet::create(gpu::FrameRing& ring, const Document& document) {
    auto set = std::make_unique<LayerSet>();
    gpu::Device& device = ring.device();
    auto loaded = load_all(document);
    if (!loaded.ok()) return loaded.error();
    std::vector<LayerTextures> layers = std::move(*loaded);
    std::vector<double> tiles_m;
    for (const LayerEntry& entry : document.settings().layers) {
        set->names.push_back(entry.name);
        tiles_m.push_back(entry.tile_m);
    }
    if (layers.empty()) {
        layers.push_back(flat_grey());
        set->names.push_back("grey");
        tiles_m.push_back(2.0);
    }
    set->count = int(layers.size());
    int size = 1;
    for (const LayerTextures& l : layers) {
        size = std::max(size, l.size_texels);
        set->has_metal |= l.has_metal;
        set->thumbnails.push_back(make_thumbnail(l));
    }
    size = std::min(size, kMaxLayerTexels);
    set->size_texels = size;
    uint32_t mip_count = 1;
    while (size >> mip_count) ++mip_count;

    const auto make_image = [&](const char* name, VkFormat format, int side, uint32_t mips) {
        return gpu::Image::create(device,
                                  {.name = name,
                                   .format = format,
                                   .width = uint32_t(side),
                                   .height = uint32_t(side),
                                   .mip_count = mips,
                                   .layer_count = uint32_t(set->count),
                                   .array_view = true,
                                   .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    };
    auto albedo = make_image("layer albedo", VK_FORMAT_R8G8B8A8_SRGB, size, mip_count);
    if (!albedo.ok()) return albedo.error();
    auto normal = make_image("layer normal", VK_FORMAT_R8G8B8A8_UNORM, size, mip_count);
    if (!normal.ok()) return normal.error();
    auto metal = make_image("layer metalness", VK_FORMAT_R8_UNORM, set->has_metal ? size : 1,
                            set->has_metal ? mip_count : 1);
    if (!metal.ok()) return metal.error();
    set->albedo_reveal = std::move(*albedo);
    set->normal_gloss_occlusion = std::move(*normal);
    set->metalness = std::move(*metal);

    // One staging buffer of our own: through the frame ring it would stay for good.
    std::vector<Target> targets = {{&set->albedo_reveal, {}, size, 4},
                                   {&set->normal_gloss_occlusion, {}, size, 4}};
    for (LayerTextures& l : layers) {
        targets[0].layers.push_back(&l.albedo_reveal);
        targets[1].layers.push_back(&l.normal_gloss_occlusion);
    }
    if (set->has_metal) {
        targets.push_back({&set->metalness, {}, size, 1});
        for (LayerTextures& l : layers) targets[2].layers.push_back(&l.metalness);
    }
    const auto mip_bytes = [](const Target& t, uint32_t mip) {
        const uint64_t side = uint64_t(std::max(1, t.size >> mip));
        return side * side * uint64_t(t.texel_bytes);
    };
    uint64_t total = 0;
    for (Target& t : targets) {
        t.offset = total;
        for (uint32_t mip = 0; mip < t.image->mip_count(); ++mip)
            total += (mip_bytes(t, mip) * uint64_t(set->count) + 15) / 16 * 16;
    }
    std::vector<shared::LayerParams> params(size_t(set->count));
    for (size_t i = 0; i < params.size(); ++i) {
        // A repeated layer's tile grows with it; log2(texels a metre) is what mip choice needs.
        const double repeats = std::max(1.0, double(size) / layers[i].size_texels);
        const double tile_m = tiles_m[i] * repeats;
        set->tiles_m.push_back(tile_m);
        params[i] = {float(1.0 / tile_m), float(std::log2(size / tile_m)), 0, 0};
    }
    const uint64_t params_offset = total;
    const uint64_t params_bytes = params.size() * sizeof(shared::LayerParams);
    auto staging = gpu::Buffer::create(device, {.name = "layer staging",
                                                .size_bytes = total + params_bytes,
                                                .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                .memory = gpu::MemoryUse::upload});
    if (!staging.ok()) return staging.error();
    auto parameters = gpu::Buffer::create(device, {.name = "layer parameters",
                                                   .size_bytes = params_bytes,
                                                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    if (!parameters.ok()) return parameters.error();
    set->parameters = std::move(*parameters);
    uint8_t* bytes = staging->as<uint8_t>();
    std::memcpy(bytes + params_offset, params.data(), params_bytes);
    parallel_ranges(set->count, 1, [&](int begin, int end) {
        for (int layer = begin; layer < end; ++layer)
            for (const Target& t : targets) {
                uint64_t at = t.offset;
                for (uint32_t mip = 0; mip < t.image->mip_count(); ++mip) {
                    fill_mip(*t.layers[size_t(layer)], layers[size_t(layer)].size_texels, t.size, int(mip),
                             t.texel_bytes, bytes + at + mip_bytes(t, mip) * uint64_t(layer));
                    at += (mip_bytes(t, mip) * uint64_t(set->count) + 15) / 16 * 16;
                }
            }
    });

    auto sampler = gpu::Sampler::create(device, {.filter = VK_FILTER_LINEAR,
                                                 .mip_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                                 .address = VK_SAMPLER_ADDRESS_MODE_REPEAT});
    if (!sampler.ok()) return sampler.error();
    set->sampler = std::move(*sampler);

    auto frame = ring.begin();
    if (!frame.ok()) return frame.error();
    gpu::Commands& commands = (*frame)->commands;
    commands.use({{set->albedo_reveal, gpu::Access::copy_target},
                  {set->normal_gloss_occlusion, gpu::Access::copy_target},
                  {set->metalness, gpu::Access::copy_target},
                  {set->parameters, gpu::Access::copy_target}});
    for (const Target& t : targets) {
        std::vector<VkBufferImageCopy> regions;
        uint64_t at = t.offset;
        for (uint32_t mip = 0; mip < t.image->mip_count(); ++mip) {
            const uint32_t side = uint32_t(std::max(1, t.size >> mip));
            regions.push_back({.bufferOffset = at,
                               .bufferRowLength = 0,
                               .bufferImageHeight = 0,
                               .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, uint32_t(set->count)},
                               .imageOffset = {},
                               .imageExtent = {side, side, 1}});
            at += (mip_bytes(t, mip) * uint64_t(set->count) + 15) / 16 * 16;
        }
        vkCmdCopyBufferToImage(commands.handle(), staging->handle(), t.image->handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, uint32_t(regions.size()),
                               regions.data());
    }
    const VkBufferCopy region{params_offset, 0, params_bytes};
    vkCmdCopyBuffer(commands.handle(), staging->handle(), set->parameters.handle(), 1, &region);
    if (auto done = ring.finish(**frame); !done.ok()) return done.error();
    LOAM_TRY(set->take_ground(ring, document.settings().ground));
    return set;
}

Status LayerSet::take_ground(gpu::FrameRing& ring, const GroundSettings& settings) {
    ground = settings;
    const bool wanted = settings.distortion_amplitude_m > 0;
    if (!wanted) distortion = {};
    if (!wanted || distortion) return {};
    const auto mips = make_distortion();
    auto image = gpu::Image::create(ring.device(),
                                    {.name = "distortion",
                                     .format = VK_FORMAT_R16G16_SFLOAT,
                                     .width = kDistortionTexels,
                                     .height = kDistortionTexels,
                                     .mip_count = uint32_t(mips.size()),
                                     .array_view = true,
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    if (!image.ok()) return image.error();
    distortion = std::move(*image);
    auto frame = ring.begin();
    if (!frame.ok()) return frame.error();
    gpu::Commands& commands = (*frame)->commands;
    commands.use({{distortion, gpu::Access::copy_target}});
    for (uint32_t mip = 0; mip < mips.size(); ++mip) {
        const uint64_t bytes = mips[mip].size() * sizeof(mips[mip][0]);
        const gpu::UploadSlice slice = ring.upload(bytes);
        std::memcpy(slice.data, mips[mip].data(), bytes);
        const uint32_t side = kDistortionTexels >> mip;
        const VkBufferImageCopy region{.bufferOffset = slice.offset,
                                       .bufferRowLength = 0,
                                       .bufferImageHeight = 0,
                                       .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1},
                                       .imageOffset = {},
                                       .imageExtent = {side, side, 1}};
        vkCmdCopyBufferToImage(commands.handle(), slice.buffer->handle(), distortion.handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    }
    return ring.finish(**frame);
}

}  // namespace loam
