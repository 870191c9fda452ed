// Handles of an operator on the ground: places that can be taken hold of to move, turn and size it, the
// control points of splines among them. Pure functions of the operator; the viewport draws and drags them.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "runtime/document/operator.h"

namespace loam::window {

struct Handle {
    enum class Role { move, turn, side, radius, end, anchor, tangent };
    Role role = Role::move;
    glm::dvec2 at_m{0, 0};
    int index = 0;  // of a spline's control point
    // Where a line leads to it from: a tangent's anchor, else the operator's middle.
    glm::dvec2 from_m{0, 0};
};

// The one that moves all of it comes first.
[[nodiscard]] std::vector<Handle> handles_of(const OperatorShape& shape);

// The operator with one of its handles taken to a place on the ground. What has a height of its own keeps it
// above the ground when it is moved: `from_ground_m` was the ground's height under the handle. Of a spline's
// anchor the tangents come along; the tangent on its other side turns with a tangent. `shape` is the operator
// as it was when the drag began.
[[nodiscard]] OperatorShape dragged(const OperatorShape& shape, const Handle& handle, const glm::dvec3& to_m,
                                    double from_ground_m);

}  // namespace loam::window
