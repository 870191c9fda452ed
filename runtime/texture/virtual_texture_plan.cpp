// The deciding half of the virtual texture: no GPU command is recorded here.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/maps/base_window.h"
#include "runtime/maps/tint_blocks.h"
#include "runtime/texture/paint_decals.h"
#include "runtime/texture/virtual_texture_impl.h"
#include "shaders/texture/decal_io.h"

namespace loam {

namespace {

constexpr float kDirtFirst = 1.0e6f;    // before the cells that want a page
constexpr size_t kInputLookahead = 24;  // index pages asked for ahead, of missing pages and of dirty ones
constexpr TexelRect kWholePage{0, 0, kPageTexels, kPageTexels};
constexpr uint64_t kHiddenFrames = 8;  // a sector not seen for so long is hidden

}  // namespace

MapPage VirtualTexture::Impl::index_page(const PageId& page) const {
    const WorldRect square = layout.square(page);
    return index.page_for_square(square.min_x, square.min_y, layout.page_side_m(page));
}

uint32_t VirtualTexture::Impl::indirection_texel(int place, int log2_width) const {
    const PageId& page = pool.place(place).page;
    return uint32_t(place % desc.pages_per_side) | uint32_t(place / desc.pages_per_side) << 8 |
           uint32_t(log2_width - page.depth) << 16 | uint32_t(page.depth) << 24;
}

void VirtualTexture::Impl::enter_tree(int place) {
    const PageId page = pool.place(place).page;
    PageTree* tree = sectors.tree_of(page.image);
    if (!tree || page.depth > tree->log2_width()) {  // the image ended or shrank while its page was composed
        pool.pin(place, false);
        pool.retire(place, frame);
        return;
    }
    tree->set(page.depth, page.x, page.y, indirection_texel(place, tree->log2_width()));
    entered[size_t(place)] = pool.place(place).generation;
    if (page.image.live && page.depth == 0) {
        pool.pin(place, true);
        sectors.find({page.image.sector_x, page.image.sector_y})->in_table = true;
        touch_tables();
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
}

// A resized image: its tree is new, its pages are the same squares of the world. What is finer than it can
// name rests.
void VirtualTexture::Impl::refill_image(const ImageId& image) {
    for (int i = 0; i < pool.place_count(); ++i)
        if (pool.place(i).state == PagePool::State::usable && pool.place(i).page.image == image)
            enter_tree(i);
}

void VirtualTexture::Impl::update_sectors(const TextureView& view) {
    const double texel_angle_rad = std::exp2(double(view.mip_bias)) / view.pixels_per_radian;
    const SectorSet::Changes changes = sectors.update(view.near, texel_angle_rad, frame);
    for (const ImageId& image : changes.dropped) drop_image(image);
    for (const ImageId& image : changes.resized) refill_image(image);
    if (changes.moved) touch_tables();
}

// A live sector that is seen: by a page of its image, or by the default image's finest page over it.
void VirtualTexture::Impl::mark_seen(const std::vector<PageRequest>& wanted) {
    const int sectors_wide = 1 << layout.default_log2_page;
    for (const PageRequest& r : wanted) {
        if (r.page.image.live) {
            sectors.seen({r.page.image.sector_x, r.page.image.sector_y}, frame);
            continue;
        }
        if (r.page.depth < layout.default_log2_width || r.cells == 0) continue;
        for (int y = 0; y < sectors_wide; ++y)
            for (int x = 0; x < sectors_wide; ++x)
                sectors.seen({r.page.x * sectors_wide + x, r.page.y * sectors_wide + y}, frame);
    }
}

void VirtualTexture::Impl::take_feedback(const TextureView& view, Eye eye) {
    EyeState& state = eye_state(eye);
    Inbox& inbox = *state.inbox;
    if (eye == Eye::announced && !view.announced_m) {
        state.requests.clear();
        inbox.fresh = false;
        return;
    }
    if (!inbox.fresh) return;
    inbox.fresh = false;
    // For roots, for hidden sectors, and a sixteenth at rest so that what is lacking finds a place; for an
    // announced place all beyond the third.
    const int places = pool.place_count();
    const int kept = view.announced_m
                         ? places
                         : 1 + int(sectors.live().size()) + places / desc.hidden_divisor + places / 16;
    FeedbackResult result =
        analyse_feedback({.values = inbox.values,
                          .images = &inbox.images,
                          .layout = layout,
                          .capacity_pages = uint32_t(places),
                          .kept_pages = uint32_t(kept),
                          .rules = desc.feedback_rules,
                          .speed_m_s = eye == Eye::camera ? view.speed_m_s : 0.0,
                          .exact = inbox.exact,
                          .is_visible = [this](const PageId& page) {
                              const int place = pool.find(page);
                              return place >= 0 && pool.place(place).state == PagePool::State::usable;
                          }});
    state.requests = std::move(result.requests);
    mark_seen(state.requests);
    if (eye != Eye::camera) return;
    feedback_frame = inbox.frame;
    feedback_view_frame = inbox.view_frame;
    feedback_exact = inbox.exact;
    sharpness = {inbox.view_frame, result.terrain_cells, result.coarser};
}

void VirtualTexture::Impl::want(const PageRequest& request) {
    PageTree* tree = sectors.tree_of(request.page.image);
    // Wanted by a feedback older than the image's end or last resizing.
    if (!tree || request.page.depth > tree->log2_width()) return;
    const int place = pool.find(request.page);
    if (place < 0) {
        if (index.map().exists(index_page(request.page))) missing.push_back(request);
        return;
    }
    pool.touch(place, frame);
    popularity[size_t(place)] = std::max({popularity[size_t(place)], request.popularity, 1u});
    if (pool.place(place).state == PagePool::State::resting && pool.place(place).dirty.empty()) {
        pool.revive(place, frame);
        enter_tree(place);
    }
}

// Fake requests: of every live sector that is not seen the page nearest to the camera, a sixteenth of the
// image wide, so that a quick turn finds something. Source: Call of Duty talk, "Battle Against Low-Rez VT".
void VirtualTexture::Impl::want_hidden() {
    std::vector<const LiveSector*> hidden;
    for (const LiveSector& s : sectors.live())
        if (s.last_seen + kHiddenFrames < frame) hidden.push_back(&s);
    std::sort(hidden.begin(), hidden.end(), [](const LiveSector* a, const LiveSector* b) {
        return a->distance_m != b->distance_m ? a->distance_m < b->distance_m : a->id < b->id;
    });
    for (const LiveSector* s : hidden) want({PageId{s->image(), 0, 0, 0}, 1});
    const size_t limit = size_t(pool.place_count() / desc.hidden_divisor);
    if (hidden.size() > limit) hidden.resize(limit);
    hidden_pages = uint32_t(hidden.size());
    for (const LiveSector* s : hidden) {
        const int depth = std::min(desc.hidden_depth, s->log2_width());
        const auto nearest = [&](double camera, int sector) {
            const double pages = (camera / kSectorSize_m - sector) * double(1 << depth);
            return int(std::clamp(std::floor(pages), 0.0, double((1 << depth) - 1)));
        };
        want({PageId{s->image(), depth, nearest(camera_m.x, s->sector.x), nearest(camera_m.y, s->sector.y)},
              1});
    }
}

uint32_t VirtualTexture::Impl::low_res_count() const {
    uint32_t count = 0;
    for (int i = 0; i < pool.place_count(); ++i) count += pool.place(i).low_res && popularity[size_t(i)] > 0;
    return count;
}

// Everything wanted, most wanted first: the default root, roots of seen sectors, what callers, the picture
// and the announced place ask for, then hidden sectors.
void VirtualTexture::Impl::gather_missing() {
    missing.clear();
    std::fill(popularity.begin(), popularity.end(), 0u);
    want({PageId{}, UINT32_MAX});
    for (const LiveSector& s : sectors.live())
        if (s.last_seen + kHiddenFrames >= frame) want({PageId{s.image(), 0, 0, 0}, UINT32_MAX - 1});
    for (const PageRequest& r : asked) want(r);
    for (const PageRequest& r : camera_eye().requests) want(r);
    const size_t before_announced = missing.size();
    for (const PageRequest& r : eye_state(Eye::announced).requests) want({r.page, r.popularity, 0});
    announced_missing = uint32_t(missing.size() - before_announced);
    want_hidden();
    std::vector<PageRequest> unique;
    std::unordered_set<PageId, PageIdHash> seen;
    for (const PageRequest& r : missing)
        if (seen.insert(r.page).second) unique.push_back(r);
    missing = std::move(unique);
}

// A still picture, all of whose pixels have been asked, shows what they want and nothing else: finer pages
// that happen to be resident would make it depend on the way there. They rest, and come back at once when
// wanted.
void VirtualTexture::Impl::keep_only_wanted(const TextureView& view) {
    if (!view.still || !feedback_exact || feedback_view_frame < view.same_since || !missing.empty()) return;
    for (int i = 0; i < pool.place_count(); ++i)
        if (pool.place(i).state == PagePool::State::composed) return;  // in the tree from the next frame on
    for (int i = 0; i < pool.place_count(); ++i) {
        const PagePool::Place& p = pool.place(i);
        if (p.state == PagePool::State::usable && !p.pinned && popularity[size_t(i)] == 0) leave_tree(i);
    }
    kept_since = view.same_since;
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
    for (const PageRequest& r : camera_eye().requests)
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
        if (shortage-- <= 0) break;
        leave_tree(place);
    }
}

void VirtualTexture::Impl::gather_dirty() {
    dirty.clear();
    for (int i = 0; i < pool.place_count(); ++i) {
        const PagePool::Place& p = pool.place(i);
        if (p.dirty.empty()) continue;
        // A page from coarser inputs is composed whole, as the inputs there are now may be others.
        const TexelRect rect =
            p.low_res ? kWholePage : aligned_out(p.dirty, layers.rect_texels(), kPageTexels);
        dirty.push_back({.place = i,
                         .texels = rect.area(),
                         .shown = shown[size_t(i)],
                         .wanted = popularity[size_t(i)] > 0,
                         .distance_m = layout.square(p.page).distance(camera_m.x, camera_m.y)});
    }
    order_dirty(dirty);
}

void VirtualTexture::Impl::advance(const TextureView& view) {
    ++frame;
    view_frame = view.frame;
    still = view.still;
    same_since = view.same_since;
    advanced = true;
    camera_m = {view.camera_m.x, view.camera_m.y};
    pool.promote(frame, [this](int place) { enter_tree(place); });
    take_feedback(view, Eye::camera);
    take_feedback(view, Eye::announced);
    update_sectors(view);
    budget.frame_took(view.last_frame_ms, view.goal_ms, composed_texels);
    price.frame_took(view.last_frame_ms, composed_texels);
    gather_missing();
    find_shown();
    keep_only_wanted(view);
    make_room();
    gather_dirty();
}

ComposeJob VirtualTexture::Impl::make_job(int place, const TexelRect& rect, const Inputs& from) const {
    return {pool.place(place).page,
            rect,
            {place % desc.pages_per_side, place / desc.pages_per_side},
            from.page,
            index.map().slot_of(from.page),
            from.tier};
}

// A page is composed only from index pages that have no dirt of their own left: what is in the cache is
// always a function of the document, never of what happened to be resident. But for low-res pages, which say
// so. Source: Call of Duty talk, "Streamer Connection".
VirtualTexture::Impl::Inputs VirtualTexture::Impl::inputs_of(const PageId& page, float priority) const {
    const MapPage wanted = index_page(page), there = index.map().finest_resident(wanted);
    const int slot = index.map().slot_of(there);
    if (slot < 0 || stale_inputs.contains(there)) return {there, InputState::absent};
    const InputState state = there == wanted ? InputState::ready : InputState::low_res;
    if (!layers.streams()) return {there, state};
    if (state == InputState::low_res) return {there, state, LayerTier::tail};
    const LayerNeeds needs = composer->needs_of({page, kWholePage, {0, 0}, there, slot});
    // Also where they are there already: until the page has been composed they stay.
    if (!needs.tail_suffices) layers.slots().want(needs.files, priority);
    return {there, layers.ready(needs) ? InputState::ready : InputState::low_res, layers.tier_of(needs)};
}

void VirtualTexture::Impl::choose_dirty(std::vector<ComposeJob>& jobs) {
    std::vector<DirtyPage> ready;
    for (const DirtyPage& d : dirty) {
        const PagePool::Place& p = pool.place(d.place);
        const InputState state = inputs_of(p.page, float(d.shown) + kDirtFirst).state;
        if (state == InputState::ready || (p.low_res && state == InputState::low_res)) ready.push_back(d);
    }
    ready.resize(dirt_that_fits(ready, budget.texels()));
    for (const DirtyPage& d : ready) {
        const PagePool::Place& p = pool.place(d.place);
        const Inputs inputs = inputs_of(p.page, float(d.shown) + kDirtFirst);
        jobs.push_back(make_job(
            d.place, p.low_res ? kWholePage : aligned_out(p.dirty, layers.rect_texels(), kPageTexels),
            inputs));
        if (inputs.state == InputState::ready) pool.clear_low_res(d.place);
        pool.set_input_level(d.place, inputs.page.level);
        pool.clear_dirty(d.place);
    }
}

int VirtualTexture::Impl::pages_left(const TextureView& view, int64_t dirt_texels) const {
    const bool asked = view.budget_pages >= 0;
    return page_allowance({.pages = asked ? view.budget_pages : desc.budget_pages,
                           .ms = asked ? 0.0 : desc.budget_ms,
                           .page_ms = price.page_ms(),
                           .fit_texels = budget.texels(),
                           .waited_for = view.goal_ms > 0},
                          dirt_texels, frame);
}

int VirtualTexture::Impl::choose_missing(int left, std::vector<ComposeJob>& jobs) {
    std::vector<PageRequest> still_missing;
    for (const PageRequest& request : missing) {
        if (left <= 0) {
            still_missing.push_back(request);
            continue;
        }
        const Inputs inputs = inputs_of(request.page, float(request.cells));
        const int place = inputs.state != InputState::absent ? pool.take(request.page, frame) : -1;
        if (place < 0) {
            still_missing.push_back(request);
            continue;
        }
        --left;
        ++counted.pages_composed;
        facts.taken(place);
        if (inputs.state == InputState::low_res) pool.mark_low_res(place, inputs.page.level, frame);
        jobs.push_back(make_job(place, kWholePage, inputs));
    }
    missing = std::move(still_missing);
    return left;
}

// What is left of the budget: low-res pages whose inputs have come, a last time; the others from the best
// there is, at growing intervals. Source: Call of Duty talk, "Battle Against Low-Rez VT", "Composite even
// when not ready".
void VirtualTexture::Impl::choose_low_res(int left, std::vector<ComposeJob>& jobs) {
    std::vector<LowResPage> better;
    for (int i = 0; i < pool.place_count(); ++i) {
        const PagePool::Place& p = pool.place(i);
        // One that was composed in this frame has clean inputs of its own already.
        if (p.state == PagePool::State::free || !p.low_res || popularity[size_t(i)] == 0) continue;
        const Inputs inputs = inputs_of(p.page, float(popularity[size_t(i)]));
        const bool ready = inputs.state == InputState::ready, due = p.retry_frame <= frame;
        if (ready || (due && inputs.state == InputState::low_res && inputs.page.level < p.input_level))
            better.push_back({i, popularity[size_t(i)], p.input_level - inputs.page.level, ready});
        else if (due)
            pool.mark_low_res(i, p.input_level, frame);
    }
    order_low_res(better);
    for (const LowResPage& page : better) {
        if (left-- <= 0) return;
        const Inputs inputs = inputs_of(pool.place(page.place).page, float(page.popularity));
        jobs.push_back(make_job(page.place, kWholePage, inputs));
        if (page.final)
            pool.clear_low_res(page.place);
        else
            pool.mark_low_res(page.place, inputs.page.level, frame);
        pool.clear_dirty(page.place);
    }
}

std::vector<ComposeJob> VirtualTexture::Impl::choose_jobs(const TextureView& view) {
    stale_inputs.clear();
    index.map().for_each_resident([&](const MapPage& page, int, const TexelRect& stale) {
        if (!stale.empty()) stale_inputs.insert(page);
    });
    const auto texels_of = [](const std::vector<ComposeJob>& jobs) {
        return std::accumulate(jobs.begin(), jobs.end(), int64_t(0),
                               [](int64_t sum, const ComposeJob& job) { return sum + job.rect.area(); });
    };
    // What was edited and is in view, then what is missing, then what could be better.
    std::vector<ComposeJob> jobs;
    choose_dirty(jobs);
    const int left = choose_missing(pages_left(view, texels_of(jobs)), jobs);
    choose_low_res(left, jobs);
    std::erase_if(dirty, [&](const DirtyPage& d) { return pool.place(d.place).dirty.empty(); });
    composed_texels = texels_of(jobs);
    counted.rects_composed += jobs.size();
    counted.texels_composed += uint64_t(composed_texels);
    for (const ComposeJob& job : jobs)
        facts.composed(job.target.y * desc.pages_per_side + job.target.x, job.rect.area(), frame);
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
    for (const DirtyPage& d : t.dirty) ask(t.pool.place(d.place).page, kInputLookahead);
    for (int i = 0; i < t.pool.place_count(); ++i)
        if (t.pool.place(i).low_res && t.popularity[size_t(i)] > 0)
            ask(t.pool.place(i).page, 2 * kInputLookahead);
    for (const PageRequest& request : t.missing) ask(request.page, 2 * kInputLookahead);
}

bool VirtualTexture::Impl::shows(const PageId& page, double size_m) const {
    return shared::decal_fade(float(size_m), float(layout.texel_m(page))) > 0;
}

template <typename RectOf>
void VirtualTexture::Impl::take_dirt(std::span<const WorldRect> rects, double size_m, RectOf&& rect_of) {
    Impl& t = *this;
    for (int i = 0; i < t.pool.place_count(); ++i) {
        const PagePool::Place& place = t.pool.place(i);
        if (place.state == PagePool::State::free) continue;
        if (!t.shows(place.page, size_m)) continue;
        const double index_m = t.index.map().spacing_m(t.index_page(place.page).level);
        TexelRect dirty;
        for (const WorldRect& rect : rects) {
            if (rect.empty()) continue;
            const TexelRect texels = page_texels(t.layout, place.page, rect_of(rect, index_m));
            dirty = united(dirty, aligned_out(texels, t.layers.rect_texels(), kPageTexels));
        }
        if (dirty.empty()) continue;
        ++t.counted.pages_dirtied;
        t.pool.mark_dirty(i, dirty);
        t.facts.dirtied(i, t.frame);
    }
    t.gather_dirty();
}

void VirtualTexture::on_dirt(std::span<const WorldRect> rects, double size_m) {
    // Coarser index levels filter over wider texels; one texel of that level is about two texels of the page.
    const double finest_m = impl_->index.map().spacing_m(0);
    impl_->take_dirt(rects, size_m,
                     [&](const WorldRect& rect, double index_m) { return rect.grown(index_m - finest_m); });
}

void VirtualTexture::on_index_dirt(std::span<const WorldRect> rects) {
    // The filter's reach, and distortion's.
    const double distortion_m = impl_->layers.ground.distortion_amplitude_m;
    const bool blocks = impl_->index.compressed_tints();
    impl_->take_dirt(rects, INFINITY, [&](const WorldRect& rect, double index_m) {
        return (blocks ? tint_block_rect(rect, index_m) : rect).grown(index_m + distortion_m);
    });
}

// Texels whose ground changed, where a volume lies on it. A page of coarser texels looks at coarser samples,
// farther away.
void VirtualTexture::on_height_dirt(std::span<const WorldRect> rects) {
    Impl& t = *impl_;
    const auto reach_m = [&](const PageId& page) {
        return ground_reach_m(t.document, t.layout.texel_m(page));
    };
    struct Shaken {
        WorldRect changed, volume;
        double size_m;
    };
    std::vector<Shaken> volumes;
    std::vector<const Operator*> operators;
    {
        const auto lock = t.document.read_lock();
        for (const WorldRect& rect : rects) {
            if (rect.empty()) continue;
            const WorldRect changed = extended_beyond_edges(rect, t.document.bounds());
            t.document.operators_over_ground(changed.grown(reach_m(PageId{})), operators);
            for (const Operator* op : operators)
                volumes.push_back({changed, op->texture_bounds(), op->texture_size_m()});
        }
    }
    if (volumes.empty()) return;
    for (int i = 0; i < t.pool.place_count(); ++i) {
        const PagePool::Place& place = t.pool.place(i);
        if (place.state == PagePool::State::free) continue;
        TexelRect dirty;
        for (const auto& [changed, volume, size_m] : volumes) {
            if (!t.shows(place.page, size_m)) continue;
            const WorldRect seen = intersected(changed.grown(reach_m(place.page)), volume);
            if (!seen.empty())
                dirty = united(dirty, aligned_out(page_texels(t.layout, place.page, seen),
                                                  t.layers.rect_texels(), kPageTexels));
        }
        if (dirty.empty()) continue;
        ++t.counted.pages_dirtied;
        t.pool.mark_dirty(i, dirty);
        t.facts.dirtied(i, t.frame);
    }
    t.gather_dirty();
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
}

double VirtualTexture::live_radius_m(double pixels_per_radian, float mip_bias) const {
    const TextureLayout& layout = impl_->layout;
    const double default_texel_m = layout.texel_m({{}, layout.default_log2_width, 0, 0});
    return default_texel_m * pixels_per_radian * std::exp2(-double(mip_bias)) * SectorSet::kSlack;
}

}  // namespace loam
