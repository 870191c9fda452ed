// Satellite or ortho imagery over the whole map, made of any picture (runtime/document/imagery.h).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "editor/recipe/progress.h"
#include "runtime/base/result.h"
#include "runtime/document/document.h"
#include "runtime/store/imagery_file.h"

namespace loam {

struct AddImageryRequest {
    std::filesystem::path file;  // its corners are the map's, its top is north; an alpha channel is its cover
    std::optional<double> strength, distance_m;  // none: as they are
};

struct AddedImagery {
    ImagerySettings settings;
    int width = 0, height = 0;  // of the picture
    ImageryShape shape;
    uint64_t size_bytes = 0;  // of the file in the project
    std::vector<std::string> notes;
};

// Writes imagery/NAME.imagery row by row and names it in project.toml, whole or not at all. The file of
// imagery that was there before stays in the project's folder.
[[nodiscard]] Result<AddedImagery> add_imagery(Document& document, const AddImageryRequest& request,
                                               const Progress& progress);

}  // namespace loam
