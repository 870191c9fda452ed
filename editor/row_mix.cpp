#include "editor/row_mix.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"

namespace loam {

PixelMix mix_between(double from, double to, int pixels) {
    PixelMix mix;
    const int last = pixels - 1;
    if (to - from <= 1) {
        const double at = (from + to) / 2 - 0.5, low = std::floor(at);
        mix.first = std::clamp(int(low), 0, last);
        const int second = std::clamp(int(low) + 1, 0, last);
        if (second == mix.first)
            mix.weights = {1};
        else
            mix.weights = {float(1 - (at - low)), float(at - low)};
        return mix;
    }
    mix.first = std::clamp(int(std::floor(from)), 0, last);
    const int end = std::clamp(int(std::ceil(to)), mix.first + 1, pixels);
    double sum = 0;
    for (int i = mix.first; i < end; ++i) {
        const double share = std::max(0.0, std::min(to, i + 1.0) - std::max(from, double(i)));
        mix.weights.push_back(float(share));
        sum += share;
    }
    if (sum <= 0) {
        mix.weights.assign(1, 1.0f);
        mix.first = std::clamp(int(from), 0, last);
        return mix;
    }
    for (float& weight : mix.weights) weight = float(weight / sum);
    return mix;
}

RowMixer::RowMixer(ImageRows& picture, std::vector<PixelMix> columns, std::vector<PixelMix> rows,
                   Decode decode)
    : picture_(picture),
      columns_(std::move(columns)),
      rows_(std::move(rows)),
      decode_(std::move(decode)),
      decoded_(size_t(picture.width())),
      mixed_(columns_.size()) {}

Status RowMixer::hold_next() {
    const auto row = picture_.next();
    if (!row.ok()) return row.error();
    const size_t channels = size_t(picture_.channel_count());
    for (size_t x = 0; x < decoded_.size(); ++x) decoded_[x] = decode_(row->data() + x * channels);
    std::vector<glm::vec4>& out = held_.emplace_back(columns_.size(), glm::vec4(0));
    for (size_t x = 0; x < out.size(); ++x)
        for (size_t k = 0; k < columns_[x].weights.size(); ++k)
            out[x] += columns_[x].weights[k] * decoded_[size_t(columns_[x].first) + k];
    return {};
}

Result<std::span<const glm::vec4>> RowMixer::next() {
    LOAM_CHECK(next_ < rows_.size(), "a row mixer has as many rows as it was made with");
    const PixelMix& mix = rows_[next_++];
    LOAM_CHECK(mix.first >= first_held_, "rows are wanted from the top");
    for (; first_held_ < mix.first && !held_.empty(); ++first_held_) held_.pop_front();
    for (; first_held_ < mix.first; ++first_held_)
        if (const auto skipped = picture_.next(); !skipped.ok()) return skipped.error();
    while (held_.size() < mix.weights.size()) LOAM_TRY(hold_next());
    std::fill(mixed_.begin(), mixed_.end(), glm::vec4(0));
    for (size_t k = 0; k < mix.weights.size(); ++k)
        for (size_t x = 0; x < mixed_.size(); ++x) mixed_[x] += mix.weights[k] * held_[k][x];
    return std::span<const glm::vec4>(mixed_);
}

Status RowMixer::finish() {
    for (int row = first_held_ + int(held_.size()); row < picture_.height(); ++row)
        if (const auto rest = picture_.next(); !rest.ok()) return rest.error();
    return {};
}

}  // namespace loam
