#include "editor/choices.h"

#include <string>

namespace loam {

namespace {

constexpr QualityName kQualities[] = {{"very_low", "very low, 13² pages", Quality::very_low},
                                      {"low", "low, 16² pages", Quality::low},
                                      {"mid", "mid, 22² pages", Quality::mid},
                                      {"high", "high, 30² pages", Quality::high},
                                      {"ultra", "ultra, 42² pages", Quality::ultra}};
constexpr PageFormatName kFormats[] = {{"bc1", "3 x BC1", PageFormat::bc1x3},
                                       {"bc3", "2 x BC3", PageFormat::bc3x2},
                                       {"bc1x4", "4 x BC1", PageFormat::bc1x4},
                                       {"rgba8", "uncompressed", PageFormat::rgba8}};

struct FilterName {
    const char* name;
    std::optional<Filter> filter;
};
constexpr FilterName kFilters[] = {{"auto", std::nullopt},
                                   {"bilinear", Filter::bilinear},
                                   {"trilinear", Filter::trilinear},
                                   {"tiles", Filter::anisotropic_tiles},
                                   {"hardware", Filter::anisotropic_hardware}};

struct NormalDirectionName {
    const char* name;
    NormalDirection direction;
};
constexpr NormalDirectionName kNormalDirections[] = {{"gl", NormalDirection::gl},
                                                     {"dx", NormalDirection::dx}};

struct ColorEncodingName {
    const char* name;
    ColorEncoding encoding;
};
constexpr ColorEncodingName kColorEncodings[] = {{"srgb", ColorEncoding::srgb},
                                                 {"linear", ColorEncoding::linear}};

// The row of that name.
template <typename Row>
Result<const Row*> find_named(std::string_view what, std::string_view name, std::span<const Row> rows) {
    std::string names;
    for (const Row& row : rows) {
        if (name == row.name) return &row;
        names += names.empty() ? row.name : fmt::format(", {}", row.name);
    }
    return error("unknown {} \"{}\", expected one of {}", what, name, names);
}

}  // namespace

std::span<const QualityName> quality_names() {
    return kQualities;
}
std::span<const PageFormatName> page_format_names() {
    return kFormats;
}

const QualityName& quality_name(Quality quality) {
    return kQualities[size_t(quality)];
}

Result<Quality> parse_quality(std::string_view name) {
    auto row = find_named("quality", name, quality_names());
    if (!row) return row.error();
    return (*row)->quality;
}

Result<PageFormat> parse_page_format(std::string_view name) {
    auto row = find_named("format", name, page_format_names());
    if (!row) return row.error();
    return (*row)->format;
}

Result<std::optional<Filter>> parse_filter(std::string_view name) {
    auto row = find_named("filter", name, std::span<const FilterName>(kFilters));
    if (!row) return row.error();
    return (*row)->filter;
}

Result<DebugView> parse_debug_view(std::string_view name) {
    auto row = find_named("debug view", name, debug_views());
    if (!row) return row.error();
    return (*row)->view;
}

Result<NormalDirection> parse_normal_direction(std::string_view name) {
    auto row =
        find_named("direction of normals", name, std::span<const NormalDirectionName>(kNormalDirections));
    if (!row) return row.error();
    return (*row)->direction;
}

Result<ColorEncoding> parse_color_encoding(std::string_view name) {
    auto row = find_named("encoding of colours", name, std::span<const ColorEncodingName>(kColorEncodings));
    if (!row) return row.error();
    return (*row)->encoding;
}

}  // namespace loam
