#include "editor/packer/pack_folder.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "editor/packer/map_image.h"
#include "editor/packer/normal_maps.h"
#include "runtime/base/srgb.h"
#include "shaders/texture/layer_math.h"

namespace loam {

namespace {

constexpr int kSmallestLayer = 4, kLargestLayer = 4096;  // runtime/store/layer_file.h
constexpr int kLargestGuess = 2048;                      // the renderer keeps no more
constexpr float kDefaultGloss = 0.25f;                   // as the layers by recipe: soil, litter, stones
constexpr double kRepeatTolerance = 0.02;                // 1024x512 is two squares; 1024x500 is not
constexpr int kMostRepeats = 8;
constexpr double kDeepest = 10;  // of a relief, as a share of the tile

struct Frame {  // what all maps of a folder share: they cover the same ground
    int size = 0, repeat_x = 1, repeat_y = 1;
};

using Texts = std::vector<std::string>;

Result<Frame> frame_of(const MapImage& color, int wanted_size, Texts& notes) {
    if (wanted_size != 0 && (wanted_size < kSmallestLayer || wanted_size > kLargestLayer ||
                             !std::has_single_bit(static_cast<unsigned>(wanted_size))))
        return error("a layer of {} texels cannot be made, must be a power of two, {} … {}", wanted_size,
                     kSmallestLayer, kLargestLayer);
    Frame frame;
    const int longer = std::max(color.width(), color.height()),
              shorter = std::min(color.width(), color.height());
    const double ratio = static_cast<double>(longer) / shorter;
    const int repeats = static_cast<int>(std::lround(ratio));
    if (repeats > 1 && repeats <= kMostRepeats && std::abs(ratio - repeats) < kRepeatTolerance) {
        (color.width() < color.height() ? frame.repeat_x : frame.repeat_y) = repeats;
        notes.push_back(fmt::format("the maps are {}x{}: repeated {} times they fill a square", color.width(),
                                    color.height(), repeats));
    } else if (longer != shorter) {
        notes.push_back(
            fmt::format("the maps are {}x{}: stretched to a square", color.width(), color.height()));
    }
    const double exponent = std::round(std::log2(static_cast<double>(longer)));
    const int nearest = std::clamp(1 << static_cast<int>(exponent), kSmallestLayer, kLargestGuess);
    frame.size = wanted_size > 0 ? wanted_size : nearest;
    return frame;
}

Plane fitted(const Plane& plane, const Frame& frame) {
    return resampled(plane, frame.repeat_x, frame.repeat_y, frame.size);
}

void say_if_resampled(std::string_view name, const MapImage& map, const Frame& frame, Texts& notes) {
    if (map.width() * frame.repeat_x == frame.size && map.height() * frame.repeat_y == frame.size) return;
    notes.push_back(fmt::format("the {} map is resampled from {}x{} to {}x{}", name, map.width(),
                                map.height(), frame.size, frame.size));
}

size_t clamped_count(std::vector<float>& values) {
    size_t count = 0;
    for (float& v : values) {
        if (v < 0 || v > 1) ++count;
        v = std::clamp(v, 0.0f, 1.0f);
    }
    return count;
}

void say_clamped(std::string_view name, size_t count, Texts& warnings) {
    if (count > 0)
        warnings.push_back(
            fmt::format("{} samples of the {} map lie outside 0 … 1 and are clamped", count, name));
}

class Packer {
  public:
    Packer(const PackRequest& request, const Progress& progress) : request_(request), progress_(progress) {}

    Result<PackedFolder> run() {
        if (!(request_.relief >= 0 && request_.relief <= kDeepest))
            return error("a relief of {} cannot be made, must be 0 … {}", request_.relief, kDeepest);
        auto maps = find_maps(request_.folder);
        if (!maps) return maps.error();
        maps_ = std::move(*maps);
        out_.notes = maps_.notes;
        LOAM_TRY(read_color());
        LOAM_TRY(step_progress(progress_, 0.3, "reading normals"));
        LOAM_TRY(read_heights());
        LOAM_TRY(read_normals());
        LOAM_TRY(step_progress(progress_, 0.7, "reading surface maps"));
        LOAM_TRY(read_surface());
        LOAM_TRY(read_metal());
        LOAM_TRY(step_progress(progress_, 1.0, "packed"));
        return std::move(out_);
    }

  private:
    [[nodiscard]] bool has(MapKind kind) const { return maps_.files.contains(kind); }
    Result<MapImage> read(MapKind kind) { return read_map(maps_.files.at(kind), out_.warnings); }
    void note(std::string text) { out_.notes.push_back(std::move(text)); }

    // A map of one channel, fitted, clamped.
    Result<std::vector<float>> read_scalar(MapKind kind) {
        auto map = read(kind);
        if (!map) return map.error();
        if (map->channels_differ)
            out_.warnings.push_back(fmt::format("the {} map is coloured: its red is used", map_name(kind)));
        say_if_resampled(map_name(kind), *map, frame_, out_.notes);
        std::vector<float> values = fitted(map->channels[0], frame_).v;
        say_clamped(map_name(kind), clamped_count(values), out_.warnings);
        return values;
    }

