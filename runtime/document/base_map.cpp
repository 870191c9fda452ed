#include "runtime/document/base_map.h"

#include <algorithm>
#include <cmath>

namespace loam {

namespace {

MapShape shape_of(BaseMap map, int samples_x, int samples_y, double spacing_m) {
    MapShape shape{
        .map = map, .samples_x = samples_x, .samples_y = samples_y, .spacing_m = spacing_m, .mip_count = 1};
    while (std::max(shape.width(shape.mip_count - 1), shape.height(shape.mip_count - 1)) > kBasePageSide)
        ++shape.mip_count;
    return shape;
}

}  // namespace

MapShape height_shape(const ProjectSettings& settings) {
    return shape_of(BaseMap::height, settings.height_samples_x, settings.height_samples_y,
                    settings.height_spacing_m);
}

MapShape index_shape(const ProjectSettings& settings) {
    const WorldRect bounds = settings.bounds();
    return shape_of(BaseMap::index, int(std::ceil(bounds.width() / settings.index_spacing_m)) + 1,
                    int(std::ceil(bounds.height() / settings.index_spacing_m)) + 1, settings.index_spacing_m);
}

bool BasePages::find(int64_t key, std::shared_ptr<const void>& page) {
    std::lock_guard lock(cache_mutex_);
    const auto found = entries_.find(key);
    if (found == entries_.end()) return false;
    ages_.splice(ages_.begin(), ages_, found->second.age);
    page = found->second.page;
    return true;
}

void BasePages::insert(int64_t key, std::shared_ptr<const void> page, size_t bytes) {
    std::lock_guard lock(cache_mutex_);
    auto [entry, fresh] = entries_.try_emplace(key);
    if (fresh) {
        ages_.push_front(key);
        entry->second.age = ages_.begin();
    } else {
        bytes_ -= entry->second.bytes;
        ages_.splice(ages_.begin(), ages_, entry->second.age);
    }
    entry->second.page = std::move(page);
    entry->second.bytes = bytes;
    bytes_ += bytes;
    while (bytes_ > capacity_bytes_ && ages_.size() > 1) {
        const auto oldest = entries_.find(ages_.back());
        bytes_ -= oldest->second.bytes;
        entries_.erase(oldest);
        ages_.pop_back();
    }
}

void BasePages::forget(int64_t key) {
    std::lock_guard lock(cache_mutex_);
    const auto found = entries_.find(key);
    if (found == entries_.end()) return;
    bytes_ -= found->second.bytes;
    ages_.erase(found->second.age);
    entries_.erase(found);
}

void BasePages::clear() {
    std::lock_guard lock(cache_mutex_);
    entries_.clear();
    ages_.clear();
    bytes_ = 0;
}

uint64_t BasePages::cached_pages() const {
    std::lock_guard lock(cache_mutex_);
    return entries_.size();
}

uint64_t BasePages::cached_bytes() const {
    std::lock_guard lock(cache_mutex_);
    return bytes_;
}

}  // namespace loam
