// Operators by place: a hash grid for every power of two of size, an operator in the one cell that holds the
// south-west corner of its bounds. A query looks at the cells it overlaps and one more to the west and south,
// of sizes that are in use, so that what lies elsewhere costs nothing, whatever its number.
#pragma once

#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

#include "runtime/base/rect.h"
#include "runtime/document/operator.h"

namespace loam {

class OperatorIndex {
  public:
    // Empty bounds: not indexed. An operator may have several. It must outlive its entries, and each be
    // removed with the bounds it was added with.
    void add(const Operator* op, const WorldRect& bounds);
    void remove(const Operator* op, const WorldRect& bounds);
    // Appends nothing twice; ascending (order, id, part); enabled operators only. Clears `out` first.
    // texel_m: of what is drawn, all that texels of this size show is there; what they do not show may be
    // left out.
    void query(const WorldRect& rect, std::vector<const Operator*>& out, double texel_m = 0) const;

  private:
    struct Entry {
        const Operator* op;
        WorldRect bounds;
    };
    struct Level {
        std::unordered_map<uint64_t, std::vector<Entry>> cells;
    };
    std::map<int, Level> levels_;  // by log2 of the cell's side in metres
};

}  // namespace loam
