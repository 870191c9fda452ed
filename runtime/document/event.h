// Events: small programs of operators in time. An event keeps its parameters only; its parts (craters,
// decals, prints, slides), each with a life of its own, are made of them when it is read, so that an event
// costs memory on disk for its parameters, not for the ground it changes. Parts are a function of the
// parameters alone. Source: Call of Duty talk, "Large Map Events".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec2.hpp>

namespace loam {

struct Operator;

enum class EventKind {
    crater,       // one impact
    crater_line,  // impacts from a place to another, one after another
    barrage,      // impacts all over a square
    crash,        // a furrow from a place to another, a burning crater at its end, scorch and debris
    landslide,    // soil from a place to another: lumps, each of which keeps its volume
    flood         // the water rises within a circle
};
inline constexpr int kEventKinds = 6;
[[nodiscard]] std::string_view name_of(EventKind kind);  // as commands have it

// What a kind does not use has no meaning for it and is not written.
struct Event {
    EventKind kind = EventKind::crater;
    double x_m = 0, y_m = 0;
    // crater_line, crash, landslide: where it ends. A landslide without one runs down the base map's ground;
    // the document finds out where to.
    std::optional<glm::dvec2> to_m;
    double energy_j = 4.0e11;  // of an impact; of a barrage the largest; 1e5 … 1e17
    double radius_m = 0;       // barrage: half a side; landslide: of the scar; flood: of the circle
    int count = 0;             // crater_line, barrage: impacts; crash: pieces of debris
    double width_m = 6;        // crash: of the furrow
    double volume_m3 = 0;      // landslide
    double level_m = 0;        // flood: of the water at the end
    double from_m = 0;         // flood: and at the start
    std::string layer;         // flood: of the wet ground; empty: as it was
    double start_s = 0;
    double duration_s = 0;
    double cool_s = 120;   // impacts and crash: embers go out; 0: never
    double weather_s = 0;  // impacts: from fresh to weathered; 0: never
    uint32_t seed = 0;
    uint16_t layer_number = 0;  // of `layer`; the document sets it
    bool operator==(const Event&) const = default;
};

// The defaults of a kind: what a user gets who names nothing but the place.
[[nodiscard]] Event default_event(EventKind kind);

// Of the crest of a crater: an explosion of W kilograms of TNT (4.184 MJ each) at the surface leaves one 0.8
// W^(1/3) metres across (Kinney and Graham, Explosive Shocks in Air, 1985).
[[nodiscard]] double crater_radius_m(double energy_j);
[[nodiscard]] double crater_energy_j(double radius_m);

inline constexpr int kMostEventParts = 20'000;

// In order of evaluation; ids, order and `enabled` are the event's.
[[nodiscard]] std::vector<Operator> parts_of(const Operator& event);
// Until nothing of it moves any more, which is later than its duration where embers cool or craters weather.
[[nodiscard]] double end_s(const Event& event);

}  // namespace loam
