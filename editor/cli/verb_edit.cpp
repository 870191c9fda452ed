#include "editor/cli/verb.h"
#ifdef LOAM_HAS_WINDOW
#include "editor/window/window.h"
#endif

namespace loam::cli {

namespace {

Status run(const Args& args) {
#ifdef LOAM_HAS_WINDOW
    WindowOptions options;
    options.project = args.positional(0);
    auto session = session_desc(args);
    if (!session) return session.error();
    options.device = session->device;
    options.validation = session->device.validation;
    options.renderer = session->renderer;
    const PixelSize size = args.size("--size", {1280, 800});
    options.width = size.width;
    options.height = size.height;
    options.record = args.text("--record");
    if (args.has("--shaders")) options.shader_dir = args.text("--shaders");
    options.ui_scale = args.number("--ui-scale", 0);
    options.max_frames = args.integer("--max-frames", 0);
    options.report = args.has("--report");
    // The project is opened once here: a bad one is refused before a window flashes up.
    if (auto document = Document::open(options.project, OpenMode::read_only); !document)
        return document.error();
    if (run_window(options) != 0) return error("the window ended with a failure, see above");
    return {};
#else
    return error("this build of loam has no window; {} can be rendered with loam render", args.positional(0));
#endif
}

}  // namespace

Verb edit_verb() {
    return {.name = "edit",
            .summary = "opens the window",
            .positionals = {{"PROJECT", "project folder"}},
            .options = with_device_options(
                {{"--size", ValueKind::size, "WxH", "of the window; default 1280x800"},
                 {"--record", ValueKind::text, "FILE", "append every command to this script"},
                 {"--shaders", ValueKind::text, "DIR",
                  "read shaders from here and reload them when a file changes"},
                 {"--ui-scale", ValueKind::number, "S", "size of the interface; default as the screen says"},
                 {"--max-frames", ValueKind::integer, "N", "close after so many frames"},
                 {"--report", ValueKind::none, "", "say what happens as JSON lines on stdout"}}),
            .run = run};
}

}  // namespace loam::cli
