#include "editor/packer/map_image.h"

#include <algorithm>
#include <cmath>

#include "editor/image_file.h"
#include "runtime/base/job_queue.h"

namespace loam {

namespace {

// The texels of a row that one new texel averages.
struct Tap {
    int first = 0;  // may lie outside: wraps
    std::vector<float> weights;
};

std::vector<Tap> taps_of(int length, int repeat, int size) {
    std::vector<Tap> taps(static_cast<size_t>(size));
    const double ratio = static_cast<double>(length) * repeat / size, reach = std::max(1.0, ratio);
    for (int i = 0; i < size; ++i) {
        Tap& tap = taps[static_cast<size_t>(i)];
        const double center = (i + 0.5) * ratio - 0.5;
        tap.first = static_cast<int>(std::floor(center - reach)) + 1;
        const int last = static_cast<int>(std::ceil(center + reach)) - 1;
        double sum = 0;
        for (int k = tap.first; k <= last; ++k) sum += reach - std::abs(k - center);
        for (int k = tap.first; k <= last; ++k)
            tap.weights.push_back(static_cast<float>((reach - std::abs(k - center)) / sum));
    }
    return taps;
}

int wrapped(int k, int length) {
    return (k % length + length) % length;
}

}  // namespace

Result<MapImage> read_map(const std::filesystem::path& file, std::vector<std::string>& warnings) {
    auto image = read_samples(file, kMaxMapSide, KeptChannels::up_to_four);
    if (!image) return image.error();
    if (image->kind == SampleKind::signed_16)
        return error("{} has signed samples, expected 8 or 16-bit unsigned integers or floats",
                     file.string());
    const float scale = image->kind == SampleKind::unsigned_8    ? 1.0f / 255
                        : image->kind == SampleKind::unsigned_16 ? 1.0f / 65535
                                                                 : 1.0f;
    MapImage map;
    const auto count = static_cast<size_t>(image->kept_channel_count);
    map.has_alpha = count == 2 || count == 4;
    map.is_float = image->kind == SampleKind::floating;
    map.says_linear = image->color_space == "Linear" || image->color_space == "linear";
    map.channels_differ = image->channels_differ;
    const auto width = static_cast<size_t>(image->width), height = static_cast<size_t>(image->height);
    for (size_t c = 0; c < count; ++c) {
        Plane plane{image->width, image->height, std::vector<float>(width * height)};
        double sum = 0;
        size_t bad = 0;
        for (size_t y = 0; y < height; ++y)
            for (size_t x = 0; x < width; ++x) {
                const float v = image->samples[(y * width + x) * count + c] * scale;
                plane.v[(height - 1 - y) * width + x] = v;
                if (std::isfinite(v))
                    sum += v;
                else
                    ++bad;
            }
        if (bad == plane.v.size())
            return error("{}: no sample of channel {} is a finite number", file.string(), c + 1);
        if (bad > 0) {
            const auto mean = static_cast<float>(sum / static_cast<double>(plane.v.size() - bad));
            for (float& v : plane.v)
                if (!std::isfinite(v)) v = mean;
            warnings.push_back(
                fmt::format("{}: {} of {} samples of channel {} are NaN or infinite and become {:.4g}, "
                            "the mean of the others",
                            file.filename().string(), bad, plane.v.size(), c + 1, mean));
        }
        map.channels.push_back(std::move(plane));
    }
    return map;
}

Plane resampled(const Plane& plane, int repeat_x, int repeat_y, int size) {
    const std::vector<Tap> columns = taps_of(plane.width, repeat_x, size);
    const std::vector<Tap> rows = taps_of(plane.height, repeat_y, size);
    Plane narrow{size, plane.height,
                 std::vector<float>(static_cast<size_t>(size) * static_cast<size_t>(plane.height))};
    parallel_ranges(plane.height, 64, [&](int begin, int end) {
        for (int y = begin; y < end; ++y)
            for (int x = 0; x < size; ++x) {
                const Tap& tap = columns[static_cast<size_t>(x)];
                float sum = 0;
                for (size_t k = 0; k < tap.weights.size(); ++k)
                    sum +=
                        tap.weights[k] * plane.at(wrapped(tap.first + static_cast<int>(k), plane.width), y);
                narrow.v[static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x)] = sum;
            }
    });
    Plane out{size, size, std::vector<float>(static_cast<size_t>(size) * static_cast<size_t>(size), 0.0f)};
    parallel_ranges(size, 64, [&](int begin, int end) {
        for (int y = begin; y < end; ++y) {
            const Tap& tap = rows[static_cast<size_t>(y)];
            float* to = &out.v[static_cast<size_t>(y) * static_cast<size_t>(size)];
            for (size_t k = 0; k < tap.weights.size(); ++k) {
                const int from = wrapped(tap.first + static_cast<int>(k), plane.height);
                for (int x = 0; x < size; ++x) to[x] += tap.weights[k] * narrow.at(x, from);
            }
        }
    });
    return out;
}

}  // namespace loam
