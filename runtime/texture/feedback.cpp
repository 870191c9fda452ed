#include "runtime/texture/feedback.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace loam {

namespace {

constexpr uint32_t kRootBias = 1u << 24;  // above any count of cells
constexpr uint32_t kValueMask = (1u << kFeedbackCoarserShift) - 1;

bool before(const PageRequest& a, const PageRequest& b) {
    if (a.popularity != b.popularity) return a.popularity > b.popularity;
    const PageId &p = a.page, &q = b.page;
    if (p.depth != q.depth) return p.depth < q.depth;
    if (p.image.live != q.image.live) return q.image.live;
    if (p.image.sector_y != q.image.sector_y) return p.image.sector_y < q.image.sector_y;
    if (p.image.sector_x != q.image.sector_x) return p.image.sector_x < q.image.sector_x;
    return p.y != q.y ? p.y < q.y : p.x < q.x;
}

uint32_t spread_bits(uint32_t v) {  // 8 bits to the even places of 16
    v = (v | v << 4) & 0x0f0f;
    v = (v | v << 2) & 0x3333;
    return (v | v << 1) & 0x5555;
}

uint32_t gather_bits(uint32_t v) {
    v &= 0x5555;
    v = (v | v >> 1) & 0x3333;
    v = (v | v >> 2) & 0x0f0f;
    return (v | v >> 4) & 0xff;
}

// Of pages, in Morton order: a page's parent is the code without its last two bits, so that parents of sorted
// pages are sorted and every level is one merge.
struct Counted {
    uint32_t key;  // id : 8 | mip : 8 | Morton code of x, y : 16
    uint32_t count;
};

// By key, 11 bits at a time: where every cell wants another page this is what the analysis costs.
void sort_by_key(std::vector<Counted>& counted) {
    constexpr int kBits = 11, kDigits = 3;
    constexpr uint32_t kBuckets = 1u << kBits;
    std::array<std::array<uint32_t, kBuckets>, kDigits> begins{};
    for (const Counted& c : counted)
        for (int digit = 0; digit < kDigits; ++digit)
            ++begins[size_t(digit)][c.key >> (digit * kBits) & (kBuckets - 1)];
    std::vector<Counted> other(counted.size());
    for (int digit = 0; digit < kDigits; ++digit) {
        uint32_t sum = 0;
        for (uint32_t& begin : begins[size_t(digit)]) sum += std::exchange(begin, sum);
        for (const Counted& c : counted)
            other[begins[size_t(digit)][c.key >> (digit * kBits) & (kBuckets - 1)]++] = c;
        counted.swap(other);
    }
}

std::vector<Counted> count_values(const FeedbackInput& input, FeedbackResult& result) {
    std::vector<Counted> counted;
    const std::span<const uint32_t> values = input.values;
    for (size_t i = 0; i < values.size();) {
        // Neighbouring cells mostly agree: count runs, not cells.
        size_t end = i + 1;
        while (end < values.size() && values[end] == values[i]) ++end;
        const uint32_t value = values[i], count = uint32_t(end - i);
        i = end;
        if (value == kNoTerrain) continue;
        result.terrain_cells += count;
        result.coarser[value >> kFeedbackCoarserShift] += count;
        const uint32_t id = value >> 16 & 0xff, mip = (value & kValueMask) >> kFeedbackMipShift;
        if (!input.images->valid[id]) continue;
        const int depth = input.images->log2_width[id] - int(mip);
        const uint32_t x = value & 0xff, y = value >> 8 & 0xff;
        // No such page: noise must not become a request.
        if (depth < 0 || x >> depth != 0 || y >> depth != 0) continue;
        counted.push_back({id << 24 | mip << 16 | spread_bits(x) | spread_bits(y) << 1, count});
    }
    constexpr size_t kFew = 512;  // less than the buckets cost
    if (counted.size() < kFew)
        std::sort(counted.begin(), counted.end(),
                  [](const Counted& a, const Counted& b) { return a.key < b.key; });
    else
        sort_by_key(counted);
    size_t unique = 0;
    for (size_t i = 0; i < counted.size(); ++i) {
        if (unique > 0 && counted[unique - 1].key == counted[i].key)
            counted[unique - 1].count += counted[i].count;
        else
            counted[unique++] = counted[i];
    }
    counted.resize(unique);
    return counted;
}

struct Wish {
    uint32_t code, cells, popularity;
};

// `own` and the parents of `finer`, both in Morton order.
std::vector<Wish> with_children(std::span<const Counted> own, const std::vector<Wish>& finer) {
    std::vector<Wish> level;
    size_t o = 0, f = 0;
    while (o < own.size() || f < finer.size()) {
        const uint32_t own_code = o < own.size() ? own[o].key & 0xffff : UINT32_MAX;
        const uint32_t finer_code = f < finer.size() ? finer[f].code >> 2 : UINT32_MAX;
        Wish wish{std::min(own_code, finer_code), 0, 0};
        if (own_code == wish.code) wish.cells = wish.popularity = own[o++].count;
        for (; f < finer.size() && finer[f].code >> 2 == wish.code; ++f)
            wish.popularity += finer[f].popularity;
        level.push_back(wish);
    }
    return level;
}

}  // namespace

