#include "ui/glyph_atlas.h"

#include <cstring>
#include <utility>

namespace loam::ui {

GlyphAtlas::GlyphAtlas() : pixels_(size_t(kWidth) * kStartHeight), dirty_{0, 0, kWidth, kStartHeight} {}

std::optional<TexelRect> GlyphAtlas::add(int width, int height, const uint8_t* coverage, int stride) {
    const int need_w = width + 1, need_h = height + 1;
    if (width < 0 || height < 0 || need_w > kWidth) return std::nullopt;

    // The lowest shelf that fits without wasting more than a third of its height.
    Shelf* best = nullptr;
    for (Shelf& s : shelves_)
        if (s.height >= need_h && s.height * 2 <= need_h * 3 + 4 && s.next_x + need_w <= kWidth)
            if (!best || s.height < best->height) best = &s;
    if (!best) {
        const int y = shelves_.empty() ? 0 : shelves_.back().y + shelves_.back().height;
        while (y + need_h > height_ && height_ < kMaxHeight) {
            height_ *= 2;
            pixels_.resize(size_t(kWidth) * size_t(height_));
            dirty_ = {0, 0, kWidth, height_};
        }
        if (y + need_h > height_) {
            full_ = true;
            return std::nullopt;
        }
        best = &shelves_.emplace_back(Shelf{y, need_h, 0});
    }
    const TexelRect slot{best->next_x, best->y, best->next_x + width, best->y + height};
    best->next_x += need_w;
    for (int row = 0; row < height; ++row)
        std::memcpy(&pixels_[size_t(slot.y0 + row) * kWidth + size_t(slot.x0)],
                    coverage + ptrdiff_t(row) * stride, size_t(width));
    dirty_ = united(dirty_, slot);
    return slot;
}

void GlyphAtlas::clear() {
    std::fill(pixels_.begin(), pixels_.end(), uint8_t(0));
    shelves_.clear();
    full_ = false;
    dirty_ = {0, 0, kWidth, height_};
}

TexelRect GlyphAtlas::take_dirty() {
    return std::exchange(dirty_, {});
}

}  // namespace loam::ui
