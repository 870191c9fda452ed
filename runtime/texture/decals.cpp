#include "runtime/texture/decals.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "runtime/document/document.h"
#include "runtime/texture/layer_set.h"
#include "shaders/document/crater_math.h"
#include "shaders/document/footprint_math.h"

namespace loam {

namespace {

int clamped_int(double v) {
    return int(std::clamp(v, -1.0e8, 1.0e8));
}

WorldRect square_around(double x_m, double y_m, double half_m) {
    return {x_m - half_m, y_m - half_m, x_m + half_m, y_m + half_m};
}

// The bounds of a convex outline between two latitudes; empty where it has nothing there.
WorldRect slice_of(const std::array<glm::dvec2, 4>& outline, double min_y_m, double max_y_m) {
    WorldRect slice;
    for (size_t i = 0; i < outline.size(); ++i) {
        glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
        if (a.y > b.y) std::swap(a, b);
        if (b.y < min_y_m || a.y > max_y_m) continue;
        const auto at = [&](double y) { return b.y > a.y ? a + (b - a) * ((y - a.y) / (b.y - a.y)) : a; };
        for (const glm::dvec2& p : {a.y < min_y_m ? at(min_y_m) : a, b.y > max_y_m ? at(max_y_m) : b})
            slice = united(slice, {p.x, p.y, p.x, p.y});
    }
    return slice;
}

// What both paths take from a crater or a footprint; the place stays in doubles.
struct MarkSource {
    DecalKind kind = DecalKind::crater;
    double x_m = 0, y_m = 0;
    double size_m = 0;   // see decal_fade
    double reach_m = 0;  // from the centre
    float strength = 1;
    glm::vec4 shape{0};
    uint32_t seed = 0, foot = 0;
};

MarkSource source_of(const Crater& c) {
    return {.kind = DecalKind::crater,
            .x_m = c.x_m,
            .y_m = c.y_m,
            .size_m = size_m(c),
            .reach_m = c.radius_m * double(kCraterMarkReach),
            .strength = float(c.strength),
            .shape = {float(c.radius_m), float(c.depth_m > 0 ? c.depth_m : c.radius_m * 0.4), float(c.heat),
                      float(c.age)},
            .seed = c.seed};
}

MarkSource source_of(const Footprint& f) {
    return {.kind = DecalKind::footprint,
            .x_m = f.x_m,
            .y_m = f.y_m,
            .size_m = size_m(f),
            .reach_m = f.length_m * double(kFootprintReach),
            .strength = float(f.strength),
            .shape = {float(f.length_m), float(f.depth_m), float(std::sin(f.heading_rad)),
                      float(std::cos(f.heading_rad))},
            .seed = f.seed,
            .foot = uint32_t(f.foot)};
}

DecalPass pass_of(const Operator& op) {
    return std::holds_alternative<SplineDecal>(op.shape) ? DecalPass::splines
           : std::holds_alternative<VolumeDecal>(op.shape) || std::holds_alternative<Flood>(op.shape)
               ? DecalPass::volumes
               : DecalPass::terrain;
}

// One rectangle of a page; a call a kind of operator.
struct PageDecals {
    const Document& document;
    const LayerSet& layers;
    LayerTier tier;
    const TextureLayout& layout;
    const PageId& page;
    const TexelRect& rect;
    glm::ivec2 shift;  // page texel to scratch
    DecalList& list;
    WorldRect square = layout.square(page);
    double texel_m = layout.texel_m(page);

    [[nodiscard]] glm::dvec3 origin(double z_m) const { return {square.min_x, square.min_y, z_m}; }
    [[nodiscard]] bool shown(double size_m) const {
        return shared::decal_fade(float(size_m), float(texel_m)) > 0;
    }
    [[nodiscard]] TexelRect covered(const WorldRect& bounds) const {
        return intersected(page_texels(layout, page, bounds), rect);
    }

    // The texels whose centres lie in a rectangle, or so near it that the shader's floats may see them there.
    static constexpr double kCentreMargin = 1.0 / 64;  // texels
    [[nodiscard]] TexelRect centred_in(const WorldRect& world) const {
        const auto at = [&](double m, double origin_m) {
            return (m - origin_m) / texel_m + kPageBorder - 0.5;
        };
        const auto first = [](double u) { return clamped_int(std::ceil(u - kCentreMargin)); };
        const auto end = [](double u) { return clamped_int(std::floor(u + kCentreMargin)) + 1; };
        return {first(at(world.min_x, square.min_x)), first(at(world.min_y, square.min_y)),
                end(at(world.max_x, square.min_x)), end(at(world.max_y, square.min_y))};
    }

