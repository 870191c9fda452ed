#include "runtime/gpu/device_setup.h"
#include "runtime/gpu/vk_struct.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace loam::gpu {

namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

std::vector<VkExtensionProperties> instance_extensions(const char* layer) {
    uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
    std::vector<VkExtensionProperties> found(count);
    vkEnumerateInstanceExtensionProperties(layer, &count, found.data());
    return found;
}

bool has_extension(const std::vector<VkExtensionProperties>& list, const char* name) {
    return std::ranges::any_of(list, [&](const auto& e) { return std::strcmp(e.extensionName, name) == 0; });
}

bool has_validation_layer() {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(
        layers, [](const auto& layer) { return std::strcmp(layer.layerName, kValidationLayer) == 0; });
}

int type_rank(VkPhysicalDeviceType type) {
    switch (type) {
        case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
            return 0;
        case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
            return 1;
        case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
            return 2;
        default:
            return 3;
    }
}

std::string lower(std::string_view text) {
    std::string out(text);
    std::ranges::transform(out, out.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

VkFormat pick_depth_stencil(VkPhysicalDevice physical) {
    for (const VkFormat format : {VK_FORMAT_D32_SFLOAT_S8_UINT, VK_FORMAT_D24_UNORM_S8_UINT}) {
        VkFormatProperties properties;
        vkGetPhysicalDeviceFormatProperties(physical, format, &properties);
        constexpr VkFormatFeatureFlags kNeeds =
            VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT;
        if ((properties.optimalTilingFeatures & kNeeds) == kNeeds) return format;
    }
    return VK_FORMAT_UNDEFINED;
}

Result<uint32_t> find_queue_family(VkPhysicalDevice physical) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags kNeeds = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & kNeeds) == kNeeds) return i;
    return error("the device has no queue for graphics and compute");
}

// The chain of feature structs, linked for a query and again for vkCreateDevice.
struct Features {
    VkPhysicalDeviceFeatures2 core =
        vk_struct<VkPhysicalDeviceFeatures2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2);
    VkPhysicalDeviceVulkan11Features v11 =
        vk_struct<VkPhysicalDeviceVulkan11Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_FEATURES);
    VkPhysicalDeviceVulkan12Features v12 =
        vk_struct<VkPhysicalDeviceVulkan12Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES);
    VkPhysicalDeviceVulkan13Features v13 =
        vk_struct<VkPhysicalDeviceVulkan13Features>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES);
    Features() {
        core.pNext = &v11;
        v11.pNext = &v12;
        v12.pNext = &v13;
    }
    Features(const Features&) = delete;
    Features& operator=(const Features&) = delete;
};

// Turns on in `on` what is there: first what Loam cannot do without, then what it uses where it is.
Status select_features(const Features& there, Features& on) {
    std::string missing;
    const auto need = [&](const char* name, VkBool32 supported, VkBool32& enable) {
        enable = supported;
        if (!supported) missing += missing.empty() ? name : std::string(", ") + name;
    };
    const VkPhysicalDeviceFeatures& core = there.core.features;
    need("independentBlend", core.independentBlend, on.core.features.independentBlend);
    need("fragmentStoresAndAtomics", core.fragmentStoresAndAtomics,
         on.core.features.fragmentStoresAndAtomics);
    need("shaderStorageImageExtendedFormats", core.shaderStorageImageExtendedFormats,
         on.core.features.shaderStorageImageExtendedFormats);
    need("scalarBlockLayout", there.v12.scalarBlockLayout, on.v12.scalarBlockLayout);
    need("timelineSemaphore", there.v12.timelineSemaphore, on.v12.timelineSemaphore);
    need("synchronization2", there.v13.synchronization2, on.v13.synchronization2);
    need("dynamicRendering", there.v13.dynamicRendering, on.v13.dynamicRendering);
    // What glslang emits for Vulkan 1.3 without being asked: local sizes by id, discard.
    need("maintenance4", there.v13.maintenance4, on.v13.maintenance4);
    need("shaderTerminateInvocation", there.v13.shaderTerminateInvocation, on.v13.shaderTerminateInvocation);
    need("shaderDemoteToHelperInvocation", there.v13.shaderDemoteToHelperInvocation,
         on.v13.shaderDemoteToHelperInvocation);
    if (!missing.empty()) return error("the device lacks {}", missing);

    on.core.features.samplerAnisotropy = core.samplerAnisotropy;
    on.core.features.textureCompressionBC = core.textureCompressionBC;
    on.core.features.multiDrawIndirect = core.multiDrawIndirect;
    on.core.features.drawIndirectFirstInstance = core.drawIndirectFirstInstance;
    on.core.features.shaderStorageImageWriteWithoutFormat = core.shaderStorageImageWriteWithoutFormat;
    on.v11.shaderDrawParameters = there.v11.shaderDrawParameters;
    on.v12.drawIndirectCount = there.v12.drawIndirectCount;
    return {};
}

}  // namespace

