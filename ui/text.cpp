#include "ui/text.h"

#include <cmath>
#include <cstring>
#include <map>
#include <tuple>
#include <unordered_map>

#include <hb-ft.h>
#include <hb.h>

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include "runtime/base/check.h"
#include "ui/utf8.h"

namespace loam::ui {
namespace {

constexpr FT_Int32 kLoadFlags = FT_LOAD_TARGET_LIGHT | FT_LOAD_NO_BITMAP;
constexpr uint64_t kKeepFrames = 120;      // a shaped text lives so long unused
constexpr size_t kShapedTextLimit = 4096;  // texts kept before sweeping
constexpr float kBoxWidthEm = 0.6f;        // box of a missing glyph

struct SizedFace {
    FT_Face face = nullptr;
    hb_font_t* font = nullptr;
};

// "{}" of a style that does not depend on floating-point noise: 26.6 fixed point.
long size_26_6(float size_px) {
    return std::lround(std::clamp(size_px, 4.0f, 400.0f) * 64.0f);
}

// Fonts hold no control characters; line ends and tabs become spaces.
char32_t printable(char32_t c) {
    return c < 0x20 || c == 0x7F ? U' ' : c;
}

}  // namespace

struct Text::Fonts {
    FT_Library library = nullptr;
    std::vector<FT_Face> faces;  // by Weight, then fallbacks …
    std::vector<std::string> paths;
    std::map<std::pair<int, long>, SizedFace> sized;  // own FT_Face a size: no size switching
    hb_buffer_t* buffer = nullptr;

    ~Fonts() {
        for (auto& [key, s] : sized) {
            hb_font_destroy(s.font);
            FT_Done_Face(s.face);
        }
        for (FT_Face f : faces) FT_Done_Face(f);
        if (buffer) hb_buffer_destroy(buffer);
        if (library) FT_Done_FreeType(library);
    }

    bool open_first(const std::vector<std::string>& candidates) {
        for (const std::string& path : candidates) {
            FT_Face face = nullptr;
            if (FT_New_Face(library, path.c_str(), 0, &face) != 0) continue;
            if (!FT_IS_SCALABLE(face)) {
                FT_Done_Face(face);
                continue;
            }
            faces.push_back(face);
            paths.push_back(path);
            return true;
        }
        return false;
    }

    SizedFace& at_size(int face, float size_px) {
        const long size = size_26_6(size_px);
        SizedFace& s = sized[{face, size}];
        if (!s.face) {
            const FT_Error failed = FT_New_Face(library, paths[size_t(face)].c_str(), 0, &s.face);
            LOAM_CHECK(failed == 0, "a font file vanished while in use: " + paths[size_t(face)]);
            FT_Set_Char_Size(s.face, size, size, 72, 72);
            s.font = hb_ft_font_create_referenced(s.face);
            hb_ft_font_set_load_flags(s.font, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP);
        }
        return s;
    }

