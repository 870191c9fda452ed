// What HeightMap's two files share: its slots (height_map.cpp) and its queries (height_query.cpp).
#pragma once

#include <list>
#include <mutex>
#include <unordered_map>

#include "runtime/document/document.h"
#include "runtime/maps/height_map.h"

namespace loam {

// Pages of the finest level composed for queries, heights alone; and the height bounds of such pages, for
// rays.
class HeightQueryCache {
  public:
    static constexpr size_t kPageLimit = 256;        // 18.5 KB each
    static constexpr size_t kBoundsLimit = 1 << 18;  // a 16.8 km map at 0.5 m has 275,625 pages

    struct Bounds {
        float min_m, max_m;
    };
    // Composes what is absent. The pointer holds until the next call.
    const float* page(const Document& document, const MapPage& page);
    // Between which heights the page's surface lies; need not be tight. `heights_m`: the page's, where they
    // are at hand.
    Bounds bounds(const Document& document, const VirtualMap& map, const MapPage& page,
                  const float* heights_m);
    void drop(const VirtualMap& map, const WorldRect& rect);
    [[nodiscard]] uint64_t bytes() const;

    std::mutex mutex;  // held by whoever queries

  private:
    struct Entry {
        MapPage page;
        std::vector<float> heights_m;
    };
    std::list<Entry> pages_;  // newest first
    std::unordered_map<MapPage, std::list<Entry>::iterator, MapPageHash> by_page_;
    std::unordered_map<MapPage, Bounds, MapPageHash> bounds_;
};

struct HeightMap::Impl {
    Impl(const Document& d, const VirtualMapDesc& desc)
        : document(d), map(desc), slots(size_t(desc.slot_count)) {}

    struct Slot {
        HeightPage page;
        std::vector<double> window_m;  // kWindowTexels²
        TexelRect changed;             // of the window, in texels of the page: heights to evaluate again
    };

    // Null: not resident, or dirty.
    [[nodiscard]] const float* clean_heights(const MapPage& page) const;
    // The page's heights at the finest level, as they would be composed now. Cache's mutex held.
    const float* finest_heights(const MapPage& page);
    std::vector<VirtualMap::Work> compose_planned(uint64_t frame, int new_pages);

    const Document& document;
    VirtualMap map;
    std::vector<Slot> slots;
    gpu::Image heights, normals;
    HeightQueryCache cache;
};

}  // namespace loam
