// The painting brush: sets the layer of some texels under each dab and blends their tint.
#pragma once

#include "runtime/base/result.h"
#include "runtime/document/command.h"
#include "runtime/document/page_edits.h"
#include "runtime/document/slope.h"

namespace loam {

// `layer`: the index of command.layer, where it is given.
Status paint(const PaintCommand& command, uint16_t layer, SlopeReader& slopes, PageEdits<IndexTexel>& edits);

}  // namespace loam
