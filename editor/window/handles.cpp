#include "editor/window/handles.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace loam::window {

namespace {

using Role = Handle::Role;
using Handles = std::vector<Handle>;

constexpr double kSmallest_m = 0.05, kLargest_m = 2000;

glm::dvec2 ahead(double heading_rad) {
    return {std::sin(heading_rad), std::cos(heading_rad)};
}
glm::dvec2 right_of(double heading_rad) {
    return {std::cos(heading_rad), -std::sin(heading_rad)};
}
double reach(glm::dvec2 from, glm::dvec2 to) {
    return std::clamp(glm::length(to - from), kSmallest_m, kLargest_m);
}
double signed_like(double value, double sign) {
    return sign < 0 ? -value : value;
}

// A box on the ground: its middle, the end that it is turned by, and its side.
template <typename Box>
Handles box_handles(const Box& box) {
    const glm::dvec2 middle(box.x_m, box.y_m);
    return {{Role::move, middle, 0, middle},
            {Role::turn, middle + ahead(box.heading_rad) * std::abs(box.half_m.y), 0, middle},
            {Role::side, middle + right_of(box.heading_rad) * std::abs(box.half_m.x), 0, middle}};
}
template <typename Box>
void drag_box(Box& box, const Handle& handle, glm::dvec2 to) {
    const glm::dvec2 middle(box.x_m, box.y_m), away = to - middle;
    if (handle.role == Role::move) {
        box.x_m = to.x;
        box.y_m = to.y;
    } else if (handle.role == Role::side) {
        box.half_m.x = signed_like(reach(middle, to), box.half_m.x);
    } else if (glm::length(away) > kSmallest_m) {
        box.heading_rad = std::atan2(away.x, away.y);
        box.half_m.y = signed_like(reach(middle, to), box.half_m.y);
    }
}

// A box in space, seen from above: what of its sides can be seen from there. One that stands on edge has no
// handle for the axis that is upright.
constexpr double kLeastSeen = 0.15;  // of an axis, that has a handle

double heading_of(glm::dvec2 v) {
    return std::atan2(v.x, v.y);
}

template <typename Box>
Handles space_box_handles(const Box& box) {
    const VolumeAxes axes = axes_of(box.direction, box.roll_rad);
    const glm::dvec2 middle(box.center_m), x(axes.x), y(axes.y);
    Handles list{{Role::move, middle, 0, middle}};
    if (glm::length(y) > kLeastSeen)
        list.push_back({Role::turn, middle + y * std::abs(box.half_m.y), 0, middle});
    if (glm::length(x) > kLeastSeen)
        list.push_back({Role::side, middle + x * std::abs(box.half_m.x), 0, middle});
    return list;
}

// Turned around the upright through its middle: by its direction, or by its roll where that points straight
// down.
template <typename Box>
void turn_to(Box& box, double heading_rad) {
    const auto heading_now = [](const Box& b) {
        return heading_of(glm::dvec2(axes_of(b.direction, b.roll_rad).y));
    };
    const double turn = heading_rad - heading_now(box);
    if (std::hypot(box.direction.x, box.direction.y) > 1e-6 * std::abs(box.direction.z)) {
        const double c = std::cos(turn), s = std::sin(turn);
        box.direction = {c * box.direction.x + s * box.direction.y, c * box.direction.y - s * box.direction.x,
                         box.direction.z};
        return;
    }
    Box other = box;
    box.roll_rad -= turn;  // seen from below it turns the other way
    other.roll_rad += turn;
    const auto off = [&](const Box& b) {
        return std::abs(std::remainder(heading_now(b) - heading_rad, 2 * M_PI));
    };
    if (off(other) < off(box)) box = other;
    box.roll_rad = std::remainder(box.roll_rad, 2 * M_PI);
}

template <typename Box>
void drag_space_box(Box& box, const Handle& handle, glm::dvec2 to) {
    const glm::dvec2 middle(box.center_m);
    const VolumeAxes axes = axes_of(box.direction, box.roll_rad);
    const int axis = handle.role == Role::side ? 0 : 1;
    const double seen = glm::length(glm::dvec2(axis == 0 ? axes.x : axes.y));
    if (axis == 1 && glm::length(to - middle) > kSmallest_m) turn_to(box, heading_of(to - middle));
    box.half_m[axis] =
        signed_like(std::clamp(reach(middle, to) / seen, kSmallest_m, kLargest_m), box.half_m[axis]);
}

template <typename Round>
Handles round_handles(const Round& round, double radius_m) {
    const glm::dvec2 middle(round.x_m, round.y_m);
    return {{Role::move, middle, 0, middle}, {Role::radius, middle + glm::dvec2(radius_m, 0), 0, middle}};
}

glm::dvec2 middle_of(const std::vector<glm::dvec2>& places) {
    glm::dvec2 sum(0);
    for (const glm::dvec2& at : places) sum += at;
    return places.empty() ? sum : sum / double(places.size());
}

Handles handles(const Crater& c) {
    return round_handles(c, c.radius_m);
}
Handles handles(const Flood& f) {
    return round_handles(f, f.radius_m);
}
Handles handles(const TerrainDecal& d) {
    return box_handles(d);
}
Handles handles(const Stamp& s) {
    return box_handles(s);
}
Handles handles(const Footprint& f) {
    const glm::dvec2 at(f.x_m, f.y_m);
    return {{Role::move, at, 0, at}, {Role::turn, at + ahead(f.heading_rad) * (f.length_m / 2), 0, at}};
}
Handles handles(const Slide& s) {
    const glm::dvec2 from(s.x_m, s.y_m);
    return {{Role::move, from, 0, from},
            {Role::end, s.to_m, 0, from},
            {Role::radius, from + glm::dvec2(s.radius_m, 0), 0, from}};
}
Handles handles(const VolumeDecal& v) {
    return space_box_handles(v);
}
Handles handles(const Cutout& c) {
    if (c.form == CutoutForm::box || c.form == CutoutForm::cylinder) return space_box_handles(c);
    if (c.form == CutoutForm::brush) {
        const glm::dvec2 at = middle_of(c.dabs);
        return {{Role::move, at, 0, at}, {Role::radius, at + glm::dvec2(c.radius_m, 0), 0, at}};
    }
    glm::dvec2 at(0);
    for (const glm::dvec3& corner : c.corners) at += glm::dvec2(corner) / double(c.corners.size());
    Handles list{{Role::move, at, 0, at}};
    for (size_t i = 0; i < c.corners.size(); ++i)
        list.push_back({Role::anchor, glm::dvec2(c.corners[i]), int(i), at});
    return list;
}
Handles handles(const SplineDecal& s) {
    Handles list;
    glm::dvec2 middle(0);
    for (size_t i = 0; i < s.points.size(); i += 3) middle += glm::dvec2(s.points[i].x_m, s.points[i].y_m);
    middle /= double(s.points.size() / 3 + 1);
    list.push_back({Role::move, middle, 0, middle});
    const auto place = [&](size_t i) { return glm::dvec2(s.points[i].x_m, s.points[i].y_m); };
    for (size_t i = 0; i < s.points.size(); ++i) {
        const size_t anchor = i % 3 == 0 ? i : i % 3 == 1 ? i - 1 : i + 1;
        list.push_back({i % 3 == 0 ? Role::anchor : Role::tangent, place(i), int(i), place(anchor)});
    }
    return list;
}
Handles handles(const Event& e) {
    const glm::dvec2 at(e.x_m, e.y_m);
    Handles list{{Role::move, at, 0, at}};
    if (e.to_m) list.push_back({Role::end, *e.to_m, 0, at});
    const double radius_m = e.kind == EventKind::crater ? crater_radius_m(e.energy_j) : e.radius_m;
    if (radius_m > 0) list.push_back({Role::radius, at + glm::dvec2(radius_m, 0), 0, at});
    return list;
}

struct Drag {
    const Handle& handle;
    glm::dvec2 to;
    double rise_m;  // of the ground from where the handle was to where it goes

