#include "editor/packer/map_files.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace loam {

namespace fs = std::filesystem;

namespace {

struct Word {
    std::string_view text;
    MapKind kind;
};
constexpr Word kWords[] = {
    {"color", MapKind::color},         {"colour", MapKind::color},
    {"col", MapKind::color},           {"albedo", MapKind::color},
    {"alb", MapKind::color},           {"diff", MapKind::color},
    {"diffuse", MapKind::color},       {"basecolor", MapKind::color},
    {"basecolour", MapKind::color},    {"normal", MapKind::normal},
    {"normals", MapKind::normal},      {"nor", MapKind::normal},
    {"nrm", MapKind::normal},          {"norm", MapKind::normal},
    {"normalgl", MapKind::normal},     {"normaldx", MapKind::normal},
    {"roughness", MapKind::roughness}, {"rough", MapKind::roughness},
    {"gloss", MapKind::gloss},         {"glossiness", MapKind::gloss},
    {"smoothness", MapKind::gloss},    {"smooth", MapKind::gloss},
    {"ao", MapKind::occlusion},        {"occlusion", MapKind::occlusion},
    {"occ", MapKind::occlusion},       {"ambientocclusion", MapKind::occlusion},
    {"displacement", MapKind::height}, {"disp", MapKind::height},
    {"height", MapKind::height},       {"heightmap", MapKind::height},
    {"bump", MapKind::height},         {"reveal", MapKind::reveal},
    {"metalness", MapKind::metalness}, {"metallic", MapKind::metalness},
    {"metal", MapKind::metalness},     {"specular", MapKind::specular},
    {"spec", MapKind::specular},
};
constexpr std::string_view kIgnored[] = {"opacity",  "alpha",      "mask",         "transparency",
                                         "emission", "emissive",   "translucency", "transmission",
                                         "sss",      "scattering", "thickness",    "arm",
                                         "orm",      "preview",    "thumbnail"};
constexpr std::string_view kPictures[] = {".png", ".jpg", ".jpeg", ".tif",  ".tiff",
                                          ".exr", ".tga", ".bmp",  ".webp", ".hdr"};

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

// "Ground037_1K-JPG_NormalGL" → ground, 037, 1, k, jpg, normal, gl.
std::vector<std::string> words_of(std::string_view stem) {
    enum class Class { other, digit, small, large };
    const auto class_of = [](char c) {
        const auto u = static_cast<unsigned char>(c);
        if (std::isdigit(u)) return Class::digit;
        if (std::islower(u)) return Class::small;
        return std::isupper(u) ? Class::large : Class::other;
    };
    std::vector<std::string> words;
    Class before = Class::other;
    for (const char c : stem) {
        const Class now = class_of(c);
        const bool joins = now == before || (before == Class::large && now == Class::small);
        if (now != Class::other) {
            if (!joins || words.empty()) words.emplace_back();
            words.back() += c;
        }
        before = now;
    }
    for (std::string& word : words) word = lower(word);
    return words;
}

}  // namespace

std::string_view map_name(MapKind kind) {
    constexpr std::string_view names[] = {"colour", "normal", "roughness", "gloss",   "occlusion",
                                          "height", "reveal", "metalness", "specular"};
    return names[static_cast<size_t>(kind)];
}

NameMeaning meaning_of_name(std::string_view file_stem) {
    NameMeaning meaning;
    const std::vector<std::string> words = words_of(file_stem);
    std::optional<NormalDirection> direction;
    for (size_t i = words.size(); i-- > 0;) {
        const std::string& word = words[i];
        if (word == "gl" || word == "opengl" || word == "normalgl") direction = NormalDirection::gl;
        if (word == "dx" || word == "directx" || (word == "x" && i > 0 && words[i - 1] == "direct") ||
            word == "normaldx")
            direction = NormalDirection::dx;
        const auto found =
            std::find_if(std::begin(kWords), std::end(kWords), [&](const Word& w) { return w.text == word; });
        if (found != std::end(kWords)) {
            meaning.kind = found->kind;
            if (meaning.kind == MapKind::normal) meaning.direction = direction;
            return meaning;
        }
        if (std::find(std::begin(kIgnored), std::end(kIgnored), word) != std::end(kIgnored)) {
            meaning.ignored = true;
            return meaning;
        }
    }
    return meaning;
}

Result<MapFiles> find_maps(const fs::path& folder) {
    std::error_code code;
    if (!fs::exists(folder, code)) return error("there is no folder {}", folder.string());
    if (!fs::is_directory(folder, code))
        return error("{} is a file, expected a folder of maps", folder.string());
    std::vector<fs::path> pictures;
    for (fs::directory_iterator entry(folder, code), end; !code && entry != end; entry.increment(code)) {
        const std::string extension = lower(entry->path().extension().string());
        if (std::find(std::begin(kPictures), std::end(kPictures), extension) != std::end(kPictures))
            pictures.push_back(entry->path());
    }
    if (code) return error("cannot read the folder {}: {}", folder.string(), code.message());
    std::sort(pictures.begin(), pictures.end());

    MapFiles maps;
    for (const fs::path& file : pictures) {
        const NameMeaning meaning = meaning_of_name(file.stem().string());
        const std::string name = file.filename().string();
        if (!meaning.kind) {
            maps.notes.push_back(meaning.ignored
                                     ? fmt::format("{} is left out: layers have no such map", name)
                                     : fmt::format("{} is left out: its name says no map", name));
            continue;
        }
        fs::path& place = maps.files[*meaning.kind];
        const bool second = !place.empty();
        const bool two_directions = second && meaning.kind == MapKind::normal && meaning.direction &&
                                    maps.normal_direction && meaning.direction != maps.normal_direction;
        if (second && !two_directions)
            return error("{} and {} both look like the {} map of {}: remove one", place.filename().string(),
                         name, map_name(*meaning.kind), folder.string());
        if (two_directions) {
            const bool use_new = meaning.direction == NormalDirection::gl;
            maps.notes.push_back(fmt::format("{} is left out: the OpenGL normals are used",
                                             use_new ? place.filename().string() : name));
            if (!use_new) continue;
        }
        place = file;
        if (meaning.kind == MapKind::normal) maps.normal_direction = meaning.direction;
    }
    if (!maps.files.contains(MapKind::color))
        return error(
            "{} has no colour map: expected a picture with a name such as {}_Color.png, _albedo, _diff "
            "or _basecolor, found {} picture{}",
            folder.string(), folder.filename().string(), pictures.size(), pictures.size() == 1 ? "" : "s");
    const auto drop = [&](MapKind unused, MapKind used) {
        if (!maps.files.contains(unused) || !maps.files.contains(used)) return;
        maps.notes.push_back(fmt::format("{} is left out: the {} map is used",
                                         maps.files[unused].filename().string(), map_name(used)));
        maps.files.erase(unused);
    };
    drop(MapKind::gloss, MapKind::roughness);
    drop(MapKind::specular, MapKind::metalness);
    return maps;
}

}  // namespace loam
