// Prints of moving actors: the calls that a game makes when a foot comes down or a wheel rolls on. They are
// gathered and laid with the next frames, one command a frame and a limited number, so that a crowd costs
// what a frame can give. Source: Call of Duty talk, "Dynamic Decals" (footsteps and treads on snow or sand).
#pragma once

#include <cstdint>
#include <deque>
#include <unordered_map>

#include "runtime/base/result.h"
#include "runtime/document/document.h"

namespace loam {

class Session;

struct PrintSettings {
    double lifetime_s = 180;  // then a print is gone; 0: never
    double fade_s = 60;       // of it the last, in which snow fills it and wind takes it
    uint64_t keep = 10'000;   // prints with a lifetime on the map; the oldest are dropped. 0: any number
    uint64_t a_frame = 50;    // are laid with a picture, and with a move of the time; the rest waits. 0: all
};

struct FootDesc {
    double length_m = 0.3;
    double weight_kg = 80;
};
struct TreadDesc {
    double width_m = 0.28;   // of a tyre
    double gauge_m = 1.8;    // between the middles of the two tracks; 0: one track
    double weight_kg = 800;  // on a wheel
};

// How deep the ground gives under a pressure: softness times the pressure over that of a standing man
// (Bekker's pressure-sinkage relation with an exponent of one), to a quarter of a metre.
[[nodiscard]] double sinkage_m(double softness, double weight_kg, double area_m2);

class Prints {
  public:
    explicit Prints(Session& session) : session_(session) {}

    PrintSettings settings;

    // A foot comes down: 0 left, 1 right. No print where the ground is hard; whether there is one is the
    // answer. Of the actor nothing is kept: a foot leaves its print wherever it comes down.
    Result<bool> step(uint64_t actor, int foot, glm::dvec2 at_m, double heading_rad, const FootDesc& desc);
    // The actor's axle is here now: tracks from where it was at its last call. How many pieces there are is
    // the answer. The first call, and one after a leap of more than 20 m, only says where it is.
    Result<int> tread(uint64_t actor, glm::dvec2 at_m, const TreadDesc& desc);
    void lift(uint64_t actor);  // its next tread begins elsewhere

    // Lays what was gathered, all of it or what a frame may. Nothing gathered: nothing happens.
    Result<Dirt> flush();
    Result<Dirt> flush_for_frame();
    [[nodiscard]] size_t waiting() const { return waiting_.size(); }

  private:
    struct Wheel {
        glm::dvec2 at_m{0, 0};
        double carry_m = 0;  // since the last piece
    };
    Result<double> softness_at(glm::dvec2 at_m);
    Result<bool> lay(Footprint print, double weight_kg, double area_m2);

    Result<Dirt> flush(size_t count);

    Session& session_;
    std::deque<Footprint> waiting_;  // no more than are kept
    std::unordered_map<uint64_t, Wheel> wheels_;
    uint32_t count_ = 0;
    uint64_t group_ = 0;  // of one walk: what is laid until something else is edited is undone together
    uint64_t revision_ = 0;
};

}  // namespace loam