    void operator()(Crater& c) const {
        if (handle.role == Role::move) {
            c.x_m = to.x, c.y_m = to.y;
            return;
        }
        const double radius_m = std::max(reach({c.x_m, c.y_m}, to), 0.1);
        c.depth_m *= radius_m / c.radius_m;  // its shape stays
        c.radius_m = radius_m;
    }
    void operator()(Flood& f) const {
        if (handle.role == Role::radius)
            f.radius_m = std::max(reach({f.x_m, f.y_m}, to), 1.0);
        else
            f.x_m = to.x, f.y_m = to.y;
    }
    void operator()(TerrainDecal& d) const { drag_box(d, handle, to); }
    void operator()(Stamp& s) const {
        drag_box(s, handle, to);
        if (handle.role == Role::move && s.mode != StampMode::add) s.base_m += rise_m;
    }
    void operator()(Footprint& f) const {
        const glm::dvec2 away = to - glm::dvec2(f.x_m, f.y_m);
        if (handle.role == Role::move) {
            f.x_m = to.x, f.y_m = to.y;
        } else if (glm::length(away) > 0.01) {
            f.heading_rad = std::atan2(away.x, away.y);
            f.length_m = std::clamp(2 * glm::length(away), 0.05, 50.0);
        }
    }
    void operator()(Slide& s) const {
        if (handle.role == Role::end)
            s.to_m = to;
        else if (handle.role == Role::radius)
            s.radius_m = std::max(reach({s.x_m, s.y_m}, to), 0.1);
        else
            s.to_m += to - glm::dvec2(s.x_m, s.y_m), s.x_m = to.x, s.y_m = to.y;
    }
    void operator()(VolumeDecal& v) const {
        if (handle.role == Role::move)
            v.center_m = {to, v.center_m.z + rise_m};
        else
            drag_space_box(v, handle, to);
    }
    void operator()(Cutout& c) const {
        if (handle.role == Role::radius) {  // of the brush: as far from its middle
            c.radius_m = reach(handle.from_m, to);
            return;
        }
        if (handle.role == Role::anchor) {  // a corner of a hull
            c.corners[size_t(handle.index)] += glm::dvec3(to - handle.at_m, rise_m);
            return;
        }
        if (handle.role != Role::move) return drag_space_box(c, handle, to);
        const glm::dvec2 by = to - handle.at_m;
        c.center_m += glm::dvec3(by, rise_m);
        for (glm::dvec2& dab : c.dabs) dab += by;
        for (glm::dvec3& corner : c.corners) corner += glm::dvec3(by, rise_m);
        if (c.form == CutoutForm::brush || c.form == CutoutForm::convex) c.center_m = Cutout{}.center_m;
    }
    void operator()(SplineDecal& s) const {
        const glm::dvec2 by = to - handle.at_m;
        const size_t count = s.points.size(), i = size_t(handle.index);
        const auto shift = [&](size_t k) {
            s.points[k].x_m += by.x;
            s.points[k].y_m += by.y;
            s.points[k].z_m += rise_m;
        };
        if (handle.role == Role::move) {
            for (size_t k = 0; k < count; ++k) shift(k);
        } else if (handle.role == Role::anchor) {
            for (size_t k = i > 0 ? i - 1 : 0; k <= std::min(i + 1, count - 1); ++k) shift(k);
        } else {
            s.points[i].x_m = to.x;
            s.points[i].y_m = to.y;
            // The one on the other side of the anchor stays in line with it, at its own distance.
            const bool after = i % 3 == 1;
            const size_t anchor = after ? i - 1 : i + 1;
            if (after ? anchor == 0 : anchor + 1 >= count) return;
            SplinePoint& other = s.points[after ? anchor - 1 : anchor + 1];
            const glm::dvec2 middle(s.points[anchor].x_m, s.points[anchor].y_m);
            const double apart_m = glm::length(glm::dvec2(other.x_m, other.y_m) - middle);
            const glm::dvec2 away = middle - to;
            if (!(glm::length(away) > 1e-6)) return;
            const glm::dvec2 place = middle + glm::normalize(away) * apart_m;
            other.x_m = place.x;
            other.y_m = place.y;
        }
    }
    void operator()(Event& e) const {
        const glm::dvec2 from(e.x_m, e.y_m);
        if (handle.role == Role::end) {
            e.to_m = to;
        } else if (handle.role == Role::radius) {
            if (e.kind == EventKind::crater)
                e.energy_j = std::clamp(crater_energy_j(reach(from, to)), 1e5, 1e17);
            else
                e.radius_m = std::max(reach(from, to), 1.0);
        } else {
            if (e.to_m) *e.to_m += to - from;
            e.x_m = to.x, e.y_m = to.y;
        }
    }
};

}  // namespace

std::vector<Handle> handles_of(const OperatorShape& shape) {
    return std::visit([](const auto& kind) { return handles(kind); }, shape);
}

OperatorShape dragged(const OperatorShape& shape, const Handle& handle, const glm::dvec3& to_m,
                      double from_ground_m) {
    OperatorShape moved = shape;
    std::visit(Drag{handle, glm::dvec2(to_m), to_m.z - from_ground_m}, moved);
    return moved;
}

}  // namespace loam::window
