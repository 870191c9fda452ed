// The adaptive virtual texture: sectors, virtual images with their page quad trees, the indirection texture,
// feedback, composition and compression. Pages are usable the frame after they were composed and rest three
// frames before their place is used again. Source: Call of Duty talk, from "Virtual Texture" to
// "Scalability".
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/maps/index_map.h"
#include "runtime/texture/feedback.h"
#include "runtime/texture/filter.h"
#include "runtime/texture/layer_set.h"
#include "runtime/texture/page_format.h"
#include "runtime/texture/page_id.h"
#include "runtime/texture/page_pool.h"
#include "runtime/texture/sector_set.h"
#include "shaders/frame/debug_io.h"

namespace loam {

inline constexpr uint32_t kUnusedIndirection = 0xfffffffeu;  // of expected_indirection

struct VirtualTextureDesc {
    int pages_per_side = 22;      // physical texture: very low 13, low 16, mid 22, high 30, ultra 42
    int indirection_size = 1024;  // texels a side, up to 1024
    PageFormat format = PageFormat::bc1x3;
    int max_live_sectors = 255;  // beside that, their root pages take at most a third of the physical texture
    int budget_pages = 2;        // whole pages composed a frame
    double budget_ms = 0;        // what they may take a frame, instead of a number; 0: budget_pages
    FeedbackCells feedback_cells = FeedbackCells::grid;
    FeedbackRules feedback_rules;
    PagePoolRules pool_rules;
    // Of each live sector that is not seen, the nearest page 1/2^depth of its image wide is kept, for as many
    // sectors as this part of the cache has places.
    int hidden_divisor = 16, hidden_depth = 4;
    bool decals = true;
};

struct TextureView {
    glm::dvec3 camera_m{0};
    double pixels_per_radian = 500;  // picture height / (2 tan(fov_y / 2)): sizes the sectors' images
    // Every sector that may have to be live, with the announced place's; see live_radius_m().
    std::span<const SectorDistance> near;
    double speed_m_s = 0;
    // Where the camera will be: its pages are requested too. Its feedback comes by record_feedback with
    // Eye::announced.
    std::optional<glm::dvec3> announced_m;
    uint64_t frame = 0;
    uint64_t same_since = 0;  // the first frame of this view
    // A still picture: every pixel is asked, and only what they want is shown, so that the picture depends on
    // the view and not on the way there.
    bool still = false;
    FilterRule filter;
    float mip_bias = 0;
    int budget_pages = -1;  // overrides VirtualTextureDesc::budget_pages when >= 0
    // While someone works: what a frame may take, and how long the last one took (0: unknown). Composition
    // adapts.
    double goal_ms = 0;  // 0: none
    double last_frame_ms = 0;
};

// Whose pages a feedback pass asks for: the picture's, or those of a place that the camera will jump to.
enum class Eye { camera, announced };

struct FeedbackSource {
    gpu::Image& depth;    // the prepass' (Access::depth_sampled)
    gpu::Image& gbuffer;  // normal.xy, log2 footprints (see frame_io.h)
    const gpu::Buffer& uniforms;
    uint64_t uniforms_offset = 0;
    glm::ivec2 picture_px{0};
    Eye eye = Eye::camera;
    float footprint_log2 =
        0;  // added to the footprints, where they are of a smaller picture than the one they speak for
};

class VirtualTexture {
  public:
    static Result<std::unique_ptr<VirtualTexture>> create(gpu::Device& device, const Document& document,
                                                          IndexMap& index, LayerSet& layers,
                                                          const VirtualTextureDesc& desc);
    ~VirtualTexture();

    // World rectangles whose texels change: decals, and index dirt grown by one index spacing of level 0 (its
    // filter). What coarser levels need beyond that is added here. Pages that are too coarse to show a decal
    // of size_m (Dirt::texture_size_m) stay as they are; what has no size is infinitely large.
    void on_dirt(std::span<const WorldRect> rects, double size_m);
    // Index dirt as the document tells it: what it changes of the tints' blocks and what filters over them.
    void on_index_dirt(std::span<const WorldRect> rects);
    // After LayerSet::take_settings: every page is composed again.
    Status take_settings();
    // Height dirt as the document tells it: volume decals lie on the ground.
    void on_height_dirt(std::span<const WorldRect> rects);
    // Pages wanted beside the feedback's, until the next call (tests, benches).
    void request_pages(std::span<const PageId> pages);
    // Sectors farther than this from every eye are not live.
    [[nodiscard]] double live_radius_m(double pixels_per_radian, float mip_bias) const;

