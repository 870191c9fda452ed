// SPIR-V by name. The build compiles every shader and embeds it; in the editor the sources can be watched and compiled again with
// glslang, includes resolved below the shader folder.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace loam::gpu {

class Device;

class ShaderLibrary {
  public:
    // The SPIR-V of a shader ("geometry/terrain.vert"): reloaded code if there is any, else what was embedded.
    [[nodiscard]] Result<std::span<const uint32_t>> spirv(std::string_view name) const;

    // Compiles GLSL source text; `name` gives the stage by its extension and appears in messages as "name:line: …".
    [[nodiscard]] static Result<std::vector<uint32_t>> compile(std::string_view name, std::string_view source,
                                                               const std::filesystem::path& include_root);

    // Watching: call `poll` now and then (the editor: twice a second). Returns names whose code changed, and keeps the
    // last error, one message a shader, until that shader compiles.
    void watch(const std::filesystem::path& shader_root);
    std::vector<std::string> poll();
    [[nodiscard]] const std::map<std::string, std::string>& errors() const { return errors_; }

  private:
    struct Watched {
        std::filesystem::file_time_type newest{}; // of the file and what it includes
    };
    std::filesystem::path root_;
    std::map<std::string, Watched, std::less<>> watched_;
    std::map<std::string, std::vector<uint32_t>, std::less<>> reloaded_;
    std::map<std::string, std::string> errors_;
};

// Rebuilds every live pipeline that uses one of the changed shaders; failures are added to the library's errors.
void reload_pipelines(Device& device, std::span<const std::string> changed);

} // namespace loam::gpu
