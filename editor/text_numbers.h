// Numbers as people type them on the command line. Independent of the locale.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

// The whole text must be one finite number: "12", "-0.5", "1e3".
[[nodiscard]] Result<double> parse_number(std::string_view text);
[[nodiscard]] Result<int64_t> parse_integer(std::string_view text);
// "1,2,3"; blanks around a number are allowed.
[[nodiscard]] Result<std::vector<double>> parse_numbers(std::string_view text);
// "1280x720"
struct PixelSize {
    int width = 0, height = 0;
};
[[nodiscard]] Result<PixelSize> parse_size(std::string_view text);

}  // namespace loam
