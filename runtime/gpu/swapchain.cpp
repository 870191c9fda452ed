#include "runtime/gpu/swapchain.h"
#include "runtime/gpu/vk_struct.h"

#include <algorithm>

namespace loam::gpu {

Swapchain::Swapchain(Device& device) : device_(device) {}

Result<std::unique_ptr<Swapchain>> Swapchain::create(Device& device, VkSurfaceKHR surface, uint32_t width,
                                                     uint32_t height) {
    VkBool32 supported = VK_FALSE;
    const VkResult r =
        vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queue_family(), surface, &supported);
    if (r != VK_SUCCESS) return vk_error("asking for the window's surface", r);
    if (!supported) return error("{} cannot show pictures in this window", device.caps().name);
    std::unique_ptr<Swapchain> swapchain(new Swapchain(device));
    swapchain->surface_ = surface;
    LOAM_TRY(swapchain->choose_format());
    // A window without an area gets its images when it has one.
    if (Status s = swapchain->recreate(width, height); !s && !s.message().starts_with("window has no area"))
        return s.error();
    return swapchain;
}

Swapchain::~Swapchain() {
    device_.wait_idle();  // presentation has no semaphore to wait for
    destroy_images();
    if (swapchain_) vkDestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
}

Status Swapchain::choose_format() {
    uint32_t count = 0;
    vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, nullptr);
    std::vector<VkSurfaceFormatKHR> formats(count);
    vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, formats.data());
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
        for (const VkSurfaceFormatKHR& f : formats)
            if (f.format == wanted && f.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
                format_ = wanted;
                return {};
            }
    return error("the window offers no 8-bit RGBA format");
}

void Swapchain::destroy_images() {
    for (const VkImageView view : views_) vkDestroyImageView(device_.handle(), view, nullptr);
    for (const VkSemaphore s : acquired_) vkDestroySemaphore(device_.handle(), s, nullptr);
    for (const VkSemaphore s : rendered_) vkDestroySemaphore(device_.handle(), s, nullptr);
    views_.clear();
    acquired_.clear();
    rendered_.clear();
    images_.clear();
}

Status Swapchain::recreate(uint32_t width, uint32_t height) {
    VkSurfaceCapabilitiesKHR caps;
    if (const VkResult r = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &caps);
        r != VK_SUCCESS)
        return vk_error("asking for the window's size", r);
    VkExtent2D extent = caps.currentExtent;
    if (extent.width == UINT32_MAX)  // the surface takes the size of the swapchain
        extent = {std::clamp(width, caps.minImageExtent.width, caps.maxImageExtent.width),
                  std::clamp(height, caps.minImageExtent.height, caps.maxImageExtent.height)};
    stale_ = true;  // until all is made
    if (extent.width == 0 || extent.height == 0 || width == 0 || height == 0)
        return error("window has no area ({} x {})", width, height);

    // Old images may still be shown, and only an idle device says that their semaphores are free.
    if (swapchain_) device_.wait_idle();
    auto info = vk_struct<VkSwapchainCreateInfoKHR>(VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR);
    info.surface = surface_;
    info.minImageCount = std::max(caps.minImageCount, 3u);
    if (caps.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, caps.maxImageCount);
    info.imageFormat = format_;
    info.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    info.imageExtent = extent;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = caps.currentTransform;
    info.compositeAlpha = caps.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_;
    VkSwapchainKHR made = VK_NULL_HANDLE;
    const VkResult r = vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &made);
    destroy_images();
    if (swapchain_) vkDestroySwapchainKHR(device_.handle(), swapchain_, nullptr);
    swapchain_ = made;  // null on failure: the old one was given up to the attempt
    if (r != VK_SUCCESS) return vk_error("creating the window's images", r);
    extent_ = extent;
    width_ = width;
    height_ = height;
    LOAM_TRY(make_images());
    stale_ = false;
    return {};
}

Status Swapchain::make_images() {
    uint32_t count = 0;
    vkGetSwapchainImagesKHR(device_.handle(), swapchain_, &count, nullptr);
    images_.resize(count);
    vkGetSwapchainImagesKHR(device_.handle(), swapchain_, &count, images_.data());
    views_.resize(count);
    rendered_.resize(count);
    acquired_.resize(count + 1);  // one is being waited for while all images are out
    next_acquire_ = 0;
    for (uint32_t i = 0; i < count; ++i) {
        auto view = vk_struct<VkImageViewCreateInfo>(VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO);
        view.image = images_[i];
        view.viewType = VK_IMAGE_VIEW_TYPE_2D;
        view.format = format_;
        view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
        if (const VkResult r = vkCreateImageView(device_.handle(), &view, nullptr, &views_[i]);
            r != VK_SUCCESS)
            return vk_error("vkCreateImageView", r);
    }
    for (auto* list : {&acquired_, &rendered_})
        for (VkSemaphore& s : *list) {
            const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO, nullptr, 0};
            if (const VkResult r = vkCreateSemaphore(device_.handle(), &info, nullptr, &s); r != VK_SUCCESS)
                return vk_error("vkCreateSemaphore", r);
        }
    return {};
}

Result<Swapchain::Target> Swapchain::acquire(uint32_t width, uint32_t height) {
    // Resizing by hand can outrun a recreation, so it is tried a few times.
    for (int attempt = 0; attempt < 3; ++attempt) {
        if (stale_ || !swapchain_ || width != width_ || height != height_) LOAM_TRY(recreate(width, height));
        Target target;
        target.acquired = acquired_[next_acquire_];
        const VkResult r = vkAcquireNextImageKHR(device_.handle(), swapchain_, UINT64_MAX, target.acquired,
                                                 VK_NULL_HANDLE, &target.index);
        if (r == VK_ERROR_OUT_OF_DATE_KHR) {
            stale_ = true;
            continue;
        }
        if (r == VK_ERROR_DEVICE_LOST) device_.set_lost();
        if (r != VK_SUCCESS && r != VK_SUBOPTIMAL_KHR) return vk_error("acquiring a window image", r);
        if (r == VK_SUBOPTIMAL_KHR) stale_ = true;  // this image is ours now: show it first
        next_acquire_ = (next_acquire_ + 1) % static_cast<uint32_t>(acquired_.size());
        target.image = images_[target.index];
        target.view = views_[target.index];
        target.extent = extent_;
        target.rendered = rendered_[target.index];
        return target;
    }
    return error("window has no area: its size keeps changing");
}

Status Swapchain::present(const Target& target) {
    auto info = vk_struct<VkPresentInfoKHR>(VK_STRUCTURE_TYPE_PRESENT_INFO_KHR);
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &target.rendered;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain_;
    info.pImageIndices = &target.index;
    const VkResult r = vkQueuePresentKHR(device_.queue(), &info);
    if (r == VK_ERROR_OUT_OF_DATE_KHR || r == VK_SUBOPTIMAL_KHR) {
        stale_ = true;
        return {};
    }
    if (r == VK_ERROR_DEVICE_LOST) device_.set_lost();
    if (r != VK_SUCCESS) return vk_error("showing a picture", r);
    return {};
}

}  // namespace loam::gpu
