// Sharing a length among children: the one place where sizes are decided. Pure, in whole pixels.
//
// Each child is fixed, as large as its content, or takes a weight's share of what is left. Then:
//  - children follow one another with exactly `gap` between, never overlapping;
//  - with a flexible child and room enough, they fill `available` exactly;
//  - without room, flexible children shrink to their minimum, then the others in proportion: nothing
//  overflows
//    unless the gaps alone do.
#pragma once

#include <span>
#include <vector>

namespace loam::ui {

struct Size {
    enum class Kind { fixed, content, flex };
    Kind kind = Kind::flex;
    float value = 1;  // fixed: logical px; flex: weight
    float min = 0;    // flex: logical px
};
[[nodiscard]] constexpr Size fixed(float logical_px) {
    return {Size::Kind::fixed, logical_px};
}
[[nodiscard]] constexpr Size content() {
    return {Size::Kind::content, 0};
}
[[nodiscard]] constexpr Size flex(float weight = 1, float min = 0) {
    return {Size::Kind::flex, weight, min};
}

struct Extent {
    float start = 0, length = 0;
};

struct SolveDesc {
    std::span<const Size> sizes{};
    std::span<const float> content_px{};  // wanted by content children; missing entries count as 0
    float available_px = 0;
    float gap_px = 0;
    float scale = 1;
};
[[nodiscard]] std::vector<Extent> solve(const SolveDesc& desc);

}  // namespace loam::ui