    // A colour map in linear light. Grey ones count for all three channels; alpha is left out.
    std::vector<glm::vec3> linear_colors(MapKind kind, const MapImage& map) {
        const bool linear =
            request_.color ? *request_.color == ColorEncoding::linear : map.is_float || map.says_linear;
        if (linear && !request_.color)
            note(fmt::format("the {} map is taken as linear: {}", map_name(kind),
                             map.is_float ? "it holds floats" : "its file says so"));
        if (map.has_alpha) note(fmt::format("the alpha of the {} map is left out", map_name(kind)));
        std::vector<glm::vec3> colors(static_cast<size_t>(frame_.size) * static_cast<size_t>(frame_.size));
        size_t clamped = 0;
        for (int c = 0; c < 3; ++c) {
            Plane plane = map.channels[static_cast<size_t>(map.color_channels() < 3 ? 0 : c)];
            clamped += clamped_count(plane.v);
            if (!linear)
                for (float& v : plane.v) v = linear_of_srgb(v);
            plane = fitted(plane, frame_);
            for (size_t i = 0; i < colors.size(); ++i) colors[i][c] = plane.v[i];
        }
        say_clamped(map_name(kind), clamped, out_.warnings);
        say_if_resampled(map_name(kind), map, frame_, out_.notes);
        return colors;
    }

    Status read_color() {
        auto map = read(MapKind::color);
        if (!map) return map.error();
        auto frame = frame_of(*map, request_.size_texels, out_.notes);
        if (!frame) return frame.error();
        frame_ = *frame;
        out_.planes.size_texels = frame_.size;
        if (map->color_channels() < 3) note("the colour map is grey");
        out_.planes.albedo = linear_colors(MapKind::color, *map);
        return {};
    }

    Status read_heights() {
        if (!has(MapKind::height)) return {};
        auto map = read(MapKind::height);
        if (!map) return map.error();
        say_if_resampled("height", *map, frame_, out_.notes);
        height_ = fitted(map->channels[0], frame_);
        return {};
    }

    Status read_normals() {
        if (has(MapKind::normal)) {
            auto map = read(MapKind::normal);
            if (!map) return map.error();
            auto normals =
                normals_of(*map, request_.normal, maps_.normal_direction, out_.notes, out_.warnings);
            if (!normals) return error("{}: {}", maps_.files[MapKind::normal].string(), normals.message());
            say_if_resampled("normal", *map, frame_, out_.notes);
            fit_normals(*normals, map->width(), map->height());
            return {};
        }
        if (!height_.v.empty()) {
            note(fmt::format("no normal map: made from the heights, {:.3g} of the tile deep",
                             request_.relief));
            const auto [low, high] = std::minmax_element(height_.v.begin(), height_.v.end());
            const float span = *high - *low;
            Plane texels = height_;
            for (float& v : texels.v)
                v *= span > 0 ? static_cast<float>(request_.relief * frame_.size) / span : 0.0f;
            out_.planes.normal = normals_of_heights(texels);
        } else {
            note("no normal and no height map: flat");
            out_.planes.normal.assign(out_.planes.albedo.size(), {0, 0, 1});
        }
        spread_.assign(out_.planes.albedo.size(), 0.0f);
        return {};
    }

    // Means of vectors; what they lose in length widens the gloss, as in mips.
    void fit_normals(const std::vector<glm::vec3>& normals, int width, int height) {
        std::vector<glm::vec3>& to = out_.planes.normal;
        to.resize(out_.planes.albedo.size());
        for (int axis = 0; axis < 3; ++axis) {
            Plane plane{width, height, std::vector<float>(normals.size())};
            for (size_t i = 0; i < normals.size(); ++i) plane.v[i] = normals[i][axis];
            plane = fitted(plane, frame_);
            for (size_t i = 0; i < to.size(); ++i) to[i][axis] = plane.v[i];
        }
        spread_.resize(to.size());
        for (size_t i = 0; i < to.size(); ++i) {
            const float length = glm::length(to[i]);
            spread_[i] = length < 1 - 1e-4f ? shared::layer_spread_alpha2(length) : 0.0f;
            to[i] = length > 1e-4f ? to[i] / length : glm::vec3(0, 0, 1);
        }
    }

    Status read_surface() {
        const size_t count = out_.planes.albedo.size();
        std::vector<float>& gloss = out_.planes.gloss;
        if (has(MapKind::roughness) || has(MapKind::gloss)) {
            const bool rough = has(MapKind::roughness);
            auto values = read_scalar(rough ? MapKind::roughness : MapKind::gloss);
            if (!values) return values.error();
            gloss = std::move(*values);
            if (rough)
                for (float& v : gloss) v = 1 - v;
        } else {
            note(fmt::format("no roughness map: roughness {} everywhere", 1 - kDefaultGloss));
            gloss.assign(count, kDefaultGloss);
        }
        for (size_t i = 0; i < count; ++i)
            if (spread_[i] > 0)
                gloss[i] =
                    shared::layer_gloss_of_alpha2(shared::layer_alpha2_of_gloss(gloss[i]) + spread_[i]);
        if (has(MapKind::occlusion)) {
            auto values = read_scalar(MapKind::occlusion);
            if (!values) return values.error();
            out_.planes.occlusion = std::move(*values);
        } else {
            note("no occlusion map: 1 everywhere");
            out_.planes.occlusion.assign(count, 1.0f);
        }
        return read_reveal();
    }

