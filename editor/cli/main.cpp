// loam VERB …: finds the verb, parses its arguments, runs it, and says one sentence when it failed.
#include <cstdio>
#include <exception>

#include "editor/cli/verb.h"

namespace {

constexpr int kFailed = 1, kUsage = 2;

int complain(std::string_view prefix, std::string_view message, int status) {
    fmt::print(stderr, "loam: {}{}\n", prefix, message);
    return status;
}

int run(const std::vector<std::string>& words) {
    using namespace loam::cli;
    if (words.empty()) {
        fmt::print(stderr, "{}", overview_text());
        return kUsage;
    }
    if (words[0] == "--help" || words[0] == "-h" || words[0] == "help") {
        fmt::print("{}", overview_text());
        return 0;
    }
    const Verb* verb = nullptr;
    std::vector<std::string> names;
    for (const Verb& v : verbs()) {
        names.emplace_back(v.name);
        if (words[0] == v.name) verb = &v;
    }
    if (!verb) {
        const std::string nearest = loam::nearest_word(words[0], names);
        const std::string hint =
            nearest.empty() ? "see loam --help" : fmt::format("did you mean {}?", nearest);
        return complain("", fmt::format("unknown verb \"{}\", {}", words[0], hint), kUsage);
    }
    for (const std::string& word : words)
        if (word == "--help" || word == "-h") {
            fmt::print("{}", help_text(*verb));
            return 0;
        }
    const std::string prefix = fmt::format("{}: ", verb->name);
    const auto args = parse_args(verb->positionals, verb->options, std::span(words).subspan(1));
    if (!args)
        return complain(prefix, fmt::format("{}; see loam {} --help", args.message(), verb->name), kUsage);
    const loam::Status status = verb->run(*args);
    std::fflush(stdout);
    return status.ok() ? 0 : complain(prefix, status.message(), kFailed);
}

}  // namespace

int main(int argc, char** argv) {
    try {
        return run({argv + 1, argv + argc});
    } catch (const std::exception& exception) {  // out of memory and the like
        return complain("", exception.what(), kFailed);
    }
}
