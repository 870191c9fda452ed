#include "editor/settings_text.h"

#include <algorithm>

#include <fmt/ranges.h>

#include "editor/text_numbers.h"

namespace loam {

namespace {

struct Entry {
    const char* name;
    double* (*number)(ProjectSettings&);
    bool* (*flag)(ProjectSettings&) = nullptr;
    std::string* (*text)(ProjectSettings&) = nullptr;
};

constexpr Entry kEntries[] = {
    {"sun.azimuth_rad", [](ProjectSettings& s) { return &s.sun_azimuth_rad; }},
    {"sun.elevation_rad", [](ProjectSettings& s) { return &s.sun_elevation_rad; }},
    {"air.haze_per_km", [](ProjectSettings& s) { return &s.haze_per_km; }},
    {"ground.distortion_amplitude_m", [](ProjectSettings& s) { return &s.ground.distortion_amplitude_m; }},
    {"ground.distortion_period_m", [](ProjectSettings& s) { return &s.ground.distortion_period_m; }},
    {"ground.tile_hiding", nullptr, [](ProjectSettings& s) { return &s.ground.tile_hiding; }},
    {"ground.vista_scale", [](ProjectSettings& s) { return &s.ground.vista_scale; }},
    {"ground.vista_distance_m", [](ProjectSettings& s) { return &s.ground.vista_distance_m; }},
    {"imagery.file", nullptr, nullptr, [](ProjectSettings& s) { return &s.imagery.file; }},
    {"imagery.strength", [](ProjectSettings& s) { return &s.imagery.strength; }},
    {"imagery.distance_m", [](ProjectSettings& s) { return &s.imagery.distance_m; }},
};

Status set_number(double& number, std::string_view name, std::string_view value) {
    const auto parsed = parse_number(value);
    if (!parsed) return error("{} is \"{}\", must be a number", name, value);
    number = *parsed;
    return {};
}

constexpr std::string_view kLayer = "layer.";

// The key follows the last dot: names of layers may have some.
Status set_of_layer(ProjectSettings& settings, std::string_view name, std::string_view value) {
    const std::string_view rest = name.substr(kLayer.size());
    const size_t dot = std::min(rest.rfind('.'), rest.size());
    const std::string_view layer = rest.substr(0, dot), key = rest.substr(std::min(dot + 1, rest.size()));
    for (LayerEntry& entry : settings.layers) {
        if (entry.name != layer) continue;
        if (entry.blend) return error("\"{}\" is a transition: loam transition changes it", layer);
        if (key == "tile_m") return set_number(entry.tile_m, name, value);
        if (key == "softness") return set_number(entry.softness, name, value);
        for (size_t c = 0; c < kChannelNames.size(); ++c)
            if (key == kChannelNames[c]) return set_number(entry.channels[c], name, value);
        return error("a layer has no setting \"{}\" (known: tile_m, softness, {})", key,
                     fmt::join(kChannelNames, ", "));
    }
    return error("the project has no layer \"{}\"", layer);
}

}  // namespace

std::vector<NamedSetting> named_settings(const ProjectSettings& settings) {
    ProjectSettings copy = settings;
    std::vector<NamedSetting> list;
    for (const Entry& entry : kEntries)
        list.push_back({entry.name, entry.number ? fmt::format("{}", *entry.number(copy))
                                    : entry.flag ? fmt::format("{}", *entry.flag(copy))
                                                 : *entry.text(copy)});
    for (const LayerEntry& layer : settings.layers) {
        if (layer.blend) continue;
        const auto add = [&](std::string_view key, double value) {
            list.push_back({fmt::format("{}{}.{}", kLayer, layer.name, key), fmt::format("{}", value)});
        };
        add("tile_m", layer.tile_m);
        add("softness", layer.softness);
        for (const Channel channel : settings.channels)
            add(kChannelNames[size_t(channel)], layer.channels[size_t(channel)]);
    }
    return list;
}

Status set_by_name(ProjectSettings& settings, std::string_view name, std::string_view value) {
    if (name.starts_with(kLayer)) return set_of_layer(settings, name, value);
    std::string known;
    for (const Entry& entry : kEntries) {
        known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
        if (name != entry.name) continue;
        if (entry.text) {
            *entry.text(settings) = value;
            return {};
        }
        if (entry.flag) {
            if (value != "true" && value != "false")
                return error("{} is \"{}\", must be true or false", name, value);
            *entry.flag(settings) = value == "true";
            return {};
        }
        return set_number(*entry.number(settings), name, value);
    }
    return error("unknown setting \"{}\" (known: {}, layer.NAME.KEY)", name, known);
}

}  // namespace loam
