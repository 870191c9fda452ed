// "Did you mean …?"
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace loam {

// The candidate with the fewest edits to `word`, empty when none is close.
[[nodiscard]] std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

}  // namespace loam
