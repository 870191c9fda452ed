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
#include "shaders/texture/ompv.h"

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

// The files that layers name, each once, in the list's order.
std::vector<std::string> files_of(const std::vector<LayerEntry>& entries) {
    std::vector<std::string> files;
    for (const LayerEntry& entry : entries)
        if (!entry.blend && std::find(files.begin(), files.end(), entry.file) == files.end())
            files.push_back(entry.file);
    return files;
}

Result<std::vector<LayerTextures>> load_all(const Document& document, const std::vector<std::string>& files) {
    std::vector<LayerTextures> loaded(files.size());
    std::vector<std::string> failures(files.size());
    parallel_ranges(int(files.size()), 1, [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            auto layer = load_layer(document.folder() / files[size_t(i)]);
            if (layer.ok())
                loaded[size_t(i)] = std::move(*layer);
            else
                failures[size_t(i)] = layer.message();
        }
    });
    for (size_t i = 0; i < files.size(); ++i)
        if (!failures[i].empty())
            for (const LayerEntry& entry : document.settings().layers)
                if (!entry.blend && entry.file == files[i])
                    return error("cannot load layer \"{}\" from {}: {}", entry.name,
                                 (document.folder() / files[i]).string(), failures[i]);
    return loaded;
}

// Row 0 north; nearest texel of the mip that is just large enough; alpha is the reveal map.
std::vector<uint8_t> make_thumbnail(const LayerTextures& layer) {
    size_t mip = 0;
    int size = layer.size_texels;
    for (; size / 2 >= kThumbnail && mip + 1 < layer.albedo_reveal.size(); size /= 2) ++mip;
    std::vector<uint8_t> out(size_t(kThumbnail) * kThumbnail * 4, 255);
    for (int y = 0; y < kThumbnail; ++y)
        for (int x = 0; x < kThumbnail; ++x) {
            const size_t from = size_t((kThumbnail - 1 - y) * size / kThumbnail) * size_t(size) +
                                size_t(x * size / kThumbnail);
            std::memcpy(&out[size_t(y * kThumbnail + x) * 4], &layer.albedo_reveal[mip][from * 4], 4);
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
    const std::vector<std::string> files = files_of(document.settings().layers);
    auto loaded = load_all(document, files);
    if (!loaded.ok()) return loaded.error();
    std::vector<LayerTextures> layers = std::move(*loaded);
    if (layers.empty()) layers.push_back(flat_grey());
    const int slot_count = int(layers.size());
    int size = 1;
    for (size_t i = 0; i < layers.size(); ++i) {
        size = std::max(size, layers[i].size_texels);
        set->has_metal |= layers[i].has_metal;
        set->slots_.push_back({i < files.size() ? files[i] : "", 1, make_thumbnail(layers[i])});
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
                                   .layer_count = uint32_t(slot_count),
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
            total += (mip_bytes(t, mip) * uint64_t(slot_count) + 15) / 16 * 16;
    }
    // A repeated layer's tile grows with it.
    for (size_t i = 0; i < layers.size(); ++i)
        set->slots_[i].repeats = std::max(1.0, double(size) / layers[i].size_texels);
    auto staging = gpu::Buffer::create(device, {.name = "layer staging",
                                                .size_bytes = total,
                                                .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                .memory = gpu::MemoryUse::upload});
    if (!staging.ok()) return staging.error();
    uint8_t* bytes = staging->as<uint8_t>();
    parallel_ranges(slot_count, 1, [&](int begin, int end) {
        for (int layer = begin; layer < end; ++layer)
            for (const Target& t : targets) {
                uint64_t at = t.offset;
                for (uint32_t mip = 0; mip < t.image->mip_count(); ++mip) {
                    fill_mip(*t.layers[size_t(layer)], layers[size_t(layer)].size_texels, t.size, int(mip),
                             t.texel_bytes, bytes + at + mip_bytes(t, mip) * uint64_t(layer));
                    at += (mip_bytes(t, mip) * uint64_t(slot_count) + 15) / 16 * 16;
                }
            }
    });

    for (const VkSamplerMipmapMode mips : {VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_SAMPLER_MIPMAP_MODE_LINEAR}) {
        auto sampler = gpu::Sampler::create(
            device,
            {.filter = VK_FILTER_LINEAR, .mip_mode = mips, .address = VK_SAMPLER_ADDRESS_MODE_REPEAT});
        if (!sampler.ok()) return sampler.error();
        (mips == VK_SAMPLER_MIPMAP_MODE_NEAREST ? set->sampler : set->smooth_sampler) = std::move(*sampler);
    }

    auto frame = ring.begin();
    if (!frame.ok()) return frame.error();
    gpu::Commands& commands = (*frame)->commands;
    commands.use({{set->albedo_reveal, gpu::Access::copy_target},
                  {set->normal_gloss_occlusion, gpu::Access::copy_target},
                  {set->metalness, gpu::Access::copy_target}});
    for (const Target& t : targets) {
        std::vector<VkBufferImageCopy> regions;
        uint64_t at = t.offset;
        for (uint32_t mip = 0; mip < t.image->mip_count(); ++mip) {
            const uint32_t side = uint32_t(std::max(1, t.size >> mip));
            regions.push_back({.bufferOffset = at,
                               .bufferRowLength = 0,
                               .bufferImageHeight = 0,
                               .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, uint32_t(slot_count)},
                               .imageOffset = {},
                               .imageExtent = {side, side, 1}});
            at += (mip_bytes(t, mip) * uint64_t(slot_count) + 15) / 16 * 16;
        }
        vkCmdCopyBufferToImage(commands.handle(), staging->handle(), t.image->handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, uint32_t(regions.size()),
                               regions.data());
    }
    if (auto done = ring.finish(**frame); !done.ok()) return done.error();
    LOAM_TRY(set->take_settings(ring, document.settings()));
    return set;
}

