// Operators as text, one JSON object each, for the database. Reading gives back the same operator, numbers
// bit for bit.
#pragma once

#include <string>
#include <string_view>

#include "runtime/base/result.h"
#include "runtime/document/operator.h"

namespace loam {

[[nodiscard]] std::string operator_json(const Operator& op);  // without its id, which is the row's key
[[nodiscard]] Result<Operator> parse_operator(uint64_t id, std::string_view json);

}  // namespace loam
