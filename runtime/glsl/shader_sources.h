// The texts of what shaders are made of while running, which the build embedded (shaders/CMakeLists.txt),
// sorted by name.
#pragma once

#include <span>
#include <string_view>

namespace loam::glsl {

struct ShaderSource {
    std::string_view name;  // path below shaders/
    std::string_view text;
};
[[nodiscard]] std::span<const ShaderSource> shader_sources();

}  // namespace loam::glsl
