// How steep and how bent a ground is: percentiles of slope and curvature, to set recipes beside measured
// grounds.
#pragma once

#include <array>
#include <filesystem>
#include <ostream>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

inline constexpr std::array<int, 7> kGroundPercentiles = {5, 25, 50, 75, 90, 95, 99};

struct GroundStatistics {
    int columns = 0, rows = 0;
    double relief_m = 0;                // highest less lowest
    std::array<double, 7> slope_deg{};  // at kGroundPercentiles
    std::array<double, 7> curvature{};  // |Laplacian|, 1/m, at kGroundPercentiles
};

struct ElevationMap {  // row 0 at either end; samples dx, dy metres apart
    std::string name;
    int columns = 0, rows = 0;
    double dx_m = 1, dy_m = 1;
    std::vector<float> height_m;
};

// At samples `spacing_m` apart: finer maps are averaged over squares of that side first, coarser ones
// interpolated.
[[nodiscard]] GroundStatistics ground_statistics(const ElevationMap& map, double spacing_m);

// The real maps of a folder that are known by name (dem_images.cpp), as many as are there.
[[nodiscard]] Result<std::vector<ElevationMap>> load_known_elevations(const std::filesystem::path& folder);

enum class BenchFormat { table, json };
// Recipes and real grounds side by side, at 30 m and at 2 m. Says why when the real ones are missing.
[[nodiscard]] Status bench_ground(const std::filesystem::path& elevation_folder, std::ostream& out,
                                  BenchFormat format);

}  // namespace loam
