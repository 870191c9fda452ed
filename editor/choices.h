// Names of renderer settings, as the command line and Python write them.
#pragma once

#include <string_view>

#include "runtime/frame/renderer.h"

namespace loam {

[[nodiscard]] Result<Quality> parse_quality(std::string_view name);         // very_low … ultra
[[nodiscard]] Result<PageFormat> parse_page_format(std::string_view name);  // bc1, bc3, rgba8
[[nodiscard]] Result<DebugView> parse_debug_view(std::string_view name);    // none, mips, sectors, …

}  // namespace loam
