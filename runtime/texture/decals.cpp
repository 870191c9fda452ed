#include "runtime/texture/decals.h"

#include <algorithm>
#include <cmath>

#include "runtime/document/document.h"
#include "shaders/document/crater_math.h"
#include "shaders/document/footprint_math.h"

namespace loam {

namespace {

// What both paths take from an operator; the place stays in doubles.
struct DecalSource {
    DecalKind kind = DecalKind::crater;
    double x_m = 0, y_m = 0;
    double size_m = 0;   // see decal_fade
    double reach_m = 0;  // from the centre
    glm::vec4 shape{0};
    uint32_t seed = 0, foot = 0;
};

DecalSource source_of(const Crater& c) {
    return {
        .kind = DecalKind::crater,
        .x_m = c.x_m,
        .y_m = c.y_m,
        .size_m = c.radius_m * 2,
        .reach_m = c.radius_m * double(kCraterMarkReach),
        .shape = {float(c.radius_m), float(c.depth_m > 0 ? c.depth_m : c.radius_m * 0.4), float(c.heat), 0},
        .seed = c.seed};
}

DecalSource source_of(const Footprint& f) {
    return {.kind = DecalKind::footprint,
            .x_m = f.x_m,
            .y_m = f.y_m,
            .size_m = f.length_m * 0.6,
            .reach_m = f.length_m * double(kFootprintReach),
            .shape = {float(f.length_m), float(f.depth_m), float(std::sin(f.heading_rad)),
                      float(std::cos(f.heading_rad))},
            .seed = f.seed,
            .foot = uint32_t(f.foot)};
}

DecalSource source_of(const Operator& op) {
    return std::visit([](const auto& shape) { return source_of(shape); }, op.shape);
}

// A pixel's smallest footprint is that of level ground seen from straight above; slopes and the picture's
// corners make it smaller still, for which this share is left.
constexpr double kFootprintMargin = 0.125;

int clamped_int(double v) {
    return int(std::clamp(v, -1.0e8, 1.0e8));
}

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

void add_decals(const Document& document, const TextureLayout& layout, const PageId& page,
                const TexelRect& rect, glm::ivec2 scratch_min, DecalList& list) {
    const WorldRect square = layout.square(page);
    const double texel_m = layout.texel_m(page);
    const WorldRect covered{
        square.min_x + (rect.x0 - kPageBorder) * texel_m, square.min_y + (rect.y0 - kPageBorder) * texel_m,
        square.min_x + (rect.x1 - kPageBorder) * texel_m, square.min_y + (rect.y1 - kPageBorder) * texel_m};
    std::vector<const Operator*> operators;
    document.operators_over_texture(covered, operators);
    for (const Operator* op : operators) {
        const DecalSource source = source_of(*op);
        shared::DecalInstance instance{};
        instance.fade = shared::decal_fade(float(source.size_m), float(texel_m));
        if (instance.fade <= 0) continue;
        const TexelRect quad = intersected(page_texels(layout, page, op->texture_bounds()), rect);
        if (quad.empty()) continue;
        const glm::ivec2 shift = scratch_min - glm::ivec2(rect.x0, rect.y0);
        instance.quad_min = glm::ivec2(quad.x0, quad.y0) + shift;
        instance.quad_size = {quad.width(), quad.height()};
        instance.page_shift = shift;
        instance.center_texel = {float((source.x_m - square.min_x) / texel_m + kPageBorder),
                                 float((source.y_m - square.min_y) / texel_m + kPageBorder)};
        instance.texel_m = float(texel_m);
        instance.shape = source.shape;
        instance.seed = source.seed;
        instance.foot = source.foot;
        if (list.runs.empty() || list.runs.back().kind != source.kind)
            list.runs.push_back({source.kind, uint32_t(list.instances.size()), 0});
        list.instances.push_back(instance);
        ++list.runs.back().count;
    }
}

std::vector<shared::DirectDecal> direct_decals(const Document& document, const DirectDecalView& view) {
    const auto lock = document.read_lock();
    std::vector<const Operator*> found, here;
    for (const WorldRect& rect : view.ground) {
        document.operators_over_texture(rect, here);
        found.insert(found.end(), here.begin(), here.end());
    }
    std::sort(found.begin(), found.end(), [](const Operator* a, const Operator* b) {
        return a->order != b->order ? a->order < b->order : a->id < b->id;
    });
    found.erase(std::unique(found.begin(), found.end()), found.end());
    const double texel_a_metre = kFootprintMargin / view.pixels_per_radian * std::exp2(view.footprint_bias);
    std::vector<shared::DirectDecal> decals;
    for (const Operator* op : found) {
        const DecalSource source = source_of(*op);
        const double near_m = op->texture_bounds().distance(view.camera_m.x, view.camera_m.y);
        if (source.size_m * 2 <= near_m * texel_a_metre) continue;  // decal_fade is 0
        decals.push_back(
            {.center_rel_m = {float(source.x_m - view.camera_m.x), float(source.y_m - view.camera_m.y)},
             .reach_m = float(source.reach_m),
             .size_m = float(source.size_m),
             .shape = source.shape,
             .seed = source.seed,
             .foot = source.foot,
             .kind = source.kind == DecalKind::crater ? kDecalCrater : kDecalFootprint,
             .unused = 0});
    }
    return decals;
}

}  // namespace loam
