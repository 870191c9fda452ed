// World: metres, Z up, X east, Y north, `double` on the CPU. A position on the terrain is (sector, offset in
// sector): the sector's integer coordinates in units of 64 m and a float in [0, 64). Heights are stored as whole
// millimetres (int32), limited to ±16,384 m so that a float holds any of them to within half a millimetre.
// Source: Call of Duty talk, "Adaptive Virtual Texture" (64 m sectors, maps up to 16.8 km).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace loam {

inline constexpr double kSectorSize_m = 64.0;
inline constexpr double kMaxMapSize_m = 16800.0;
inline constexpr double kHeightStep_m = 0.001;
inline constexpr int32_t kHeightLimit_mm = 16'384'000; // heights saturate at ± this

[[nodiscard]] inline int32_t saturate_height_mm(int64_t mm) {
    return static_cast<int32_t>(std::clamp<int64_t>(mm, -kHeightLimit_mm, kHeightLimit_mm));
}
// NaN becomes 0: callers that care must look before.
[[nodiscard]] inline int32_t height_mm_from_m(double m) {
    if (std::isnan(m)) return 0;
    const double mm = std::nearbyint(std::clamp(m, -1.0e6, 1.0e6) / kHeightStep_m);
    return saturate_height_mm(static_cast<int64_t>(mm));
}
[[nodiscard]] inline double height_m_from_mm(int32_t mm) {
    return mm * kHeightStep_m;
}

struct SectorPosition {
    glm::ivec2 sector{0};
    glm::vec2 offset_m{0}; // in [0, 64)
};

[[nodiscard]] inline SectorPosition sector_position(glm::dvec2 world_m) {
    const glm::dvec2 sector(std::floor(world_m.x / kSectorSize_m), std::floor(world_m.y / kSectorSize_m));
    SectorPosition p{glm::ivec2(sector), glm::vec2(world_m - sector * kSectorSize_m)};
    // A double just below a multiple of 64 may round to 64.0f.
    for (int i = 0; i < 2; ++i)
        if (p.offset_m[i] >= float(kSectorSize_m)) {
            p.offset_m[i] = 0.0f;
            p.sector[i] += 1;
        }
    return p;
}

} // namespace loam
