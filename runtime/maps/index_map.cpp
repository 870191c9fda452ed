#include "runtime/maps/index_map.h"

#include <cmath>
#include <cstring>

#include "runtime/base/check.h"
#include "runtime/base/job_queue.h"
#include "runtime/document/document.h"
#include "runtime/maps/base_window.h"
#include "runtime/maps/rect_upload.h"
#include "runtime/maps/tint_blocks.h"
#include "shaders/texture/imagery.h"

namespace loam {

namespace {

constexpr size_t kPageTexels = size_t(kIndexTexels) * kIndexTexels;
constexpr size_t kPageBlocks = kPageTexels / (kTintBlockTexels * kTintBlockTexels);
constexpr int64_t kParallelTexels = 30'000;  // about 0.1 ms
constexpr int kParallelBlocks = 200;         // 0.2 ms where tints differ; nothing where they do not
static_assert(kIndexBorder % kTintBlockTexels == 0 && kIndexPayload % kTintBlockTexels == 0);

struct IndexPage {
    std::vector<IndexTexel> texels;
    // The same as the GPU has them; one of the last two. The fourth byte of a tint is 255.
    std::vector<uint16_t> layers;
    std::vector<glm::uvec2> tint_blocks;
    std::vector<uint32_t> tints;
    std::vector<uint32_t> imagery;  // of this update only
    uint64_t imagery_generation = 0;
};

VirtualMapDesc map_desc(const Document& document, int slot_count) {
    VirtualMapDesc desc;
    desc.payload_texels = kIndexPayload;
    desc.border_texels = kIndexBorder;
    desc.slot_count = slot_count;
    desc.spacing_m = document.settings().index_spacing_m;
    desc.bounds = document.bounds();
    const double extent_m = std::max({desc.bounds.max_x, desc.bounds.max_y, desc.spacing_m});
    desc.level_count = level_count_for(extent_m, desc.spacing_m, kIndexSquareTexels);
    return desc;
}

void compose_page(const Document& document, const VirtualMap& map, const VirtualMap::Work& work,
                  bool compressed_tints, IndexPage& page) {
    page.texels.resize(kPageTexels);
    page.layers.resize(kPageTexels);
    if (!compressed_tints) page.tints.resize(kPageTexels);
    IndexMap::compose(document, map, work.page, work.rect, page.texels);
    for (int y = work.rect.y0; y < work.rect.y1; ++y)
        for (int x = work.rect.x0; x < work.rect.x1; ++x) {
            const size_t i = size_t(y) * kIndexTexels + size_t(x);
            const IndexTexel& t = page.texels[i];
            page.layers[i] = t.layer;
            if (!compressed_tints)
                page.tints[i] =
                    0xff000000u | uint32_t(t.tint[2]) << 16 | uint32_t(t.tint[1]) << 8 | t.tint[0];
        }
}

void pack_tints(IndexPage& page, const TexelRect& blocks) {
    page.tint_blocks.resize(kPageBlocks);
    parallel_ranges(
        blocks.height(), std::max(1, kParallelBlocks / std::max(blocks.width(), 1)), [&](int begin, int end) {
            encode_tint_blocks(page.texels, kIndexTexels,
                               {blocks.x0, blocks.y0 + begin, blocks.x1, blocks.y0 + end}, page.tint_blocks);
        });
}

// The square of imagery that is the page's.
std::vector<uint32_t> imagery_of(const Document& document, const MapPage& page) {
    constexpr int kBorder = kIndexBorder * kImageryDensity, kPayload = kIndexPayload * kImageryDensity;
    std::vector<uint32_t> texels(size_t(kImageryPageTexels) * kImageryPageTexels);
    const auto lock = document.read_lock();
    document.read_imagery(page.level, page.x * kPayload - kBorder, page.y * kPayload - kBorder,
                          kImageryPageTexels, kImageryPageTexels, texels.data());
    return texels;
}

}  // namespace

struct IndexMap::Impl {
    Impl(gpu::Device* on, const Document& d, const VirtualMapDesc& desc)
        : device(on), document(d), map(desc), pages(size_t(desc.slot_count)) {}

