// SPIR-V by name. The build compiles every shader and embeds it; in the editor the sources can be watched and compiled again with
// glslang. Includes are resolved from the folder above shaders/, as the build does ("shaders/texture/page_io.h"), or
// beside the including file.
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/glsl/compiler.h"

namespace loam::gpu {

class Device;

class ShaderLibrary {
  public:
    // The SPIR-V of a shader ("geometry/terrain.vert"): reloaded code if there is any, else what was embedded.
    [[nodiscard]] Result<std::span<const uint32_t>> spirv(std::string_view name) const;

    // Makes, or makes again, the shader `name` ("texture/paint.frag:moss"): watched as its base is. After an
    // error the one before stays. The caller reloads pipelines.
    Status make(const std::string& name, const std::string& base, glsl::Texts texts);

    // Watching: call `poll` now and then (the editor: twice a second). Returns names whose code changed, and keeps the
    // last error, one message a shader, until that shader compiles.
    void watch(const std::filesystem::path& shader_root); // the `shaders` folder
    std::vector<std::string> poll();
    [[nodiscard]] const std::map<std::string, std::string>& errors() const { return errors_; }
    // A failure found elsewhere, such as a driver that rejects the code.
    void report(const std::string& name, std::string message) { errors_[name] = std::move(message); }

  private:
    struct Watched {
        std::vector<std::filesystem::path> files;           // the file and what it includes
        std::vector<std::filesystem::file_time_type> times; // of each: two may be saved within one tick of the clock
    };
    struct Made {
        std::string base;
        glsl::Texts texts;
    };
    bool recompile(const std::string& name); // true: the code is another
    bool poll_one(const std::string& name, const std::string& base);
    [[nodiscard]] Result<glsl::Words> compile_made(const Made& made) const;
    std::filesystem::path root_;
    std::map<std::string, Watched, std::less<>> watched_;
    std::map<std::string, Made, std::less<>> made_;
    std::map<std::string, std::vector<uint32_t>, std::less<>> reloaded_;
    std::map<std::string, std::string> errors_;
};

// Rebuilds every live pipeline that uses one of the changed shaders; failures are added to the library's errors.
void reload_pipelines(Device& device, std::span<const std::string> changed);

} // namespace loam::gpu
