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

Status check_name(const ProjectSettings& settings, const std::string& name) {
    for (const LayerEntry& layer : settings.layers)
        if (layer.name == name) return error("the project has a layer \"{}\": choose another name", name);
    return {};
}

ProjectSettings with_layer(const Document& document, const LayerEntry& entry) {
    ProjectSettings settings = document.settings();
    settings.layers.push_back(entry);
    return settings;
}

}  // namespace

Result<std::unique_ptr<LayerImport>> LayerImport::plan(const Document& document,
                                                       const AddLayerRequest& request) {
    std::unique_ptr<LayerImport> import(new LayerImport);
    import->request_ = request;
    LayerEntry& entry = import->added_.entry;
    entry.name = name_of(request);
    entry.tile_m = request.tile_m;
    LOAM_TRY(check_name(document.settings(), entry.name));
    import->file_ = free_file(document.folder() / "layers", entry.name, {".layer", ".json"});
    entry.file = (fs::path("layers") / import->file_.filename()).string();
    LOAM_TRY(check_settings(with_layer(document, entry)));
    LOAM_TRY(document.check_writable());
    return import;
}

LayerImport::~LayerImport() {
    std::error_code code;
    if (adopted_ || file_.empty()) return;
    fs::remove(file_, code);
    fs::remove(report_file_of(file_), code);
}

Status LayerImport::make(const Progress& progress) {
    auto packed = pack_folder(request_.pack, part_of(progress, 0, 0.4));
    if (!packed) return packed.error();
    LOAM_TRY(step_progress(progress, 0.4, "measuring formats"));
    const FormatTable table = measure_formats(packed->planes);
    added_.report = pack_report(added_.entry.name, *packed, table);
    LOAM_TRY(step_progress(progress, 0.8, "writing the layer"));
    std::error_code code;
    fs::create_directories(file_.parent_path(), code);
    if (code) return error("cannot make the folder {}: {}", file_.parent_path().string(), code.message());
    LOAM_TRY(save_layer(file_, textures_of(packed->planes)));
    LOAM_TRY(save_pack_report(report_file_of(file_), added_.report));
    return step_progress(progress, 0.95, "adding the layer");
}

Result<AddedLayer> LayerImport::adopt(Document& document) {
    LOAM_TRY(check_name(document.settings(), added_.entry.name));
    added_.index = static_cast<int>(document.settings().layers.size());
    LOAM_TRY(document.change_settings(with_layer(document, added_.entry)));
    adopted_ = true;
    return added_;
}

Result<AddedLayer> add_layer(Document& document, const AddLayerRequest& request, const Progress& progress) {
    auto import = LayerImport::plan(document, request);
    if (!import) return import.error();
    LOAM_TRY((*import)->make(progress));
    return (*import)->adopt(document);
}

}  // namespace loam
