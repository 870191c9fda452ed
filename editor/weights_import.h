// Painted weights of layers (alpha masks, splat maps) made the map's index and colour. Source: Call of Duty
// talk, "Layer Masks" and "One Material Per Vertex": a mask a layer against one index a vertex.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "editor/recipe/progress.h"
#include "runtime/base/result.h"
#include "runtime/document/document.h"

namespace loam {

struct WeightsRequest {
    // Pictures named after layers: grass.png, or for the channels of one, in order, grass+rock+dirt.png. Any
    // size; their corners are the map's, their top is north.
    std::filesystem::path folder;
    bool tint = true;         // darkens the chosen layer towards the colour of the blend
    bool transitions = true;  // of the project count as what they show on the average
};

struct WeightsReport {
    struct Share {
        std::string layer;
        double weight = 0, texels = 0;  // of the whole: painted, and as indices
    };
    std::vector<Share> shares;
    int64_t texels = 0;
    double kept = 0;        // mean over texels of the weight that what was chosen shows
    double unweighted = 0;  // share of texels without any weight: the default layer
    double color_rms = 0,
           color_rms_plain = 0;  // of 255, encoded: mean colours against the blend's; without tint
    std::vector<std::string> notes;
};

// Replaces the whole index map; refused when the project has a history, as it could not be undone.
[[nodiscard]] Result<WeightsReport> import_weights(Document& document, const WeightsRequest& request,
                                                   const Progress& progress);

}  // namespace loam
