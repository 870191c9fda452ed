// The Vulkan 1.3 device: choice, queues (one), memory pools, retirement of raw objects, and the device profile.
//
// Ownership: every GPU object is a move-only RAII type. Its destructor hands the raw handle to the device together
// with the number of the frame that may still use it; the device destroys it when the GPU has passed that frame.
// Needs beyond Vulkan 1.3 core: scalarBlockLayout, independentBlend, fragmentStoresAndAtomics,
// shaderStorageImageExtendedFormats; textureCompressionBC is optional (`caps().bc`). One thread uses the device.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/base/result.h"

namespace loam::gpu {

// Sets defaults for what is dear or cheap on a device; chosen by the driver's id, overridable.
enum class Profile { software, gpu };

struct DeviceDesc {
    std::string device_filter;  // part of the device's name, or its index as digits; empty: best device
    bool validation = false;    // Khronos validation with synchronisation validation; messages are counted
    bool present = false;       // needs a swapchain (the window): enables VK_KHR_swapchain
    std::vector<const char*> instance_extensions; // what the window system needs
};

struct DeviceCaps {
    std::string name;
    Profile profile = Profile::gpu;
    bool bc = false;            // BC1, BC3, BC4 can be sampled
    float max_anisotropy = 1.0f;
    float timestamp_period_ns = 1.0f;
    VkFormat depth_stencil = VK_FORMAT_UNDEFINED; // D32_SFLOAT_S8_UINT or D24_UNORM_S8_UINT
};

// A piece of a memory block; see memory.h. `mapped` is null for MemoryUse::device, even where the host could see it.
struct Allocation {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0, size = 0;
    void* mapped = nullptr;
    uint32_t block = 0, pool = 0;
};

enum class MemoryUse { device, upload, readback };

class MemoryPools; // memory.h
class PipelineSet; // pipeline.cpp: live pipelines for hot reload
class ShaderLibrary;

class Device {
  public:
    static Result<std::unique_ptr<Device>> create(const DeviceDesc& desc);
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] VkInstance instance() const { return instance_; }
    [[nodiscard]] VkPhysicalDevice physical() const { return physical_; }
    [[nodiscard]] VkDevice handle() const { return device_; }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] uint32_t queue_family() const { return queue_family_; }
    [[nodiscard]] const DeviceCaps& caps() const { return caps_; }
    [[nodiscard]] const VkPhysicalDeviceLimits& limits() const { return limits_; }
    [[nodiscard]] VkPipelineCache pipeline_cache() const { return pipeline_cache_; }
    [[nodiscard]] ShaderLibrary& shaders() { return *shaders_; }
    [[nodiscard]] PipelineSet& pipelines() { return *pipelines_; }

    // Memory. Bytes in use are counted a use for `loam info` and the memory table.
    Result<Allocation> allocate(const VkMemoryRequirements& needs, MemoryUse use, bool linear);
    void release(const Allocation& allocation);
    [[nodiscard]] uint64_t allocated_bytes(MemoryUse use) const;

    // Frames. `begin_frame_number` is called by FrameRing; `retire` runs the closure once the GPU has finished
    // every frame that was submitted or is being recorded now.
    uint64_t begin_frame_number();
    void retire(std::function<void()> destroy);
    void collect(uint64_t finished_frame); // run what has been passed
    [[nodiscard]] VkSemaphore timeline() const { return timeline_; } // value = number of the last finished frame
    [[nodiscard]] uint64_t finished_frame() const;
    Status wait_frame(uint64_t frame, uint64_t timeout_ns = UINT64_MAX);
    void wait_idle(); // shutdown and tests only

    void set_name(VkObjectType type, uint64_t handle, std::string_view name);
    void begin_label(VkCommandBuffer commands, const char* name);
    void end_label(VkCommandBuffer commands);
    // Validation messages (errors and warnings) since start: tests demand 0.
    [[nodiscard]] uint32_t validation_message_count() const;

    // Set when the driver reports VK_ERROR_DEVICE_LOST; every later submit fails with the same sentence.
    [[nodiscard]] bool lost() const { return lost_; }
    void set_lost() { lost_ = true; }

  private:
    Device();
    Status set_up(const DeviceDesc& desc);
    struct Retired {
        uint64_t frame = 0; // the last that may use it
        std::function<void()> destroy;
    };
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    uint32_t queue_family_ = 0;
    VkPipelineCache pipeline_cache_ = VK_NULL_HANDLE;
    VkSemaphore timeline_ = VK_NULL_HANDLE;
    DeviceCaps caps_;
    VkPhysicalDeviceLimits limits_{};
    std::atomic<uint32_t> validation_messages_{0};
    PFN_vkSetDebugUtilsObjectNameEXT set_object_name_ = nullptr; // null without VK_EXT_debug_utils
    PFN_vkCmdBeginDebugUtilsLabelEXT cmd_begin_label_ = nullptr;
    PFN_vkCmdEndDebugUtilsLabelEXT cmd_end_label_ = nullptr;
    uint64_t current_frame_ = 0;
    bool lost_ = false;
    std::unique_ptr<MemoryPools> memory_;
    std::unique_ptr<ShaderLibrary> shaders_;
    std::unique_ptr<PipelineSet> pipelines_;
    std::vector<Retired> retired_;
};

// Of all devices of this process, those already destroyed included: what leaks shows at destruction.
[[nodiscard]] uint32_t total_validation_messages();

// Names of all Vulkan devices, in the order that DeviceDesc::device_filter numbers them; empty when there is no Vulkan.
[[nodiscard]] std::vector<std::string> device_names();

// One sentence for a Vulkan failure: "vkCreateImage failed: out of device memory".
[[nodiscard]] Error vk_error(std::string_view what, VkResult result);

} // namespace loam::gpu
