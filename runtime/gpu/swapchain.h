// The window's images. FIFO does not throttle everywhere, so the window limits its own rate.
#pragma once

#include <memory>
#include <vector>

#include "runtime/gpu/device.h"
#include "runtime/gpu/resources.h"

namespace loam::gpu {

class Swapchain {
  public:
    static Result<std::unique_ptr<Swapchain>> create(Device& device, VkSurfaceKHR surface, uint32_t width, uint32_t height);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;

    struct Target {
        uint32_t index = 0;
        VkImage image = VK_NULL_HANDLE;
        VkImageView view = VK_NULL_HANDLE;
        VkExtent2D extent{};
        VkSemaphore acquired = VK_NULL_HANDLE, rendered = VK_NULL_HANDLE;
    };
    // Recreates itself when the window has changed size. An error when the surface is gone, or, starting with
    // "window has no area", while there is nothing to draw on. Call it before FrameRing::begin, or end that frame.
    Result<Target> acquire(uint32_t width, uint32_t height);
    // The image must be in PRESENT_SRC layout by then. SUBOPTIMAL marks it for recreation.
    Status present(const Target& target);
    [[nodiscard]] VkFormat format() const { return format_; } // an 8-bit UNORM format; colours are written sRGB-encoded

  private:
    explicit Swapchain(Device& device);
    Status choose_format();
    Status recreate(uint32_t width, uint32_t height);
    Status make_images();
    void destroy_images();
    Device& device_;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
    VkFormat format_ = VK_FORMAT_UNDEFINED;
    VkExtent2D extent_{};
    uint32_t width_ = 0, height_ = 0; // as asked for; the surface may decide otherwise
    std::vector<VkImage> images_;
    std::vector<VkImageView> views_;
    std::vector<VkSemaphore> acquired_, rendered_;
    uint32_t next_acquire_ = 0;
    bool stale_ = false;
};

} // namespace loam::gpu
