#include "runtime/gpu/frame_ring.h"

#include <algorithm>

#include "runtime/base/check.h"
#include "runtime/gpu/format.h"
#include "runtime/gpu/frame_slot.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

namespace {

constexpr uint32_t kMaxTimedPasses = 256;  // a frame; further passes go untimed
constexpr uint32_t kNoQuery = UINT32_MAX;
constexpr uint64_t kHostBlock_bytes = 4ull << 20;  // a few frames of page uploads
constexpr uint64_t kSliceAlignment_bytes = 256;    // the largest minimum offset that Vulkan allows a device

Status create_descriptor_pool(VkDevice device, VkDescriptorPool& out) {
    constexpr VkDescriptorPoolSize kSizes[] = {{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1024},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 512},
                                               {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1024},
                                               {VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 512}};
    auto info = vk_struct<VkDescriptorPoolCreateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO);
    info.maxSets = 256;
    info.poolSizeCount = 4;
    info.pPoolSizes = kSizes;
    const VkResult r = vkCreateDescriptorPool(device, &info, nullptr, &out);
    if (r != VK_SUCCESS) return vk_error("vkCreateDescriptorPool", r);
    return {};
}

}  // namespace

Result<UploadSlice> HostRing::take(Device& device, uint64_t size_bytes) {
    const uint64_t size = (size_bytes + kSliceAlignment_bytes - 1) & ~(kSliceAlignment_bytes - 1);
    auto block = std::ranges::find_if(
        blocks_, [&](const Block& b) { return b.buffer->size_bytes() - b.used >= size; });
    if (block == blocks_.end()) {
        auto buffer = Buffer::create(
            device, {.name = name_,
                     .size_bytes = std::max(size, kHostBlock_bytes),
                     .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
                              VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT,
                     .memory = use_});
        if (!buffer) return buffer.error();
        blocks_.push_back({std::make_unique<Buffer>(std::move(*buffer)), 0});
        block = std::prev(blocks_.end());
    }
    const UploadSlice slice{block->buffer.get(), block->used, block->buffer->as<std::byte>() + block->used,
                            size_bytes};
    block->used += size;
    return slice;
}

void HostRing::reset() {
    std::erase_if(blocks_,
                  [](const Block& b) { return b.used == 0 && b.buffer->size_bytes() > kHostBlock_bytes; });
    for (Block& b : blocks_) b.used = 0;
}

uint64_t HostRing::bytes() const {
    uint64_t sum = 0;
    for (const Block& b : blocks_) sum += b.buffer->size_bytes();
    return sum;
}

FrameRing::FrameRing(Device& device) : device_(device) {}

Result<std::unique_ptr<FrameRing>> FrameRing::create(Device& device, uint32_t frames_in_flight) {
    LOAM_CHECK(frames_in_flight > 0, "a ring needs a frame");
    std::unique_ptr<FrameRing> ring(new FrameRing(device));
    for (uint32_t i = 0; i < frames_in_flight; ++i) {
        ring->slots_.push_back(std::make_unique<Slot>());
        LOAM_TRY(ring->make_slot(*ring->slots_.back()));
    }
    return ring;
}

Status FrameRing::make_slot(Slot& slot) {
    auto pool = vk_struct<VkCommandPoolCreateInfo>(VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO);
    pool.queueFamilyIndex = device_.queue_family();
    if (const VkResult r = vkCreateCommandPool(device_.handle(), &pool, nullptr, &slot.command_pool);
        r != VK_SUCCESS)
        return vk_error("vkCreateCommandPool", r);
    auto buffer = vk_struct<VkCommandBufferAllocateInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO);
    buffer.commandPool = slot.command_pool;
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    if (const VkResult r = vkAllocateCommandBuffers(device_.handle(), &buffer, &slot.frame.commands.buffer_);
        r != VK_SUCCESS)
        return vk_error("vkAllocateCommandBuffers", r);
    auto queries = vk_struct<VkQueryPoolCreateInfo>(VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO);
    queries.queryType = VK_QUERY_TYPE_TIMESTAMP;
    queries.queryCount = 2 * kMaxTimedPasses;
    if (const VkResult r = vkCreateQueryPool(device_.handle(), &queries, nullptr, &slot.queries);
        r != VK_SUCCESS)
        return vk_error("vkCreateQueryPool", r);
    slot.frame.commands.ring_ = this;
    return {};
}

