#include "editor/recipe/ground_statistics.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "editor/recipe/ground.h"

namespace loam {

namespace {

std::array<double, 7> percentiles(std::vector<float>& values) {
    std::array<double, 7> out{};
    if (values.empty()) return out;
    std::sort(values.begin(), values.end());
    for (size_t k = 0; k < out.size(); ++k)
        out[k] = values[static_cast<size_t>(kGroundPercentiles[k] * 0.01 *
                                            static_cast<double>(values.size() - 1))];
    return out;
}

// Mean over the square of side `spacing_m` around each new sample; where that holds no old sample, bilinear.
std::vector<float> at_spacing(const ElevationMap& map, double spacing_m, int columns, int rows) {
    std::vector<float> out(static_cast<size_t>(columns) * rows);
    const double half_x = spacing_m * 0.5 / map.dx_m, half_y = spacing_m * 0.5 / map.dy_m;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const double x = i * spacing_m / map.dx_m, y = j * spacing_m / map.dy_m;
            double sum = 0;
            int count = 0;
            if (half_x >= 0.75 && half_y >= 0.75)
                for (int b = std::max(0, static_cast<int>(std::ceil(y - half_y)));
                     b <= std::min<double>(map.rows - 1, y + half_y); ++b)
                    for (int a = std::max(0, static_cast<int>(std::ceil(x - half_x)));
                         a <= std::min<double>(map.columns - 1, x + half_x); ++a)
                        sum += map.height_m[static_cast<size_t>(b) * map.columns + a], ++count;
            if (count == 0) {
                const int a = std::clamp(static_cast<int>(x), 0, map.columns - 2),
                          b = std::clamp(static_cast<int>(y), 0, map.rows - 2);
                const double u = x - a, v = y - b;
                const float* p = &map.height_m[static_cast<size_t>(b) * map.columns + a];
                sum = (p[0] * (1 - u) + p[1] * u) * (1 - v) +
                      (p[map.columns] * (1 - u) + p[map.columns + 1] * u) * v;
                count = 1;
            }
            out[static_cast<size_t>(j) * columns + i] = static_cast<float>(sum / count);
        }
    return out;
}

}  // namespace

GroundStatistics ground_statistics(const ElevationMap& map, double spacing_m) {
    GroundStatistics s;
    if (map.columns < 2 || map.rows < 2) return s;
    s.columns = static_cast<int>((map.columns - 1) * map.dx_m / spacing_m) + 1;
    s.rows = static_cast<int>((map.rows - 1) * map.dy_m / spacing_m) + 1;
    if (s.columns < 3 || s.rows < 3) return s;
    const std::vector<float> h = at_spacing(map, spacing_m, s.columns, s.rows);
    const auto [low, high] = std::minmax_element(h.begin(), h.end());
    s.relief_m = *high - *low;
    std::vector<float> slope, curvature;
    for (int j = 1; j + 1 < s.rows; ++j)
        for (int i = 1; i + 1 < s.columns; ++i) {
            const float* p = &h[static_cast<size_t>(j) * s.columns + i];
            const double dx = (p[1] - p[-1]) / (2 * spacing_m),
                         dy = (p[s.columns] - p[-s.columns]) / (2 * spacing_m);
            slope.push_back(static_cast<float>(std::atan(std::hypot(dx, dy)) * 180 / std::numbers::pi));
            curvature.push_back(static_cast<float>(
                std::fabs(p[1] + p[-1] + p[s.columns] + p[-s.columns] - 4 * p[0]) / (spacing_m * spacing_m)));
        }
    s.slope_deg = percentiles(slope);
    s.curvature = percentiles(curvature);
    return s;
}

Status bench_ground(const std::filesystem::path& elevation_folder, std::ostream& out, BenchFormat format) {
    std::vector<ElevationMap> maps;
    auto real = load_known_elevations(elevation_folder);
    if (real)
        maps = std::move(*real);
    else if (format == BenchFormat::table)
        out << "no real grounds to compare with: " << real.message() << "\n";
    for (const RecipeName& recipe : ground_recipe_names()) {
        auto ground = make_ground({.name = recipe.name, .size_m = 4096, .seed = 1}, {});
        if (!ground) return ground.error();
        maps.push_back({"recipe " + std::string(recipe.name), ground->size, ground->size, ground->spacing_m,
                        ground->spacing_m, std::move(ground->height_m)});
    }
    if (format == BenchFormat::json)
        out << "[";
    else
        out << fmt::format(
            "{:<18} {:>5} {:>7}  slope, degrees: p5 p25 p50 p75 p90 p95 p99 | curvature, 1/m: the same\n",
            "ground", "at m", "relief");
    bool first = true;
    for (const double spacing : {30.0, 2.0})
        for (const ElevationMap& map : maps) {
            if (std::min(map.dx_m, map.dy_m) > 2 * spacing)
                continue;  // too coarse to say anything at that spacing
            const GroundStatistics s = ground_statistics(map, spacing);
            if (format == BenchFormat::json) {
                out << fmt::format(
                    "{}{{\"ground\":\"{}\",\"spacing_m\":{},\"relief_m\":{:.1f},\"slope_deg\":[{:.2f}],"
                    "\"curvature\":[{:.5f}]}}",
                    first ? "" : ",\n", map.name, spacing, s.relief_m, fmt::join(s.slope_deg, ","),
                    fmt::join(s.curvature, ","));
            } else {
                out << fmt::format("{:<18} {:>5} {:>7.0f}  {:5.1f} | {:7.4f}\n", map.name, spacing,
                                   s.relief_m, fmt::join(s.slope_deg, " "), fmt::join(s.curvature, " "));
            }
            first = false;
        }
    if (format == BenchFormat::json) out << "]\n";
    return {};
}

}  // namespace loam
