// Layers of different sizes meet at the largest size among them, at most kMaxLayerTexels: a larger one drops
// its finest mips, a smaller one is repeated (tile scale adjusted, so its texels keep their size in the
// world).
#include "runtime/texture/layer_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include "runtime/base/check.h"
#include "runtime/base/job_queue.h"
#include "runtime/document/document.h"
#include "runtime/store/layer_file.h"
#include "runtime/texture/distortion.h"
#include "runtime/texture/page_format.h"
#include "shaders/texture/ompv.h"

namespace loam {

namespace {

constexpr int kMaxLayerTexels = 2048;  // 8 layers of it are 360 MB: enough for texels of 1 mm on a 2 m tile
constexpr int kTailLevel = 3;  // a 64th of the memory, and enough for pages from 3 cm a texel of a 2 m tile
// A page is composed as sharply as it can be only where its layers are all there at once.
constexpr int kFewestSlots = 8;

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

// What visiting a file says, with the layer that names it.
template <typename Visit>
Status visit_files(const Document& document, const std::vector<std::string>& files, const Visit& visit) {
    std::vector<std::string> failures(files.size());
    parallel_ranges(int(files.size()), 1, [&](int begin, int end) {
        for (size_t i = size_t(begin); i < size_t(end); ++i)
            if (const Status status = visit(i, document.folder() / files[i]); !status.ok())
                failures[i] = status.message();
    });
    for (size_t i = 0; i < files.size(); ++i)
        if (!failures[i].empty())
            for (const LayerEntry& entry : document.settings().layers)
                if (!entry.blend && entry.file == files[i])
                    return error("cannot load layer \"{}\" from {}: {}", entry.name,
                                 (document.folder() / files[i]).string(), failures[i]);
    return {};
}

// Row 0 north; nearest texel of the mip that is just large enough; alpha is the reveal map.
std::vector<uint8_t> make_thumbnail(const LayerTextures& layer) {
    constexpr int kThumbnail = LayerSet::kThumbnail;
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

}  // namespace

Result<std::unique_ptr<LayerSet>> LayerSet::create(gpu::FrameRing& ring, const Document& document,
                                                   uint64_t budget_bytes) {
    auto set = std::make_unique<LayerSet>();
    for (const VkSamplerMipmapMode mips : {VK_SAMPLER_MIPMAP_MODE_NEAREST, VK_SAMPLER_MIPMAP_MODE_LINEAR}) {
        auto sampler = gpu::Sampler::create(
            ring.device(),
            {.filter = VK_FILTER_LINEAR, .mip_mode = mips, .address = VK_SAMPLER_ADDRESS_MODE_REPEAT});
        if (!sampler.ok()) return sampler.error();
        (mips == VK_SAMPLER_MIPMAP_MODE_NEAREST ? set->sampler : set->smooth_sampler) = std::move(*sampler);
    }
    LOAM_TRY(set->load(ring, document, budget_bytes));
    LOAM_TRY(set->take_settings(ring, document.settings()));
    return set;
}

Status LayerSet::load(gpu::FrameRing& ring, const Document& document, uint64_t budget_bytes) {
    const std::vector<std::string> files = files_of(document.settings().layers);
    std::vector<int> sizes(files.size());
    LOAM_TRY(visit_files(document, files, [&](size_t i, const std::filesystem::path& file) -> Status {
        const auto size = layer_size(file);
        if (!size.ok()) return size.error();
        sizes[i] = *size;
        return {};
    }));
    std::vector<LayerTextures> layers(files.size());
    if (files.empty()) layers.push_back(flat_grey());
    if (files.empty()) sizes.push_back(layers[0].size_texels);
    const int size = std::min(*std::max_element(sizes.begin(), sizes.end()), kMaxLayerTexels);
    size_texels = size;

    LayerArraysDesc whole{
        .size_texels = size, .first_level = 0, .slot_count = int(layers.size()), .has_metal = true};
    const auto fitting =
        int(std::min<uint64_t>(budget_bytes / LayerArrays::slot_bytes(whole), layers.size()));
    const int tail_texels = std::max(size >> kTailLevel, kThumbnail);
    const bool streams = fitting < int(layers.size()) && tail_texels < size;
    const int first_level = streams ? std::countr_zero(uint32_t(size / tail_texels)) : 0;
    LOAM_TRY(visit_files(document, files, [&](size_t i, const std::filesystem::path& file) -> Status {
        // A small layer's picture in the palette may want finer mips than its tail has.
        const int drop = std::max(0, std::countr_zero(uint32_t(sizes[i])) - std::countr_zero(uint32_t(size)));
        const int first_mip =
            std::clamp(std::countr_zero(uint32_t(sizes[i])) - kThumbnailLog2, 0, first_level + drop);
        auto layer = load_layer(file, streams ? first_mip : 0);
        if (!layer.ok()) return layer.error();
        layers[i] = std::move(*layer);
        return {};
    }));
    whole.has_metal = false;
    for (size_t i = 0; i < layers.size(); ++i) {
        whole.has_metal |= layers[i].has_metal;
        // A repeated layer's tile grows with it.
        files_.push_back({i < files.size() ? files[i] : "",
                          std::max(1.0, double(size) / layers[i].size_texels), make_thumbnail(layers[i])});
    }
    has_metal = whole.has_metal;
    if (streams) whole.slot_count = std::max(fitting, std::min(kFewestSlots, int(layers.size())));
    auto arrays = LayerArrays::create(ring.device(), whole);
    if (!arrays.ok()) return arrays.error();
    whole_ = std::move(*arrays);
    if (!streams) return fill(ring, whole_, layers);

    LayerArraysDesc tail = whole;
    tail.first_level = first_level;
    tail.slot_count = int(layers.size());
    auto tails = LayerArrays::create(ring.device(), tail);
    if (!tails.ok()) return tails.error();
    tail_ = std::move(*tails);
    stream_ = std::make_unique<LayerStream>(whole_, document.folder(), files);
    return fill(ring, tail_, layers);
}

// Through a staging buffer of our own: in the frame ring it would stay for good.
Status LayerSet::fill(gpu::FrameRing& ring, LayerArrays& arrays, const std::vector<LayerTextures>& layers) {
    const uint64_t slot_bytes = arrays.slot_bytes();
    auto staging = gpu::Buffer::create(ring.device(), {.name = "layer staging",
                                                       .size_bytes = slot_bytes * layers.size(),
                                                       .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                       .memory = gpu::MemoryUse::upload});
    if (!staging.ok()) return staging.error();
    parallel_ranges(int(layers.size()), 1, [&](int begin, int end) {
        for (size_t i = size_t(begin); i < size_t(end); ++i)
            arrays.write_slot(layers[i], staging->as<uint8_t>() + i * slot_bytes);
    });
    auto frame = ring.begin();
    if (!frame.ok()) return frame.error();
    gpu::Commands& commands = (*frame)->commands;
    commands.use({{arrays.albedo_reveal, gpu::Access::copy_target},
                  {arrays.normal_gloss_occlusion, gpu::Access::copy_target},
                  {arrays.metalness, gpu::Access::copy_target}});
    for (size_t i = 0; i < layers.size(); ++i)
        arrays.cmd_fill(commands, *staging, i * slot_bytes, uint32_t(i));
    return ring.finish(**frame);
}

Status LayerSet::update(gpu::FrameRing& ring, gpu::Commands& commands, bool wait) {
    return stream_ ? stream_->update(ring, commands, wait) : Status();
}

LayerSet::Statistics LayerSet::statistics() const {
    return {int(files_.size()), whole_.desc().slot_count, stream_ ? stream_->load_count() : 0};
}

void LayerSet::add_need(uint32_t layer, double level, LayerNeeds& needs) const {
    const uint32_t file = blends_[layer].file;
    if (std::find(needs.files.begin(), needs.files.end(), file) == needs.files.end())
        needs.files.push_back(file);
    needs.tail_suffices &= level >= first_tail_level();
}

LayerTier LayerSet::tier_of(const LayerNeeds& needs) const {
    return needs.tail_suffices || !stream_->slots.all_resident(needs.files) ? LayerTier::tail
                                                                            : LayerTier::whole;
}

bool LayerSet::has_textures_of(const ProjectSettings& settings) const {
    std::vector<std::string> files = files_of(settings.layers);
    if (files.empty()) files.emplace_back();
    return std::equal(files.begin(), files.end(), files_.begin(), files_.end(),
                      [](const std::string& name, const File& file) { return name == file.name; });
}

void LayerSet::fill_place(int layer, LayerTier tier, shared::LayerPlace& place) const {
    const Source& source = blends_[size_t(layer)];
    place.slot = source.file;
    if (stream_ && tier == LayerTier::whole)  // what is in no slot is not looked at
        place.slot = uint32_t(std::max(0, stream_->slots.slot_of(source.file)));
    if (stream_ && tier == LayerTier::tail) {
        place.lod_bias -= float(first_tail_level());
        place.vista_lod_bias -= float(first_tail_level());
    }
    place.first = source.first;
    place.second = source.second;
    place.threshold = source.threshold;
    place.channels = glm::vec4(0);
    if (size_t(layer) < entries.size())
        for (uint32_t c = 0; c < kChannelCount; ++c)
            if (const uint32_t at = shared::page_channel_place(placement_, c); at > 0)
                place.channels[int(at - 1)] = float(entries[size_t(layer)].channels[c]);
}

// A transition's picture is what its threshold makes of its layers' pictures.
void LayerSet::make_thumbnails() {
    thumbnails.clear();
    for (const Source& source : blends_) {
        std::vector<uint8_t> picture = files_[blends_[source.first].file].thumbnail;
        const std::vector<uint8_t>& over = files_[blends_[source.second].file].thumbnail;
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
    placement_ = channel_placement(project.channels);
    deepest = 0;
    if (shared::page_channel_place(placement_, kChannelDepth) > 0)
        for (const LayerEntry& layer : entries)
            if (!layer.blend) deepest = std::max(deepest, float(layer.channels[kChannelDepth]));
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
            source.file = uint32_t(std::find_if(files_.begin(), files_.end(),
                                                [&](const File& f) { return f.name == entry.file; }) -
                                   files_.begin());
        }
        tiles_m.push_back(entry.tile_m * files_[source.file].repeats);
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
