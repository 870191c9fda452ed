#include "runtime/texture/page_tree.h"

namespace loam {

PageTree::PageTree(int log2_width)
    : log2_width_(log2_width), nodes_(((size_t(1) << (2 * (log2_width + 1))) - 1) / 3) {}

void PageTree::set(int depth, int x, int y, uint32_t texel) {
    Node& target = node(depth, x, y);
    if (target.texel == texel) return;
    const int more = int(texel != kNoPage) - int(target.texel != kNoPage);
    target.texel = texel;
    target.changed = true;
    page_count_ += more;
    for (int d = depth - 1; d >= 0; --d) {
        x >>= 1;
        y >>= 1;
        Node& above = node(d, x, y);
        above.below += uint32_t(more);
        above.below_changed = true;
    }
}

uint32_t PageTree::shown(int depth, int x, int y) const {
    for (; depth >= 0; --depth, x >>= 1, y >>= 1)
        if (const uint32_t texel = at(depth, x, y); texel != kNoPage) return texel;
    return kNoPage;
}

void PageTree::touch_all() {
    for (Node& n : nodes_) n.changed = n.below_changed = true;
    const size_t finest = index(log2_width_, 0, 0);
    for (size_t i = finest; i < nodes_.size(); ++i) nodes_[i].below_changed = false;  // nothing is below
}

void PageTree::take_fills(glm::ivec2 origin, int size, std::vector<shared::IndirectionFill>& out) {
    if (changed()) visit(0, 0, 0, kNoPage, false, {origin, size, &out});
}

void PageTree::write(int depth, int x, int y, int levels, uint32_t texel, const Target& target) const {
    if (!target.out) return;
    for (int finer = 0; finer < levels; ++finer) {
        const int level = log2_width_ - depth - finer, side = 1 << finer;
        const glm::ivec2 at =
            shared::vt_level_origin(level, target.size) + (target.origin >> level) + glm::ivec2(x, y) * side;
        target.out->push_back({at.x, at.y, side, texel});
    }
}

// A square is written when what it shows may have changed: with all mips under it where nothing finer is
// there, alone where its quarters have to be looked at.
void PageTree::visit(int depth, int x, int y, uint32_t inherited, bool inherited_changed,
                     const Target& target) {
    Node& here = node(depth, x, y);
    const bool changed = here.changed || (inherited_changed && here.texel == kNoPage);
    const bool below_changed = here.below_changed;
    const uint32_t shown = here.texel != kNoPage ? here.texel : inherited;
    here.changed = here.below_changed = false;
    if (!changed && !below_changed) return;
    const auto quarters = [&](const Target& to) {
        for (int i = 0; i < 4; ++i) visit(depth + 1, x * 2 + (i & 1), y * 2 + (i >> 1), shown, changed, to);
    };
    if (here.below == 0) {
        write(depth, x, y, log2_width_ - depth + 1, shown, target);
        // Pages below went away: the flags of their nodes are left to clear.
        if (below_changed) quarters({target.origin, target.size, nullptr});
        return;
    }
    if (changed) write(depth, x, y, 1, shown, target);
    quarters(target);
}

}  // namespace loam
