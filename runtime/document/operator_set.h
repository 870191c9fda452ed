// The document's operators: by id, and by place for each map.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "runtime/document/operator.h"
#include "runtime/document/operator_index.h"

namespace loam {

class OperatorSet {
  public:
    void set(const Operator& op);  // adds or replaces
    void remove(uint64_t id);      // unknown: fine
    [[nodiscard]] const Operator* find(uint64_t id) const;
    [[nodiscard]] size_t size() const { return by_id_.size(); }
    [[nodiscard]] std::vector<Operator> sorted() const;  // ascending (order, id)

    [[nodiscard]] const OperatorIndex& over_height() const { return height_; }
    [[nodiscard]] const OperatorIndex& over_index() const { return index_; }
    [[nodiscard]] const OperatorIndex& over_texture() const { return texture_; }
    [[nodiscard]] const OperatorIndex& over_cutout() const { return cutout_; }

  private:
    std::unordered_map<uint64_t, std::unique_ptr<Operator>>
        by_id_;  // pointers stay valid while the map grows
    OperatorIndex height_, index_, texture_, cutout_;
};

}  // namespace loam
