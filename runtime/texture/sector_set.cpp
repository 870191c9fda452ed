#include "runtime/texture/sector_set.h"

#include <algorithm>
#include <array>

#include "runtime/base/check.h"

namespace loam {

namespace {
double distance_m(glm::ivec2 sector, glm::dvec2 from_m) {
    const WorldRect square{sector.x * kSectorSize_m, sector.y * kSectorSize_m, (sector.x + 1) * kSectorSize_m,
                           (sector.y + 1) * kSectorSize_m};
    return square.distance(from_m.x, from_m.y);
}
}  // namespace

SectorSet::SectorSet(const SectorSetDesc& desc)
    : desc_(desc), default_tree_(desc.layout.default_log2_width), allocator_(desc.indirection_log2_size) {
    const auto origin = allocator_.allocate(desc.layout.default_log2_width);
    LOAM_CHECK(origin && *origin == glm::ivec2(0),
               "the default sector's image does not fit the indirection texture");
    default_tree_.touch_all();
}

LiveSector* SectorSet::find(glm::ivec2 sector) {
    const auto it =
        std::find_if(live_.begin(), live_.end(), [&](const LiveSector& s) { return s.sector == sector; });
    return it == live_.end() ? nullptr : &*it;
}

PageTree* SectorSet::tree_of(const ImageId& image) {
    if (!image.live) return &default_tree_;
    LiveSector* sector = find({image.sector_x, image.sector_y});
    return sector ? sector->tree.get() : nullptr;
}

FeedbackImages SectorSet::images() const {
    FeedbackImages images;
    images.valid[0] = true;
    for (const LiveSector& s : live_) {
        images.image[size_t(s.id)] = s.image();
        images.valid[size_t(s.id)] = true;
    }
    return images;
}

void SectorSet::want(glm::ivec2 sector, uint64_t frame) {
    if (LiveSector* live = find(sector)) {
        live->last_wanted = frame;
        return;
    }
    const auto known = [&](const Wanted& w) { return w.sector == sector; };
    if (std::none_of(wanted_.begin(), wanted_.end(), known)) wanted_.push_back({sector, frame});
}

void SectorSet::drop(size_t index, std::vector<ImageId>& dropped) {
    dropped.push_back(live_[index].image());
    allocator_.release(live_[index].origin, desc_.layout.sector_log2_width);
    live_.erase(live_.begin() + std::ptrdiff_t(index));
}

bool SectorSet::add(glm::ivec2 sector, uint64_t frame) {
    if (int(live_.size()) >= std::min(desc_.max_live, 255)) return false;
    const auto origin = allocator_.allocate(desc_.layout.sector_log2_width);
    if (!origin) return false;
    std::array<bool, 256> taken{};
    for (const LiveSector& s : live_) taken[size_t(s.id)] = true;
    int id = 1;
    while (taken[size_t(id)]) ++id;
    live_.push_back(
        {sector, id, *origin, frame, false, std::make_unique<PageTree>(desc_.layout.sector_log2_width)});
    live_.back().tree->touch_all();
    return true;
}

std::vector<ImageId> SectorSet::update(glm::dvec2 camera_m, double radius_m, uint64_t frame) {
    std::vector<ImageId> dropped;
    for (size_t i = live_.size(); i-- > 0;)
        if (live_[i].last_wanted + kIdleFrames < frame ||
            distance_m(live_[i].sector, camera_m) > radius_m * kLeave)
            drop(i, dropped);

    std::vector<Wanted> wanted = std::move(wanted_);
    wanted_.clear();
    std::stable_sort(wanted.begin(), wanted.end(), [&](const Wanted& a, const Wanted& b) {
        return distance_m(a.sector, camera_m) < distance_m(b.sector, camera_m);
    });
    for (const Wanted& w : wanted) {
        const double distance = distance_m(w.sector, camera_m);
        if (distance > radius_m) continue;
        if (add(w.sector, frame)) continue;
        const auto farthest = std::max_element(live_.begin(), live_.end(), [&](const auto& a, const auto& b) {
            return distance_m(a.sector, camera_m) < distance_m(b.sector, camera_m);
        });
        if (farthest == live_.end() ||
            distance_m(farthest->sector, camera_m) <= distance * kFarther + kSectorSize_m)
            break;
        drop(size_t(farthest - live_.begin()), dropped);
        if (!add(w.sector, frame)) break;
    }
    return dropped;
}

void SectorSet::write_table(glm::ivec2 camera_sector, std::span<uint32_t> out) const {
    LOAM_CHECK(out.size() == size_t(kSectorTableSide) * kSectorTableSide, "the sector table has one size");
    std::fill(out.begin(), out.end(), 0u);
    for (const LiveSector& s : live_) {
        const glm::ivec2 cell = s.sector - camera_sector + kSectorTableSide / 2;
        const bool inside =
            cell.x > 0 && cell.y > 0 && cell.x < kSectorTableSide - 1 && cell.y < kSectorTableSide - 1;
        if (!s.in_table || !inside) continue;
        out[size_t(cell.y * kSectorTableSide + cell.x)] =
            uint32_t(s.id) | uint32_t(s.origin.x) << 8 | uint32_t(s.origin.y) << 20;
    }
}

}  // namespace loam
