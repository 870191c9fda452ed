// The sculpting brushes: raise, lower, smooth, flatten. Dabs act one after another, each on what the one
// before left.
#pragma once

#include "runtime/base/result.h"
#include "runtime/document/command.h"
#include "runtime/document/page_edits.h"

namespace loam {

Status sculpt(const SculptCommand& command, PageEdits<int32_t>& edits);

}  // namespace loam
