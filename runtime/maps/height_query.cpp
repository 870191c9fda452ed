// Queries at the finest level: height, normal, rays.
//
// A ray walks the pages it passes over, skips those whose height bounds it does not meet, and within the
// others solves for the bilinear surface of one cell after another: along a ray that surface's height is a
// quadratic in t, so hits are exact to rounding. Bounds come from the base samples below a page, so that
// pages far from the ray are not composed.
#include "runtime/base/units.h"
#include "runtime/maps/height_compose.h"
#include "runtime/maps/height_impl.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace loam {

namespace {

// Catmull-Rom weights add up to 1 with an absolute sum of at most 1.25 an axis: a value lies within
// (1.25² - 1) / 2 of the samples' range beyond it.
constexpr double kOvershoot = 0.28125;
constexpr double kFarthest_m = 1e7;

glm::ivec2 cell_counts(const Document& document) {  // of the finest level; never 0
    const ProjectSettings& s = document.settings();
    return glm::max(glm::ivec2(s.height_samples_x - 1, s.height_samples_y - 1) * (1 << s.refine),
                    glm::ivec2(1));
}

// A place in the finest samples: the cell's sample within its page, and where in the cell.
struct Place {
    MapPage page;
    int texel = 0;  // of the cell's south-west sample
    double u = 0, v = 0;
};

Place place_at(const VirtualMap& map, glm::ivec2 cells, double x_m, double y_m) {
    const auto sample = [&](double metres, int count) {
        return std::isnan(metres) ? 0.0 : std::clamp(metres / map.spacing_m(0), 0.0, double(count));
    };
    const double x = sample(x_m, cells.x), y = sample(y_m, cells.y);
    const int i = std::min(int(x), cells.x - 1), j = std::min(int(y), cells.y - 1);
    const int row = j % kHeightPayload + kHeightBorder, column = i % kHeightPayload + kHeightBorder;
    return {{0, i / kHeightPayload, j / kHeightPayload}, row * kHeightTexels + column, x - i, y - j};
}

double bilinear(double a, double b, double c, double d, double u, double v) {
    return (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v;
}

// Visits the cells (ix, iy) in [low, high) that x(t) = ox + dx t, y(t) = oy + dy t passes for t0 <= t <= t1,
// in order, with the piece [ta, tb] in each; stops when `visit` says true.
template <typename Visit>
bool walk_cells(glm::dvec2 o, glm::dvec2 d, double t0, double t1, glm::ivec2 low, glm::ivec2 high,
                const Visit& visit) {
    glm::ivec2 cell;
    for (int a = 0; a < 2; ++a)
        cell[a] = int(std::clamp(std::floor(o[a] + d[a] * t0), double(low[a]), double(high[a] - 1)));
    double t = t0;
    while (true) {
        double leave[2];
        for (int a = 0; a < 2; ++a)
            leave[a] = d[a] == 0 ? std::numeric_limits<double>::infinity()
                                 : (cell[a] + (d[a] > 0 ? 1 : 0) - o[a]) / d[a];
        const int axis = leave[0] <= leave[1] ? 0 : 1;
        const double next = std::clamp(leave[axis], t, t1);
        if (visit(cell, t, next)) return true;
        if (!(leave[axis] < t1)) return false;
        t = next;
        cell[axis] += d[axis] > 0 ? 1 : -1;
        if (cell[axis] < low[axis] || cell[axis] >= high[axis]) return false;
    }
}

// The smallest root of a s² + b s + c in [-eps, length + eps], clamped to [0, length].
std::optional<double> first_root(double a, double b, double c, double length, double eps) {
    if (c == 0) return 0.0;
    const double discriminant = b * b - 4 * a * c;
    if (!(discriminant >= 0)) return std::nullopt;
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    std::optional<double> best;
    const auto take = [&](double s) {
        if (s >= -eps && s <= length + eps && (!best || s < *best)) best = s;
    };
    if (a != 0) take(q / a);
    if (q != 0) take(c / q);
    if (best) best = std::clamp(*best, 0.0, length);
    return best;
}

// The part of the ray above the map's rectangle [0, size]; false: none.
bool clip_to_map(glm::dvec2 o, glm::dvec2 d, glm::dvec2 size, double& t0, double& t1) {
    for (int a = 0; a < 2; ++a) {
        if (d[a] == 0) {
            if (o[a] < 0 || o[a] > size[a]) return false;
            continue;
        }
        const double s = (0 - o[a]) / d[a], e = (size[a] - o[a]) / d[a];
        t0 = std::max(t0, std::min(s, e));
        t1 = std::min(t1, std::max(s, e));
    }
    return t0 <= t1;
}

}  // namespace

const float* HeightQueryCache::page(const Document& document, const MapPage& page) {
    if (const auto found = by_page_.find(page); found != by_page_.end()) {
        pages_.splice(pages_.begin(), pages_, found->second);
        return found->second->heights_m.data();
    }
    if (pages_.size() < kPageLimit) {
        pages_.emplace_front();
        pages_.front().heights_m.resize(size_t(kHeightTexels) * kHeightTexels);
    } else {
        by_page_.erase(pages_.back().page);
        pages_.splice(pages_.begin(), pages_, std::prev(pages_.end()));
    }
    pages_.front().page = page;
    by_page_[page] = pages_.begin();
    compose_page_heights(document, page, pages_.front().heights_m.data());
    return pages_.front().heights_m.data();
}

HeightQueryCache::Bounds HeightQueryCache::bounds(const Document& document, const VirtualMap& map,
                                                  const MapPage& page, const float* heights_m) {
    if (const auto found = bounds_.find(page); found != bounds_.end()) return found->second;
    const auto operators_touch = [&] {
        std::vector<const Operator*> operators;
        document.operators_over_height(map.page_rect(page), map.spacing_m(0), operators);
        return !operators.empty();
    };
    Bounds result;
    auto lock = document.read_lock();
    if (heights_m || operators_touch()) {
        lock.unlock();
        if (!heights_m) heights_m = this->page(document, page);
        const auto [low, high] = std::minmax_element(heights_m, heights_m + kHeightTexels * kHeightTexels);
        result = {*low, *high};
    } else {
        const int shift = document.settings().refine;
        const glm::ivec2 first =
            ((glm::ivec2(page.x, page.y) * kHeightPayload) >> shift) - (shift > 0 ? 1 : 0);
        const int count = shift > 0 ? (kHeightPayload >> shift) + 4 : kHeightPayload + 1;
        std::vector<int32_t> base(size_t(count) * size_t(count));
        document.read_heights_mm(0, first.x, first.y, count, count, base.data());
        const auto [low, high] = std::minmax_element(base.begin(), base.end());
        const double low_m = height_m_from_mm(*low), high_m = height_m_from_mm(*high);
        const double beyond_m =
            (shift > 0 ? kOvershoot * (high_m - low_m) : 0) + 0.002;  // and the rounding to floats
        result = {float(low_m - beyond_m), float(high_m + beyond_m)};
    }
    if (bounds_.size() >= kBoundsLimit) bounds_.clear();
    bounds_[page] = result;
    return result;
}

void HeightQueryCache::drop(const VirtualMap& map, const WorldRect& rect) {
    const std::lock_guard lock(mutex);
    const WorldRect reach = rect.grown((kHeightBorder + 1) * map.spacing_m(0));
    const auto touched = [&](const MapPage& page) { return map.page_rect(page).overlaps(reach); };
    for (auto it = pages_.begin(); it != pages_.end();) {
        if (!touched(it->page)) {
            ++it;
            continue;
        }
        by_page_.erase(it->page);
        it = pages_.erase(it);
    }
    const auto page_of = [&](double metres, int count) {
        return int(std::clamp(std::floor(metres / map.page_size_m(0)), 0.0, double(count - 1)));
    };
    const int x0 = page_of(reach.min_x, map.pages_x(0)), x1 = page_of(reach.max_x, map.pages_x(0));
    const int y0 = page_of(reach.min_y, map.pages_y(0)), y1 = page_of(reach.max_y, map.pages_y(0));
    if (int64_t(x1 - x0 + 1) * (y1 - y0 + 1) > int64_t(bounds_.size())) {
        std::erase_if(bounds_, [&](const auto& entry) { return touched(entry.first); });
        return;
    }
    for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) bounds_.erase({0, x, y});
}

