#include "runtime/texture/decals.h"

#include <algorithm>
#include <cmath>

#include "runtime/document/document.h"

namespace loam {

namespace {

// Below half a texel a decal is gone, from one texel on it is whole: a function of the page's level alone, so
// neighbouring pages of a level agree.
float level_fade(double size_m, double texel_m) {
    return float(std::clamp(size_m / texel_m * 2.0 - 1.0, 0.0, 1.0));
}

struct ShapeToInstance {
    shared::DecalInstance& out;
    double texel_m;
    DecalKind kind = DecalKind::crater;
    double x_m = 0, y_m = 0;
    void operator()(const Crater& c) {
        kind = DecalKind::crater;
        x_m = c.x_m;
        y_m = c.y_m;
        out.shape = {float(c.radius_m), float(c.depth_m > 0 ? c.depth_m : c.radius_m * 0.4), 0, 0};
        out.seed = c.seed;
        out.fade = level_fade(c.radius_m * 2, texel_m);
    }
    void operator()(const Footprint& f) {
        kind = DecalKind::footprint;
        x_m = f.x_m;
        y_m = f.y_m;
        out.shape = {float(f.length_m), float(f.depth_m), float(std::sin(f.heading_rad)),
                     float(std::cos(f.heading_rad))};
        out.seed = f.seed;
        out.foot = uint32_t(f.foot);
        out.fade = level_fade(f.length_m * 0.6, texel_m);
    }
};

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
        shared::DecalInstance instance{};
        ShapeToInstance convert{instance, texel_m};
        std::visit(convert, op->shape);
        if (instance.fade <= 0) continue;
        const TexelRect quad = intersected(page_texels(layout, page, op->texture_bounds()), rect);
        if (quad.empty()) continue;
        const glm::ivec2 shift = scratch_min - glm::ivec2(rect.x0, rect.y0);
        instance.quad_min = glm::ivec2(quad.x0, quad.y0) + shift;
        instance.quad_size = {quad.width(), quad.height()};
        instance.page_shift = shift;
        instance.center_texel = {float((convert.x_m - square.min_x) / texel_m + kPageBorder),
                                 float((convert.y_m - square.min_y) / texel_m + kPageBorder)};
        instance.texel_m = float(texel_m);
        if (list.runs.empty() || list.runs.back().kind != convert.kind)
            list.runs.push_back({convert.kind, uint32_t(list.instances.size()), 0});
        list.instances.push_back(instance);
        ++list.runs.back().count;
    }
}

}  // namespace loam
