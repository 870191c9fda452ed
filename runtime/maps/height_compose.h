// The steps of HeightMap::compose that queries use alone. All are pure functions of the document.
//
// Source of the ambient occlusion: horizon angles as in Max, "Horizon Mapping" (1988); the cosine-weighted
// share of the sky above a horizon of slope t is 1 / (1 + t²) a direction. What differs: slopes are taken
// relative to the tangent plane, so that an even slope is open.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/maps/height_map.h"
#include "runtime/store/project.h"

namespace loam {

// Heights in metres, row-major, at samples first + (i, j) of a level: base samples (bicubic where the level
// is finer than the base, exactly through the samples), then operators. The caller holds the document's
// ReadLock.
void compose_heights(const Document& document, int level, glm::ivec2 first, glm::ivec2 size, double* out_m);

// The same at places first + (i, j) times any step, for what asks for the ground of another map's texels.
void ground_at(const Document& document, double step_m, glm::ivec2 first, glm::ivec2 size, double* out_m);

// Metres between the samples of level 0; of level L times 2^L, the places exact multiples.
[[nodiscard]] double finest_height_spacing(const ProjectSettings& settings);

// The same of a whole page with its border, as HeightPage has them. Takes the ReadLock.
void compose_page_heights(const Document& document, const MapPage& page, float* out_m);

// The heights that a page and its normals and occlusion are made from: the page's texels and kOcclusionRadius
// more on every side, row 0 south. Kept beside a resident page, so that an edit evaluates only the heights
// that it changed.
inline constexpr int kWindowMargin = kOcclusionRadius, kWindowTexels = kHeightTexels + 2 * kWindowMargin;
inline constexpr TexelRect kWindowRect{-kWindowMargin, -kWindowMargin, kHeightTexels + kWindowMargin,
                                       kHeightTexels + kWindowMargin};  // in texels of the page

// Fills `rect` of the page, heights, normals, occlusion, range, from a piece of the window: `heights_m` holds
// `window` (in texels of the page), which must reach kWindowMargin beyond the rectangle.
void derive_page(const VirtualMap& map, int level, const TexelRect& window, const double* heights_m,
                 const TexelRect& rect, HeightPage& out);

// The page's texel (0, 0) in samples of its level.
[[nodiscard]] glm::ivec2 first_sample(const MapPage& page);

// Catmull-Rom weights of the four samples around a place, 0 <= f < 1 between the middle two.
struct CubicWeights {
    double w[4];
};
[[nodiscard]] CubicWeights catmull_rom(double f);

}  // namespace loam