    void add_to_run(DecalPass pass, DecalRun run, size_t index) const {
        auto& runs = list.runs[size_t(pass)];
        run.tier = tier;
        run.first = uint32_t(index);
        if (runs.empty() || runs.back().kind != run.kind || runs.back().even != run.even ||
            runs.back().function != run.function || runs.back().tier != tier ||
            runs.back().first + runs.back().count != index)
            runs.push_back(run);
        ++runs.back().count;
    }

    // The caller adds quads.
    [[nodiscard]] shared::DecalInstance mark(const MarkSource& source) const {
        shared::DecalInstance instance{};
        instance.fade = shared::decal_fade(float(source.size_m), float(texel_m)) * source.strength;
        instance.page_shift = shift;
        instance.center_texel = {float((source.x_m - square.min_x) / texel_m + kPageBorder),
                                 float((source.y_m - square.min_y) / texel_m + kPageBorder)};
        instance.texel_m = float(texel_m);
        instance.shape = source.shape;
        instance.seed = source.seed;
        instance.foot = source.foot;
        return instance;
    }

    void add_quad(shared::DecalInstance instance, DecalKind kind, const TexelRect& quad) const {
        if (quad.empty()) return;
        instance.quad_min = glm::ivec2(quad.x0, quad.y0) + shift;
        instance.quad_size = {quad.width(), quad.height()};
        add_to_run(DecalPass::terrain, {.kind = kind}, list.marks.size());
        list.marks.push_back(instance);
    }

    // Null: its function cannot be shown.
    shared::PaintInstance* paint(DecalPass pass, DecalKind kind, const DecalMaterial& material,
                                 const TexelRect& quad, const shared::PaintDecal& decal) const {
        const auto function = place_of_function(document, material, list.functions);
        if (!function) return nullptr;
        add_to_run(pass, {.kind = kind, .even = even_channels(material), .function = *function},
                   list.paints.size());
        shared::PaintInstance& instance = list.paints.emplace_back();
        instance.decal = decal;
        instance.decal.function = *function > 0 ? 1 : 0;  // the shader has one
        instance.quad_min = glm::ivec2(quad.x0, quad.y0) + shift;
        instance.quad_size = {quad.width(), quad.height()};
        instance.page_shift = shift;
        instance.texel_m = float(texel_m);
        return &instance;
    }

    void operator()(const Crater& c) const {
        const MarkSource source = source_of(c);
        if (shown(source.size_m))
            add_quad(mark(source), source.kind, covered(square_around(c.x_m, c.y_m, source.reach_m)));
    }
    // In bands of rows, each as wide as the print's turned box is there, and no texel whose centre is not in
    // it: the shader's print is 0 outside, and of a slanting or a small print most of the bounds is.
    void operator()(const Footprint& f) const {
        constexpr int kBand = 8;  // texels
        const MarkSource source = source_of(f);
        const TexelRect all = intersected(centred_in(bounds_of(f)), rect);
        if (all.empty() || !shown(source.size_m)) return;
        const shared::DecalInstance instance = mark(source);
        const std::array<glm::dvec2, 4> box = box_of(f);
        const auto center_y_m = [&](int row) { return square.min_y + (row + 0.5 - kPageBorder) * texel_m; };
        for (int y0 = all.y0, y1 = 0; y0 < all.y1; y0 = y1) {
            y1 = std::min(all.y1, (y0 / kBand + 1) * kBand);
            const double margin_m = kCentreMargin * texel_m;
            const WorldRect slice = slice_of(box, center_y_m(y0) - margin_m, center_y_m(y1 - 1) + margin_m);
            if (slice.empty()) continue;
            const TexelRect across = centred_in(slice);
            add_quad(instance, source.kind, intersected(all, TexelRect{across.x0, y0, across.x1, y1}));
        }
    }
    void operator()(const TerrainDecal& decal, const WorldRect& bounds) const {
        const TexelRect quad = covered(bounds);
        if (quad.empty() || !shown(size_m(decal))) return;
        paint(DecalPass::terrain, DecalKind::terrain, decal.material, quad,
              paint_of(document, layers, tier, decal, origin(0)));
    }
    void operator()(const Stamp&) const {}
    void operator()(const Cutout&) const {}
    void operator()(const Slide&) const {}
    void operator()(const Flood& flood, const WorldRect& bounds) const { (*this)(surface_of(flood), bounds); }
    void operator()(const Event&) const {}
    void operator()(const SplineDecal& spline) const {
        if (!shown(size_m(spline))) return;
        for (const SplinePiece& piece : spline.path->pieces()) {
            const TexelRect quad = covered(piece.line.grown(spline.path->half_width_m()));
            if (quad.empty()) continue;
            paint(DecalPass::splines, DecalKind::spline, spline.material, quad,
                  paint_of(document, layers, tier, spline, piece, origin(0), list.segments));
        }
    }
    void operator()(const VolumeDecal& volume, const WorldRect& bounds) const {
        const TexelRect quad = covered(bounds);
        if (quad.empty() || !shown(size_m(volume))) return;
        shared::PaintInstance* instance =
            paint(DecalPass::volumes, DecalKind::volume, volume.material, quad,
                  paint_of(document, layers, tier, volume, origin(volume.center_m.z)));
        if (instance)
            add_ground(document, {square.min_x, square.min_y}, texel_m, quad, volume.center_m.z, *instance,
                       list.heights_m);
    }
};

// The decals of a picture; a call a kind of operator.
struct PictureDecals {
    const Document& document;
    const LayerSet& layers;
    const DirectDecalView& view;
    DirectDecals& out;
    FunctionList& functions;
    double texel_a_metre = 0;  // the finest footprint at a metre's distance

