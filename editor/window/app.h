// The editor without its window: tools, camera, actions, what the panels show. It works through a Session, which needs
// no device until something is drawn, so all of this runs in tests without a display.
//
// Longer than 200 lines of comments and members would suggest, because every panel reads it; the panels are free functions
// (panels.h) and change it through the calls below.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "editor/fill.h"
#include "editor/session.h"
#include "editor/window/camera_controller.h"
#include "editor/window/handles.h"
#include "editor/window/import_job.h"
#include "editor/window/tools.h"
#include "ui/shortcuts.h"
#include "ui/widgets.h"

namespace loam::window {

struct ViewSettings {
    Shading shading = Shading::virtual_texture;
    DebugView debug = DebugView::none;
    bool adaptive = true;      // render scale follows the frame-time goal while things move
    double fixed_scale = 1.0;  // when not adaptive
    bool show_ring = true;
    Quality quality = Quality::low;       // what the renderer has or is getting
    PageFormat page_format = PageFormat::rgba8;
};

// What the window knows of the frames, for the status line.
struct FrameInfo {
    double frame_ms = 0;      // of the last moving frame
    float render_scale = 1;
    uint32_t pages_pending = 0;
    uint64_t redraws = 0, scene_frames = 0;
    bool resting = false;
    std::string device;
};

struct HistoryStep { // commands of one group
    std::string title;
    uint64_t last_sequence = 0;
    int command_count = 0;
    bool applied = true;
};

struct ObjectRow {  // of the outliner
    uint64_t id = 0, order = 0;
    std::string title;  // "Stamp 12 · ridge"
    bool enabled = true;
    WorldRect bounds;  // of all that it changes
    // Of an event or an operator with a life: seconds of its beginning, of the end of its motion, and of its
    // end.
    bool timed = false;
    double from_s = 0, moved_s = 0, until_s = 0;
};

// The text of a decals' function that is being written.
struct FunctionText {
    std::string name, text;
    std::string saved;  // as it is in the project, and on the ground
    std::string tried;  // that was compiled last
    std::string error;  // of it
    double changed_s = 0;
};

// Asked for by actions, done by the window's loop between two frames.
struct Wish {
    enum class Kind { none, open_project, export_picture };
    Kind kind = Kind::none;
    std::filesystem::path path;
    int width = 0, height = 0;
};

class App {
  public:
    App(Session& session, const ui::Theme& theme);
    ~App() { leave_function(); }

    // --- parts; panels read and change these ---
    Session& session;
    ui::Shortcuts shortcuts;
    ToolController tools;
    CameraController camera;
    ViewSettings view;
    FrameInfo frame;
    Wish wish;
    std::vector<std::string> layer_names;
    std::vector<ui::TextureId> layer_pictures; // 0 or missing: none
    std::vector<std::string> shader_errors;
    std::string path_text;                     // of the dialogs
    int export_width = 1920, export_height = 1080;
    std::string new_layer_name;                // of the dialog; empty: the folder's
    double new_layer_tile_m = 2;
    uint64_t transition_group = 0;  // of a slider that is being dragged
    std::string layer_search;    // of the palette
    std::string new_stamp_name;  // likewise; empty: the file's
    std::string object_search;   // of the outliner
    uint64_t selected_object = 0;  // an operator's id; 0, or one that is gone: none
    uint64_t object_group = 0;     // of a parameter that is being dragged
    bool play_placed = true;       // the time runs once an event is placed
    bool quit = false;

