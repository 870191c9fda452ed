// The window: opens a project and lets a person edit it until the window is closed.
#pragma once

#include <filesystem>
#include <optional>

#include "runtime/frame/renderer.h"
#include "runtime/gpu/device.h"

namespace loam {

struct WindowOptions {
    std::filesystem::path project;
    gpu::DeviceDesc device;
    RendererDesc renderer;
    int width = 1280, height = 800;                  // of the window, in screen units
    std::filesystem::path record;                    // every command is appended here; empty: no recording
    std::optional<std::filesystem::path> shader_dir; // shaders are read from here and reloaded when a file changes
    double ui_scale = 0;                             // 0: as the screen says
    int max_frames = 0;                              // closes after so many frames; 0: when the person closes it
    bool validation = false;
    bool report = false;                             // what happens, as JSON lines on stdout (report.h)
};

// 0 when the window was closed, 1 after a failure that was reported on stderr.
int run_window(const WindowOptions& options);

} // namespace loam
