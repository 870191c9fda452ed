#include "editor/cli/progress_line.h"
#include "editor/cli/verb.h"
#include "editor/layer_import.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    if (args.positional(0) != "add") return error("unknown action \"{}\", expected add", args.positional(0));
    auto pack = pack_request(args, args.positional(2));
    if (!pack) return pack.error();
    if (args.has("--name") && args.text("--name").empty()) return error("--name is empty");
    const AddLayerRequest request{.pack = *pack,
                                  .name = args.text("--name"),
                                  .tile_m = args.number("--tile", AddLayerRequest{}.tile_m)};
    Result<AddedLayer> added = [&]() -> Result<AddedLayer> {
        auto document = Document::open(args.positional(1), OpenMode::read_write);
        if (!document) return document.error();
        ProgressLine progress;
        return add_layer(**document, request, progress.callback());
    }();
    if (!added) return added.error();
    if (args.has("--json")) {
        const PackJson json = {{"name", added->entry.name},
                               {"index", added->index},
                               {"file", added->entry.file},
                               {"tile_m", added->entry.tile_m},
                               {"report", added->report}};
        fmt::print("{}\n", json.dump(2));
        return {};
    }
    fmt::print("{}", pack_text(added->report));
    fmt::print("layer {} \"{}\" is ready: {}\n", added->index, added->entry.name, added->entry.file);
    return {};
}

}  // namespace

Verb layer_verb() {
    return {
        .name = "layer",
        .summary = "adds a layer made of a folder of material maps",
        .positionals = {{"ACTION", "add"},
                        {"PROJECT", "project folder; no window may have it open"},
                        {"FOLDER", "maps by the usual names (…_Color, _NormalGL, _Roughness, …)"}},
        .options = with_pack_options(
            {{"--name", ValueKind::text, "N", "of the layer; default: the folder's"},
             {"--tile", ValueKind::number, "M", "metres that the maps cover; default 2"},
             {"--json", ValueKind::none, "", "print the layer and the packer's report as JSON"}}),
        .run = run,
        .notes =
            "The layer comes after the others, so that painted ground keeps its layers. See also loam pack."};
}

}  // namespace loam::cli
