#include "editor/window/window_loop.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "editor/choices.h"
#include "editor/window/panels.h"
#include "runtime/document/function_library.h"
#include "runtime/gpu/shader_library.h"

namespace loam::window {

namespace {

constexpr double kShortestFrame_s = 1.0 / 60;  // FIFO does not throttle on every display server
constexpr double kShaderPoll_s = 0.5;
constexpr double kImportPoll_s = 0.1;
constexpr int kAnnouncedAnswer = 6;            // frames until the feedback of an announced place has come
constexpr double kLongestStep_s = 0.1;         // of the clock that moves cameras and strokes, after a stall

RenderScaleDesc scale_desc(gpu::Profile profile) {
    if (profile == gpu::Profile::software) return {.goal_ms = 33, .smallest = 0.3f, .start = 0.55f};
    return {.goal_ms = 16, .smallest = 0.5f, .start = 1.0f};
}

} // namespace

WindowLoop::WindowLoop(const LoopParts& parts)
    : platform_(parts.platform),
      session_(parts.session),
      renderer_(parts.renderer),
      presenter_(parts.presenter),
      ui_(parts.ui),
      app_(parts.app),
      report_(parts.report),
      options_(parts.options),
      started_s_(parts.started_s),
      scale_(scale_desc(parts.session.device()->caps().profile)) {
    app_.frame.device = session_.device()->caps().name;
    app_.view.quality = renderer_.quality();
    app_.view.page_format = renderer_.page_format();
    app_.on_command = [this](const Command& command) { report_.command(command); };
    if (options_.shader_dir) session_.device()->shaders().watch(*options_.shader_dir);
    last_iteration_s_ = platform_.now_s();
}

Result<std::filesystem::path> WindowLoop::run() {
    LOAM_TRY(show_layer_pictures());
    while (!platform_.should_close() && !app_.quit) {
        wait_for_work();
        LOAM_TRY(iterate());
        if (app_.wish.kind == Wish::Kind::open_project) return app_.wish.path;
        if (app_.wish.kind == Wish::Kind::export_picture) LOAM_TRY(export_picture());
        if (options_.max_frames > 0 && redraws() >= uint64_t(options_.max_frames)) break;
    }
    return std::filesystem::path();
}

// Returns when there is something to do: at once while things move (but no earlier than the frame limiter allows),
// else with the next event or at the time somebody asked for.
void WindowLoop::wait_for_work() {
    const double began_s = platform_.now_s();
    const bool moving = build_again_ || app_.busy() || pacer_.due();
    double until_s = moving ? next_frame_s_ : std::min(wake_s_, pacer_.wake_s());
    if (options_.shader_dir) until_s = std::min(until_s, next_poll_s_);
    if (polls_functions()) until_s = std::min(until_s, next_function_poll_s_);
    platform_.wait(0);
    for (double now = platform_.now_s(); now < until_s; now = platform_.now_s()) {
        // Events do not end the limiter's wait: a fast mouse must not raise the frame rate.
        if (!moving && (platform_.has_events() || platform_.should_close())) until_s = std::min(until_s, next_frame_s_);
        if (now >= until_s) break;
        platform_.wait(until_s - now);
    }
    waited_s_ = platform_.now_s() - began_s;
}

// Other programs may write the texts of functions, once there are some.
bool WindowLoop::polls_functions() const {
    return app_.show_functions || session_.document().functions().in_use();
}

const ui::FrameOutput& WindowLoop::build(double now_s, double dt_s, std::span<const ui::Event> events) {
    ui_.begin_frame({.events = events, .time_s = now_s, .size_px = {float(size_px_.x), float(size_px_.y)}});
    build_menus(app_, ui_);
    build_status_line(app_, ui_);
    build_timeline(app_, ui_);
    build_function_panel(app_, ui_);
    build_shader_errors(app_, ui_);
    build_tool_bar(app_, ui_);
    build_properties(app_, ui_);
    const ui::ViewportResponse response = ui::viewport(ui_, "viewport");
    app_.viewport_input(ui_, response, dt_s);
    draw_ring(app_, ui_, response.rect);
    draw_legend(app_, ui_, response.rect);
    build_dialogs(app_, ui_);
    if (!(response.rect == viewport_)) app_.scene_changed();
    viewport_ = response.rect;
    return ui_.end_frame();
}

Status WindowLoop::iterate() {
    const double now = platform_.now_s();
    LOAM_TRY(poll_shaders(now));
    if (polls_functions() && now >= next_function_poll_s_) {
        next_function_poll_s_ = now + kShaderPoll_s;
        build_again_ |= app_.poll_functions();
    }
    const bool exposed = platform_.take_exposed();
    const std::vector<ui::Event> events = platform_.take_events();
    const bool due = build_again_ || exposed || !events.empty() || app_.busy() || pacer_.due() || now >= wake_s_ ||
                     now >= pacer_.wake_s();
    const double dt = std::min(now - last_iteration_s_, kLongestStep_s);
    if (!due) return {};
    const glm::uvec2 size = platform_.size_px();
    const bool resized = size != size_px_;
    size_px_ = size;

    const bool was_busy = app_.busy();
    const ui::FrameOutput& out = build(now, was_busy ? dt : 0, events);
    app_.handle_keys(out.keys, ui_);
    app_.advance_time(was_busy ? dt : 0);
    app_.advance_fill();
    app_.advance_import();
    platform_.set_cursor(out.cursor);
    report_.viewport(viewport_, size.x, size.y);
    report_.message(app_.message());
    wake_s_ = app_.import() ? std::min(out.wake_s, now + kImportPoll_s) : out.wake_s;

    if (app_.take_settings_changed()) LOAM_TRY(show_settings());
    if (app_.take_quality_changed()) change_quality();
    if (app_.take_scene_changed()) pacer_.changed(now);
    pacer_.advance(now);
    const bool draw_now = out.picture_changed || exposed || resized || pacer_.due();
    // What was done just now may show in the panels (history, undo buttons): they are built once more.
    build_again_ = out.redraw || !out.keys.empty() || app_.busy() || was_busy;
    note_frame_time(now);
    if (draw_now) LOAM_TRY(draw(out, now));
    else drew_moving_ = false;
    last_iteration_s_ = now;
    return {};
}

FrameSettings WindowLoop::frame_settings() const {
    const bool moving = pacer_.phase() == FramePacer::Phase::moving;
    FrameSettings settings{.shading = app_.view.shading, .debug = app_.view.debug, .at_rest = !moving};
    if (moving) settings.render_scale = app_.view.adaptive ? scale_.scale() : float(app_.view.fixed_scale);
    return settings;
}

// The time of the frame before, all of its waiting for the device included, the limiter's waiting not.
void WindowLoop::note_frame_time(double now_s) {
    if (drew_moving_ && pacer_.phase() == FramePacer::Phase::moving) {
        const double ms = (now_s - last_iteration_s_ - waited_s_) * 1000;
        app_.frame.frame_ms = ms;
        scale_.add_frame(ms);
        report_.frame_in_motion(ms);
    } else if (drew_moving_) {
        scale_.restart();
    }
}

Status WindowLoop::draw(const ui::FrameOutput& out, double now_s) {
    SceneFrame scene{.renderer = &renderer_,
                     .camera = app_.camera.camera(),
                     .settings = frame_settings(),
                     .draw = pacer_.due(),
                     .viewport = viewport_};
    if (scene.draw) announce();
    next_frame_s_ = now_s + kShortestFrame_s;
    auto drawn = presenter_.draw(size_px_, *out.draw, ui_.text().atlas(), ui_.theme.window, scene);
    if (!drawn) return drawn.error();
    if (!*drawn) { // minimised: look again when the window system says so
        drew_moving_ = false;
        next_frame_s_ = now_s + 0.1;
        return {};
    }
    ++app_.frame.redraws;
    const FramePacer::Phase before = pacer_.phase();
    drew_moving_ = scene.draw && before == FramePacer::Phase::moving;
    if (scene.draw) {
        ++app_.frame.scene_frames;
        app_.frame.render_scale = scene.settings.render_scale;
        app_.frame.pages_pending = renderer_.pending_pages();
        pacer_.drawn(renderer_.settled());
        report_.texture(quality_name(renderer_.quality()).name, renderer_.statistics().texture.capacity_pages);
        if (!drew_moving_) report_.motion_ends(scale_.scale(), session_.ring()->pass_times());
    }
    if (!ready_ && pacer_.phase() != FramePacer::Phase::moving) {
        ready_ = true;
        report_.ready((platform_.now_s() - started_s_) * 1000);
    }
    const bool resting = pacer_.phase() == FramePacer::Phase::resting;
    if (resting != app_.frame.resting) {
        app_.frame.resting = resting;
        build_again_ = true; // the status line says so
    }
    if (resting && !build_again_) report_.idle(redraws(), app_.frame.scene_frames);
    return {};
}

void WindowLoop::change_quality() {
    if (const Status changed = session_.set_quality(app_.view.quality, app_.view.page_format); !changed)
        app_.fail(changed.message());
    app_.view.quality = renderer_.quality();
    app_.view.page_format = renderer_.page_format();
    build_again_ = true; // the menu's check marks
}

// Where the camera will be in a moment: its pages are made now. A jump waits for them, but not for long.
void WindowLoop::announce() {
    const std::optional<Camera> there = app_.camera.destination();
    announced_frames_ = there ? announced_frames_ + 1 : 0;
    renderer_.announce(there);
    if (!there || announced_frames_ < kAnnouncedAnswer) return;
    if (renderer_.statistics().texture.announced_missing > 0) return;
    app_.camera.arrive();
    app_.scene_changed();
}

// Those that changed: a transition's with its threshold.
Status WindowLoop::show_layer_pictures() {
    const std::vector<std::vector<uint8_t>>& pictures = renderer_.layers().thumbnails;
    pictured_layers_.resize(pictures.size());
    app_.layer_pictures.resize(pictures.size());
    for (size_t i = 0; i < pictures.size(); ++i) {
        if (pictured_layers_[i] == pictures[i]) continue;
        const auto shown = presenter_.set_picture(app_.layer_pictures[i], pictures[i], LayerSet::kThumbnail);
        if (!shown) return shown.error();
        app_.layer_pictures[i] = *shown;
        pictured_layers_[i] = pictures[i];
    }
    return {};
}

Status WindowLoop::show_settings() {
    if (const Status taken = renderer_.settings_changed(*session_.ring()); !taken) {
        if (session_.device()->lost()) return taken;
        app_.fail(taken.message());
    }
    return show_layer_pictures();
}

Status WindowLoop::export_picture() {
    const Wish wish = std::exchange(app_.wish, {});
    const auto picture = session_.render(
        {.camera = app_.camera.camera(), .width = wish.width, .height = wish.height, .supersample = 2});
    if (!picture) {
        if (session_.device()->lost()) return picture.error();
        app_.fail(picture.message());
    } else if (const Status saved = save_png(wish.path, *picture); !saved) {
        app_.fail(saved.message());
    } else {
        app_.say(fmt::format("Picture saved as {}", wish.path.string()));
    }
    app_.scene_changed(); // the renderer's picture is another one now
    build_again_ = true;
    return {};
}

Status WindowLoop::poll_shaders(double now_s) {
    if (!options_.shader_dir || now_s < next_poll_s_) return {};
    next_poll_s_ = now_s + kShaderPoll_s;
    gpu::Device& device = *session_.device();
    const std::vector<std::string> changed = device.shaders().poll();
    if (!changed.empty()) {
        gpu::reload_pipelines(device, changed);
        app_.say(fmt::format("Reloaded {} shader{}", changed.size(), changed.size() == 1 ? "" : "s"));
        app_.scene_changed();
    }
    std::vector<std::string> errors;
    for (const auto& [name, text] : device.shaders().errors()) errors.push_back(text);
    if (errors != app_.shader_errors) {
        app_.shader_errors = std::move(errors);
        build_again_ = true;
    }
    if (!changed.empty()) build_again_ = true;
    return {};
}

} // namespace loam::window
