// project.toml in and out. The only file that sees toml++; its exceptions end here.
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <map>
#include <sstream>

#include "runtime/store/packed_file.h"
#include "runtime/store/project.h"

#if defined(__GNUC__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#endif
#define TOML_HEADER_ONLY 1
#include <toml++/toml.h>
#if defined(__GNUC__)
#pragma GCC diagnostic pop
#endif

namespace loam {

namespace {

// Thrown inside this file only and turned into an Error by load_project.
struct Refused {
    std::string message;
    toml::source_position where;
};

template <typename... Args>
[[noreturn]] void refuse(const toml::node& node, fmt::format_string<Args...> format, Args&&... args) {
    throw Refused{fmt::format(format, std::forward<Args>(args)...), node.source().begin};
}

using Readers = std::map<std::string, std::function<void(const toml::node&)>, std::less<>>;

// Calls the reader of every key; a key without one is refused.
void read_table(const toml::table& table, const char* place, const Readers& readers) {
    for (const auto& [key, node] : table) {
        const auto reader = readers.find(std::string_view(key.str()));
        if (reader == readers.end()) {
            std::string known;
            for (const auto& [name, unused] : readers) {
                if (!known.empty()) known += ", ";
                known += name;
            }
            throw Refused{fmt::format("unknown key \"{}\" in {} (known: {})", std::string_view(key.str()),
                                      place, known),
                          key.source().begin};
        }
        reader->second(node);
    }
}

const toml::table& table_of(const toml::node& node, const char* name) {
    if (const auto* table = node.as_table()) return *table;
    refuse(node, "{} must be a table", name);
}

std::string string_of(const toml::node& node, const char* name) {
    if (const auto* text = node.as_string()) return text->get();
    refuse(node, "{} must be a text in quotes", name);
}

double number_of(const toml::node& node, const char* name, double low, double high) {
    double value = 0;
    if (const auto* whole = node.as_integer())
        value = double(whole->get());
    else if (const auto* real = node.as_floating_point())
        value = real->get();
    else
        refuse(node, "{} must be a number", name);
    if (!(std::isfinite(value) && value >= low && value <= high))
        refuse(node, "{} is {}, must be {} … {}", name, value, low, high);
    return value;
}

bool flag_of(const toml::node& node, const char* name) {
    if (const auto* flag = node.as_boolean()) return flag->get();
    refuse(node, "{} must be true or false", name);
}

int64_t whole_of(const toml::node& node, const char* name, int64_t low, int64_t high) {
    const auto* whole = node.as_integer();
    if (!whole) refuse(node, "{} must be a whole number", name);
    if (whole->get() < low || whole->get() > high)
        refuse(node, "{} is {}, must be {} … {}", name, whole->get(), low, high);
    return whole->get();
}

LayerEntry layer_of(const toml::node& node) {
    LayerEntry layer;
    LayerEntry::Blend blend;
    const toml::node* only_blends = nullptr;
    const auto read_blend = [&](const toml::node& n) {
        const auto* pair = n.as_array();
        if (!pair || pair->size() != 2) refuse(n, "blend must be [from, to], the names of two layers");
        blend.from = string_of(*pair->get(0), "blend (from)");
        blend.to = string_of(*pair->get(1), "blend (to)");
        layer.blend = blend;
    };
    const toml::table& table = table_of(node, "layer");
    Readers readers = {
        {"name", [&](const toml::node& n) { layer.name = string_of(n, "name"); }},
        {"file", [&](const toml::node& n) { layer.file = string_of(n, "file"); }},
        {"tile_m", [&](const toml::node& n) { layer.tile_m = number_of(n, "tile_m", 0.01, 10000); }},
        {"softness", [&](const toml::node& n) { layer.softness = number_of(n, "softness", 0, 1); }},
        {"blend", read_blend},
        {"threshold",
         [&](const toml::node& n) {
             blend.threshold = number_of(n, "threshold", 0, 1);
             only_blends = &n;
         }},
        {"removed", [&](const toml::node& n) {
             blend.removed = flag_of(n, "removed");
             only_blends = &n;
         }}};
    for (size_t c = 0; c < kChannelNames.size(); ++c)
        readers[kChannelNames[c]] = [&layer, c](const toml::node& n) {
            layer.channels[c] = number_of(n, kChannelNames[c], 0, 1);
        };
    read_table(table, "[[layer]]", readers);
    if (layer.blend) {
        layer.blend->threshold = blend.threshold;
        layer.blend->removed = blend.removed;
    } else if (only_blends) {
        refuse(*only_blends, "threshold and removed belong to layers with a blend");
    }
    if (layer.name.empty()) refuse(node, "a layer needs a name");
    return layer;
}

Channel channel_of(const toml::node& node) {
    const std::string name = string_of(node, "a channel");
    std::string known;
    for (size_t c = 0; c < kChannelNames.size(); ++c) {
        if (name == kChannelNames[c]) return Channel(c);
        known += fmt::format("{}{}", known.empty() ? "" : ", ", kChannelNames[c]);
    }
    refuse(node, "unknown channel \"{}\" in [texture] (known: {})", name, known);
}

ProjectSettings settings_of(const toml::table& root) {
    ProjectSettings s;
    bool has_samples = false, has_refine = false;
    const auto read_terrain = [&](const toml::node& node) {
        const auto samples = [&](const toml::node& n) {
            const auto* pair = n.as_array();
            if (!pair || pair->size() != 2)
                refuse(n, "height_samples must be [east, north], two whole numbers");
            s.height_samples_x = int(whole_of(*pair->get(0), "height_samples (x)", 2, 1 << 17));
            s.height_samples_y = int(whole_of(*pair->get(1), "height_samples (y)", 2, 1 << 17));
            has_samples = true;
        };
        const auto refine = [&](const toml::node& n) {
            s.refine = int(whole_of(n, "refine", 0, 6));
            has_refine = true;
        };
        read_table(
            table_of(node, "terrain"), "[terrain]",
            {{"height_samples", samples},
             {"refine", refine},
             {"height_spacing_m",
              [&](const toml::node& n) {
                  s.height_spacing_m = number_of(n, "height_spacing_m", 0.01, 1000);
              }},
             {"index_spacing_m",
              [&](const toml::node& n) { s.index_spacing_m = number_of(n, "index_spacing_m", 0.25, 64); }},
             {"default_height_mm",
              [&](const toml::node& n) {
                  s.default_height_mm = int32_t(whole_of(n, "default_height_mm", -16384000, 16384000));
              }},
             {"default_layer", [&](const toml::node& n) {
                  s.default_layer = uint16_t(whole_of(n, "default_layer", 0, 65535));
              }}});
    };
    const auto read_sun = [&](const toml::node& node) {
        read_table(
            table_of(node, "sun"), "[sun]",
            {{"azimuth_rad",
              [&](const toml::node& n) { s.sun_azimuth_rad = number_of(n, "azimuth_rad", -100, 100); }},
             {"elevation_rad", [&](const toml::node& n) {
                  s.sun_elevation_rad = number_of(n, "elevation_rad", -1.5708, 1.5708);
              }}});
    };
    const auto read_air = [&](const toml::node& node) {
        read_table(table_of(node, "air"), "[air]", {{"haze_per_km", [&](const toml::node& n) {
                                                         s.haze_per_km = number_of(n, "haze_per_km", 0, 100);
                                                     }}});
    };
    const auto read_roles = [&](const toml::node& node) {
        read_table(table_of(node, "roles"), "[roles]",
                   {{"scorched", [&](const toml::node& n) { s.roles.scorched = string_of(n, "scorched"); }},
                    {"broken", [&](const toml::node& n) { s.roles.broken = string_of(n, "broken"); }}});
    };
    const auto read_ground = [&](const toml::node& node) {
        GroundSettings& g = s.ground;
        read_table(table_of(node, "ground"), "[ground]",
                   {{"distortion_amplitude_m",
                     [&](const toml::node& n) {
                         g.distortion_amplitude_m = number_of(n, "distortion_amplitude_m", 0, 64);
                     }},
                    {"distortion_period_m",
                     [&](const toml::node& n) {
                         g.distortion_period_m = number_of(n, "distortion_period_m", 1, 4096);
                     }},
                    {"tile_hiding", [&](const toml::node& n) { g.tile_hiding = flag_of(n, "tile_hiding"); }},
                    {"vista_scale",
                     [&](const toml::node& n) {
                         g.vista_scale = number_of(n, "vista_scale", kVistaScale.min, kVistaScale.max);
                     }},
                    {"vista_distance_m", [&](const toml::node& n) {
                         g.vista_distance_m =
                             number_of(n, "vista_distance_m", kVistaDistance_m.min, kVistaDistance_m.max);
                     }}});
    };
    const auto read_imagery = [&](const toml::node& node) {
        ImagerySettings& i = s.imagery;
        read_table(table_of(node, "imagery"), "[imagery]",
                   {{"file", [&](const toml::node& n) { i.file = string_of(n, "file"); }},
                    {"strength", [&](const toml::node& n) { i.strength = number_of(n, "strength", 0, 1); }},
                    {"distance_m", [&](const toml::node& n) {
                         i.distance_m =
                             number_of(n, "distance_m", kImageryDistance_m.min, kImageryDistance_m.max);
                     }}});
    };
    const auto read_palette = [&](const toml::node& node) {
        read_table(table_of(node, "palette"), "[palette]",
                   {{"order", [&](const toml::node& n) {
                         const auto* list = n.as_array();
                         if (!list) refuse(n, "order must be a list of layer names");
                         for (const toml::node& name : *list) s.palette.push_back(string_of(name, "order"));
                     }}});
    };
    const auto read_texture = [&](const toml::node& node) {
        read_table(table_of(node, "texture"), "[texture]",
                   {{"channels", [&](const toml::node& n) {
                         const auto* list = n.as_array();
                         if (!list) refuse(n, "channels must be a list of names");
                         for (const toml::node& name : *list) s.channels.push_back(channel_of(name));
                     }}});
    };
    const auto read_layers = [&](const toml::node& node) {
        const auto* layers = node.as_array();
        if (!layers) refuse(node, "layer must be a list of tables: [[layer]]");
        for (const toml::node& layer : *layers) s.layers.push_back(layer_of(layer));
    };
    read_table(root, "the project",
               {{"name", [&](const toml::node& n) { s.name = string_of(n, "name"); }},
                {"terrain", read_terrain},
                {"sun", read_sun},
                {"air", read_air},
                {"roles", read_roles},
                {"ground", read_ground},
                {"imagery", read_imagery},
                {"palette", read_palette},
                {"texture", read_texture},
                {"layer", read_layers}});
    if (!has_samples) refuse(root, "height_samples is missing in [terrain]");
    if (!has_refine) s.refine = default_refine(s.height_spacing_m);
    return s;
}

std::string toml_text(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            out.append(1, '\\').append(1, c);
        else if (uint8_t(c) < 0x20 || c == 0x7f)
            out += fmt::format("\\u{:04X}", uint8_t(c));
        else
            out += c;
    }
    return out + "\"";
}

// The shortest text that reads back as the same number; TOML wants a point or an exponent in a real number.
std::string toml_real(double value) {
    std::string text = fmt::format("{}", value);
    if (text.find_first_of(".e") == std::string::npos) text += ".0";
    return text;
}

std::string text_of(const ProjectSettings& s) {
    std::string out = fmt::format("name = {}\n\n[terrain]\n", toml_text(s.name));
    out += fmt::format("height_samples = [{}, {}] # east, north\n", s.height_samples_x, s.height_samples_y);
    out += fmt::format("height_spacing_m = {}\nrefine = {}\n", toml_real(s.height_spacing_m), s.refine);
    out += fmt::format("index_spacing_m = {}\n", toml_real(s.index_spacing_m));
    out += fmt::format("default_height_mm = {}\ndefault_layer = {}\n", s.default_height_mm, s.default_layer);
    out += fmt::format("\n[sun]\nazimuth_rad = {} # clockwise from north\nelevation_rad = {}\n",
                       toml_real(s.sun_azimuth_rad), toml_real(s.sun_elevation_rad));
    out += fmt::format("\n[air]\nhaze_per_km = {}\n", toml_real(s.haze_per_km));
    out += fmt::format("\n[roles]\nscorched = {}\nbroken = {}\n", toml_text(s.roles.scorched),
                       toml_text(s.roles.broken));
    if (!s.channels.empty()) {
        std::string names;
        for (const Channel channel : s.channels)
            names += (names.empty() ? "" : ", ") + toml_text(kChannelNames[size_t(channel)]);
        out += fmt::format("\n[texture]\nchannels = [{}]\n", names);
    }
    out += fmt::format("\n[ground]\ndistortion_amplitude_m = {} # at most index_spacing_m; 0: off\n",
                       toml_real(s.ground.distortion_amplitude_m));
    out += fmt::format("distortion_period_m = {}\ntile_hiding = {}\n",
                       toml_real(s.ground.distortion_period_m), s.ground.tile_hiding);
    out += fmt::format("vista_scale = {} # 1: off\nvista_distance_m = {}\n", toml_real(s.ground.vista_scale),
                       toml_real(s.ground.vista_distance_m));
    if (s.imagery != ImagerySettings{})
        out += fmt::format("\n[imagery]\nfile = {}\nstrength = {} # 0: off\ndistance_m = {}\n",
                           toml_text(s.imagery.file), toml_real(s.imagery.strength),
                           toml_real(s.imagery.distance_m));
    if (!s.palette.empty()) {
        std::string names;
        for (const std::string& name : s.palette) names += (names.empty() ? "" : ", ") + toml_text(name);
        out += fmt::format(
            "\n[palette]\norder = [{}] # the order of [[layer]] is what the map's numbers mean\n", names);
    }
    for (const LayerEntry& layer : s.layers) {
        out += fmt::format("\n[[layer]]\nname = {}\n", toml_text(layer.name));
        if (layer.blend) {
            out += fmt::format("blend = [{}, {}]\nthreshold = {}\n", toml_text(layer.blend->from),
                               toml_text(layer.blend->to), toml_real(layer.blend->threshold));
            if (layer.blend->removed) out += "removed = true # its place in the list is kept\n";
            continue;
        }
        out += fmt::format("file = {}\ntile_m = {}\n", toml_text(layer.file), toml_real(layer.tile_m));
        if (layer.softness != LayerEntry{}.softness)
            out += fmt::format("softness = {}\n", toml_real(layer.softness));
        for (size_t c = 0; c < kChannelNames.size(); ++c)
            if (layer.channels[c] != 0)
                out += fmt::format("{} = {}\n", kChannelNames[c], toml_real(layer.channels[c]));
    }
    return out;
}

}  // namespace

