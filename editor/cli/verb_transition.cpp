#include "editor/cli/verb.h"
#include "editor/transitions.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    auto document = Document::open(args.positional(0), OpenMode::read_write);
    if (!document) return document.error();
    ProjectSettings settings = (*document)->settings();
    const std::string& name = args.positional(1);
    if (args.has("--remove")) {
        if (args.has("--from") || args.has("--to") || args.has("--threshold"))
            return error("--remove stands alone");
        LOAM_TRY(remove_transition(settings, name));
    } else {
        TransitionRequest request{
            .name = name, .from = args.text("--from"), .to = args.text("--to"), .threshold = {}};
        if (args.has("--threshold")) request.threshold = args.number("--threshold", 0.5);
        LOAM_TRY(put_transition(settings, request));
    }
    return (*document)->change_settings(settings);
}

}  // namespace

Verb transition_verb() {
    return {
        .name = "transition",
        .summary = "makes, changes or removes a transition between two layers",
        .positionals = {{"PROJECT", "project folder"}, {"NAME", "of the transition; paints like a layer"}},
        .options = {{"--from", ValueKind::text, "LAYER", "below"},
                    {"--to", ValueKind::text, "LAYER", "above, through whose reveal map it is blended"},
                    {"--threshold", ValueKind::number, "N", "0: all of FROM … 1: all of TO; default 0.5"},
                    {"--remove", ValueKind::none, "", "remove it; its texels show the nearer of the two"}},
        .run = run};
}

}  // namespace loam::cli
