// The table of verbs and what they share.
#pragma once

#include <vector>

#include "editor/cli/args.h"
#include "editor/session.h"

namespace loam::cli {

struct Verb {
    const char* name;
    const char* summary;
    std::vector<Positional> positionals;
    std::vector<Option> options;
    Status (*run)(const Args& args);
    const char* notes = "";  // below the options in the help
};

[[nodiscard]] const std::vector<Verb>& verbs();
[[nodiscard]] std::string help_text(const Verb& verb);
[[nodiscard]] std::string overview_text();

// One file a verb.
[[nodiscard]] Verb edit_verb();
[[nodiscard]] Verb new_verb();
[[nodiscard]] Verb import_verb();
[[nodiscard]] Verb export_verb();
[[nodiscard]] Verb encode_verb();
[[nodiscard]] Verb replay_verb();
[[nodiscard]] Verb render_verb();
[[nodiscard]] Verb info_verb();
[[nodiscard]] Verb set_verb();
[[nodiscard]] Verb transition_verb();
[[nodiscard]] Verb verify_verb();
[[nodiscard]] Verb bench_verb();
[[nodiscard]] Verb layer_verb();
[[nodiscard]] Verb stamp_verb();
[[nodiscard]] Verb function_verb();
[[nodiscard]] Verb imagery_verb();
[[nodiscard]] Verb weights_verb();
[[nodiscard]] Verb pack_verb();

// --device, --validation, --quality, --format, --set: for every verb that renders.
[[nodiscard]] std::vector<Option> with_device_options(std::vector<Option> options);
[[nodiscard]] Result<SessionDesc> session_desc(const Args& args);

// --size, --normal, --color, --relief: for the verbs that read a folder of maps.
[[nodiscard]] std::vector<Option> with_pack_options(std::vector<Option> options);
[[nodiscard]] Result<PackRequest> pack_request(const Args& args, const std::string& folder);

}  // namespace loam::cli
