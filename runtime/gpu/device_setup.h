// Steps of Device::create: instance, choice of the physical device, the logical device. Internal to
// runtime/gpu.
#pragma once

#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/gpu/device.h"

namespace loam::gpu {

struct InstanceSetup {
    VkInstance instance = VK_NULL_HANDLE;
    bool debug_utils = false;
};
Result<InstanceSetup> create_instance(const DeviceDesc& desc);

struct PhysicalSetup {
    VkPhysicalDevice physical = VK_NULL_HANDLE;
    uint32_t queue_family = 0;
    DeviceCaps caps;
    VkPhysicalDeviceLimits limits{};
};
Result<PhysicalSetup> choose_physical(VkInstance instance, const DeviceDesc& desc);

// Fails with the name of what the device lacks.
Result<VkDevice> create_logical(const PhysicalSetup& setup, const DeviceDesc& desc);

}  // namespace loam::gpu
