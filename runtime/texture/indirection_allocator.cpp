#include "runtime/texture/indirection_allocator.h"

#include "runtime/base/check.h"

namespace loam {

IndirectionAllocator::IndirectionAllocator(int log2_size)
    : free_(size_t(log2_size) + 1), free_texels_(int64_t(1) << (2 * log2_size)) {
    free_.back().insert({0, 0});
}

std::optional<glm::ivec2> IndirectionAllocator::allocate(int log2_side) {
    size_t order = size_t(log2_side);
    while (order < free_.size() && free_[order].empty()) ++order;
    if (order >= free_.size()) return std::nullopt;
    const Origin origin = *free_[order].begin();
    free_[order].erase(free_[order].begin());
    while (order > size_t(log2_side)) {
        --order;
        const int half = 1 << order;
        free_[order].insert({origin.first, origin.second + half});
        free_[order].insert({origin.first + half, origin.second});
        free_[order].insert({origin.first + half, origin.second + half});
    }
    free_texels_ -= int64_t(1) << (2 * log2_side);
    return glm::ivec2(origin.second, origin.first);
}

void IndirectionAllocator::release(glm::ivec2 origin, int log2_side) {
    free_texels_ += int64_t(1) << (2 * log2_side);
    size_t order = size_t(log2_side);
    Origin square{origin.y, origin.x};
    for (; order + 1 < free_.size(); ++order) {
        const int side = 1 << order;
        const Origin parent{square.first & ~side, square.second & ~side};
        std::vector<Origin> siblings;
        for (int i = 0; i < 4; ++i) {
            const Origin sibling{parent.first + (i >> 1) * side, parent.second + (i & 1) * side};
            if (sibling != square && free_[order].contains(sibling)) siblings.push_back(sibling);
        }
        if (siblings.size() < 3) break;
        for (const Origin& sibling : siblings) free_[order].erase(sibling);
        square = parent;
    }
    const bool fresh = free_[order].insert(square).second;
    LOAM_CHECK(fresh, "a square of the indirection texture was released twice");
}

}  // namespace loam
