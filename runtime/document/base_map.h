// Base maps as samples: their shape over all mips, and a cache of decoded pages.
//
// Mip m holds every 2^m-th sample of mip 0 in both directions: sample i of mip m is sample i * 2^m of mip 0.
// A page that is all default is not stored; its handle is null. Samples of a page beyond the map's edge are
// default.
#pragma once

#include <array>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <unordered_map>

#include "runtime/base/result.h"
#include "runtime/store/page_codec.h"
#include "runtime/store/page_store.h"
#include "runtime/store/project.h"

namespace loam {

struct MapShape {
    BaseMap map = BaseMap::height;
    int samples_x = 0, samples_y = 0;  // of mip 0
    double spacing_m = 1;
    int mip_count = 1;  // down to one page

    [[nodiscard]] int width(int mip) const { return ((samples_x - 1) >> mip) + 1; }
    [[nodiscard]] int height(int mip) const { return ((samples_y - 1) >> mip) + 1; }
    [[nodiscard]] int pages_x(int mip) const { return (width(mip) + kBasePageSide - 1) / kBasePageSide; }
    [[nodiscard]] int pages_y(int mip) const { return (height(mip) + kBasePageSide - 1) / kBasePageSide; }
};

[[nodiscard]] MapShape height_shape(const ProjectSettings& settings);
[[nodiscard]] MapShape index_shape(const ProjectSettings& settings);

template <typename Sample>
using BasePage = std::array<Sample, kBasePageSamples>;
template <typename Sample>
using PageHandle = std::shared_ptr<const BasePage<Sample>>;  // null: all default

// The codec of a map by the type of its samples.
template <typename Sample>
[[nodiscard]] std::vector<uint8_t> encode_page(const BasePage<Sample>& page);
template <typename Sample>
[[nodiscard]] Status decode_page(std::span<const uint8_t> blob, BasePage<Sample>& page);
template <>
inline std::vector<uint8_t> encode_page(const BasePage<int32_t>& page) {
    return encode_height_page(page);
}
template <>
inline std::vector<uint8_t> encode_page(const BasePage<IndexTexel>& page) {
    return encode_index_page(page);
}
template <>
inline Status decode_page(std::span<const uint8_t> blob, BasePage<int32_t>& page) {
    return decode_height_page(blob, page);
}
template <>
inline Status decode_page(std::span<const uint8_t> blob, BasePage<IndexTexel>& page) {
    return decode_index_page(blob, page);
}

// Decoded pages of both maps, least recently used out first. Any thread; one lock over the cache, another
// over the database.
class BasePages {
  public:
    BasePages(PageStore store, size_t capacity_bytes)
        : capacity_bytes_(capacity_bytes), store_(std::move(store)) {}

    template <typename Sample>
    Result<PageHandle<Sample>> load(const PageKey& key);
    // The page has been written (or, null, erased). Nobody may be loading it meanwhile.
    template <typename Sample>
    void publish(int64_t key, PageHandle<Sample> page) {
        const size_t bytes = page_bytes<Sample>(page);
        insert(key, std::move(page), bytes);
    }
    void forget(int64_t key);
    void clear();

    // The reading connection, for what is not a page.
    template <typename Body>
    auto with_store(Body&& body) {
        std::lock_guard lock(store_mutex_);
        return body(store_);
    }

    [[nodiscard]] uint64_t cached_pages() const;
    [[nodiscard]] uint64_t cached_bytes() const;

  private:
    struct Entry {
        std::shared_ptr<const void> page;
        size_t bytes = 0;
        std::list<int64_t>::iterator age;
    };
    static constexpr size_t kEntryBytes = 128;  // of an entry without page: list node, map node
    template <typename Sample>
    static size_t page_bytes(const PageHandle<Sample>& page) {
        return kEntryBytes + (page ? sizeof(BasePage<Sample>) : 0);
    }
    bool find(int64_t key, std::shared_ptr<const void>& page);
    void insert(int64_t key, std::shared_ptr<const void> page, size_t bytes);

    mutable std::mutex cache_mutex_;
    std::unordered_map<int64_t, Entry> entries_;
    std::list<int64_t> ages_;  // newest first
    size_t bytes_ = 0;
    const size_t capacity_bytes_;

    std::mutex store_mutex_;
    PageStore store_;
};

template <typename Sample>
Result<PageHandle<Sample>> BasePages::load(const PageKey& key) {
    const int64_t packed = key.packed();
    std::shared_ptr<const void> found;
    if (find(packed, found)) return std::static_pointer_cast<const BasePage<Sample>>(found);
    auto blob = with_store([&](PageStore& store) { return store.read_page(packed); });
    if (!blob.ok()) return blob.error();
    PageHandle<Sample> page;
    if (blob->has_value()) {
        auto decoded = std::make_shared<BasePage<Sample>>();
        const Status status = decode_page<Sample>(**blob, *decoded);
        if (!status.ok())
            return error("page {}, {} of mip {} of the {} map: {}", key.x, key.y, key.mip,
                         key.map == BaseMap::height ? "height" : "index", status.message());
        page = std::move(decoded);
    }
    const size_t bytes = page_bytes<Sample>(page);
    insert(packed, page, bytes);
    return page;
}

// A window of one mip, coordinates clamped to the map. `load(page_x, page_y)` gives a pointer to a page's
// samples or null for a default one, and is called once a page.
template <typename Sample, typename Load>
void read_window(const MapShape& shape, int mip, int x0, int y0, int width, int height,
                 const Sample& fallback, Load&& load, Sample* out) {
    const int last_x = shape.width(mip) - 1, last_y = shape.height(mip) - 1;
    const auto clamped = [](int v, int last) { return v < 0 ? 0 : (v > last ? last : v); };
    // End of the run of coordinates that fall in the page of `v`.
    const auto run_end = [&](int v, int end, int last) {
        if (v >= last) return end;
        const int page_end = v < 0 ? kBasePageSide : (v / kBasePageSide + 1) * kBasePageSide;
        return page_end > last ? end : (page_end < end ? page_end : end);
    };
    for (int y = y0; y < y0 + height;) {
        const int y_end = run_end(y, y0 + height, last_y);
        for (int x = x0; x < x0 + width;) {
            const int x_end = run_end(x, x0 + width, last_x);
            const int page_x = clamped(x, last_x) / kBasePageSide,
                      page_y = clamped(y, last_y) / kBasePageSide;
            const auto page = load(page_x, page_y);
            for (int j = y; j < y_end; ++j) {
                Sample* row = out + size_t(j - y0) * size_t(width) + (x - x0);
                const int sy = clamped(j, last_y) - page_y * kBasePageSide;
                for (int i = x; i < x_end; ++i) {
                    const int sx = clamped(i, last_x) - page_x * kBasePageSide;
                    *row++ = page ? (*page)[size_t(sy * kBasePageSide + sx)] : fallback;
                }
            }
            x = x_end;
        }
        y = y_end;
    }
}

}  // namespace loam
