// Any picture becomes a stamp of a project.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "editor/recipe/progress.h"
#include "runtime/base/result.h"

namespace loam {

struct AddedStamp {
    std::string name;
    int width = 0, height = 0;
    bool has_colors = false;         // its colours differ from grey
    bool has_cover = false;          // an alpha channel that is not 1 everywhere
    double black = 0, white = 1;     // what black and white stand for in the file's own numbers
    std::vector<std::string> notes;  // what was mended or made smaller
};

// Writes stamps/NAME.stamp in the project's folder; refuses a name that is taken. Heights are the picture's
// brightness (Rec. 709), of the file's numbers as they are: integers over their whole range, floats from the
// least to the greatest. Larger than 4096 texels a side: halved until it fits.
[[nodiscard]] Result<AddedStamp> add_stamp(const std::filesystem::path& project,
                                           const std::filesystem::path& file,
                                           const std::string& name,  // empty: the file's
                                           const Progress& progress = {});

}  // namespace loam
