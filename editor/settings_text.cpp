#include "editor/settings_text.h"

#include "editor/text_numbers.h"

namespace loam {

namespace {

struct Entry {
    const char* name;
    double* (*number)(ProjectSettings&);
    bool* (*flag)(ProjectSettings&);
};

constexpr Entry kEntries[] = {
    {"sun.azimuth_rad", [](ProjectSettings& s) { return &s.sun_azimuth_rad; }, nullptr},
    {"sun.elevation_rad", [](ProjectSettings& s) { return &s.sun_elevation_rad; }, nullptr},
    {"air.haze_per_km", [](ProjectSettings& s) { return &s.haze_per_km; }, nullptr},
    {"ground.distortion_amplitude_m", [](ProjectSettings& s) { return &s.ground.distortion_amplitude_m; },
     nullptr},
    {"ground.distortion_period_m", [](ProjectSettings& s) { return &s.ground.distortion_period_m; }, nullptr},
    {"ground.tile_hiding", nullptr, [](ProjectSettings& s) { return &s.ground.tile_hiding; }},
    {"ground.vista_scale", [](ProjectSettings& s) { return &s.ground.vista_scale; }, nullptr},
    {"ground.vista_distance_m", [](ProjectSettings& s) { return &s.ground.vista_distance_m; }, nullptr},
};

}  // namespace

std::vector<NamedSetting> named_settings(const ProjectSettings& settings) {
    ProjectSettings copy = settings;
    std::vector<NamedSetting> list;
    for (const Entry& entry : kEntries)
        list.push_back({entry.name, entry.number ? fmt::format("{}", *entry.number(copy))
                                                 : fmt::format("{}", *entry.flag(copy))});
    return list;
}

Status set_by_name(ProjectSettings& settings, std::string_view name, std::string_view value) {
    std::string known;
    for (const Entry& entry : kEntries) {
        known += fmt::format("{}{}", known.empty() ? "" : ", ", entry.name);
        if (name != entry.name) continue;
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
