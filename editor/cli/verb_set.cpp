#include "editor/cli/verb.h"
#include "editor/settings_text.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    auto document = Document::open(args.positional(0), OpenMode::read_write);
    if (!document) return document.error();
    ProjectSettings settings = (*document)->settings();
    LOAM_TRY(set_by_name(settings, args.positional(1), args.positional(2)));
    return (*document)->change_settings(settings);
}

}  // namespace

Verb set_verb() {
    static const std::string notes = [] {
        std::string text = "Settings and their defaults:";
        for (const NamedSetting& setting : named_settings({}))
            text += fmt::format("\n  {:<32} {}", setting.name, setting.value);
        return text;
    }();
    return {.name = "set",
            .summary = "changes a setting of a project",
            .positionals = {{"PROJECT", "project folder"},
                            {"NAME", "which, see below"},
                            {"VALUE", "a number, true or false"}},
            .options = {},
            .run = run,
            .notes = notes.c_str()};
}

}  // namespace loam::cli
