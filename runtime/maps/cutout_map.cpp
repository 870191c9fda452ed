#include "runtime/maps/cutout_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <unordered_map>
#include <unordered_set>

#include "runtime/base/check.h"
#include "runtime/document/cutout.h"
#include "runtime/document/document.h"
#include "runtime/maps/base_window.h"
#include "runtime/maps/height_compose.h"

namespace loam {

namespace {

using gpu::Access;

// The base's vertices, as the height map has them.
struct Grid {
    explicit Grid(const ProjectSettings& settings)
        : level(settings.refine),
          spacing_m(std::ldexp(finest_height_spacing(settings), settings.refine)),
          last(glm::ivec2(
              glm::round(glm::dvec2(settings.bounds().max_x, settings.bounds().max_y) / spacing_m))) {}
    [[nodiscard]] WorldRect rect(glm::ivec2 first, glm::ivec2 size) const {
        const glm::dvec2 low = glm::dvec2(first) * spacing_m, high = glm::dvec2(first + size - 1) * spacing_m;
        return {low.x, low.y, high.x, high.y};
    }
    int level;
    double spacing_m;
    glm::ivec2 last;
};

struct VertexRange {
    glm::ivec2 low, high;  // half open, within the window
};
VertexRange vertices_in(const Grid& grid, const WorldRect& rect, glm::ivec2 first, glm::ivec2 size) {
    const auto index = [&](double metres, double low, int count) {
        return int(std::clamp(metres / grid.spacing_m - low, 0.0, double(count)));
    };
    // A vertex too many on either side is asked and says no.
    return {{index(rect.min_x, first.x, size.x), index(rect.min_y, first.y, size.y)},
            {index(rect.max_x, first.x - 2, size.x), index(rect.max_y, first.y - 2, size.y)}};
}

// 1 where a vertex is cut, row by row from first. False: none is. The caller
// holds the ReadLock.
bool cut_vertices(const Document& document, const Grid& grid, glm::ivec2 first, glm::ivec2 size,
                  uint8_t* out) {
    std::fill_n(out, size_t(size.x) * size_t(size.y), uint8_t(0));
    thread_local std::vector<const Operator*> operators;
    document.operators_over_cutout(grid.rect(first, size), operators);
    if (operators.empty()) return false;
    thread_local std::vector<double> heights_m;
    heights_m.assign(size_t(size.x) * size_t(size.y), 0.0);
    if (std::any_of(operators.begin(), operators.end(),
                    [](const Operator* op) { return looks_at_heights(std::get<Cutout>(op->shape)); }))
        compose_heights(document, grid.level, first, size, heights_m.data());
    for (const Operator* op : operators) {
        const Cutout& cutout = std::get<Cutout>(op->shape);
        const auto visit = [&](const WorldRect& rect, auto&& is_in) {
            const VertexRange range = vertices_in(grid, rect, first, size);
            for (int j = range.low.y; j < range.high.y; ++j)
                for (int i = range.low.x; i < range.high.x; ++i) {
                    const size_t at = size_t(j) * size_t(size.x) + size_t(i);
                    const glm::dvec2 place = glm::dvec2(first + glm::ivec2(i, j)) * grid.spacing_m;
                    if (is_in(glm::dvec3(place, heights_m[at]))) out[at] = !cutout.fill;
                }
        };
        if (cutout.form != CutoutForm::brush) {
            for (const WorldRect& rect : rects_of(cutout))
                visit(rect, [&](const glm::dvec3& place) { return holds(cutout, place); });
            continue;
        }
        for (const glm::dvec2& dab : cutout.dabs)  // of a long stroke few are near
            visit(disc_rect(cutout, dab),
                  [&](const glm::dvec3& place) { return disc_holds(cutout, dab, place); });
    }
    return std::any_of(out, out + size_t(size.x) * size_t(size.y), [](uint8_t cut) { return cut != 0; });
}

// Of the squares between a page's vertices 0 … 64.
CutoutCover cover_of_bits(const CutoutBits& bits) {
    int cut = 0;
    constexpr int kAcross = kCutoutPayload + 1;
    for (int y = 0; y < kAcross; ++y)
        for (int x = 0; x < kAcross; ++x) cut += bit_of(bits, x + kCutoutBorder, y + kCutoutBorder);
    return cut == 0 ? CutoutCover::ground : cut == kAcross * kAcross ? CutoutCover::gone : CutoutCover::mixed;
}

}  // namespace

bool bit_of(const CutoutBits& bits, int x, int y) {
    return bits[size_t(shared::cutout_byte(x, y))] >> shared::cutout_bit(x, y) & 1;
}

struct CutoutMap::Impl {
    Impl(gpu::Device* on, const Document& d)
        : device(on),
          document(d),
          grid(d.settings()),
          pages(glm::max((grid.last + kCutoutPayload - 1) / kCutoutPayload, glm::ivec2(1))) {
        for (glm::ivec2 size = pages;; size = (size + 1) / 2) {
            covers.push_back(
                {size, std::vector<CutoutCover>(size_t(size.x) * size_t(size.y), CutoutCover::ground)});
            if (size == glm::ivec2(1)) break;
        }
        table.resize((size_t(pages.x) * size_t(pages.y) + 3) / 4 * 4, kCutoutGround);
    }

