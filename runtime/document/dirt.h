// Rectangles of dirt: few, tight, and as bytes in the journal.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/base/rect.h"
#include "runtime/base/result.h"
#include "runtime/document/document.h"

namespace loam {

// The same area or a little more with at most `most` rectangles: joins those that hardly grow by it, then the
// best pairs.
void merge_rects(std::vector<WorldRect>& rects, size_t most);

void append_dirt(Dirt& to, const Dirt& more);
void append_dirt(Dirt& to, const Operator& op);  // where it shows; one that is off nowhere

[[nodiscard]] std::vector<uint8_t> dirt_bytes(const Dirt& dirt);
[[nodiscard]] Result<Dirt> dirt_of(std::span<const uint8_t> bytes);

}  // namespace loam
