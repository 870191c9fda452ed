#include "runtime/maps/base_window.h"

#include <cmath>

namespace loam {

namespace {

// `read(mip, x, y, width, height, out)` clamps within the mip; `last` is the last sample of mip 0.
template <typename T, typename Read>
void read_by_place(const Read& read, int mip, glm::ivec2 last, glm::ivec2 first, glm::ivec2 size, T* out) {
    read(mip, first.x, first.y, size.x, size.y, out);
    const glm::ivec2 last_in_mip(last.x >> mip, last.y >> mip);
    const auto place = [&](int sample, int axis) {
        if (sample > last_in_mip[axis]) return last[axis];
        return std::max(sample, 0) << mip;
    };
    const glm::ivec2 inside =
        glm::clamp(last_in_mip + 1 - first, glm::ivec2(0), size);  // counts of columns and rows
    if (inside.x < size.x && (last_in_mip.x << mip) != last.x) {
        for (int j = 0; j < size.y; ++j) {
            T edge;
            read(0, last.x, place(first.y + j, 1), 1, 1, &edge);
            std::fill(out + j * size.x + inside.x, out + (j + 1) * size.x, edge);
        }
    }
    if (inside.y < size.y && (last_in_mip.y << mip) != last.y) {
        for (int i = 0; i < size.x; ++i) {
            T edge;
            read(0, place(first.x + i, 0), last.y, 1, 1, &edge);
            for (int j = inside.y; j < size.y; ++j) out[j * size.x + i] = edge;
        }
    }
}

}  // namespace

void read_heights_by_place(const Document& document, int mip, glm::ivec2 first, glm::ivec2 size,
                           int32_t* out) {
    const ProjectSettings& settings = document.settings();
    const auto read = [&](int m, int x, int y, int width, int height, int32_t* to) {
        document.read_heights_mm(m, x, y, width, height, to);
    };
    read_by_place(read, mip, {settings.height_samples_x - 1, settings.height_samples_y - 1}, first, size,
                  out);
}

void read_index_by_place(const Document& document, int mip, glm::ivec2 first, glm::ivec2 size,
                         IndexTexel* out) {
    const auto read = [&](int m, int x, int y, int width, int height, IndexTexel* to) {
        document.read_index(m, x, y, width, height, to);
    };
    read_by_place(read, mip, document.index_size_texels() - 1, first, size, out);
}

double exact_spacing(double spacing_m) {
    constexpr int kMantissaBits = 34;
    int exponent = 0;
    const double mantissa = std::frexp(spacing_m, &exponent);
    return std::ldexp(std::nearbyint(std::ldexp(mantissa, kMantissaBits)), exponent - kMantissaBits);
}

WorldRect extended_beyond_edges(const WorldRect& rect, const WorldRect& bounds) {
    if (rect.empty()) return rect;
    constexpr double kBeyond_m = 1e6, kHair_m = 1e-3;
    WorldRect r = rect;
    if (r.min_x <= bounds.min_x + kHair_m) r.min_x -= kBeyond_m;
    if (r.min_y <= bounds.min_y + kHair_m) r.min_y -= kBeyond_m;
    if (r.max_x >= bounds.max_x - kHair_m) r.max_x += kBeyond_m;
    if (r.max_y >= bounds.max_y - kHair_m) r.max_y += kBeyond_m;
    return r;
}

int level_count_for(double extent_m, double spacing_m, int payload_texels) {
    int count = 1;
    for (double side = spacing_m * payload_texels; side < extent_m * (1 - 1e-9); side *= 2) ++count;
    return count;
}

}  // namespace loam
