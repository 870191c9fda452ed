#include <algorithm>
#include <utility>

#include "runtime/gpu/resources.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

Result<Sampler> Sampler::create(Device& device, const SamplerDesc& desc) {
    const float anisotropy = std::min(desc.max_anisotropy, device.caps().max_anisotropy);
    auto info = vk_struct<VkSamplerCreateInfo>(VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO);
    info.magFilter = info.minFilter = desc.filter;
    info.mipmapMode = desc.mip_mode;
    info.addressModeU = info.addressModeV = info.addressModeW = desc.address;
    info.anisotropyEnable = anisotropy > 1.0f;
    info.maxAnisotropy = std::max(anisotropy, 1.0f);
    info.compareEnable = desc.compare_greater;
    info.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
    info.maxLod = desc.max_lod;
    Sampler sampler;
    sampler.device_ = &device;
    if (const VkResult r = vkCreateSampler(device.handle(), &info, nullptr, &sampler.sampler_);
        r != VK_SUCCESS)
        return vk_error("vkCreateSampler", r);
    return sampler;
}

Sampler::Sampler(Sampler&& other) noexcept
    : device_(other.device_), sampler_(std::exchange(other.sampler_, VK_NULL_HANDLE)) {}

Sampler& Sampler::operator=(Sampler&& other) noexcept {
    Sampler taken(std::move(other));
    std::swap(device_, taken.device_);
    std::swap(sampler_, taken.sampler_);
    return *this;
}

Sampler::~Sampler() {
    if (sampler_ == VK_NULL_HANDLE) return;
    device_->retire(
        [device = device_->handle(), sampler = sampler_] { vkDestroySampler(device, sampler, nullptr); });
}

}  // namespace loam::gpu