bool LayerSet::has_textures_of(const ProjectSettings& settings) const {
    std::vector<std::string> files = files_of(settings.layers);
    if (files.empty()) files.emplace_back();
    return std::equal(files.begin(), files.end(), slots_.begin(), slots_.end(),
                      [](const std::string& file, const Slot& slot) { return file == slot.file; });
}

void LayerSet::fill_place(int layer, shared::LayerPlace& place) const {
    const Source& source = blends_[size_t(layer)];
    place.slot = source.slot;
    place.first = source.first;
    place.second = source.second;
    place.threshold = source.threshold;
    place.channels = glm::vec4(0);
    if (size_t(layer) < entries.size())
        for (size_t c = 0; c < kChannelNames.size(); ++c)
            place.channels[int(c)] = float(entries[size_t(layer)].channels[c]);
}

// A transition's picture is what its threshold makes of its layers' pictures.
void LayerSet::make_thumbnails() {
    thumbnails.clear();
    for (const Source& source : blends_) {
        std::vector<uint8_t> picture = slots_[blends_[source.first].slot].thumbnail;
        const std::vector<uint8_t>& over = slots_[blends_[source.second].slot].thumbnail;
        for (size_t i = 0; i < picture.size(); i += 4) {
            const float cover = source.first == source.second
                                    ? 0.0f
                                    : shared::ompv_cover(source.threshold, float(over[i + 3]) / 255.0f);
            for (size_t c = 0; c < 3; ++c)
                picture[i + c] = uint8_t(std::lerp(float(picture[i + c]), float(over[i + c]), cover) + 0.5f);
            picture[i + 3] = 255;
        }
        thumbnails.push_back(std::move(picture));
    }
}

Status LayerSet::take_settings(gpu::FrameRing& ring, const ProjectSettings& project) {
    LOAM_CHECK(has_textures_of(project), "other layer files need another LayerSet");
    std::vector<LayerEntry> list = project.layers;
    if (list.empty()) list.push_back({.name = "grey"});
    const auto number_of = [&](const std::string& name) {
        return uint32_t(
            std::find_if(list.begin(), list.end(), [&](const LayerEntry& l) { return l.name == name; }) -
            list.begin());
    };
    entries = project.layers;
    count = int(list.size());
    names.clear();
    tiles_m.clear();
    blends_.clear();
    has_transitions = false;
    for (uint32_t i = 0; i < list.size(); ++i) {
        const LayerEntry& entry = list[i];
        names.push_back(entry.name);
        Source source{.first = i, .second = i};
        if (entry.blend) {
            source.first = number_of(entry.blend->from);
            source.second = number_of(entry.blend->to);
            source.threshold = float(entry.blend->threshold);
            if (entry.blend->removed)
                source.first = source.second = source.threshold < 0.5f ? source.first : source.second;
            has_transitions = true;
        } else {
            source.slot = uint32_t(std::find_if(slots_.begin(), slots_.end(),
                                                [&](const Slot& s) { return s.file == entry.file; }) -
                                   slots_.begin());
        }
        tiles_m.push_back(entry.tile_m * slots_[source.slot].repeats);
        blends_.push_back(source);
    }
    make_thumbnails();

    const GroundSettings& settings = project.ground;
    ground = settings;
    imagery = project.imagery;
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
