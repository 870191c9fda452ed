// The window's loop for one open project: wait, take input, edit, draw what has changed, and otherwise rest.
#pragma once

#include "editor/window/app.h"
#include "editor/window/frame_pacer.h"
#include "editor/window/platform_glfw.h"
#include "editor/window/presenter.h"
#include "editor/window/render_scale.h"
#include "editor/window/report.h"
#include "editor/window/window.h"

namespace loam::window {

struct LoopParts {
    Platform& platform;
    Session& session;
    Renderer& renderer;
    Presenter& presenter;
    ui::Ui& ui;
    App& app;
    Report& report;
    const WindowOptions& options;
    double started_s = 0; // when the command was given, on the platform's clock
};

class WindowLoop {
  public:
    explicit WindowLoop(const LoopParts& parts);

    // Until the window is closed (no path) or another project is to be opened.
    Result<std::filesystem::path> run();
    [[nodiscard]] uint64_t redraws() const { return app_.frame.redraws; }

  private:
    void wait_for_work();
    Status iterate();
    const ui::FrameOutput& build(double now_s, double dt_s, std::span<const ui::Event> events);
    Status draw(const ui::FrameOutput& out, double now_s);
    FrameSettings frame_settings() const;
    void change_quality();
    void announce();
    Status show_settings();
    Status show_layer_pictures();  // of layers, that changed since the last call
    Status export_picture();
    Status poll_shaders(double now_s);
    [[nodiscard]] bool polls_functions() const;
    void note_frame_time(double now_s);

    Platform& platform_;
    Session& session_;
    Renderer& renderer_;
    Presenter& presenter_;
    ui::Ui& ui_;
    App& app_;
    Report& report_;
    const WindowOptions& options_;
    double started_s_;

    FramePacer pacer_;
    RenderScale scale_;
    ui::Rect viewport_;
    double last_iteration_s_ = 0, waited_s_ = 0, next_frame_s_ = 0, wake_s_ = 0, next_poll_s_ = 0,
           next_function_poll_s_ = 0;
    std::vector<std::vector<uint8_t>> pictured_layers_;
    bool build_again_ = true, ready_ = false, drew_moving_ = false;
    int announced_frames_ = 0;
    glm::uvec2 size_px_{0};
};

} // namespace loam::window