FrameRing::~FrameRing() {
    uint64_t last = 0;
    for (const auto& slot : slots_)
        if (slot->pending) last = std::max(last, slot->frame.number);
    // Failure means a lost device, which holds on to nothing.
    if (last > 0) (void)device_.wait_frame(last).ok();
    for (const auto& slot : slots_) {
        for (const VkDescriptorPool pool : slot->descriptor_pools)
            vkDestroyDescriptorPool(device_.handle(), pool, nullptr);
        vkDestroyQueryPool(device_.handle(), slot->queries, nullptr);
        vkDestroyCommandPool(device_.handle(), slot->command_pool, nullptr);
    }
    slots_.clear();
    if (last > 0) device_.collect(device_.finished_frame());
}

Result<Frame*> FrameRing::begin() {
    LOAM_CHECK(!current_, "the frame before was not ended");
    if (device_.lost()) return vk_error("beginning a frame", VK_ERROR_DEVICE_LOST);
    Slot& slot = *slots_[next_slot_];
    if (slot.pending) LOAM_TRY(device_.wait_frame(slot.frame.number));
    deliver_finished();
    device_.collect(device_.finished_frame());

    vkResetCommandPool(device_.handle(), slot.command_pool, 0);
    for (const VkDescriptorPool pool : slot.descriptor_pools)
        vkResetDescriptorPool(device_.handle(), pool, 0);
    slot.descriptor_pool = 0;
    slot.uploads.reset();
    slot.readback_memory.reset();
    slot.readbacks.clear();
    slot.pass_names.clear();
    auto info = vk_struct<VkCommandBufferBeginInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO);
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    if (const VkResult r = vkBeginCommandBuffer(slot.frame.commands.buffer_, &info); r != VK_SUCCESS)
        return vk_error("vkBeginCommandBuffer", r);
    vkCmdResetQueryPool(slot.frame.commands.buffer_, slot.queries, 0, 2 * kMaxTimedPasses);
    slot.frame.commands.bound_ = nullptr;
    slot.frame.number = device_.begin_frame_number();
    current_ = &slot;
    next_slot_ = (next_slot_ + 1) % slots_.size();
    return &slot.frame;
}

Status FrameRing::end(Frame& frame, const SubmitSync& sync) {
    LOAM_CHECK(current_ && &current_->frame == &frame, "end of a frame that is not being recorded");
    Slot& slot = *current_;
    current_ = nullptr;
    const VkCommandBuffer commands = frame.commands.buffer_;
    if (!slot.readbacks.empty()) {  // copies become visible to the host
        auto barrier = vk_struct<VkMemoryBarrier2>(VK_STRUCTURE_TYPE_MEMORY_BARRIER_2);
        barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
        barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
        auto dependency = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
        dependency.memoryBarrierCount = 1;
        dependency.pMemoryBarriers = &barrier;
        vkCmdPipelineBarrier2(commands, &dependency);
    }
    if (const VkResult r = vkEndCommandBuffer(commands); r != VK_SUCCESS)
        return vk_error("vkEndCommandBuffer", r);

    auto buffer = vk_struct<VkCommandBufferSubmitInfo>(VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO);
    buffer.commandBuffer = commands;
    auto wait = vk_struct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO);
    wait.semaphore = sync.wait_acquired;
    wait.stageMask =
        access_info(Access::present).stages;  // work before the window's image is touched runs on
    VkSemaphoreSubmitInfo signals[2] = {
        vk_struct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO),
        vk_struct<VkSemaphoreSubmitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO)};
    signals[0].semaphore = device_.timeline();
    signals[0].value = frame.number;
    signals[0].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    signals[1].semaphore = sync.signal_rendered;
    signals[1].stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    auto submit = vk_struct<VkSubmitInfo2>(VK_STRUCTURE_TYPE_SUBMIT_INFO_2);
    submit.waitSemaphoreInfoCount = sync.wait_acquired ? 1 : 0;
    submit.pWaitSemaphoreInfos = &wait;
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &buffer;
    submit.signalSemaphoreInfoCount = sync.signal_rendered ? 2 : 1;
    submit.pSignalSemaphoreInfos = signals;
    const VkResult r = vkQueueSubmit2(device_.queue(), 1, &submit, VK_NULL_HANDLE);
    if (r == VK_ERROR_DEVICE_LOST) device_.set_lost();
    if (r != VK_SUCCESS) return vk_error("submitting a frame", r);
    slot.pending = true;
    return {};
}

