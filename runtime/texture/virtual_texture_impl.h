// What the parts of VirtualTexture share. One frame:
//
//   advance (request_inputs)  frame counter; pages of the last frame enter the trees; feedback; live sectors
//   and their sizes; what
//                             is wanted, missing and in the way
//   update                    choose jobs whose index page is ready; compose; write indirection, tables and
//   parameters record_feedback           after the prepass
#pragma once

#include <array>
#include <memory>
#include <unordered_set>
#include <vector>

#include "runtime/texture/compose_budget.h"
#include "runtime/texture/compose_plan.h"
#include "runtime/texture/composer.h"
#include "runtime/texture/feedback.h"
#include "runtime/texture/page_facts.h"
#include "runtime/texture/page_pool.h"
#include "runtime/texture/sector_set.h"
#include "runtime/texture/virtual_texture.h"

namespace loam {

struct VirtualTexture::Impl {
    // Feedback read back; shared with the closure that fills it, which may outlive the texture.
    struct Inbox {
        bool fresh = false, exact = false;
        std::vector<uint32_t> values;
        FeedbackImages images;
        uint64_t frame = 0, view_frame = 0;
    };
    // What shaders read to look at the texture from one place, and what they want.
    struct EyeState {
        gpu::Buffer params, sector_table, feedback;
        glm::ivec2 table_sector{1 << 30};
        bool table_changed = true;
        std::shared_ptr<Inbox> inbox = std::make_shared<Inbox>();
        std::vector<PageRequest> requests;  // of the newest feedback
    };

    Impl(gpu::Device& d, const Document& doc, IndexMap& i, LayerSet& l, const VirtualTextureDesc& s,
         const PageTextures& p, const TextureLayout& t, const SectorSetDesc& sector_desc)
        : device(d),
          document(doc),
          index(i),
          layers(l),
          desc(s),
          textures(p),
          layout(t),
          pool(s.pages_per_side, s.pool_rules),
          sectors(sector_desc),
          entered(size_t(pool.place_count()), 0),
          popularity(size_t(pool.place_count()), 0),
          shown(size_t(pool.place_count()), 0),
          facts(pool.place_count()) {}

    // virtual_texture_plan.cpp
    void advance(const TextureView& view);
    void take_feedback(const TextureView& view, Eye eye);
    void update_sectors(const TextureView& view);
    void drop_image(const ImageId& image);
    void refill_image(const ImageId& image);
    void mark_seen(const std::vector<PageRequest>& wanted);
    void want_hidden();
    void keep_only_wanted(const TextureView& view);
    void choose_dirty(std::vector<ComposeJob>& jobs);
    [[nodiscard]] int pages_left(const TextureView& view,
                                 int64_t dirt_texels) const;                    // of the frame's budget
    [[nodiscard]] int choose_missing(int left, std::vector<ComposeJob>& jobs);  // returns what is left then
    void choose_low_res(int left, std::vector<ComposeJob>& jobs);
    // All there; only a coarser index page, or layers' tails; no index page without dirt.
    enum class InputState { ready, low_res, absent };
    struct Inputs {
        MapPage page;  // what there is
        InputState state;
        LayerTier tier = LayerTier::whole;
    };
    // `priority` is that of its layers, where they have to be waited for.
    [[nodiscard]] Inputs inputs_of(const PageId& page, float priority) const;
    void touch_tables() {
        for (EyeState& eye : eyes) eye.table_changed = true;
    }
    [[nodiscard]] EyeState& eye_state(Eye eye) { return eyes[size_t(eye)]; }
    [[nodiscard]] const EyeState& camera_eye() const { return eyes[0]; }
    void enter_tree(int place);
    void leave_tree(int place);
    void gather_missing();
    void find_shown();
    void want(const PageRequest& request);
    void make_room();
    void gather_dirty();
    // rect_of(rect, spacing of the index level that the page is composed from): what of the page is dirty.
    template <typename RectOf>
    void take_dirt(std::span<const WorldRect> rects, double size_m, RectOf&& rect_of);
    [[nodiscard]] MapPage index_page(const PageId& page) const;
    [[nodiscard]] uint32_t indirection_texel(int place, int log2_width) const;
    [[nodiscard]] std::vector<ComposeJob> choose_jobs(const TextureView& view);
    [[nodiscard]] ComposeJob make_job(int place, const TexelRect& rect, const Inputs& from) const;
    // Wanted pages that were composed from coarser inputs.
    [[nodiscard]] uint32_t low_res_count() const;
    [[nodiscard]] bool shows(const PageId& page, double size_m) const;  // a decal of this size
    [[nodiscard]] bool has_dirt() const { return !dirty.empty(); }

    // virtual_texture.cpp
    Status make_resources();
    Status make_direct_places();  // as many as there are layers
    void cmd_indirection(gpu::FrameRing& ring, gpu::Commands& commands);
    void cmd_eye(gpu::Commands& commands, const TextureView& view, EyeState& eye, const glm::dvec3& at_m);
    void cmd_direct(gpu::Commands& commands, const TextureView& view);

    gpu::Device& device;
    const Document& document;
    IndexMap& index;
    LayerSet& layers;
    VirtualTextureDesc desc;
    PageTextures textures;
    TextureLayout layout;
    PagePool pool;
    SectorSet sectors;
    std::unique_ptr<Composer> composer;

    PageAtlas atlas;
    gpu::Image indirection;
    std::array<EyeState, 2> eyes;  // by Eye
    gpu::Buffer direct_params, direct_places;
    gpu::Sampler linear, nearest;
    gpu::Pipeline fill_pipeline, feedback_pipeline;

    uint64_t frame = 0;                                    // counts updates
    uint64_t view_frame = 0;                               // TextureView::frame of the newest
    uint64_t changed_frame = 0;                            // last update that changed anything a shader sees
    uint64_t feedback_frame = 0, feedback_view_frame = 0;  // of the newest feedback taken in
    bool feedback_exact = false;
    bool still = false;                           // TextureView's, of the newest
    uint64_t same_since = 0, kept_since = ~0ull;  // the view that keep_only_wanted has been done for
    Sharpness sharpness;
    bool advanced = false;
    FeedbackCells recorded_cells = FeedbackCells::grid;  // of this frame's feedback

    std::vector<PageRequest> asked;    // by request_pages
    std::vector<PageRequest> missing;  // absent, most wanted first
    uint32_t announced_missing = 0;
    std::unordered_set<MapPage, MapPageHash>
        stale_inputs;                  // index pages with dirt of their own left, in this update
    std::vector<uint32_t> entered;     // by place: generation of its page that entered a tree
    std::vector<uint32_t> popularity;  // by place, of this frame's wishes; 0: not wanted
    std::vector<uint32_t> shown;       // by place: cells of the newest feedback that see this page
    PageFacts facts;
    std::vector<DirtyPage> dirty;  // in the order in which they are composed
    glm::dvec2 camera_m{0};
    ComposeBudget budget;
    ComposePrice price;
    uint32_t hidden_pages = 0;
    int64_t composed_texels = 0;  // by the last update
    Statistics counted;
};

}  // namespace loam
