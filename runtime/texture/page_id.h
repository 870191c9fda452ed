// Which square of the world a texture page is. A page is known by its square (image, depth below the image's
// root, x, y), never by a mip number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "runtime/base/rect.h"
#include "runtime/base/units.h"
#include "shaders/texture/texture_io.h"

namespace loam {

// A virtual image: the default sector, which covers the whole map, or the live image of one 64 m sector.
struct ImageId {
    bool live = false;
    int sector_x = 0, sector_y = 0;
    bool operator==(const ImageId&) const = default;
};

struct PageId {
    ImageId image;
    int depth = 0, x = 0, y = 0;  // depth 0 is the root
    bool operator==(const PageId&) const = default;
    [[nodiscard]] PageId parent() const { return {image, depth - 1, x >> 1, y >> 1}; }
};

struct PageIdHash {
    size_t operator()(const PageId& p) const {
        uint64_t h = uint64_t(p.image.live) << 63 | uint64_t(uint32_t(p.image.sector_x) & 0xfff) << 44 |
                     uint64_t(uint32_t(p.image.sector_y) & 0xfff) << 32 | uint64_t(uint32_t(p.depth)) << 24 |
                     uint64_t(uint32_t(p.x) & 0xfff) << 12 | uint64_t(uint32_t(p.y) & 0xfff);
        h *= 0x9E3779B97F4A7C15ull;
        return size_t(h ^ (h >> 29));
    }
};

// The images' squares of the world. How many pages wide a live image is changes while it lives
// (sector_set.h); its pages keep their identity.
struct TextureLayout {
    int default_log2_width = 0;  // pages
    int default_log2_page = 0;  // log2 of (side of the finest default page / 64 m): 1 for maps above 16,384 m

    [[nodiscard]] double image_side_m(const ImageId& image) const {
        return image.live ? kSectorSize_m : std::ldexp(kSectorSize_m, default_log2_width + default_log2_page);
    }
    [[nodiscard]] double page_side_m(const PageId& page) const {
        return std::ldexp(image_side_m(page.image), -page.depth);
    }
    [[nodiscard]] double texel_m(const PageId& page) const { return page_side_m(page) / kPagePayload; }
    // The payload's square.
    [[nodiscard]] WorldRect square(const PageId& page) const {
        const double side = page_side_m(page);
        const double x = page.image.sector_x * kSectorSize_m + page.x * side;
        const double y = page.image.sector_y * kSectorSize_m + page.y * side;
        return {x, y, x + side, y + side};
    }
    // The page of twice the side that holds it, a live image's root in the default image; none above the
    // default root.
    [[nodiscard]] std::optional<PageId> coarser(const PageId& page) const {
        if (page.depth > 0) return page.parent();
        const int depth = default_log2_width + default_log2_page - 1;
        if (!page.image.live || depth < 0) return {};
        return PageId{{}, depth, page.image.sector_x >> 1, page.image.sector_y >> 1};
    }
};

// The smallest default image that covers the map: at most 256 pages wide, as a page coordinate has eight
// bits.
[[nodiscard]] inline TextureLayout texture_layout(const WorldRect& bounds) {
    TextureLayout layout;
    const double side = std::max(bounds.max_x, bounds.max_y);
    int log2_sectors = 0;
    while (std::ldexp(kSectorSize_m, log2_sectors) < side) ++log2_sectors;
    layout.default_log2_width = std::min(log2_sectors, 8);
    layout.default_log2_page = log2_sectors - layout.default_log2_width;
    return layout;
}

}  // namespace loam
