// The painting brush: sets the layer of some texels under each dab and blends their tint.
#pragma once

#include "runtime/base/result.h"
#include "runtime/document/command.h"
#include "runtime/document/page_edits.h"
#include "runtime/document/slope.h"
#include "runtime/document/transitions.h"

namespace loam {

// `layer`: the index of command.layer, where it is given. `transitions`: what is placed where layers meet, if any.
Status paint(const PaintCommand& command, uint16_t layer, const std::vector<Transition>& transitions,
             SlopeReader& slopes, PageEdits<IndexTexel>& edits);

}  // namespace loam
