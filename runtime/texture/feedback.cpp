#include "runtime/texture/feedback.h"

#include <algorithm>
#include <unordered_map>

namespace loam {

namespace {

constexpr uint32_t kRootBias = 1u << 20;  // above any count of cells

bool before(const PageRequest& a, const PageRequest& b) {
    if (a.popularity != b.popularity) return a.popularity > b.popularity;
    const PageId &p = a.page, &q = b.page;
    if (p.depth != q.depth) return p.depth < q.depth;
    if (p.image.live != q.image.live) return q.image.live;
    if (p.image.sector_y != q.image.sector_y) return p.image.sector_y < q.image.sector_y;
    if (p.image.sector_x != q.image.sector_x) return p.image.sector_x < q.image.sector_x;
    return p.y != q.y ? p.y < q.y : p.x < q.x;
}

// Neighbouring cells mostly agree: count runs, not cells.
std::unordered_map<uint32_t, uint32_t> count_values(std::span<const uint32_t> values) {
    std::unordered_map<uint32_t, uint32_t> counts;
    for (size_t i = 0; i < values.size();) {
        size_t end = i + 1;
        while (end < values.size() && values[end] == values[i]) ++end;
        if (values[i] != kNoTerrain) counts[values[i]] += uint32_t(end - i);
        i = end;
    }
    return counts;
}

}  // namespace

FeedbackResult analyse_feedback(const FeedbackInput& input) {
    FeedbackResult result;
    struct Wish {
        uint32_t popularity = 0, cells = 0;
    };
    std::unordered_map<PageId, Wish, PageIdHash> wishes;
    for (const auto& [value, count] : count_values(input.values)) {
        result.terrain_cells += count;
        const uint32_t id = value >> 16 & 0xff;
        if (!input.images->valid[id]) continue;
        const ImageId image = input.images->image[id];
        const int mip = int(value >> 24 & 0x7f), width = input.layout.log2_width(image);
        if (mip > width) continue;  // no such page: noise must not become a request
        PageId page{image, width - mip, int(value & 0xff), int(value >> 8 & 0xff)};
        if (page.x >> page.depth != 0 || page.y >> page.depth != 0) continue;
        if ((value & kFeedbackFinerBit) != 0 && !image.live && mip == 0) result.wants_finer.push_back(page);
        wishes[page].cells += count;
        for (;; page = page.parent()) {
            wishes[page].popularity += count;
            if (page.depth == 0) break;
        }
    }
    for (const auto& [page, wish] : wishes) {
        const uint32_t biased = page.depth == 0 ? wish.popularity + kRootBias : wish.popularity;
        if (biased >= input.threshold || input.is_visible(page))
            result.requests.push_back({page, biased, wish.cells});
    }
    std::sort(result.requests.begin(), result.requests.end(), before);
    const size_t limit = std::max<size_t>(1, input.capacity_pages / 3);
    if (result.requests.size() > limit) result.requests.resize(limit);
    std::sort(result.wants_finer.begin(), result.wants_finer.end(),
              [](const PageId& a, const PageId& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; });
    return result;
}

}  // namespace loam
