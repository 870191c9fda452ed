#include "runtime/document/cutout.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "runtime/base/check.h"
#include "runtime/document/ground_decal.h"

namespace loam {

namespace {

constexpr double kHair_m = 1e-6;   // on a surface is inside
constexpr size_t kDabsARect = 16;  // a long stroke touches the pages along it

VolumeAxes axes(const Cutout& cutout) {
    return axes_of(cutout.direction, cutout.roll_rad);
}

}  // namespace

WorldRect disc_rect(const Cutout& cutout, const glm::dvec2& dab) {
    return WorldRect{dab.x, dab.y, dab.x, dab.y}.grown(cutout.radius_m + kHair_m);
}

bool disc_holds(const Cutout& cutout, const glm::dvec2& dab, const glm::dvec3& place_m) {
    return glm::distance(dab, glm::dvec2(place_m)) <= cutout.radius_m + kHair_m;
}

std::vector<WorldRect> rects_of(const Cutout& cutout) {
    std::vector<WorldRect> rects;
    if (cutout.form == CutoutForm::brush) {
        for (size_t i = 0; i < cutout.dabs.size(); ++i) {
            const WorldRect disc = disc_rect(cutout, cutout.dabs[i]);
            if (i % kDabsARect == 0)
                rects.push_back(disc);
            else
                rects.back() = united(rects.back(), disc);
        }
        return rects;
    }
    WorldRect rect;
    if (cutout.form == CutoutForm::convex) {
        for (const glm::dvec3& c : cutout.corners) rect = united(rect, {c.x, c.y, c.x, c.y});
    } else {
        const VolumeAxes a = axes(cutout);
        const glm::dvec3 half = glm::abs(a.x * cutout.half_m.x) + glm::abs(a.y * cutout.half_m.y) +
                                glm::abs(a.z * cutout.half_m.z);
        const glm::dvec3& c = cutout.center_m;
        rect = {c.x - half.x, c.y - half.y, c.x + half.x, c.y + half.y};
    }
    return {rect.grown(kHair_m)};
}

bool holds(const Cutout& cutout, const glm::dvec3& place_m) {
    switch (cutout.form) {
        case CutoutForm::brush:
            return std::any_of(cutout.dabs.begin(), cutout.dabs.end(),
                               [&](const glm::dvec2& dab) { return disc_holds(cutout, dab, place_m); });
        case CutoutForm::convex:
            LOAM_CHECK(cutout.planes, "an operator of a document has been prepared");
            return std::all_of(cutout.planes->begin(), cutout.planes->end(), [&](const glm::dvec4& plane) {
                return glm::dot(glm::dvec3(plane), place_m) <= plane.w + kHair_m;
            });
        case CutoutForm::box:
        case CutoutForm::cylinder:
            break;
    }
    const VolumeAxes a = axes(cutout);
    const glm::dvec3 rel = place_m - cutout.center_m;
    const glm::dvec3 local(glm::dot(rel, a.x), glm::dot(rel, a.y), glm::dot(rel, a.z));
    const glm::dvec3 reach = glm::abs(cutout.half_m) + kHair_m;
    if (std::abs(local.z) > reach.z) return false;
    if (cutout.form == CutoutForm::box) return std::abs(local.x) <= reach.x && std::abs(local.y) <= reach.y;
    const glm::dvec2 share(local.x / reach.x, local.y / reach.y);
    return glm::dot(share, share) <= 1;
}

// Every plane through three corners that has all others on one side. Corners are few.
Result<std::vector<glm::dvec4>> hull_planes(const std::vector<glm::dvec3>& corners) {
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const glm::dvec3& c : corners) {
        low = glm::min(low, c);
        high = glm::max(high, c);
    }
    const double size_m = corners.empty() ? 0 : glm::length(high - low);
    const double hair_m = std::max(1e-9 * size_m, 1e-9);
    std::vector<glm::dvec4> planes;
    const auto add = [&](const glm::dvec3& normal, const glm::dvec3& through) {
        double least = INFINITY, most = -INFINITY;
        for (const glm::dvec3& c : corners) {
            const double beyond = glm::dot(normal, c - through);
            least = std::min(least, beyond);
            most = std::max(most, beyond);
        }
        for (const double side : {1.0, -1.0}) {
            const double outside = side > 0 ? most : -least, depth = side > 0 ? -least : most;
            if (outside > hair_m || depth < 1e-6 * size_m) continue;
            const glm::dvec3 n = normal * side;
            const glm::dvec4 plane(n, glm::dot(n, through));
            const bool known = std::any_of(planes.begin(), planes.end(), [&](const glm::dvec4& p) {
                return glm::distance(glm::dvec3(p), n) < 1e-9 && std::abs(p.w - plane.w) <= hair_m;
            });
            if (!known) planes.push_back(plane);
        }
    };
    for (size_t i = 0; i < corners.size(); ++i)
        for (size_t j = i + 1; j < corners.size(); ++j)
            for (size_t k = j + 1; k < corners.size(); ++k) {
                const glm::dvec3 normal = glm::cross(corners[j] - corners[i], corners[k] - corners[i]);
                const double length = glm::length(normal);
                if (length > 1e-9 * size_m * size_m) add(normal / length, corners[i]);
            }
    if (planes.size() < 4)
        return error(
            "the corners of a convex cutout span no volume: give four or more that do not lie in one plane");
    return planes;
}

}  // namespace loam
