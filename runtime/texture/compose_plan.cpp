#include "runtime/texture/compose_plan.h"

#include <algorithm>

namespace loam {

void order_dirty(std::vector<DirtyPage>& pages) {
    std::sort(pages.begin(), pages.end(), [](const DirtyPage& a, const DirtyPage& b) {
        if (a.shown != b.shown) return a.shown > b.shown;
        if (a.wanted != b.wanted) return a.wanted;
        return a.distance_m != b.distance_m ? a.distance_m < b.distance_m : a.place < b.place;
    });
}

size_t dirt_that_fits(std::span<const DirtyPage> ordered, int64_t budget_texels) {
    int64_t texels = 0;
    for (size_t i = 0; i < ordered.size(); ++i) {
        const int64_t limit =
            ordered[i].shown > 0 ? std::max(kShownDirtTexels, budget_texels) : budget_texels;
        if (i > 0 && texels + ordered[i].texels > limit) return i;
        texels += ordered[i].texels;
    }
    return ordered.size();
}

void order_low_res(std::vector<LowResPage>& pages) {
    const auto need = [](const LowResPage& p) {
        return double(p.popularity) * double(uint64_t(1) << (2 * std::clamp(p.levels_short, 0, 15)));
    };
    std::sort(pages.begin(), pages.end(), [&](const LowResPage& a, const LowResPage& b) {
        if (need(a) != need(b)) return need(a) > need(b);
        if (a.final != b.final) return a.final;
        return a.place < b.place;
    });
}

int page_allowance(const PageBudget& budget, int64_t dirt_texels, uint64_t frame) {
    const bool turn = dirt_texels == 0 || frame % 2 == 0;
    int pages = budget.pages;
    if (budget.ms > 0) {
        const double left_ms =
            budget.ms - budget.page_ms * double(dirt_texels) / double(ComposeBudget::kPage);
        pages = std::max(int(left_ms / std::max(budget.page_ms, 1e-3)), turn ? 1 : 0);
    }
    if (!budget.waited_for) return pages;
    const int64_t fit = std::max<int64_t>(0, budget.fit_texels - dirt_texels) / ComposeBudget::kPage;
    return std::min(pages, std::max(int(fit), turn ? 1 : 0));
}

}  // namespace loam
