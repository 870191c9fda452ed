#include "editor/text_numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace loam {

namespace {

constexpr int kLargestPicture_px = 16384;

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

Result<double> parse_number(std::string_view text) {
    std::string_view digits = text;
    if (digits.starts_with('+') && !digits.starts_with("+-"))
        digits.remove_prefix(1);  // from_chars takes no plus sign
    double value = 0;
    const auto [end, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (code != std::errc{} || end != digits.data() + digits.size() || digits.empty())
        return error("\"{}\" is not a number", text);
    if (!std::isfinite(value)) return error("\"{}\" is not a finite number", text);
    return value;
}

Result<int64_t> parse_integer(std::string_view text) {
    int64_t value = 0;
    const auto [end, code] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (code != std::errc{} || end != text.data() + text.size() || text.empty())
        return error("\"{}\" is not a whole number", text);
    return value;
}

Result<std::vector<double>> parse_numbers(std::string_view text) {
    std::vector<double> values;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t comma = std::min(text.find(',', begin), text.size());
        auto value = parse_number(trimmed(text.substr(begin, comma - begin)));
        if (!value) return value.error();
        values.push_back(*value);
        begin = comma + 1;
    }
    return values;
}

Result<PixelSize> parse_size(std::string_view text) {
    const size_t cross = text.find('x');
    if (cross == std::string_view::npos)
        return error("size \"{}\" is not WIDTHxHEIGHT, as in 1280x720", text);
    auto width = parse_integer(text.substr(0, cross));
    auto height = parse_integer(text.substr(cross + 1));
    if (!width || !height) return error("size \"{}\" is not WIDTHxHEIGHT, as in 1280x720", text);
    if (*width < 1 || *height < 1 || *width > kLargestPicture_px || *height > kLargestPicture_px)
        return error("size \"{}\" is outside 1 … {} pixels a side", text, kLargestPicture_px);
    return PixelSize{static_cast<int>(*width), static_cast<int>(*height)};
}

}  // namespace loam
