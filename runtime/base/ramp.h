// The cubic step from 0 at 0 to 1 at 1, level at both ends.
#pragma once

#include <algorithm>

namespace loam {

[[nodiscard]] inline double ramp(double t) {
    t = std::clamp(t, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace loam
