// The patch quad tree: which pages of the height map are drawn, at which level, with which neighbours.
// A node is split when the camera is near, all its children are resident, and the split keeps the level
// difference between neighbours at most log2(kPatchQuads); what is not resident is requested. Any state of the cache draws
// one cover of the map, without overlap or gap. Sources: Far Cry 5 talk, "Terrain Quad Tree", "LOD
// Transitions", "LOD Mesh Stitching".
#pragma once

#include <span>
#include <vector>

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "runtime/maps/cutout_map.h"
#include "runtime/maps/height_map.h"
#include "shaders/geometry/geometry_io.h"

namespace loam {

struct PatchView {
    glm::dvec3 camera_m{0};
    glm::dmat4 clip_from_rel{1};  // camera-relative world to clip, reversed Z
    double split_distance = 1.5;  // a node of side s is split when nearer than split_distance * s
    double hidden_share = 1.0;   // of split_distance for nodes outside the frustum
    // min_level: do not go finer than this. max_level: do not stay coarser than this where pages allow; 0: no
    // such limit.
    int max_level = 0, min_level = 0;
    const CutoutMap* cutouts = nullptr;  // null: all ground is there
};

struct PatchSet {
    std::vector<shared::PatchInstance>
        patches;  // leaves of which there is any ground; the first `visible_count` are inside the frustum
    int visible_count = 0;
    int visible_cut = 0, hidden_cut = 0;  // with holes: the last so many inside, and outside, the frustum
    const CutoutMap* cutouts = nullptr;   // of the view
    glm::ivec2 origin_step{0};     // the view's origin step
    glm::dvec2 origin_rel_m{0};    // its camera-relative place
    glm::dvec2 map_edge_rel_m{0};  // the map's north-east corner
    double step_m = 0;             // of the finest patch grid (4 height samples of level 0)
    uint64_t cut_hash = 0;         // changes when the set of leaves or of those with holes changes
    [[nodiscard]] bool has_holes(uint32_t patch) const {
        const auto n = int(patch);
        return n < visible_count ? n >= visible_count - visible_cut : n >= int(patches.size()) - hidden_cut;
    }
    std::vector<MapPage> pages;    // of the patches, in their order
    glm::dvec3 camera_m{0};        // of the view
};

// Requests pages (visible and near first) and selects the cut from what is resident.
[[nodiscard]] PatchSet select_patches(HeightMap& heights, const PatchView& view);

// Indices of the patches that may be seen through another view with the same camera position, for instance a
// shadow cascade: nothing is culled by depth unless the projection is a perspective (then what is behind the
// near plane).
[[nodiscard]] std::vector<uint32_t> patches_in(const PatchSet& set, const HeightMap& heights,
                                               const glm::dmat4& clip_from_rel);

// A page's box, camera-relative, from its heights; grown by what float arithmetic may add.
struct PatchBox {
    glm::dvec3 low_m, high_m;
};
[[nodiscard]] PatchBox patch_box(const HeightMap& heights, const MapPage& page, glm::dvec3 camera_m);

}  // namespace loam
