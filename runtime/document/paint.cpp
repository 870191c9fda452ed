// A texel takes the layer when a number hashed from its coordinates and the seed is below strength * falloff:
// strokes of one seed agree on which texels those are, so that more dabs fill a disc no further than its
// weight says. Tint is blended by strength * falloff a dab.
#include "runtime/document/paint.h"

#include <cmath>

#include "runtime/document/brush_step.h"
#include "shaders/document/noise_math.h"

namespace loam {

namespace {

// The share of paint that sticks to a place of the base map.
class MaskReader {
  public:
    MaskReader(const GroundMask& mask, uint32_t seed, SlopeReader& ground)
        : mask_(mask), seed_(shared::noise_hash(seed + 0x9u)), ground_(ground) {
        constexpr double kUpright_rad =
            1.5707;  // a little below a right angle: vertical ground counts as that
        const double low = std::tan(std::min(mask.min_slope_rad, kUpright_rad));
        const double high = std::tan(std::min(mask.max_slope_rad, kUpright_rad));
        min_tangent2_ = low * low;
        if (mask.max_slope_rad < kUpright_rad) max_tangent2_ = high * high;
        any_slope_ = mask.min_slope_rad <= 0 && mask.max_slope_rad >= kUpright_rad;
        any_height_ =
            mask.min_height_m <= -GroundMask::kHighest_m && mask.max_height_m >= GroundMask::kHighest_m;
    }

    Result<double> share(double x_m, double y_m) {
        if (!any_height_) {
            const auto height_m = ground_.height_m(x_m, y_m);
            if (!height_m.ok()) return height_m.error();
            if (*height_m < mask_.min_height_m || *height_m > mask_.max_height_m) return 0.0;
        }
        if (!any_slope_) {
            const auto tangent2 = ground_.tangent_squared(x_m, y_m);
            if (!tangent2.ok()) return tangent2.error();
            if (*tangent2 < min_tangent2_ || *tangent2 > max_tangent2_) return 0.0;
        }
        if (mask_.noise <= 0) return 1.0;
        const glm::vec2 at(float(x_m / mask_.noise_size_m), float(y_m / mask_.noise_size_m));
        // Two octaves: patches with ragged rims.
        const float n = 0.7f * shared::noise_value(at, seed_) +
                        0.3f * shared::noise_value(at * 3.7f, shared::noise_hash(seed_));
        return 1.0 - mask_.noise * double(1.0f - shared::noise_ramp(-0.2f, 0.2f, n));
    }

  private:
    const GroundMask& mask_;
    uint32_t seed_;
    SlopeReader& ground_;
    double min_tangent2_ = 0, max_tangent2_ = INFINITY;
    bool any_slope_ = true, any_height_ = true;  // no limit: heights need not be read
};

void blend_tint(IndexTexel& texel, const glm::dvec3& tint, double weight) {
    for (int channel = 0; channel < 3; ++channel) {
        const double old = texel.tint[channel];
        texel.tint[channel] = uint8_t(old + (tint[channel] * 255 - old) * weight + 0.5);
    }
}

// A brush finer than the map paints the one texel nearest to it wholly; at full hardness a disc has no soft
// rim.
double paint_falloff(const PaintCommand& command, const DabFootprint& dab, bool finer_than_map, int x,
                     int y) {
    if (finer_than_map) return x == dab.nearest_x && y == dab.nearest_y ? 1 : 0;
    const double dx = x - dab.x, dy = y - dab.y;
    const double t = std::sqrt(dx * dx + dy * dy) / dab.radius;
    if (command.hardness >= 1) return t <= 1 ? 1 : 0;
    return brush_falloff(t, command.hardness);
}

// What both commands do to a texel at a weight of 0 … 1 before the mask.
class TexelPainter {
  public:
    TexelPainter(const GroundMask& mask, uint32_t seed, const std::optional<glm::dvec3>& tint,
                 std::optional<uint16_t> layer, double spacing_m, SlopeReader& ground)
        : mask_(mask, seed, ground), seed_(seed), tint_(tint), layer_(layer), spacing_m_(spacing_m) {}

