#include "runtime/gpu/commands.h"

#include <algorithm>
#include <array>

#include "runtime/base/check.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

namespace {

constexpr size_t kMaxColorTargets = 8;
constexpr size_t kMaxBound = 32;

// A last_access set by hand (contents given up, or used outside Commands) takes the place of what was
// tracked.
template <typename Resource>
std::optional<BarrierMasks> next_use(Resource& resource, Access access, bool is_image) {
    if (resource.last_access == Access::undefined) resource.sync.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    resource.last_access = access;
    return advance(resource.sync, access, is_image);
}

VkImageMemoryBarrier2 image_barrier(const BarrierMasks& masks, VkImage image, VkImageAspectFlags aspect) {
    auto barrier = vk_struct<VkImageMemoryBarrier2>(VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2);
    barrier.srcStageMask = masks.source_stages;
    barrier.srcAccessMask = masks.source_access;
    barrier.dstStageMask = masks.target_stages;
    barrier.dstAccessMask = masks.target_access;
    barrier.oldLayout = masks.old_layout;
    barrier.newLayout = masks.new_layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    return barrier;
}

VkBufferMemoryBarrier2 buffer_barrier(const BarrierMasks& masks, VkBuffer buffer) {
    auto barrier = vk_struct<VkBufferMemoryBarrier2>(VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER_2);
    barrier.srcStageMask = masks.source_stages;
    barrier.srcAccessMask = masks.source_access;
    barrier.dstStageMask = masks.target_stages;
    barrier.dstAccessMask = masks.target_access;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.buffer = buffer;
    barrier.size = VK_WHOLE_SIZE;
    return barrier;
}

// Barriers of one batch are not ordered among themselves, so a resource cannot go through two states in one.
void check_conflicts(std::span<const Use> uses) {
    for (size_t i = 0; i < uses.size(); ++i)
        for (size_t j = 0; j < i; ++j) {
            const bool image = uses[i].image != nullptr;
            if (image ? uses[i].image != uses[j].image : uses[i].buffer != uses[j].buffer) continue;
            LOAM_CHECK(!needs_barrier(uses[j].access, uses[i].access, image),
                       fmt::format("one resource used as {} and as {} in one pass",
                                   static_cast<int>(uses[j].access), static_cast<int>(uses[i].access)));
        }
}

}  // namespace

Commands::Pass::Pass(Commands& commands, uint32_t query) : commands_(commands), query_(query) {}

Commands::Pass::~Pass() {
    commands_.close_pass(query_);
}

Commands::Pass Commands::pass(const char* name, std::initializer_list<Use> uses) {
    return pass(name, std::span(uses.begin(), uses.size()));
}

Commands::Pass Commands::pass(const char* name, std::span<const Use> uses) {
    ring_->device().begin_label(buffer_, name);
    const uint32_t query = ring_->open_timer(name);
    use(uses);
    return Pass(*this, query);
}

void Commands::close_pass(uint32_t query) {
    ring_->close_timer(query);
    ring_->device().end_label(buffer_);
}

void Commands::use(std::initializer_list<Use> uses) {
    use(std::span(uses.begin(), uses.size()));
}

void Commands::use(std::span<const Use> uses) {
    check_conflicts(uses);
    std::vector<VkImageMemoryBarrier2> images;
    std::vector<VkBufferMemoryBarrier2> buffers;
    for (const Use& u : uses) {
        if (u.image) {
            LOAM_CHECK(bool(*u.image), "use of an image that does not exist");
            if (const auto masks = next_use(*u.image, u.access, true))
                images.push_back(image_barrier(*masks, u.image->handle(), u.image->aspect()));
        } else {
            LOAM_CHECK(bool(*u.buffer), "use of a buffer that does not exist");
            if (const auto masks = next_use(*u.buffer, u.access, false))
                buffers.push_back(buffer_barrier(*masks, u.buffer->handle()));
        }
    }
    if (images.empty() && buffers.empty()) return;
    auto info = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.imageMemoryBarrierCount = static_cast<uint32_t>(images.size());
    info.pImageMemoryBarriers = images.data();
    info.bufferMemoryBarrierCount = static_cast<uint32_t>(buffers.size());
    info.pBufferMemoryBarriers = buffers.data();
    vkCmdPipelineBarrier2(buffer_, &info);
}

void Commands::transition(VkImage image, Access before, Access after) {
    // The stages of `present` are those that wait for the acquired image: what was undefined waits for them
    // too.
    SyncState state = state_after(before == Access::undefined ? Access::present : before);
    if (before == Access::undefined) state.layout = VK_IMAGE_LAYOUT_UNDEFINED;
    const auto masks = advance(state, after, true);
    if (!masks) return;
    const VkImageMemoryBarrier2 barrier = image_barrier(*masks, image, VK_IMAGE_ASPECT_COLOR_BIT);
    auto info = vk_struct<VkDependencyInfo>(VK_STRUCTURE_TYPE_DEPENDENCY_INFO);
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(buffer_, &info);
}

