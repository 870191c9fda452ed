#include "runtime/maps/height_compose.h"

#include <cmath>

#include "runtime/base/check.h"
#include "runtime/base/units.h"
#include "runtime/document/document.h"
#include "runtime/maps/base_window.h"
#include "runtime/maps/half.h"

namespace loam {

namespace {

// Operators are data; whatever they compute, no page holds a NaN or a height that a float of metres cannot
// take well.
constexpr double kLimit_m = 20'000.0;

struct Columns {  // where the samples of a window fall on base samples, along one axis
    std::vector<int> base;
    std::vector<CubicWeights> weights;
    int first = 0, count = 0;  // base samples needed
};

// `place` of sample i in base samples, within the map.
template <typename Place>
Columns columns_of(int count, Place&& place) {
    Columns c;
    for (int i = 0; i < count; ++i) {
        const double at = place(i);
        c.base.push_back(int(at));
        c.weights.push_back(catmull_rom(at - int(at)));
    }
    c.first = c.base.front() - 1;
    c.count = c.base.back() + 2 - c.first + 1;
    return c;
}

// Both passes evaluate one fixed expression a sample, whose operands depend on the sample's place only.
void interpolate(const Document& document, const Columns& x, const Columns& y, double* out_m) {
    const glm::ivec2 size(int(x.base.size()), int(y.base.size()));
    thread_local std::vector<int32_t> base;
    thread_local std::vector<double> rows;
    base.resize(size_t(x.count) * size_t(y.count));
    rows.resize(size_t(size.x) * size_t(y.count));
    document.read_heights_mm(0, x.first, y.first, x.count, y.count, base.data());
    for (int j = 0; j < y.count; ++j) {
        const int32_t* in = base.data() + j * x.count;
        double* out = rows.data() + j * size.x;
        for (int i = 0; i < size.x; ++i) {
            const int32_t* s = in + (x.base[size_t(i)] - 1 - x.first);
            const double* w = x.weights[size_t(i)].w;
            out[i] = w[0] * s[0] + w[1] * s[1] + w[2] * s[2] + w[3] * s[3];
        }
    }
    for (int j = 0; j < size.y; ++j) {
        const double* s0 = rows.data() + (y.base[size_t(j)] - 1 - y.first) * size.x;
        const double *s1 = s0 + size.x, *s2 = s1 + size.x, *s3 = s2 + size.x;
        const double* w = y.weights[size_t(j)].w;
        double* out = out_m + j * size.x;
        for (int i = 0; i < size.x; ++i)
            out[i] = (w[0] * s0[i] + w[1] * s1[i] + w[2] * s2[i] + w[3] * s3[i]) * kHeightStep_m;
    }
}

glm::dvec2 last_base(const Document& document) {
    return {document.settings().height_samples_x - 1, document.settings().height_samples_y - 1};
}

void interpolate_base(const Document& document, int shift, glm::ivec2 first, glm::ivec2 size, double* out_m) {
    const glm::dvec2 last = last_base(document);
    const auto axis = [&](int k) {
        return columns_of(size[k],
                          [&](int i) { return std::clamp(std::ldexp(first[k] + i, -shift), 0.0, last[k]); });
    };
    interpolate(document, axis(0), axis(1), out_m);
}

void read_base(const Document& document, int mip, glm::ivec2 first, glm::ivec2 size, double* out_m) {
    thread_local std::vector<int32_t> base;
    const size_t count = size_t(size.x) * size_t(size.y);
    base.resize(count);
    read_heights_by_place(document, mip, first, size, base.data());
    for (size_t i = 0; i < count; ++i) out_m[i] = base[i] * kHeightStep_m;
}

// Composed heights around a texel: what its normal and ambient occlusion look at.
struct Neighbourhood {
    const double* heights_m = nullptr;
    const float* floats_m = nullptr;
    int width = 0;  // texels a row
    double spacing_m = 1;
};

struct Direction {
    int x, y;
    float length;  // of one step, texels
};
constexpr float kDiagonal = 1.41421356f;
constexpr Direction kDirections[] = {{1, 0, 1},  {1, 1, kDiagonal},   {0, 1, 1},  {-1, 1, kDiagonal},
                                     {-1, 0, 1}, {-1, -1, kDiagonal}, {0, -1, 1}, {1, -1, kDiagonal}};

// `count` texels of a row from the neighbourhood's. Loops run over the row so that they vectorise; every
// texel's expression is the same wherever the row begins.
void derive_row(const Neighbourhood& window, int count, uint16_t* out) {
    const double* h = window.heights_m;
    const float* f = window.floats_m;
    float slope_x[kHeightTexels], slope_y[kHeightTexels], horizon[kHeightTexels], sky[kHeightTexels] = {};
    double normal_x[kHeightTexels], normal_y[kHeightTexels];
    const double scale = 1.0 / (2.0 * window.spacing_m);
    for (int i = 0; i < count; ++i) {
        const double gx = (h[i + 1] - h[i - 1]) * scale;
        const double gy = (h[i + window.width] - h[i - window.width]) * scale;
        const double inverse = 1.0 / std::sqrt(gx * gx + gy * gy + 1.0);
        normal_x[i] = -gx * inverse;
        normal_y[i] = -gy * inverse;
        slope_x[i] = static_cast<float>(gx);
        slope_y[i] = static_cast<float>(gy);
    }
    const float spacing = static_cast<float>(window.spacing_m);
    for (const Direction& d : kDirections) {
        const float unit_x = float(d.x) / d.length, unit_y = float(d.y) / d.length;
        for (int i = 0; i < count; ++i) horizon[i] = slope_x[i] * unit_x + slope_y[i] * unit_y;
        float tangent[kHeightTexels];
        for (int i = 0; i < count; ++i) tangent[i] = horizon[i];
        for (int step = 1; step <= kOcclusionRadius; step *= 2) {
            const float* far = f + ptrdiff_t(d.y * step) * window.width + d.x * step;
            const float inverse = 1.0f / (d.length * float(step) * spacing);
            for (int i = 0; i < count; ++i) {
                const float slope = (far[i] - f[i]) * inverse;
                horizon[i] = slope > horizon[i] ? slope : horizon[i];
            }
        }
        for (int i = 0; i < count; ++i) {
            const float above = horizon[i] - tangent[i];
            sky[i] += 1.0f / (1.0f + above * above);
        }
    }
    for (int i = 0; i < count; ++i) {
        out[4 * i + 0] = half_from_float(static_cast<float>(normal_x[i]));
        out[4 * i + 1] = half_from_float(static_cast<float>(normal_y[i]));
        out[4 * i + 2] = half_from_float(sky[i] * 0.125f);
        out[4 * i + 3] = 0;
    }
}

void measure_range(HeightPage& page) {
    float low = page.heights_m[size_t(kHeightBorder * kHeightTexels + kHeightBorder)], high = low;
    for (int j = kHeightBorder; j <= kHeightBorder + kHeightPayload; ++j) {
        const float* row = page.heights_m.data() + j * kHeightTexels + kHeightBorder;
        for (int i = 0; i <= kHeightPayload; ++i) {
            low = row[i] < low ? row[i] : low;
            high = row[i] > high ? row[i] : high;
        }
    }
    page.min_m = low;
    page.max_m = high;
}

// To heights at places (first + (i, j)) * step_m.
void apply_operators(const Document& document, double step_m, glm::ivec2 first, glm::ivec2 size,
                     double* out_m) {
    const glm::dvec2 low(double(first.x) * step_m, double(first.y) * step_m);
    const WorldRect rect{low.x, low.y, low.x + (size.x - 1) * step_m, low.y + (size.y - 1) * step_m};
    thread_local std::vector<const Operator*> operators;
    operators.clear();
    document.operators_over_height(rect, step_m, operators);
    if (operators.empty()) return;
    const SampleGrid<double> grid{out_m, size.x, size.y, size.x, low.x, low.y, step_m};
    for (const Operator* op : operators) apply_height(*op, grid);
    const size_t count = size_t(size.x) * size_t(size.y);
    for (size_t i = 0; i < count; ++i)
        out_m[i] = std::isnan(out_m[i]) ? 0.0 : std::clamp(out_m[i], -kLimit_m, kLimit_m);
}

}  // namespace

CubicWeights catmull_rom(double f) {
    return {{((-0.5 * f + 1.0) * f - 0.5) * f, (1.5 * f - 2.5) * f * f + 1.0,
             ((-1.5 * f + 2.0) * f + 0.5) * f, (0.5 * f - 0.5) * f * f}};
}

double finest_height_spacing(const ProjectSettings& settings) {
    return exact_spacing(settings.height_spacing_m / double(1 << settings.refine));
}

void compose_heights(const Document& document, int level, glm::ivec2 first, glm::ivec2 size, double* out_m) {
    const int refine = document.settings().refine;
    if (level < refine)
        interpolate_base(document, refine - level, first, size, out_m);
    else
        read_base(document, level - refine, first, size, out_m);

    apply_operators(document, finest_height_spacing(document.settings()) * double(int64_t(1) << level), first,
                    size, out_m);
}

void ground_at(const Document& document, double step_m, glm::ivec2 first, glm::ivec2 size, double* out_m) {
    const double steps = step_m / document.settings().height_spacing_m;  // base samples a step
    const glm::dvec2 last = last_base(document);
    const auto axis = [&](int k, int from, int count) {
        return columns_of(count,
                          [&](int i) { return std::clamp((first[k] + from + i) * steps, 0.0, last[k]); });
    };
    int mip = 0;
    const bool samples = std::frexp(steps, &mip) == 0.5 && --mip >= 0 && mip < document.height_mip_count();
    if (samples)
        read_base(document, mip, first, size, out_m);
    else if (steps < 4)
        interpolate(document, axis(0, 0, size.x), axis(1, 0, size.y), out_m);
    else  // what lies between is not read
        for (int j = 0; j < size.y; ++j)
            for (int i = 0; i < size.x; ++i)
                interpolate(document, axis(0, i, 1), axis(1, j, 1), out_m + j * size.x + i);
    apply_operators(document, step_m, first, size, out_m);
}

void compose_page_heights(const Document& document, const MapPage& page, float* out_m) {
    thread_local std::vector<double> heights_m;
    heights_m.resize(size_t(kHeightTexels) * kHeightTexels);
    const auto lock = document.read_lock();
    compose_heights(document, page.level, first_sample(page), glm::ivec2(kHeightTexels), heights_m.data());
    for (size_t i = 0; i < heights_m.size(); ++i) out_m[i] = static_cast<float>(heights_m[i]);
}

void derive_page(const VirtualMap& map, int level, const TexelRect& window, const double* heights_m,
                 const TexelRect& rect, HeightPage& out) {
    LOAM_CHECK(window.x0 <= rect.x0 - kWindowMargin && window.y0 <= rect.y0 - kWindowMargin &&
                   window.x1 >= rect.x1 + kWindowMargin && window.y1 >= rect.y1 + kWindowMargin,
               "the window does not reach beyond the rectangle");
    out.heights_m.resize(size_t(kHeightTexels) * kHeightTexels);
    out.normals.resize(size_t(kHeightTexels) * kHeightTexels * 4);
    const int width = window.width();
    // Only the rows around the rectangle, and of those the columns.
    thread_local std::vector<float> floats_m;
    floats_m.resize(size_t(window.area()));
    for (int y = rect.y0 - kWindowMargin; y < rect.y1 + kWindowMargin; ++y) {
        const size_t row = size_t(y - window.y0) * size_t(width);
        const size_t begin = row + size_t(rect.x0 - kWindowMargin - window.x0);
        const size_t end = row + size_t(rect.x1 + kWindowMargin - window.x0);
        for (size_t i = begin; i < end; ++i) floats_m[i] = static_cast<float>(heights_m[i]);
    }
    for (int y = rect.y0; y < rect.y1; ++y) {
        const size_t from = size_t(y - window.y0) * size_t(width) + size_t(rect.x0 - window.x0);
        const size_t to = size_t(y) * kHeightTexels + size_t(rect.x0);
        std::copy_n(floats_m.data() + from, rect.width(), out.heights_m.data() + to);
        derive_row({heights_m + from, floats_m.data() + from, width, map.spacing_m(level)}, rect.width(),
                   out.normals.data() + to * 4);
    }
    measure_range(out);
}

glm::ivec2 first_sample(const MapPage& page) {
    return {page.x * kHeightPayload - kHeightBorder, page.y * kHeightPayload - kHeightBorder};
}

void HeightMap::compose(const Document& document, const VirtualMap& map, const MapPage& page,
                        const TexelRect& rect, HeightPage& out) {
    LOAM_CHECK(rect == intersected(rect, {0, 0, kHeightTexels, kHeightTexels}), "rectangle beyond the page");
    if (rect.empty()) return;
    const TexelRect window{rect.x0 - kWindowMargin, rect.y0 - kWindowMargin, rect.x1 + kWindowMargin,
                           rect.y1 + kWindowMargin};
    thread_local std::vector<double> heights_m;
    heights_m.resize(size_t(window.area()));
    {
        const auto lock = document.read_lock();
        compose_heights(document, page.level, first_sample(page) + glm::ivec2(window.x0, window.y0),
                        {window.width(), window.height()}, heights_m.data());
    }
    derive_page(map, page.level, window, heights_m.data(), rect, out);
}

}  // namespace loam
