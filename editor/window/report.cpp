#include "editor/window/report.h"

#include <algorithm>
#include <cstdio>

#include <nlohmann/json.hpp>

namespace loam::window {

namespace {

using Json = nlohmann::ordered_json;

void print(const Json& line) {
    const std::string text = line.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
}

double rounded(double ms) {
    return static_cast<double>(static_cast<int64_t>(ms * 100 + 0.5)) / 100;
}

} // namespace

void Report::ready(double ms) {
    if (enabled_) print({{"event", "ready"}, {"ms", rounded(ms)}});
}

void Report::viewport(const ui::Rect& rect, uint32_t width, uint32_t height) {
    if (!enabled_ || rect == viewport_) return;
    viewport_ = rect;
    print({{"event", "viewport"},
           {"rect", {int(rect.x), int(rect.y), int(rect.w), int(rect.h)}},
           {"window", {width, height}}});
}

void Report::command(const Command& command) {
    if (enabled_) print({{"event", "command"}, {"command", Json::parse(to_json(command), nullptr, false)}});
}

void Report::message(const std::string& text) {
    if (!enabled_ || text == message_) return;
    message_ = text;
    print({{"event", "message"}, {"text", text}});
}

void Report::texture(std::string_view quality, uint32_t pages) {
    if (!enabled_ || pages == texture_pages_) return;
    texture_pages_ = pages;
    print({{"event", "texture"}, {"quality", quality}, {"pages", pages}});
}

void Report::motion_ends(float scale, std::span<const gpu::PassTime> passes) {
    if (motion_ms_.empty()) return;
    std::sort(motion_ms_.begin(), motion_ms_.end());
    const size_t count = motion_ms_.size();
    Json pass_ms = Json::object();
    for (const gpu::PassTime& pass : passes) pass_ms[std::string(pass.name)] = rounded(pass.gpu_ms);
    if (enabled_)
        print({{"event", "motion"},
               {"frames", count},
               {"median_ms", rounded(motion_ms_[count / 2])},
               {"p95_ms", rounded(motion_ms_[count * 95 / 100])},
               {"scale", rounded(scale)},
               {"passes", pass_ms}});
    motion_ms_.clear();
}

void Report::idle(uint64_t redraws, uint64_t scene_frames) {
    if (!enabled_ || redraws == idle_redraws_) return;
    idle_redraws_ = redraws;
    print({{"event", "idle"}, {"redraws", redraws}, {"scene_frames", scene_frames}});
}

void Report::closed(uint64_t redraws, uint32_t validation_messages) {
    if (enabled_) print({{"event", "closed"}, {"redraws", redraws}, {"validation_messages", validation_messages}});
}

} // namespace loam::window
