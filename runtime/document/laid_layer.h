// The layer of the index map that an operator lays, by name, and where its number is kept.
#pragma once

#include <string>

#include "runtime/document/operator.h"

namespace loam {

struct LaidLayer {
    std::string* name = nullptr;  // null: lays none; empty: none was chosen
    uint16_t* number = nullptr;   // the document sets it

    [[nodiscard]] bool chosen() const { return name && !name->empty(); }
};

[[nodiscard]] inline LaidLayer laid_layer(OperatorShape& shape) {
    if (auto* stamp = std::get_if<Stamp>(&shape)) return {&stamp->layer, &stamp->layer_number};
    if (auto* flood = std::get_if<Flood>(&shape)) return {&flood->layer, &flood->layer_number};
    if (auto* event = std::get_if<Event>(&shape)) return {&event->layer, &event->layer_number};
    return {};
}

}  // namespace loam