    Status take_imagery();
    std::vector<VirtualMap::Work> compose_planned(uint64_t frame, int new_pages);
    Status cmd_update_table(gpu::FrameRing& ring, gpu::Commands& commands);

    gpu::Device* device;
    const Document& document;
    VirtualMap map;
    std::vector<IndexPage> pages;  // one a slot
    gpu::Image indices, tints, imagery;
    bool compressed_tints = false;
    std::string imagery_file;  // that pages are composed with; empty: none
    uint64_t imagery_generation = 0;
    gpu::Buffer page_table;
    bool table_cleared = false;
};

IndexMap::IndexMap() = default;
IndexMap::~IndexMap() = default;

Result<std::unique_ptr<IndexMap>> IndexMap::create(gpu::Device* device, const Document& document,
                                                   const IndexMapDesc& desc) {
    if (desc.slot_count < 1) return error("an index map needs at least one slot, not {}", desc.slot_count);
    std::unique_ptr<IndexMap> map(new IndexMap);
    map->impl_ = std::make_unique<Impl>(device, document, map_desc(document, desc.slot_count));
    if (!desc.gpu) return map;

    LOAM_CHECK(device, "an index map with GPU arrays needs a device");
    gpu::ImageDesc image;
    image.width = image.height = kIndexTexels;
    image.layer_count = uint32_t(desc.slot_count);
    image.array_view = true;
    image.usage =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    image.name = "layer indices";
    image.format = VK_FORMAT_R16_UINT;
    auto indices = gpu::Image::create(*device, image);
    if (!indices) return indices.error();
    image.name = "layer tints";
    map->impl_->compressed_tints = desc.compressed_tints && device->caps().bc;
    image.format = map->impl_->compressed_tints ? VK_FORMAT_BC1_RGB_UNORM_BLOCK : VK_FORMAT_R8G8B8A8_UNORM;
    auto tints = gpu::Image::create(*device, image);
    if (!tints) return tints.error();
    gpu::BufferDesc table;
    table.name = "index page table";
    table.size_bytes = uint64_t(map->impl_->map.table_entry_count()) * sizeof(uint32_t);
    table.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    auto page_table = gpu::Buffer::create(*device, table);
    if (!page_table) return page_table.error();
    map->impl_->indices = std::move(*indices);
    map->impl_->tints = std::move(*tints);
    map->impl_->page_table = std::move(*page_table);
    LOAM_TRY(map->impl_->take_imagery());
    return map;
}

Status IndexMap::Impl::take_imagery() {
    const ImagerySettings& wanted = document.settings().imagery;
    const std::string file = wanted.is_on() ? wanted.file : std::string();
    if (file == imagery_file) return {};
    if (file.empty()) {
        imagery = {};
    } else if (!imagery) {
        auto made = gpu::Image::create(
            *device, {.name = "imagery pages",
                      .format = VK_FORMAT_R8G8B8A8_SRGB,
                      .width = kImageryPageTexels,
                      .height = kImageryPageTexels,
                      .layer_count = uint32_t(map.desc().slot_count),
                      .array_view = true,
                      .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
        if (!made) return made.error();
        imagery = std::move(*made);
    }
    imagery_file = file;
    ++imagery_generation;
    map.invalidate(extended_beyond_edges(document.bounds(), document.bounds()));
    return {};
}

Status IndexMap::take_settings() {
    return impl_->indices ? impl_->take_imagery() : Status();
}

const VirtualMap& IndexMap::map() const {
    return impl_->map;
}

void IndexMap::request(const MapPage& page, float priority) {
    impl_->map.request(page, priority);
}

void IndexMap::on_dirt(std::span<const WorldRect> rects) {
    for (const WorldRect& rect : rects)
        impl_->map.invalidate(extended_beyond_edges(rect, impl_->document.bounds()));
}

std::vector<VirtualMap::Work> IndexMap::Impl::compose_planned(uint64_t frame, int new_pages) {
    std::vector<VirtualMap::Work> work = map.plan(frame, new_pages);
    int64_t texels = 0;
    for (const auto& w : work) texels += w.rect.area();
    const int count = int(work.size());
    const auto compose_range = [&](int begin, int end) {
        for (int i = begin; i < end; ++i) {
            const VirtualMap::Work& w = work[size_t(i)];
            IndexPage& page = pages[size_t(w.slot)];
            compose_page(document, map, w, compressed_tints, page);
            // An edit changes no imagery.
            if (!imagery || (!w.whole && page.imagery_generation == imagery_generation)) continue;
            page.imagery = imagery_of(document, w.page);
            page.imagery_generation = imagery_generation;
        }
    };
    parallel_ranges(count, texels >= kParallelTexels ? 1 : std::max(count, 1), compose_range);
    if (compressed_tints)
        for (const VirtualMap::Work& w : work) pack_tints(pages[size_t(w.slot)], tint_blocks_of(w.rect));
    return work;
}

// Only the last change of an entry counts: regions of one copy must not overlap.
Status IndexMap::Impl::cmd_update_table(gpu::FrameRing& ring, gpu::Commands& commands) {
    const std::vector<VirtualMap::TableChange> changes = map.take_table_changes();
    if (table_cleared && changes.empty()) return {};
    commands.use({{page_table, gpu::Access::copy_target}});
    if (!table_cleared) {
        vkCmdFillBuffer(commands.handle(), page_table.handle(), 0, VK_WHOLE_SIZE, VirtualMap::kNoSlot);
        commands.use({{page_table, gpu::Access::copy_target}});
        table_cleared = true;
    }
    std::unordered_map<uint32_t, uint32_t> newest;
    for (const auto& change : changes) newest[change.entry] = change.slot;
    if (newest.empty()) return {};
    const gpu::UploadSlice slice = ring.upload(newest.size() * sizeof(uint32_t));
    if (!slice.data) return error("no memory for {} page table entries", newest.size());
    std::vector<VkBufferCopy> copies;
    for (const auto& [entry, slot] : newest) {
        const uint64_t offset = copies.size() * sizeof(uint32_t);
        std::memcpy(static_cast<std::byte*>(slice.data) + offset, &slot, sizeof slot);
        copies.push_back({slice.offset + offset, uint64_t(entry) * sizeof(uint32_t), sizeof slot});
    }
    vkCmdCopyBuffer(commands.handle(), slice.buffer->handle(), page_table.handle(), uint32_t(copies.size()),
                    copies.data());
    return {};
}

Status IndexMap::update(gpu::FrameRing& ring, gpu::Commands& commands, uint64_t frame, int new_pages) {
    LOAM_CHECK(impl_->indices, "an index map without GPU arrays is updated by update_without_gpu");
    const std::vector<VirtualMap::Work> work = impl_->compose_planned(frame, new_pages);
    std::vector<RectUpload> indices, tints, imagery;
    for (const VirtualMap::Work& w : work) {
        const IndexPage& page = impl_->pages[size_t(w.slot)];
        indices.push_back({w.rect, uint32_t(w.slot), page.layers.data()});
        if (impl_->compressed_tints)
            tints.push_back({tint_blocks_of(w.rect), uint32_t(w.slot), page.tint_blocks.data()});
        else
            tints.push_back({w.rect, uint32_t(w.slot), page.tints.data()});
        if (!page.imagery.empty())
            imagery.push_back(
                {{0, 0, kImageryPageTexels, kImageryPageTexels}, uint32_t(w.slot), page.imagery.data()});
    }
    LOAM_TRY(cmd_upload_rects(ring, commands, impl_->indices, {.bytes = 2}, indices));
    const UploadUnit tint_unit = impl_->compressed_tints
                                     ? UploadUnit{.bytes = 8, .side_texels = kTintBlockTexels}
                                     : UploadUnit{.bytes = 4};
    LOAM_TRY(cmd_upload_rects(ring, commands, impl_->tints, tint_unit, tints));
    if (!imagery.empty()) LOAM_TRY(cmd_upload_rects(ring, commands, impl_->imagery, {.bytes = 4}, imagery));
    for (const VirtualMap::Work& w : work) impl_->pages[size_t(w.slot)].imagery = {};
    for (const VirtualMap::Work& w : work) impl_->map.finish(w);
    return impl_->cmd_update_table(ring, commands);
}

void IndexMap::update_without_gpu(uint64_t frame, int new_pages) {
    for (const VirtualMap::Work& w : impl_->compose_planned(frame, new_pages)) impl_->map.finish(w);
}

bool IndexMap::has_work() const {
    return impl_->map.has_work();
}

gpu::Image& IndexMap::indices() {
    return impl_->indices;
}

gpu::Image& IndexMap::tints() {
    return impl_->tints;
}

bool IndexMap::compressed_tints() const {
    return impl_->compressed_tints;
}

gpu::Image& IndexMap::imagery() {
    return impl_->imagery ? impl_->imagery : impl_->tints;
}

gpu::Buffer& IndexMap::page_table() {
    return impl_->page_table;
}

const IndexTexel* IndexMap::resident_page(const MapPage& page) const {
    const int slot = impl_->map.slot_of(page);
    return slot < 0 ? nullptr : impl_->pages[size_t(slot)].texels.data();
}

MapPage IndexMap::page_for_square(double min_x_m, double min_y_m, double side_m) const {
    const VirtualMap& map = impl_->map;
    MapPage page;
    while (page.level < map.root().level && map.spacing_m(page.level) * kIndexSquareTexels < side_m)
        ++page.level;
    const double size_m = map.page_size_m(page.level);
    const auto index = [&](double low_m, int count) {
        return std::isnan(low_m) ? 0 : int(std::clamp(std::floor(low_m / size_m), 0.0, double(count - 1)));
    };
    page.x = index(min_x_m, map.pages_x(page.level));
    page.y = index(min_y_m, map.pages_y(page.level));
    return page;
}

IndexTexel IndexMap::texel_at(double x_m, double y_m) {
    const VirtualMap& map = impl_->map;
    const glm::ivec2 last = impl_->document.index_size_texels() - 1;
    const auto nearest = [&](double metres, int limit) {
        return std::isnan(metres)
                   ? 0
                   : int(std::clamp(std::floor(metres / map.spacing_m(0) + 0.5), 0.0, double(limit)));
    };
    const glm::ivec2 sample(nearest(x_m, last.x), nearest(y_m, last.y));
    MapPage page{0, sample.x / kIndexPayload, sample.y / kIndexPayload};
    page.x = std::min(page.x, map.pages_x(0) - 1);  // the last sample may be the far edge of the last page
    page.y = std::min(page.y, map.pages_y(0) - 1);
    const glm::ivec2 texel = sample - glm::ivec2(page.x, page.y) * kIndexPayload + kIndexBorder;
    const size_t at = size_t(texel.y) * kIndexTexels + size_t(texel.x);
    if (const int slot = map.slot_of(page); slot >= 0 && map.dirty_of(slot).empty())
        return impl_->pages[size_t(slot)].texels[at];
    std::vector<IndexTexel> scratch(kPageTexels);
    compose(impl_->document, map, page, {texel.x, texel.y, texel.x + 1, texel.y + 1}, scratch);
    return scratch[at];
}

uint32_t IndexMap::count_stale_pages(const Document& document) const {
    uint32_t stale = 0;
    constexpr int kBlocksAcross = kIndexTexels / kTintBlockTexels;
    std::vector<IndexTexel> fresh(kPageTexels);
    std::vector<glm::uvec2> blocks(kPageBlocks);
    impl_->map.for_each_resident([&](const MapPage& page, int slot, const TexelRect& dirty) {
        if (!dirty.empty()) return;
        compose(document, impl_->map, page, {0, 0, kIndexTexels, kIndexTexels}, fresh);
        const IndexPage& kept = impl_->pages[size_t(slot)];
        bool same = fresh == kept.texels;
        if (impl_->compressed_tints) {
            encode_tint_blocks(fresh, kIndexTexels, {0, 0, kBlocksAcross, kBlocksAcross}, blocks);
            same = same && blocks == kept.tint_blocks;
        }
        stale += same ? 0 : 1;
    });
    return stale;
}

uint64_t IndexMap::gpu_bytes() const {
    return impl_->indices ? impl_->indices.bytes() + impl_->tints.bytes() + impl_->page_table.size_bytes() +
                                (impl_->imagery ? impl_->imagery.bytes() : 0)
                          : 0;
}

}  // namespace loam