    // --- edits ---
    // Applies, remembers what changed, reports; false after an error, which is shown.
    bool apply(const Command& command);
    void undo_step();
    void redo_step();
    // Undoes or redoes until `sequence` is the newest applied command (0: none).
    void go_to(uint64_t sequence);
    void change_settings(const ProjectSettings& settings);
    // With the paint tool's layer, tint and masks: `replaced_layer`'s texels (0: all), square by square.
    void start_fill();
    void advance_fill();  // a few squares; once a frame
    void cancel_fill();
    [[nodiscard]] bool filling() const { return fill_.has_value(); }
    [[nodiscard]] double filled_share() const { return fill_ ? fill_->share() : 0; }
    int replaced_layer = 0;
    int transition_from = 0, transition_to = 1; // of the next one to be made; among the layers with textures
    void set_tool(Tool tool);
    void set_layer(int index);
    // Imports, one at a time, while everything else goes on; what comes of them is said.
    void import_layer(const AddLayerRequest& request);  // then it is the paint tool's
    void import_imagery(const std::filesystem::path& file);
    void import_stamp(const std::filesystem::path& file,
                      const std::string& name);                              // then it is the stamp tool's
    [[nodiscard]] const ImportJob* import() const { return import_.get(); }  // null: none is running
    void cancel_import();
    void advance_import();                 // once a frame
    std::vector<std::string> stamp_names;  // of the project
    [[nodiscard]] int layer() const; // of the paint tool, -1: none
    void change_quality(Quality quality, PageFormat format); // of the virtual texture
    void resize_brush(double factor);
    void strengthen_brush(double factor);
    [[nodiscard]] const std::vector<HistoryStep>& history(); // oldest first
    [[nodiscard]] std::string layer_name_at(double x_m, double y_m);
    [[nodiscard]] double height_at(double x_m, double y_m);

    // --- the outliner (outliner.cpp) ---
    [[nodiscard]] const std::vector<ObjectRow>& objects();  // last evaluated first
    [[nodiscard]] const ObjectRow* selected_row();          // null: none
    void show_object(uint64_t id, bool shown);
    void remove_object(uint64_t id);
    void move_object(uint64_t id, bool later);  // past its neighbour in the order of evaluation
    void frame_object();                        // the selected one

    [[nodiscard]] const Operator* selected_operator();  // null: none

    // A new shape of the selected operator, while a slider is dragged; none: nothing was changed.
    void edit_selected(const std::optional<OperatorShape>& shape, ui::Ui& ui);

    // --- functions of decals (function_panel.cpp) ---
    bool show_functions = false;
    FunctionText functions;
    std::string new_function_name;  // of the dialog
    [[nodiscard]] const std::vector<std::string>& function_names();
    void edit_function(const std::string& name);  // in the panel; what was written there before is kept
    void try_function();    // saves and shows the text if it compiles, else keeps it beside
    void leave_function();  // what was written just now is tried
    bool poll_functions();                        // twice a second; whether something is shown otherwise

    // --- the time (timeline.cpp) ---
    bool show_timeline = false;
    bool playing = false;
    double play_speed = 1;
    [[nodiscard]] double time_s() const;
    void set_time(double time_s);
    void play(bool on);
    void advance_time(double dt_s);             // once a frame
    void event_placed(const Command& command);  // nothing for any other command
    [[nodiscard]] double timeline_end_s();
    [[nodiscard]] const std::vector<ObjectRow>& timed_objects();  // by beginning, without prints

    // --- actions: menu entries, shortcuts and buttons ---
    void run(std::string_view action, ui::Ui& ui);
    // Keys that the interface did not use. While flying the letter keys steer.
    void handle_keys(const std::vector<ui::Event>& keys, ui::Ui& ui);

    // --- the viewport ---
    // Feeds mouse and keyboard to camera and tools; commands are applied before it returns.
    void viewport_input(ui::Ui& ui, const ui::ViewportResponse& response, double dt_s);
    [[nodiscard]] const std::optional<glm::dvec3>& cursor_ground() const { return cursor_; }
    [[nodiscard]] std::optional<ToolController::Ring> ring() const { return ring_; }
    [[nodiscard]] const std::vector<ToolController::Outline>& outlines() const { return outlines_; }
    // Of the selected operator, and which of them is under the cursor or held; -1: none.
    [[nodiscard]] const std::vector<Handle>& handles() const { return handles_; }
    [[nodiscard]] int hot_handle() const { return handle_held_ ? held_handle_ : hot_handle_; }
    [[nodiscard]] bool flying() const { return drag_ == CameraInput::Drag::look; }
    // A frame must follow at once: something moves by itself or is being held down.
    [[nodiscard]] bool busy() const {
        return playing || handle_held_ || filling() || tools.stroking() || camera.moving() ||
               drag_ != CameraInput::Drag::none;
    }

