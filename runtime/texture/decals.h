// Which decals a page rectangle gets, as instances for the decal pass, in operator order; and which decals
// direct shading looks at.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/base/rect.h"
#include "runtime/texture/page_id.h"
#include "runtime/texture/paint_decals.h"
#include "shaders/texture/decal_io.h"
#include "shaders/texture/paint_io.h"

namespace loam {

enum class DecalKind : uint8_t { crater, footprint, terrain, spline, volume };

// Consecutive instances of one kind: one draw. Order between pages does not matter, order within one does.
struct DecalRun {
    DecalKind kind;
    bool even = true;       // one weight a target will do (paint.frag)
    uint32_t function = 0;  // from 1 in the list; 0: none
    LayerTier tier{};
    uint32_t first = 0, count = 0;
};

// The talk's order. A pass is recorded when it has runs.
enum class DecalPass : uint8_t { splines, terrain, volumes };
inline constexpr size_t kDecalPasses = 3;

struct DecalList {
    std::vector<shared::DecalInstance> marks;    // of craters and footprints
    std::vector<shared::PaintInstance> paints;   // of the other kinds
    std::vector<shared::PaintSegment> segments;  // of splines
    std::vector<float> heights_m;                // under volumes
    FunctionList functions;
    std::array<std::vector<DecalRun>, kDecalPasses> runs;
};

// Appends the decals over `rect` (texels of the page with border); scratch_min is where rect's corner lies in
// scratch. The caller holds the document's ReadLock.
void add_decals(const Document& document, const LayerSet& layers, LayerTier tier, const TextureLayout& layout,
                const PageId& page, const TexelRect& rect, glm::ivec2 scratch_min, DecalList& list);

// The layers that decals over `rect` show. Takes the document's ReadLock.
struct DecalTexture {
    uint32_t layer;
    double tile_m;  // size of a repeat
};
[[nodiscard]] std::vector<DecalTexture> decal_textures(const Document& document, const LayerSet& layers,
                                                       const TextureLayout& layout, const PageId& page,
                                                       const TexelRect& rect);

struct DirectDecalView {
    glm::dvec3 camera_m{0};
    double pixels_per_radian = 500;
    double footprint_bias = 0;          // log2, as direct shading's
    std::span<const WorldRect> ground;  // together at least the ground in view
};

struct DirectDecals {
    std::vector<shared::DirectDecal> decals;  // in the order of evaluation
    std::vector<shared::PaintDecal> paints;
    std::vector<shared::PaintSegment> segments;
};

// The decals over the ground in view that are not too small to be seen. Takes the document's ReadLock.
// `functions`: that pictures have shown so far, in the order of the shader.
[[nodiscard]] DirectDecals direct_decals(const Document& document, const LayerSet& layers,
                                         const DirectDecalView& view, FunctionList& functions);

// The texels of a page whose centres lie in a world rectangle, grown by one; not clipped.
[[nodiscard]] TexelRect page_texels(const TextureLayout& layout, const PageId& page, const WorldRect& world);

}  // namespace loam