    struct Page {
        CutoutBits bits{};
        CutoutCover cover = CutoutCover::ground;
        int place = -1;
    };
    struct Level {
        glm::ivec2 size;
        std::vector<CutoutCover> covers;
        [[nodiscard]] CutoutCover& at(glm::ivec2 p) {
            return covers[size_t(p.y) * size_t(size.x) + size_t(p.x)];
        }
        [[nodiscard]] CutoutCover at(glm::ivec2 p) const {
            return covers[size_t(p.y) * size_t(size.x) + size_t(p.x)];
        }
    };

    [[nodiscard]] uint32_t key_of(glm::ivec2 page) const { return uint32_t(page.y * pages.x + page.x); }
    [[nodiscard]] glm::ivec2 page_of(uint32_t key) const { return {int(key) % pages.x, int(key) / pages.x}; }
    [[nodiscard]] double distance_m(uint32_t key, const glm::dvec3& camera_m) const {
        const glm::dvec2 centre = (glm::dvec2(page_of(key)) + 0.5) * (kCutoutPayload * grid.spacing_m);
        return glm::distance(centre, glm::dvec2(camera_m));
    }
    void take_stale(const glm::dvec3& camera_m, int new_pages, std::vector<WorldRect>& changed);
    void give_places(const glm::dvec3& camera_m, std::vector<WorldRect>& changed);
    void show(uint32_t key, std::vector<WorldRect>& changed);
    Status create_buffers();
    Status cmd_upload(gpu::FrameRing& ring, gpu::Commands& commands);

    gpu::Device* device;
    const Document& document;
    const Grid grid;
    const glm::ivec2 pages;
    std::unordered_map<uint32_t, Page> kept;  // that have any bit set
    std::unordered_set<uint32_t> stale;
    std::array<uint32_t, kMaxCutoutPages> owner{};  // key + 1 of the page in a place; 0: free
    uint32_t mixed = 0;
    bool places_stale = false;
    glm::dvec2 ranked_from_m{1e30};
    std::vector<Level> covers;   // as shown; level 0: pages, then four to one
    std::vector<uint8_t> table;  // as shown
    std::unordered_set<uint32_t> dirty_words, dirty_places;

