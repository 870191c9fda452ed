#include <nlohmann/json.hpp>

#include "editor/cli/verb.h"
#include "editor/stamp_import.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    const auto added = add_stamp(args.positional(0), args.positional(1), args.text("--name"));
    if (!added) return added.error();
    if (args.has("--json")) {
        const nlohmann::ordered_json json = {{"name", added->name},       {"width", added->width},
                                             {"height", added->height},   {"colours", added->has_colors},
                                             {"cover", added->has_cover}, {"black", added->black},
                                             {"white", added->white},     {"notes", added->notes}};
        fmt::print("{}\n", json.dump(2));
        return {};
    }
    for (const std::string& note : added->notes) fmt::print("{}\n", note);
    fmt::print("stamp \"{}\" is ready: {} x {} texels, {} black to {} white{}{}\n", added->name, added->width,
               added->height, added->black, added->white, added->has_colors ? ", colours" : "",
               added->has_cover ? ", cover" : "");
    return {};
}

}  // namespace

Verb stamp_verb() {
    return {
        .name = "stamp",
        .summary = "makes a stamp of a picture",
        .positionals = {{"PROJECT", "project folder"}, {"FILE", "any picture: its brightness is the height"}},
        .options = {{"--name", ValueKind::text, "N", "of the stamp; default: the file's"},
                    {"--json", ValueKind::none, "", "print what it has as JSON"}},
        .run = run,
        .notes =
            "Laid on the ground by the command stamp of scripts, Project.stamp of Python and the window's "
            "Stamp "
            "tool. An alpha channel says where there is any of it."};
}

}  // namespace loam::cli
