// Fills of any size: squares of the index map, one command each, in a group of their own, so that a large one
// can be watched, stopped and undone as one.
#pragma once

#include <functional>
#include <optional>

#include "runtime/base/result.h"
#include "runtime/document/command.h"
#include "runtime/document/dirt.h"

namespace loam {

class Session;

class Fill {
  public:
    Fill(Session& session, FillCommand command);

    // The next square. After an error, or `cancel`, the map is as it was before the first one.
    Result<Dirt> step();
    Result<Dirt> cancel();
    [[nodiscard]] const Command& last() const { return last_; }  // that step or cancel applied
    [[nodiscard]] bool done() const { return next_ == count(); }
    [[nodiscard]] double share() const { return count() > 0 ? double(next_) / count() : 1; }

    // Texels a side: some 20 ms each.
    static constexpr int kSquareTexels = 512;

  private:
    [[nodiscard]] int count() const { return squares_x_ * squares_y_; }

    Session& session_;
    FillCommand command_;
    Command last_;
    uint64_t group_ = 0;
    TexelRect texels_;
    double spacing_m_ = 1;
    int squares_x_ = 0, squares_y_ = 0, next_ = 0;
    size_t applied_ = 0;  // commands of the group that changed something
};

}  // namespace loam
