#include "editor/cli/verb.h"
#include "runtime/document/document.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    auto document = Document::open(args.positional(0), OpenMode::read_write);
    if (!document) return document.error();
    TransitionCommand transition{.name = args.positional(1),
                                 .from = args.text("--from"),
                                 .to = args.text("--to"),
                                 .threshold = {},
                                 .remove = args.has("--remove")};
    if (args.has("--threshold")) transition.threshold = args.number("--threshold", 0.5);
    const auto applied = (*document)->apply({transition});
    return applied ? Status() : applied.error();
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
