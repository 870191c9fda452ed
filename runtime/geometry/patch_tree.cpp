#include "runtime/geometry/patch_tree.h"

#include "runtime/base/check.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_set>

namespace loam {

namespace {

constexpr int kMaxDelta = 3;  // log2(kPatchQuads): a patch's edge is at least one whole quad of its neighbour
static_assert(1 << kMaxDelta == kPatchQuads);

using PageSet = std::unordered_set<MapPage, MapPageHash>;

MapPage parent_of(const MapPage& page) {
    return {page.level + 1, page.x >> 1, page.y >> 1};
}

std::vector<MapPage> children_of(const VirtualMap& map, const MapPage& page) {
    std::vector<MapPage> children;
    for (int i = 0; i < 4; ++i) {
        const MapPage child{page.level - 1, page.x * 2 + (i & 1), page.y * 2 + (i >> 1)};
        if (map.exists(child)) children.push_back(child);
    }
    return children;
}

// Half spaces dot(xyz, p) + w >= 0 that a visible point lies in. The far plane is infinite, and an
// orthographic view must not lose what casts shadows from before it, so that depth counts only as the near
// plane of a perspective.
struct Frustum {
    std::array<glm::dvec4, 5> planes;
    int count = 4;

    explicit Frustum(const glm::dmat4& clip_from_rel) {
        const glm::dmat4 rows = glm::transpose(clip_from_rel);
        planes = {rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1],
                  rows[3] - rows[2]};
        const bool perspective = glm::dvec3(rows[3]) != glm::dvec3(0);
        if (perspective) count = 5;
    }
    [[nodiscard]] bool meets(const PatchBox& box) const {
        for (int i = 0; i < count; ++i) {
            const glm::dvec4& plane = planes[size_t(i)];
            const glm::dvec3 corner(plane.x > 0 ? box.high_m.x : box.low_m.x,
                                    plane.y > 0 ? box.high_m.y : box.low_m.y,
                                    plane.z > 0 ? box.high_m.z : box.low_m.z);
            if (glm::dot(glm::dvec3(plane), corner) + plane.w < 0) return false;
        }
        return true;
    }
};

double distance_to_origin(const PatchBox& box) {
    return glm::length(glm::max(glm::max(box.low_m, -box.high_m), glm::dvec3(0)));
}

class Selection {
  public:
    Selection(HeightMap& heights, const PatchView& view)
        : heights_(heights), map_(heights.map()), view_(view), frustum_(view.clip_from_rel) {}

    void select() {
        heights_.request(map_.root(), kRootPriority);
        if (map_.slot_of(map_.root()) < 0) return;
        visit(map_.root(), kRootPriority, true);
        // Where pages of very different levels meet, the finer side gives way. Rare: the distance alone never
        // does it.
        while (keep_whole_where_too_steep()) {
            leaves_.clear();
            visit(map_.root(), kRootPriority, false);
        }
    }

    PatchSet result() {
        PatchSet set;
        set.camera_m = view_.camera_m;
        set.step_m = map_.spacing_m(0) * kPatchQuadTexels;
        set.origin_step = glm::ivec2(glm::floor(glm::dvec2(view_.camera_m) / set.step_m));
        set.origin_rel_m = glm::dvec2(set.origin_step) * set.step_m - glm::dvec2(view_.camera_m);
        set.map_edge_rel_m =
            glm::dvec2(map_.desc().bounds.max_x, map_.desc().bounds.max_y) - glm::dvec2(view_.camera_m);
        const auto visible = [&](const MapPage& page) {
            return frustum_.meets(patch_box(heights_, page, view_.camera_m));
        };
        const auto cover = [&](const MapPage& page) {
            return view_.cutouts ? view_.cutouts->cover_of(page) : CutoutCover::ground;
        };
        const auto is_whole = [&](const MapPage& page) { return cover(page) == CutoutCover::ground; };
        set.cutouts = view_.cutouts;
        std::erase_if(leaves_, [&](const MapPage& page) { return cover(page) == CutoutCover::gone; });
        const auto hidden = std::stable_partition(leaves_.begin(), leaves_.end(), visible);
        set.visible_count = int(hidden - leaves_.begin());
        set.visible_cut = int(hidden - std::stable_partition(leaves_.begin(), hidden, is_whole));
        set.hidden_cut = int(leaves_.end() - std::stable_partition(hidden, leaves_.end(), is_whole));
        for (const MapPage& page : leaves_) set.patches.push_back(instance(page, set.origin_step));
        for (size_t i = 0; i < leaves_.size(); ++i)  // in any order
            set.cut_hash +=
                (MapPageHash{}(leaves_[i]) + (set.has_holes(uint32_t(i)) ? 1 : 0)) * 0x9E3779B97F4A7C15ull;
        set.pages = std::move(leaves_);
        return set;
    }

  private:
    static constexpr float kRootPriority = 4;

