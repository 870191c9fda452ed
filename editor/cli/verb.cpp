#include "editor/cli/verb.h"

#include <algorithm>
#include <iterator>

#include "editor/choices.h"
#include "editor/settings.h"

namespace loam::cli {

namespace {

std::string shown(const Option& option) {
    return *option.value ? fmt::format("{} {}", option.name, option.value) : std::string(option.name);
}

}  // namespace

const std::vector<Verb>& verbs() {
    static const std::vector<Verb> table = {
        edit_verb(),     new_verb(),     import_verb(),  export_verb(),     layer_verb(),  stamp_verb(),
        function_verb(), imagery_verb(), weights_verb(), pack_verb(),       encode_verb(), replay_verb(),
        render_verb(),   info_verb(),    set_verb(),     transition_verb(), verify_verb(), bench_verb()};
    return table;
}

std::string help_text(const Verb& verb) {
    std::string text = fmt::format("loam {}", verb.name);
    for (const Positional& p : verb.positionals) text += fmt::format(" {}", p.name);
    if (!verb.options.empty()) text += " [options]";
    text += fmt::format("\n\n{}\n", verb.summary);
    size_t width = 6;
    for (const Positional& p : verb.positionals) width = std::max(width, std::string_view(p.name).size());
    for (const Option& o : verb.options) width = std::max(width, shown(o).size());
    text += "\n";
    for (const Positional& p : verb.positionals) text += fmt::format("  {:<{}}  {}\n", p.name, width, p.help);
    for (const Option& o : verb.options) text += fmt::format("  {:<{}}  {}\n", shown(o), width, o.help);
    text += fmt::format("  {:<{}}  {}\n", "--help", width, "this text");
    if (*verb.notes) text += fmt::format("\n{}\n", verb.notes);
    return text;
}

std::string overview_text() {
    std::string text = "loam VERB …: a live terrain editor\n\n";
    for (const Verb& verb : verbs()) text += fmt::format("  {:<8} {}\n", verb.name, verb.summary);
    return text +
           "\nloam VERB --help says more about a verb. Exit status: 0 done, 1 failed, 2 wrong usage.\n";
}

std::vector<Option> with_device_options(std::vector<Option> options) {
    const Option device[] = {
        {"--device", ValueKind::text, "NAME", "part of the Vulkan device's name, or its number"},
        {"--validation", ValueKind::none, "", "Vulkan validation; its messages fail the command"},
        {"--quality", ValueKind::text, "Q",
         "very_low, low, mid, high or ultra: the size of the virtual texture"},
        {"--format", ValueKind::text, "F", 
         "bc1, bc3, bc1x4 or rgba8: the format of texture pages; default by device and the map's channels"},
        {"--set", ValueKind::text, "NAME=VALUE[,…]",
         "figures of the renderer; loam info --settings lists them"},
    };
    options.insert(options.end(), std::begin(device), std::end(device));
    return options;
}

Result<SessionDesc> session_desc(const Args& args) {
    SessionDesc desc;
    desc.device.device_filter = args.text("--device");
    desc.device.validation = args.has("--validation");
    if (args.has("--quality")) {
        auto quality = parse_quality(args.text("--quality"));
        if (!quality) return quality.error();
        desc.renderer.quality = *quality;
    }
    if (args.has("--format")) {
        auto format = parse_page_format(args.text("--format"));
        if (!format) return format.error();
        desc.renderer.page_format = *format;
    }
    LOAM_TRY(change_settings(desc.renderer, args.text("--set")));
    return desc;
}

std::vector<Option> with_pack_options(std::vector<Option> options) {
    const Option pack[] = {
        {"--size", ValueKind::integer, "N",
         "texels a side, a power of two; default: nearest to the colour map, at most 2048"},
        {"--normal", ValueKind::text, "D",
         "gl or dx: green points up or down; default: by name, else by the slopes"},
        {"--color", ValueKind::text, "E", "srgb or linear; default: floats are linear, integers sRGB"},
        {"--relief", ValueKind::number, "SHARE",
         "depth of a height map as a share of the tile, for normals made of it; default 0.03"},
    };
    options.insert(options.end(), std::begin(pack), std::end(pack));
    return options;
}

Result<PackRequest> pack_request(const Args& args, const std::string& folder) {
    PackRequest request{.folder = folder, .size_texels = args.integer("--size", 0)};
    if (args.has("--size") && request.size_texels <= 0)
        return error("--size {} must be above 0", request.size_texels);
    if (args.has("--normal")) {
        auto direction = parse_normal_direction(args.text("--normal"));
        if (!direction) return direction.error();
        request.normal = *direction;
    }
    if (args.has("--color")) {
        auto encoding = parse_color_encoding(args.text("--color"));
        if (!encoding) return encoding.error();
        request.color = *encoding;
    }
    request.relief = args.number("--relief", request.relief);
    return request;
}

}  // namespace loam::cli
