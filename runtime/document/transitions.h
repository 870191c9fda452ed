// Transitions of the layer list, made, changed and removed; and placed where two layers meet. Source: Call of
// Duty talk, "Content Work-Around" (transition materials that artists set by hand between two layers) and
// "Multi-Layered Terrain Materials".
//
// What is placed follows from the map without its transitions alone, so that doing it twice, or in another
// order, changes nothing:
//  1. every transition texel counts as the layer it is from;
//  2. a texel of `from` that touches `to` (eight neighbours) and nothing but these two wants the transition;
//  3. it takes it unless a neighbour wants another one.
// So a square of four texels that holds a transition shows its two layers only: a third one, hidden in the
// transition, cannot come up beside a layer that it has nothing to do with.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/document/command.h"
#include "runtime/document/page_edits.h"
#include "runtime/store/project.h"

namespace loam {

struct Transition {
    uint16_t layer = 0, from = 0, to = 0;
    bool placed = true;  // false: removed, only read as `from`
};

// Changes the transition of this name, or makes it; a new one takes the place of a removed one when there is
// one. Gives its place in the layer list.
[[nodiscard]] Result<size_t> put_transition(ProjectSettings& settings, const TransitionCommand& command);
// The texels that hold it show the side it was nearer to, from now on and after more layers have been added.
[[nodiscard]] Result<size_t> remove_transition(ProjectSettings& settings, const std::string& name);
// Of what was removed there: no other place's, whatever is undone and done again.
[[nodiscard]] std::string name_of_removed(const ProjectSettings& settings, size_t place);

// Of two transitions between the same layers the first one is placed.
[[nodiscard]] std::vector<Transition> transitions_of(const ProjectSettings& settings);

// After texels in `changed` have changed: what is placed there and around it.
Status place_transitions(const std::vector<Transition>& transitions, const TexelRect& changed,
                         PageEdits<IndexTexel>& edits);

}  // namespace loam
