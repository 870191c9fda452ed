// Normal maps in, and normals from heights.
#pragma once

#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "editor/packer/map_files.h"
#include "editor/packer/map_image.h"

namespace loam {

// How well the slopes of a map fit a height field: the correlation of d(slope x)/dy and d(slope y)/dx, which
// are equal where green points up (1) and opposite where it points down (-1). Near 0: nothing can be said
// (flat, or mixed).
[[nodiscard]] double upward_green(const std::vector<glm::vec3>& normals, int width, int height);

// Unit normals, green up, z ≥ 0, of a map's channels: blue is computed where there is none, vectors of wrong
// length are normalised, those below the ground's plane laid on its rim, those without length stand upright.
// Notes say what was done and how the direction of green was found.
[[nodiscard]] Result<std::vector<glm::vec3>> normals_of(const MapImage& map,
                                                        std::optional<NormalDirection> told,
                                                        std::optional<NormalDirection> named,
                                                        std::vector<std::string>& notes,
                                                        std::vector<std::string>& warnings);

// Of a square plane of heights in texels that repeats.
[[nodiscard]] std::vector<glm::vec3> normals_of_heights(const Plane& height_texels);

}  // namespace loam
