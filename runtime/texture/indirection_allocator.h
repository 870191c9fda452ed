// Squares with power-of-two sides out of the indirection texture: a buddy allocator in two dimensions. A free
// square is split in four; four free quarters are joined again at once, so that after any traffic an empty
// texture is one square.
#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <glm/vec2.hpp>

namespace loam {

class IndirectionAllocator {
  public:
    explicit IndirectionAllocator(int log2_size);

    // South-west texel of a square of side 2^log2_side, aligned to its side. None: full, or too cut up.
    [[nodiscard]] std::optional<glm::ivec2> allocate(int log2_side);
    void release(glm::ivec2 origin, int log2_side);  // exactly what was allocated
    [[nodiscard]] int64_t free_texels() const { return free_texels_; }

  private:
    using Origin = std::pair<int, int>;   // y, x: lowest rows first
    std::vector<std::set<Origin>> free_;  // by log2 of the side
    int64_t free_texels_;
};

}  // namespace loam
