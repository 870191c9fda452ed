// Names of renderer settings, as the command line and Python write them.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "editor/packer/pack_folder.h"
#include "runtime/frame/debug_views.h"
#include "runtime/frame/renderer.h"

namespace loam {

struct QualityName {
    const char *name, *title;
    Quality quality;
};
struct PageFormatName {
    const char *name, *title;
    PageFormat format;
};
[[nodiscard]] std::span<const QualityName> quality_names();
[[nodiscard]] std::span<const PageFormatName> page_format_names();
[[nodiscard]] const QualityName& quality_name(Quality quality);
[[nodiscard]] Result<Quality> parse_quality(std::string_view name);               // very_low … ultra
[[nodiscard]] Result<PageFormat> parse_page_format(std::string_view name);        // bc1, bc3, bc1x4, rgba8
[[nodiscard]] Result<std::optional<Filter>> parse_filter(std::string_view name);  // auto, bilinear, …
[[nodiscard]] Result<DebugView> parse_debug_view(std::string_view name);          // none, mips, sectors, …
[[nodiscard]] Result<NormalDirection> parse_normal_direction(std::string_view name);  // gl, dx
[[nodiscard]] Result<ColorEncoding> parse_color_encoding(std::string_view name);      // srgb, linear

}  // namespace loam
