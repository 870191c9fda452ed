#include "runtime/texture/page_pool.h"

#include <algorithm>

#include "runtime/base/check.h"

namespace loam {

namespace {
bool is_default_root(const PageId& page) {
    return !page.image.live && page.depth == 0;
}
}  // namespace

PagePool::PagePool(int pages_per_side, const PagePoolRules& rules)
    : pages_per_side_(pages_per_side),
      rules_(rules),
      places_(size_t(pages_per_side) * size_t(pages_per_side)) {
    by_page_.reserve(places_.size());
}

int PagePool::find(const PageId& page) const {
    const auto it = by_page_.find(page);
    return it == by_page_.end() ? -1 : it->second;
}

void PagePool::touch(int index, uint64_t frame) {
    Place& place = places_[size_t(index)];
    place.last_requested = std::max(place.last_requested, frame);
}

int PagePool::take(const PageId& page, uint64_t frame) {
    LOAM_CHECK(find(page) < 0, "the page has a place already");
    int best = -1;
    if (is_default_root(page)) {
        best = 0;
    } else {
        for (int i = 1; i < place_count(); ++i) {
            const Place& p = places_[size_t(i)];
            if (p.state == State::free) {
                best = i;
                break;
            }
            if (p.state != State::resting || p.changed + kRestFrames > frame) continue;
            if (best < 0 || p.last_requested < places_[size_t(best)].last_requested) best = i;
        }
    }
    if (best < 0) return -1;
    Place& place = places_[size_t(best)];
    if (place.state != State::free) by_page_.erase(place.page);
    const uint32_t generation = place.generation + 1;
    place = {page, State::composed, is_default_root(page), frame, frame, {}, generation};
    by_page_.emplace(page, best);
    return best;
}

int PagePool::takeable_count(uint64_t frame) const {
    return int(std::count_if(places_.begin() + 1, places_.end(), [&](const Place& p) {
        return p.state == State::free || (p.state == State::resting && p.changed + kRestFrames <= frame);
    }));
}

void PagePool::promote(uint64_t frame, const std::function<void(int)>& visit) {
    for (int i = 0; i < place_count(); ++i) {
        Place& p = places_[size_t(i)];
        if (p.state != State::composed || p.changed >= frame) continue;
        p.state = State::usable;
        p.changed = frame;
        visit(i);
    }
}

void PagePool::retire(int index, uint64_t frame) {
    Place& p = places_[size_t(index)];
    LOAM_CHECK(p.state == State::usable && !p.pinned, "only a usable page that is not pinned can be retired");
    p.state = State::resting;
    p.changed = frame;
}

void PagePool::revive(int index, uint64_t frame) {
    Place& p = places_[size_t(index)];
    LOAM_CHECK(p.state == State::resting && p.dirty.empty(), "only a clean resting page can be revived");
    p.state = State::usable;
    p.changed = frame;
    p.last_requested = frame;
}

std::vector<int> PagePool::retirable(uint64_t frame) const {
    std::vector<int> found;
    for (int i = 0; i < place_count(); ++i) {
        const Place& p = places_[size_t(i)];
        if (p.state == State::usable && !p.pinned && p.last_requested + uint64_t(rules_.age_frames) <= frame)
            found.push_back(i);
    }
    std::sort(found.begin(), found.end(), [&](int a, int b) {
        const uint64_t age_a = places_[size_t(a)].last_requested, age_b = places_[size_t(b)].last_requested;
        return age_a != age_b ? age_a < age_b : a < b;
    });
    return found;
}

void PagePool::mark_low_res(int index, int input_level, uint64_t frame) {
    Place& p = places_[size_t(index)];
    p.retry_wait =
        p.low_res ? std::min(p.retry_wait * 2, rules_.last_retry_frames) : rules_.first_retry_frames;
    p.retry_frame = frame + uint64_t(p.retry_wait);
    p.low_res = true;
    p.input_level = input_level;
}

void PagePool::mark_dirty(int index, const TexelRect& rect) {
    Place& p = places_[size_t(index)];
    if (p.state != State::free) p.dirty = united(p.dirty, rect);
}

}  // namespace loam
