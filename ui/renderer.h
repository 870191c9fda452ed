// Draws a DrawList. Two steps a frame: `prepare` before rendering begins (copies quads and new glyphs),
// `cmd_record` inside it. The target is UNORM; colours are sRGB-encoded and blended so.
#pragma once

#include <unordered_map>

#include "runtime/gpu/frame_ring.h"
#include "ui/draw_list.h"

namespace loam::ui {

class UiRenderer {
  public:
    static Result<UiRenderer> create(gpu::Device& device, VkFormat color_format);

    // Pictures of the application, in SHADER_READ_ONLY layout when drawn. They are borrowed: remove or
    // replace one before it is destroyed. Removing forgets the id; a draw list that still names it draws
    // nothing there.
    [[nodiscard]] TextureId add_image(VkImageView view);
    void set_image(TextureId id, VkImageView view);
    void remove_image(TextureId id);

    // Outside rendering.
    Status prepare(gpu::FrameRing& ring, gpu::Commands& commands, const DrawList& list, GlyphAtlas& atlas);
    // Inside rendering to a colour target of the whole window.
    void cmd_record(gpu::Commands& commands, VkExtent2D extent);

  private:
    UiRenderer(gpu::Device& device, gpu::Pipeline shapes, gpu::Pipeline images, gpu::Sampler nearest,
               gpu::Sampler linear);
    Status upload_atlas(gpu::FrameRing& ring, gpu::Commands& commands, GlyphAtlas& atlas);

    gpu::Device* device_;
    gpu::Pipeline shapes_, images_;
    gpu::Sampler nearest_, linear_;
    gpu::Image atlas_;
    std::unordered_map<TextureId, VkImageView> views_;
    TextureId next_id_ = 1;
    gpu::UploadSlice quads_;
    std::vector<DrawRun> runs_;
};

}  // namespace loam::ui
