// The renderer: Document (const) plus dirt in, pictures out. `render` is the frame's list of passes in order.
//
//     auto renderer = Renderer::create(device, ring, document, desc);
//     renderer->on_dirt(document.apply(command).value());
//     auto frame = ring.begin();
//     renderer->render(ring, (*frame)->commands, camera, {960, 540});
//     ring.end(**frame);
//     … renderer->picture() holds the picture (RGBA8, sRGB-encoded), `settled()` says whether another frame
//     would improve it
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/base/result.h"
#include "runtime/document/document.h"
#include "runtime/frame/camera.h"
#include "runtime/frame/filter_tiles.h"
#include "runtime/frame/frame_settings.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/maps/cutout_map.h"
#include "runtime/texture/layer_set.h"
#include "runtime/texture/virtual_texture.h"

namespace loam {

enum class Quality {
    very_low,
    low,
    mid,
    high,
    ultra
};  // virtual texture sizes of the talk: 13², 16², 22², 30², 42² pages
struct RendererDesc {
    Quality quality = Quality::low;
    std::optional<PageFormat> page_format;  // default by device profile
    // The talk's 144 height pages serve its patches; here a page's normals are seen pixel by pixel, which
    // wants smaller pages: a 16 km range along a slope takes 618 (with 320 the ground at the eye's feet was
    // metres off).
    int height_slots = 640, index_slots = 48;
    int layer_budget_mb = int(LayerSet::kBudgetBytes >> 20);
    // What is 0 here: by quality (sizes), by profile (pages a frame). The format is page_format's.
    VirtualTextureDesc texture{.pages_per_side = 0, .indirection_size = 0, .budget_pages = 0};
    bool shadows = true;
    double patch_split_distance = 0;  // 0: by profile
};

struct MemoryRow {
    std::string name;
    uint64_t bytes = 0;
};

struct FrameStatistics {
    uint32_t patches = 0, patches_visible = 0, triangles = 0;
    uint32_t height_pages = 0, index_pages = 0;
    uint32_t shadow_cascades_drawn = 0, shadow_parts_drawn = 0;  // whole cascades; parts of others
    VirtualTexture::Statistics texture;
    VirtualMap::Counters height, index;
    LayerSet::Statistics layers;
    CutoutMap::Counts cutouts;
    std::vector<MemoryRow> memory;
    std::vector<gpu::PassTime> passes;  // of the newest finished frame
};

class Renderer {
  public:
    static Result<std::unique_ptr<Renderer>> create(gpu::Device& device, gpu::FrameRing& ring,
                                                    Document& document, const RendererDesc& desc);
    ~Renderer();

    void on_dirt(const Dirt& dirt);
    // Reads the sun, haze and layer list again from the document.
    Status settings_changed(gpu::FrameRing& ring);
    // While pictures are made: the next texture is prepared beside the one shown, which stays until the new
    // one has what the picture wants. After an error everything is as it was.
    Status set_quality(Quality quality, std::optional<PageFormat> page_format);
    [[nodiscard]] Quality quality() const;
    [[nodiscard]] PageFormat page_format() const;  // what the device takes of what was asked for

    // Records one frame. The picture is `extent` · render_scale pixels in the upper left of picture().
    Status render(gpu::FrameRing& ring, gpu::Commands& commands, const Camera& camera, glm::uvec2 extent,
                  const FrameSettings& settings);
    // The camera will soon be there: its pages are made beside the picture's, until another place or none is
    // announced.
    void announce(const std::optional<Camera>& camera);
    [[nodiscard]] gpu::Image& picture();            // RGBA8_UNORM, sRGB-encoded, last access fragment_sampled
    [[nodiscard]] glm::uvec2 picture_size() const;  // pixels of it that the last frame filled
    [[nodiscard]] gpu::Image& gbuffer();            // tests: RGBA16F
    [[nodiscard]] gpu::Image& depth();
    [[nodiscard]] FilterTiles& filter_tiles();  // benches: of the newest resolve by tiles

    // Nothing to compose, nothing missing, nothing dirty: another frame from the same camera gives the same
    // picture.
    [[nodiscard]] bool settled() const;
    // Pages that wait to be composed, over all maps.
    [[nodiscard]] uint32_t pending_pages() const;

    // --- queries; the same composed pages as the picture ---
    [[nodiscard]] double height_m(double x_m, double y_m);
    [[nodiscard]] glm::dvec3 normal(double x_m, double y_m);
    [[nodiscard]] IndexTexel layer_at(double x_m, double y_m);
    [[nodiscard]] std::optional<glm::dvec3> ray_cast(glm::dvec3 origin_m, glm::dvec3 direction,
                                                     double max_m = 50'000, Holes holes = Holes::open);

    [[nodiscard]] FrameStatistics statistics() const;
    [[nodiscard]] const LayerSet& layers() const;
    // Benches: the newest frame's resolve again, over its depth and g-buffer, without sky; or the floor that
    // it is measured against (shaders/frame/resolve_floor.frag).
    enum class ResolveProbe { resolve, floor };
    Status resolve_again(gpu::FrameRing& ring, gpu::Commands& commands, const FrameSettings& settings,
                         ResolveProbe probe);
    // Tests: resident pages of all maps that differ from their composition from nothing.
    Result<uint32_t> count_stale_pages(gpu::FrameRing& ring);

  private:
    Renderer();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace loam
