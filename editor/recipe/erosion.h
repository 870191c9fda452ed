// Erosion on square grids: what turns noise into ground. All of it is deterministic and independent of the
// number of threads: the routing is serial, everything parallel gathers from the state before the step.
//
// - Routing: depressions are filled by priority flood (Barnes, Lehman, Mulla 2014), so that every sample
// drains to an outlet.
// - Incision: stream power law, implicit along the drainage tree (Braun and Willett 2013; for terrain
// synthesis Cordonnier et
//   al. 2016), hill slopes limited at the angle of failure in the same sweep.
// - Sediment: transport capacity along many-way flow (Freeman 1991), what exceeds it is laid down: fans and
// valley floors.
// - Thermal: rock steeper than its strength crumbles, debris slides to its angle of repose (Musgrave, Kolb,
// Mace 1989).
#pragma once

#include <cstdint>
#include <vector>

#include "editor/recipe/grid.h"

namespace loam::recipe {

enum class Outlets {
    all_edges,
    lowest_of_edge
};  // the latter: one mouth on the map's edge, the rest of it drains inwards

struct Drainage {
    std::vector<uint32_t> order;     // every sample, each after the one it drains to
    std::vector<uint32_t> receiver;  // steepest lower neighbour on the filled ground; itself at an outlet
    Grid filled_m;                   // the ground with its depressions filled
    Grid area_m2;                    // catchment of each sample, itself included
};
// `wander` > 0 lets chance bend the choice among lower neighbours (Fairfield and Leymarie's "rho8", 1991), so
// that streams do not follow the eight directions of the grid for long; another number, other bends.
[[nodiscard]] Drainage route(const Grid& height_m, double spacing_m, Outlets outlets, uint32_t wander = 0);

struct Incision {
    float uplift_m = 0;     // a step, times `uplift_share`
    float rate = 0;         // lowering a step is rate · sqrt(area) · slope; rate is in 1 (metres a metre)
    float steepest = 1.0f;  // tangent of the failure angle, times `strength`
    const Grid* uplift_share = nullptr;  // null: 1 everywhere
    const Grid* strength = nullptr;      // null: 1 everywhere; also divides the rate
};
// One implicit step. Outlets keep their height.
void incise(Grid& height_m, const Drainage& drainage, double spacing_m, const Incision& incision);

struct SedimentBalance {
    double eroded_m3 = 0, deposited_m3 = 0,
           exported_m3 = 0;  // eroded = deposited + exported, but for rounding
};
struct Transport {
    float capacity = 0.02f;  // sediment a stream can carry: capacity · area^0.6 · slope, m³ a step
    float pick_up = 0.2f;    // share of the free capacity that is taken up from the bed
    float deepest_m = 0.5f;  // most that one step takes off or lays down at a sample
};
// One pass from the heights down. `deposit_m` gathers what was laid down; erosion takes it away again first.
SedimentBalance carry_sediment(Grid& height_m, Grid& deposit_m, const Drainage& drainage, double spacing_m,
                               const Transport& transport);

// Debris above rock. `debris_m` lies on rock whose height is height - debris.
struct Weathering {
    float repose = 0.67f;     // tangent of the debris' angle, 34°
    float rock_limit = 1.3f;  // rock steeper than this crumbles, times `strength`
    float crumble = 0.15f;    // share of the excess that becomes debris a step
    const Grid* strength = nullptr;
};
void weather(Grid& height_m, Grid& debris_m, double spacing_m, const Weathering& weathering, int steps);

// Everything is loose: slides until no slope exceeds `repose` (nearly: steps are limited). Keeps the mass.
void settle(Grid& height_m, double spacing_m, float repose, int steps);

// Soil creep: linear diffusion by `diffusivity_m2` a step in total, split into stable steps.
void creep(Grid& height_m, double spacing_m, float diffusivity_m2);

// Lays valley floors: ground lower than depth(area) above the stream it drains to is filled up to that,
// gently rising away from the stream. `depth_m` is the fill for a catchment of 1 km², growing with a power of
// the area; streams with less than `smallest_area_m2` lay none. What is laid is added to `deposit_m`.
void fill_valleys(Grid& height_m, Grid& deposit_m, const Drainage& drainage, double spacing_m, float depth_m,
                  float smallest_area_m2);

}  // namespace loam::recipe