uint64_t HeightQueryCache::bytes() const {
    return pages_.size() * size_t(kHeightTexels) * kHeightTexels * sizeof(float) +
           bounds_.size() * (sizeof(MapPage) + sizeof(Bounds) + 2 * sizeof(void*));
}

const float* HeightMap::Impl::clean_heights(const MapPage& page) const {
    const int slot = map.slot_of(page);
    return slot >= 0 && map.dirty_of(slot).empty() ? slots[size_t(slot)].page.heights_m.data() : nullptr;
}

const float* HeightMap::Impl::finest_heights(const MapPage& page) {
    const float* heights_m = clean_heights(page);
    return heights_m ? heights_m : cache.page(document, page);
}

double HeightMap::height_m(double x_m, double y_m) {
    const std::lock_guard lock(impl_->cache.mutex);
    const Place p = place_at(impl_->map, cell_counts(impl_->document), x_m, y_m);
    const float* h = impl_->finest_heights(p.page) + p.texel;
    return bilinear(h[0], h[1], h[kHeightTexels], h[kHeightTexels + 1], p.u, p.v);
}

glm::dvec3 HeightMap::normal(double x_m, double y_m) {
    const std::lock_guard lock(impl_->cache.mutex);
    const Place p = place_at(impl_->map, cell_counts(impl_->document), x_m, y_m);
    const float* h = impl_->finest_heights(p.page) + p.texel;
    const auto slope = [&](int step) {  // of heights across one sample, in steps of `step` texels
        const auto at = [&](int texel) { return double(h[texel + step]) - double(h[texel - step]); };
        return bilinear(at(0), at(1), at(kHeightTexels), at(kHeightTexels + 1), p.u, p.v) /
               (2 * impl_->map.spacing_m(0));
    };
    return glm::normalize(glm::dvec3(-slope(1), -slope(kHeightTexels), 1.0));
}

