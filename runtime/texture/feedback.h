// What the feedback buffer asks for: a pure function of its values and of what is visible now.
// Source: Call of Duty talk, "Processing of the Feedback Buffer": count unique values, add children to
// parents, sort by popularity, bias roots, threshold with rescue of visible pages, at most a third of the
// cache.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "runtime/texture/page_id.h"

namespace loam {

// What sector ids meant in the frame that wrote the values.
struct FeedbackImages {
    std::array<ImageId, 256> image{};  // by id; [0] is the default image
    std::array<bool, 256> valid{};
};

struct PageRequest {
    PageId page;
    uint32_t popularity = 0;  // cells of the feedback buffer that want the page or something below it
    uint32_t cells = 0;       // that want this very page
};

struct FeedbackInput {
    std::span<const uint32_t> values;
    const FeedbackImages* images = nullptr;
    TextureLayout layout;
    uint32_t capacity_pages = 0;
    uint32_t threshold = 3;  // fewer cells than this do not get a page (of 32,640: 0.01 % of the picture)
    std::function<bool(const PageId&)> is_visible;  // usable now: rescued from the threshold
};

struct FeedbackResult {
    std::vector<PageRequest> requests;  // most popular first; a parent always before its children
    std::vector<PageId>
        wants_finer;  // finest default pages that are too coarse: their sectors should be live
    uint32_t terrain_cells = 0;
};

[[nodiscard]] FeedbackResult analyse_feedback(const FeedbackInput& input);

}  // namespace loam
