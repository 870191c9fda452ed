// Composing what a frame planned, in two steps over all cores.
//
//  1. Heights. A new page's whole window; of an edited page only the heights that changed. Windows of
//  neighbouring pages overlap
//     (they are 100² for 64²), and operators are what is dear, so changed heights of one level are evaluated
//     once over the rectangle around all of them where that is less than one by one.
//  2. Normals and occlusion of the dirty texels, from the windows.
// A sample depends on its place only, so how the work is cut up does not show in any bit.
#include "runtime/base/job_queue.h"
#include "runtime/maps/height_compose.h"
#include "runtime/maps/height_impl.h"

namespace loam {

namespace {

// Samples of a level to evaluate, in samples of that level.
struct Patch {
    int level = 0;
    TexelRect rect;
    std::vector<double> heights_m;
};
constexpr int kPatchRows = 32;  // a job's, so that one large edit occupies all cores
// Less than this many samples or texels is done on the calling thread: starting another takes as long.
constexpr int64_t kSmall = 2000;

TexelRect moved(const TexelRect& r, glm::ivec2 by) {
    return {r.x0 + by.x, r.y0 + by.y, r.x1 + by.x, r.y1 + by.y};
}

void add_patches(std::vector<Patch>& patches, int level, const TexelRect& rect) {
    for (int y = rect.y0; y < rect.y1; y += kPatchRows)
        patches.push_back({level, {rect.x0, y, rect.x1, std::min(y + kPatchRows, rect.y1)}, {}});
}

void run(size_t count, int64_t size, const std::function<void(size_t)>& job) {
    const auto range = [&](int begin, int end) {
        for (int i = begin; i < end; ++i) job(size_t(i));
    };
    parallel_ranges(int(count), size < kSmall ? std::max(int(count), 1) : 1, range);
}

// The parts of a slot's window that lie in evaluated patches.
void copy_into(std::vector<double>& window_m, const MapPage& page, const std::vector<Patch>& patches) {
    const glm::ivec2 origin = first_sample(page) + glm::ivec2(kWindowRect.x0, kWindowRect.y0);
    const TexelRect window = moved({0, 0, kWindowTexels, kWindowTexels}, origin);
    for (const Patch& patch : patches) {
        if (patch.level != page.level) continue;
        const TexelRect both = intersected(patch.rect, window);
        for (int y = both.y0; y < both.y1; ++y) {
            const double* from = patch.heights_m.data() + int64_t(y - patch.rect.y0) * patch.rect.width() +
                                 both.x0 - patch.rect.x0;
            double* to = window_m.data() + int64_t(y - origin.y) * kWindowTexels + both.x0 - origin.x;
            std::copy_n(from, std::max(both.width(), 0), to);
        }
    }
}

}  // namespace

std::vector<VirtualMap::Work> HeightMap::Impl::compose_planned(uint64_t frame, int new_pages) {
    const std::vector<VirtualMap::Work> work = map.plan(frame, new_pages);
    std::vector<Patch> patches;
    int64_t texels = 0;
    for (int level = 0; level <= map.root().level; ++level) {
        TexelRect around;
        int64_t one_by_one = 0;
        std::vector<TexelRect> rects;
        for (const VirtualMap::Work& w : work) {
            if (w.page.level != level) continue;
            texels += w.rect.area();
            Slot& slot = slots[size_t(w.slot)];
            if (w.whole) {
                slot.window_m.resize(size_t(kWindowTexels) * kWindowTexels);
                slot.changed = kWindowRect;
            }
            if (slot.changed.empty()) continue;
            rects.push_back(moved(slot.changed, first_sample(w.page)));
            one_by_one += rects.back().area();
            around = united(around, rects.back());
        }
        if (around.area() <= one_by_one) rects = {around};
        for (const TexelRect& rect : rects) add_patches(patches, level, rect);
    }
    int64_t samples = 0;
    for (const Patch& patch : patches) samples += patch.rect.area();
    run(patches.size(), samples, [&](size_t i) {
        Patch& patch = patches[i];
        patch.heights_m.resize(size_t(patch.rect.area()));
        const auto lock = document.read_lock();
        compose_heights(document, patch.level, {patch.rect.x0, patch.rect.y0},
                        {patch.rect.width(), patch.rect.height()}, patch.heights_m.data());
    });
    run(work.size(), texels, [&](size_t i) {
        const VirtualMap::Work& w = work[i];
        Slot& slot = slots[size_t(w.slot)];
        copy_into(slot.window_m, w.page, patches);
        slot.changed = {};
        derive_page(map, w.page.level, kWindowRect, slot.window_m.data(), w.rect, slot.page);
    });
    return work;
}

}  // namespace loam
