// The SPIR-V that the build compiled and embedded (shaders/CMakeLists.txt), sorted by name.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

namespace loam::gpu {

struct EmbeddedShader {
    std::string_view name;  // path below shaders/: "geometry/terrain.vert"
    std::span<const uint32_t> words;
};

[[nodiscard]] std::span<const EmbeddedShader> embedded_shaders();

}  // namespace loam::gpu
