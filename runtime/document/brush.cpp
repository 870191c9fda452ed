#include <algorithm>

#include "runtime/document/command.h"

namespace loam {

double brush_falloff(double t, double hardness) {
    // The flat part ends a little inside the rim even at hardness 1, so that the fall stays a curve and not a
    // step.
    const double flat = 0.98 * std::clamp(hardness, 0.0, 1.0);
    if (!(t < 1)) return 0;
    if (t <= flat) return 1;
    const double u = (t - flat) / (1 - flat);
    return 1 - u * u * (3 - 2 * u);
}

}  // namespace loam
