// A folder of maps becomes a layer of a project.
#pragma once

#include <string>

#include "editor/packer/pack_report.h"
#include "runtime/document/document.h"

namespace loam {

struct AddLayerRequest {
    PackRequest pack;
    std::string name;   // empty: the folder's
    double tile_m = 2;  // world size of one repeat
};

struct AddedLayer {
    LayerEntry entry;
    int index = 0;  // what the index map holds for it
    PackJson report;
};

// Writes layers/NAME.layer and NAME.json, then appends the layer to project.toml, whole or not at all: the
// layers that are there keep their indices.
[[nodiscard]] Result<AddedLayer> add_layer(Document& document, const AddLayerRequest& request,
                                           const Progress& progress);

}  // namespace loam
