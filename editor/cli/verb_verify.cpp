#include <nlohmann/json.hpp>

#include "editor/cli/verb.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    auto faults = Document::verify(args.positional(0));
    if (!faults) return faults.error();
    if (args.has("--json"))
        fmt::print("{}\n", nlohmann::ordered_json{{"faults", *faults}}.dump(2));
    else
        for (const std::string& fault : *faults) fmt::print("{}\n", fault);
    if (faults->empty()) {
        if (!args.has("--json")) fmt::print("no fault found\n");
        return {};
    }
    return error("{} {} found in {}", faults->size(), faults->size() == 1 ? "fault" : "faults",
                 args.positional(0));
}

}  // namespace

Verb verify_verb() {
    return {.name = "verify",
            .summary = "reads every page, operator and journal entry and says what is wrong",
            .positionals = {{"PROJECT", "project folder"}},
            .options = {{"--json", ValueKind::none, "", "print the faults as JSON"}},
            .run = run};
}

}  // namespace loam::cli
