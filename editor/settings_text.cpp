#include "editor/settings_text.h"

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

}  // namespace

std::vector<NamedSetting> named_settings(const ProjectSettings& settings) {
    ProjectSettings copy = settings;
    std::vector<NamedSetting> list;
    for (const Entry& entry : kEntries)
        list.push_back({entry.name, entry.number ? fmt::format("{}", *entry.number(copy))
                                    : entry.flag ? fmt::format("{}", *entry.flag(copy))
                                                 : *entry.text(copy)});
    return list;
}

Status set_by_name(ProjectSettings& settings, std::string_view name, std::string_view value) {
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
        const auto number = parse_number(value);
        if (!number) return error("{} is \"{}\", must be a number", name, value);
        *entry.number(settings) = *number;
        return {};
    }
    return error("unknown setting \"{}\" (known: {})", name, known);
}

}  // namespace loam
