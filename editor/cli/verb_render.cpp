#include <chrono>

#include "editor/choices.h"
#include "editor/cli/verb.h"
#include "editor/report.h"

namespace loam::cli {

namespace {

Result<RenderRequest> request_of(const Args& args, Session& session) {
    RenderRequest request;
    if (args.has("--camera") && args.has("--look-at"))
        return error("--camera and --look-at exclude each other");
    if (args.has("--camera"))
        request.camera = parse_camera(args.text("--camera")).value();
    else if (args.has("--look-at"))
        request.camera = parse_look_at(args.text("--look-at")).value();
    else
        request.camera = session.default_camera();
    const PixelSize size = args.size("--size", {1280, 720});
    request.width = size.width;
    request.height = size.height;
    request.reference = args.has("--reference");
    request.supersample = args.integer("--supersample", 1);
    if (request.supersample < 1 || request.supersample > 16)
        return error("--supersample {} is outside 1 … 16", request.supersample);
    request.max_frames = args.integer("--max-frames", 600);
    if (request.max_frames < 1) return error("--max-frames {} is below 1", request.max_frames);
    request.frame.render_scale = static_cast<float>(args.number("--render-scale", 1));
    if (request.frame.render_scale < 0.05f || request.frame.render_scale > 1)
        return error("--render-scale {} is outside 0.05 … 1", request.frame.render_scale);
    auto filter = parse_filter(args.text("--filter", "auto"));
    if (!filter) return filter.error();
    request.frame.filter = *filter;
    if (args.has("--debug")) {
        auto debug = parse_debug_view(args.text("--debug"));
        if (!debug) return debug.error();
        request.frame.debug = *debug;
    }
    return request;
}

// The camera is somewhere else first and is announced for some frames where it will be.
Status stand_elsewhere(const Args& args, Session& session, const RenderRequest& request) {
    const int announced = args.integer("--announce", 0);
    if (announced < 0) return error("--announce {} is below 0", announced);
    if (!args.has("--from")) {
        if (announced > 0) return error("--announce needs --from, where the camera is before");
        return {};
    }
    RenderRequest before = request;
    before.camera = parse_camera(args.text("--from")).value();
    before.max_frames = 600;
    if (auto picture = session.render(before); !picture) return picture.error();
    if (announced == 0) return {};
    LOAM_TRY(session.announce(request.camera));
    LOAM_TRY(session.step(before.camera, request.width, request.height, request.frame, announced));
    return session.announce(std::nullopt);
}

Status run(const Args& args) {
    auto desc = session_desc(args);
    if (!desc) return desc.error();
    desc->mode = OpenMode::read_only;
    auto session = Session::open(args.positional(0), *desc);
    if (!session) return session.error();
    if (args.has("--time"))
        if (auto moved = (*session)->apply({TimeCommand{args.number("--time", 0)}}); !moved)
            return moved.error();
    auto request = request_of(args, **session);
    if (!request) return request.error();
    const std::string file = args.text("-o", "out.png");
    LOAM_TRY(stand_elsewhere(args, **session, *request));
    const auto start = std::chrono::steady_clock::now();
    auto picture = (*session)->render(*request);
    if (!picture) return picture.error();
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    LOAM_TRY(save_png(file, *picture));
    const bool settled = (*session)->last_render_settled();
    const uint32_t messages = (*session)->device()->validation_message_count();
    if (args.has("--json")) {
        Json json = {{"file", file},
                     {"size", {picture->width, picture->height}},
                     {"device", (*session)->device()->caps().name},
                     {"frames", (*session)->frames_rendered()},
                     {"settled", settled},
                     {"ms", ms},
                     {"validation_messages", messages}};
        if (!request->reference)
            json["texture"] = to_report((*session)->renderer().value()->statistics().texture);
        fmt::print("{}\n", json.dump());
    } else {
        fmt::print("{}: {}x{}, {} frames in {:.0f} ms{}\n", file, picture->width, picture->height,
                   (*session)->frames_rendered(), ms, settled ? "" : ", not yet settled");
    }
    if (messages > 0) return error("{} validation messages, see above", messages);
    return {};
}

}  // namespace

Verb render_verb() {
    static const std::string notes = [] {
        std::string text = "Without a camera the whole map is shown from the south-west.\n\nDebug views:\n";
        for (const DebugViewInfo& view : debug_views())
            text += fmt::format("  {:<16} {}{}{}\n", view.name, view.title, *view.legend ? ": " : "",
                                view.legend);
        text.pop_back();
        return text;
    }();
    return {
        .name = "render",
        .summary = "renders a picture without a window",
        .positionals = {{"PROJECT", "project folder"}},
        .options = with_device_options(
            {{"-o", ValueKind::text, "FILE", "picture to write, PNG; default out.png"},
             {"--camera", ValueKind::camera, "X,Y,Z,YAW,PITCH[,FOV]",
              "metres and degrees; yaw is clockwise from north"},
             {"--look-at", ValueKind::look_at, "EX,EY,EZ,TX,TY,TZ[,FOV]", "from an eye to a target"},
             {"--size", ValueKind::size, "WxH", "pixels; default 1280x720"},
             {"--time", ValueKind::number, "S",
              "seconds: operators with a life and events as they are then; default as the project was left"},
             {"--reference", ValueKind::none, "",
              "every pixel evaluated directly: no cache, no compression, at least 4x4 samples"},
             {"--supersample", ValueKind::integer, "N", "average of N x N pictures"},
             {"--render-scale", ValueKind::number, "S",
              "share of the width and height that is rendered; default 1"},
             {"--max-frames", ValueKind::integer, "N", "stop refining after so many; default 600"},
             {"--filter", ValueKind::text, "FILTER",
              "of the texture: bilinear, trilinear, tiles, hardware; default auto, the device's best"},
             {"--debug", ValueKind::text, "VIEW",
              "what the picture is made of instead of the picture; see below"},
             {"--from", ValueKind::camera, "X,Y,Z,YAW,PITCH[,FOV]",
              "first render from here until the picture rests, then jump to the camera"},
             {"--announce", ValueKind::integer, "N",
              "before that jump, make pages of the new place for N frames; default 0"},
             {"--json", ValueKind::none, "", "print figures as JSON"}}),
        .run = run,
        .notes = notes.c_str()};
}

}  // namespace loam::cli
