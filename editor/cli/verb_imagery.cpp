#include <nlohmann/json.hpp>

#include "editor/cli/progress_line.h"
#include "editor/cli/verb.h"
#include "editor/imagery_import.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    AddImageryRequest request{.file = args.positional(1), .strength = {}, .distance_m = {}};
    if (args.has("--strength")) request.strength = args.number("--strength", 1);
    if (args.has("--distance")) request.distance_m = args.number("--distance", 0);
    Result<AddedImagery> added = [&]() -> Result<AddedImagery> {
        auto document = Document::open(args.positional(0), OpenMode::read_write);
        if (!document) return document.error();
        ProgressLine progress;
        return add_imagery(**document, request, progress.callback());
    }();
    if (!added) return added.error();
    if (args.has("--json")) {
        const nlohmann::ordered_json json = {{"file", added->settings.file},
                                             {"strength", added->settings.strength},
                                             {"distance_m", added->settings.distance_m},
                                             {"width", added->width},
                                             {"height", added->height},
                                             {"texel_m", added->shape.spacing_m},
                                             {"levels", added->shape.level_count()},
                                             {"bytes", added->size_bytes},
                                             {"notes", added->notes}};
        fmt::print("{}\n", json.dump(2));
        return {};
    }
    for (const std::string& note : added->notes) fmt::print("{}\n", note);
    fmt::print("imagery is ready: {}, {} x {} pixels as texels of {} m, {:.1f} MB; shows from {} m on\n",
               added->settings.file, added->width, added->height, added->shape.spacing_m,
               double(added->size_bytes) / 1e6, added->settings.distance_m);
    return {};
}

}  // namespace

Verb imagery_verb() {
    return {
        .name = "imagery",
        .summary = "lays satellite or ortho imagery over the map as its far look",
        .positionals = {{"PROJECT", "project folder; no window may have it open"},
                        {"FILE", "any picture of any size: its corners are the map's, its top is north"}},
        .options = {{"--strength", ValueKind::number, "S", "0 to 1: of its colours; default as it is, or 1"},
                    {"--distance", ValueKind::number, "M",
                     "metres from which it shows, alone from four times that on; default as it is, or 400"},
                    {"--json", ValueKind::none, "", "print what was made as JSON"}},
        .run = run,
        .notes =
            "An alpha channel says where there is imagery. loam set PROJECT imagery.strength 0 turns it "
            "off, imagery.file \"\" takes it away; its file stays in the folder imagery."};
}

}  // namespace loam::cli
