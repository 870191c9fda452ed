// Operators, and transitions of the layer list, as text, one JSON object each, for the database. Reading
// gives back the same, numbers bit for bit.
#pragma once

#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/document/operator.h"
#include "runtime/store/project.h"

namespace loam {

[[nodiscard]] std::string operator_json(const Operator& op);  // without its id, which is the row's key
[[nodiscard]] Result<Operator> parse_operator(uint64_t id, std::string_view json);
[[nodiscard]] std::string transition_json(const LayerEntry& entry);  // that has a blend
[[nodiscard]] Result<LayerEntry> parse_transition(std::string_view json);

}  // namespace loam
