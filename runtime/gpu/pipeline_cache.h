// The driver's pipeline cache, kept on disk a device. Internal to runtime/gpu.
#pragma once

#include <vulkan/vulkan_core.h>

#include "runtime/base/result.h"

namespace loam::gpu {

// Starts from the file if there is one that belongs to this device and driver, else empty.
Result<VkPipelineCache> load_pipeline_cache(VkPhysicalDevice physical, VkDevice device);
// Writes beside the file and renames. A folder that cannot be written costs a log line, no more.
void save_pipeline_cache(VkPhysicalDevice physical, VkDevice device, VkPipelineCache cache);

}  // namespace loam::gpu
