#include <chrono>

#include <nlohmann/json.hpp>

#include "editor/cli/verb.h"
#include "editor/script.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    auto session = Session::open(args.positional(0), {});
    if (!session) return session.error();
    const bool commit_log = args.has("--commit-log");
    const auto start = std::chrono::steady_clock::now();
    uint64_t count = 0;
    LOAM_TRY(run_script(args.positional(1), [&](const Command& command) -> Status {
        auto dirt = (*session)->apply(command);
        if (!dirt) return dirt.error();
        ++count;
        if (commit_log) {
            fmt::print("committed {}\n", count);
            std::fflush(stdout);  // said only after it is on disk, and at once: whoever kills us believes it
        }
        return {};
    }));
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (args.has("--json"))
        fmt::print("{}\n", nlohmann::ordered_json{{"commands", count}, {"seconds", seconds}}.dump());
    else if (!commit_log)
        fmt::print("{} commands in {:.2f} s\n", count, seconds);
    return {};
}

}  // namespace

Verb replay_verb() {
    return {.name = "replay",
            .summary = "runs a script of commands",
            .positionals = {{"PROJECT", "project folder"},
                            {"SCRIPT", "one command a line as JSON; # begins a comment line"}},
            .options = {{"--commit-log", ValueKind::none, "",
                         "print \"committed N\" once command N is safe on disk"},
                        {"--json", ValueKind::none, "", "print figures as JSON"}},
            .run = run,
            .notes = "Stops at the first line that fails; what came before stays done."};
}

}  // namespace loam::cli
