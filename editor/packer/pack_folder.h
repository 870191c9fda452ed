// A folder of maps becomes a layer's planes. What is missing, odd or mended is said.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "editor/packer/layer_planes.h"
#include "editor/packer/map_files.h"
#include "editor/recipe/progress.h"
#include "runtime/base/result.h"

namespace loam {

enum class ColorEncoding { srgb, linear };

struct PackRequest {
    std::filesystem::path folder;
    int size_texels = 0;  // a power of two, 4 … 4096; 0: the one nearest to the colour map
    std::optional<NormalDirection> normal{};  // else by name, else by the slopes
    std::optional<ColorEncoding> color{};  // of colour and specular; else floats are linear and integers sRGB
    double relief = 0.03;  // of a height map, as a share of the tile, where normals are made of it
};

// Specular and albedo there and back again, as stored in floats and in eight bits; linear values 0…1.
struct FusedRoundTrip {
    double mean = 0, max = 0;  // of the largest of six channel errors
    double mean_8bit = 0, max_8bit = 0;
    double mean_lit = 0, max_lit = 0;  // as Loam's lighting reads it: insulators reflect 0.04
};
[[nodiscard]] FusedRoundTrip fused_round_trip(const std::vector<glm::vec3>& albedo,
                                              const std::vector<glm::vec3>& specular);

struct PackedFolder {
    LayerPlanes planes;
    FusedRoundTrip fused;               // of the folder's specular map, else of what the layer reflects
    std::vector<std::string> notes;     // said, nothing to worry about
    std::vector<std::string> warnings;  // works, but a person may want to do something
};
[[nodiscard]] Result<PackedFolder> pack_folder(const PackRequest& request, const Progress& progress);
// Of a layer that has no specular map: what its light reflects, 0.04 or the metal's colour.
[[nodiscard]] FusedRoundTrip fused_round_trip(const LayerPlanes& planes);

}  // namespace loam