Status FrameRing::finish(Frame& frame) {
    const uint64_t number = frame.number;
    LOAM_TRY(end(frame));
    LOAM_TRY(device_.wait_frame(number));
    deliver_finished();
    device_.collect(device_.finished_frame());
    return {};
}

// next_slot_ is the oldest, so this goes in order of frames.
void FrameRing::deliver_finished() {
    const uint64_t finished = device_.finished_frame();
    for (size_t i = 0; i < slots_.size(); ++i) {
        Slot& slot = *slots_[(next_slot_ + i) % slots_.size()];
        if (slot.pending && slot.frame.number <= finished) deliver(slot);
    }
}

void FrameRing::deliver(Slot& slot) {
    slot.pending = false;
    if (device_.lost()) return;  // the memory holds nothing of worth
    std::vector<uint64_t> ticks(2 * slot.pass_names.size());
    pass_times_.clear();
    const bool timed =
        !ticks.empty() &&
        vkGetQueryPoolResults(device_.handle(), slot.queries, 0, static_cast<uint32_t>(ticks.size()),
                              ticks.size() * 8, ticks.data(), 8, VK_QUERY_RESULT_64_BIT) == VK_SUCCESS;
    for (size_t i = 0; timed && i < slot.pass_names.size(); ++i) {
        const uint64_t duration = ticks[2 * i + 1] - std::min(ticks[2 * i], ticks[2 * i + 1]);
        pass_times_.push_back(
            {slot.pass_names[i], static_cast<double>(duration) * device_.caps().timestamp_period_ns * 1e-6});
    }
    // A callback may ask for nothing of this slot: it is being read.
    auto readbacks = std::move(slot.readbacks);
    slot.readbacks.clear();
    for (const Slot::Readback& r : readbacks)
        r.done({r.slice.as<const std::byte>(), static_cast<size_t>(r.slice.size_bytes)});
}

UploadSlice FrameRing::upload(uint64_t size_bytes) {
    LOAM_CHECK(current_, "upload outside of a frame");
    auto slice = current_->uploads.take(device_, std::max<uint64_t>(size_bytes, 1));
    LOAM_CHECK(slice.ok(), slice.ok() ? "" : slice.message());
    return *slice;
}

void FrameRing::read_back(Commands& commands, Buffer& source, uint64_t offset, uint64_t size_bytes,
                          std::function<void(std::span<const std::byte>)> done) {
    LOAM_CHECK(current_, "readback outside of a frame");
    LOAM_CHECK(size_bytes > 0 && offset + size_bytes <= source.size_bytes(),
               fmt::format("{} bytes at {} of {}", size_bytes, offset, source.size_bytes()));
    auto slice = current_->readback_memory.take(device_, size_bytes);
    LOAM_CHECK(slice.ok(), slice.ok() ? "" : slice.message());
    commands.use({{source, Access::copy_source}});
    const VkBufferCopy region{offset, slice->offset, size_bytes};
    vkCmdCopyBuffer(commands.handle(), source.handle(), slice->buffer->handle(), 1, &region);
    current_->readbacks.push_back({*slice, std::move(done)});
}

