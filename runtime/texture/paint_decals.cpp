#include "runtime/texture/paint_decals.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "runtime/base/srgb.h"
#include "runtime/document/document.h"
#include "runtime/document/function_library.h"
#include "runtime/maps/height_compose.h"
#include "runtime/texture/layer_set.h"
#include "runtime/texture/page_id.h"

namespace loam {

namespace {

float phase_of(double repeats) {
    return float(repeats - std::floor(repeats));
}

// What the kinds share; returns the size of a repeat of the layer.
double set_material(const Document& document, const LayerSet& layers, LayerTier tier, const DecalMaterial& m,
                    shared::PaintDecal& out) {
    const int layer = layer_of(document, layers, m);
    const double tile_m = layer < 0 ? 1 : tile_of(document, layers, m, layer);
    shared::LayerPlace place{};
    place.lod_bias = float(std::log2(layers.size_texels / tile_m));
    if (layer >= 0) layers.fill_place(layer, tier, place);
    out.layer = layer < 0 ? -1 : int(place.slot);
    out.tiles_per_m = float(1.0 / tile_m);
    out.lod_bias = place.lod_bias;
    out.colour = {float(linear_of_srgb(m.colour.x)), float(linear_of_srgb(m.colour.y)),
                  float(linear_of_srgb(m.colour.z))};
    out.gloss = float(m.gloss);
    out.metalness = float(m.metalness);
    out.opacity = float(m.opacity);
    out.edge = float(m.edge);
    out.rough = float(m.rough);
    out.seed = m.seed;
    out.albedo_share = float(m.channels.albedo);
    out.normal_share = float(m.channels.normal);
    out.gloss_share = float(m.channels.gloss);
    out.metal_share = float(m.channels.metalness);
    out.occlusion_share = float(m.channels.occlusion);
    if (m.function.empty()) return tile_m;
    if (const auto function = document.functions().shown(m.function)) {
        const std::vector<double> values = parameter_values(*function, m.parameters);
        for (size_t i = 0; i < values.size(); ++i)
            (i < 4 ? out.parameters_a : out.parameters_b)[int(i % 4)] = float(values[i]);
    }
    return tile_m;
}

// A negative half size mirrors its axis.
void set_box(VolumeAxes axes, glm::dvec3 half_m, glm::dvec3 center_rel_m, double tile_m,
             shared::PaintDecal& out) {
    if (half_m.x < 0) axes.x = -axes.x;
    if (half_m.y < 0) axes.y = -axes.y;
    out.center_m = glm::vec3(center_rel_m);
    out.axis_x = glm::vec3(axes.x);
    out.axis_y = glm::vec3(axes.y);
    out.axis_z = glm::vec3(axes.z);
    out.half_m = glm::vec3(glm::abs(half_m));
    out.phase = {phase_of(-glm::dot(center_rel_m, axes.x) / tile_m),
                 phase_of(-glm::dot(center_rel_m, axes.y) / tile_m)};
}

}  // namespace

std::optional<uint32_t> place_of_function(const Document& document, const DecalMaterial& material,
                                          FunctionList& functions) {
    if (material.function.empty()) return 0;
    auto shown = document.functions().shown(material.function);
    if (!shown) return std::nullopt;
    for (size_t i = 0; i < functions.size(); ++i) {
        if (functions[i]->name != material.function) continue;
        functions[i] = std::move(shown);
        return uint32_t(i + 1);
    }
    functions.push_back(std::move(shown));
    return uint32_t(functions.size());
}

int layer_of(const Document& document, const LayerSet& layers, const DecalMaterial& material) {
    return material.layer.empty() ? -1 : std::min(document.layer_index(material.layer), layers.count - 1);
}

double tile_of(const Document& document, const LayerSet& layers, const DecalMaterial& material, int layer) {
    const double tile_m = layers.tiles_m[size_t(layer)];
    // A repeated small layer's whole texture is larger than its tile: the share stays.
    return material.tile_m > 0 ? tile_m * material.tile_m / document.settings().layers[size_t(layer)].tile_m
                               : tile_m;
}

shared::PaintDecal paint_of(const Document& document, const LayerSet& layers, LayerTier tier,
                            const TerrainDecal& decal, glm::dvec3 origin_m) {
    shared::PaintDecal out{};
    const double tile_m = set_material(document, layers, tier, decal.material, out);
    const double s = std::sin(decal.heading_rad), c = std::cos(decal.heading_rad);
    set_box({{c, -s, 0}, {s, c, 0}, {0, 0, 1}}, {decal.half_m.x, decal.half_m.y, 1},
            {decal.x_m - origin_m.x, decal.y_m - origin_m.y, 0}, tile_m, out);
    out.ellipse = decal.outline == DecalOutline::ellipse;
    return out;
}

shared::PaintDecal paint_of(const Document& document, const LayerSet& layers, LayerTier tier,
                            const VolumeDecal& volume, glm::dvec3 origin_m) {
    shared::PaintDecal out{};
    const double tile_m = set_material(document, layers, tier, volume.material, out);
    set_box(axes_of(volume), volume.half_m, volume.center_m - origin_m, tile_m, out);
    out.ellipse = volume.outline == DecalOutline::ellipse;
    out.deep_edge = float(volume.deep_edge);
    return out;
}

shared::PaintDecal paint_of(const Document& document, const LayerSet& layers, LayerTier tier,
                            const SplineDecal& spline, const SplinePiece& piece, glm::dvec3 origin_m,
                            std::vector<shared::PaintSegment>& segments) {
    shared::PaintDecal out{};
    const double tile_m = set_material(document, layers, tier, spline.material, out);
    out.length_m = float(spline.path->length_m());
    out.fade_m = float(spline.fade_m);
    out.first_segment = uint32_t(segments.size());
    out.segment_count = uint32_t(piece.near.size());
    out.own_first =
        uint32_t(std::lower_bound(piece.near.begin(), piece.near.end(), piece.first) - piece.near.begin());
    out.own_count = piece.count;
    for (const uint32_t i : piece.near) {
        const SplineSegment& s = spline.path->segments()[i];
        segments.push_back({.from_m = glm::vec2(s.from_m - glm::dvec2(origin_m)),
                            .direction = glm::vec2(s.direction),
                            .length_m = float(s.length_m),
                            .half_from_m = float(s.half_from_m),
                            .half_to_m = float(s.half_to_m),
                            .start_m = float(s.start_m),
                            .phase = phase_of(s.start_m / tile_m)});
    }
    return out;
}

bool even_channels(const DecalMaterial& material) {
    const DecalChannels& c = material.channels;
    return c.gloss == c.normal && c.gloss == c.occlusion && c.gloss == c.metalness;
}

int ground_level(const Document& document, double texel_m) {
    const int coarsest = document.settings().refine + document.height_mip_count() - 1;
    const double finest_m = finest_height_spacing(document.settings());
    return std::clamp(int(std::ceil(std::log2(texel_m / finest_m) - 1e-9)), 0, coarsest);
}

double ground_reach_m(const Document& document, double texel_m) {
    // Slopes are differences of bilinear heights one sample to either side.
    return 2 * std::ldexp(finest_height_spacing(document.settings()), ground_level(document, texel_m));
}

void add_ground(const Document& document, glm::dvec2 square_corner, double texel_m, const TexelRect& texels,
                double center_z_m, shared::PaintInstance& instance, std::vector<float>& heights) {
    const int level = ground_level(document, texel_m);
    const double spacing_m = std::ldexp(finest_height_spacing(document.settings()), level);
    // Counted from the sample at or before the page's corner, whatever part of the page is drawn.
    const glm::dvec2 base = glm::floor(square_corner / spacing_m);
    instance.grid_spacing_m = float(spacing_m);
    instance.grid_scale = float(texel_m / spacing_m);
    instance.grid_origin = glm::vec2((square_corner - glm::dvec2(kPageBorder * texel_m)) / spacing_m - base);
    const auto sample = [&](int texel, float origin) {
        return int(std::floor(texel * double(instance.grid_scale) + double(origin)));
    };
    const glm::ivec2 first(sample(texels.x0, instance.grid_origin.x) - 2,
                           sample(texels.y0, instance.grid_origin.y) - 2);
    const glm::ivec2 last(sample(texels.x1, instance.grid_origin.x) + 3,
                          sample(texels.y1, instance.grid_origin.y) + 3);
    const glm::ivec2 size = last - first + 1;
    instance.grid_min = first;
    instance.grid_first = uint32_t(heights.size());
    instance.grid_width = uint32_t(size.x);
    std::vector<double> composed(size_t(size.x) * size_t(size.y));
    compose_heights(document, level, glm::ivec2(base) + first, size, composed.data());
    for (const double height_m : composed) heights.push_back(float(height_m - center_z_m));
}

}  // namespace loam
