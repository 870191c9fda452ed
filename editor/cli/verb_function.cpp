#include <fstream>
#include <iterator>

#include "editor/cli/verb.h"
#include "editor/report.h"

namespace loam::cli {

namespace {

void print_list(const Json& list) {
    for (const Json& f : list) {
        fmt::print("{}: {}\n", f["name"].get<std::string>(), f.value("says", f.value("error", "")));
        if (!f.contains("parameters")) continue;
        for (const auto& [name, p] : f["parameters"].items())
            fmt::print("    {} {} ({} … {})  {}\n", name, p["value"].get<double>(), p["min"].get<double>(),
                       p["max"].get<double>(), p["says"].get<std::string>());
    }
}

Status run(const Args& args) {
    const std::string name = args.text("--name"), file = args.text("--set");
    if (!file.empty() && name.empty())
        return error("--set needs --name, the function that the file is the text of");
    auto document =
        Document::open(args.positional(0), file.empty() ? OpenMode::read_only : OpenMode::read_write);
    if (!document) return document.error();
    if (!file.empty()) {
        std::ifstream stream(file, std::ios::binary);
        std::error_code none;
        if (!stream || std::filesystem::is_directory(file, none)) return error("cannot read {}", file);
        const auto set = (*document)->apply(
            {FunctionCommand{name, std::string(std::istreambuf_iterator<char>(stream), {})}});
        if (!set) return set.error();
    }
    FunctionLibrary& functions = (*document)->functions();
    if (name.empty() || args.has("--json")) {
        const Json list = function_report(functions);
        if (args.has("--json"))
            fmt::print("{}\n", list.dump(2));
        else
            print_list(list);
        return {};
    }
    if (!file.empty()) return {};
    const auto text = functions.text(name);
    if (!text) return text.error();
    fmt::print("{}", *text);
    return {};
}

}  // namespace

Verb function_verb() {
    return {
        .name = "function",
        .summary = "lists the functions that decals can be made by, prints one's text or sets it",
        .positionals = {{"PROJECT", "project folder"}},
        .options = {{"--name", ValueKind::text, "N", "print the text of this one"},
                    {"--set", ValueKind::text, "FILE", "make FILE the text of --name, if it compiles"},
                    {"--json", ValueKind::none, "", "print the list as JSON"}},
        .run = run,
        .notes =
            "docs/decal_functions.md says how they are written. A decal is made by one with \"function\" and "
            "\"parameters\" in its command."};
}

}  // namespace loam::cli
