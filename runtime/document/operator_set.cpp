#include "runtime/document/operator_set.h"

#include <algorithm>

namespace loam {

void OperatorSet::set(const Operator& op) {
    remove(op.id);
    auto owned = std::make_unique<Operator>(op);
    for (const WorldRect& rect : op.height_rects()) height_.add(owned.get(), rect);
    index_.add(owned.get(), op.index_bounds());
    for (const WorldRect& rect : op.texture_rects()) texture_.add(owned.get(), rect);
    for (const WorldRect& rect : op.cutout_rects()) cutout_.add(owned.get(), rect);
    by_id_.emplace(op.id, std::move(owned));
}

void OperatorSet::remove(uint64_t id) {
    const auto found = by_id_.find(id);
    if (found == by_id_.end()) return;
    const Operator* op = found->second.get();
    for (const WorldRect& rect : op->height_rects()) height_.remove(op, rect);
    index_.remove(op, op->index_bounds());
    for (const WorldRect& rect : op->texture_rects()) texture_.remove(op, rect);
    for (const WorldRect& rect : op->cutout_rects()) cutout_.remove(op, rect);
    by_id_.erase(found);
}

const Operator* OperatorSet::find(uint64_t id) const {
    const auto found = by_id_.find(id);
    return found == by_id_.end() ? nullptr : found->second.get();
}

std::vector<Operator> OperatorSet::sorted() const {
    std::vector<Operator> all;
    all.reserve(by_id_.size());
    for (const auto& [id, op] : by_id_) all.push_back(*op);
    std::sort(all.begin(), all.end(), [](const Operator& a, const Operator& b) {
        return a.order != b.order ? a.order < b.order : a.id < b.id;
    });
    return all;
}

}  // namespace loam
