// A folder of maps becomes a layer of a project.
#pragma once

#include <filesystem>
#include <memory>
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

// In three steps, so that the longest needs neither the document nor its thread. What was written is removed
// again unless it was adopted.
class LayerImport {
  public:
    static Result<std::unique_ptr<LayerImport>> plan(const Document& document,
                                                     const AddLayerRequest& request);
    ~LayerImport();

    Status make(const Progress& progress);  // on any thread
    // Into project.toml, behind the layers that are there now. Refuses a name that was taken since.
    Result<AddedLayer> adopt(Document& document);
    [[nodiscard]] const std::string& name() const { return added_.entry.name; }

  private:
    LayerImport() = default;

    AddLayerRequest request_;
    std::filesystem::path file_;
    AddedLayer added_;
    bool adopted_ = false;
};

// Writes layers/NAME.layer and NAME.json, then appends the layer to project.toml, whole or not at all: the
// layers that are there keep their indices.
[[nodiscard]] Result<AddedLayer> add_layer(Document& document, const AddLayerRequest& request,
                                           const Progress& progress);

}  // namespace loam
