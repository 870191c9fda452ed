#include "editor/fill.h"

#include <algorithm>

#include "editor/session.h"
#include "runtime/document/document.h"

namespace loam {

Fill::Fill(Session& session, FillCommand command)
    : session_(session), command_(std::move(command)), group_(session.document().next_group()) {
    const Document& document = session.document();
    texels_ = document.fill_texels(command_);
    spacing_m_ = document.settings().index_spacing_m;
    if (texels_.empty()) return;
    squares_x_ = (texels_.width() + kSquareTexels - 1) / kSquareTexels;
    squares_y_ = (texels_.height() + kSquareTexels - 1) / kSquareTexels;
}

Result<Dirt> Fill::step() {
    const int x0 = texels_.x0 + next_ % squares_x_ * kSquareTexels,
              y0 = texels_.y0 + next_ / squares_x_ * kSquareTexels;
    FillCommand square = command_;
    square.rect = WorldRect{x0 * spacing_m_, y0 * spacing_m_,
                            std::min(x0 + kSquareTexels, texels_.x1) * spacing_m_,
                            std::min(y0 + kSquareTexels, texels_.y1) * spacing_m_};
    const uint64_t before = session_.document().revision();
    last_ = {.body = std::move(square), .group = group_};
    auto dirt = session_.apply_one(last_);
    if (!dirt) {
        if (auto undone = cancel(); !undone) return undone.error();
        return dirt.error();
    }
    applied_ += session_.document().revision() != before;
    ++next_;
    return dirt;
}

Result<Dirt> Fill::cancel() {
    next_ = count();
    if (std::exchange(applied_, 0) == 0) return Dirt{};
    last_ = {UndoCommand{}};
    return session_.apply_one(last_);
}

}  // namespace loam
