// How near an eye is to the ground of each sector: what the sectors' virtual images are sized by.
#pragma once

#include <vector>

#include "runtime/geometry/patch_tree.h"
#include "runtime/texture/sector_set.h"

namespace loam {

// Of all sectors within radius_m, by the boxes of the patches that cover them (so never too far). The set's
// camera is the eye.
[[nodiscard]] std::vector<SectorDistance> sector_distances(const PatchSet& patches, const HeightMap& heights,
                                                           double radius_m);

// Both lists; of a sector in both the smaller distance.
void merge_nearer(std::vector<SectorDistance>& into, const std::vector<SectorDistance>& more);

}  // namespace loam
