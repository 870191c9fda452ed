// The virtual index and colour map: a layer index and a tint a texel, always in step with each other; coarser
// levels are point samples. Where the map has imagery (document/imagery.h), a page holds its texels too.
// Pages of 256² + 4 border nest with virtual-texture pages: every texture page lies in one index page.
// Source: Call of Duty talk, "One Material Per Vertex", "Virtual Index & Color Map".
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/document/operator.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/resources.h"
#include "runtime/maps/virtual_map.h"

namespace loam {

class Document;

inline constexpr int kIndexPayload = 256, kIndexBorder = 4, kIndexTexels = kIndexPayload + 2 * kIndexBorder;
// A texture page is composed from the finest level of which it covers no more texels a side.
inline constexpr int kIndexSquareTexels = 128;

struct IndexMapDesc {
    int slot_count = 48;
    bool gpu = true;
    bool compressed_tints = true;  // where the device samples BC1
};

class IndexMap {
  public:
    static Result<std::unique_ptr<IndexMap>> create(gpu::Device* device, const Document& document,
                                                    const IndexMapDesc& desc);
    ~IndexMap();

    [[nodiscard]] const VirtualMap& map() const;
    void request(const MapPage& page, float priority);
    void on_dirt(std::span<const WorldRect> rects);
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, uint64_t frame, int new_pages);
    // The same without a device (desc.gpu false).
    void update_without_gpu(uint64_t frame, int new_pages);
    [[nodiscard]] bool has_work() const;
    [[nodiscard]] const IndexTexel* resident_page(
        const MapPage& page) const;  // kIndexTexels²; null: not resident

    [[nodiscard]] gpu::Image& indices();  // R16_UINT kIndexTexels², one layer a slot
    // sRGB-encoded, read as they are: BC1_RGB_UNORM (maps/tint_blocks.h) or, where the device has none,
    // RGBA8_UNORM.
    [[nodiscard]] gpu::Image& tints();
    [[nodiscard]] bool compressed_tints() const;
    // RGBA8_SRGB 528² (shaders/texture/imagery.h), one layer a slot, cover in alpha; without imagery the
    // tints, that there is something to bind.
    [[nodiscard]] gpu::Image& imagery();
    // After Document::change_settings: where the imagery is another one, every page is composed again.
    Status take_settings();
    // Page table on the GPU for shaders that look up any place: uint a table entry (kNoSlot: absent).
    [[nodiscard]] gpu::Buffer& page_table();

    // The index page that holds a square of the world of side 64 m * 2^k (k may be negative), coarse enough
    // that the square is kIndexSquareTexels or fewer; level 0 where it is smaller.
    [[nodiscard]] MapPage page_for_square(double min_x_m, double min_y_m, double side_m) const;
    // Nearest texel at the finest level (what is under a point); composes what is not resident.
    [[nodiscard]] IndexTexel texel_at(double x_m, double y_m);

    static void compose(const Document& document, const VirtualMap& map, const MapPage& page,
                        const TexelRect& rect,
                        std::span<IndexTexel> out);  // out: whole page, kIndexTexels²
    // Tests: resident pages without dirt that differ in any bit from what `document` gives when composed from
    // nothing.
    [[nodiscard]] uint32_t count_stale_pages(const Document& document) const;
    [[nodiscard]] uint64_t gpu_bytes() const;

  private:
    IndexMap();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace loam
