#include "editor/picture.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "runtime/base/check.h"
#include "runtime/base/srgb.h"

namespace loam {

namespace {

void check_same_size(const Picture& a, const Picture& b) {
    LOAM_CHECK(a.width == b.width && a.height == b.height && a.rgba.size() == b.rgba.size(),
               fmt::format("pictures of {}x{} and {}x{}", a.width, a.height, b.width, b.height));
}

double luma(const Picture& p, int x, int y) {
    const uint8_t* c =
        p.rgba.data() + 4 * (static_cast<size_t>(y) * static_cast<size_t>(p.width) + static_cast<size_t>(x));
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];  // Rec. 709 weights on encoded values
}

}  // namespace

void LinearAverage::add(const Picture& picture) {
    const size_t pixels = static_cast<size_t>(picture.width) * static_cast<size_t>(picture.height);
    if (count_ == 0) {
        width_ = picture.width;
        height_ = picture.height;
        sum_.assign(pixels * 3, 0.0f);
    }
    LOAM_CHECK(width_ == picture.width && height_ == picture.height, "pictures of one size are averaged");
    for (size_t i = 0; i < pixels; ++i)
        for (size_t c = 0; c < 3; ++c) sum_[i * 3 + c] += float(linear_of_srgb8(picture.rgba[i * 4 + c]));
    ++count_;
}

Picture LinearAverage::picture() const {
    LOAM_CHECK(count_ > 0, "an average of no pictures");
    Picture out{width_, height_, std::vector<uint8_t>(sum_.size() / 3 * 4, 255)};
    const float share = 1.0f / static_cast<float>(count_);
    for (size_t i = 0; i < sum_.size() / 3; ++i)
        for (size_t c = 0; c < 3; ++c) out.rgba[i * 4 + c] = srgb8_of_linear(sum_[i * 3 + c] * share);
    return out;
}

double psnr_db(const Picture& a, const Picture& b) {
    check_same_size(a, b);
    double squares = 0;
    for (size_t i = 0; i < a.rgba.size(); ++i)
        if (i % 4 != 3) {
            const double d = static_cast<double>(a.rgba[i]) - b.rgba[i];
            squares += d * d;
        }
    if (squares == 0) return std::numeric_limits<double>::infinity();
    return 10.0 * std::log10(255.0 * 255.0 * static_cast<double>(a.rgba.size() / 4 * 3) / squares);
}

double laplacian_energy(const Picture& picture) {
    double sum = 0;
    for (int y = 1; y + 1 < picture.height; ++y)
        for (int x = 1; x + 1 < picture.width; ++x) {
            const double l = 4 * luma(picture, x, y) - luma(picture, x - 1, y) - luma(picture, x + 1, y) -
                             luma(picture, x, y - 1) - luma(picture, x, y + 1);
            sum += l * l;
        }
    return sum / std::max(1.0, (picture.width - 2.0) * (picture.height - 2.0));
}

double differing_share(const Picture& a, const Picture& b, int tolerance) {
    check_same_size(a, b);
    size_t differing = 0;
    for (size_t i = 0; i + 3 < a.rgba.size(); i += 4)
        for (size_t c = 0; c < 3; ++c)
            if (std::abs(int(a.rgba[i + c]) - int(b.rgba[i + c])) > tolerance) {
                ++differing;
                break;
            }
    return static_cast<double>(differing) / static_cast<double>(std::max<size_t>(1, a.rgba.size() / 4));
}

PictureStep picture_step(const Picture& a, const Picture& b) {
    check_same_size(a, b);
    constexpr int kTile = 8;
    PictureStep step;
    size_t count_of[256] = {};
    for (int tile_y = 0; tile_y < a.height; tile_y += kTile)
        for (int tile_x = 0; tile_x < a.width; tile_x += kTile) {
            const int end_x = std::min(tile_x + kTile, a.width), end_y = std::min(tile_y + kTile, a.height);
            int sum[3] = {};
            for (int y = tile_y; y < end_y; ++y)
                for (int x = tile_x; x < end_x; ++x) {
                    const size_t at =
                        (static_cast<size_t>(y) * static_cast<size_t>(a.width) + static_cast<size_t>(x)) * 4;
                    int largest = 0;
                    for (size_t c = 0; c < 3; ++c) {
                        const int d = std::abs(int(a.rgba[at + c]) - int(b.rgba[at + c]));
                        sum[c] += d;
                        largest = std::max(largest, d);
                    }
                    ++count_of[largest];
                }
            const double pixels = static_cast<double>(end_x - tile_x) * (end_y - tile_y);
            for (const int s : sum) step.tile = std::max(step.tile, s / pixels);
        }
    const size_t allowed = a.rgba.size() / 4 / 1000;  // pixels beyond
    size_t beyond = 0;
    int value = 255;
    while (value > 0 && beyond + count_of[value] <= allowed) beyond += count_of[value--];
    step.pixel = value;
    return step;
}

}  // namespace loam
