// In which order a frame composes, and how much: pure functions of what waits. Source: Call of Duty talk,
// "Composition Manager": popular pages that are missing first, then, if there is room left, low-resolution
// pages, those that need it most first. Differs: before both, in a lane of its own that no budget takes away,
// what was edited and is in view; and the budget may be milliseconds.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/texture/compose_budget.h"

namespace loam {

// Dirt in view is composed in the next frame up to this, whatever else waits: a dab shows at once.
inline constexpr int64_t kShownDirtTexels = 4 * ComposeBudget::kPage;

struct DirtyPage {
    int place = 0;
    int64_t texels = 0;  // of its dirty rectangle
    uint32_t shown = 0;  // cells of the feedback that see it
    bool wanted = false;
    double distance_m = 0;
};
// Seen by most cells first, then wanted, then nearest.
void order_dirty(std::vector<DirtyPage>& pages);
// How many of the first ones a frame composes: those in view up to kShownDirtTexels, all up to
// `budget_texels`; at least one.
[[nodiscard]] size_t dirt_that_fits(std::span<const DirtyPage> ordered, int64_t budget_texels);

struct LowResPage {
    int place = 0;
    uint32_t popularity = 0;
    int levels_short = 0;  // that its inputs can be better than what it was composed from
    bool final = false;    // all inputs are there
};
// Those that need it most: wanted most, farthest from what they should be.
void order_low_res(std::vector<LowResPage>& pages);

struct PageBudget {
    int pages = 2;                              // a frame
    double ms = 0;                              // a frame, instead of pages; 0: pages
    double page_ms = 4;                         // what one costs
    int64_t fit_texels = ComposeBudget::kMost;  // of frames that are waited for; see ComposeBudget
    bool waited_for = false;
};
// Pages to compose after dirt of `dirt_texels`. Something is always made in the end: at least one page every
// other frame.
[[nodiscard]] int page_allowance(const PageBudget& budget, int64_t dirt_texels, uint64_t frame);

}  // namespace loam
