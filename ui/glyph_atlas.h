// One R8 coverage picture for glyphs and icons, filled by shelves. Slots are in texels, so growing does not
// move anything. It grows by doubling its height up to kMaxHeight; when it is full there, `add` fails and the
// owner clears it at the start of its next frame, when no slot is in use.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/base/rect.h"

namespace loam::ui {

class GlyphAtlas {
  public:
    static constexpr int kWidth = 1024, kStartHeight = 256, kMaxHeight = 2048;

    GlyphAtlas();
    // Copies width × height coverage bytes, rows `stride` apart, with a free texel around; nothing when full.
    std::optional<TexelRect> add(int width, int height, const uint8_t* coverage, int stride);
    void clear();

    [[nodiscard]] int width() const { return kWidth; }
    [[nodiscard]] int height() const { return height_; }
    [[nodiscard]] std::span<const uint8_t> pixels() const { return pixels_; }
    [[nodiscard]] bool full() const { return full_; }
    // Texels changed since the last call.
    TexelRect take_dirty();

  private:
    struct Shelf {
        int y = 0, height = 0, next_x = 0;
    };
    std::vector<uint8_t> pixels_;
    std::vector<Shelf> shelves_;
    int height_ = kStartHeight;
    bool full_ = false;
    TexelRect dirty_{};
};

}  // namespace loam::ui
