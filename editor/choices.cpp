#include "editor/choices.h"

#include <array>
#include <string>
#include <utility>

namespace loam {

namespace {

template <typename T, size_t N>
Result<T> parse_choice(std::string_view what, std::string_view name,
                       const std::array<std::pair<const char*, T>, N>& choices) {
    std::string names;
    for (const auto& [text, value] : choices) {
        if (name == text) return value;
        names += names.empty() ? text : fmt::format(", {}", text);
    }
    return error("unknown {} \"{}\", expected one of {}", what, name, names);
}

}  // namespace

Result<Quality> parse_quality(std::string_view name) {
    return parse_choice<Quality, 5>("quality", name,
                                    {{{"very_low", Quality::very_low},
                                      {"low", Quality::low},
                                      {"mid", Quality::mid},
                                      {"high", Quality::high},
                                      {"ultra", Quality::ultra}}});
}

Result<PageFormat> parse_page_format(std::string_view name) {
    return parse_choice<PageFormat, 3>(
        "format", name,
        {{{"bc1", PageFormat::bc1x3}, {"bc3", PageFormat::bc3x2}, {"rgba8", PageFormat::rgba8}}});
}

Result<DebugView> parse_debug_view(std::string_view name) {
    return parse_choice<DebugView, 8>("debug view", name,
                                      {{{"none", DebugView::none},
                                        {"mips", DebugView::mips},
                                        {"sectors", DebugView::sectors},
                                        {"normals", DebugView::normals},
                                        {"occlusion", DebugView::occlusion},
                                        {"indirection", DebugView::indirection},
                                        {"shadow", DebugView::shadow},
                                        {"albedo", DebugView::albedo}}});
}

}  // namespace loam