Result<InstanceSetup> create_instance(const DeviceDesc& desc) {
    InstanceSetup setup;
    std::vector<const char*> extensions = desc.instance_extensions;
    std::vector<const char*> layers;
    setup.debug_utils = has_extension(instance_extensions(nullptr), VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    constexpr VkValidationFeatureEnableEXT kEnable =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    auto features = vk_struct<VkValidationFeaturesEXT>(VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT);
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &kEnable;
    if (desc.validation) {
        if (!has_validation_layer())
            return error("validation was asked for, but {} is not installed", kValidationLayer);
        layers.push_back(kValidationLayer);
        const auto of_layer = instance_extensions(kValidationLayer);
        if (has_extension(of_layer, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME))
            extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
        setup.debug_utils |= has_extension(of_layer, VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        if (!setup.debug_utils) return error("validation was asked for, but VK_EXT_debug_utils is missing");
    }
    if (setup.debug_utils) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);

    auto application = vk_struct<VkApplicationInfo>(VK_STRUCTURE_TYPE_APPLICATION_INFO);
    application.pApplicationName = "Loam";
    application.pEngineName = "Loam";
    application.apiVersion = VK_API_VERSION_1_3;
    auto info = vk_struct<VkInstanceCreateInfo>(VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO);
    info.pNext = desc.validation ? &features : nullptr;
    info.pApplicationInfo = &application;
    info.enabledLayerCount = static_cast<uint32_t>(layers.size());
    info.ppEnabledLayerNames = layers.data();
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (const VkResult r = vkCreateInstance(&info, nullptr, &setup.instance); r != VK_SUCCESS)
        return vk_error("starting Vulkan 1.3", r);
    return setup;
}

Result<PhysicalSetup> choose_physical(VkInstance instance, const DeviceDesc& desc) {
    uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> devices(count);
    vkEnumeratePhysicalDevices(instance, &count, devices.data());
    if (devices.empty()) return error("no Vulkan device was found");

    const std::string& filter = desc.device_filter;
    const bool by_index =
        !filter.empty() && std::ranges::all_of(filter, [](unsigned char c) { return std::isdigit(c); });
    std::string names;
    int best = -1, best_rank = 0;
    for (uint32_t i = 0; i < count; ++i) {
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(devices[i], &properties);
        names += fmt::format("{}{}: {}", i ? ", " : "", i, properties.deviceName);
        const bool fits = filter.empty() ||
                          (by_index ? filter == std::to_string(i)
                                    : lower(properties.deviceName).find(lower(filter)) != std::string::npos);
        // Too old a driver is passed over unless it was named.
        if (!fits || (filter.empty() && properties.apiVersion < VK_API_VERSION_1_3)) continue;
        const int rank = type_rank(properties.deviceType);
        if (best < 0 || rank < best_rank) {
            best = static_cast<int>(i);
            best_rank = rank;
        }
    }
    if (best < 0 && filter.empty()) return error("no device supports Vulkan 1.3, there are {}", names);
    if (best < 0) return error("no device matches \"{}\", there are {}", filter, names);

    PhysicalSetup setup;
    setup.physical = devices[best];
    auto driver =
        vk_struct<VkPhysicalDeviceDriverProperties>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES);
    auto properties = vk_struct<VkPhysicalDeviceProperties2>(VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2);
    properties.pNext = &driver;
    vkGetPhysicalDeviceProperties2(setup.physical, &properties);
    const VkPhysicalDeviceProperties& base = properties.properties;
    setup.caps.name = base.deviceName;
    if (base.apiVersion < VK_API_VERSION_1_3)
        return error("{} supports Vulkan {}.{} only, Loam needs 1.3", setup.caps.name,
                     VK_API_VERSION_MAJOR(base.apiVersion), VK_API_VERSION_MINOR(base.apiVersion));
    const bool software = driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE ||
                          driver.driverID == VK_DRIVER_ID_GOOGLE_SWIFTSHADER ||
                          base.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    setup.caps.profile = software ? Profile::software : Profile::gpu;
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(setup.physical, &features);
    setup.caps.bc = features.textureCompressionBC;
    setup.caps.max_anisotropy = features.samplerAnisotropy ? base.limits.maxSamplerAnisotropy : 1.0f;
    setup.caps.timestamp_period_ns = base.limits.timestampPeriod;
    setup.caps.depth_stencil = pick_depth_stencil(setup.physical);
    setup.limits = base.limits;
    if (setup.caps.depth_stencil == VK_FORMAT_UNDEFINED)
        return error("{} has no depth format with stencil", setup.caps.name);
    auto family = find_queue_family(setup.physical);
    if (!family) return family.error();
    setup.queue_family = *family;
    return setup;
}

Result<VkDevice> create_logical(const PhysicalSetup& setup, const DeviceDesc& desc) {
    Features there, on;
    vkGetPhysicalDeviceFeatures2(setup.physical, &there.core);
    if (Status s = select_features(there, on); !s) return error("{}: {}", setup.caps.name, s.message());

    const float priority = 1.0f;
    auto queue = vk_struct<VkDeviceQueueCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO);
    queue.queueFamilyIndex = setup.queue_family;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    const char* extensions[] = {VK_KHR_SWAPCHAIN_EXTENSION_NAME};
    auto info = vk_struct<VkDeviceCreateInfo>(VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO);
    info.pNext = &on.core;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = desc.present ? 1 : 0;
    info.ppEnabledExtensionNames = extensions;
    VkDevice device = VK_NULL_HANDLE;
    if (const VkResult r = vkCreateDevice(setup.physical, &info, nullptr, &device); r != VK_SUCCESS)
        return vk_error(fmt::format("opening {}", setup.caps.name), r);
    return device;
}

std::vector<std::string> device_names() {
    auto setup = create_instance({});
    if (!setup) return {};
    uint32_t count = 0;
    std::vector<std::string> names;
    if (vkEnumeratePhysicalDevices(setup->instance, &count, nullptr) == VK_SUCCESS) {
        std::vector<VkPhysicalDevice> devices(count);
        vkEnumeratePhysicalDevices(setup->instance, &count, devices.data());
        for (VkPhysicalDevice device : devices) {
            VkPhysicalDeviceProperties properties{};
            vkGetPhysicalDeviceProperties(device, &properties);
            names.emplace_back(properties.deviceName);
        }
    }
    vkDestroyInstance(setup->instance, nullptr);
    return names;
}

}  // namespace loam::gpu
