#include "runtime/maps/height_map.h"

#include "runtime/base/check.h"
#include "runtime/maps/base_window.h"
#include "runtime/maps/height_compose.h"
#include "runtime/maps/height_impl.h"
#include "runtime/maps/rect_upload.h"

#include <cstring>

namespace loam {

namespace {

VirtualMapDesc map_desc(const Document& document, int slot_count) {
    const ProjectSettings& settings = document.settings();
    VirtualMapDesc desc;
    desc.payload_texels = kHeightPayload;
    desc.border_texels = kHeightBorder;
    desc.slot_count = slot_count;
    desc.spacing_m = finest_height_spacing(settings);
    desc.bounds = document.bounds();
    const double extent_m = std::max({desc.bounds.max_x, desc.bounds.max_y, desc.spacing_m});
    desc.level_count = level_count_for(extent_m, desc.spacing_m, kHeightPayload);
    return desc;
}

}  // namespace

HeightMap::HeightMap() = default;
HeightMap::~HeightMap() = default;

Result<std::unique_ptr<HeightMap>> HeightMap::create(gpu::Device* device, const Document& document,
                                                     const HeightMapDesc& desc) {
    if (desc.slot_count < 1) return error("a height map needs at least one slot, not {}", desc.slot_count);
    std::unique_ptr<HeightMap> map(new HeightMap);
    map->impl_ = std::make_unique<Impl>(document, map_desc(document, desc.slot_count));
    if (!desc.gpu) return map;

    LOAM_CHECK(device, "a height map with GPU arrays needs a device");
    gpu::ImageDesc image;
    image.width = image.height = kHeightTexels;
    image.layer_count = uint32_t(desc.slot_count);
    image.array_view = true;
    image.usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    image.name = "heights";
    image.format = VK_FORMAT_R32_SFLOAT;
    auto heights = gpu::Image::create(*device, image);
    if (!heights) return heights.error();
    image.name = "height normals";
    image.format = VK_FORMAT_R16G16B16A16_SFLOAT;
    auto normals = gpu::Image::create(*device, image);
    if (!normals) return normals.error();
    map->impl_->heights = std::move(*heights);
    map->impl_->normals = std::move(*normals);
    return map;
}

const VirtualMap& HeightMap::map() const {
    return impl_->map;
}

void HeightMap::request(const MapPage& page, float priority) {
    impl_->map.request(page, priority);
}

void HeightMap::on_dirt(std::span<const WorldRect> rects) {
    for (const WorldRect& rect : rects) {
        if (rect.empty()) continue;
        const WorldRect changed = extended_beyond_edges(rect, impl_->document.bounds());
        impl_->map.invalidate(changed, kOcclusionRadius);
        impl_->map.for_each_resident([&](const MapPage& page, int slot, const TexelRect&) {
            TexelRect& of_slot = impl_->slots[size_t(slot)].changed;
            of_slot = united(of_slot, intersected(impl_->map.texels_in(page, changed), kWindowRect));
        });
        impl_->cache.drop(impl_->map, changed);
    }
}

Status HeightMap::update(gpu::FrameRing& ring, gpu::Commands& commands, uint64_t frame, int new_pages) {
    LOAM_CHECK(impl_->heights, "a height map without GPU arrays is updated by update_without_gpu");
    const std::vector<VirtualMap::Work> work = impl_->compose_planned(frame, new_pages);
    std::vector<RectUpload> heights, normals;
    for (const VirtualMap::Work& w : work) {
        const HeightPage& page = impl_->slots[size_t(w.slot)].page;
        heights.push_back({w.rect, uint32_t(w.slot), page.heights_m.data()});
        normals.push_back({w.rect, uint32_t(w.slot), page.normals.data()});
    }
    LOAM_TRY(cmd_upload_rects(ring, commands, impl_->heights, {.bytes = 4}, heights));
    LOAM_TRY(cmd_upload_rects(ring, commands, impl_->normals, {.bytes = 8}, normals));
    commands.use(
        {{impl_->heights, gpu::Access::graphics_read}, {impl_->normals, gpu::Access::graphics_read}});
    for (const VirtualMap::Work& w : work) impl_->map.finish(w);
    return {};
}

void HeightMap::update_without_gpu(uint64_t frame, int new_pages) {
    for (const VirtualMap::Work& w : impl_->compose_planned(frame, new_pages)) impl_->map.finish(w);
}

bool HeightMap::has_work() const {
    return impl_->map.has_work();
}

gpu::Image& HeightMap::heights() {
    return impl_->heights;
}

gpu::Image& HeightMap::normals() {
    return impl_->normals;
}

const gpu::Image& HeightMap::heights() const {
    return impl_->heights;
}

const gpu::Image& HeightMap::normals() const {
    return impl_->normals;
}

uint32_t HeightMap::count_stale_pages(const Document& document) const {
    uint32_t stale = 0;
    impl_->map.for_each_resident([&](const MapPage& page, int slot, const TexelRect& dirty) {
        if (!dirty.empty()) return;
        HeightPage fresh;
        compose(document, impl_->map, page, {0, 0, kHeightTexels, kHeightTexels}, fresh);
        const HeightPage& kept = impl_->slots[size_t(slot)].page;
        const bool same =
            std::memcmp(fresh.heights_m.data(), kept.heights_m.data(), fresh.heights_m.size() * 4) == 0 &&
            fresh.normals == kept.normals && fresh.min_m == kept.min_m && fresh.max_m == kept.max_m;
        stale += same ? 0 : 1;
    });
    return stale;
}

const HeightPage* HeightMap::resident_page(const MapPage& page) const {
    const int slot = impl_->map.slot_of(page);
    return slot < 0 ? nullptr : &impl_->slots[size_t(slot)].page;
}

uint64_t HeightMap::gpu_bytes() const {
    return impl_->heights ? impl_->heights.bytes() + impl_->normals.bytes() : 0;
}

uint64_t HeightMap::cpu_bytes() const {
    uint64_t bytes = impl_->cache.bytes();
    for (const Impl::Slot& slot : impl_->slots)
        bytes += slot.page.heights_m.capacity() * sizeof(float) +
                 slot.page.normals.capacity() * sizeof(uint16_t) + slot.window_m.capacity() * sizeof(double);
    return bytes;
}

}  // namespace loam
