// Commands: plain data, one JSON object a line. The window's tools, the Python module, the command line and
// the journal all make these.
//
//   {"cmd":"sculpt","mode":"raise","dabs":[[x,y],…],"radius_m":10,"strength_m":0.5,"hardness":0.5}
//       modes: raise, lower (strength_m a dab), smooth, flatten (strength 0…1; flatten has "target_m");
//       either name of the strength is read in any mode
//   {"cmd":"paint","dabs":[[x,y],…],"radius_m":5,"layer":"rock","strength":1,"hardness":0.5,"seed":1,
//    "tint":[r,g,b],"transitions":false, MASK}   ("layer" or "tint" or both)
//       transitions: the project's transitions are placed where layers meet, under the dabs and beside them
//       (transitions.h)
//   {"cmd":"fill","rect":[x0,y0,x1,y1],"layer":"rock","tint":[r,g,b],"replace":"grass","strength":1,"seed":1,
//    "transitions":false, MASK}
//       the same over a rectangle (without one: the map); only texels of "replace", if that is given; at most
//       33 million texels: a session cuts larger ones into a group (editor/fill.h)
//       MASK, of the base map's ground: "min_slope_rad":0,"max_slope_rad":1.5708,"min_height_m":-16384,
//       "max_height_m":16384,"noise":0,"noise_size_m":8 (GroundMask below says what they mean)
//   {"cmd":"crater","x":…,"y":…,"radius_m":10,"depth_m":4,"seed":7,"heat":0.8}
//   {"cmd":"footprints","prints":[{"x":…,"y":…,"heading_rad":…,"foot":0},…],"length_m":0.3,"depth_m":0.03,"seed":1}
//       a print may have its own length_m, depth_m and seed; else print i has seed + i. foot: 0 left, 1
//       right, 2 a piece of a tyre's track, 3 of a furrow. "keep":10000 drops the oldest of those with an end
//   {"cmd":"decal","x":…,"y":…,"half_m":[4,2],"heading_rad":0,"outline":"rectangle","displacement_m":0,
//   MATERIAL}
//   {"cmd":"spline","points":[[x,y,z,width,roll],…],"fade_m":0,"carve":0,"shoulder_m":3, MATERIAL}
//       control points of cubic Bezier pieces: 4, 7, 10, …; without a width they take "width_m", without a
//       roll 0, and a carve needs every z
//   {"cmd":"volume","at":[x,y,z],"half_m":[4,2,3],"direction":[0,0,-1],"roll_rad":0,"outline":"ellipse",
//   MATERIAL}
//       MATERIAL:
//       "layer":"rock","colour":[1,1,1],"gloss":0.2,"metalness":0,"tile_m":0,"opacity":1,"edge":0.2,
//       "rough":0,"seed":0,"channels":{"albedo":1,"normal":1,"gloss":1,"metalness":1,"occlusion":1}
//       (ground_decal.h says what they mean); all of it may be left out
//   {"cmd":"stamp","image":"ridge","x":0,"y":0,"half_m":[50,50],"heading_rad":0,"mode":"add","height_m":20,
//       "base_m":0,"strength":1,"edge":0.1,"layer":"rock","layer_from":0.5,"colour":false}  (stamp.h)
//   {"cmd":"cutout","form":"box","at":[x,y,z],"half_m":[4,4,3],"direction":[0,0,-1],"roll_rad":0,"fill":false}
//       forms: box and cylinder; "convex" with "corners":[[x,y,z],…]; "brush" with "dabs":[[x,y],…] and
//       "radius_m":5. A fill closes what those before it opened  (cutout.h)
//   {"cmd":"slide","x":0,"y":0,"radius_m":10,"to":[50,0],"to_radius_m":15,"volume_m3":100,"way":1}
//   {"cmd":"flood","x":0,"y":0,"radius_m":200,"level_m":12,"from_m":7,"layer":"mud","way":1}  (earth.h)
//   {"cmd":"event","event":"crater","x":0,"y":0,"energy_j":6.5e10,"start_s":0,"duration_s":0,"cool_s":120,
//    "weather_s":0,"seed":1}
//       others: crater_line with "to":[x,y] and "count"; barrage with "radius_m" and "count"; crash with
//       "to", "width_m" and "count"; landslide with "to" (without: downhill), "radius_m" and "volume_m3";
//       flood with "radius_m", "level_m", "from_m" and "layer"  (event.h)
//
//   LIFE, of all operators but events: "life":{"from_s":0,"until_s":60,"rise_s":0,"fade_s":0,"cool_s":0,
//       "weather_s":0}  (life.h); an edit without one keeps what there is
//
//   {"cmd":"transition","name":"edge","from":"grass","to":"rock","threshold":0.5}   makes one, or changes
//   what is
//       given of it; {"cmd":"transition","name":"edge","remove":true}   (transitions.h)
//   {"cmd":"edit","id":12,"kind":"decal", …}   replaces all parameters; kinds: crater, footprint, decal,
//       spline, volume, stamp, cutout, slide, flood, event
//   {"cmd":"reorder","id":12,"order":3}   evaluated in ascending order, then id; a new operator's order is
//   its id
//   {"cmd":"operator","id":12,"enabled":false}    {"cmd":"remove","id":12}
//   {"cmd":"time","time_s":12.5}   shows the map as it is then; like a camera it is not undone
//   {"cmd":"undo"}    {"cmd":"redo"}
// Required: mode and dabs; form; target_m to flatten; layer or tint; x and y (of a fill no dabs); prints;
// points; at; id, enabled and order; name. The rest have the defaults below. Any command may carry "group":
// n. Consecutive commands of one group undo together.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/base/result.h"
#include "runtime/document/operator.h"