std::optional<glm::dvec3> HeightMap::ray_cast(glm::dvec3 origin_m, glm::dvec3 direction, double max_m,
                                              Holes holes) {
    const double length = glm::length(direction);
    if (!(length > 0) || !std::isfinite(length) || !std::isfinite(glm::dot(origin_m, origin_m)) ||
        !(max_m >= 0))
        return std::nullopt;
    const glm::dvec3 unit = direction / length;
    const double spacing = impl_->map.spacing_m(0);
    const glm::dvec2 o = glm::dvec2(origin_m) / spacing, d = glm::dvec2(unit) / spacing;
    const glm::ivec2 cells = cell_counts(impl_->document);
    double t0 = 0, t1 = std::min(max_m, kFarthest_m);
    if (!clip_to_map(o, d, glm::dvec2(cells), t0, t1)) return std::nullopt;

    const std::lock_guard lock(impl_->cache.mutex);
    std::optional<double> hit;
    const auto is_open = [&](double t) {
        return holes == Holes::open &&
               CutoutMap::is_cut(impl_->document, origin_m.x + unit.x * t, origin_m.y + unit.y * t);
    };
    const auto visit_page = [&](glm::ivec2 page_at, double from, double to) {
        const MapPage page{0, page_at.x, page_at.y};
        const HeightQueryCache::Bounds bounds =
            impl_->cache.bounds(impl_->document, impl_->map, page, impl_->clean_heights(page));
        const double z0 = origin_m.z + unit.z * from, z1 = origin_m.z + unit.z * to;
        if (std::min(z0, z1) > double(bounds.max_m) + 1e-3 || std::max(z0, z1) < double(bounds.min_m) - 1e-3)
            return false;

        const float* heights_m = impl_->finest_heights(page);
        const glm::ivec2 first = page_at * kHeightPayload;
        const auto visit_cell = [&](glm::ivec2 cell, double ta, double tb) {
            const glm::ivec2 texel = cell - first + kHeightBorder;
            const float* h = heights_m + texel.y * kHeightTexels + texel.x;
            const double h00 = h[0], h10 = h[1], h01 = h[kHeightTexels], h11 = h[kHeightTexels + 1];
            // Ground at (u, v) = h00 + du u + dv v + duv u v, with u, v and z linear in s = t - ta.
            const double du = h10 - h00, dv = h01 - h00, duv = h00 + h11 - h10 - h01;
            const double u = o.x + d.x * ta - cell.x, v = o.y + d.y * ta - cell.y,
                         z = origin_m.z + unit.z * ta;
            const double a = -duv * d.x * d.y;
            const double b = unit.z - du * d.x - dv * d.y - duv * (u * d.y + v * d.x);
            const double c = z - h00 - du * u - dv * v - duv * u * v;
            const auto root = first_root(a, b, c, tb - ta, 1e-9 * (1 + ta));
            if (!root) return false;
            hit = ta + *root;
            if (!is_open(*hit)) return true;
            // Through a hole; the same cell may be met once more, where the other root is.
            const double other = a != 0 ? -(2 * a * *root + b) / a : -1;
            hit = other > 0 && *root + other <= tb - ta ? std::optional(ta + *root + other) : std::nullopt;
            if (hit && is_open(*hit)) hit.reset();
            return hit.has_value();
        };
        const glm::ivec2 high = glm::min(first + kHeightPayload, cells);
        return walk_cells(o, d, from, to, first, high, visit_cell);
    };
    const double per_page = 1.0 / kHeightPayload;
    const glm::ivec2 pages = (cells + kHeightPayload - 1) / kHeightPayload;
    walk_cells(o * per_page, d * per_page, t0, t1, glm::ivec2(0), pages, visit_page);
    if (!hit) return std::nullopt;
    return origin_m + unit * *hit;
}

}  // namespace loam
