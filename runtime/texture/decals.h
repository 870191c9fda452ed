// Which decals a page rectangle gets, as instances for the decal pass, in operator order; and which decals
// direct shading looks at.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "runtime/base/rect.h"
#include "runtime/texture/page_id.h"
#include "shaders/texture/decal_io.h"

namespace loam {

class Document;

enum class DecalKind : uint8_t { crater, footprint };

// Consecutive instances of one kind: one draw. Order between pages does not matter, order within one does.
struct DecalRun {
    DecalKind kind;
    uint32_t first = 0, count = 0;
};

struct DecalList {
    std::vector<shared::DecalInstance> instances;
    std::vector<DecalRun> runs;
};

// Appends the decals over `rect` (texels of the page with border); scratch_min is where rect's corner lies in
// scratch. The caller holds the document's ReadLock.
void add_decals(const Document& document, const TextureLayout& layout, const PageId& page,
                const TexelRect& rect, glm::ivec2 scratch_min, DecalList& list);

struct DirectDecalView {
    glm::dvec2 camera_m{0};
    double pixels_per_radian = 500;
    double footprint_bias = 0;          // log2, as direct shading's
    std::span<const WorldRect> ground;  // together at least the ground in view
};

// The decals over the ground in view that are not too small to be seen, in operator order. Takes the
// document's ReadLock.
[[nodiscard]] std::vector<shared::DirectDecal> direct_decals(const Document& document,
                                                             const DirectDecalView& view);

// The texels of a page whose centres lie in a world rectangle, grown by one; not clipped.
[[nodiscard]] TexelRect page_texels(const TextureLayout& layout, const PageId& page, const WorldRect& world);

}  // namespace loam
