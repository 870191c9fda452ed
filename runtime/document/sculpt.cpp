// One dab = its samples, a weight for each by falloff, and a new height from weight and old height.
// Everything is rounded to whole millimetres, half away from zero, so that a replay gives the same bits.
// Smoothing blends towards a tent filter (two box filters, running sums in whole numbers) of an eighth of the
// radius, of the heights before the dab; so it averages only and cannot overshoot.
#include "runtime/document/sculpt.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/units.h"
#include "runtime/document/brush_step.h"

namespace loam {

namespace {

// The sample nearest to a dab's centre gets this weight at least: what a brush finer than the map does to it.
constexpr double kLeastNearestWeight = 0.25;
// Half widths of the smoothing boxes: 1 is a 5x5 tent; 64 keeps the sums in 64 bits.
constexpr int kMaxBox = 64;

int64_t rounded(double v) {
    return int64_t(v < 0 ? v - 0.5 : v + 0.5);
}

// Sums over 2*box+1 entries along rows of `width`: the result is 2*box narrower.
std::vector<int64_t> box_rows(const std::vector<int64_t>& in, int width, int height, int box) {
    const int out_width = width - 2 * box;
    std::vector<int64_t> out(size_t(out_width) * size_t(height));
    for (int y = 0; y < height; ++y) {
        const int64_t* from = in.data() + size_t(y) * size_t(width);
        int64_t* to = out.data() + size_t(y) * size_t(out_width);
        int64_t sum = 0;
        for (int x = 0; x < 2 * box; ++x) sum += from[x];
        for (int x = 0; x < out_width; ++x) {
            sum += from[x + 2 * box];
            to[x] = sum;
            sum -= from[x];
        }
    }
    return out;
}

// The same along columns, row by row to stay in the cache.
std::vector<int64_t> box_columns(const std::vector<int64_t>& in, int width, int height, int box) {
    const int out_height = height - 2 * box;
    const size_t w = size_t(width);
    std::vector<int64_t> out(w * size_t(out_height)), sum(w, 0);
    for (int y = 0; y < 2 * box; ++y)
        for (size_t x = 0; x < w; ++x) sum[x] += in[size_t(y) * w + x];
    for (int y = 0; y < out_height; ++y)
        for (size_t x = 0; x < w; ++x) {
            sum[x] += in[size_t(y + 2 * box) * w + x];
            out[size_t(y) * w + x] = sum[x];
            sum[x] -= in[size_t(y) * w + x];
        }
    return out;
}

// Tent-filtered heights of a rectangle, in (2 box + 1)^4 ths of a millimetre.
Result<std::vector<int64_t>> smoothed(PageEdits<int32_t>& edits, const TexelRect& rect, int box) {
    int width = rect.width() + 4 * box, height = rect.height() + 4 * box;
    std::vector<int32_t> heights(size_t(width) * size_t(height));
    LOAM_TRY(edits.read(rect.x0 - 2 * box, rect.y0 - 2 * box, width, height, heights.data()));
    std::vector<int64_t> sums(heights.begin(), heights.end());
    for (int pass = 0; pass < 2; ++pass) {
        sums = box_rows(sums, width, height, box);
        width -= 2 * box;
        sums = box_columns(sums, width, height, box);
        height -= 2 * box;
    }
    return sums;
}

// Calls change(height, weight, is it the nearest sample, x, y) for every sample under the dab.
template <typename Change>
Status for_each_sample(const DabFootprint& dab, double hardness, PageEdits<int32_t>& edits, Change&& change) {
    return for_each_page_under(dab.rect, [&](int page_x, int page_y, const TexelRect& part) -> Status {
        const auto page = edits.page(page_x, page_y);
        if (!page.ok()) return page.error();
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x) {
                const double dx = x - dab.x, dy = y - dab.y;
                const bool nearest = x == dab.nearest_x && y == dab.nearest_y;
                double weight = brush_falloff(std::sqrt(dx * dx + dy * dy) / dab.radius, hardness);
                if (nearest) weight = std::max(weight, kLeastNearestWeight);
                if (weight <= 0) continue;
                change((*page)[(y - page_y * kBasePageSide) * kBasePageSide + x - page_x * kBasePageSide],
                       weight, nearest, x, y);
            }
        return {};
    });
}

Status raise(const SculptCommand& command, const DabFootprint& dab, PageEdits<int32_t>& edits) {
    const double strength_mm = command.strength / kHeightStep_m;
    const int64_t sign = command.mode == SculptMode::lower ? -1 : 1;
    const int64_t least = command.strength > 0 ? 1 : 0;
    return for_each_sample(dab, command.hardness, edits,
                           [&](int32_t& height, double weight, bool nearest, int, int) {
                               int64_t step = rounded(strength_mm * weight);
                               if (nearest) step = std::max(step, least);
                               height = saturate_height_mm(height + sign * step);
                           });
}

Status flatten(const SculptCommand& command, const DabFootprint& dab, PageEdits<int32_t>& edits) {
    const int32_t target = height_mm_from_m(command.target_m);
    return for_each_sample(dab, command.hardness, edits,
                           [&](int32_t& height, double weight, bool nearest, int, int) {
                               const int64_t difference = int64_t(target) - height;
                               int64_t step = rounded(double(difference) * weight * command.strength);
                               if (nearest && step == 0 && command.strength > 0)
                                   step = (difference > 0) - (difference < 0);
                               height = saturate_height_mm(height + step);
                           });
}

Status smooth(const SculptCommand& command, const DabFootprint& dab, PageEdits<int32_t>& edits) {
    if (dab.rect.empty()) return {};
    const int box = std::clamp(int(dab.radius / 8), 1, kMaxBox);
    const auto means = smoothed(edits, dab.rect, box);
    if (!means.ok()) return means.error();
    const double side = 2 * box + 1, count = side * side * side * side;
    return for_each_sample(
        dab, command.hardness, edits, [&](int32_t& height, double weight, bool, int x, int y) {
            const size_t at = size_t(y - dab.rect.y0) * size_t(dab.rect.width()) + size_t(x - dab.rect.x0);
            const double difference = double((*means)[at]) / count - height;
            height = saturate_height_mm(height + rounded(difference * weight * command.strength));
        });
}

}  // namespace

Status sculpt(const SculptCommand& command, PageEdits<int32_t>& edits) {
    for (const glm::dvec2& center : command.dabs) {
        const DabFootprint dab = dab_footprint(edits.shape(), center, command.radius_m);
        const size_t pages = size_t(dab.rect.area() / kBasePageSamples);
        if (pages > kMaxPagesPerCommand)
            return error("a dab covers {} million samples, the limit is {}; use a smaller brush",
                         dab.rect.area() / 1000000, kMaxPagesPerCommand * size_t(kBasePageSamples) / 1000000);
        switch (command.mode) {
            case SculptMode::raise:
            case SculptMode::lower:
                LOAM_TRY(raise(command, dab, edits));
                break;
            case SculptMode::smooth:
                LOAM_TRY(smooth(command, dab, edits));
                break;
            case SculptMode::flatten:
                LOAM_TRY(flatten(command, dab, edits));
                break;
        }
    }
    return {};
}

}  // namespace loam
