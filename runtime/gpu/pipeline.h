// Pipelines. A pipeline names its shaders ("texture/compose.comp", a path under shaders/) and states its bindings
// (one descriptor set, set 0) and push constants. Live reload: when a shader file changes, ShaderLibrary compiles it
// with glslang and every pipeline made from it is rebuilt in place; on an error the old pipeline stays and the
// message is shown.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/gpu/device.h"

namespace loam::gpu {

struct Binding {
    uint32_t slot = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
};
[[nodiscard]] constexpr Binding sampled_image(uint32_t slot) { return {slot, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}; }
[[nodiscard]] constexpr Binding storage_image(uint32_t slot) { return {slot, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}; }
[[nodiscard]] constexpr Binding storage_buffer(uint32_t slot) { return {slot, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}; }
[[nodiscard]] constexpr Binding uniform_buffer(uint32_t slot) { return {slot, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}; }

struct SpecConstant {
    uint32_t id = 0;
    uint32_t value = 0; // bits
};

enum class Blend { none, alpha, premultiplied, additive };

struct ComputeDesc {
    std::string name;
    std::string shader;
    std::vector<Binding> bindings;
    uint32_t push_bytes = 0; // ≤ 128
    std::vector<SpecConstant> constants;
};

struct StencilDesc {
    bool enable = false;
    VkCompareOp compare = VK_COMPARE_OP_ALWAYS;
    VkStencilOp pass = VK_STENCIL_OP_KEEP;
    uint32_t reference = 0, read_mask = 0xff, write_mask = 0xff;
};

struct GraphicsDesc {
    std::string name;
    std::string vertex_shader, fragment_shader; // fragment may be empty: depth only
    std::vector<Binding> bindings;
    uint32_t push_bytes = 0;
    std::vector<SpecConstant> constants;
    std::vector<VkFormat> color_formats;
    std::vector<Blend> blends;                 // one a colour target; empty: none
    std::vector<VkColorComponentFlags> write_masks; // one a colour target; empty: all
    VkFormat depth_format = VK_FORMAT_UNDEFINED; // also the stencil format where it has one
    bool depth_test = false, depth_write = false;
    VkCompareOp depth_compare = VK_COMPARE_OP_GREATER; // reversed Z
    bool depth_bias = false;                   // dynamic: set with vkCmdSetDepthBias
    StencilDesc stencil;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkCullModeFlags cull = VK_CULL_MODE_NONE;
    VkFrontFace front = VK_FRONT_FACE_COUNTER_CLOCKWISE;
};

// No vertex input: shaders pull vertices from buffers. Viewport and scissor are dynamic.
class Pipeline {
  public:
    static Result<Pipeline> create(Device& device, const ComputeDesc& desc);
    static Result<Pipeline> create(Device& device, const GraphicsDesc& desc);
    Pipeline();
    Pipeline(Pipeline&& other) noexcept;
    Pipeline& operator=(Pipeline&& other) noexcept;
    ~Pipeline();

    [[nodiscard]] explicit operator bool() const { return state_ != nullptr; }
    [[nodiscard]] VkPipeline handle() const;
    [[nodiscard]] VkPipelineLayout layout() const;
    [[nodiscard]] VkDescriptorSetLayout set_layout() const;
    [[nodiscard]] VkPipelineBindPoint bind_point() const;
    [[nodiscard]] VkShaderStageFlags push_stages() const;
    [[nodiscard]] std::span<const Binding> bindings() const;

    struct State; // owned; also known to the device's PipelineSet for reload

  private:
    std::unique_ptr<State> state_;
};

} // namespace loam::gpu