    Status paint(IndexTexel& texel, double weight, int x, int y) {
        if (weight <= 0) return {};
        const auto share = mask_.share(x * spacing_m_, y * spacing_m_);
        if (!share.ok()) return share.error();
        weight *= *share;
        if (weight <= 0) return {};
        if (tint_) blend_tint(texel, *tint_, weight);
        if (layer_ && double(shared::noise_share(shared::noise_cell(x, y, seed_))) < weight)
            texel.layer = *layer_;
        return {};
    }

  private:
    MaskReader mask_;
    uint32_t seed_;
    const std::optional<glm::dvec3>& tint_;
    std::optional<uint16_t> layer_;
    double spacing_m_;
};

// Calls texel(IndexTexel&, x, y) for a rectangle of the map.
template <typename Texel>
Status for_each_texel(const TexelRect& rect, PageEdits<IndexTexel>& edits, Texel&& texel) {
    return for_each_page_under(rect, [&](int page_x, int page_y, const TexelRect& part) -> Status {
        const auto page = edits.page(page_x, page_y);
        if (!page.ok()) return page.error();
        for (int y = part.y0; y < part.y1; ++y)
            for (int x = part.x0; x < part.x1; ++x)
                LOAM_TRY(
                    texel((*page)[(y - page_y * kBasePageSide) * kBasePageSide + x - page_x * kBasePageSide],
                          x, y));
        return {};
    });
}

}  // namespace

Status paint(const PaintCommand& command, const PaintLayers& layers, SlopeReader& ground,
             PageEdits<IndexTexel>& edits) {
    const MapShape& shape = edits.shape();
    const bool finer_than_map = command.radius_m < 0.75 * shape.spacing_m;
    TexelPainter painter(command.mask, command.seed, command.tint, layers.layer, shape.spacing_m, ground);
    for (const glm::dvec2& center : command.dabs) {
        const DabFootprint dab = dab_footprint(shape, center, command.radius_m);
        LOAM_TRY(for_each_texel(dab.rect, edits, [&](IndexTexel& texel, int x, int y) {
            return painter.paint(texel, command.strength * paint_falloff(command, dab, finer_than_map, x, y),
                                 x, y);
        }));
    }
    for (const glm::dvec2& center : command.dabs)
        LOAM_TRY(place_transitions(layers.transitions, dab_footprint(shape, center, command.radius_m).rect,
                                   edits));
    return {};
}

TexelRect fill_texels(const FillCommand& command, const MapShape& shape) {
    if (!command.rect) return {0, 0, shape.samples_x, shape.samples_y};
    const auto first = [&](double at_m, int samples) {
        return int(std::clamp(std::ceil(at_m / shape.spacing_m), 0.0, double(samples)));
    };
    const WorldRect& r = *command.rect;
    return {first(r.min_x, shape.samples_x), first(r.min_y, shape.samples_y), first(r.max_x, shape.samples_x),
            first(r.max_y, shape.samples_y)};
}

Status fill(const FillCommand& command, const PaintLayers& layers, SlopeReader& ground,
            PageEdits<IndexTexel>& edits) {
    const TexelRect rect = fill_texels(command, edits.shape());
    if (rect.empty()) return {};
    TexelPainter painter(command.mask, command.seed, command.tint, layers.layer, edits.shape().spacing_m,
                         ground);
    LOAM_TRY(for_each_texel(rect, edits, [&](IndexTexel& texel, int x, int y) -> Status {
        if (layers.replace && texel.layer != *layers.replace) return {};
        return painter.paint(texel, command.strength, x, y);
    }));
    return place_transitions(layers.transitions, rect, edits);
}

}  // namespace loam
