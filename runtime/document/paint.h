// Painting: sets the layer of some texels under each dab, or of a rectangle, and blends their tint.
#pragma once

#include "runtime/base/result.h"
#include "runtime/document/command.h"
#include "runtime/document/page_edits.h"
#include "runtime/document/slope.h"
#include "runtime/document/transitions.h"

namespace loam {

// A command's names as indices.
struct PaintLayers {
    std::optional<uint16_t> layer, replace;
    std::vector<Transition> transitions;  // placed where layers meet, if any
};

Status paint(const PaintCommand& command, const PaintLayers& layers, SlopeReader& ground,
             PageEdits<IndexTexel>& edits);
// The texels that a fill looks at.
[[nodiscard]] TexelRect fill_texels(const FillCommand& command, const MapShape& shape);
Status fill(const FillCommand& command, const PaintLayers& layers, SlopeReader& ground,
            PageEdits<IndexTexel>& edits);

}  // namespace loam
