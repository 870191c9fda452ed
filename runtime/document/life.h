// When an operator is there, and how it ages. Source: Call of Duty talk, "Dynamic Decals" (a virtual texture
// is a static cache that can afford some dynamicity), "Large Map Events".
//
// What is shown changes in steps, sixteen a ramp, so that however often the time moves an operator is
// composed again a bounded number of times in its life, and a page composed at any moment of a step has the
// same bits. A state is a function of the time alone: winding back shows what was there.
#pragma once

#include <limits>

namespace loam {

struct Life {
    static constexpr double kEver_s = std::numeric_limits<double>::infinity();
    double from_s = -kEver_s, until_s = kEver_s;  // there from the first to, not at, the second
    double rise_s = 0;                            // grows to its strength in this time after from_s
    double fade_s = 0;                            // is lost in this time before until_s
    double cool_s = 0;     // craters: the heat is gone this long after from_s; 0: never
    double weather_s = 0;  // craters: weathered this long after from_s; 0: never

    bool operator==(const Life&) const = default;
    [[nodiscard]] bool ever() const { return *this == Life{}; }
};

inline constexpr int kLifeSteps = 16;

struct LifeState {
    bool there = true;
    double strength = 1;  // 1/16 … 1
    double heat = 1;      // share of the crater's that is left
    double age = 0;       // of a crater: 0 fresh … 1 weathered
    // The times of this state: from the first to, not at, the second.
    double since_s = -Life::kEver_s, until_s = Life::kEver_s;
};
[[nodiscard]] LifeState state_at(const Life& life, double time_s);

}  // namespace loam