    // --- messages ---
    void say(std::string message) { message_ = std::move(message); }
    void fail(std::string message);
    [[nodiscard]] const std::string& message() const { return message_; }
    [[nodiscard]] std::vector<std::string> take_errors() { return std::exchange(errors_, {}); }

    // True once after the scene changed in a way that a new picture shows.
    [[nodiscard]] bool take_scene_changed() { return std::exchange(scene_changed_, false); }
    void scene_changed() { scene_changed_ = true; }
    [[nodiscard]] bool take_settings_changed() { return std::exchange(settings_changed_, false); }
    [[nodiscard]] bool take_quality_changed() { return std::exchange(quality_changed_, false); }
    std::function<void(const Command&)> on_command; // after it was committed

  private:
    void bind_shortcuts();
    void find_cursor_ground(const ui::ViewportResponse& response);
    CameraInput camera_input(ui::Ui& ui, const ui::ViewportResponse& response, double dt_s);
    void choose_drag(ui::Ui& ui, const ui::ViewportResponse& response);
    void find_handles(const ui::ViewportResponse& response);
    void drag_handle(const ui::ViewportResponse& response);
    [[nodiscard]] double base_height_at(glm::dvec2 at_m) const;  // without operators
    [[nodiscard]] glm::dvec2 base_place_under(const ui::ViewportResponse& response, glm::dvec2 near_m) const;

    void start_import(ImportJob::Steps steps);

    std::unique_ptr<ImportJob> import_;
    std::optional<Fill> fill_;
    std::string message_;
    std::vector<std::string> errors_;
    std::vector<HistoryStep> history_;
    uint64_t history_revision_ = ~uint64_t{0};
    std::vector<ObjectRow> objects_;
    std::vector<ObjectRow> timed_objects_;
    std::optional<uint64_t> objects_revision_, timed_objects_revision_;
    std::optional<Operator> selected_operator_;
    ObjectRow selected_row_;
    uint64_t selected_operator_revision_ = ~uint64_t{0};
    void read_layer_names();
    std::vector<std::string> function_names_;
    uint64_t function_names_revision_ = ~uint64_t{0};

    bool scene_changed_ = true, settings_changed_ = false, quality_changed_ = false;

    CameraInput::Drag drag_ = CameraInput::Drag::none;
    bool tool_drag_ = false;
    ui::Vec2 mouse_{-1, -1}, press_mouse_{0, 0};
    std::optional<glm::dvec3> cursor_;
    std::optional<ToolController::Ring> ring_;
    std::vector<ToolController::Outline> outlines_;
    std::vector<Handle> handles_;
    int hot_handle_ = -1, held_handle_ = -1;
    bool handle_held_ = false;
    OperatorShape handle_shape_;  // when it was taken hold of
    Handle handle_start_;
    glm::dvec2 handle_to_m_{0}, handle_mouse_m_{0};  // where it is; what of the ground the mouse took hold of
    uint64_t handle_group_ = 0;
    uint64_t cursor_revision_ = ~uint64_t{0};
    double cursor_time_s_ = 0;
    glm::dvec3 cursor_camera_{0};
    double cursor_yaw_ = 0, cursor_pitch_ = 0;
};

// "Crater", "Road".
[[nodiscard]] std::string_view kind_title(const OperatorShape& shape);
[[nodiscard]] std::string_view title_of(EventKind kind);
// "Raise · 24", from a command's JSON line.
[[nodiscard]] std::string command_title(std::string_view json);

} // namespace loam::window
