// The timeline: what happens when, as bars; the time is scrubbed by dragging, or played.
#include <algorithm>
#include <cmath>

#include "editor/window/panels.h"

namespace loam::window {

namespace {

constexpr float kBar = 9, kBarGap = 3, kRuler = 16, kHeight = 92;
constexpr size_t kMostLanes = 5;

// A round number of seconds between ticks that are at least 70 px apart.
double tick_s(double end_s, float width_px) {
    constexpr double kSteps_s[] = {0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 30, 60, 120, 300, 600};
    const double least_s = end_s * 70 / std::max(width_px, 70.0f);
    for (const double step_s : kSteps_s)
        if (step_s >= least_s) return step_s;
    return kSteps_s[std::size(kSteps_s) - 1];
}

std::string time_text(double seconds) {
    const bool minutes = std::abs(seconds) >= 60;
    return minutes ? fmt::format("{}:{:04.1f}", int(seconds / 60), std::fmod(std::abs(seconds), 60))
                   : fmt::format("{:.1f} s", seconds);
}

void draw_bars(App& app, ui::Ui& ui, const ui::Rect& track, double end_s) {
    const auto x_of = [&](double t) { return track.x + float(std::clamp(t / end_s, 0.0, 1.0)) * track.w; };
    std::vector<float> lanes;  // where each ends
    for (const ObjectRow& row : app.timed_objects()) {
        const float x0 = x_of(row.from_s), x1 = std::max(x_of(row.until_s), x0 + ui.px(4));
        size_t lane = 0;
        while (lane < lanes.size() && lanes[lane] > x0) ++lane;
        if (lane == kMostLanes) continue;
        if (lane == lanes.size()) lanes.push_back(0);
        lanes[lane] = x1 + ui.px(2);
        const ui::Rect bar{x0, track.y + ui.px(kRuler + 2 + float(lane) * (kBar + kBarGap)), x1 - x0,
                           ui.px(kBar)};
        const bool selected = row.id == app.selected_object;
        ui.draw().rect(bar, selected ? ui.theme.accent : ui.theme.accent_soft, ui.px(2));
        const ui::Rect moving{x0, bar.y, std::max(x_of(row.moved_s) - x0, ui.px(3)), bar.h};
        ui.draw().rect(moving, (selected ? ui.theme.text : ui.theme.accent).faded(row.enabled ? 1.0f : 0.35f),
                       ui.px(2));
        const ui::Response r = ui.interact(ui.make_id(fmt::format("bar{}", row.id)), bar, ui::Sense::click);
        if (!r.clicked) continue;
        app.selected_object = row.id;
        ui.request_redraw();
    }
}

void track_area(App& app, ui::Ui& ui, const ui::Rect& track) {
    const double end_s = app.timeline_end_s();
    ui.draw().rect(track, ui.theme.window, ui.px(3));
    const ui::Rect ruler{track.x, track.y, track.w, ui.px(kRuler)};
    const double step_s = tick_s(end_s, track.w / ui.px(1));
    for (double t = 0; t <= end_s * (1 + 1e-9); t += step_s) {
        const float x = track.x + float(t / end_s) * track.w;
        ui.draw().line({x, ruler.y}, {x, track.y + track.h}, ui.theme.panel_edge, ui.px(1));
        ui.draw_label({x + ui.px(3), ruler.y, ui.px(60), ruler.h}, time_text(t), ui.small_style(),
                      ui.theme.text_dim);
    }
    draw_bars(app, ui, track, end_s);
    // The ruler, and what of the track no bar takes.
    const ui::Response r = ui.interact(ui.make_id("scrub"), track, ui::Sense::drag);
    if (r.pressed || r.held) {
        app.playing = false;
        const double share = std::clamp(double(ui.mouse().x - track.x) / std::max(track.w, 1.0f), 0.0, 1.0);
        app.set_time(share * end_s);
    }
    const float x = track.x + float(std::clamp(app.time_s() / end_s, 0.0, 1.0)) * track.w;
    ui.draw().line({x, track.y}, {x, track.y + track.h}, ui.theme.text, ui.px(1.5f));
}

}  // namespace

void build_timeline(App& app, ui::Ui& ui) {
    if (!app.show_timeline) return;
    auto panel = ui::panel(ui, "timeline",
                           {.edge = ui::Edge::bottom, .size = kHeight, .horizontal = true, .padding = 6});
    ui::Rect area;
    {
        area = ui.allocate_rest();
        auto side = ui.column_in(ui::cut(area, ui::Edge::left, ui.px(150)), 4);
        {
            auto row = ui.row({ui::fixed(28), ui::fixed(28), ui::flex()}, 28);
            if (ui::icon_button(ui, "to the start",
                                {.icon = ui::Icon::to_start, .tooltip = "Back to the start", .size = 26}))
                app.set_time(0);
            if (ui::icon_button(ui, "play",
                                {.icon = app.playing ? ui::Icon::stop : ui::Icon::play,
                                 .toggled = app.playing,
                                 .tooltip = app.playing ? "Stop" : "Play",
                                 .shortcut = app.shortcuts.label("play"),
                                 .size = 26}))
                app.run("play", ui);
            ui::label(ui, time_text(app.time_s()));
        }
        ui::slider(ui, "Speed", app.play_speed, {.min = 0.1, .max = 50, .decimals = 1, .logarithmic = true});
    }
    track_area(app, ui, area.inset(ui.px(8), ui.px(2)));
}

double App::time_s() const {
    return session.document().time_s();
}

void App::set_time(double time_s) {
    if (time_s == this->time_s() || tools.stroking()) return;
    apply({.body = TimeCommand{time_s}});
}

double App::timeline_end_s() {
    constexpr double kShortest_s = 30, kLongest_s = 3600;
    double end_s = kShortest_s;
    for (const ObjectRow& row : timed_objects())
        end_s = std::max(end_s, 1.1 * std::min(row.until_s, row.moved_s + 4 * kShortest_s));
    return std::min(std::max(end_s, time_s()), kLongest_s);
}

void App::play(bool on) {
    playing = on;
    if (!on) return;
    show_timeline = true;
    if (time_s() >= timeline_end_s()) set_time(0);
}

void App::event_placed(const Command& command) {
    const auto* added = std::get_if<AddOperatorCommand>(&command.body);
    if (!added || !std::holds_alternative<Event>(added->shape)) return;
    for (const ObjectRow& row : timed_objects()) selected_object = std::max(selected_object, row.id);
    show_timeline = true;
    if (play_placed) play(true);
}

void App::advance_time(double dt_s) {
    if (!playing || dt_s <= 0 || tools.stroking()) return;
    const double end_s = timeline_end_s(), next_s = time_s() + dt_s * play_speed;
    set_time(std::min(next_s, end_s));
    if (next_s >= end_s) playing = false;
}

}  // namespace loam::window
