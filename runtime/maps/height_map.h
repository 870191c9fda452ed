// The virtual height map: composed heights (base map, refined, plus operators) with normals and ambient
// occlusion. The CPU keeps what the GPU has, so that queries read the same numbers as the picture.
//
// A page's sample (i, j), -2 <= i < 66, lies at world ((64 x + i) * spacing, …): one multiplication from an
// integer, so a place shared by two levels has one position and, as operators and interpolation depend on
// position only, one height.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/resources.h"
#include "runtime/maps/cutout_map.h"
#include "runtime/maps/virtual_map.h"

namespace loam {

class Document;

inline constexpr int kHeightPayload = 64, kHeightBorder = 2,
                     kHeightTexels = kHeightPayload + 2 * kHeightBorder;
inline constexpr int kOcclusionRadius = 16;  // texels of the page's own level that ambient occlusion looks at

// Composed page. heights: metres. normals: half floats x, y, ambient occlusion (1 open), 0; four a texel.
struct HeightPage {
    std::vector<float> heights_m;   // 68 x 68, row 0 south
    std::vector<uint16_t> normals;  // 68 x 68 x 4
    float min_m = 0, max_m = 0;     // of the payload and its far edge (samples 0 … 64)
};

struct HeightMapDesc {  // gpu memory: slot_count * 68 * 68 * 12 bytes
    int slot_count = 144;
    bool gpu = true;  // false: CPU queries only (no device needed)
};

class HeightMap {
  public:
    // `device` may be null when desc.gpu is false.
    static Result<std::unique_ptr<HeightMap>> create(gpu::Device* device, const Document& document,
                                                     const HeightMapDesc& desc);
    ~HeightMap();

    [[nodiscard]] const VirtualMap& map() const;
    void request(const MapPage& page, float priority);
    // Rectangles outside which no height of any level changes: the Document has grown those of base samples
    // by what the interpolation reaches. Normals and occlusion are taken care of here.
    void on_dirt(std::span<const WorldRect> rects);
    // Composes at most `new_pages` whole pages and every dirty rectangle of requested pages; records the
    // uploads and leaves both arrays ready to be read in vertex and fragment shaders.
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, uint64_t frame, int new_pages);
    // The same without a device (desc.gpu false).
    void update_without_gpu(uint64_t frame, int new_pages);
    [[nodiscard]] bool has_work() const;

    [[nodiscard]] gpu::Image& heights();  // R32_SFLOAT 68x68, one layer a slot
    [[nodiscard]] gpu::Image& normals();  // RGBA16_SFLOAT 68x68, one layer a slot
    [[nodiscard]] const gpu::Image& heights() const;
    [[nodiscard]] const gpu::Image& normals() const;
    [[nodiscard]] const HeightPage* resident_page(const MapPage& page) const;  // null: not resident

    // --- queries, at the finest level, whatever is resident; any thread but not during update or on_dirt ---
    // Heights and normals in a hole are those of the ground that would be there.
    // What was composed before on_dirt is never used after it, so that a query right after an edit sees the
    // edit.
    [[nodiscard]] double height_m(
        double x_m, double y_m);  // bilinear in the finest samples; clamped to the map; NaN: at 0
    [[nodiscard]] glm::dvec3 normal(double x_m,
                                    double y_m);  // central differences at the finest spacing, bilinear
    // First hit of a ray with the surface of the finest level, within max_m; origin and direction in world
    // metres. The surface is that of height_m, over the map only; a ray from below the ground hits it from
    // below, and goes through holes unless they count as closed. Nothing for a direction of no length and for
    // anything not finite (max_m may be infinite).
    [[nodiscard]] std::optional<glm::dvec3> ray_cast(glm::dvec3 origin_m, glm::dvec3 direction, double max_m,
                                                     Holes holes = Holes::open);

    // The composer, a pure function of the document: fills `rect` (texels with border) of `page`. Heights and
    // normals both.
    static void compose(const Document& document, const VirtualMap& map, const MapPage& page,
                        const TexelRect& rect, HeightPage& out);
    // Tests: resident pages without dirt that differ in any bit from what `document` gives when composed from
    // nothing.
    [[nodiscard]] uint32_t count_stale_pages(const Document& document) const;
    [[nodiscard]] uint64_t gpu_bytes() const;
    [[nodiscard]] uint64_t cpu_bytes() const;

  private:
    HeightMap();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace loam
