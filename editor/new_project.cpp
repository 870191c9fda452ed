#include "editor/new_project.h"

#include "editor/project_folder.h"
#include "runtime/store/project.h"

namespace loam {

Status create_project(const NewProjectRequest& request, const Progress& progress) {
    // The folder first: a place that cannot be written is said before a minute of erosion.
    auto folder = NewFolder::create(request.project);
    if (!folder) return folder.error();
    LOAM_TRY(make_project(folder->path(), request.recipe, progress, request.layer_size_texels));
    // The recipe named the project after the temporary folder.
    auto settings = load_project(folder->path());
    if (!settings) return settings.error();
    settings->name = folder->name();
    LOAM_TRY(save_project(folder->path(), *settings));
    return folder->keep();
}

}  // namespace loam