void Commands::begin_rendering(VkExtent2D extent, std::span<const ColorTarget> colors,
                               const DepthTarget& depth) {
    LOAM_CHECK(colors.size() <= kMaxColorTargets, fmt::format("{} colour targets", colors.size()));
    std::array<VkRenderingAttachmentInfo, kMaxColorTargets> attachments{};
    for (size_t i = 0; i < colors.size(); ++i) {
        attachments[i].sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO;
        attachments[i].imageView = colors[i].view;
        attachments[i].imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        attachments[i].loadOp = colors[i].load;
        attachments[i].storeOp = VK_ATTACHMENT_STORE_OP_STORE;
        attachments[i].clearValue.color = colors[i].clear;
    }
    auto depth_info = vk_struct<VkRenderingAttachmentInfo>(VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO);
    depth_info.imageView = depth.view;
    depth_info.imageLayout = depth.read_only ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                             : VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
    depth_info.loadOp = depth.load;
    // A store counts as a write, which a read-only target that is sampled at the same time must not have.
    depth_info.storeOp = depth.read_only ? VK_ATTACHMENT_STORE_OP_NONE : VK_ATTACHMENT_STORE_OP_STORE;
    depth_info.clearValue.depthStencil = depth.clear;
    auto info = vk_struct<VkRenderingInfo>(VK_STRUCTURE_TYPE_RENDERING_INFO);
    info.renderArea = {{0, 0}, extent};
    info.layerCount = 1;
    info.colorAttachmentCount = static_cast<uint32_t>(colors.size());
    info.pColorAttachments = attachments.data();
    info.pDepthAttachment = depth.view ? &depth_info : nullptr;
    info.pStencilAttachment = depth.view && depth.has_stencil ? &depth_info : nullptr;
    vkCmdBeginRendering(buffer_, &info);
    set_viewport(0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height));
}

void Commands::end_rendering() {
    vkCmdEndRendering(buffer_);
}

void Commands::set_viewport(float x, float y, float width, float height) {
    const VkViewport viewport{x, y, width, height, 0.0f, 1.0f};
    vkCmdSetViewport(buffer_, 0, 1, &viewport);
    set_scissor(static_cast<int>(x), static_cast<int>(y), static_cast<uint32_t>(width),
                static_cast<uint32_t>(height));
}

void Commands::set_scissor(int x, int y, uint32_t width, uint32_t height) {
    const VkRect2D scissor{{x, y}, {width, height}};
    vkCmdSetScissor(buffer_, 0, 1, &scissor);
}

void Commands::bind(const Pipeline& pipeline, std::initializer_list<Bound> bound) {
    bind(pipeline, std::span(bound.begin(), bound.size()));
}

void Commands::bind(const Pipeline& pipeline, std::span<const Bound> bound) {
    LOAM_CHECK(bool(pipeline), "bind of a pipeline that does not exist");
    LOAM_CHECK(bound.size() <= kMaxBound, fmt::format("{} descriptors", bound.size()));
    bound_ = &pipeline;
    vkCmdBindPipeline(buffer_, pipeline.bind_point(), pipeline.handle());
    if (bound.empty()) return;
    const VkDescriptorSet set = ring_->allocate_set(pipeline.set_layout());
    std::array<VkWriteDescriptorSet, kMaxBound> writes;
    for (size_t i = 0; i < bound.size(); ++i) {
        const Bound& b = bound[i];
        const auto binding = std::ranges::find(pipeline.bindings(), b.slot, &Binding::slot);
        LOAM_CHECK(binding != pipeline.bindings().end(), fmt::format("the pipeline has no slot {}", b.slot));
        const bool is_image = binding->type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER ||
                              binding->type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
        LOAM_CHECK((is_image ? uint64_t(b.image.imageView) : uint64_t(b.buffer.buffer)) != 0,
                   fmt::format("slot {} got nothing, or the wrong kind of resource", b.slot));
        LOAM_CHECK(binding->type != VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER || b.image.sampler,
                   fmt::format("slot {} needs a sampler", b.slot));
        writes[i] = {.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                     .pNext = nullptr,
                     .dstSet = set,
                     .dstBinding = b.slot,
                     .dstArrayElement = 0,
                     .descriptorCount = 1,
                     .descriptorType = binding->type,
                     .pImageInfo = is_image ? &b.image : nullptr,
                     .pBufferInfo = is_image ? nullptr : &b.buffer,
                     .pTexelBufferView = nullptr};
    }
    vkUpdateDescriptorSets(ring_->device().handle(), static_cast<uint32_t>(bound.size()), writes.data(), 0,
                           nullptr);
    vkCmdBindDescriptorSets(buffer_, pipeline.bind_point(), pipeline.layout(), 0, 1, &set, 0, nullptr);
}

void Commands::push_bytes(const Pipeline& pipeline, const void* data, uint32_t size_bytes) {
    vkCmdPushConstants(buffer_, pipeline.layout(), pipeline.push_stages(), 0, size_bytes, data);
}

void Commands::dispatch(uint32_t groups_x, uint32_t groups_y, uint32_t groups_z) {
    vkCmdDispatch(buffer_, groups_x, groups_y, groups_z);
}

void Commands::draw(uint32_t vertex_count, uint32_t instance_count, uint32_t first_vertex,
                    uint32_t first_instance) {
    vkCmdDraw(buffer_, vertex_count, instance_count, first_vertex, first_instance);
}

void Commands::draw_indirect(const Buffer& arguments, uint64_t offset) {
    vkCmdDrawIndirect(buffer_, arguments.handle(), offset, 1, sizeof(VkDrawIndirectCommand));
}

}  // namespace loam::gpu