    [[nodiscard]] bool shown(double size_m, const WorldRect& bounds) const {
        return size_m * 2 > bounds.distance(view.camera_m.x, view.camera_m.y) * texel_a_metre;
    }
    [[nodiscard]] glm::vec2 relative(glm::dvec2 at_m) const {
        return glm::vec2(at_m - glm::dvec2(view.camera_m));
    }

    void mark(const MarkSource& source, uint32_t kind) const {
        if (!shown(source.size_m, square_around(source.x_m, source.y_m, source.reach_m))) return;
        out.decals.push_back({.center_rel_m = relative({source.x_m, source.y_m}),
                              .reach_m = float(source.reach_m),
                              .size_m = float(source.size_m),
                              .strength = source.strength,
                              .shape = source.shape,
                              .seed = source.seed,
                              .foot = source.foot,
                              .kind = kind,
                              .paint = 0});
    }
    void paint(uint32_t kind, const DecalMaterial& material, shared::PaintDecal decal,
               const WorldRect& bounds) const {
        const auto function = place_of_function(document, material, functions);
        if (!function) return;
        decal.function = *function;
        out.decals.push_back({.center_rel_m = relative(bounds.center()),
                              .reach_m = float(std::hypot(bounds.width(), bounds.height()) * 0.5),
                              .size_m = 0,
                              .strength = 1,
                              .shape = {},
                              .seed = 0,
                              .foot = 0,
                              .kind = kDecalPaint + kind,
                              .paint = uint32_t(out.paints.size())});
        out.paints.push_back(decal);
    }

