// Rules of project.toml that hold wherever the settings come from.
#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/base/units.h"
#include "runtime/store/project.h"

namespace loam {

namespace {

constexpr int kMaxSamples = 1 << 17;  // 0.125 m over the largest map
constexpr size_t kMaxLayers = 1024;

Status check_number(const char* name, double value, double low, double high) {
    if (std::isfinite(value) && value >= low && value <= high) return {};
    return error("{} is {}, must be {} … {}", name, value, low, high);
}

bool is_power_of_two(double value) {
    int exponent = 0;
    return std::frexp(value, &exponent) == 0.5;
}

Status check_inside(const std::string& path) {
    const std::filesystem::path file(path);
    bool climbs = file.is_absolute();
    for (const auto& part : file) climbs |= part == "..";
    return climbs ? error("the file \"{}\" is outside the project; give a path relative to it", path)
                  : Status();
}

Status check_layer(const LayerEntry& layer, std::set<std::string>& names) {
    if (layer.name.empty()) return error("a layer has no name");
    if (!names.insert(layer.name).second)
        return error("two layers are called \"{}\"; names must be unique", layer.name);
    if (const Status inside = check_inside(layer.file); !inside.ok())
        return error("layer \"{}\": {}", layer.name, inside.message());
    const auto check = [&](const char* key, double value, double low, double high) -> Status {
        const Status status = check_number(key, value, low, high);
        return status.ok() ? status : error("layer \"{}\": {}", layer.name, status.message());
    };
    LOAM_TRY(check("tile_m", layer.tile_m, 0.01, 10000));
    LOAM_TRY(check("softness", layer.softness, 0, 1));
    for (size_t c = 0; c < kChannelNames.size(); ++c)
        LOAM_TRY(check(kChannelNames[c], layer.channels[c], 0, 1));
    return {};
}

Status check_blends(const std::vector<LayerEntry>& layers) {
    const auto has_textures = [&](const std::string& name) {
        return std::any_of(layers.begin(), layers.end(),
                           [&](const LayerEntry& l) { return l.name == name && !l.blend; });
    };
    for (const LayerEntry& layer : layers) {
        if (!layer.blend) continue;
        if (!layer.file.empty())
            return error("layer \"{}\" has a blend and a file; a transition has no textures of its own",
                         layer.name);
        for (const std::string& side : {layer.blend->from, layer.blend->to})
            if (!has_textures(side))
                return error("transition \"{}\": there is no layer \"{}\" with textures", layer.name, side);
        if (layer.blend->from == layer.blend->to)
            return error("transition \"{}\" is from \"{}\" to itself", layer.name, layer.blend->from);
        if (const Status status = check_number("threshold", layer.blend->threshold, 0, 1); !status.ok())
            return error("transition \"{}\": {}", layer.name, status.message());
    }
    return {};
}

Status check_ground(const ProjectSettings& settings) {
    const GroundSettings& ground = settings.ground;
    // An index page's border holds what a lookup reaches that moves by one texel, and no more.
    if (const Status status = check_number("distortion_amplitude_m", ground.distortion_amplitude_m, 0,
                                           settings.index_spacing_m);
        !status.ok())
        return error("{} (index_spacing_m): a lookup moves by one index texel at most", status.message());
    LOAM_TRY(check_number("distortion_period_m", ground.distortion_period_m, 1, 4096));
    LOAM_TRY(check_number("vista_scale", ground.vista_scale, kVistaScale.min, kVistaScale.max));
    return check_number("vista_distance_m", ground.vista_distance_m, kVistaDistance_m.min,
                        kVistaDistance_m.max);
}

Status check_imagery(const ImagerySettings& imagery) {
    if (const Status inside = check_inside(imagery.file); !inside.ok())
        return error("[imagery]: {}", inside.message());
    LOAM_TRY(check_number("imagery.strength", imagery.strength, 0, 1));
    return check_number("imagery.distance_m", imagery.distance_m, kImageryDistance_m.min,
                        kImageryDistance_m.max);
}

}  // namespace

std::vector<int> palette_order(const ProjectSettings& settings) {
    std::vector<int> order;
    std::vector<bool> taken(settings.layers.size());
    for (size_t i = 0; i < settings.layers.size(); ++i)
        taken[i] = settings.layers[i].blend && settings.layers[i].blend->removed;
    for (const std::string& name : settings.palette)
        for (size_t i = 0; i < settings.layers.size(); ++i)
            if (!taken[i] && settings.layers[i].name == name) {
                taken[i] = true;
                order.push_back(int(i));
            }
    for (size_t i = 0; i < settings.layers.size(); ++i)
        if (!taken[i]) order.push_back(int(i));
    return order;
}

int default_refine(double height_spacing_m) {
    int refine = 0;
    while (refine < 6 && height_spacing_m / double(2 << refine) >= 0.25) ++refine;
    return refine;
}

Status check_settings(const ProjectSettings& settings) {
    LOAM_TRY(check_number("height_samples (x)", settings.height_samples_x, 2, kMaxSamples));
    LOAM_TRY(check_number("height_samples (y)", settings.height_samples_y, 2, kMaxSamples));
    LOAM_TRY(check_number("height_spacing_m", settings.height_spacing_m, 0.01, 1000));
    const WorldRect bounds = settings.bounds();
    if (bounds.width() > kMaxMapSize_m || bounds.height() > kMaxMapSize_m)
        return error("the map is {} x {} m, the limit is {} m a side", bounds.width(), bounds.height(),
                     kMaxMapSize_m);
    LOAM_TRY(check_number("refine", settings.refine, 0, 6));
    LOAM_TRY(check_number("index_spacing_m", settings.index_spacing_m, 0.25, 64));
    if (!is_power_of_two(settings.index_spacing_m))
        return error("index_spacing_m is {}, must be a power of two from 0.25 to 64",
                     settings.index_spacing_m);
    LOAM_TRY(
        check_number("default_height_mm", settings.default_height_mm, -kHeightLimit_mm, kHeightLimit_mm));
    if (settings.layers.size() > kMaxLayers)
        return error("{} layers, the limit is {}", settings.layers.size(), kMaxLayers);
    if (settings.default_layer >= std::max<size_t>(1, settings.layers.size()))
        return error("default_layer is {}, there are {} layers", settings.default_layer,
                     settings.layers.size());
    std::set<std::string> names;
    for (const LayerEntry& layer : settings.layers) LOAM_TRY(check_layer(layer, names));
    LOAM_TRY(check_blends(settings.layers));
    LOAM_TRY(check_ground(settings));
    LOAM_TRY(check_imagery(settings.imagery));
    if (settings.channels.size() > kMostChannelsOfAMap)
        return error("[texture] channels names {}, pages hold {}: leave some out", settings.channels.size(),
                     kMostChannelsOfAMap);
    for (size_t i = 0; i < settings.channels.size(); ++i)
        for (size_t k = 0; k < i; ++k)
            if (settings.channels[i] == settings.channels[k])
                return error("[texture] channels names \"{}\" twice",
                             kChannelNames[size_t(settings.channels[i])]);
    LOAM_TRY(check_number("azimuth_rad", settings.sun_azimuth_rad, -100, 100));
    LOAM_TRY(check_number("elevation_rad", settings.sun_elevation_rad, -1.5708, 1.5708));
    LOAM_TRY(check_number("haze_per_km", settings.haze_per_km, 0, 100));
    return {};
}

}  // namespace loam
