#include "ui/layout.h"

#include <algorithm>
#include <cmath>

namespace loam::ui {

std::vector<Extent> solve(const SolveDesc& d) {
    const size_t count = d.sizes.size();
    std::vector<Extent> out(count);
    if (count == 0) return out;

    std::vector<float> length(count, 0.0f);
    float rigid = 0, flex_min = 0;
    for (size_t i = 0; i < count; ++i) {
        const Size& s = d.sizes[i];
        if (s.kind == Size::Kind::flex) {
            length[i] = std::round(std::max(0.0f, s.min) * d.scale);
            flex_min += length[i];
        } else {
            const float wanted = s.kind == Size::Kind::fixed ? s.value * d.scale
                                 : i < d.content_px.size()   ? d.content_px[i]
                                                             : 0.0f;
            length[i] = std::max(0.0f, std::ceil(wanted - 0.01f));
            rigid += length[i];
        }
    }
    const float room = std::max(0.0f, std::floor(d.available_px) - d.gap_px * float(count - 1));

    if (rigid + flex_min > room) {
        // Minimums give way first, then everything that is left shrinks by the same factor.
        const float flex_factor = flex_min > 0 ? std::clamp((room - rigid) / flex_min, 0.0f, 1.0f) : 0.0f;
        const float rigid_factor = rigid > room ? room / rigid : 1.0f;
        for (size_t i = 0; i < count; ++i)
            length[i] =
                std::floor(length[i] * (d.sizes[i].kind == Size::Kind::flex ? flex_factor : rigid_factor));
    } else {
        // Weights share the rest. A child whose share is below its minimum keeps the minimum and leaves the
        // sharing.
        std::vector<bool> settled(count);
        float rest = room - rigid;
        for (bool again = true; again;) {
            again = false;
            float weights = 0;
            for (size_t i = 0; i < count; ++i)
                if (d.sizes[i].kind == Size::Kind::flex && !settled[i])
                    weights += std::max(0.0f, d.sizes[i].value);
            if (weights <= 0) break;
            for (size_t i = 0; i < count; ++i) {
                if (d.sizes[i].kind != Size::Kind::flex || settled[i]) continue;
                if (rest * std::max(0.0f, d.sizes[i].value) / weights < length[i]) {
                    settled[i] = again = true;
                    rest -= length[i];
                    break;
                }
            }
            if (again) continue;
            // Rounded as running sums, so that the last one ends exactly at the end.
            float sum = 0, done = 0;
            for (size_t i = 0; i < count; ++i) {
                if (d.sizes[i].kind != Size::Kind::flex || settled[i]) continue;
                sum += std::max(0.0f, d.sizes[i].value);
                const float end = sum >= weights ? rest : std::round(rest * sum / weights);
                length[i] = end - done;
                done = end;
            }
        }
    }
    float at = 0;
    for (size_t i = 0; i < count; ++i) {
        out[i] = {at, length[i]};
        at += length[i] + d.gap_px;
    }
    return out;
}

}  // namespace loam::ui
