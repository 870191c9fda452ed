#include "editor/layer_import.h"

#include <algorithm>
#include <cmath>

#include "editor/project_folder.h"

namespace loam {

namespace fs = std::filesystem;

namespace {

std::string name_of(const AddLayerRequest& request) {
    if (!request.name.empty()) return request.name;
    std::error_code code;
    const fs::path whole = fs::absolute(request.pack.folder, code).lexically_normal();
    return (whole.has_filename() ? whole : whole.parent_path()).filename().string();
}

// Removes what was written unless it is kept.
class NewFiles {
  public:
    explicit NewFiles(fs::path layer) : layer_(std::move(layer)) {}
    NewFiles(const NewFiles&) = delete;
    NewFiles& operator=(const NewFiles&) = delete;
    ~NewFiles() {
        std::error_code code;
        if (kept_) return;
        fs::remove(layer_, code);
        fs::remove(report_file_of(layer_), code);
    }
    void keep() { kept_ = true; }

  private:
    fs::path layer_;
    bool kept_ = false;
};

}  // namespace

Result<AddedLayer> add_layer(Document& document, const AddLayerRequest& request, const Progress& progress) {
    AddedLayer added;
    ProjectSettings settings = document.settings();
    const fs::path layers = document.folder() / "layers";
    added.index = static_cast<int>(settings.layers.size());
    added.entry.name = name_of(request);
    added.entry.tile_m = request.tile_m;
    for (const LayerEntry& layer : settings.layers)
        if (layer.name == added.entry.name)
            return error("the project has a layer \"{}\": choose another name", layer.name);
    const fs::path file = free_file(layers, added.entry.name, {".layer", ".json"});
    added.entry.file = (fs::path("layers") / file.filename()).string();
    settings.layers.push_back(added.entry);
    LOAM_TRY(check_settings(settings));
    LOAM_TRY(document.check_writable());

    auto packed = pack_folder(request.pack, part_of(progress, 0, 0.4));
    if (!packed) return packed.error();
    LOAM_TRY(step_progress(progress, 0.4, "measuring formats"));
    const FormatTable table = measure_formats(packed->planes);
    added.report = pack_report(added.entry.name, *packed, table);
    LOAM_TRY(step_progress(progress, 0.8, "writing the layer"));
    std::error_code code;
    fs::create_directories(layers, code);
    if (code) return error("cannot make the folder {}: {}", layers.string(), code.message());
    NewFiles files(file);
    LOAM_TRY(save_layer(file, textures_of(packed->planes)));
    LOAM_TRY(save_pack_report(report_file_of(file), added.report));
    LOAM_TRY(step_progress(progress, 0.95, "adding the layer"));
    LOAM_TRY(document.change_settings(settings));
    files.keep();
    return added;
}

}  // namespace loam
