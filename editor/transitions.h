// Transitions made, changed and removed in the layer list (project.h: LayerEntry::Blend).
#pragma once

#include <string>

#include "runtime/base/result.h"
#include "runtime/store/project.h"

namespace loam {

struct TransitionRequest {
    std::string name;
    std::string from, to;  // of an existing one: empty leaves them
    std::optional<double> threshold;
};
// Changes the transition of this name, or makes it; a new one takes the place of a removed one when there is one.
Status put_transition(ProjectSettings& settings, const TransitionRequest& request);
// The texels that hold it show the side it was nearer to, from now on and after more layers have been added.
Status remove_transition(ProjectSettings& settings, const std::string& name);

}  // namespace loam
