#include "runtime/gpu/device.h"

#include <algorithm>
#include <cstdio>

#include "runtime/base/log.h"
#include "runtime/gpu/device_setup.h"
#include "runtime/gpu/memory.h"
#include "runtime/gpu/pipeline_cache.h"
#include "runtime/gpu/pipeline_state.h"
#include "runtime/gpu/shader_library.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

namespace {

std::atomic<uint32_t> g_validation_messages{0};

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT severity,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    const bool bad = severity & VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    std::fprintf(stderr, "vulkan %s: %s\n", bad ? "error" : "warning", data->pMessage);
    static_cast<std::atomic<uint32_t>*>(user)->fetch_add(1);
    g_validation_messages.fetch_add(1);
    return VK_FALSE;
}

template <typename Function>
Function load(VkInstance instance, const char* name) {
    return reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
}

}  // namespace

uint32_t total_validation_messages() {
    return g_validation_messages.load();
}

Device::Device() = default;

Result<std::unique_ptr<Device>> Device::create(const DeviceDesc& desc) {
    std::unique_ptr<Device> device(new Device);  // destroyed half made on failure
    if (Status s = device->set_up(desc); !s) return s.error();
    return device;
}

Status Device::set_up(const DeviceDesc& desc) {
    auto instance = create_instance(desc);
    if (!instance) return instance.error();
    instance_ = instance->instance;
    if (desc.validation) {
        auto info = vk_struct<VkDebugUtilsMessengerCreateInfoEXT>(
            VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
        info.messageSeverity =
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
        info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
        info.pfnUserCallback = on_message;
        info.pUserData = &validation_messages_;
        const auto create =
            load<PFN_vkCreateDebugUtilsMessengerEXT>(instance_, "vkCreateDebugUtilsMessengerEXT");
        if (const VkResult r = create(instance_, &info, nullptr, &messenger_); r != VK_SUCCESS)
            return vk_error("listening to validation", r);
    }
    if (instance->debug_utils) {
        set_object_name_ = load<PFN_vkSetDebugUtilsObjectNameEXT>(instance_, "vkSetDebugUtilsObjectNameEXT");
        cmd_begin_label_ = load<PFN_vkCmdBeginDebugUtilsLabelEXT>(instance_, "vkCmdBeginDebugUtilsLabelEXT");
        cmd_end_label_ = load<PFN_vkCmdEndDebugUtilsLabelEXT>(instance_, "vkCmdEndDebugUtilsLabelEXT");
    }

    auto physical = choose_physical(instance_, desc);
    if (!physical) return physical.error();
    physical_ = physical->physical;
    queue_family_ = physical->queue_family;
    caps_ = physical->caps;
    limits_ = physical->limits;
    auto logical = create_logical(*physical, desc);
    if (!logical) return logical.error();
    device_ = *logical;
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);

    auto timeline = vk_struct<VkSemaphoreTypeCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
    timeline.semaphoreType = VK_SEMAPHORE_TYPE_TIMELINE;
    auto semaphore = vk_struct<VkSemaphoreCreateInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO);
    semaphore.pNext = &timeline;
    if (const VkResult r = vkCreateSemaphore(device_, &semaphore, nullptr, &timeline_); r != VK_SUCCESS)
        return vk_error("creating the frame semaphore", r);
    set_name(VK_OBJECT_TYPE_SEMAPHORE, reinterpret_cast<uint64_t>(timeline_), "frames");
    auto cache = load_pipeline_cache(physical_, device_);
    if (!cache) return cache.error();
    pipeline_cache_ = *cache;
    memory_ = std::make_unique<MemoryPools>(physical_, device_);
    shaders_ = std::make_unique<ShaderLibrary>();
    pipelines_ = std::make_unique<PipelineSet>();
    return {};
}

Device::~Device() {
    if (device_) {
        wait_idle();
        collect(UINT64_MAX);
        if (pipeline_cache_) {
            save_pipeline_cache(physical_, device_, pipeline_cache_);
            vkDestroyPipelineCache(device_, pipeline_cache_, nullptr);
        }
        if (timeline_) vkDestroySemaphore(device_, timeline_, nullptr);
        memory_.reset();
        vkDestroyDevice(device_, nullptr);
    }
    if (messenger_)
        load<PFN_vkDestroyDebugUtilsMessengerEXT>(instance_, "vkDestroyDebugUtilsMessengerEXT")(
            instance_, messenger_, nullptr);
    if (instance_) vkDestroyInstance(instance_, nullptr);
}

Result<Allocation> Device::allocate(const VkMemoryRequirements& needs, MemoryUse use, bool linear) {
    return memory_->allocate(needs, use, linear);
}

void Device::release(const Allocation& allocation) {
    memory_->release(allocation);
}

uint64_t Device::allocated_bytes(MemoryUse use) const {
    return memory_->used_bytes(use);
}

uint64_t Device::begin_frame_number() {
    return ++current_frame_;
}

void Device::retire(std::function<void()> destroy) {
    if (finished_frame() >= current_frame_)  // nothing recorded or running can use it
        destroy();
    else
        retired_.push_back({current_frame_, std::move(destroy)});
}

void Device::collect(uint64_t finished_frame) {
    // Tags only grow, so what has passed is a prefix. Closures may retire more: take them out first.
    const auto end =
        std::ranges::find_if(retired_, [&](const Retired& r) { return r.frame > finished_frame; });
    std::vector<Retired> passed(std::make_move_iterator(retired_.begin()), std::make_move_iterator(end));
    retired_.erase(retired_.begin(), end);
    for (Retired& r : passed) r.destroy();
}

uint64_t Device::finished_frame() const {
    uint64_t value = 0;
    if (lost_ || vkGetSemaphoreCounterValue(device_, timeline_, &value) != VK_SUCCESS)
        return current_frame_;  // a lost device runs nothing any more
    return value;
}

Status Device::wait_frame(uint64_t frame, uint64_t timeout_ns) {
    if (lost_) return vk_error("waiting for the GPU", VK_ERROR_DEVICE_LOST);
    auto info = vk_struct<VkSemaphoreWaitInfo>(VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO);
    info.semaphoreCount = 1;
    info.pSemaphores = &timeline_;
    info.pValues = &frame;
    const VkResult r = vkWaitSemaphores(device_, &info, timeout_ns);
    if (r == VK_ERROR_DEVICE_LOST) set_lost();
    if (r != VK_SUCCESS) return vk_error("waiting for the GPU", r);
    return {};
}

void Device::wait_idle() {
    if (vkDeviceWaitIdle(device_) == VK_ERROR_DEVICE_LOST) set_lost();
}

void Device::set_name(VkObjectType type, uint64_t handle, std::string_view name) {
    if (!set_object_name_ || name.empty()) return;
    const std::string text(name);
    auto info = vk_struct<VkDebugUtilsObjectNameInfoEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
    info.objectType = type;
    info.objectHandle = handle;
    info.pObjectName = text.c_str();
    set_object_name_(device_, &info);
}

void Device::begin_label(VkCommandBuffer commands, const char* name) {
    if (!cmd_begin_label_) return;
    auto label = vk_struct<VkDebugUtilsLabelEXT>(VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT);
    label.pLabelName = name;
    cmd_begin_label_(commands, &label);
}

void Device::end_label(VkCommandBuffer commands) {
    if (cmd_end_label_) cmd_end_label_(commands);
}

uint32_t Device::validation_message_count() const {
    return validation_messages_.load();
}

}  // namespace loam::gpu
