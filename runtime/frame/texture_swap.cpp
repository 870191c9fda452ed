#include "runtime/frame/texture_swap.h"

#include "runtime/document/document.h"

namespace loam {

namespace {

Result<std::unique_ptr<VirtualTexture>> make(const TextureSources& s, const VirtualTextureDesc& desc) {
    return VirtualTexture::create(s.device, s.document, s.indices, s.layers, desc);
}

}  // namespace

Status TextureSwap::replace(const TextureSources& sources, const VirtualTextureDesc& desc) {
    clear();
    auto made = make(sources, desc);
    if (!made) return made.error();
    shown_ = std::move(*made);
    return {};
}

void TextureSwap::clear() {
    next_.reset();
    shown_.reset();
}

Status TextureSwap::prepare(const TextureSources& sources, const VirtualTextureDesc& desc) {
    next_.reset();
    auto made = make(sources, desc);
    if (!made) return made.error();
    next_ = std::move(*made);
    waited_frames_ = 0;
    return {};
}

Status TextureSwap::take_settings() {
    for (VirtualTexture* t : {shown_.get(), next_.get()})
        if (t) LOAM_TRY(t->take_settings());
    return {};
}

void TextureSwap::on_dirt(const Dirt& dirt) {
    for (VirtualTexture* t : {shown_.get(), next_.get()}) {
        if (!t) continue;
        t->on_index_dirt(dirt.index);
        t->on_dirt(dirt.texture, dirt.texture_size_m);
        t->on_height_dirt(dirt.height);
    }
}

bool TextureSwap::next_is_ready(const TextureView& view, bool seen) const {
    if (next_->place_of(PageId{}) < 0) return false;
    if (!seen || waited_frames_ >= kLongestSwap) return true;
    return next_->settled() && next_->last_feedback_frame() >= view.same_since;
}

// While the next texture is made, its pages come first; a moving picture still needs some of its own.
TextureView TextureSwap::shown_view(const TextureView& view) const {
    TextureView shown = view;
    if (next_ && view.still) shown.budget_pages = 0;
    return shown;
}

void TextureSwap::request_inputs(const TextureView& view, bool seen) {
    if (next_ && next_is_ready(view, seen)) shown_ = std::move(next_);
    if (next_) {
        ++waited_frames_;
        next_->request_inputs(view);
    }
    shown_->request_inputs(shown_view(view));
}

Status TextureSwap::update(gpu::FrameRing& ring, gpu::Commands& commands, const TextureView& view) {
    if (next_) LOAM_TRY(next_->update(ring, commands, view));
    return shown_->update(ring, commands, shown_view(view));
}

Status TextureSwap::record_feedback(gpu::FrameRing& ring, gpu::Commands& commands,
                                    const FeedbackSource& source) {
    if (next_) LOAM_TRY(next_->record_feedback(ring, commands, source));
    return shown_->record_feedback(ring, commands, source);
}

}  // namespace loam