    void operator()(const Crater& c) const { mark(source_of(c), kDecalCrater); }
    void operator()(const Footprint& f) const { mark(source_of(f), kDecalFootprint); }
    void operator()(const TerrainDecal& decal, const WorldRect& bounds) const {
        if (shown(size_m(decal), bounds))
            paint(kPaintTerrain, decal.material,
                  paint_of(document, layers, layers.direct_tier(), decal, view.camera_m), bounds);
    }
    void operator()(const VolumeDecal& volume, const WorldRect& bounds) const {
        if (shown(size_m(volume), bounds))
            paint(kPaintVolume, volume.material,
                  paint_of(document, layers, layers.direct_tier(), volume, view.camera_m), bounds);
    }
    void operator()(const Stamp&) const {}
    void operator()(const Cutout&) const {}
    void operator()(const Slide&) const {}
    void operator()(const Flood& flood, const WorldRect& bounds) const { (*this)(surface_of(flood), bounds); }
    void operator()(const Event&) const {}
    void operator()(const SplineDecal& spline) const {
        for (const SplinePiece& piece : spline.path->pieces()) {
            const WorldRect bounds = piece.line.grown(spline.path->half_width_m());
            const bool in_view = std::any_of(view.ground.begin(), view.ground.end(),
                                             [&](const WorldRect& rect) { return rect.overlaps(bounds); });
            if (in_view && shown(size_m(spline), bounds))
                paint(kPaintSpline, spline.material,
                      paint_of(document, layers, layers.direct_tier(), spline, piece, view.camera_m,
                               out.segments),
                      bounds);
        }
    }
};

// Visits with the operator's bounds where the kind asks for them.
template <typename Kinds>
void visit_decal(const Kinds& kinds, const Operator& op) {
    std::visit(
        [&](const auto& shape) {
            if constexpr (std::is_invocable_v<const Kinds&, decltype(shape), const WorldRect&>)
                kinds(shape, op.texture_bounds());
            else
                kinds(shape);
        },
        op.shape);
}

WorldRect world_of(const TextureLayout& layout, const PageId& page, const TexelRect& rect) {
    const WorldRect square = layout.square(page);
    const double texel_m = layout.texel_m(page);
    return {
        square.min_x + (rect.x0 - kPageBorder) * texel_m, square.min_y + (rect.y0 - kPageBorder) * texel_m,
        square.min_x + (rect.x1 - kPageBorder) * texel_m, square.min_y + (rect.y1 - kPageBorder) * texel_m};
}

// A pixel's smallest footprint is that of level ground seen from straight above; slopes and the picture's
// corners make it smaller still, for which this share is left.
constexpr double kFootprintMargin = 0.125;

}  // namespace

TexelRect page_texels(const TextureLayout& layout, const PageId& page, const WorldRect& world) {
    if (world.empty()) return {};
    const WorldRect square = layout.square(page);
    const double per_m = 1.0 / layout.texel_m(page);
    const auto texel = [&](double at, double origin) { return (at - origin) * per_m + kPageBorder; };
    return {clamped_int(std::floor(texel(world.min_x, square.min_x)) - 1),
            clamped_int(std::floor(texel(world.min_y, square.min_y)) - 1),
            clamped_int(std::ceil(texel(world.max_x, square.min_x)) + 1),
            clamped_int(std::ceil(texel(world.max_y, square.min_y)) + 1)};
}

void add_decals(const Document& document, const LayerSet& layers, LayerTier tier, const TextureLayout& layout,
                const PageId& page, const TexelRect& rect, glm::ivec2 scratch_min, DecalList& list) {
    std::vector<const Operator*> operators;
    document.operators_over_texture(world_of(layout, page, rect), layout.texel_m(page), operators);
    const PageDecals decals{
        document, layers, tier, layout, page, rect, scratch_min - glm::ivec2(rect.x0, rect.y0), list};
    for (const Operator* op : operators) visit_decal(decals, *op);
}

std::vector<DecalTexture> decal_textures(const Document& document, const LayerSet& layers,
                                         const TextureLayout& layout, const PageId& page,
                                         const TexelRect& rect) {
    const auto lock = document.read_lock();
    std::vector<const Operator*> operators;
    document.operators_over_texture(world_of(layout, page, rect), layout.texel_m(page), operators);
    std::vector<DecalTexture> textures;
    for (const Operator* op : operators)
        std::visit(
            [&](const auto& shape) {
                if constexpr (requires { shape.material.channels; })
                    if (const int layer = layer_of(document, layers, shape.material); layer >= 0)
                        textures.push_back(
                            {uint32_t(layer), tile_of(document, layers, shape.material, layer)});
            },
            op->shape);
    return textures;
}

DirectDecals direct_decals(const Document& document, const LayerSet& layers, const DirectDecalView& view,
                           FunctionList& functions) {
    const auto lock = document.read_lock();
    std::vector<const Operator*> found, here;
    for (const WorldRect& rect : view.ground) {
        document.operators_over_texture(rect, 0, here);
        found.insert(found.end(), here.begin(), here.end());
    }
    std::sort(found.begin(), found.end(), [](const Operator* a, const Operator* b) {
        const DecalPass pass_a = pass_of(*a), pass_b = pass_of(*b);
        return pass_a != pass_b ? pass_a < pass_b : evaluated_before(*a, *b);
    });
    found.erase(std::unique(found.begin(), found.end()), found.end());
    DirectDecals out;
    const PictureDecals decals{
        document, layers,    view,
        out,      functions, kFootprintMargin / view.pixels_per_radian * std::exp2(view.footprint_bias)};
    for (const Operator* op : found) visit_decal(decals, *op);
    return out;
}

}  // namespace loam