FeedbackGrid feedback_grid(FeedbackCells cells, glm::ivec2 picture_px, uint64_t frame) {
    if (cells == FeedbackCells::every_pixel) {
        const double pixels = double(picture_px.x) * picture_px.y;
        const double step = std::ceil(std::sqrt(std::max(pixels / kEveryPixelLimit, 1.0)));
        return {{int(std::ceil(picture_px.x / step)), int(std::ceil(picture_px.y / step))}, glm::vec2(0.5f)};
    }
    if (cells == FeedbackCells::eighth) {
        // The places of a cell in the order of an 8 x 8 Bayer matrix: any 2^n frames in a row are spread
        // evenly.
        const uint32_t i = uint32_t(frame & 63);
        int x = 0, y = 0;
        for (int bit = 0; bit < 3; ++bit) {
            const int low = int(i >> (2 * bit) & 1), high = int(i >> (2 * bit + 1) & 1);
            x |= (low ^ high) << (2 - bit);
            y |= high << (2 - bit);
        }
        return {glm::max((picture_px + 7) / 8, glm::ivec2(1)), (glm::vec2(x, y) + 0.5f) / 8.0f};
    }
    // R2 sequence (Roberts 2018): every place of a cell is visited evenly.
    const double n = double(frame & 1023);
    const auto fraction = [](double v) { return float(v - std::floor(v)); };
    return {{kFeedbackWidth, kFeedbackHeight},
            {fraction(0.5 + n * 0.75487766624669), fraction(0.5 + n * 0.56984029099805)}};
}

FeedbackResult analyse_feedback(const FeedbackInput& input) {
    FeedbackResult result;
    const std::vector<Counted> counted = count_values(input, result);
    const double share = input.exact ? 0.0 : input.rules.threshold_share;
    const uint32_t threshold = uint32_t(std::max(1.0, std::ceil(share * double(input.values.size()) - 1e-9)));
    const double crossed_m = input.speed_m_s * input.rules.horizon_s;

    for (size_t first = 0; first < counted.size();) {
        const uint32_t id = counted[first].key >> 24;
        const ImageId image = input.images->image[id];
        const int width = input.images->log2_width[id];
        std::vector<Wish> level;
        for (int mip = 0; mip <= width; ++mip) {
            size_t end = first;
            while (end < counted.size() && counted[end].key >> 16 == (id << 8 | uint32_t(mip))) ++end;
            level = with_children({counted.data() + first, end - first}, level);
            first = end;
            const int depth = width - mip;
            const double side_m = input.layout.page_side_m({image, depth, 0, 0});
            const double bias = crossed_m > side_m ? side_m / crossed_m : 1.0;
            for (const Wish& wish : level) {
                const PageId page{image, depth, int(gather_bits(wish.code)),
                                  int(gather_bits(wish.code >> 1))};
                const uint32_t popularity =
                    depth == 0 ? wish.popularity + kRootBias : std::max(1u, uint32_t(wish.popularity * bias));
                if (popularity >= threshold || input.is_visible(page))
                    result.requests.push_back({page, popularity, wish.cells});
            }
        }
    }
    size_t limit = std::max<size_t>(1, input.capacity_pages / input.rules.cache_divisor);
    if (input.exact && input.capacity_pages > input.kept_pages)
        limit = std::max<size_t>(limit, input.capacity_pages - input.kept_pages);
    if (result.requests.size() > limit) {
        std::nth_element(result.requests.begin(), result.requests.begin() + std::ptrdiff_t(limit),
                         result.requests.end(), before);
        result.requests.resize(limit);
    }
    std::sort(result.requests.begin(), result.requests.end(), before);
    return result;
}

}  // namespace loam
