// Progress of long verbs: a bar that is drawn over itself on a terminal, a line every ten percent elsewhere.
// Ctrl-C cancels: the work stops at its next step and cleans up.
#pragma once

#include <string>

#include "editor/recipe/progress.h"

namespace loam::cli {

class ProgressLine {
  public:
    ProgressLine();  // from now on Ctrl-C and SIGTERM cancel rather than kill
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;

    [[nodiscard]] Progress callback();  // valid as long as this object

  private:
    Going show(double share, std::string_view what);
    bool is_terminal_ = false;
    int shown_percent_ = -1;
    std::string shown_what_;
};

}  // namespace loam::cli
