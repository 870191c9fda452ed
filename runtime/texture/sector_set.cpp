#include "runtime/texture/sector_set.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "runtime/base/check.h"

namespace loam {

namespace {

constexpr double kNearest_m = 0.25;   // an eye is never thought to be nearer: the finest texels are 1 mm
constexpr double kUnseenPenalty = 2;  // of the distance, where there are more sectors than ids
constexpr double kKnownBonus = 0.8;   // so that two equally far sectors do not take turns

int64_t area(int log2) {
    return int64_t(1) << (2 * log2);
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

const PageTree* SectorSet::tree_of(const ImageId& image) const {
    if (!image.live) return &default_tree_;
    for (const LiveSector& s : live_)
        if (s.image() == image) return s.tree.get();
    return nullptr;
}

FeedbackImages SectorSet::images() const {
    FeedbackImages images;
    images.valid[0] = true;
    images.log2_width[0] = int8_t(desc_.layout.default_log2_width);
    for (const LiveSector& s : live_) {
        images.image[size_t(s.id)] = s.image();
        images.log2_width[size_t(s.id)] = int8_t(s.log2_width());
        images.valid[size_t(s.id)] = true;
    }
    return images;
}

void SectorSet::seen(glm::ivec2 sector, uint64_t frame) {
    if (LiveSector* live = find(sector)) live->last_seen = frame;
}

int SectorSet::wanted_log2(double texel_m) const {
    const double root_m = kSectorSize_m / kPagePayload;
    if (!(texel_m < std::ldexp(root_m, desc_.layout.default_log2_page))) return -1;
    // A hair of tolerance: at exactly a power of two the smaller image has the texels.
    const double log2 = std::ceil(std::log2(root_m / texel_m) - 1e-6);
    return int(std::clamp(log2, 0.0, double(kMaxSectorLog2Width)));
}

std::vector<SectorSet::Target> SectorSet::targets(std::span<const SectorDistance> near,
                                                  double texel_angle_rad, uint64_t frame) {
    std::vector<Target> found;
    std::vector<double> order;
    for (const SectorDistance& s : near) {
        const double distance_m = s.distance_m > kNearest_m ? s.distance_m : kNearest_m;
        const LiveSector* live = find(s.sector);
        const int least = wanted_log2(distance_m * texel_angle_rad);
        const int kept =
            live ? std::min(wanted_log2(distance_m * texel_angle_rad / kSlack), live->log2_width()) : -1;
        const int log2 = std::max(least, kept);
        if (log2 < 0) continue;
        found.push_back({s.sector, distance_m, log2, std::max(least, 0), live != nullptr});
    }
    // Nearest first; where ids are short, those that are seen or live already count as nearer.
    const auto rank = [&](const Target& t) {
        const LiveSector* live = t.known ? find(t.sector) : nullptr;
        const bool unseen = live && live->last_seen + kSeenFrames < frame;
        return t.distance_m * (live ? kKnownBonus : 1.0) * (unseen ? kUnseenPenalty : 1.0);
    };
    const size_t limit = size_t(std::clamp(desc_.max_live, 0, 255));
    const auto nearer = [](const Target& a, const Target& b) {
        if (a.distance_m != b.distance_m) return a.distance_m < b.distance_m;
        return a.sector.y != b.sector.y ? a.sector.y < b.sector.y : a.sector.x < b.sector.x;
    };
    std::sort(found.begin(), found.end(), nearer);
    if (found.size() > limit) {
        std::stable_sort(found.begin(), found.end(),
                         [&](const Target& a, const Target& b) { return rank(a) < rank(b); });
        found.resize(limit);
        std::sort(found.begin(), found.end(), nearer);
    }
    return found;
}

// Makes the sizes fit the indirection texture.
void SectorSet::fit(std::vector<Target>& targets) {
    const int64_t room = capacity_texels() - area(desc_.layout.default_log2_width);
    const auto total = [&] {
        int64_t sum = 0;
        for (const Target& t : targets) sum += area(t.log2);
        return sum;
    };
    capped_count_ = 0;
    cap_log2_ = kMaxSectorLog2Width;
    int64_t sum = total();
    if (sum <= room) return;
    for (Target& t : targets) t.log2 = t.least_log2;
    sum = total();
    while (sum > room) {
        // `targets` is sorted by distance: the last of the largest is the farthest.
        auto largest = targets.begin();
        for (auto it = targets.begin(); it != targets.end(); ++it)
            if (it->log2 >= largest->log2) largest = it;
        sum -= area(largest->log2);
        if (largest->log2 == 0) {
            targets.erase(largest);
            continue;
        }
        sum += area(--largest->log2);
    }
    for (const Target& t : targets) {
        if (t.log2 >= t.least_log2) continue;
        cap_log2_ = capped_count_++ == 0 ? t.log2 : std::max(cap_log2_, t.log2);
    }
}

int SectorSet::free_id() const {
    std::array<bool, 256> taken{};
    for (const LiveSector& s : live_) taken[size_t(s.id)] = true;
    int id = 1;
    while (taken[size_t(id)]) ++id;
    return id;
}

void SectorSet::repack() {
    ++repack_count_;
    allocator_ = IndirectionAllocator(desc_.indirection_log2_size);
    const auto corner = allocator_.allocate(desc_.layout.default_log2_width);
    LOAM_CHECK(corner && *corner == glm::ivec2(0), "the default image keeps its corner");
    std::vector<LiveSector*> order;
    for (LiveSector& s : live_) order.push_back(&s);
    std::stable_sort(order.begin(), order.end(), [](const LiveSector* a, const LiveSector* b) {
        return a->log2_width() > b->log2_width();
    });
    for (LiveSector* s : order) {
        const auto origin = allocator_.allocate(s->log2_width());
        LOAM_CHECK(origin, "images that fit by their area fit the indirection texture");
        s->origin = *origin;
        s->tree->touch_all();
    }
}

void SectorSet::place(const std::vector<Target>& targets, uint64_t frame, Changes& changes) {
    const auto target_of = [&](glm::ivec2 sector) {
        return std::find_if(targets.begin(), targets.end(),
                            [&](const Target& t) { return t.sector == sector; });
    };
    // What ends or changes its size gives its square back first: its texels are read by earlier frames only.
    for (size_t i = live_.size(); i-- > 0;) {
        LiveSector& s = live_[i];
        const auto target = target_of(s.sector);
        if (target != targets.end() && target->log2 == s.log2_width()) continue;
        allocator_.release(s.origin, s.log2_width());
        changes.moved = true;
        if (target != targets.end()) {
            changes.resized.push_back(s.image());
            s.origin = glm::ivec2(-1);
            s.tree = std::make_unique<PageTree>(target->log2);
            continue;
        }
        changes.dropped.push_back(s.image());
        live_.erase(live_.begin() + std::ptrdiff_t(i));
    }
    for (const Target& t : targets) {
        if (LiveSector* live = find(t.sector)) {
            live->distance_m = t.distance_m;
            continue;
        }
        live_.push_back({t.sector, free_id(), glm::ivec2(-1), t.distance_m, frame, false,
                         std::make_unique<PageTree>(t.log2)});
    }
    bool refused = false;
    for (LiveSector& s : live_) {
        if (s.origin.x >= 0) continue;
        s.tree->touch_all();
        const auto origin = refused ? std::nullopt : allocator_.allocate(s.log2_width());
        if (origin)
            s.origin = *origin;
        else
            refused = true;
    }
    if (refused) {
        repack();
        changes.moved = true;
    }
}

SectorSet::Changes SectorSet::update(std::span<const SectorDistance> near, double texel_angle_rad,
                                     uint64_t frame) {
    std::vector<Target> wanted = targets(near, texel_angle_rad, frame);
    fit(wanted);
    Changes changes;
    place(wanted, frame, changes);
    return changes;
}

void SectorSet::write_table(glm::ivec2 middle_sector, std::span<uint32_t> out) const {
    LOAM_CHECK(out.size() == size_t(kSectorTableSide) * kSectorTableSide, "the sector table has one size");
    std::fill(out.begin(), out.end(), 0u);
    for (const LiveSector& s : live_) {
        const glm::ivec2 cell = s.sector - middle_sector + kSectorTableSide / 2;
        const bool inside =
            cell.x > 0 && cell.y > 0 && cell.x < kSectorTableSide - 1 && cell.y < kSectorTableSide - 1;
        if (!s.in_table || !inside) continue;
        out[size_t(cell.y * kSectorTableSide + cell.x)] = uint32_t(s.id) | uint32_t(s.origin.x) << 8 |
                                                          uint32_t(s.origin.y) << 18 |
                                                          uint32_t(s.log2_width()) << 28;
    }
}

std::vector<SectorDistance> flat_sector_distances(const WorldRect& bounds, const glm::dvec3& eye_m,
                                                  double radius_m) {
    std::vector<SectorDistance> near;
    const auto first = [&](double at_m) { return int(std::floor((at_m - radius_m) / kSectorSize_m)); };
    const auto last = [&](double at_m) { return int(std::floor((at_m + radius_m) / kSectorSize_m)); };
    for (int y = std::max(first(eye_m.y), 0); y <= last(eye_m.y) && y * kSectorSize_m < bounds.max_y; ++y)
        for (int x = std::max(first(eye_m.x), 0); x <= last(eye_m.x) && x * kSectorSize_m < bounds.max_x;
             ++x) {
            const WorldRect square{x * kSectorSize_m, y * kSectorSize_m, (x + 1) * kSectorSize_m,
                                   (y + 1) * kSectorSize_m};
            const double distance = std::hypot(square.distance(eye_m.x, eye_m.y), eye_m.z);
            if (distance <= radius_m) near.push_back({{x, y}, distance});
        }
    return near;
}

}  // namespace loam
