#include "ui/utf8.h"

#include <algorithm>
#include <cstdint>

namespace loam::ui {

Decoded decode_utf8(std::string_view text, size_t at) {
    if (at >= text.size()) return {0, 0};
    const auto byte = [&](size_t i) { return uint32_t(uint8_t(text[at + i])); };
    const uint32_t lead = byte(0);
    if (lead < 0x80) return {char32_t(lead), 1};
    const size_t length = lead >= 0xF0 && lead < 0xF5   ? 4
                          : lead >= 0xE0 && lead < 0xF0 ? 3
                          : lead >= 0xC2 && lead < 0xE0 ? 2
                                                        : 0;
    if (length == 0 || at + length > text.size()) return {};
    uint32_t value = lead & (0x7Fu >> length);
    for (size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xC0u) != 0x80u) return {};
        value = value << 6 | (byte(i) & 0x3Fu);
    }
    const bool overlong = (length == 3 && value < 0x800) || (length == 4 && value < 0x10000);
    if (overlong || value > 0x10FFFF || (value >= 0xD800 && value < 0xE000)) return {};
    return {char32_t(value), length};
}

void append_utf8(std::string& text, char32_t codepoint) {
    uint32_t c = codepoint;
    if (c > 0x10FFFF || (c >= 0xD800 && c < 0xE000)) c = 0xFFFD;
    const auto tail = [](uint32_t bits) { return char(0x80u | (bits & 0x3Fu)); };
    if (c < 0x80) {
        text += char(c);
    } else if (c < 0x800) {
        text += {char(0xC0u | c >> 6), tail(c)};
    } else if (c < 0x10000) {
        text += {char(0xE0u | c >> 12), tail(c >> 6), tail(c)};
    } else {
        text += {char(0xF0u | c >> 18), tail(c >> 12), tail(c >> 6), tail(c)};
    }
}

size_t next_codepoint(std::string_view text, size_t at) {
    return std::min(text.size(), at + std::max<size_t>(1, decode_utf8(text, at).bytes));
}

// The longest well-formed sequence that ends at `at`, so that stepping back visits the same places as
// stepping on.
size_t previous_codepoint(std::string_view text, size_t at) {
    at = std::min(at, text.size());
    if (at == 0) return 0;
    for (size_t length = std::min<size_t>(4, at); length > 1; --length)
        if (decode_utf8(text.substr(0, at), at - length).bytes == length) return at - length;
    return at - 1;
}

}  // namespace loam::ui