namespace loam {

enum class SculptMode { raise, lower, smooth, flatten };

struct SculptCommand {
    SculptMode mode = SculptMode::raise;
    std::vector<glm::dvec2> dabs;
    double radius_m = 10;   // 0.01 … 5000
    double strength = 0.5;  // metres a dab for raise and lower; share 0…1 for smooth and flatten
    double hardness = 0.5;  // 0: falls off from the centre; 1: flat to the rim
    double target_m = 0;    // flatten
};

// Where the ground lets paint stick, and how much of it.
struct GroundMask {
    double min_slope_rad = 0, max_slope_rad = 1.5707963267948966;
    double min_height_m = -kHighest_m, max_height_m = kHighest_m;
    double noise = 0;         // 0: all of the place; 1: only in patches
    double noise_size_m = 8;  // of the patches, 0.5 … 5000

    static constexpr double kHighest_m = 16'384;
    bool operator==(const GroundMask&) const = default;
};

struct PaintCommand {
    std::vector<glm::dvec2> dabs;
    double radius_m = 5;
    std::optional<std::string> layer;
    std::optional<glm::dvec3> tint;  // sRGB-encoded 0…1
    double strength = 1;             // share of texels (layer, dithered by position and seed) or of the tint
    double hardness = 0.5;
    GroundMask mask;
    uint32_t seed = 0;
    bool transitions = false;
};

// Texels from a rectangle's lower edges up to, but not at, its upper ones, so that adjoining fills meet once.
struct FillCommand {
    std::optional<WorldRect> rect;  // none: the map
    std::optional<std::string> layer;
    std::optional<glm::dvec3> tint;      // as PaintCommand's
    std::optional<std::string> replace;  // only texels of this layer
    double strength = 1;
    GroundMask mask;
    uint32_t seed = 0;
    bool transitions = false;
};

struct CraterCommand {
    Crater crater;
    Life life;
};
struct FootprintsCommand {
    std::vector<Footprint> prints;
    Life life;  // of each
    // Of the prints that end some day, those of earlier commands included, the oldest beyond this many are
    // removed. 0: none.
    uint64_t keep = 0;
};
struct AddOperatorCommand {  // all but craters and footprints
    OperatorShape shape;
    Life life;
};
struct EditOperatorCommand {
    uint64_t id = 0;
    OperatorShape shape;
    std::optional<Life> life;  // none: as it is
};
struct ReorderCommand {
    uint64_t id = 0, order = 0;
};
struct SetOperatorCommand {
    uint64_t id = 0;
    bool enabled = true;
};
struct RemoveOperatorCommand {
    uint64_t id = 0;
};
// The layer list's entry of this name that is made of two others.
struct TransitionCommand {
    std::string name;
    std::string from, to;  // layers with textures; empty: as they are
    std::optional<double> threshold;
    bool remove = false;  // its texels show the nearer of the two; nothing else is given then
};
struct TimeCommand {
    double time_s = 0;
};
// The text of a decals' function (decal_function.h), saved and shown once it compiles. Not undone: the one
// before is given again.
struct FunctionCommand {
    std::string name, text;
};
struct UndoCommand {};
struct RedoCommand {};

using CommandBody = std::variant<SculptCommand, PaintCommand, FillCommand, CraterCommand, FootprintsCommand,
                                 AddOperatorCommand, EditOperatorCommand, ReorderCommand, SetOperatorCommand,
                                 RemoveOperatorCommand, TransitionCommand, TimeCommand, FunctionCommand,
                                 UndoCommand, RedoCommand>;

struct Command {
    CommandBody body;
    uint64_t group = 0;  // 0: a group of its own
};

// One line of JSON. Unknown commands, unknown keys, missing or non-finite numbers are refused with what and
// where.
[[nodiscard]] Result<Command> parse_command(std::string_view json_line);
// Reading the text back gives the same command, numbers bit for bit.
[[nodiscard]] std::string to_json(const Command& command);
// The ranges of all numbers; `apply` and parse_command refuse what does not pass.
[[nodiscard]] Status check_command(const Command& command);
[[nodiscard]] Status check_shape(const OperatorShape& shape);
[[nodiscard]] Status check_life(const Life& life);

// Brush falloff, 1 at the centre to 0 at the rim; `t` = distance / radius. Smooth (C1) for any hardness.
[[nodiscard]] double brush_falloff(double t, double hardness);

}  // namespace loam