void FrameRing::read_back(Commands& commands, Image& source,
                          std::function<void(std::span<const std::byte>)> done, uint32_t mip) {
    LOAM_CHECK(current_, "readback outside of a frame");
    const uint32_t width = std::max(source.width() >> mip, 1u), height = std::max(source.height() >> mip, 1u);
    // The depth aspect of either depth format is copied as 4 bytes a texel.
    const bool depth = (source.aspect() & VK_IMAGE_ASPECT_DEPTH_BIT) != 0;
    const VkImageAspectFlags aspect = depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
    const uint64_t size = depth ? uint64_t(width) * height * 4 : image_bytes(source.format(), width, height);
    LOAM_CHECK(size > 0 && (source.aspect() & aspect) != 0,
               fmt::format("no readback of format {}", static_cast<int>(source.format())));
    auto slice = current_->readback_memory.take(device_, size);
    LOAM_CHECK(slice.ok(), slice.ok() ? "" : slice.message());
    commands.use({{source, Access::copy_source}});
    VkBufferImageCopy region{};
    region.bufferOffset = slice->offset;
    region.imageSubresource = {aspect, mip, 0, 1};
    region.imageExtent = {width, height, 1};
    vkCmdCopyImageToBuffer(commands.handle(), source.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           slice->buffer->handle(), 1, &region);
    current_->readbacks.push_back({*slice, std::move(done)});
}

std::span<const PassTime> FrameRing::pass_times() const {
    return pass_times_;
}

uint64_t FrameRing::ring_bytes() const {
    uint64_t sum = 0;
    for (const auto& slot : slots_) sum += slot->uploads.bytes() + slot->readback_memory.bytes();
    return sum;
}

VkDescriptorSet FrameRing::allocate_set(VkDescriptorSetLayout layout) {
    LOAM_CHECK(current_, "bind outside of a frame");
    Slot& slot = *current_;
    for (;; ++slot.descriptor_pool) {
        const bool fresh = slot.descriptor_pool == slot.descriptor_pools.size();
        if (fresh) {
            VkDescriptorPool pool = VK_NULL_HANDLE;
            const Status made = create_descriptor_pool(device_.handle(), pool);
            LOAM_CHECK(made.ok(), made.ok() ? "" : made.message());
            slot.descriptor_pools.push_back(pool);
        }
        auto info = vk_struct<VkDescriptorSetAllocateInfo>(VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO);
        info.descriptorPool = slot.descriptor_pools[slot.descriptor_pool];
        info.descriptorSetCount = 1;
        info.pSetLayouts = &layout;
        VkDescriptorSet set = VK_NULL_HANDLE;
        const VkResult r = vkAllocateDescriptorSets(device_.handle(), &info, &set);
        if (r == VK_SUCCESS) return set;
        LOAM_CHECK(!fresh, vk_error("vkAllocateDescriptorSets", r).message);
    }
}

uint32_t FrameRing::open_timer(const char* name) {
    LOAM_CHECK(current_, "pass outside of a frame");
    if (current_->pass_names.size() == kMaxTimedPasses) return kNoQuery;
    const auto query = static_cast<uint32_t>(2 * current_->pass_names.size());
    current_->pass_names.push_back(name);
    vkCmdWriteTimestamp2(current_->frame.commands.buffer_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                         current_->queries, query);
    return query;
}

void FrameRing::close_timer(uint32_t query) {
    LOAM_CHECK(current_, "a pass outlived its frame");
    if (query == kNoQuery) return;
    vkCmdWriteTimestamp2(current_->frame.commands.buffer_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT,
                         current_->queries, query + 1);
}

}  // namespace loam::gpu
