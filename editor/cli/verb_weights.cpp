#include "editor/cli/progress_line.h"
#include "editor/cli/verb.h"
#include "editor/report.h"
#include "editor/weights_import.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    const WeightsRequest request{.folder = args.positional(1),
                                 .tint = !args.has("--no-tint"),
                                 .transitions = !args.has("--no-transitions")};
    Result<WeightsReport> report = [&]() -> Result<WeightsReport> {
        auto document = Document::open(args.positional(0), OpenMode::read_write);
        if (!document) return document.error();
        ProgressLine progress;
        return import_weights(**document, request, progress.callback());
    }();
    if (!report) return report.error();
    if (args.has("--json")) {
        fmt::print("{}\n", to_report(*report).dump(2));
        return {};
    }
    fmt::print("  {:<20} {:>9} {:>9}\n", "layer", "weight", "texels");
    for (const auto& share : report->shares)
        fmt::print("  {:<20} {:>7.2f} % {:>7.2f} %\n", share.layer, 100 * share.weight, 100 * share.texels);
    for (const std::string& note : report->notes) fmt::print("{}\n", note);
    fmt::print(
        "{} texels keep {:.1f} % of the weights; mean colours are {:.2f} of 255 from the blend's ({:.2f} "
        "without tint)\n",
        report->texels, 100 * report->kept, report->color_rms, report->color_rms_plain);
    return {};
}

}  // namespace

Verb weights_verb() {
    return {.name = "weights",
            .summary = "makes the index map of painted weights (alpha masks, splat maps)",
            .positionals =
                {{"PROJECT", "project folder without a history; no window may have it open"},
                 {"FOLDER",
                  "pictures named after layers: grass.png, or grass+rock+dirt.png for channels in order"}},
            .options = {{"--no-tint", ValueKind::none, "", "leave colours as the chosen layer has them"},
                        {"--no-transitions", ValueKind::none, "", "choose among layers only"},
                        {"--json", ValueKind::none, "", "print what was lost as JSON"}},
            .run = run,
            .notes =
                "Each texel takes the layer, or the transition of the project, whose weights are nearest. "
                "The whole index "
                "map is replaced."};
}

}  // namespace loam::cli