    Status read_reveal() {
        if (has(MapKind::reveal)) {
            auto values = read_scalar(MapKind::reveal);
            if (!values) return values.error();
            out_.planes.reveal = std::move(*values);
            return {};
        }
        std::vector<float> source = height_.v;
        if (source.empty()) {
            note("no reveal and no height map: reveal follows the colour's brightness");
            source.reserve(out_.planes.albedo.size());
            for (const glm::vec3& c : out_.planes.albedo)
                source.push_back(srgb_of_linear(glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f))));
        } else {
            note("no reveal map: reveal follows the heights");
        }
        // From the 1st to the 99th of a hundred, as the layers by recipe.
        std::vector<float> sorted = source;
        const auto percentile = [&](double share) {
            const auto it =
                sorted.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
            std::nth_element(sorted.begin(), it, sorted.end());
            return *it;
        };
        const float low = percentile(0.01), high = percentile(0.99);
        for (float& v : source) v = high > low ? std::clamp((v - low) / (high - low), 0.0f, 1.0f) : 0.5f;
        out_.planes.reveal = std::move(source);
        return {};
    }

    Status read_metal() {
        LayerPlanes& planes = out_.planes;
        if (has(MapKind::specular)) {
            auto map = read(MapKind::specular);
            if (!map) return map.error();
            const std::vector<glm::vec3> specular = linear_colors(MapKind::specular, *map);
            out_.fused = fused_round_trip(planes.albedo, specular);
            planes.metalness.resize(specular.size());
            for (size_t i = 0; i < specular.size(); ++i) {
                const shared::FusedAlbedo lit =
                    shared::layer_lit(shared::layer_fuse(planes.albedo[i], specular[i]));
                planes.albedo[i] = lit.albedo;
                planes.metalness[i] = lit.metalness;
            }
            note("specular becomes metalness and one fused albedo; insulators reflect 0.04");
            return {};
        }
        if (has(MapKind::metalness)) {
            auto values = read_scalar(MapKind::metalness);
            if (!values) return values.error();
            planes.metalness = std::move(*values);
        } else {
            planes.metalness.assign(planes.albedo.size(), 0.0f);
        }
        out_.fused = fused_round_trip(planes);
        return {};
    }

    const PackRequest& request_;
    const Progress& progress_;
    MapFiles maps_;
    Frame frame_;
    Plane height_;               // empty: none
    std::vector<float> spread_;  // added to alpha² of the gloss: normals that resampling averaged
    PackedFolder out_;
};

float largest(glm::vec3 v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

}  // namespace

FusedRoundTrip fused_round_trip(const std::vector<glm::vec3>& albedo,
                                const std::vector<glm::vec3>& specular) {
    FusedRoundTrip trip;
    const auto rounded = [](float v) { return std::round(std::clamp(v, 0.0f, 1.0f) * 255) / 255; };
    const auto error_of = [](const shared::AlbedoSpecular& split, glm::vec3 a, glm::vec3 s) {
        return static_cast<double>(std::max(largest(split.albedo - a), largest(split.specular - s)));
    };
    for (size_t i = 0; i < albedo.size(); ++i) {
        shared::FusedAlbedo fused = shared::layer_fuse(albedo[i], specular[i]);
        const double exact = error_of(shared::layer_split(fused), albedo[i], specular[i]);
        const double lit =
            error_of(shared::layer_reflected(shared::layer_lit(fused)), albedo[i], specular[i]);
        fused.metalness = rounded(fused.metalness);
        for (int c = 0; c < 3; ++c)
            fused.albedo[c] = linear_of_srgb(rounded(srgb_of_linear(fused.albedo[c])));
        const double stored = error_of(shared::layer_split(fused), albedo[i], specular[i]);
        trip.mean += exact;
        trip.mean_8bit += stored;
        trip.mean_lit += lit;
        trip.max = std::max(trip.max, exact);
        trip.max_8bit = std::max(trip.max_8bit, stored);
        trip.max_lit = std::max(trip.max_lit, lit);
    }
    const double count = std::max<double>(1, static_cast<double>(albedo.size()));
    trip.mean /= count;
    trip.mean_8bit /= count;
    trip.mean_lit /= count;
    return trip;
}

FusedRoundTrip fused_round_trip(const LayerPlanes& planes) {
    std::vector<glm::vec3> albedo(planes.albedo.size()), specular(planes.albedo.size());
    for (size_t i = 0; i < albedo.size(); ++i) {
        const shared::AlbedoSpecular split = shared::layer_reflected({planes.albedo[i], planes.metalness[i]});
        albedo[i] = split.albedo;
        specular[i] = split.specular;
    }
    return fused_round_trip(albedo, specular);
}

Result<PackedFolder> pack_folder(const PackRequest& request, const Progress& progress) {
    return Packer(request, progress).run();
}

}  // namespace loam
