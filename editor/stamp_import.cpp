#include "editor/stamp_import.h"

#include <algorithm>
#include <cmath>

#include "editor/image_file.h"
#include "runtime/document/stamp_library.h"
#include "runtime/store/project.h"
#include "runtime/store/stamp_file.h"

namespace loam {

namespace {

constexpr int kMaxSide = 16384;  // of a picture

// The numbers that become 0 and 1. Infinite ones are mended first.
std::pair<double, double> range_of(const SampleImage& image) {
    switch (image.kind) {
        case SampleKind::unsigned_8:
            return {0, 255};
        case SampleKind::unsigned_16:
            return {0, 65535};
        case SampleKind::signed_16:
        case SampleKind::floating:
            break;
    }
    const auto colors = size_t(image.kept_channel_count >= 3 ? 3 : 1);
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < image.samples.size(); i += size_t(image.kept_channel_count))
        for (size_t c = 0; c < colors; ++c) {
            low = std::min(low, double(image.samples[i + c]));
            high = std::max(high, double(image.samples[i + c]));
        }
    return {low, high > low ? high : low + 1};
}

size_t mend(SampleImage& image) {
    float least = INFINITY;
    for (const float sample : image.samples)
        if (std::isfinite(sample)) least = std::min(least, sample);
    if (!std::isfinite(least)) least = 0;
    size_t mended = 0;
    for (float& sample : image.samples)
        if (!std::isfinite(sample)) sample = least, ++mended;
    return mended;
}

// Means of two by two; a last odd row or column counts twice.
void halve(SampleImage& image) {
    const int width = (image.width + 1) / 2, height = (image.height + 1) / 2,
              channels = image.kept_channel_count;
    std::vector<float> small(size_t(width) * size_t(height) * size_t(channels));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            for (int c = 0; c < channels; ++c) {
                const auto at = [&](int i, int j) {
                    const int sx = std::min(2 * x + i, image.width - 1),
                              sy = std::min(2 * y + j, image.height - 1);
                    return image.samples[(size_t(sy) * size_t(image.width) + size_t(sx)) * size_t(channels) +
                                         size_t(c)];
                };
                small[(size_t(y) * size_t(width) + size_t(x)) * size_t(channels) + size_t(c)] =
                    0.25f * (at(0, 0) + at(1, 0) + at(0, 1) + at(1, 1));
            }
    image.width = width;
    image.height = height;
    image.samples = std::move(small);
}

StampImage stamp_of(const SampleImage& image, double black, double white, AddedStamp& out) {
    StampImage stamp{.width = image.width, .height = image.height, .heights = {}, .colors = {}, .cover = {}};
    const size_t texels = size_t(image.width) * size_t(image.height),
                 channels = size_t(image.kept_channel_count);
    const bool is_rgb = channels >= 3, has_alpha = channels == 2 || channels == 4;
    out.has_colors = is_rgb && image.channels_differ;
    stamp.heights.resize(texels);
    if (out.has_colors) stamp.colors.resize(3 * texels);
    if (has_alpha) stamp.cover.resize(texels);
    const double alpha_white = white_of(image.kind);
    const auto share = [&](float sample) {
        return std::clamp((double(sample) - black) / (white - black), 0.0, 1.0);
    };
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const float* from =
                &image.samples[(size_t(image.height - 1 - y) * size_t(image.width) + size_t(x)) * channels];
            const size_t to = size_t(y) * size_t(image.width) + size_t(x);
            const double level =
                out.has_colors ? 0.2126 * share(from[0]) + 0.7152 * share(from[1]) + 0.0722 * share(from[2])
                               : share(from[0]);
            stamp.heights[to] = uint16_t(level * 65535 + 0.5);
            for (size_t c = 0; out.has_colors && c < 3; ++c)
                stamp.colors[3 * to + c] = uint8_t(share(from[c]) * 255 + 0.5);
            if (has_alpha)
                stamp.cover[to] =
                    uint8_t(std::clamp(double(from[channels - 1]) / alpha_white, 0.0, 1.0) * 255 + 0.5);
        }
    if (std::all_of(stamp.cover.begin(), stamp.cover.end(), [](uint8_t c) { return c == 255; }))
        stamp.cover.clear();
    out.has_cover = !stamp.cover.empty();
    return stamp;
}

}  // namespace

Result<AddedStamp> add_stamp(const std::filesystem::path& project, const std::filesystem::path& file,
                             const std::string& name, const Progress& progress) {
    if (const auto settings = load_project(project); !settings.ok()) return settings.error();
    AddedStamp added{.name = name.empty() ? file.stem().string() : name};
    LOAM_TRY(check_stamp_name(added.name));
    const std::filesystem::path target = StampLibrary(project).file_of(added.name);
    if (std::filesystem::exists(target))
        return error("the project has a stamp \"{}\" already; give another name with --name", added.name);
    LOAM_TRY(step_progress(progress, 0, "reading the picture"));
    auto image = read_samples(file, kMaxSide, KeptChannels::up_to_four);
    if (!image.ok()) return image.error();
    if (const size_t mended = mend(*image); mended > 0)
        added.notes.push_back(
            fmt::format("{} numbers were not finite: set to the least of the others", mended));
    LOAM_TRY(step_progress(progress, 0.6, "making the stamp"));
    const glm::ivec2 size(image->width, image->height);
    while (image->width > kMaxStampTexels || image->height > kMaxStampTexels) halve(*image);
    if (glm::ivec2(image->width, image->height) != size)
        added.notes.push_back(fmt::format("{} x {} texels made {} x {}: a stamp has at most {} a side",
                                          size.x, size.y, image->width, image->height, kMaxStampTexels));
    std::tie(added.black, added.white) = range_of(*image);
    const StampImage stamp = stamp_of(*image, added.black, added.white, added);
    if (std::all_of(stamp.heights.begin(), stamp.heights.end(),
                    [&](uint16_t h) { return h == stamp.heights[0]; }))
        added.notes.push_back("its brightness is the same everywhere: it has no relief");
    LOAM_TRY(step_progress(progress, 0.8, "writing the stamp"));
    added.width = stamp.width;
    added.height = stamp.height;
    std::error_code failure;
    std::filesystem::create_directories(target.parent_path(), failure);
    if (failure) return error("cannot make {}: {}", target.parent_path().string(), failure.message());
    LOAM_TRY(save_stamp(target, stamp));
    return added;
}

}  // namespace loam