Result<ProjectSettings> load_project(const std::filesystem::path& folder) {
    std::error_code failure;
    if (!std::filesystem::is_directory(folder, failure))
        return error("there is no folder {}", folder.string());
    const std::filesystem::path file = folder / "project.toml";
    std::ifstream stream(file, std::ios::binary);
    if (!stream) return error("{} cannot be read: {}; is it a project?", file.string(), std::strerror(errno));
    std::ostringstream text;
    text << stream.rdbuf();
    try {
        const toml::table root = toml::parse(text.view(), file.string());
        ProjectSettings settings = settings_of(root);
        const Status status = check_settings(settings);
        if (!status.ok()) return error("{}: {}", file.string(), status.message());
        return settings;
    } catch (const Refused& refused) {
        return error("{}:{}: {}", file.string(), refused.where.line, refused.message);
    } catch (const toml::parse_error& bad) {
        return error("{}:{}: {}", file.string(), bad.source().begin.line, bad.description());
    } catch (const std::exception& bad) {
        return error("{}: {}", file.string(), bad.what());
    }
}

Status save_project(const std::filesystem::path& folder, const ProjectSettings& settings) {
    LOAM_TRY(check_settings(settings));
    const std::string text = text_of(settings);
    return replace_file(folder / "project.toml",
                        {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

}  // namespace loam
