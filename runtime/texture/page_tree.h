// The quad tree of one virtual image: which pages the GPU may use, and what each square of its page grid
// therefore shows at each mip. A node holds the indirection texel of its page or nothing; a square shows its
// own page or else the nearest above it. What changed since the last `take_fills` comes out as squares of
// texels, disjoint by construction, so that a compute shader may write them in any order. Source: Call of
// Duty talk, "Virtual Image Quad Tree", "Indirection Texture".
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>

#include "shaders/texture/texture_io.h"

namespace loam {

class PageTree {
  public:
    explicit PageTree(int log2_width);

    [[nodiscard]] int log2_width() const { return log2_width_; }
    // kNoPage takes the page out. Nodes of any depth may come and go in any order: holes show the nearest
    // ancestor.
    void set(int depth, int x, int y, uint32_t texel);
    [[nodiscard]] uint32_t at(int depth, int x, int y) const { return node(depth, x, y).texel; }
    // What a square shows, itself or the nearest above it; kNoPage when there is nothing.
    [[nodiscard]] uint32_t shown(int depth, int x, int y) const;
    [[nodiscard]] int page_count() const { return page_count_; }

    // Everything counts as changed: the image got a new place in the indirection texture.
    void touch_all();
    // Appends the squares to write in an indirection texture of `size` texels a side (texture_io.h), in which
    // the image's mip 0 begins at `origin`, a multiple of its width.
    void take_fills(glm::ivec2 origin, int size, std::vector<shared::IndirectionFill>& out);
    [[nodiscard]] bool changed() const { return nodes_[0].changed || nodes_[0].below_changed; }

  private:
    struct Node {
        uint32_t texel = kNoPage;
        uint32_t below = 0;          // pages in the subtree without the node itself
        bool changed = false;        // the node's own texel
        bool below_changed = false;  // something in the subtree
    };
    [[nodiscard]] size_t index(int depth, int x, int y) const {
        // Levels before it hold (4^depth - 1) / 3 nodes.
        return ((size_t(1) << (2 * depth)) - 1) / 3 + (size_t(y) << depth) + size_t(x);
    }
    [[nodiscard]] Node& node(int depth, int x, int y) { return nodes_[index(depth, x, y)]; }
    [[nodiscard]] const Node& node(int depth, int x, int y) const { return nodes_[index(depth, x, y)]; }
    struct Target {
        glm::ivec2 origin;
        int size;
        std::vector<shared::IndirectionFill>* out;  // null: only flags are cleared
    };
    void visit(int depth, int x, int y, uint32_t inherited, bool inherited_changed, const Target& target);
    // The squares of `levels` mips of a node, from its own on.
    void write(int depth, int x, int y, int levels, uint32_t texel, const Target& target) const;

    int log2_width_;
    int page_count_ = 0;
    std::vector<Node> nodes_;
};

}  // namespace loam
