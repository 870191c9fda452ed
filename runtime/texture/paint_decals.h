// Terrain decals, splines and volumes (document/ground_decal.h) as the shaders have them: what they are made
// of, where they lie in a frame, and the ground's heights under volumes.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <glm/vec3.hpp>

#include "runtime/base/rect.h"
#include "runtime/document/operator.h"
#include "runtime/document/spline_path.h"
#include "shaders/texture/paint_io.h"

namespace loam {

class Document;
class LayerSet;
struct DecalFunction;
enum class LayerTier : uint8_t;

// The layer whose textures a material shows; -1: a flat colour. And the size of a repeat of them.
[[nodiscard]] int layer_of(const Document& document, const LayerSet& layers, const DecalMaterial& material);
[[nodiscard]] double tile_of(const Document& document, const LayerSet& layers, const DecalMaterial& material,
                             int layer);

// The functions that a list of decals shows, each once.
using FunctionList = std::vector<std::shared_ptr<const DecalFunction>>;
// The place of a material's function in the list, counted from 1 and added if need be; 0: it has none.
// Nothing: the decal cannot be shown.
[[nodiscard]] std::optional<uint32_t> place_of_function(const Document& document,
                                                        const DecalMaterial& material,
                                                        FunctionList& functions);

// But for its function's place. A decal that lies on the ground at `origin_m`'s frame: the segments of a
// spline's piece are appended to `segments`.
[[nodiscard]] shared::PaintDecal paint_of(const Document& document, const LayerSet& layers, LayerTier tier,
                                          const TerrainDecal& decal, glm::dvec3 origin_m);
[[nodiscard]] shared::PaintDecal paint_of(const Document& document, const LayerSet& layers, LayerTier tier,
                                          const VolumeDecal& volume, glm::dvec3 origin_m);
[[nodiscard]] shared::PaintDecal paint_of(const Document& document, const LayerSet& layers, LayerTier tier,
                                          const SplineDecal& spline, const SplinePiece& piece,
                                          glm::dvec3 origin_m, std::vector<shared::PaintSegment>& segments);

// Whether every target's channels have one weight, so that one draw will do (paint.frag).
[[nodiscard]] bool even_channels(const DecalMaterial& material);

// The level of the height map whose samples a page under a volume is looked up in: the finest that is no
// finer than the page's texels.
[[nodiscard]] int ground_level(const Document& document, double texel_m);
// A height that changed is seen by texels within this distance.
[[nodiscard]] double ground_reach_m(const Document& document, double texel_m);

// Fills in the grid of an instance and appends its heights. `square_corner`: of the page's payload; `texels`:
// of the page that the instance covers. The caller holds the ReadLock.
void add_ground(const Document& document, glm::dvec2 square_corner, double texel_m, const TexelRect& texels,
                double center_z_m, shared::PaintInstance& instance, std::vector<float>& heights);

}  // namespace loam
