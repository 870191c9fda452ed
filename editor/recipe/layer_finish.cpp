// From a canvas to a layer: everything that is derived from height, and the flattening that keeps repeats
// from showing.
#include <algorithm>
#include <array>
#include <cmath>

#include "editor/recipe/layer_canvas.h"
#include "runtime/base/srgb.h"
#include "shaders/texture/layer_math.h"

namespace loam::recipe {

namespace {

using Plane = std::vector<float>;

// Mean over a wrapped square, three passes (nearly a Gaussian).
Plane blurred_wrapped(const Plane& source, int size, int radius) {
    Plane a = source, b(a.size());
    const auto at = [size](int i, int j) { return static_cast<size_t>(j) * size + (i & (size - 1)); };
    for (int pass = 0; pass < 6; ++pass) {  // rows into columns: two make one pass over both axes
        for (int j = 0; j < size; ++j) {
            double sum = 0;
            for (int i = -radius; i <= radius; ++i) sum += a[at(i, j)];
            for (int i = 0; i < size; ++i) {
                b[static_cast<size_t>(i) * size + j] = static_cast<float>(sum / (2 * radius + 1));
                sum += a[at(i + radius + 1, j)] - a[at(i - radius, j)];
            }
        }
        std::swap(a, b);
    }
    return a;
}

// The share of a sky-lit hemisphere that is seen: mean over eight directions of cos² of the horizon's angle.
Plane occlusion_of(const Plane& height_texel, int size) {
    static constexpr std::array<int, 7> kReach = {1, 2, 4, 7, 12, 20, 34};
    static constexpr int kX[8] = {1, 1, 0, -1, -1, -1, 0, 1}, kY[8] = {0, 1, 1, 1, 0, -1, -1, -1};
    Plane out(height_texel.size());
    const int mask = size - 1;
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) {
            const float here = height_texel[static_cast<size_t>(j) * size + i];
            float open = 0;
            for (int k = 0; k < 8; ++k) {
                const float unit = (k & 1) ? 1.41421356f : 1.0f;
                float steepest = 0;
                for (const int reach : kReach) {
                    const int step = (k & 1) ? std::max(1, reach * 7 / 10) : reach;
                    const float there = height_texel[static_cast<size_t>((j + kY[k] * step) & mask) * size +
                                                     ((i + kX[k] * step) & mask)];
                    steepest = std::max(steepest, (there - here) / (unit * static_cast<float>(step)));
                }
                open += 1.0f / (1.0f + steepest * steepest);
            }
            out[static_cast<size_t>(j) * size + i] = open / 8;
        }
    return out;
}

uint8_t byte(float v) {
    return static_cast<uint8_t>(std::lround(std::clamp(v, 0.0f, 1.0f) * 255.0f));
}

}  // namespace

LayerTextures finished(Canvas& canvas, const Finish& f) {
    const int n = canvas.size() / 2;
    const size_t count = static_cast<size_t>(n) * n;
    Plane height(count), gloss(count), luminance(count);
    std::vector<glm::vec3> albedo(count);
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const size_t c = static_cast<size_t>(j) * n + i;
            for (int k = 0; k < 4; ++k) {
                const Canvas::Texel& t = canvas.at(2 * i + (k & 1), 2 * j + (k >> 1));
                height[c] += 0.25f * t.height * static_cast<float>(n) * f.relief;  // now in texels
                gloss[c] += 0.25f * t.gloss;
                albedo[c] += 0.25f * t.albedo;
            }
        }
    const Plane open = occlusion_of(height, n);
    for (size_t c = 0; c < count; ++c) {
        albedo[c] *= 1.0f - f.cavity * (1.0f - open[c]);
        luminance[c] = 0.2126f * albedo[c].r + 0.7152f * albedo[c].g + 0.0722f * albedo[c].b;
    }
    const Plane broad = blurred_wrapped(luminance, n, std::max(1, n / 20));
    double mean_broad = 0;
    for (const float v : broad) mean_broad += v / static_cast<double>(count);
    glm::dvec3 mean(0);
    for (size_t c = 0; c < count; ++c) {
        albedo[c] *= mix(1.0f, static_cast<float>(mean_broad) / std::max(broad[c], 1e-4f), f.flatten);
        mean += glm::dvec3(albedo[c]) / static_cast<double>(count);
    }
    const glm::vec3 gain = f.mean_albedo / glm::vec3(mean);

    // Reveal: heights between the 1st and the 99th percentile, without what is broader than a quarter of the
    // tile.
    const Plane swell = blurred_wrapped(height, n, std::max(1, n / 8));
    Plane fine(count);
    for (size_t c = 0; c < count; ++c) fine[c] = height[c] - 0.7f * swell[c];
    Plane sorted = fine;
    const auto percentile = [&](double share) {
        const auto it = sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(count - 1));
        std::nth_element(sorted.begin(), it, sorted.end());
        return *it;
    };
    const float low = percentile(0.01), high = std::max(percentile(0.99), low + 1e-6f);

    LayerTextures out;
    out.size_texels = n;
    out.albedo_reveal.assign(1, std::vector<uint8_t>(count * 4));
    out.normal_gloss_occlusion.assign(1, std::vector<uint8_t>(count * 4));
    out.metalness.assign(1, std::vector<uint8_t>(count, 0));
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            const size_t c = static_cast<size_t>(j) * n + i;
            const auto h = [&](int x, int y) {
                return height[static_cast<size_t>(y & (n - 1)) * n + (x & (n - 1))];
            };
            const float dx = 0.5f * (h(i + 1, j) - h(i - 1, j)), dy = 0.5f * (h(i, j + 1) - h(i, j - 1));
            const float length = 1.0f / std::sqrt(1 + dx * dx + dy * dy);
            const glm::vec3 colour = f.mean_albedo + (albedo[c] * gain - f.mean_albedo) * f.contrast;
            uint8_t* a = &out.albedo_reveal[0][c * 4];
            a[0] = srgb8_of_linear(colour.r), a[1] = srgb8_of_linear(colour.g),
            a[2] = srgb8_of_linear(colour.b);
            a[3] = byte((fine[c] - low) / (high - low));
            uint8_t* b = &out.normal_gloss_occlusion[0][c * 4];
            b[0] = byte(shared::layer_encode_signed(-dx * length));
            b[1] = byte(shared::layer_encode_signed(-dy * length));
            b[2] = byte(gloss[c]), b[3] = byte(open[c]);
        }
    build_layer_mips(out);
    return out;
}

}  // namespace loam::recipe
