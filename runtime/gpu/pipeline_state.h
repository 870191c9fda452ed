// What a Pipeline owns, and the set of live ones for reload. Internal to runtime/gpu.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "runtime/gpu/pipeline.h"

namespace loam::gpu {

struct Pipeline::State {
    State(Device& device, std::variant<ComputeDesc, GraphicsDesc> desc);
    ~State();
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    // Makes the VkPipeline from the shaders as they are now; on success the one before is retired.
    Status build();
    Status make_layout();
    [[nodiscard]] bool uses(std::string_view shader) const;
    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] std::span<const Binding> bindings() const;

    Device& device;
    std::variant<ComputeDesc, GraphicsDesc> desc;
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout set_layout = VK_NULL_HANDLE;
    VkShaderStageFlags stages = 0;
    uint32_t push_bytes = 0;
};

class PipelineSet {
  public:
    void add(Pipeline::State* state) { live_.push_back(state); }
    void remove(Pipeline::State* state) { std::erase(live_, state); }
    [[nodiscard]] std::span<Pipeline::State* const> live() const { return live_; }

  private:
    std::vector<Pipeline::State*> live_;
};

}  // namespace loam::gpu
