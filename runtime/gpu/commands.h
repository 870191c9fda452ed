// Recording. A pass is opened with what it reads and writes; the barriers follow from how each resource was used
// before. The same call opens the debug label and the timestamp.
//
//     auto pass = commands.pass("texture compose", {{scratch, Access::compute_storage}, {layers, Access::compute_sampled}});
//     commands.bind(pipeline, {{0, scratch.mip_view(0)}, {1, layers.view(), sampler}});
//     commands.push(params);                       // to the pipeline bound last
//     commands.dispatch(32, 32, 3);
#pragma once

#include <cstddef>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/base/check.h"
#include "runtime/gpu/pipeline.h"
#include "runtime/gpu/resources.h"

namespace loam::gpu {

struct Use {
    Use(Image& i, Access a) : image(&i), access(a) {}
    Use(Buffer& b, Access a) : buffer(&b), access(a) {}
    Image* image = nullptr;
    Buffer* buffer = nullptr;
    Access access;
};

// One descriptor: slot and what is there. Sampled images are read in SHADER_READ_ONLY (or
// DEPTH_STENCIL_READ_ONLY for Access::depth_sampled), storage in GENERAL. Images sampled in GENERAL say so.
struct Bound {
    Bound(uint32_t s, VkImageView view) : slot(s), image{VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL} {}
    Bound(uint32_t s, VkImageView view, const Sampler& sampler,
          VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
        : slot(s), image{sampler.handle(), view, layout} {}
    Bound(uint32_t s, const Buffer& b, uint64_t offset = 0, uint64_t range = VK_WHOLE_SIZE)
        : slot(s), buffer{b.handle(), offset, range} {}
    uint32_t slot;
    VkDescriptorImageInfo image{};
    VkDescriptorBufferInfo buffer{};
};

struct ColorTarget {
    VkImageView view = VK_NULL_HANDLE;
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkClearColorValue clear{};
};
struct DepthTarget {
    VkImageView view = VK_NULL_HANDLE; // null: none
    VkAttachmentLoadOp load = VK_ATTACHMENT_LOAD_OP_LOAD;
    VkClearDepthStencilValue clear{0.0f, 0};
    bool has_stencil = false;
    bool read_only = false; // layout of Access::depth_sampled
};

struct PassTime {
    std::string_view name; // static strings only
    double gpu_ms = 0;
};

class FrameRing;

class Commands {
  public:
    [[nodiscard]] VkCommandBuffer handle() const { return buffer_; }

    // Closes label and timestamp when destroyed. Name must be a string literal.
    class Pass {
      public:
        Pass(Commands& commands, uint32_t query);
        Pass(const Pass&) = delete;
        ~Pass();

      private:
        Commands& commands_;
        uint32_t query_;
    };
    [[nodiscard]] Pass pass(const char* name, std::initializer_list<Use> uses);
    [[nodiscard]] Pass pass(const char* name, std::span<const Use> uses);

    // The barrier alone, for uses that are not a pass of their own. Not inside begin_rendering … end_rendering.
    // A resource may be named twice only for two reads in one layout.
    void use(std::initializer_list<Use> uses);
    void use(std::span<const Use> uses);
    // For images that are not ours (the swapchain's): `before` undefined discards the contents.
    void transition(VkImage image, Access before, Access after);

    // Sets viewport and scissor to the whole extent.
    void begin_rendering(VkExtent2D extent, std::span<const ColorTarget> colors, const DepthTarget& depth = {});
    void end_rendering();
    void set_viewport(float x, float y, float width, float height); // viewport, and a scissor to match
    void set_scissor(int x, int y, uint32_t width, uint32_t height);

    void bind(const Pipeline& pipeline, std::initializer_list<Bound> bound);
    void bind(const Pipeline& pipeline, std::span<const Bound> bound);
    void push_bytes(const Pipeline& pipeline, const void* data, uint32_t size_bytes);
    template <typename T>
    void push(const Pipeline& pipeline, const T& data) {
        static_assert(sizeof(T) <= 128 && sizeof(T) % 4 == 0);
        push_bytes(pipeline, &data, sizeof(T));
    }
    template <typename T>
    void push(const T& data) {
        LOAM_CHECK(bound_ != nullptr, "push without a bound pipeline");
        push(*bound_, data);
    }

    void dispatch(uint32_t groups_x, uint32_t groups_y = 1, uint32_t groups_z = 1);
    void draw(uint32_t vertex_count, uint32_t instance_count = 1, uint32_t first_vertex = 0, uint32_t first_instance = 0);

    // One VkDrawIndirectCommand; the buffer was used with Access::indirect_args.
    void draw_indirect(const Buffer& arguments, uint64_t offset);

  private:
    friend class FrameRing;
    void close_pass(uint32_t query);
    FrameRing* ring_ = nullptr;
    VkCommandBuffer buffer_ = VK_NULL_HANDLE;
    const Pipeline* bound_ = nullptr; // since begin()
};

} // namespace loam::gpu
