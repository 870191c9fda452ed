// The renderer's figures by name, as the command line (--set) and Python (settings=) change them. Every
// figure that a talk gives is one, with that figure as its default. They belong to a session, not to the
// project.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/frame/renderer.h"

namespace loam {

struct SettingText {
    std::string name, value, range, help;
};

// Every setting with what it is in `desc`.
[[nodiscard]] std::vector<SettingText> list_settings(const RendererDesc& desc);
// An unknown name, a value of another kind or out of range: an error, and `desc` is as it was.
Status change_setting(RendererDesc& desc, std::string_view name, std::string_view value);
// "name=value,name=value"
Status change_settings(RendererDesc& desc, std::string_view text);

}  // namespace loam
