// The deciding half of the virtual texture: no GPU command is recorded here.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/texture/virtual_texture_impl.h"

namespace loam {

namespace {

// Dirt that is in view is composed in the next frame up to this, whatever the budget says: a dab shows at
// once.
constexpr int64_t kShownDirtTexels = 4 * ComposeBudget::kPage;
constexpr size_t kInputLookahead = 24;  // index pages asked for ahead, of missing pages and of dirty ones
// A page not wanted for so long, whose parent is, only shows texels too fine for the distance.
constexpr uint64_t kTooFineFrames = 30;

}  // namespace

MapPage VirtualTexture::Impl::index_page(const PageId& page) const {
    const WorldRect square = layout.square(page);
    return index.page_for_square(square.min_x, square.min_y, layout.page_side_m(page));
}

uint32_t VirtualTexture::Impl::indirection_texel(int place) const {
    const PageId& page = pool.place(place).page;
    return uint32_t(place % desc.pages_per_side) | uint32_t(place / desc.pages_per_side) << 8 |
           uint32_t(layout.mip(page)) << 16 | uint32_t(page.depth) << 24;
}

void VirtualTexture::Impl::enter_tree(int place) {
    const PageId page = pool.place(place).page;
    PageTree* tree = sectors.tree_of(page.image);
    if (!tree) {  // the sector went away while its page was composed
        pool.retire(place, frame);
        return;
    }
    tree->set(page.depth, page.x, page.y, indirection_texel(place));
    if (page.image.live && page.depth == 0) {
        pool.pin(place, true);
        sectors.find({page.image.sector_x, page.image.sector_y})->in_table = true;
        table_changed = true;
    }
}

void VirtualTexture::Impl::leave_tree(int place) {
    const PageId page = pool.place(place).page;
    if (PageTree* tree = sectors.tree_of(page.image)) tree->set(page.depth, page.x, page.y, kNoPage);
    pool.retire(place, frame);
}

void VirtualTexture::Impl::drop_image(const ImageId& image) {
    for (int i = 0; i < pool.place_count(); ++i)
        if (pool.place(i).state == PagePool::State::usable && pool.place(i).page.image == image) {
            pool.pin(i, false);
            pool.retire(i, frame);
        }
    table_changed = true;
}

void VirtualTexture::Impl::take_feedback() {
    if (!inbox->fresh) return;
    inbox->fresh = false;
    feedback_frame = inbox->frame;
    feedback_view_frame = inbox->view_frame;
    const FeedbackResult result =
        analyse_feedback({.values = inbox->values,
                          .images = &inbox->images,
                          .layout = layout,
                          .capacity_pages = uint32_t(pool.place_count()),
                          .is_visible = [this](const PageId& page) {
                              const int place = pool.find(page);
                              return place >= 0 && pool.place(place).state == PagePool::State::usable;
                          }});
    requests = result.requests;
    for (const PageId& page : result.wants_finer) {
        const int sectors_wide = 1 << layout.default_log2_page;
        for (int y = 0; y < sectors_wide; ++y)
            for (int x = 0; x < sectors_wide; ++x)
                sectors.want({page.x * sectors_wide + x, page.y * sectors_wide + y}, frame);
    }
    // A live sector that is seen stays.
    for (const PageRequest& r : requests)
        if (r.page.image.live) sectors.want({r.page.image.sector_x, r.page.image.sector_y}, frame);
}

void VirtualTexture::Impl::want(const PageRequest& request) {
    PageTree* tree = sectors.tree_of(request.page.image);
    if (!tree) return;  // wanted by a feedback older than the sector's end
    const int place = pool.find(request.page);
    if (place < 0) {
        if (index.map().exists(index_page(request.page))) missing.push_back(request);
        return;
    }
    pool.touch(place, frame);
    popularity[size_t(place)] = std::max(popularity[size_t(place)], request.popularity);
    if (pool.place(place).state == PagePool::State::resting && pool.place(place).dirty.empty()) {
        pool.revive(place, frame);
        enter_tree(place);
    }
}

// Everything wanted, most wanted first: the default root, the roots of live sectors, then what feedback and
// callers ask for.
void VirtualTexture::Impl::gather_missing() {
    missing.clear();
    std::fill(popularity.begin(), popularity.end(), 0u);
    want({PageId{}, UINT32_MAX});
    for (const LiveSector& sector : sectors.live()) want({PageId{sector.image(), 0, 0, 0}, UINT32_MAX - 1});
    for (const PageRequest& r : asked) want(r);
    for (const PageRequest& r : requests) want(r);
    std::vector<PageRequest> unique;
    std::unordered_set<PageId, PageIdHash> seen;
    for (const PageRequest& r : missing)
        if (seen.insert(r.page).second) unique.push_back(r);
    missing = std::move(unique);
}

// Which pages the picture shows now: what a cell wants, or the nearest page above it that is usable.
void VirtualTexture::Impl::find_shown() {
    std::fill(shown.begin(), shown.end(), 0u);
    const auto show = [&](PageId page, uint32_t cells) {
        for (;; page = page.parent()) {
            const int place = pool.find(page);
            if (place >= 0 && pool.place(place).state == PagePool::State::usable) {
                shown[size_t(place)] += cells;
                return;
            }
            if (page.depth == 0) return;
        }
    };
    for (const PageRequest& r : requests)
        if (r.cells > 0) show(r.page, r.cells);
}

// Pages leave the trees early enough for their places to rest before they are needed.
void VirtualTexture::Impl::make_room() {
    int available = 0;
    for (int i = 1; i < pool.place_count(); ++i) {
        const PagePool::Place& p = pool.place(i);
        available += p.state == PagePool::State::free || p.state == PagePool::State::resting;
    }
    int shortage = int(missing.size()) - available;
    for (const int place : pool.retirable(frame)) {
        const PagePool::Place& p = pool.place(place);
        const int parent = p.page.depth > 0 ? pool.find(p.page.parent()) : -1;
        const bool too_fine = parent >= 0 && pool.place(parent).last_requested == frame &&
                              pool.place(parent).state == PagePool::State::usable &&
                              p.last_requested + kTooFineFrames < frame;
        if (shortage <= 0 && !too_fine) continue;
        leave_tree(place);
        --shortage;
    }
}

void VirtualTexture::Impl::order_dirty() {
    dirty_order.clear();
    for (int i = 0; i < pool.place_count(); ++i)
        if (!pool.place(i).dirty.empty()) dirty_order.push_back(i);
    const auto distance_m = [&](int place) {
        return layout.square(pool.place(place).page).distance(camera_m.x, camera_m.y);
    };
    std::sort(dirty_order.begin(), dirty_order.end(), [&](int a, int b) {
        const uint32_t sa = shown[size_t(a)], sb = shown[size_t(b)];
        if (sa != sb) return sa > sb;
        const bool wa = popularity[size_t(a)] > 0, wb = popularity[size_t(b)] > 0;
        if (wa != wb) return wa;
        const double da = distance_m(a), db = distance_m(b);
        return da != db ? da < db : a < b;
    });
}

void VirtualTexture::Impl::advance(const TextureView& view) {
    ++frame;
    view_frame = view.frame;
    advanced = true;
    pool.promote(frame, [this](int place) { enter_tree(place); });
    take_feedback();
    const PageId finest_default{{}, layout.default_log2_width, 0, 0};
    const double radius_m =
        layout.texel_m(finest_default) * view.pixels_per_radian * std::exp2(-double(view.mip_bias));
    for (const ImageId& image : sectors.update({view.camera_m.x, view.camera_m.y}, radius_m, frame))
        drop_image(image);
    camera_m = {view.camera_m.x, view.camera_m.y};
    budget.frame_took(view.last_frame_ms, view.goal_ms, composed_texels);
    gather_missing();
    find_shown();
    make_room();
    order_dirty();
}

ComposeJob VirtualTexture::Impl::make_job(int place, const TexelRect& rect) const {
    const PageId& page = pool.place(place).page;
    const MapPage from = index_page(page);
    return {page,
            rect,
            {place % desc.pages_per_side, place / desc.pages_per_side},
            from,
            index.map().slot_of(from)};
}

// A page is composed only from an index page that is there and has no dirt of its own left: what is in the
// cache is always a function of the document, never of what happened to be resident.
std::vector<ComposeJob> VirtualTexture::Impl::choose_jobs(const TextureView& view) {
    std::unordered_set<MapPage, MapPageHash> stale;
    index.map().for_each_resident([&](const MapPage& page, int, const TexelRect& dirty) {
        if (!dirty.empty()) stale.insert(page);
    });
    const auto ready = [&](const PageId& page) {
        const MapPage from = index_page(page);
        return index.map().slot_of(from) >= 0 && !stale.contains(from);
    };
    std::vector<ComposeJob> jobs;
    int64_t texels = 0;
    for (const int place : dirty_order) {
        if (!ready(pool.place(place).page)) continue;
        const TexelRect rect = aligned_out(pool.place(place).dirty, 8, kPageTexels);
        const int64_t limit = shown[size_t(place)] > 0 ? kShownDirtTexels : budget.texels();
        if (texels > 0 && texels + rect.area() > limit) break;
        texels += rect.area();
        jobs.push_back(make_job(place, rect));
        pool.clear_dirty(place);
    }
    std::erase_if(dirty_order, [&](int place) { return pool.place(place).dirty.empty(); });

    // New pages share the budget with dirt; at least one is composed every other frame.
    int left = view.budget_pages >= 0 ? view.budget_pages : desc.budget_pages;
    if (view.goal_ms > 0) {
        const int64_t fit = std::max<int64_t>(0, budget.texels() - texels) / ComposeBudget::kPage;
        left = std::min(left, std::max(int(fit), texels == 0 || frame % 2 == 0 ? 1 : 0));
    }
    std::vector<PageRequest> still_missing;
    for (const PageRequest& request : missing) {
        const int place = left > 0 && ready(request.page) ? pool.take(request.page, frame) : -1;
        if (place < 0) {
            still_missing.push_back(request);
            continue;
        }
        --left;
        ++counted.pages_composed;
        jobs.push_back(make_job(place, {0, 0, kPageTexels, kPageTexels}));
    }
    missing = std::move(still_missing);
    composed_texels = 0;
    for (const ComposeJob& job : jobs) {
        composed_texels += job.rect.area();
        ++counted.rects_composed;
        counted.texels_composed += uint64_t(job.rect.area());
    }
    return jobs;
}

void VirtualTexture::request_inputs(const TextureView& view) {
    Impl& t = *impl_;
    if (!t.advanced) t.advance(view);
    // Dirt first, then missing pages, in the order in which they will be composed.
    float priority = 1.0e6f;
    std::unordered_set<MapPage, MapPageHash> asked;
    const auto ask = [&](const PageId& page, size_t limit) {
        const MapPage from = t.index_page(page);
        if (asked.contains(from) || asked.size() >= limit) return;
        asked.insert(from);
        t.index.request(from, priority);
        priority -= 1.0f;
    };
    for (const int place : t.dirty_order) ask(t.pool.place(place).page, kInputLookahead);
    for (const PageRequest& request : t.missing) ask(request.page, 2 * kInputLookahead);
}

void VirtualTexture::on_dirt(std::span<const WorldRect> rects) {
    Impl& t = *impl_;
    const double finest_m = t.index.map().spacing_m(0);
    for (int i = 0; i < t.pool.place_count(); ++i) {
        const PagePool::Place& place = t.pool.place(i);
        if (place.state == PagePool::State::free) continue;
        // Coarser index levels filter over wider texels; one texel of that level is about two texels of the
        // page.
        const double grow_m = t.index.map().spacing_m(t.index_page(place.page).level) - finest_m;
        TexelRect dirty;
        for (const WorldRect& rect : rects) {
            if (rect.empty()) continue;
            const TexelRect texels = page_texels(t.layout, place.page, rect.grown(grow_m));
            dirty = united(dirty, aligned_out(texels, 8, kPageTexels));
        }
        if (dirty.empty()) continue;
        ++t.counted.pages_dirtied;
        t.pool.mark_dirty(i, dirty);
    }
    t.order_dirty();
}

void VirtualTexture::on_index_dirt(std::span<const WorldRect> rects) {
    std::vector<WorldRect> grown;
    for (const WorldRect& rect : rects)
        if (!rect.empty()) grown.push_back(rect.grown(impl_->index.map().spacing_m(0)));
    on_dirt(grown);
}

void VirtualTexture::request_pages(std::span<const PageId> pages) {
    impl_->asked.clear();
    for (PageId page : pages)
        for (;; page = page.parent()) {
            impl_->asked.push_back({page, 1});
            if (page.depth == 0) break;
        }
    std::stable_sort(impl_->asked.begin(), impl_->asked.end(),
                     [](const PageRequest& a, const PageRequest& b) { return a.page.depth < b.page.depth; });
    // A page of a live image makes its sector live.
    for (const PageId& page : pages)
        if (page.image.live) impl_->sectors.want({page.image.sector_x, page.image.sector_y}, impl_->frame);
}

}  // namespace loam
