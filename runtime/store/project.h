// project.toml: what a person may want to read or change. Unknown keys are refused with a sentence that names
// them; opening a project executes nothing from it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "runtime/base/rect.h"
#include "runtime/base/result.h"

namespace loam {

// What texture pages can hold beside a material, chosen for a whole map: [texture] channels = ["scattering",
// …]. Numbered as kChannel… in shaders/texture/page_format.h.
enum class Channel : uint8_t { scattering, thermal, emissive, glint, depth };
inline constexpr std::array<const char*, 5> kChannelNames = {"scattering", "thermal", "emissive", "glint",
                                                             "depth"};
inline constexpr size_t kMostChannelsOfAMap = 4;

struct LayerEntry {
    std::string name;     // "grass"; unique in a project
    std::string file;     // "layers/grass.layer", relative to the project (layer_file.h)
    double tile_m = 2.0;  // world size of one repeat of its textures
    // A transition has no textures of its own: it is layer `from` with as much of `to` as a threshold and the reveal map of `to` let
    // through. Source: Call of Duty talk, "Multi-Layered Terrain Materials".
    struct Blend {
        std::string from, to;   // names of layers with textures
        double threshold = 0.5; // 0: all of `from`, 1: all of `to`
        // Removed: its number may still stand in the index map, so it keeps its place in the list, shows the side that it was
        // nearer to, and is taken again by the next transition that is made.
        bool removed = false;
        bool operator==(const Blend&) const = default;
    };
    std::optional<Blend> blend{};
    bool operator==(const LayerEntry&) const = default;
    std::array<double, kChannelNames.size()> channels{};  // amounts 0 … 1, by Channel
    double softness = 0.2;  // how far it gives underfoot: 0 rock … 1 deep snow
};

// Which layers events use, by name; an empty or unknown name falls back to layer 0.
struct LayerRoles {
    std::string scorched = "dirt";  // crater floors
    std::string broken = "scree";   // crater rims and ejecta
};

struct NumberRange {
    double min, max;
};
inline constexpr NumberRange kVistaScale{1, 64}, kVistaDistance_m{1, 16'384};

// How the ground's layers are laid over the whole map; each is off by default and then costs nothing.
struct GroundSettings {
    // Distortion: the lookup of the index map moves by up to so much, at most one index texel, in waves that repeat after a period.
    double distortion_amplitude_m = 0;
    double distortion_period_m = 32;
    bool tile_hiding = false;  // textures turned by sections of four index texels
    // Vista UVs: from a distance on textures show so much larger, alone from four times that distance on; 1:
    // off.
    double vista_scale = 1;
    double vista_distance_m = 100;
    [[nodiscard]] bool has_vista() const { return vista_scale > 1; }
    bool operator==(const GroundSettings&) const = default;
};

inline constexpr NumberRange kImageryDistance_m{1, 16'384};

// Imagery over the whole map as the ground's far look: its colours in place of the layers', whose relief
// stays.
struct ImagerySettings {
    std::string file;     // "imagery/ortho.imagery", relative to the project (imagery_file.h); empty: none
    double strength = 1;  // 0 … 1, of its colours where they show alone; 0: off
    double distance_m = 400;  // from here on it shows, alone from four times that
    [[nodiscard]] bool is_on() const { return !file.empty() && strength > 0; }
    bool operator==(const ImagerySettings&) const = default;
};

struct ProjectSettings {
    std::string name = "untitled";
    // Height base map: samples (i, j) at world (i, j) * height_spacing_m, 0 <= i < height_samples_x.
    int height_samples_x = 0, height_samples_y = 0;
    double height_spacing_m = 1.0;
    int refine = 0;                 // the height map's level 0 has spacing height_spacing_m / 2^refine
    double index_spacing_m = 1.0;   // 2^k metres, 0.25 … 64
    int32_t default_height_mm = 0;  // of pages never written
    uint16_t default_layer = 0;     // index of pages never written
    std::vector<LayerEntry> layers;
    // Names in the order that a palette shows them; layers that it does not name come after. The numbers in
    // the index map are places in `layers`, so that list is never put in another order.
    std::vector<std::string> palette;
    LayerRoles roles;
    GroundSettings ground;
    ImagerySettings imagery;
    std::vector<Channel> channels;  // that pages hold, each once
    double sun_azimuth_rad = 3.9;  // clockwise from north, where the sun stands
    double sun_elevation_rad = 0.6;
    double haze_per_km = 0.045;  // extinction at sea level, 1/km

    [[nodiscard]] WorldRect bounds() const {
        return {0, 0, (height_samples_x - 1) * height_spacing_m, (height_samples_y - 1) * height_spacing_m};
    }
};

// Numbers of the layers in the palette's order, removed transitions left out.
[[nodiscard]] std::vector<int> palette_order(const ProjectSettings& settings);
// The largest refine (≤ 6) for which level 0 is no finer than 0.25 m.
[[nodiscard]] int default_refine(double height_spacing_m);

[[nodiscard]] Result<ProjectSettings> load_project(const std::filesystem::path& folder);
// Writes to a temporary file and renames it.
[[nodiscard]] Status save_project(const std::filesystem::path& folder, const ProjectSettings& settings);
// Everything that must hold: sizes, spacings, ranges, finite numbers, at least one layer or none, unique
// names.
[[nodiscard]] Status check_settings(const ProjectSettings& settings);

}  // namespace loam
