// Satellite or ortho imagery over the whole map, made of any picture (runtime/document/imagery.h).
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
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

// In three steps, as LayerImport.
class ImageryImport {
  public:
    static Result<std::unique_ptr<ImageryImport>> plan(const Document& document,
                                                       const AddImageryRequest& request);
    ~ImageryImport();

    Status make(const Progress& progress);  // on any thread
    // Into project.toml; what its strength and distance are by now stays where the request names none.
    Result<AddedImagery> adopt(Document& document);

  private:
    ImageryImport() = default;

    AddImageryRequest request_;
    std::filesystem::path file_;
    ProjectSettings settings_;  // when it was planned
    AddedImagery added_;
    bool adopted_ = false;
};

// Writes imagery/NAME.imagery row by row and names it in project.toml, whole or not at all. The file of
// imagery that was there before stays in the project's folder.
[[nodiscard]] Result<AddedImagery> add_imagery(Document& document, const AddImageryRequest& request,
                                               const Progress& progress);

}  // namespace loam
