#include "runtime/document/life.h"

#include <algorithm>

namespace loam {

namespace {

// How many of the moments start + length * j/16, j = first … last, have come; the state lasts from the last
// of them to the next.
int come(double start_s, double length_s, int first, int last, double time_s, LifeState& state) {
    int count = 0;
    for (int j = first; j <= last; ++j) {
        const double moment_s = start_s + length_s * j / kLifeSteps;
        if (moment_s <= time_s) {
            state.since_s = std::max(state.since_s, moment_s);
            ++count;
        } else {
            state.until_s = std::min(state.until_s, moment_s);
        }
    }
    return count;
}

double share(int steps) {
    return double(steps) / kLifeSteps;
}

}  // namespace

LifeState state_at(const Life& life, double time_s) {
    LifeState state;
    const int risen = come(life.from_s, life.rise_s, 0, kLifeSteps - 1, time_s, state);
    const int faded = come(life.until_s - life.fade_s, life.fade_s, 1, kLifeSteps - 1, time_s, state);
    const bool gone = come(life.until_s, 0, 0, 0, time_s, state) > 0;
    if (risen == 0 || gone) {
        // Nothing that happens meanwhile shows.
        state = {.there = false};
        (gone ? state.since_s : state.until_s) = gone ? life.until_s : life.from_s;
        return state;
    }
    state.strength = share(std::min(risen, life.fade_s > 0 ? kLifeSteps - faded : kLifeSteps));
    if (life.cool_s > 0) state.heat = 1 - share(come(life.from_s, life.cool_s, 1, kLifeSteps, time_s, state));
    if (life.weather_s > 0)
        state.age = share(come(life.from_s, life.weather_s, 1, kLifeSteps, time_s, state));
    return state;
}

}  // namespace loam
