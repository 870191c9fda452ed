// The virtual index and colour map: a layer index and a tint a texel, always in step with each other; coarser
// levels are point samples. Where the map has imagery (document/imagery.h), a page holds its texels too.
// Pages of 128² + 4 border nest with virtual-texture pages: every texture page lies in one index page.
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

inline constexpr int kIndexPayload = 128, kIndexBorder = 4, kIndexTexels = kIndexPayload + 2 * kIndexBorder;

struct IndexMapDesc {
    int slot_count = 144;
    bool gpu = true;
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
        const MapPage& page) const;  // 136 x 136; null: not resident

    [[nodiscard]] gpu::Image& indices();  // R16_UINT 136x136, one layer a slot
    [[nodiscard]] gpu::Image& tints();    // RGBA8_UNORM (sRGB-encoded) 136x136, one layer a slot
    // RGBA8_SRGB 272x272 (shaders/texture/imagery.h), one layer a slot, cover in alpha; without imagery the
    // tints, that there is something to bind.
    [[nodiscard]] gpu::Image& imagery();
    // After Document::change_settings: where the imagery is another one, every page is composed again.
    Status take_settings();
    // Page table on the GPU for shaders that look up any place: uint a table entry (kNoSlot: absent).
    [[nodiscard]] gpu::Buffer& page_table();

    // The index page that holds a square of the world of side 64 m * 2^k (k may be negative), coarse enough
    // that the square is about 128 texels or fewer; level 0 where the square is smaller than a page.
    [[nodiscard]] MapPage page_for_square(double min_x_m, double min_y_m, double side_m) const;
    // Nearest texel at the finest level (what is under a point); composes what is not resident.
    [[nodiscard]] IndexTexel texel_at(double x_m, double y_m);

    static void compose(const Document& document, const VirtualMap& map, const MapPage& page,
                        const TexelRect& rect,
                        std::span<IndexTexel> out);  // out: whole page, 136 x 136
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
