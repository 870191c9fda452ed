// The invariant that everything hangs on, looked at directly: a resident page equals the page composed from
// nothing.
#include <algorithm>
#include <cstring>

#include <fmt/format.h>

#include "runtime/gpu/format.h"
#include "runtime/texture/virtual_texture_impl.h"

namespace loam {

namespace {

using gpu::Access;
constexpr uint32_t kPagesX = 4, kPagesY = 2, kPagesAtOnce = kPagesX * kPagesY;
constexpr int kPatience = 16;  // frames to wait for the inputs of a group

// Both mips of a page of one texture, copied to a buffer; returns the bytes written.
uint64_t cmd_copy_page(gpu::Commands& commands, const gpu::Image& image, glm::ivec2 page, gpu::Buffer& out,
                       uint64_t offset) {
    VkBufferImageCopy regions[2] = {};
    uint64_t bytes = 0;
    for (uint32_t mip = 0; mip < 2; ++mip) {
        const uint32_t side = kPageTexels >> mip;
        regions[mip].bufferOffset = offset + bytes;
        regions[mip].imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, mip, 0, 1};
        regions[mip].imageOffset = {page.x * int(side), page.y * int(side), 0};
        regions[mip].imageExtent = {side, side, 1};
        bytes += gpu::image_bytes(image.format(), side, side);
    }
    vkCmdCopyImageToBuffer(commands.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           out.handle(), 2, regions);
    return bytes;
}

}  // namespace

Result<uint32_t> VirtualTexture::count_stale_pages(gpu::FrameRing& ring) {
    Impl& t = *impl_;
    auto made = make_page_atlas(t.device, t.textures, kPagesX, kPagesY);
    if (!made.ok()) return made.error();
    PageAtlas fresh = std::move(*made);
    const VkFormat format = t.textures.vk_format;
    const uint64_t page_bytes = fresh.size() * (gpu::image_bytes(format, kPageTexels, kPageTexels) +
                                                gpu::image_bytes(format, kPageTexels / 2, kPageTexels / 2));
    auto buffer = gpu::Buffer::create(
        t.device, {.name = "page comparison", .size_bytes = 2 * page_bytes * kPagesAtOnce});
    if (!buffer.ok()) return buffer.error();

    std::vector<int> places;
    for (int i = 0; i < t.pool.place_count(); ++i)
        if (t.pool.place(i).state != PagePool::State::free && !t.pool.place(i).low_res) places.push_back(i);
    uint32_t stale = 0;
    uint64_t index_frame = t.view_frame;
    t.stale_inputs.clear();  // of the last update; index pages are brought up to date here
    // The layers of several pages may not be there at once.
    const size_t at_once = t.layers.streams() ? 1 : kPagesAtOnce;
    for (size_t first = 0; first < places.size(); first += at_once) {
        const size_t count = std::min(at_once, places.size() - first);
        bool compared = false;
        for (int attempt = 0; attempt < kPatience && !compared; ++attempt) {
            auto frame = ring.begin();
            if (!frame.ok()) return frame.error();
            gpu::Commands& commands = (*frame)->commands;
            for (size_t i = 0; i < count; ++i)
                t.index.request(t.index_page(t.pool.place(places[first + i]).page), 1.0e9f);
            LOAM_TRY(t.index.update(ring, commands, ++index_frame, int(kPagesAtOnce)));
            LOAM_TRY(t.layers.update(ring, commands, true));
            std::vector<ComposeJob> jobs;
            for (size_t i = 0; i < count; ++i) {
                const int place = places[first + i];
                const PageId& page = t.pool.place(place).page;
                const MapPage from = t.index_page(page);
                if (t.index.map().slot_of(from) < 0) continue;
                const Impl::Inputs inputs = t.inputs_of(page, 1);
                if (inputs.page != from || inputs.state != Impl::InputState::ready) continue;
                ComposeJob job = t.make_job(place, {0, 0, kPageTexels, kPageTexels}, inputs);
                job.target = {int(i % kPagesX), int(i / kPagesX)};
                jobs.push_back(job);
            }
            if (jobs.size() == count) {
                LOAM_TRY(t.composer->cmd_compose(ring, commands, jobs, fresh));
                commands.use({{*buffer, Access::copy_target}});
                for (PageAtlas* atlas : {&fresh, &t.atlas})
                    for (gpu::Image& image : *atlas) commands.use({{image, Access::copy_source}});
                uint64_t at = 0;
                for (size_t i = 0; i < count; ++i)
                    for (const bool resident : {true, false}) {
                        const int place = places[first + i], side = t.desc.pages_per_side;
                        const glm::ivec2 page =
                            resident ? glm::ivec2(place % side, place / side) : jobs[i].target;
                        for (size_t which = 0; which < fresh.size(); ++which)
                            at += cmd_copy_page(commands, resident ? t.atlas[which] : fresh[which], page,
                                                *buffer, at);
                    }
                ring.read_back(
                    commands, *buffer, 0, at, [&stale, count, page_bytes](std::span<const std::byte> bytes) {
                        for (size_t i = 0; i < count; ++i)
                            stale += std::memcmp(&bytes[2 * i * page_bytes], &bytes[(2 * i + 1) * page_bytes],
                                                 page_bytes) != 0;
                    });
                compared = true;
            }
            LOAM_TRY(ring.finish(**frame));
        }
        if (!compared) return error("the inputs of {} texture pages did not become resident", count);
    }
    return stale;
}

std::string VirtualTexture::tree_fault() const {
    const Impl& t = *impl_;
    int usable = 0, in_trees = t.sectors.default_tree().page_count();
    for (const LiveSector& s : t.sectors.live()) in_trees += s.tree->page_count();
    for (int i = 0; i < t.pool.place_count(); ++i) {
        const PagePool::Place& p = t.pool.place(i);
        if (p.state != PagePool::State::usable) continue;
        ++usable;
        const PageTree* tree = t.sectors.tree_of(p.page.image);
        if (!tree) return fmt::format("place {} is usable, but its image has ended", i);
        if (t.entered[size_t(i)] != p.generation)
            return fmt::format("place {} holds generation {}, its tree generation {}", i, p.generation,
                               t.entered[size_t(i)]);
        if (p.page.depth > tree->log2_width() ||
            tree->at(p.page.depth, p.page.x, p.page.y) != t.indirection_texel(i, tree->log2_width()))
            return fmt::format("the page of place {} is not in its tree", i);
    }
    if (usable != in_trees)
        return fmt::format("{} places are usable, {} pages are in trees", usable, in_trees);
    return {};
}

}  // namespace loam
