#include <algorithm>

#include "runtime/base/check.h"
#include "runtime/document/document.h"
#include "runtime/maps/base_window.h"
#include "runtime/maps/height_compose.h"
#include "runtime/maps/index_map.h"

namespace loam {

void IndexMap::compose(const Document& document, const VirtualMap& map, const MapPage& page,
                       const TexelRect& rect, std::span<IndexTexel> out) {
    LOAM_CHECK(out.size() == size_t(kIndexTexels) * kIndexTexels,
               "an index page is composed whole or in part, into a whole one");
    LOAM_CHECK(rect == intersected(rect, {0, 0, kIndexTexels, kIndexTexels}), "rectangle beyond the page");
    if (rect.empty()) return;
    const glm::ivec2 first(page.x * kIndexPayload - kIndexBorder + rect.x0,
                           page.y * kIndexPayload - kIndexBorder + rect.y0);
    const glm::ivec2 size(rect.width(), rect.height());
    thread_local std::vector<IndexTexel> texels;
    texels.resize(size_t(rect.area()));

    const auto lock = document.read_lock();
    read_index_by_place(document, page.level, first, size, texels.data());
    const double spacing = map.spacing_m(page.level);
    const glm::dvec2 low(double(first.x) * spacing, double(first.y) * spacing);
    thread_local std::vector<const Operator*> operators;
    operators.clear();
    document.operators_over_index(
        {low.x, low.y, low.x + (size.x - 1) * spacing, low.y + (size.y - 1) * spacing}, spacing, operators);
    const ResolvedRoles roles = document.roles();
    const SampleGrid<IndexTexel> grid{texels.data(), size.x, size.y, size.x, low.x, low.y, spacing};
    const bool floods = std::any_of(operators.begin(), operators.end(), [](const Operator* op) {
        return std::holds_alternative<Flood>(op->shape);
    });
    thread_local std::vector<double> ground_m;
    ground_m.resize(floods ? texels.size() : 0);
    if (floods) ground_at(document, spacing, first, size, ground_m.data());
    for (const Operator* op : operators) apply_index(*op, roles, grid, ground_m);

    for (int j = 0; j < size.y; ++j)
        std::copy_n(texels.begin() + ptrdiff_t(j) * size.x, size.x,
                    out.begin() + ptrdiff_t(rect.y0 + j) * kIndexTexels + rect.x0);
}

}  // namespace loam
