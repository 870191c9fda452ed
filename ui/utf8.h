// UTF-8 by hand: every byte sequence decodes (what is malformed becomes U+FFFD, one a byte), nothing throws.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace loam::ui {

struct Decoded {
    char32_t codepoint = 0xFFFD;
    size_t bytes = 1;  // consumed, at least 1 unless at the end
};

[[nodiscard]] Decoded decode_utf8(std::string_view text, size_t at);
void append_utf8(std::string& text, char32_t codepoint);  // surrogates and values over 10FFFF become U+FFFD
[[nodiscard]] size_t next_codepoint(std::string_view text, size_t at);
[[nodiscard]] size_t previous_codepoint(std::string_view text, size_t at);

}  // namespace loam::ui
