// Which file of a folder is which map of a material, by the usual suffixes of texture libraries.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

enum class MapKind { color, normal, roughness, gloss, occlusion, height, reveal, metalness, specular };
[[nodiscard]] std::string_view map_name(MapKind kind);  // "colour", "normal", …

enum class NormalDirection { gl, dx };  // the green channel points up, or down

struct MapFiles {
    std::map<MapKind, std::filesystem::path> files;
    std::optional<NormalDirection> normal_direction;  // when the name says so
    std::vector<std::string> notes;                   // pictures left out, and why
};

// What a name says; the last word that means a map decides ("rough_metal_plate_diff_1k" is a colour map).
struct NameMeaning {
    std::optional<MapKind> kind;
    bool ignored = false;  // a map that layers do not have: opacity, emission, …
    std::optional<NormalDirection> direction;
};
[[nodiscard]] NameMeaning meaning_of_name(std::string_view file_stem);

// Refuses a folder that is missing, two files for one map, and a folder without a colour map.
[[nodiscard]] Result<MapFiles> find_maps(const std::filesystem::path& folder);

}  // namespace loam
