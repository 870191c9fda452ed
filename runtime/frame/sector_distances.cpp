#include "runtime/frame/sector_distances.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "runtime/base/units.h"

namespace loam {

std::vector<SectorDistance> sector_distances(const PatchSet& patches, const HeightMap& heights,
                                             double radius_m) {
    const glm::dvec3 eye = patches.camera_m;
    const WorldRect& bounds = heights.map().desc().bounds;
    const auto sector_at = [](double m) { return int(std::floor(m / kSectorSize_m)); };
    const glm::ivec2 first(std::max(sector_at(eye.x - radius_m), 0),
                           std::max(sector_at(eye.y - radius_m), 0));
    const glm::ivec2 last(
        std::min(sector_at(eye.x + radius_m), sector_at(std::nextafter(bounds.max_x, 0.0))),
        std::min(sector_at(eye.y + radius_m), sector_at(std::nextafter(bounds.max_y, 0.0))));
    if (last.x < first.x || last.y < first.y) return {};
    const int width = last.x - first.x + 1, height = last.y - first.y + 1;
    std::vector<double> nearest(size_t(width) * size_t(height), std::numeric_limits<double>::infinity());
    for (const MapPage& page : patches.pages) {
        const WorldRect rect = heights.map().page_rect(page);
        if (rect.distance(eye.x, eye.y) > radius_m) continue;
        const PatchBox box = patch_box(heights, page, eye);
        const double below =
            std::max({box.low_m.z, -box.high_m.z, 0.0});  // the eye is outside of the box's heights
        const auto clamped = [](double m, int low, int high) {
            return std::clamp(int(std::floor(m / kSectorSize_m)), low, high);
        };
        for (int y = clamped(rect.min_y, first.y, last.y); y <= clamped(rect.max_y, first.y, last.y); ++y)
            for (int x = clamped(rect.min_x, first.x, last.x); x <= clamped(rect.max_x, first.x, last.x);
                 ++x) {
                const WorldRect part = intersected(rect, {x * kSectorSize_m, y * kSectorSize_m,
                                                          (x + 1) * kSectorSize_m, (y + 1) * kSectorSize_m});
                if (part.empty()) continue;
                double& at = nearest[size_t(y - first.y) * size_t(width) + size_t(x - first.x)];
                at = std::min(at, std::hypot(part.distance(eye.x, eye.y), below));
            }
    }
    std::vector<SectorDistance> found;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            if (const double d = nearest[size_t(y) * size_t(width) + size_t(x)]; d <= radius_m)
                found.push_back({first + glm::ivec2(x, y), d});
    return found;
}

void merge_nearer(std::vector<SectorDistance>& into, const std::vector<SectorDistance>& more) {
    for (const SectorDistance& m : more) {
        const auto known = std::find_if(into.begin(), into.end(),
                                        [&](const SectorDistance& s) { return s.sector == m.sector; });
        if (known == into.end())
            into.push_back(m);
        else
            known->distance_m = std::min(known->distance_m, m.distance_m);
    }
}

}  // namespace loam
