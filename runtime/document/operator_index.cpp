#include "runtime/document/operator_index.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"

namespace loam {

namespace {

int level_of(const WorldRect& bounds) {
    int exponent = 0;
    std::frexp(std::max({bounds.width(), bounds.height(), 1e-3}), &exponent);  // size < 2^exponent
    return exponent;
}

double side_of(int level) {
    return std::ldexp(1.0, level);
}

int32_t cell_of(double position_m, double side_m) {
    return int32_t(std::clamp(std::floor(position_m / side_m), -2.0e9, 2.0e9));
}

uint64_t key_of(int32_t x, int32_t y) {
    return uint64_t(uint32_t(y)) << 32 | uint32_t(x);
}

}  // namespace

void OperatorIndex::add(const Operator* op, const WorldRect& bounds) {
    if (bounds.empty()) return;
    const int level = level_of(bounds);
    const double side = side_of(level);
    levels_[level].cells[key_of(cell_of(bounds.min_x, side), cell_of(bounds.min_y, side))].push_back(
        {op, bounds});
}

void OperatorIndex::remove(const Operator* op, const WorldRect& bounds) {
    if (bounds.empty()) return;
    const int level = level_of(bounds);
    const double side = side_of(level);
    auto& cells = levels_[level].cells;
    const auto cell = cells.find(key_of(cell_of(bounds.min_x, side), cell_of(bounds.min_y, side)));
    LOAM_CHECK(cell != cells.end(), "an operator was removed from where it is not");
    const auto entry = std::find_if(cell->second.begin(), cell->second.end(),
                                    [&](const Entry& e) { return e.op == op && e.bounds == bounds; });
    LOAM_CHECK(entry != cell->second.end(), "an operator was removed with bounds it was not added with");
    cell->second.erase(entry);
    if (cell->second.empty()) cells.erase(cell);
    if (cells.empty()) levels_.erase(level);
}

void OperatorIndex::query(const WorldRect& rect, std::vector<const Operator*>& out, double texel_m) const {
    out.clear();
    if (rect.empty()) return;
    const auto visit = [&](const std::vector<Entry>& cell) {
        for (const Entry& entry : cell)
            if (entry.op->enabled && entry.bounds.overlaps(rect)) out.push_back(entry.op);
    };
    for (const auto& [exponent, level] : levels_) {
        const double side = side_of(exponent);
        // A volume on its side is drawn up to 1.5 times as wide as its bounds; half a texel is too little to
        // show.
        if (4 * side <= texel_m) continue;
        const int64_t x0 = int64_t(cell_of(rect.min_x, side)) - 1, x1 = cell_of(rect.max_x, side);
        const int64_t y0 = int64_t(cell_of(rect.min_y, side)) - 1, y1 = cell_of(rect.max_y, side);
        // A rectangle of more cells than there are: look at those there are.
        if (double(x1 - x0 + 1) * double(y1 - y0 + 1) > double(level.cells.size())) {
            for (const auto& [key, cell] : level.cells) visit(cell);
            continue;
        }
        for (int64_t y = y0; y <= y1; ++y)
            for (int64_t x = x0; x <= x1; ++x)
                if (const auto cell = level.cells.find(key_of(int32_t(x), int32_t(y)));
                    cell != level.cells.end())
                    visit(cell->second);
    }
    std::sort(out.begin(), out.end(),
              [](const Operator* a, const Operator* b) { return evaluated_before(*a, *b); });
    out.erase(std::unique(out.begin(), out.end()), out.end());
}

}  // namespace loam
