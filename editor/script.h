// Scripts: one command a line, as the window records them. Blank lines and lines that begin with # or // are
// skipped.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/document/command.h"

namespace loam {

// Calls `run` with every command in order; stops at the first line that cannot be read, parsed or run, and
// says "FILE:LINE: …". Lines are parsed one by one, so what came before a bad line has been run.
Status run_script(const std::filesystem::path& file, const std::function<Status(const Command&)>& run);

}  // namespace loam
