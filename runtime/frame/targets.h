// The pictures a frame is made in. They grow with the largest extent asked for and are not given back until
// then.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/base/result.h"
#include "runtime/gpu/resources.h"

namespace loam {

inline constexpr VkFormat kGbufferFormat = VK_FORMAT_R16G16B16A16_SFLOAT;  // see shaders/frame/frame_io.h
inline constexpr VkFormat kOcclusionFormat = VK_FORMAT_R8G8_UNORM;    // and the footprint's direction
inline constexpr VkFormat kPictureFormat = VK_FORMAT_R8G8B8A8_UNORM;  // holds sRGB-encoded colours

struct FrameTargets {
    gpu::Image depth, gbuffer, occlusion, picture;

    // Makes every target at least `extent`. Nothing happens when they are.
    Status ensure(gpu::Device& device, glm::uvec2 extent);
    [[nodiscard]] uint64_t bytes() const;
};

}  // namespace loam
