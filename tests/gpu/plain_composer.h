// A plain composer written from the talk's description, in doubles, with loops and a sort, sharing nothing
// with the shaders but the hash that says which section turns how; tints are those that the map's blocks
// show (maps/tint_blocks.h). Source: Call of Duty talk, "One Material
// Per Vertex", "Distortion", "Tile Hiding": the four index texels around a texel weigh bilinearly, equal
// layers (with tile hiding: of one section) are merged, alpha is doubled and clamped, layers are sorted, the
// lowest is opaque, reveal cuts the edge.
//
// Longer than 200 lines because it is one composer, to be read beside the talk from top to bottom.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>
#include <vector>

#include "runtime/document/document.h"
#include "runtime/maps/half.h"
#include "runtime/maps/tint_blocks.h"
#include "runtime/texture/distortion.h"
#include "shaders/document/noise_math.h"
#include "tests/gpu/texture_world.h"

namespace loam::test {

inline constexpr double kIndexSpacing_m = 0.5;  // MapFixtureDesc's
inline constexpr double kSoftness = 0.25;       // of the reveal's edge

inline double linear_of(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

struct RandomMap {
    int width = 0, height = 0;
    std::vector<IndexTexel> texels;
    bool compressed_tints = true;
    [[nodiscard]] const IndexTexel& at(int x, int y) const {
        return texels[size_t(std::clamp(y, 0, height - 1)) * size_t(width) +
                      size_t(std::clamp(x, 0, width - 1))];
    }
    // 0…1: as the page of a level shows it, whose blocks are of the level's own vertices.
    [[nodiscard]] glm::dvec3 tint(int x, int y, int level) const {
        const IndexTexel& exact = at(x << level, y << level);
        if (!compressed_tints) return glm::dvec3(exact.tint[0], exact.tint[1], exact.tint[2]) / 255.0;
        const glm::ivec2 first(x & ~3, y & ~3);
        std::array<IndexTexel, 16> block;
        for (int i = 0; i < 16; ++i)
            block[size_t(i)] = at((first.x + i % 4) << level, (first.y + i / 4) << level);
        glm::uvec2 encoded;
        encode_tint_blocks(block, 4, {0, 0, 1, 1}, {&encoded, 1});
        return shown_tint(encoded, (y & 3) * 4 + (x & 3));
    }
};

// Speckles of all layers in some places, larger areas in others; tints that are not dark.
inline RandomMap write_random_map(World& w) {
    const glm::ivec2 size = w.document().index_size_texels();
    RandomMap map{size.x, size.y, std::vector<IndexTexel>(size_t(size.x) * size_t(size.y)),
                  w.index->compressed_tints()};
    for (size_t i = 0; i < map.texels.size(); ++i) {
        IndexTexel& t = map.texels[i];
        const bool speckled = i / 16 % 2 == 0;
        t.layer =
            uint16_t(w.fixture.uniform(0, speckled ? 1 : 6) == 0 ? w.fixture.uniform(0, w.layers->count - 1)
                                                                 : int(i / 16 % 2));
        for (uint8_t& c : t.tint) c = uint8_t(w.fixture.uniform(128, 255));
    }
    BulkWriter writer(w.document());
    for (int y = 0; y < size.y; ++y)
        need(writer.write_index_rows(
            y, 1, std::span(map.texels).subspan(size_t(y) * size_t(size.x), size_t(size.x))));
    need(writer.finish());
    return map;
}

struct PlainTransition {
    int from = 0, to = 0;
    double threshold = 0.5;
};

struct PlainWorld {
    const RandomMap& map;
    std::vector<LayerTextures> layers{};
    std::vector<double> tiles_m;
    GroundSettings ground;
    std::vector<std::vector<glm::u16vec2>> distortion = make_distortion();
    std::map<int, PlainTransition> transitions{};  // by layer
    ImagerySettings imagery{};
    // Of squares of half an index spacing, rows from the south.
    int imagery_width = 0, imagery_height = 0;
    std::vector<std::array<uint8_t, 4>> imagery_texels{};
};

// albedo r g b linear, normal x y, gloss, occlusion as stored; reveal
using Channels = std::array<double, 8>;

// Four texels of a square image that repeats, and their weights.
template <typename Take>
void bilinear(int side, double u, double v, const Take& take) {
    const double x = (u - std::floor(u)) * side - 0.5, y = (v - std::floor(v)) * side - 0.5;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    for (int corner = 0; corner < 4; ++corner) {
        const int i = corner & 1, j = corner >> 1;
        const double weight = (i ? x - x0 : 1 - (x - x0)) * (j ? y - y0 : 1 - (y - y0));
        take(size_t((y0 + j + side) % side) * size_t(side) + size_t((x0 + i + side) % side), weight);
    }
}

inline int nearest_mip(double log2_texels) {
    return std::max(0, int(std::floor(log2_texels + 0.5)));
}

inline Channels layer_at(const LayerTextures& layer, int mip, double u, double v) {
    Channels sum{};
    bilinear(std::max(1, int(layer.size_texels) >> mip), u, v, [&](size_t texel, double weight) {
        const uint8_t* albedo = &layer.albedo_reveal[size_t(mip)][texel * 4];
        const uint8_t* surface = &layer.normal_gloss_occlusion[size_t(mip)][texel * 4];
        for (size_t c = 0; c < 3; ++c) sum[c] += weight * linear_of(albedo[c] / 255.0);
        for (size_t c = 0; c < 4; ++c) sum[3 + c] += weight * surface[c] / 255.0;
        sum[7] += weight * albedo[3] / 255.0;
    });
    return sum;
}

inline glm::dvec2 distorted(const PlainWorld& w, glm::dvec2 world, double texel_m) {
    const GroundSettings& g = w.ground;
    if (g.distortion_amplitude_m <= 0) return world;
    const int mip = std::min(nearest_mip(std::log2(texel_m * kDistortionTexels / g.distortion_period_m)),
                             int(w.distortion.size()) - 1);
    const glm::dvec2 at = world / g.distortion_period_m;
    glm::dvec2 moved(0);
    bilinear(kDistortionTexels >> mip, at.x, at.y, [&](size_t texel, double weight) {
        const glm::u16vec2 t = w.distortion[size_t(mip)][texel];
        moved += weight * glm::dvec2(float_from_half(t.x), float_from_half(t.y));
    });
    return world + moved * g.distortion_amplitude_m;
}

// Which section of four by four vertices of level 0 a vertex is in, and how that is turned.
struct Section {
    int x = 0, y = 0, turn = 0;
    glm::dvec2 shift{0};
};

inline Section section_of(int vertex_x, int vertex_y) {
    Section s{int(std::floor(vertex_x / 4.0)), int(std::floor(vertex_y / 4.0))};
    const uint32_t hash = shared::noise_cell(s.x, s.y, 0x7115u);
    s.turn = int(hash % 16);
    s.shift = glm::dvec2(hash / 256 % 256, hash / 65536 % 256) / 256.0;
    return s;
}

inline double plain_cover(double alpha, double reveal) {
    return std::clamp((alpha * (1 + kSoftness) - (1 - reveal)) / kSoftness, 0.0, 1.0);
}

// How much is seen of what begins at a distance, in texels that are meant for so far away: 5 feet a
// millimetre.
inline double plain_far(double begin_m, double texel_m) {
    return std::clamp(std::log2(texel_m * 1524 / begin_m) / 2, 0.0, 1.0);
}

inline double plain_vista(const GroundSettings& g, double texel_m) {
    return g.vista_scale <= 1 ? 0 : plain_far(g.vista_distance_m, texel_m);
}

// Linear colour and weight of the imagery at a place: each level the mean of two by two of the one below, by
// cover, kept as bytes; between the centres of its texels.
inline glm::dvec4 plain_imagery(const PlainWorld& w, glm::dvec2 world, double texel_m, int level) {
    if (!w.imagery.is_on()) return glm::dvec4(0);
    const int side = 1 << level;
    const auto texel = [&](int x, int y) {
        glm::dvec4 sum(0);
        x = std::clamp(x, 0, (w.imagery_width - 1) / side);
        y = std::clamp(y, 0, (w.imagery_height - 1) / side);
        double count = 0;
        for (int j = y * side; j < std::min((y + 1) * side, w.imagery_height); ++j)
            for (int i = x * side; i < std::min((x + 1) * side, w.imagery_width); ++i, ++count) {
                const auto& t = w.imagery_texels[size_t(j) * size_t(w.imagery_width) + size_t(i)];
                const double cover = t[3] / 255.0;
                sum += glm::dvec4(linear_of(t[0] / 255.0) * cover, linear_of(t[1] / 255.0) * cover,
                                  linear_of(t[2] / 255.0) * cover, cover);
            }
        return sum / count;
    };
    const glm::dvec2 at = world / (kIndexSpacing_m / 2 * side) - 0.5, corner = glm::floor(at),
                     f = at - corner;
    glm::dvec4 sum(0);
    for (int k = 0; k < 4; ++k)
        sum += (k & 1 ? f.x : 1 - f.x) * (k & 2 ? f.y : 1 - f.y) *
               texel(int(corner.x) + (k & 1), int(corner.y) + (k >> 1));
    return sum * (w.imagery.strength * plain_far(w.imagery.distance_m, texel_m));
}

// One layer's textures at a place, turned as the section says.
inline Channels plain_near_layer(const PlainWorld& w, int layer, const Section& section, glm::dvec2 world,
                                 double texel_m) {
    const double tile_m = w.tiles_m[size_t(layer)];
    const LayerTextures& textures = w.layers[size_t(layer)];
    const int mip = nearest_mip(std::log2(texel_m * textures.size_texels / tile_m));
    if (!w.ground.tile_hiding) return layer_at(textures, mip, world.x / tile_m, world.y / tile_m);
    const double angle = section.turn * std::numbers::pi / 8;
    const glm::dvec2 middle = (glm::dvec2(section.x, section.y) * 4.0 + 1.5) * kIndexSpacing_m;
    const glm::dvec2 from = (world - middle) / tile_m;
    const glm::dvec2 uv = glm::dvec2(std::cos(angle) * from.x - std::sin(angle) * from.y,
                                     std::sin(angle) * from.x + std::cos(angle) * from.y) +
                          section.shift;
    Channels c = layer_at(textures, mip, uv.x, uv.y);
    const double x = c[3] - 128 / 255.0, y = c[4] - 128 / 255.0;
    c[3] = 128 / 255.0 + std::cos(angle) * x + std::sin(angle) * y;
    c[4] = 128 / 255.0 - std::sin(angle) * x + std::cos(angle) * y;
    return c;
}

// With the magnified lookup of albedo, normal, gloss and occlusion over it, which nothing turns.
inline Channels plain_layer(const PlainWorld& w, int layer, const Section& section, glm::dvec2 world,
                            double texel_m) {
    Channels c = plain_near_layer(w, layer, section, world, texel_m);
    const double share = plain_vista(w.ground, texel_m),
                 far_m = w.tiles_m[size_t(layer)] * w.ground.vista_scale;
    if (share <= 0) return c;
    const LayerTextures& textures = w.layers[size_t(layer)];
    const Channels far = layer_at(textures, nearest_mip(std::log2(texel_m * textures.size_texels / far_m)),
                                  world.x / far_m, world.y / far_m);
    for (size_t k = 0; k < 7; ++k) c[k] += (far[k] - c[k]) * share;
    return c;
}

// The material of a place as the index map's level has it; turns: which ones were used.
inline Channels plain_material(const PlainWorld& w, glm::dvec2 world, double texel_m, int level,
                               std::set<int>* turns = nullptr) {
    struct Merged {
        double alpha = 0;
        glm::dvec3 tint{0};
        Section section;
    };
    // layer, turn, then the section's parities: the order of blending
    std::map<std::tuple<int, int, int, int>, Merged> merged;
    const double spacing_m = kIndexSpacing_m * (1 << level);
    const glm::dvec2 at = distorted(w, world, texel_m) / spacing_m, corner = glm::floor(at), f = at - corner;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const double weight = (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y);
            if (weight <= 0) continue;
            const int x = (int(corner.x) + i) << level, y = (int(corner.y) + j) << level;
            const IndexTexel& t = w.map.at(x, y);
            const Section section = w.ground.tile_hiding ? section_of(x, y) : Section{};
            Merged& m = merged[{t.layer, section.turn, section.y & 1, section.x & 1}];
            m.alpha += weight;
            m.tint += weight * w.map.tint(int(corner.x) + i, int(corner.y) + j, level);
            m.section = section;
            if (turns) turns->insert(section.turn);
        }
    Channels shown{};
    bool lowest = true;
    for (const auto& [key, m] : merged) {
        const int layer = std::get<0>(key);
        Channels c{};
        if (const auto found = w.transitions.find(layer); found != w.transitions.end()) {
            const PlainTransition& t = found->second;
            c = plain_layer(w, t.from, m.section, world, texel_m);
            const Channels over = plain_layer(w, t.to, m.section, world, texel_m);
            const double cover = plain_cover(t.threshold, over[7]);
            for (size_t k = 0; k < c.size(); ++k) c[k] += (over[k] - c[k]) * cover;
        } else {
            c = plain_layer(w, layer, m.section, world, texel_m);
        }
        for (int k = 0; k < 3; ++k) c[size_t(k)] *= linear_of(m.tint[k] / m.alpha);
        const double alpha = std::clamp(2 * m.alpha, 0.0, 1.0);
        const double cover = lowest ? 1 : plain_cover(alpha, c[7]);
        for (size_t k = 0; k < 7; ++k) shown[k] += (c[k] - shown[k]) * cover;
        lowest = false;
    }
    const glm::dvec4 far = plain_imagery(w, world, texel_m, level);
    for (int k = 0; k < 3; ++k) shown[size_t(k)] = shown[size_t(k)] * (1 - far.w) + far[k];
    return shown;
}

// What a texel stores in the three textures, 0 … 255.
inline std::array<std::array<double, 3>, 3> stored_texel(const Channels& shown) {
    const auto normal = [](double stored) {
        return std::clamp(130 + 125 * ((stored * 255 - 128) / 127), 0.0, 255.0);
    };
    return {{{255 * std::sqrt(shown[0]), 255 * std::sqrt(shown[1]), 255 * std::sqrt(shown[2])},
             {255 * shown[5], normal(shown[3]), 255 * shown[6]},
             {0, normal(shown[4]), 0}}};
}

}  // namespace loam::test
