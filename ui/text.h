// Text: FreeType outlines, HarfBuzz shaping, glyphs in the atlas at quarter-pixel positions.
//
// Fonts are found at run time: Inter, and DejaVu Sans for what Inter lacks. A code point that no font has is
// drawn as a box. Text is laid out left to right; bidirectional text is not supported. Light hinting: stems
// snap vertically (crisp baselines), horizontal positions and advances stay those of the outline, so that
// widths scale.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "ui/geometry.h"
#include "ui/glyph_atlas.h"
#include "ui/icons.h"

namespace loam::ui {

enum class Weight : uint8_t { regular, medium, semibold, mono };  // mono: of one width, for code

struct TextStyle {
    Weight weight = Weight::regular;
    float size_px = 13;  // physical pixels an em
    bool operator==(const TextStyle&) const = default;
};

struct FontFiles {
    std::vector<std::string> regular{}, medium{}, semibold{},
        mono{};                                            // candidates, the first that opens is taken
    std::vector<std::string> fallbacks{};                  // asked in order for glyphs the first lacks
};
[[nodiscard]] FontFiles default_font_files();

struct FontMetrics {
    float ascent = 0, descent = 0;  // both positive, pixels
    float cap_height = 0;
};

struct ShapedGlyph {
    int face = -1;  // -1: box for a missing glyph
    uint32_t glyph = 0;
    float x = 0, y = 0;  // pen position, from the start of the text and its baseline, Y down
    float advance = 0;
};
struct CaretStop {
    size_t byte = 0;
    float x = 0;
};
struct ShapedText {
    std::vector<ShapedGlyph> glyphs;
    std::vector<CaretStop> carets;  // one a code point boundary, the end included; x never decreases
    float width = 0;
};

// Where a picture lies in the atlas and how it hangs on the pen, in whole pixels.
struct AtlasSlot {
    TexelRect texels{};
    int left = 0, top = 0;  // top: upwards from the baseline
};

class Text {
  public:
    static Result<std::unique_ptr<Text>> create(const FontFiles& files = default_font_files());
    ~Text();
    Text(const Text&) = delete;

    // Drops what was not used lately and clears a full atlas: slots do not outlive a frame.
    void begin_frame();

    [[nodiscard]] FontMetrics metrics(TextStyle style);
    // Valid until the next begin_frame.
    [[nodiscard]] const ShapedText& shape(std::string_view utf8, TextStyle style);
    [[nodiscard]] float measure(std::string_view utf8, TextStyle style) { return shape(utf8, style).width; }
    // The text itself when it fits, else its longest beginning that does with "…" after it.
    [[nodiscard]] std::string ellipsis(std::string_view utf8, TextStyle style, float width_px);

    [[nodiscard]] AtlasSlot glyph_slot(const ShapedGlyph& glyph, TextStyle style, int quarter);
    [[nodiscard]] AtlasSlot icon_slot(Icon icon, int size_px);
    [[nodiscard]] GlyphAtlas& atlas() { return atlas_; }

  private:
    struct Fonts;  // FreeType and HarfBuzz
    struct Caches;
    Text();
    GlyphAtlas atlas_;
    std::unique_ptr<Fonts> fonts_;
    std::unique_ptr<Caches> caches_;
    uint64_t frame_ = 0;
};

// Byte offset of the caret stop nearest to x, and x of the stop at a byte.
[[nodiscard]] size_t caret_at_x(const ShapedText& shaped, float x);
[[nodiscard]] float caret_x(const ShapedText& shaped, size_t byte);

}  // namespace loam::ui
