// Settings of a project by name, as `loam set` and Python write them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/project.h"

namespace loam {

struct NamedSetting {
    std::string
        name;  // "ground.tile_hiding": table and key of project.toml; "layer.grass.tile_m": of a layer
    std::string value;  // as it stands: a number, "true" or "false", or a text
};
[[nodiscard]] std::vector<NamedSetting> named_settings(const ProjectSettings& settings);
// Unknown names and values of the wrong kind are refused; ranges are the document's to check.
[[nodiscard]] Status set_by_name(ProjectSettings& settings, std::string_view name, std::string_view value);

}  // namespace loam
