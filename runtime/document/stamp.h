// Stamps: a picture laid on the ground as height, material and colour, at any place, turn and scale, as often
// as wanted and moved later like any other operator. Heights are evaluated where they are sampled; material
// and colour go through the index map, at its spacing. Source: Leadwerks, "Virtual Texture Terrain", stamps.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace loam {

struct StampImage;

enum class StampMode {
    add,    // white raises by height_m
    max,    // the ground or the stamp, whichever is higher
    min,    // … lower
    blend,  // the stamp
};

struct Stamp {
    std::string image;  // of the project: stamps/NAME.stamp
    double x_m = 0, y_m = 0;
    glm::dvec2 half_m{50, 50};  // ±0.01 … ±5000; a negative one mirrors
    double heading_rad = 0;     // clockwise from north, where the picture's top points
    StampMode mode = StampMode::add;
    double height_m = 20;     // of white above black; negative: below
    double base_m = 0;        // height of black, but for `add`
    double strength = 1;      // of the heights, 0 … 1
    double edge = 0.1;        // share of the smaller half side over which it fades
    std::string layer;        // laid where the picture is at least layer_from; empty: none
    double layer_from = 0.5;  // 0 … 1
    bool colour = false;      // the picture's colours multiply the tint
    // Set by the document. Without a picture a stamp does nothing.
    std::shared_ptr<const StampImage> picture;
    uint16_t layer_number = 0;
    bool operator==(const Stamp& o) const {
        return image == o.image && x_m == o.x_m && y_m == o.y_m && half_m == o.half_m &&
               heading_rad == o.heading_rad && mode == o.mode && height_m == o.height_m &&
               base_m == o.base_m && strength == o.strength && edge == o.edge && layer == o.layer &&
               layer_from == o.layer_from && colour == o.colour;
    }
};

// What a stamp has at an offset from its middle, in metres east and north.
struct StampSample {
    double height = 0;  // of the picture, 0 … 1: cubic, through its texels
    double weight = 0;  // of everything, 0 … 1: the picture's cover and the fading edge; 0 outside
    glm::dvec3 color{1};
};
// The stamp outlives it.
class StampSampler {
  public:
    explicit StampSampler(const Stamp& stamp);
    [[nodiscard]] StampSample operator()(double dx_m, double dy_m) const;
    // The height of the ground with the stamp on it.
    [[nodiscard]] double stamped_m(double ground_m, double dx_m, double dy_m) const;

  private:
    const Stamp& stamp_;
    double sin_, cos_;
};
[[nodiscard]] bool changes_heights(const Stamp& stamp);
[[nodiscard]] bool changes_index(const Stamp& stamp);

}  // namespace loam
