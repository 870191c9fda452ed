#include "editor/bench/bench.h"
#include "editor/cli/verb.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    std::vector<std::string> names;
    const bench::BenchName* chosen = nullptr;
    for (const bench::BenchName& bench : bench::benches()) {
        names.emplace_back(bench.name);
        if (args.positional(0) == bench.name) chosen = &bench;
    }
    if (!chosen) {
        const std::string nearest = nearest_word(args.positional(0), names);
        return error(
            "unknown bench \"{}\"{}", args.positional(0),
            nearest.empty() ? ", see loam bench --help" : fmt::format(", did you mean {}?", nearest));
    }
    auto desc = session_desc(args);
    if (!desc) return desc.error();
    bench::BenchRequest request;
    request.project = args.positional(1);
    request.session = *desc;
    const PixelSize size = args.size("--size", {960, 540});
    request.width = size.width;
    request.height = size.height;
    request.frames = args.integer("--frames", 300);
    request.goal_ms = args.number("--goal", 33);
    request.dabs = args.integer("--dabs", 0);
    request.dem = args.text("--dem");
    request.images = args.text("--images");
    request.pictures = args.text("--pictures");
    request.quick = args.has("--quick");
    if (args.has("--camera")) request.camera = parse_camera(args.text("--camera")).value();
    auto report = chosen->run(request);
    if (!report) return error("{}: {}", chosen->name, report.message());
    fmt::print("{}", args.has("--json") ? bench::to_json(*report).dump(2) + "\n" : bench::to_text(*report));
    return {};
}

}  // namespace

Verb bench_verb() {
    static const std::string notes = [] {
        std::string text = "Benches:";
        for (const bench::BenchName& bench : bench::benches())
            text += fmt::format("\n  {:<9} {}", bench.name, bench.summary);
        return text;
    }();
    return {
        .name = "bench",
        .summary = "measures",
        .positionals = {{"NAME", "which bench, see below"}, {"PROJECT", "project folder; it is not changed"}},
        .options = with_device_options(
            {{"--size", ValueKind::size, "WxH", "of the pictures; default 960x540"},
             {"--camera", ValueKind::camera, "X,Y,Z,YAW,PITCH[,FOV]", "resolve, quality, filter: this view only"},
             {"--frames", ValueKind::integer, "N", "frame: how many; default 300"},
             {"--goal", ValueKind::number, "MS", "frame: milliseconds a frame; default 33"},
             {"--dabs", ValueKind::integer, "N", "edits: a row; default up to 200 within 5 s"},
             {"--dem", ValueKind::text, "DIR", "ground, quality: folder of real elevation data"},
             {"--images", ValueKind::text, "DIR", "encoders: folder of photographs, too"},
             {"--pictures", ValueKind::text, "DIR",
              "pop, quality, filter: folder for the pictures that figures speak of"},
             {"--quick", ValueKind::none, "", "fewer views and repeats"},
             {"--json", ValueKind::none, "", "print as JSON"}}),
        .run = run,
        .notes = notes.c_str()};
}

}  // namespace loam::cli