    int face_for(char32_t c, int first) const {
        if (FT_Get_Char_Index(faces[size_t(first)], c) != 0) return first;
        for (size_t i = 3; i < faces.size(); ++i)
            if (FT_Get_Char_Index(faces[i], c) != 0) return int(i);
        return -1;
    }
};

struct Text::Caches {
    struct Shaped {
        ShapedText text;
        uint64_t used = 0;
    };
    std::unordered_map<std::string, Shaped> shaped;
    std::map<std::tuple<int, uint32_t, long, int>, AtlasSlot> glyphs;  // face, glyph, size, quarter
    std::map<std::pair<int, int>, AtlasSlot> icons;
    std::string key;
};

FontFiles default_font_files() {
    const std::string inter = "/usr/share/fonts/opentype/inter/Inter-";
    const std::string dejavu = "/usr/share/fonts/truetype/dejavu/DejaVuSans";
    return {
        .regular = {inter + "Regular.otf", dejavu + ".ttf"},
        .medium = {inter + "Medium.otf", inter + "Regular.otf", dejavu + ".ttf"},
        .semibold = {inter + "SemiBold.otf", inter + "Regular.otf", dejavu + "-Bold.ttf", dejavu + ".ttf"},
        .mono = {dejavu + "Mono.ttf", dejavu + ".ttf", inter + "Regular.otf"},
        .fallbacks = {dejavu + ".ttf"}};
}

Text::Text() : fonts_(std::make_unique<Fonts>()), caches_(std::make_unique<Caches>()) {}
Text::~Text() = default;

Result<std::unique_ptr<Text>> Text::create(const FontFiles& files) {
    std::unique_ptr<Text> text(new Text);
    Fonts& fonts = *text->fonts_;
    if (FT_Init_FreeType(&fonts.library) != 0) return error("cannot initialise FreeType");
    fonts.buffer = hb_buffer_create();
    for (const auto* candidates : {&files.regular, &files.medium, &files.semibold, &files.mono})
        if (!fonts.open_first(*candidates)) {
            std::string tried;
            for (const std::string& path : *candidates) tried += (tried.empty() ? "" : ", ") + path;
            return error("no interface font found; install fonts-inter or fonts-dejavu-core (tried: {})",
                         tried.empty() ? "nothing" : tried);
        }
    for (const std::string& path : files.fallbacks) fonts.open_first({path});
    return text;
}

void Text::begin_frame() {
    ++frame_;
    if (atlas_.full()) {
        atlas_.clear();
        caches_->glyphs.clear();
        caches_->icons.clear();
    }
    if (caches_->shaped.size() > kShapedTextLimit)
        std::erase_if(caches_->shaped,
                      [this](const auto& e) { return e.second.used + kKeepFrames < frame_; });
    if (caches_->shaped.size() > 2 * kShapedTextLimit) caches_->shaped.clear();
}

FontMetrics Text::metrics(TextStyle style) {
    const FT_Face face = fonts_->at_size(int(style.weight), style.size_px).face;
    const float em = float(face->units_per_EM), size = style.size_px;
    FontMetrics m{.ascent = float(face->ascender) / em * size,
                  .descent = -float(face->descender) / em * size};
    const FT_UInt glyph = FT_Get_Char_Index(face, U'H');
    m.cap_height = size * 0.72f;
    if (FT_Load_Glyph(face, glyph, kLoadFlags) == 0)
        m.cap_height = float(face->glyph->metrics.horiBearingY) / 64.0f;
    return m;
}

const ShapedText& Text::shape(std::string_view utf8, TextStyle style) {
    std::string& key = caches_->key;
    const long size = size_26_6(style.size_px);
    key.assign(reinterpret_cast<const char*>(&size), sizeof size);
    key += char(style.weight);
    key += utf8;
    auto [entry, fresh] = caches_->shaped.try_emplace(key);
    entry->second.used = frame_;
    ShapedText& out = entry->second.text;
    if (!fresh) return out;

    struct Unit {
        char32_t c;
        size_t byte;
        int face;
    };
    std::vector<Unit> units;
    for (size_t at = 0; at < utf8.size();) {
        const Decoded d = decode_utf8(utf8, at);
        const char32_t c = printable(d.codepoint);
        units.push_back({c, at, fonts_->face_for(c, int(style.weight))});
        at += d.bytes;
    }
    std::vector<CaretStop> starts;  // of clusters
    float pen = 0;
    for (size_t begin = 0; begin < units.size();) {
        size_t end = begin + 1;
        while (end < units.size() && units[end].face == units[begin].face) ++end;
        const int face = units[begin].face;
        if (face < 0) {
            for (size_t i = begin; i < end; ++i) {
                const float advance = kBoxWidthEm * style.size_px;
                starts.push_back({units[i].byte, pen});
                out.glyphs.push_back({-1, 0, pen, 0, advance});
                pen += advance;
            }
        } else {
            hb_buffer_reset(fonts_->buffer);
            for (size_t i = begin; i < end; ++i)
                hb_buffer_add(fonts_->buffer, units[i].c, static_cast<unsigned>(units[i].byte));
            hb_buffer_set_content_type(fonts_->buffer, HB_BUFFER_CONTENT_TYPE_UNICODE);
            hb_buffer_set_direction(fonts_->buffer, HB_DIRECTION_LTR);
            hb_buffer_guess_segment_properties(fonts_->buffer);
            hb_shape(fonts_->at_size(face, style.size_px).font, fonts_->buffer, nullptr, 0);
            unsigned count = 0;
            const hb_glyph_info_t* info = hb_buffer_get_glyph_infos(fonts_->buffer, &count);
            const hb_glyph_position_t* position = hb_buffer_get_glyph_positions(fonts_->buffer, &count);
            for (unsigned i = 0; i < count; ++i) {
                if (starts.empty() || info[i].cluster > starts.back().byte)
                    starts.push_back({info[i].cluster, pen});
                const float advance = float(position[i].x_advance) / 64.0f;
                out.glyphs.push_back({face, info[i].codepoint, pen + float(position[i].x_offset) / 64.0f,
                                      -float(position[i].y_offset) / 64.0f, advance});
                pen += advance;
            }
        }
        begin = end;
    }
    out.width = std::max(0.0f, pen);
    starts.push_back({utf8.size(), out.width});

    // Code points inside a cluster (ligatures, marks) share its width evenly.
    out.carets.reserve(units.size() + 1);
    for (size_t i = 0, s = 0; i <= units.size(); ++i) {
        const size_t byte = i < units.size() ? units[i].byte : utf8.size();
        while (s + 1 < starts.size() && starts[s + 1].byte <= byte) ++s;
        float x = starts[s].x;
        if (s + 1 < starts.size() && byte > starts[s].byte)
            x += (starts[s + 1].x - x) * float(byte - starts[s].byte) /
                 float(starts[s + 1].byte - starts[s].byte);
        if (!out.carets.empty()) x = std::max(x, out.carets.back().x);
        out.carets.push_back({byte, x});
    }
    return out;
}

std::string Text::ellipsis(std::string_view utf8, TextStyle style, float width_px) {
    const ShapedText& whole = shape(utf8, style);
    if (whole.width <= width_px) return std::string(utf8);
    constexpr std::string_view kDots = "…";
    const float dots = measure(kDots, style);
    size_t bytes = 0;
    for (const CaretStop& stop : shape(utf8, style).carets)
        if (stop.x + dots <= width_px) bytes = stop.byte;
    while (bytes > 0 && utf8[bytes - 1] == ' ') --bytes;
    // Kerning against the dots may add a fraction: shorten until it really fits.
    while (true) {
        std::string candidate(utf8.substr(0, bytes));
        candidate += kDots;
        if (bytes == 0) return dots <= width_px ? candidate : std::string();
        if (measure(candidate, style) <= width_px) return candidate;
        bytes = previous_codepoint(utf8, bytes);
    }
}

AtlasSlot Text::glyph_slot(const ShapedGlyph& glyph, TextStyle style, int quarter) {
    if (glyph.face < 0) return {};
    const auto key = std::tuple(glyph.face, glyph.glyph, size_26_6(style.size_px), quarter);
    if (const auto found = caches_->glyphs.find(key); found != caches_->glyphs.end()) return found->second;

    AtlasSlot slot;
    const FT_Face face = fonts_->at_size(glyph.face, style.size_px).face;
    if (FT_Load_Glyph(face, glyph.glyph, kLoadFlags) == 0 && face->glyph->format == FT_GLYPH_FORMAT_OUTLINE) {
        FT_Outline_Translate(&face->glyph->outline, quarter * 16, 0);
        if (FT_Render_Glyph(face->glyph, FT_RENDER_MODE_NORMAL) == 0) {
            const FT_Bitmap& b = face->glyph->bitmap;
            slot.left = face->glyph->bitmap_left;
            slot.top = face->glyph->bitmap_top;
            if (b.width > 0 && b.rows > 0) {
                const auto texels = atlas_.add(int(b.width), int(b.rows), b.buffer, b.pitch);
                if (!texels) return {};  // full: not remembered, drawn again after the atlas is cleared
                slot.texels = *texels;
            }
        }
    }
    caches_->glyphs.emplace(key, slot);
    return slot;
}

AtlasSlot Text::icon_slot(Icon icon, int size_px) {
    const auto key = std::pair(int(icon), size_px);
    if (const auto found = caches_->icons.find(key); found != caches_->icons.end()) return found->second;
    const std::vector<uint8_t> picture = rasterise_icon(icon, size_px);
    const auto texels = atlas_.add(size_px, size_px, picture.data(), size_px);
    if (!texels) return {};
    return caches_->icons.emplace(key, AtlasSlot{.texels = *texels}).first->second;
}

size_t caret_at_x(const ShapedText& shaped, float x) {
    size_t best = 0;
    float nearest = 1e30f;
    for (const CaretStop& stop : shaped.carets)
        if (const float d = std::abs(stop.x - x); d < nearest) nearest = d, best = stop.byte;
    return best;
}

float caret_x(const ShapedText& shaped, size_t byte) {
    for (const CaretStop& stop : shaped.carets)
        if (stop.byte >= byte) return stop.x;
    return shaped.width;
}

}  // namespace loam::ui
