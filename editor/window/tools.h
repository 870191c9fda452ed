// The tools: from what the left mouse button does over the ground to commands. No window, no device.
//
// A stroke is everything between press and release; its commands share one group and are undone together.
// Modifiers while pressing: Ctrl turns raise into lower and back, picks the height (flatten) or the layer
// (paint) under the cursor, closes holes instead of cutting them; Shift smooths.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "editor/window/stroke.h"
#include "runtime/document/command.h"
#include "runtime/document/spline_path.h"

namespace loam::window {

enum class Tool {
    raise,
    lower,
    smooth,
    flatten,
    paint,
    crater,
    footprints,
    decal,
    road,
    stamp,
    cutout,
    event
};
inline constexpr int kToolCount = 12;
[[nodiscard]] std::string_view tool_name(Tool tool);   // "raise": also the action's name
[[nodiscard]] std::string_view tool_title(Tool tool);  // "Raise"

struct Brush {
    double radius_m = 10;
    double strength = 0.5; // 0 … 1 of what the tool can do in a dab
    double hardness = 0.4;
};

struct DecalDesc {
    double stretch = 1;  // length over width; the brush's radius is half the width
    double rough = 0.3;
    double displacement_m = 0;  // of the ground under it
    bool ellipse = false;
};

struct RoadDesc {
    bool carve = true;
    double shoulder_m = 4;
    double edge = 0.3; // share of the half width
};

struct StampDesc {
    std::string image;  // of the project
    StampMode mode = StampMode::add;
    double height_m = 8;  // of white
    double stretch = 1;   // length over width; the brush's radius is half the width
    bool lay_layer = false;
    double layer_from = 0.5;
    bool colour = false;
};

struct CutoutDesc {
    CutoutForm form = CutoutForm::brush;  // or box, or cylinder
    double stretch = 1;                   // length over width; the brush's radius is half the width
    double depth_m = 4;                   // of a volume, below the ground and above it
};

struct ToolSettings {
    std::array<Brush, kToolCount> brushes; // a tool keeps its own
    double flatten_target_m = 0;
    bool flatten_fixed = false;            // else the height where the stroke began
    std::string layer;
    bool use_tint = false;
    bool transitions = false;              // painting places them where layers meet
    glm::vec3 tint{1, 1, 1};               // sRGB-encoded
    GroundMask mask;                       // of painting and filling
    double crater_depth_share = 0.4;       // of the radius
    double crater_heat = 0;                // seen on maps with the thermal or the emissive channel
    uint32_t seed = 1;
    GaitDesc gait;
    DecalDesc decal;
    // Of decals and roads; empty: the layer.
    std::string function;
    std::map<std::string, double> parameters;
    RoadDesc road; // the brush's radius is half the width
    StampDesc stamp;
    CutoutDesc cutout;
    EventKind event_kind = EventKind::crater;
    std::array<Event, kEventKinds> events;  // of each kind the next one's parameters
    double flood_rise_m = 3;                // above the ground where it is placed
};

struct ToolInput {
    std::optional<glm::dvec3> ground; // under the cursor
    bool pressed = false, held = false, released = false; // left button on the viewport
    bool ctrl = false, shift = false;
    double moved_px = 0;              // from where the button went down
    double camera_yaw_rad = 0;
    double dt_s = 0;
    double time_s = 0;  // of the map: when an event begins
};

// What the tools ask the document.
struct ToolQueries {
    std::function<uint64_t()> next_group;
    std::function<std::string(double x_m, double y_m)> layer_at;
};

class ToolController {
  public:
    explicit ToolController(ToolQueries queries);

    Tool tool = Tool::raise;
    ToolSettings settings;
    [[nodiscard]] Brush& brush() { return settings.brushes[size_t(tool)]; }
    [[nodiscard]] const Brush& brush() const { return settings.brushes[size_t(tool)]; }

    // One frame's input gives the commands to apply now, at most one of each kind.
    std::vector<Command> update(const ToolInput& input);
    [[nodiscard]] bool stroking() const { return stroking_; }
    void cancel(); // also drops a road that is being drawn

    // A road is drawn place by place: a press sets one or takes hold of one, a press on the last ends it. Nothing where it
    // has no two places yet.
    [[nodiscard]] bool drawing_road() const { return !road_.empty(); }
    std::optional<Command> end_road();

    // What to draw around the cursor.
    struct Ring {
        glm::dvec2 center_m{0};
        double radius_m = 0, inner_share = 0;
    };
    [[nodiscard]] std::optional<Ring> ring(const ToolInput& input) const;
    struct Outline {
        std::vector<glm::dvec2> places_m;
        bool closed = false;
    };
    [[nodiscard]] std::vector<Outline> outlines(const ToolInput& input) const; // of what would be placed

    // Height that one dab of full strength moves: grows with the brush, so that a hill keeps its shape at any size.
    [[nodiscard]] static double dab_height_m(const Brush& brush) { return brush.strength * brush.radius_m * 0.1; }
    static constexpr double kSpacingShare = 0.25;   // of the radius, between dabs
    static constexpr double kHeldDabsPerSecond = 14;
    static constexpr double kLargestRadius_m = 2000, kSmallestRadius_m = 0.1;

  private:
    void begin(const ToolInput& input);
    std::optional<Command> sculpt(const ToolInput& input);
    std::optional<Command> paint(const ToolInput& input);
    std::optional<Command> crater(const ToolInput& input);
    std::optional<Command> footprints(const ToolInput& input);
    std::optional<Command> decal(const ToolInput& input);
    std::optional<Command> road(const ToolInput& input);
    std::optional<Command> stamp(const ToolInput& input);
    std::optional<Command> cutout(const ToolInput& input);
    std::optional<Command> event(const ToolInput& input);
    [[nodiscard]] Event event_at(const ToolInput& input) const;
    [[nodiscard]] bool places_box() const {
        return tool == Tool::decal || tool == Tool::stamp ||
               (tool == Tool::cutout && settings.cutout.form != CutoutForm::brush);
    }
    [[nodiscard]] glm::dvec2 box_half_m() const;                     // of what is being placed
    [[nodiscard]] double heading_rad(const ToolInput& input) const;  // of what is being placed
    [[nodiscard]] TerrainDecal decal_at(const ToolInput& input) const;
    [[nodiscard]] Stamp stamp_at(const ToolInput& input) const;
    [[nodiscard]] DecalMaterial material() const;
    [[nodiscard]] std::vector<SplinePoint> road_points(const std::vector<glm::dvec3>& places) const;
    std::vector<glm::dvec2> dabs(const ToolInput& input, bool also_resting);
    [[nodiscard]] double crater_radius_m(const ToolInput& input) const;

    ToolQueries queries_;
    bool stroking_ = false, picking_ = false, closing_ = false;
    Tool stroke_tool_ = Tool::raise; // after modifiers
    uint64_t group_ = 0;
    uint32_t command_count_ = 0;
    StrokeSpacer spacer_;
    Gait gait_;
    double resting_s_ = 0, target_m_ = 0;
    glm::dvec2 center_m_{0};
    std::vector<glm::dvec3> road_; // places so far
    size_t held_place_ = 0;
    bool held_last_ = false;       // the press took hold of the place that was last already
};

} // namespace loam::window