    // Takes in feedback, chooses what to compose and requests the index pages for it; call before
    // IndexMap::update.
    void request_inputs(const TextureView& view);
    // Makes last frame's pages usable, applies feedback, composes dirty rectangles first, then missing pages
    // within the budget, and updates indirection and sector table.
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, const TextureView& view);
    // After the prepass: the wanted pages, read back when the GPU has passed this frame.
    Status record_feedback(gpu::FrameRing& ring, gpu::Commands& commands, const FeedbackSource& source);

    // --- for shaders that include shaders/texture/vt_sample.glsl (its head says which slots) ---
    // Physical texture 0 … 3, channels as in page_format.h; one that the format has not got: its last, as
    // every slot of a shader is bound to something.
    [[nodiscard]] gpu::Image& atlas(int which);
    [[nodiscard]] const PageTextures& textures() const;
    [[nodiscard]] gpu::Image& indirection();  // R32_UINT
    [[nodiscard]] gpu::Buffer& sector_table();
    [[nodiscard]] gpu::Buffer& params();  // VtParams of this frame
    [[nodiscard]] const gpu::Sampler& sampler() const;
    [[nodiscard]] const gpu::Sampler& nearest_sampler() const;  // of integer images
    // For shaders/texture/direct.glsl.
    [[nodiscard]] gpu::Buffer& direct_params();  // DirectParams of this frame
    [[nodiscard]] gpu::Buffer& direct_places();  // LayerPlace a layer, relative to the camera's sector

    // Nothing dirty, nothing missing, and a feedback of a frame rendered after the last change wanted nothing
    // that is missing. It speaks of the views rendered so far: after moving or turning the camera wait until
    // last_feedback_frame() reaches the TextureView::frame of the new view.
    [[nodiscard]] bool settled() const;
    [[nodiscard]] uint64_t last_feedback_frame() const;
    // Of the newest feedback: how far what is shown is from what is wanted.
    struct Sharpness {
        uint64_t view_frame = 0;  // TextureView::frame of the picture it speaks of
        uint32_t cells = 0;       // that see terrain
        std::array<uint32_t, 8>
            coarser{};  // cells by how many mips they show coarser than wanted; [7]: or more
    };
    struct Statistics {
        uint32_t resident_pages = 0, capacity_pages = 0, live_sectors = 0, requested_pages = 0,
                 missing_pages = 0;
        uint32_t dirty_pages = 0;
        uint32_t low_res_pages = 0;      // composed from coarser inputs, to be composed again
        uint32_t announced_missing = 0;  // of the announced place's pages
        uint32_t feedback_cells = 0;     // of the newest frame
        uint32_t hidden_pages = 0;       // wanted for sectors that are not seen
        double page_ms = 0;              // what composing one takes, as far as known
        uint64_t indirection_texels = 0, indirection_capacity = 0;
        // Images made smaller than wanted as the indirection texture is full, and the widest of those (log2
        // pages).
        uint32_t capped_images = 0;
        int image_cap_log2 = kMaxSectorLog2Width;
        uint64_t indirection_repacks = 0;
        Sharpness sharpness;
        uint64_t pages_dirtied = 0, pages_composed = 0, rects_composed = 0,
                 texels_composed = 0;  // since start
        uint64_t gpu_bytes = 0;
    };
    [[nodiscard]] Statistics statistics() const;
    [[nodiscard]] const VirtualTextureDesc& desc() const;  // as made

    // Debug views: of every place, row by row; counting decals looks at the document for each.
    enum class DecalCount { none, counted };
    [[nodiscard]] std::vector<shared::VtPlaceFacts> place_facts(DecalCount decals) const;
    [[nodiscard]] std::vector<shared::VtImageSquare> image_squares() const;

    // Tests: every resident page composed again from nothing into scratch and compared with what is in the
    // atlas. Returns the number of pages that differ in any byte (all mips, all textures).
    Result<uint32_t> count_stale_pages(gpu::FrameRing& ring);
    // Tests: what the CPU's quad trees say the indirection texture holds, row by row with all its mips;
    // places outside all images are kUnusedIndirection.
    [[nodiscard]] std::vector<uint32_t> expected_indirection() const;
    // Tests: every page in a quad tree is the one its place holds, composed and of the generation that
    // entered. Empty: all is well.
    [[nodiscard]] std::string tree_fault() const;
    [[nodiscard]] const TextureLayout& layout() const;
    [[nodiscard]] int place_of(
        const PageId& page) const;  // physical page y * pages a side + x, if usable; else -1

  private:
    VirtualTexture();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace loam