    gpu::Buffer table_buffer, page_buffer;
    bool cleared = false;
};

// Pages are few and small: a whole one is composed wherever it changed.
void CutoutMap::Impl::take_stale(const glm::dvec3& camera_m, int new_pages, std::vector<WorldRect>& changed) {
    std::vector<uint32_t> chosen(stale.begin(), stale.end());
    if (chosen.size() > size_t(std::max(new_pages, 0))) {
        const auto nth = chosen.begin() + std::max(new_pages, 0);
        std::nth_element(chosen.begin(), nth, chosen.end(), [&](uint32_t a, uint32_t b) {
            return std::pair(distance_m(a, camera_m), a) < std::pair(distance_m(b, camera_m), b);
        });
        chosen.erase(nth, chosen.end());
    }
    for (const uint32_t key : chosen) {
        stale.erase(key);
        CutoutBits bits;
        compose(document, page_of(key), bits);
        const CutoutCover cover = cover_of_bits(bits);
        const bool empty = bits == CutoutBits{};
        const auto found = kept.find(key);
        if (found == kept.end() && empty) continue;
        if (found != kept.end() && found->second.bits == bits) continue;
        Page& page = kept[key];
        mixed += uint32_t(cover == CutoutCover::mixed) - uint32_t(page.cover == CutoutCover::mixed);
        page.bits = bits;
        page.cover = cover;
        if (cover != CutoutCover::mixed && page.place >= 0) {
            owner[size_t(page.place)] = 0;
            page.place = -1;
        }
        if (page.place >= 0) dirty_places.insert(uint32_t(page.place));
        places_stale = true;
        show(key, changed);
        changed.push_back(grid.rect(page_of(key) * kCutoutPayload - 1, glm::ivec2(kCutoutPayload + 3)));
        if (empty) kept.erase(key);
    }
}

void CutoutMap::Impl::give_places(const glm::dvec3& camera_m, std::vector<WorldRect>& changed) {
    const double moved_m = glm::distance(ranked_from_m, glm::dvec2(camera_m));
    const bool crowded = mixed > kMaxCutoutPages;
    if (!places_stale && !(crowded && moved_m > 0)) return;
    places_stale = false;
    ranked_from_m = glm::dvec2(camera_m);
    std::vector<uint32_t> wanted;
    for (const auto& [key, page] : kept)
        if (page.cover == CutoutCover::mixed) wanted.push_back(key);
    if (crowded) {
        const auto nth = wanted.begin() + kMaxCutoutPages;
        std::nth_element(wanted.begin(), nth, wanted.end(), [&](uint32_t a, uint32_t b) {
            return std::pair(distance_m(a, camera_m), a) < std::pair(distance_m(b, camera_m), b);
        });
        for (auto i = nth; i != wanted.end(); ++i) {
            Page& page = kept.at(*i);
            if (page.place < 0) continue;
            owner[size_t(page.place)] = 0;
            page.place = -1;
            show(*i, changed);
        }
        wanted.erase(nth, wanted.end());
    }
    size_t next = 0;
    for (const uint32_t key : wanted) {
        Page& page = kept.at(key);
        if (page.place >= 0) continue;
        while (owner[next] != 0) ++next;
        owner[next] = key + 1;
        page.place = int(next);
        dirty_places.insert(uint32_t(next));
        show(key, changed);
    }
}

// Table and covers follow the page.
void CutoutMap::Impl::show(uint32_t key, std::vector<WorldRect>& changed) {
    const Page& page = kept.at(key);
    const bool shown = page.cover != CutoutCover::mixed || page.place >= 0;
    const CutoutCover cover = shown ? page.cover : CutoutCover::ground;
    const uint8_t entry = cover == CutoutCover::gone     ? kCutoutGone
                          : cover == CutoutCover::ground ? kCutoutGround
                                                         : uint8_t(1 + page.place);
    if (table[key] != entry) dirty_words.insert(key / 4);
    table[key] = entry;
    glm::ivec2 at = page_of(key);
    if (covers[0].at(at) == cover) return;
    changed.push_back(grid.rect(at * kCutoutPayload - 1, glm::ivec2(kCutoutPayload + 3)));
    covers[0].at(at) = cover;
    for (size_t level = 1; level < covers.size(); ++level) {
        at /= 2;
        bool all_gone = true, all_ground = true;
        for (int i = 0; i < 4; ++i) {
            const glm::ivec2 child = at * 2 + glm::ivec2(i & 1, i >> 1);
            if (child.x >= covers[level - 1].size.x || child.y >= covers[level - 1].size.y) continue;
            all_gone = all_gone && covers[level - 1].at(child) == CutoutCover::gone;
            all_ground = all_ground && covers[level - 1].at(child) == CutoutCover::ground;
        }
        covers[level].at(at) = all_gone     ? CutoutCover::gone
                               : all_ground ? CutoutCover::ground
                                            : CutoutCover::mixed;
    }
}

Status CutoutMap::Impl::cmd_upload(gpu::FrameRing& ring, gpu::Commands& commands) {
    if (!table_buffer && kept.empty()) return {};
    if (!table_buffer) LOAM_TRY(create_buffers());
    if (cleared && dirty_words.empty() && dirty_places.empty()) return {};
    commands.use({{table_buffer, Access::copy_target}, {page_buffer, Access::copy_target}});
    if (!cleared) {
        vkCmdFillBuffer(commands.handle(), table_buffer.handle(), 0, VK_WHOLE_SIZE, 0);
        vkCmdFillBuffer(commands.handle(), page_buffer.handle(), 0, VK_WHOLE_SIZE, 0);
        commands.use({{table_buffer, Access::copy_target}, {page_buffer, Access::copy_target}});
        cleared = true;
    }
    constexpr uint64_t kPageBytes = kCutoutPageWords * 4;
    static_assert(kPageBytes >= kCutoutPageBytes);
    const uint64_t bytes = dirty_places.size() * kPageBytes + dirty_words.size() * 4;
    if (bytes == 0) return {};
    const gpu::UploadSlice slice = ring.upload(bytes);
    if (!slice.data) return error("no memory for an upload of {} bytes", bytes);
    auto* to = static_cast<std::byte*>(slice.data);
    uint64_t offset = 0;
    std::vector<VkBufferCopy> copies;
    for (const uint32_t place : dirty_places) {
        if (owner[place] == 0) continue;
        std::memcpy(to + offset, kept.at(owner[place] - 1).bits.data(), kCutoutPageBytes);
        copies.push_back({slice.offset + offset, place * kPageBytes, kPageBytes});
        offset += kPageBytes;
    }
    if (!copies.empty())
        vkCmdCopyBuffer(commands.handle(), slice.buffer->handle(), page_buffer.handle(),
                        uint32_t(copies.size()), copies.data());
    copies.clear();
    for (const uint32_t word : dirty_words) {
        std::memcpy(to + offset, table.data() + size_t(word) * 4, 4);
        copies.push_back({slice.offset + offset, uint64_t(word) * 4, 4});
        offset += 4;
    }
    if (!copies.empty())
        vkCmdCopyBuffer(commands.handle(), slice.buffer->handle(), table_buffer.handle(),
                        uint32_t(copies.size()), copies.data());
    dirty_places.clear();
    dirty_words.clear();
    return {};
}

CutoutMap::CutoutMap() = default;
CutoutMap::~CutoutMap() = default;

Result<std::unique_ptr<CutoutMap>> CutoutMap::create(gpu::Device* device, const Document& document) {
    std::unique_ptr<CutoutMap> map(new CutoutMap);
    map->impl_ = std::make_unique<Impl>(device, document);
    map->on_dirt(std::vector<WorldRect>{document.bounds()});
    return map;
}

// When the first page has bits: a map without holes pays for none.
Status CutoutMap::Impl::create_buffers() {
    const auto buffer = [&](const char* name, uint64_t bytes) {
        return gpu::Buffer::create(
            *device, {.name = name, .size_bytes = bytes, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    };
    auto made_table = buffer("cutout table", table.size());
    if (!made_table) return made_table.error();
    auto made_pages = buffer("cutout pages", uint64_t(kMaxCutoutPages) * kCutoutPageWords * 4);
    if (!made_pages) return made_pages.error();
    table_buffer = std::move(*made_table);
    page_buffer = std::move(*made_pages);
    return {};
}

// Only what cutouts reach, now or until now, can differ.
void CutoutMap::on_dirt(std::span<const WorldRect> rects) {
    Impl& m = *impl_;
    const double page_m = kCutoutPayload * m.grid.spacing_m, reach_m = (kCutoutBorder + 1) * m.grid.spacing_m;
    const auto mark = [&](const WorldRect& rect) {
        const WorldRect r = intersected(extended_beyond_edges(rect, m.document.bounds()).grown(reach_m),
                                        m.document.bounds().grown(reach_m));
        if (r.empty()) return;
        const auto index = [&](double metres, int count) {
            return int(std::clamp(std::floor(metres / page_m), 0.0, double(count - 1)));
        };
        for (int y = index(r.min_y, m.pages.y); y <= index(r.max_y, m.pages.y); ++y)
            for (int x = index(r.min_x, m.pages.x); x <= index(r.max_x, m.pages.x); ++x)
                m.stale.insert(m.key_of({x, y}));
    };
    std::vector<const Operator*> operators;
    for (const WorldRect& rect : rects) {
        if (rect.empty()) continue;
        {
            const auto lock = m.document.read_lock();
            m.document.operators_over_cutout(rect.grown(reach_m), operators);
            for (const Operator* op : operators)
                for (const WorldRect& part : rects_of(std::get<Cutout>(op->shape)))
                    mark(intersected(part, rect.grown(reach_m)));
        }
        for (const auto& [key, page] : m.kept)
            if (m.grid.rect(m.page_of(key) * kCutoutPayload, glm::ivec2(kCutoutPayload + 1))
                    .overlaps(rect.grown(reach_m)))
                m.stale.insert(key);
    }
}

void CutoutMap::on_height_dirt(std::span<const WorldRect> rects) {
    Impl& m = *impl_;
    std::vector<WorldRect> volumes;
    std::vector<const Operator*> operators;
    {
        const auto lock = m.document.read_lock();
        for (const WorldRect& rect : rects) {
            m.document.operators_over_cutout(rect, operators);
            for (const Operator* op : operators)
                if (const Cutout& cutout = std::get<Cutout>(op->shape); looks_at_heights(cutout))
                    for (const WorldRect& part : rects_of(cutout)) volumes.push_back(intersected(part, rect));
        }
    }
    on_dirt(volumes);
}

void CutoutMap::update_without_gpu(const glm::dvec3& camera_m, int new_pages,
                                   std::vector<WorldRect>& changed) {
    impl_->take_stale(camera_m, new_pages, changed);
    impl_->give_places(camera_m, changed);
}

Status CutoutMap::update(gpu::FrameRing& ring, gpu::Commands& commands, const glm::dvec3& camera_m,
                         int new_pages, std::vector<WorldRect>& changed) {
    LOAM_CHECK(impl_->device, "a cutout map without a device is updated by update_without_gpu");
    update_without_gpu(camera_m, new_pages, changed);
    LOAM_TRY(impl_->cmd_upload(ring, commands));
    if (!impl_->table_buffer) return {};
    commands.use(
        {{impl_->table_buffer, Access::fragment_sampled}, {impl_->page_buffer, Access::fragment_sampled}});
    return {};
}

bool CutoutMap::has_work() const {
    return !impl_->stale.empty();
}

CutoutCover CutoutMap::cover_of(const MapPage& page) const {
    const int level = page.level - impl_->grid.level;
    const glm::ivec2 at = level >= 0 ? glm::ivec2(page.x, page.y) : glm::ivec2(page.x, page.y) >> -level;
    const Impl::Level& covers = impl_->covers[std::min(size_t(std::max(level, 0)), impl_->covers.size() - 1)];
    return covers.at(glm::clamp(at, glm::ivec2(0), covers.size - 1));
}

const gpu::Buffer& CutoutMap::table() const {
    return impl_->table_buffer;
}

const gpu::Buffer& CutoutMap::pages() const {
    return impl_->page_buffer;
}

shared::CutoutPush CutoutMap::push(const glm::dvec3& camera_m) const {
    const Grid& grid = impl_->grid;
    shared::CutoutPush push{};
    push.origin = glm::ivec2(glm::clamp(glm::floor(glm::dvec2(camera_m) / grid.spacing_m), -1e9, 1e9));
    push.origin_rel_m = glm::vec2(glm::dvec2(push.origin) * grid.spacing_m - glm::dvec2(camera_m));
    push.inv_spacing = float(1 / grid.spacing_m);
    push.pages = impl_->pages;
    return push;
}

CutoutMap::Counts CutoutMap::counts() const {
    Counts counts{.mixed = impl_->mixed, .stale = uint32_t(impl_->stale.size())};
    for (const auto& [key, page] : impl_->kept) counts.gone += page.cover == CutoutCover::gone;
    counts.not_shown = counts.mixed > kMaxCutoutPages ? counts.mixed - kMaxCutoutPages : 0;
    return counts;
}

uint64_t CutoutMap::gpu_bytes() const {
    return impl_->table_buffer ? impl_->table_buffer.size_bytes() + impl_->page_buffer.size_bytes() : 0;
}

void CutoutMap::compose(const Document& document, glm::ivec2 page, CutoutBits& bits) {
    thread_local std::vector<uint8_t> cut;
    cut.resize(size_t(kCutoutTexels) * kCutoutTexels);
    bits.fill(0);
    const auto lock = document.read_lock();
    const Grid grid(document.settings());
    if (!cut_vertices(document, grid, page * kCutoutPayload - kCutoutBorder, glm::ivec2(kCutoutTexels),
                      cut.data()))
        return;
    for (int y = 0; y < kCutoutTexels; ++y)
        for (int x = 0; x < kCutoutTexels; ++x)
            bits[size_t(shared::cutout_byte(x, y))] |=
                uint8_t(cut[size_t(y) * kCutoutTexels + size_t(x)] << shared::cutout_bit(x, y));
}

bool CutoutMap::is_cut(const Document& document, double x_m, double y_m) {
    if (!document.bounds().contains(x_m, y_m)) return false;
    const auto lock = document.read_lock();
    const Grid grid(document.settings());
    const glm::dvec2 at = glm::dvec2(x_m, y_m) / grid.spacing_m;
    const glm::ivec2 cell =
        glm::clamp(glm::ivec2(glm::floor(at)), glm::ivec2(0), glm::max(grid.last - 1, glm::ivec2(0)));
    uint8_t cut[4];
    if (!cut_vertices(document, grid, cell, glm::ivec2(2), cut)) return false;
    const glm::vec2 f(at - glm::dvec2(cell));
    return shared::cutout_between(glm::vec4(cut[0], cut[1], cut[2], cut[3]), f.x, f.y);
}

uint32_t CutoutMap::count_stale_pages(const Document& document) const {
    uint32_t different = 0;
    CutoutBits fresh;
    const CutoutBits ground{};
    for (int y = 0; y < impl_->pages.y; ++y)
        for (int x = 0; x < impl_->pages.x; ++x) {
            const uint32_t key = impl_->key_of({x, y});
            if (impl_->stale.contains(key)) continue;
            compose(document, {x, y}, fresh);
            const auto found = impl_->kept.find(key);
            different += fresh != (found == impl_->kept.end() ? ground : found->second.bits);
        }
    return different;
}

}  // namespace loam
