// GLSL to SPIR-V with glslang, without a device. Shaders may be made while running, of one that there is and
// texts that stand in for files that it includes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace loam::glsl {

// The text of a file by its name from the folder above shaders/ ("shaders/texture/page_io.h"); none: there is
// no such file.
using Reader = std::function<std::optional<std::string>(const std::string& name)>;
[[nodiscard]] Reader reader_of_files(std::filesystem::path root);
[[nodiscard]] std::optional<std::string> embedded_text(
    const std::string& name);  // as the build embedded them

// By the name that an #include gives: what stands there in place of a file.
using Texts = std::map<std::string, std::string, std::less<>>;

// Whether the code says which lines it is made of (OpLine).
enum class Lines { no, yes };

using Words = std::vector<uint32_t>;
// Source text; `name`, a path below shaders/, gives the stage by its extension and appears in messages as
// "name:line: …".
[[nodiscard]] Result<Words> compile(std::string_view name, std::string_view source, Reader read,
                                    Lines lines = Lines::no);
// The shader `base` with `texts`.
[[nodiscard]] Result<Words> compile_with(const std::string& base, const Texts& texts, const Reader& files,
                                         Lines lines = Lines::no);

}  // namespace loam::glsl