    // Priorities: 1 / (1 + distance / side) of the parent, plus 1 in the frustum; four siblings have the
    // same, as they are of use only together; none has more than its parent, so that ancestors come first.
    void visit(const MapPage& page, float priority, bool requesting) {
        const PatchBox box = patch_box(heights_, page, view_.camera_m);
        const double side = map_.page_size_m(page.level);
        const double distance = distance_to_origin(box);
        // What the camera cannot see only casts shadows into the picture and waits for a turn of the head.
        const double reach = view_.split_distance * (frustum_.meets(box) ? 1.0 : view_.hidden_share);
        const bool near =
            distance < reach * side || (view_.max_level > 0 && page.level > view_.max_level);
        if (page.level <= view_.min_level || page.level == 0 || !near) {
            leaves_.push_back(page);
            return;
        }
        const float seen = frustum_.meets(box) ? 1.0f : 0.0f;
        const float wanted =
            std::min(priority * 0.9999f, static_cast<float>(1.0 / (1.0 + distance / side)) + seen);
        const std::vector<MapPage> children = children_of(map_, page);
        bool all_resident = true;
        for (const MapPage& child : children) {
            if (requesting) heights_.request(child, wanted);
            all_resident = all_resident && map_.slot_of(child) >= 0;
        }
        if (!all_resident || kept_whole_.contains(page)) {
            leaves_.push_back(page);
            return;
        }
        for (const MapPage& child : children) visit(child, wanted, requesting);
    }

    // The level of the leaf that covers a page's square; -1: outside the map, or finer leaves.
    [[nodiscard]] int leaf_level(MapPage page) const {
        if (!map_.exists(page)) return -1;
        for (; page.level <= map_.root().level; page = parent_of(page))
            if (leaf_set_.contains(page)) return page.level;
        return -1;
    }

    static std::array<MapPage, 4> neighbours(
        const MapPage& p) {  // west, south, east, north: the order of lod_deltas
        return {{{p.level, p.x - 1, p.y},
                 {p.level, p.x, p.y - 1},
                 {p.level, p.x + 1, p.y},
                 {p.level, p.x, p.y + 1}}};
    }

    bool keep_whole_where_too_steep() {
        leaf_set_ = PageSet(leaves_.begin(), leaves_.end());
        bool changed = false;
        for (const MapPage& leaf : leaves_)
            for (const MapPage& neighbour : neighbours(leaf)) {
                const int level = leaf_level(neighbour);
                if (level - leaf.level <= kMaxDelta) continue;
                MapPage whole = leaf;
                while (whole.level < level - kMaxDelta) whole = parent_of(whole);
                changed = kept_whole_.insert(whole).second || changed;
            }
        return changed;
    }

    [[nodiscard]] shared::PatchInstance instance(const MapPage& page, glm::ivec2 origin_step) const {
        shared::PatchInstance patch;
        patch.stride = 1 << page.level;
        patch.origin = glm::ivec2(page.x, page.y) * (kPatchQuads << page.level) - origin_step;
        patch.slot = uint32_t(map_.slot_of(page));
        patch.level = uint32_t(page.level);
        patch.lod_deltas = 0;
        int shift = 0;
        for (const MapPage& neighbour : neighbours(page)) {
            patch.lod_deltas |= uint32_t(std::max(leaf_level(neighbour) - page.level, 0)) << shift;
            shift += 4;
        }
        return patch;
    }

    HeightMap& heights_;
    const VirtualMap& map_;
    const PatchView& view_;
    const Frustum frustum_;
    std::vector<MapPage> leaves_;
    PageSet leaf_set_, kept_whole_;
};

}  // namespace

static_assert(kPatchQuads * kPatchQuadTexels == kHeightPayload);
static_assert(kPatchBorder == kHeightBorder && kPatchTexels == kHeightTexels);

PatchBox patch_box(const HeightMap& heights, const MapPage& page, glm::dvec3 camera_m) {
    const VirtualMap& map = heights.map();
    const HeightPage* data = heights.resident_page(page);
    LOAM_CHECK(data, "only resident pages have a box");
    const WorldRect rect = intersected(map.page_rect(page), map.desc().bounds);
    const glm::dvec3 low = glm::dvec3(rect.min_x, rect.min_y, double(data->min_m)) - camera_m;
    const glm::dvec3 high = glm::dvec3(rect.max_x, rect.max_y, double(data->max_m)) - camera_m;
    // Floats of 24 km have steps of 2 mm; a matrix product adds a few of them.
    const glm::dvec3 beyond = 0.001 + 1e-6 * glm::max(glm::abs(low), glm::abs(high));
    return {low - beyond, high + beyond};
}

PatchSet select_patches(HeightMap& heights, const PatchView& view) {
    Selection selection(heights, view);
    selection.select();
    return selection.result();
}

std::vector<uint32_t> patches_in(const PatchSet& set, const HeightMap& heights,
                                 const glm::dmat4& clip_from_rel) {
    const Frustum frustum(clip_from_rel);
    std::vector<uint32_t> indices;
    for (size_t i = 0; i < set.pages.size(); ++i) {
        const MapPage& page = set.pages[i];
        // A page that was ejected since it was selected is drawn this frame still.
        const bool resident = heights.resident_page(page) != nullptr;
        if (!resident || frustum.meets(patch_box(heights, page, set.camera_m)))
            indices.push_back(uint32_t(i));
    }
    return indices;
}

}  // namespace loam
