// The virtual texture that the picture shows and, after a change of its size or format, the next one that is
// made ready beside it: the picture keeps the old texels until the new ones are there, so that no frame shows
// less than the one before. Then the old texture's memory goes back by the frame ring. Source: Call of Duty
// talk, "Scalability".
//
//   shown ──prepare──▶ shown + next ──next is ready (or kLongestSwap frames have passed)──▶ shown
#pragma once

#include <memory>
#include <span>

#include "runtime/texture/virtual_texture.h"

namespace loam {

struct Dirt;

// What a texture is made from; all outlive it.
struct TextureSources {
    gpu::Device& device;
    const Document& document;
    IndexMap& indices;
    LayerSet& layers;
};

class TextureSwap {
  public:
    // Frames that the next texture may take to have all that the picture wants; then its root must do. A
    // still picture at the largest level wants some 200 pages, at two pages a frame.
    static constexpr uint64_t kLongestSwap = 150;

    [[nodiscard]] VirtualTexture& shown() { return *shown_; }
    [[nodiscard]] const VirtualTexture& shown() const { return *shown_; }
    [[nodiscard]] bool pending() const { return next_ != nullptr; }

    // At once, with nothing to show before: at the start, and when the layers have changed.
    Status replace(const TextureSources& sources, const VirtualTextureDesc& desc);
    void clear();
    // Beside the shown one. After an error the shown one stays.
    Status prepare(const TextureSources& sources, const VirtualTextureDesc& desc);
    void cancel() { next_.reset(); }

    // After LayerSet::take_settings.
    Status take_settings();
    void on_dirt(const Dirt& dirt);
    // The frame's steps, of both; `seen`: the picture is shaded from the texture. request_inputs swaps first.
    void request_inputs(const TextureView& view, bool seen);
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, const TextureView& view);
    Status record_feedback(gpu::FrameRing& ring, gpu::Commands& commands, const FeedbackSource& source);

  private:
    [[nodiscard]] bool next_is_ready(const TextureView& view, bool seen) const;
    [[nodiscard]] TextureView shown_view(const TextureView& view) const;

    std::unique_ptr<VirtualTexture> shown_, next_;
    uint64_t waited_frames_ = 0;
};

}  // namespace loam
