#include "runtime/maps/virtual_map.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "runtime/base/check.h"

namespace loam {

namespace {

// Sample positions are products that may be rounded; a rectangle's edge is taken to include samples this
// share of a spacing beyond it.
constexpr double kHair = 1e-4;

int pages_across(double extent_m, double page_size_m) {
    return std::max(1, static_cast<int>(std::ceil(extent_m / page_size_m - 1e-6)));
}

// Samples whose position lies in [low, high], half open, within a limit that every int can take.
std::pair<int, int> samples_in(double low_m, double high_m, double spacing_m) {
    constexpr double kLimit = 1 << 28;
    const double first = std::ceil(low_m / spacing_m - kHair);
    const double last = std::floor(high_m / spacing_m + kHair);
    return {static_cast<int>(std::clamp(first, -kLimit, kLimit)),
            static_cast<int>(std::clamp(last + 1, -kLimit, kLimit))};
}

}  // namespace

VirtualMap::VirtualMap(const VirtualMapDesc& desc) : desc_(desc), slots_(size_t(desc.slot_count)) {
    LOAM_CHECK(desc.payload_texels > 0 && desc.border_texels >= 0, "a page needs texels");
    LOAM_CHECK(desc.slot_count > 0 && desc.slot_count < kNoSlot, "slot count must be 1 … 65534");
    LOAM_CHECK(desc.level_count > 0 && desc.level_count < 32, "level count must be 1 … 31");
    LOAM_CHECK(desc.spacing_m > 0 && !desc.bounds.empty() && desc.bounds.min_x == 0 && desc.bounds.min_y == 0,
               "the map must begin at the origin and have a positive spacing");
    uint32_t offset = 0;
    for (int level = 0; level < desc.level_count; ++level) {
        level_offsets_.push_back(offset);
        offset += uint32_t(pages_x(level)) * uint32_t(pages_y(level));
    }
    level_offsets_.push_back(offset);
    LOAM_CHECK(pages_x(root().level) == 1 && pages_y(root().level) == 1, "the root page must cover the map");
}

WorldRect VirtualMap::page_rect(const MapPage& page) const {
    const double spacing = spacing_m(page.level);
    const auto at = [&](int p) { return double(int64_t(p) * desc_.payload_texels) * spacing; };
    return {at(page.x), at(page.y), at(page.x + 1), at(page.y + 1)};
}

int VirtualMap::pages_x(int level) const {
    return pages_across(desc_.bounds.max_x, page_size_m(level));
}

int VirtualMap::pages_y(int level) const {
    return pages_across(desc_.bounds.max_y, page_size_m(level));
}

bool VirtualMap::exists(const MapPage& page) const {
    return page.level >= 0 && page.level < desc_.level_count && page.x >= 0 && page.y >= 0 &&
           page.x < pages_x(page.level) && page.y < pages_y(page.level);
}

int VirtualMap::slot_of(const MapPage& page) const {
    const auto found = table_.find(page);
    return found != table_.end() && slots_[size_t(found->second)].in_table ? found->second : -1;
}

TexelRect VirtualMap::dirty_of(int slot) const {
    return united(slots_[size_t(slot)].dirty, slots_[size_t(slot)].planned);
}

MapPage VirtualMap::finest_resident(MapPage page) const {
    while (page.level < root().level && slot_of(page) < 0) page = {page.level + 1, page.x >> 1, page.y >> 1};
    return page;
}

void VirtualMap::request(const MapPage& page, float priority) {
    if (std::isnan(priority) || !exists(page)) return;
    float& wanted = requests_[page];
    wanted = std::max(wanted, std::clamp(priority, FLT_MIN, FLT_MAX));
}

// Marks the resident pages that were requested and returns the absent ones, most wanted first: the
// `missing_limit` first of them. The order does not depend on the hash table's, so that every run makes the
// same choices.
std::vector<std::pair<MapPage, float>> VirtualMap::take_requests(size_t missing_limit,
                                                                 size_t& missing_count) {
    std::vector<std::pair<MapPage, float>> missing;
    requests_[root()] = FLT_MAX;
    for (const auto& [page, priority] : requests_) {
        if (const int slot = slot_of(page); slot >= 0) {
            slots_[size_t(slot)].priority = priority;
            slots_[size_t(slot)].last_requested = frame_;
        } else {
            missing.emplace_back(page, priority);
        }
    }
    requests_.clear();
    missing_count = missing.size();
    const auto more_wanted = [](const auto& a, const auto& b) {
        if (a.second != b.second) return a.second > b.second;
        if (a.first.level != b.first.level) return a.first.level > b.first.level;
        return a.first.y != b.first.y ? a.first.y < b.first.y : a.first.x < b.first.x;
    };
    const size_t count = std::min(missing.size(), missing_limit);
    std::partial_sort(missing.begin(), missing.begin() + ptrdiff_t(count), missing.end(), more_wanted);
    missing.resize(count);
    return missing;
}

void VirtualMap::drop_unfinished() {
    for (Slot& slot : slots_) {
        if (slot.used && !slot.in_table) {
            table_.erase(slot.page);
            slot = {};
        }
        slot.dirty = united(slot.dirty, slot.planned);
        slot.planned = {};
    }
}

// Pages nobody asked for go first, the longest unasked before the others; the root never.
int VirtualMap::least_wanted_slot() const {
    int worst = -1;
    for (int i = 0; i < desc_.slot_count; ++i) {
        const Slot& slot = slots_[size_t(i)];
        if (!slot.in_table || slot.page == root()) continue;
        if (worst < 0) worst = i;
        const Slot& other = slots_[size_t(worst)];
        if (std::pair(slot.priority, slot.last_requested) < std::pair(other.priority, other.last_requested))
            worst = i;
    }
    return worst;
}

uint32_t VirtualMap::table_entry(const MapPage& page) const {
    return level_offset(page.level) + uint32_t(page.y) * uint32_t(pages_x(page.level)) + uint32_t(page.x);
}

void VirtualMap::eject(int index) {
    Slot& slot = slots_[size_t(index)];
    table_.erase(slot.page);
    table_changes_.push_back({table_entry(slot.page), kNoSlot});
    slot = {};
    slot.free_from_frame = frame_ + kSlotRestFrames;
    ++counters_.ejected;
}

std::vector<VirtualMap::Work> VirtualMap::plan(uint64_t frame, int new_pages) {
    frame_ = frame;
    new_pages = std::max(new_pages, 0);
    drop_unfinished();
    for (Slot& slot : slots_) slot.priority = 0;

    // A slot ejected now can be filled in kSlotRestFrames frames: so room is made for as many pages ahead as
    // will be composed until then, and composing never stalls.
    const size_t ahead = size_t(new_pages) * (kSlotRestFrames + 1);
    size_t missing_count = 0;
    const auto missing = take_requests(ahead, missing_count);

    std::vector<Work> work;
    for (int i = 0; i < desc_.slot_count; ++i) {
        Slot& slot = slots_[size_t(i)];
        if (!slot.in_table || slot.dirty.empty() || slot.priority <= 0) continue;
        slot.planned = slot.dirty;
        slot.dirty = {};
        work.push_back({slot.page, i, slot.planned, false});
    }
    std::stable_sort(work.begin(), work.end(), [&](const Work& a, const Work& b) {
        return slots_[size_t(a.slot)].priority > slots_[size_t(b.slot)].priority;
    });

    std::vector<int> free_slots;
    size_t resting_count = 0;
    for (int i = desc_.slot_count - 1; i >= 0; --i) {
        if (slots_[size_t(i)].used) continue;
        if (slots_[size_t(i)].free_from_frame <= frame)
            free_slots.push_back(i);
        else
            ++resting_count;
    }

    int composed = 0, ejected = 0;
    bool waiting = false;
    for (const auto& [page, priority] : missing) {
        if (!free_slots.empty()) {
            waiting = true;
            if (composed == new_pages) {  // kept for the frames to come
                free_slots.pop_back();
                continue;
            }
            ++composed;
            Slot& slot = slots_[size_t(free_slots.back())];
            slot = {};
            slot.page = page;
            slot.used = true;
            slot.priority = priority;
            slot.last_requested = frame;
            slot.planned = {0, 0, page_texels(), page_texels()};
            table_[page] = free_slots.back();
            work.push_back({page, free_slots.back(), slot.planned, true});
            free_slots.pop_back();
        } else if (resting_count > 0) {
            --resting_count;
            waiting = true;
        } else if (ejected < new_pages) {
            const int victim = least_wanted_slot();
            if (victim < 0) break;
            if (double(slots_[size_t(victim)].priority) * (1.0 + double(desc_.hysteresis)) >=
                double(priority))
                break;
            eject(victim);
            std::erase_if(work, [&](const Work& w) { return w.slot == victim; });  // its dirt went with it
            ++ejected;
            waiting = true;
        }
    }
    has_work_ = !work.empty() || waiting || (new_pages == 0 && missing_count > 0);
    return work;
}

void VirtualMap::finish(const Work& work) {
    Slot& slot = slots_[size_t(work.slot)];
    LOAM_CHECK(slot.used && slot.page == work.page, "finished work that was not planned");
    if (work.whole) {
        slot.in_table = true;
        table_changes_.push_back({table_entry(work.page), static_cast<uint16_t>(work.slot)});
        ++counters_.pages_composed;
    }
    slot.planned = {};
    counters_.texels_composed += uint64_t(work.rect.area());
}

TexelRect VirtualMap::texels_in(const MapPage& page, const WorldRect& rect) const {
    if (rect.empty()) return {};
    const double spacing = spacing_m(page.level);
    const auto [x0, x1] = samples_in(rect.min_x, rect.max_x, spacing);
    const auto [y0, y1] = samples_in(rect.min_y, rect.max_y, spacing);
    const int first_x = page.x * desc_.payload_texels - desc_.border_texels;
    const int first_y = page.y * desc_.payload_texels - desc_.border_texels;
    const TexelRect texels{x0 - first_x, y0 - first_y, x1 - first_x, y1 - first_y};
    return texels.empty() ? TexelRect{}
                          : texels;  // a rectangle between the samples of this level changes none of them
}

int VirtualMap::invalidate(const WorldRect& rect, int grow_texels) {
    int touched = 0;
    for (Slot& slot : slots_) {
        if (!slot.used) continue;
        const TexelRect samples = texels_in(slot.page, rect);
        if (samples.empty()) continue;
        const TexelRect grown{samples.x0 - grow_texels, samples.y0 - grow_texels, samples.x1 + grow_texels,
                              samples.y1 + grow_texels};
        const TexelRect texels = intersected(grown, TexelRect{0, 0, page_texels(), page_texels()});
        if (texels.empty()) continue;
        slot.dirty = united(slot.dirty, texels);
        if (slot.priority > 0) has_work_ = true;
        ++touched;
    }
    counters_.pages_dirtied += uint64_t(touched);
    return touched;
}

bool VirtualMap::has_work() const {
    return has_work_;
}

void VirtualMap::for_each_resident(
    const std::function<void(const MapPage&, int slot, const TexelRect& dirty)>& visit) const {
    for (int i = 0; i < desc_.slot_count; ++i)
        if (slots_[size_t(i)].in_table) visit(slots_[size_t(i)].page, i, dirty_of(i));
}

std::vector<VirtualMap::TableChange> VirtualMap::take_table_changes() {
    return std::exchange(table_changes_, {});
}

uint32_t VirtualMap::table_entry_count() const {
    return level_offsets_.back();
}

}  // namespace loam
