#include "runtime/gpu/pipeline_cache.h"

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include <unistd.h>

#include "runtime/base/log.h"
#include "runtime/gpu/device.h"
#include "runtime/gpu/vk_struct.h"

namespace loam::gpu {

namespace {

namespace fs = std::filesystem;

fs::path cache_path(const VkPhysicalDeviceProperties& properties) {
    fs::path folder;
    if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && xdg[0] == '/')
        folder = xdg;
    else if (const char* home = std::getenv("HOME"); home && home[0])
        folder = fs::path(home) / ".cache";
    else
        return {};
    std::string id;
    for (const uint8_t byte : properties.pipelineCacheUUID) id += fmt::format("{:02x}", byte);
    return folder / "loam" /
           fmt::format("pipelines-{:04x}-{:04x}-{}.bin", properties.vendorID, properties.deviceID, id);
}

// Drivers ought to check this themselves; not all have.
bool header_fits(const std::vector<char>& bytes, const VkPhysicalDeviceProperties& properties) {
    VkPipelineCacheHeaderVersionOne header;
    if (bytes.size() < sizeof(header)) return false;
    std::memcpy(&header, bytes.data(), sizeof(header));
    return header.headerSize == sizeof(header) &&
           header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
           header.vendorID == properties.vendorID && header.deviceID == properties.deviceID &&
           std::memcmp(header.pipelineCacheUUID, properties.pipelineCacheUUID, VK_UUID_SIZE) == 0;
}

}  // namespace

Result<VkPipelineCache> load_pipeline_cache(VkPhysicalDevice physical, VkDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    std::vector<char> bytes;
    if (const fs::path path = cache_path(properties); !path.empty())
        if (std::ifstream file(path, std::ios::binary); file)
            bytes.assign(std::istreambuf_iterator<char>(file), {});
    if (!header_fits(bytes, properties)) bytes.clear();

    auto info = vk_struct<VkPipelineCacheCreateInfo>(VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO);
    info.initialDataSize = bytes.size();
    info.pInitialData = bytes.data();
    VkPipelineCache cache = VK_NULL_HANDLE;
    VkResult r = vkCreatePipelineCache(device, &info, nullptr, &cache);
    if (r != VK_SUCCESS && !bytes.empty()) {
        info.initialDataSize = 0;
        r = vkCreatePipelineCache(device, &info, nullptr, &cache);
    }
    if (r != VK_SUCCESS) return vk_error("creating the pipeline cache", r);
    return cache;
}

void save_pipeline_cache(VkPhysicalDevice physical, VkDevice device, VkPipelineCache cache) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    const fs::path path = cache_path(properties);
    size_t size = 0;
    if (path.empty() || vkGetPipelineCacheData(device, cache, &size, nullptr) != VK_SUCCESS || size == 0)
        return;
    std::vector<char> bytes(size);
    if (vkGetPipelineCacheData(device, cache, &size, bytes.data()) != VK_SUCCESS) return;

    std::error_code failed;
    fs::create_directories(path.parent_path(), failed);
    fs::path part = path;
    part += fmt::format(".{}", ::getpid());  // two processes may stop at once
    bool written = false;
    if (!failed) {
        std::ofstream file(part, std::ios::binary | std::ios::trunc);
        file.write(bytes.data(), static_cast<std::streamsize>(size));
        written = file.flush().good();
    }
    if (written) fs::rename(part, path, failed);
    if (!written || failed) {
        log(LogLevel::info, "pipeline cache {} was not written", path.string());
        std::error_code ignored;
        fs::remove(part, ignored);
    }
}

}  // namespace loam::gpu
