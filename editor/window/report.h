// What the window does, as one JSON object a line on stdout: for tests that drive a real window, and for measurements.
//
//   {"event":"ready","ms":…}                          the first whole picture is on screen
//   {"event":"viewport","rect":[x,y,w,h],"window":[w,h]}  after every change
//   {"event":"command","command":{…}}                 committed
//   {"event":"message","text":…}                      of the status line
//   {"event":"texture","quality":…,"pages":…}         the virtual texture shown, after every change
//   {"event":"motion","frames":…,"median_ms":…,"p95_ms":…,"scale":…,"passes":{…}}  when what moved came to rest
//   {"event":"idle","redraws":…,"scene_frames":…}     nothing will be drawn until something happens
//   {"event":"closed","redraws":…,"validation_messages":…}
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/document/command.h"
#include "runtime/gpu/commands.h"
#include "ui/geometry.h"

namespace loam::window {

class Report {
  public:
    explicit Report(bool enabled) : enabled_(enabled) {}

    void ready(double ms);
    void viewport(const ui::Rect& rect, uint32_t width, uint32_t height);
    void command(const Command& command);
    void message(const std::string& text);
    void texture(std::string_view quality, uint32_t pages);
    void frame_in_motion(double ms) { motion_ms_.push_back(ms); }
    // With the device's times of the newest frame's passes.
    void motion_ends(float scale, std::span<const gpu::PassTime> passes);
    void idle(uint64_t redraws, uint64_t scene_frames);
    void closed(uint64_t redraws, uint32_t validation_messages);

  private:
    bool enabled_;
    ui::Rect viewport_{-1, -1, 0, 0};
    std::string message_;
    uint32_t texture_pages_ = 0;
    std::vector<double> motion_ms_;
    uint64_t idle_redraws_ = ~uint64_t{0};
};

} // namespace loam::window
