#include "editor/cli/verb.h"
#include "editor/packer/pack_report.h"
#include "editor/report.h"
#include "editor/settings.h"
#include "runtime/gpu/device.h"

namespace loam::cli {

namespace {

void print_tree(const Json& json, int indent) {
    for (const auto& [key, value] : json.items()) {
        const std::string label = fmt::format("{:{}}{}", "", indent, key);
        if (value.is_object()) {
            fmt::print("{}\n", label);
            print_tree(value, indent + 2);
        } else if (value.is_array() && !value.empty() && value.front().is_object()) {
            fmt::print("{}\n", label);
            for (const Json& row : value) {
                std::string line;
                for (const auto& [name, cell] : row.items())
                    line += fmt::format("{}{}", line.empty() ? "" : "  ",
                                        cell.is_string() ? cell.get<std::string>() : cell.dump());
                fmt::print("{:{}}{}\n", "", indent + 2, line);
            }
        } else {
            fmt::print("{:<26} {}\n", label, value.is_string() ? value.get<std::string>() : value.dump());
        }
    }
}

Result<Json> report_of(const Args& args) {
    auto desc = session_desc(args);
    if (!desc) return desc.error();
    desc->mode = OpenMode::read_only;
    auto session = Session::open(args.positional(0), *desc);
    if (!session) return session.error();
    Json json;
    json["settings"] = to_report((*session)->document().settings());
    json["statistics"] = to_report((*session)->document().statistics());
    json["devices"] = gpu::device_names();
    if (args.has("--settings"))
        for (const SettingText& s : list_settings(desc->renderer))
            json["renderer"].push_back(
                {{"name", s.name}, {"value", s.value}, {"range", s.range}, {"help", s.help}});
    if (!args.has("--gpu")) return json;
    const PixelSize size = args.size("--size", {960, 540});
    LOAM_TRY((*session)->step((*session)->default_camera(), size.width, size.height, {}, 8));
    auto renderer = (*session)->renderer();
    if (!renderer) return renderer.error();
    json["device"] = (*session)->device()->caps().name;
    json["frame"] = to_report((*renderer)->statistics());
    json["allocated_bytes"] = memory_report(**session);
    return json;
}

// A line a layer, or all rows as JSON.
Status print_layers(const Args& args) {
    auto document = Document::open(args.positional(0), OpenMode::read_only);
    if (!document) return document.error();
    Json all = Json::array();
    for (const LayerEntry& layer : (*document)->settings().layers) {
        if (layer.blend) continue;  // has no textures of its own
        auto report = report_of_layer((*document)->folder() / layer.file);
        if (!report) return error("layer \"{}\": {}", layer.name, report.message());
        if (args.has("--json"))
            all.push_back(
                {{"name", layer.name}, {"file", layer.file}, {"tile_m", layer.tile_m}, {"report", *report}});
        else
            fmt::print("{}\n", pack_line(layer.name, *report));
    }
    if (args.has("--json")) fmt::print("{}\n", all.dump(2));
    return {};
}

Status run(const Args& args) {
    if (args.has("--layers")) return print_layers(args);
    auto json = report_of(args);
    if (!json) return json.error();
    if (args.has("--json"))
        fmt::print("{}\n", json->dump(2));
    else
        print_tree(*json, 0);
    return {};
}

}  // namespace

Verb info_verb() {
    return {
        .name = "info",
        .summary = "prints settings, sizes and devices of a project",
        .positionals = {{"PROJECT", "project folder"}},
        .options = with_device_options(
            {{"--gpu", ValueKind::none, "", "render a few frames and print the memory table and the passes"},
             {"--settings", ValueKind::none, "", "print the figures that --set changes"},
             {"--size", ValueKind::size, "WxH", "of those frames; default 960x540"},
             {"--layers", ValueKind::none, "",
              "instead: what each layer costs and loses, eight bits a value → the formats chosen (loam "
              "pack)"},
             {"--json", ValueKind::none, "", "print as JSON"}}),
        .run = run};
}

}  // namespace loam::cli
