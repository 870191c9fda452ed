// What a command does to the pages of one base map, before anything is written: copies of the pages it
// touches, then the mips, then blobs. The document stays as it was until the result has been committed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <vector>

#include "runtime/base/job_queue.h"
#include "runtime/base/rect.h"
#include "runtime/base/result.h"
#include "runtime/document/base_map.h"

namespace loam {

// A page's new state. No blob: the page is all default now and its row goes away.
struct PageChange {
    int64_t key = 0;
    std::optional<std::vector<uint8_t>> blob;
};

// 33 million samples of a command: half a gigabyte while it is applied.
inline constexpr size_t kMaxPagesPerCommand = 8192;

template <typename Sample>
class PageEdits {
  public:
    PageEdits(BasePages& pages, const MapShape& shape, const Sample& fallback)
        : pages_(pages), shape_(shape), fallback_(fallback) {}

    [[nodiscard]] const MapShape& shape() const { return shape_; }

    // The samples of a mip-0 page to change in place; stays valid. Samples beyond the map must be left alone.
    Result<Sample*> page(int page_x, int page_y) { return edited({shape_.map, 0, page_x, page_y}); }

    // A window of mip 0 with the changes so far, clamped to the map.
    Status read(int x0, int y0, int width, int height, Sample* out) {
        Status status;
        PageHandle<Sample> keep;
        read_window(
            shape_, 0, x0, y0, width, height, fallback_,
            [&](int page_x, int page_y) -> const BasePage<Sample>* {
                const PageKey key{shape_.map, 0, page_x, page_y};
                if (const auto found = edits_.find(key.packed()); found != edits_.end())
                    return found->second.samples.get();
                auto loaded = pages_.template load<Sample>(key);
                if (!loaded.ok()) {
                    status = loaded.error();
                    return nullptr;
                }
                keep = *loaded;
                return keep.get();
            },
            out);
        return status;
    }

    // Carries the changed samples up the mips and encodes. `changed`: rectangles of changed samples of mip 0,
    // one a page. Ascending keys; pages that are as before are not among them.
    Result<std::vector<PageChange>> finish(std::vector<TexelRect>& changed) {
        std::vector<int64_t> finest;
        for (const auto& [key, edit] : edits_) finest.push_back(key);
        std::sort(finest.begin(), finest.end());
        for (const int64_t key : finest) {
            const TexelRect rect = changed_samples(PageKey::unpacked(key));
            if (rect.empty()) continue;
            changed.push_back(rect);
            LOAM_TRY(carry_up(PageKey::unpacked(key), rect));
        }
        return encode();
    }

    // The new pages, to be kept decoded once they have been committed.
    void publish(const std::vector<PageChange>& changes) {
        for (const PageChange& change : changes) {
            PageHandle<Sample> handle;
            if (change.blob) handle = std::move(edits_.at(change.key).samples);
            pages_.template publish<Sample>(change.key, std::move(handle));
        }
    }

  private:
    struct Edit {
        PageHandle<Sample> before;
        std::shared_ptr<BasePage<Sample>> samples;
    };

    Result<Sample*> edited(const PageKey& key) {
        const int64_t packed = key.packed();
        if (const auto found = edits_.find(packed); found != edits_.end())
            return found->second.samples->data();
        if (edits_.size() >= kMaxPagesPerCommand)
            return error(
                "the command changes more than {} million samples at once; use a smaller brush or fewer dabs",
                kMaxPagesPerCommand * size_t(kBasePageSamples) / 1000000);
        auto before = pages_.template load<Sample>(key);
        if (!before.ok()) return before.error();
        Edit edit{.before = *before, .samples = std::make_shared<BasePage<Sample>>()};
        if (edit.before)
            *edit.samples = *edit.before;
        else
            edit.samples->fill(fallback_);
        return edits_.emplace(packed, std::move(edit)).first->second.samples->data();
    }

    // The rectangle, in the map's samples, that holds what differs from before.
    TexelRect changed_samples(const PageKey& key) const {
        const Edit& edit = edits_.at(key.packed());
        TexelRect rect;
        for (int y = 0; y < kBasePageSide; ++y)
            for (int x = 0; x < kBasePageSide; ++x) {
                const size_t i = size_t(y * kBasePageSide + x);
                const Sample& before = edit.before ? (*edit.before)[i] : fallback_;
                if (!((*edit.samples)[i] == before)) rect = united(rect, TexelRect{x, y, x + 1, y + 1});
            }
        if (rect.empty()) return rect;
        const int x0 = key.x * kBasePageSide, y0 = key.y * kBasePageSide;
        return {rect.x0 + x0, rect.y0 + y0, rect.x1 + x0, rect.y1 + y0};
    }

    Status carry_up(const PageKey& key, const TexelRect& rect) {
        const Sample* finest = edits_.at(key.packed()).samples->data();
        for (int mip = 1; mip < shape_.mip_count; ++mip) {
            const int step = 1 << mip;
            const int x0 = (rect.x0 + step - 1) / step, x1 = (rect.x1 - 1) / step;
            const int y0 = (rect.y0 + step - 1) / step, y1 = (rect.y1 - 1) / step;
            if (x0 > x1 || y0 > y1)
                continue;  // a coarser one may still have a sample here: 0 is in all of them
            // A mip-0 page lies in one page of every mip.
            const auto page = edited({shape_.map, mip, key.x >> mip, key.y >> mip});
            if (!page.ok()) return page.error();
            for (int y = y0; y <= y1; ++y)
                for (int x = x0; x <= x1; ++x) {
                    const int from_x = x * step % kBasePageSide, from_y = y * step % kBasePageSide;
                    const int to = y % kBasePageSide * kBasePageSide + x % kBasePageSide;
                    (*page)[to] = finest[from_y * kBasePageSide + from_x];
                }
        }
        return {};
    }

    Result<std::vector<PageChange>> encode() {
        std::vector<PageChange> changes;
        for (const auto& [key, edit] : edits_) {
            const bool same = edit.before ? *edit.before == *edit.samples : all_default(*edit.samples);
            if (!same) changes.push_back({key, std::nullopt});
        }
        std::sort(changes.begin(), changes.end(),
                  [](const PageChange& a, const PageChange& b) { return a.key < b.key; });
        // 16 pages, a millisecond, are worth a thread.
        parallel_ranges(int(changes.size()), 16, [&](int begin, int end) {
            for (int i = begin; i < end; ++i) {
                PageChange& change = changes[size_t(i)];
                const BasePage<Sample>& samples = *edits_.at(change.key).samples;
                if (!all_default(samples)) change.blob = encode_page<Sample>(samples);
            }
        });
        return changes;
    }

    bool all_default(const BasePage<Sample>& samples) const {
        return std::all_of(samples.begin(), samples.end(), [&](const Sample& s) { return s == fallback_; });
    }

    BasePages& pages_;
    const MapShape shape_;
    const Sample fallback_;
    std::unordered_map<int64_t, Edit> edits_;
};

}  // namespace loam
