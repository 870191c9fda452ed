// What the parts of VirtualTexture share. One frame:
//
//   advance   (request_inputs)  frame counter; pages of the last frame enter the trees; feedback; live
//   sectors; what is missing update                      choose jobs whose index page is ready; compose;
//   write indirection, table and parameters record_feedback             after the prepass
#pragma once

#include <memory>
#include <unordered_set>
#include <vector>

#include "runtime/texture/compose_budget.h"
#include "runtime/texture/composer.h"
#include "runtime/texture/feedback.h"
#include "runtime/texture/page_pool.h"
#include "runtime/texture/sector_set.h"
#include "runtime/texture/virtual_texture.h"

namespace loam {

struct VirtualTexture::Impl {
    // Feedback read back; shared with the closure that fills it, which may outlive the texture.
    struct Inbox {
        bool fresh = false;
        std::vector<uint32_t> values;
        FeedbackImages images;
        uint64_t frame = 0, view_frame = 0;
    };

    Impl(gpu::Device& d, const Document& doc, IndexMap& i, LayerSet& l, const VirtualTextureDesc& s,
         const TextureLayout& t, const SectorSetDesc& sector_desc)
        : device(d),
          document(doc),
          index(i),
          layers(l),
          desc(s),
          layout(t),
          pool(s.pages_per_side),
          sectors(sector_desc),
          inbox(std::make_shared<Inbox>()),
          popularity(size_t(pool.place_count()), 0),
          shown(size_t(pool.place_count()), 0) {}

    // virtual_texture_plan.cpp
    void advance(const TextureView& view);
    void take_feedback();
    void drop_image(const ImageId& image);
    void enter_tree(int place);
    void leave_tree(int place);
    void gather_missing();
    void find_shown();
    void want(const PageRequest& request);
    void make_room();
    void order_dirty();
    [[nodiscard]] MapPage index_page(const PageId& page) const;
    [[nodiscard]] uint32_t indirection_texel(int place) const;
    [[nodiscard]] std::vector<ComposeJob> choose_jobs(const TextureView& view);
    [[nodiscard]] ComposeJob make_job(int place, const TexelRect& rect) const;
    [[nodiscard]] bool has_dirt() const { return !dirty_order.empty(); }

    // virtual_texture.cpp
    Status make_resources();
    void cmd_indirection(gpu::FrameRing& ring, gpu::Commands& commands);
    void cmd_parameters(gpu::Commands& commands, const TextureView& view);

    gpu::Device& device;
    const Document& document;
    IndexMap& index;
    LayerSet& layers;
    VirtualTextureDesc desc;
    TextureLayout layout;
    PagePool pool;
    SectorSet sectors;
    std::unique_ptr<Composer> composer;

    PageAtlas atlas;
    gpu::Image indirection;
    gpu::Buffer sector_table, params, direct_params, direct_places, feedback;
    gpu::Sampler linear, nearest;
    gpu::Pipeline fill_pipeline, feedback_pipeline;

    uint64_t frame = 0;                                    // counts updates
    uint64_t view_frame = 0;                               // TextureView::frame of the newest
    uint64_t changed_frame = 0;                            // last update that changed anything a shader sees
    uint64_t feedback_frame = 0, feedback_view_frame = 0;  // of the newest feedback taken in
    bool advanced = false;
    glm::ivec2 table_sector{1 << 30};
    bool table_changed = true;

    std::shared_ptr<Inbox> inbox;
    std::vector<PageRequest> requests;  // of the newest feedback
    std::vector<PageRequest> asked;     // by request_pages
    std::vector<PageRequest> missing;   // absent, most wanted first
    std::vector<uint32_t> popularity;   // by place, of this frame's wishes; 0: not wanted
    std::vector<uint32_t> shown;        // by place: cells of the newest feedback that see this page
    std::vector<int> dirty_order;       // dirty places: those seen, those wanted, the others; nearest first
    glm::dvec2 camera_m{0};
    ComposeBudget budget;
    int64_t composed_texels = 0;  // by the last update
    Statistics counted;
};

}  // namespace loam
