#include <utility>

#include "runtime/base/check.h"
#include "runtime/gpu/resources.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

Result<Buffer> Buffer::create(Device& device, const BufferDesc& desc) {
    LOAM_CHECK(desc.size_bytes > 0, std::string(desc.name));
    Buffer buffer;
    buffer.device_ = &device;
    buffer.size_bytes_ = desc.size_bytes;
    auto info = vk_struct<VkBufferCreateInfo>(VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO);
    info.size = desc.size_bytes;
    info.usage = desc.usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (const VkResult r = vkCreateBuffer(device.handle(), &info, nullptr, &buffer.buffer_); r != VK_SUCCESS)
        return vk_error(fmt::format("creating buffer \"{}\"", desc.name), r);
    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), buffer.buffer_, &needs);
    auto memory = device.allocate(needs, desc.memory, true);
    if (!memory) return error("buffer \"{}\": {}", desc.name, memory.message());
    buffer.allocation_ = *memory;
    const VkResult r = vkBindBufferMemory(device.handle(), buffer.buffer_, buffer.allocation_.memory,
                                          buffer.allocation_.offset);
    if (r != VK_SUCCESS) return vk_error(fmt::format("binding buffer \"{}\"", desc.name), r);
    device.set_name(VK_OBJECT_TYPE_BUFFER, reinterpret_cast<uint64_t>(buffer.buffer_), desc.name);
    return buffer;
}

Buffer::Buffer(Buffer&& other) noexcept {
    swap(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
    Buffer taken(std::move(other));
    swap(taken);
    return *this;
}

Buffer::~Buffer() {
    retire();
}

void Buffer::swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(buffer_, other.buffer_);
    std::swap(size_bytes_, other.size_bytes_);
    std::swap(allocation_, other.allocation_);
    std::swap(last_access, other.last_access);
    std::swap(sync, other.sync);
}

void Buffer::retire() {
    if (buffer_ == VK_NULL_HANDLE) return;
    device_->retire([device = device_, buffer = buffer_, allocation = allocation_] {
        vkDestroyBuffer(device->handle(), buffer, nullptr);
        device->release(allocation);
    });
    buffer_ = VK_NULL_HANDLE;
}

}  // namespace loam::gpu
