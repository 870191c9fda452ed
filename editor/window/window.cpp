// Start: a window with a word on it comes before the renderer, whose pipelines may take seconds to compile the first time.
#include "editor/window/window.h"

#include <cstdio>

#include "editor/window/window_loop.h"

namespace loam {

namespace window {

namespace {

struct Screen { // what a project is shown with; made anew for every project, as it hangs on the session's device
    std::unique_ptr<Session> session;
    std::unique_ptr<Presenter> presenter;
};

Status show_word(Platform& platform, Presenter& presenter, ui::Ui& ui, const std::string& title, const std::string& word) {
    platform.wait(0);
    const glm::uvec2 size = platform.size_px();
    ui.begin_frame({.events = {}, .time_s = platform.now_s(), .size_px = {float(size.x), float(size.y)}});
    const ui::Rect whole = ui.window();
    const ui::Rect middle{whole.x, whole.y + whole.h * 0.45f, whole.w, ui.px(32)};
    ui.draw_label(middle, title, {ui::Weight::semibold, ui.px(20)}, ui.theme.text, ui::Ui::Align::center);
    ui.draw_label({middle.x, middle.bottom(), middle.w, ui.px(24)}, word, ui.style(), ui.theme.text_dim,
                  ui::Ui::Align::center);
    const ui::FrameOutput& out = ui.end_frame();
    auto drawn = presenter.draw(size, *out.draw, ui.text().atlas(), ui.theme.window, std::nullopt);
    return drawn ? Status() : Status(drawn.error());
}

Result<Screen> open_screen(Platform& platform, const WindowOptions& options, const std::filesystem::path& project) {
    SessionDesc desc{.device = options.device, .renderer = options.renderer};
    desc.device.present = true;
    desc.device.validation = desc.device.validation || options.validation;
    desc.device.instance_extensions = Platform::instance_extensions();
    auto session = Session::open(project, desc);
    if (!session) return session.error();
    LOAM_TRY((*session)->start_device());
    auto surface = platform.create_surface((*session)->device()->instance());
    if (!surface) return surface.error();
    auto presenter = Presenter::create(**session, *surface, platform.size_px());
    if (!presenter) return presenter.error();
    return Screen{std::move(*session), std::move(*presenter)};
}

// Edits one project; returns the next one to open, or nothing.
Result<std::filesystem::path> edit(Platform& platform, ui::Text& text, const WindowOptions& options, Report& report,
                                   const std::filesystem::path& project, bool first) {
    const double started_s = first ? 0 : platform.now_s();
    auto screen = open_screen(platform, options, project);
    if (!screen) return screen.error();
    Session& session = *screen->session;
    const std::string name = session.document().settings().name;
    platform.set_title(fmt::format("{} – Loam", name));

    ui::Theme theme;
    theme.scale = options.ui_scale > 0 ? float(options.ui_scale) : platform.content_scale();
    ui::Ui ui(text, theme);
    ui.clipboard = platform.clipboard();
    LOAM_TRY(show_word(platform, *screen->presenter, ui, name, "Preparing shaders…"));

    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    if (!options.record.empty() && first) LOAM_TRY(session.record_to(options.record));

    App app(session, theme);
    WindowLoop loop({.platform = platform,
                     .session = session,
                     .renderer = **renderer,
                     .presenter = *screen->presenter,
                     .ui = ui,
                     .app = app,
                     .report = report,
                     .options = options,
                     .started_s = started_s});
    auto next = loop.run();
    if (!next && session.device()->lost())
        return error("{}; every edit up to here is saved, start again to go on", next.message());
    session.device()->wait_idle();
    if (next && next->empty()) report.closed(loop.redraws(), session.device()->validation_message_count());
    return next;
}

} // namespace

} // namespace window

int run_window(const WindowOptions& options) {
    const auto fail = [](const std::string& message) {
        std::fprintf(stderr, "loam: %s\n", message.c_str());
        return 1;
    };
    auto platform = window::Platform::create("Loam", options.width, options.height);
    if (!platform) return fail(platform.message());
    auto text = ui::Text::create();
    if (!text) return fail(text.message());
    window::Report report(options.report);

    std::filesystem::path project = options.project;
    for (bool first = true; !project.empty(); first = false) {
        auto next = window::edit(**platform, **text, options, report, project, first);
        if (!next) return fail(next.message());
        project = *next;
    }
    return 0;
}

} // namespace loam
