#include "runtime/scene/shadow_cascades.h"

#include <cmath>
#include <limits>

#include "shaders/geometry/geometry_io.h"

namespace loam {

namespace {

// Half sizes in metres. The finest gives 8 cm texels at 1024, enough for a footprint's rim; each next is four
// times wider.
constexpr std::array<double, kCascadeCount> kHalf_m = {40.0, 160.0, 640.0, 4096.0};
// The camera may wander this share of a cascade's half size before the cascade is drawn again.
constexpr double kWander = 0.3;
// While things move a cascade that shows another cut of the ground than the picture is kept this long: pages arrive in most
// frames then, and each would cost a cascade.
constexpr uint64_t kCutPatience_frames = 12;
// Light-space depth range. A float around 0.5 has steps of 2^-24, so 4 mm.
constexpr double kDepthRange_m = 65536.0;
// A tap reads at most 1.2 * |(0.4, 1)| + sqrt(2) texels beside its point (lighting.glsl), and a plane rises there by that
// times the tangent of its angle to the light. Moved along its normal by this times the sine it lies above its own texels.
constexpr float kNormalBias_texels = 2.75f;
// Changed ground less wide than this in a cascade waits for more, for rest, or for kCutPatience_frames: a
// footprint is shaded by its normals and its dent is less deep than the bias.
constexpr double kUrgent_texels = 8;
constexpr size_t kMostParts = 8;  // of a cascade, drawn one by one
constexpr uint64_t kNoCut = 0;    // no set of patches has it, or one in 2^64
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

Result<ShadowCascades> ShadowCascades::create(gpu::Device& device, uint32_t cascade_texels) {
    ShadowCascades shadows;
    shadows.texels_ = cascade_texels;
    auto atlas = gpu::Image::create(
        device, {.name = "shadow atlas",
                 .format = VK_FORMAT_D32_SFLOAT,
                 .width = cascade_texels * 2,
                 .height = cascade_texels * 2,
                 .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    if (!atlas) return atlas.error();
    shadows.atlas_ = std::move(*atlas);
    auto sampler = gpu::Sampler::create(device, {.compare_greater = true});
    if (!sampler) return sampler.error();
    shadows.sampler_ = std::move(*sampler);
    for (int i = 0; i < kCascadeCount; ++i) shadows.cascades_[size_t(i)].half_m = kHalf_m[size_t(i)];
    return shadows;
}

TexelRect ShadowCascades::covered(const Cascade& c, const HeightMap& heights, std::span<const MapPage> pages,
                                  const WorldRect& rect) const {
    const TexelRect whole{0, 0, int(texels_), int(texels_)};
    const VirtualMap& map = heights.map();
    // A changed vertex moves the triangles around it; along a stitched edge they are as long as the coarser
    // neighbour's.
    double quad_m = 0;
    for (const MapPage& page : pages) {
        const double own_m = map.page_size_m(page.level) / kPatchQuads;
        if (map.page_rect(page).grown(own_m).overlaps(rect)) quad_m = std::max(quad_m, own_m);
    }
    const WorldRect grown = rect.grown(2.0 * quad_m);
    double low_m = kInfinity, high_m = -kInfinity;
    for (const MapPage& page : pages) {
        const WorldRect square = map.page_rect(page);
        if (!square.overlaps(grown)) continue;
        const HeightPage* data = heights.resident_page(page);
        if (!data) return whole;
        const bool inside =
            grown.contains(square.min_x, square.min_y) && grown.contains(square.max_x, square.max_y);
        if (inside) {
            low_m = std::min(low_m, double(data->min_m));
            high_m = std::max(high_m, double(data->max_m));
            continue;
        }
        const TexelRect texels =
            intersected(map.texels_in(page, grown), TexelRect{0, 0, kPatchTexels, kPatchTexels});
        for (int y = texels.y0; y < texels.y1; ++y)
            for (int x = texels.x0; x < texels.x1; ++x) {
                const double z_m = double(data->heights_m[size_t(y) * kPatchTexels + size_t(x)]);
                low_m = std::min(low_m, z_m);
                high_m = std::max(high_m, z_m);
            }
    }
    if (!(low_m <= high_m)) return {};
    glm::dvec2 least(kInfinity), most(-kInfinity);
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(corner & 1 ? grown.max_x : grown.min_x, corner & 2 ? grown.max_y : grown.min_y,
                           corner & 4 ? high_m : low_m);
        const glm::dvec2 at =
            (glm::dvec2(glm::dot(axes_.x, p), glm::dot(axes_.y, p)) - c.center_m) / c.half_m * 0.5 + 0.5;
        least = glm::min(least, at);
        most = glm::max(most, at);
    }
    // A texel more on each side for the rounding of floats.
    const double side = texels_;
    least = glm::clamp(glm::floor(least * side) - 1.0, -1.0, side + 1.0);
    most = glm::clamp(glm::ceil(most * side) + 1.0, -1.0, side + 1.0);
    return intersected(TexelRect{int(least.x), int(least.y), int(most.x), int(most.y)}, whole);
}

void ShadowCascades::place_dirt(const HeightMap& heights, std::span<const MapPage> pages,
                                std::span<const WorldRect> rects) {
    for (Cascade& c : cascades_) {
        if (!c.valid) continue;
        for (const WorldRect& rect : rects) {
            TexelRect part = covered(c, heights, pages, rect);
            if (part.empty()) continue;
            if (c.dirty.empty()) c.dirty_since = update_;
            c.urgent |= std::max(rect.width(), rect.height()) >= kUrgent_texels * 2.0 * c.half_m / texels_;
            // Overlapping ones become one; so do all when there are many.
            for (size_t i = c.dirty.size(); i-- > 0;)
                if (c.dirty.size() >= kMostParts || !intersected(c.dirty[i], part).empty()) {
                    part = united(part, c.dirty[i]);
                    c.dirty.erase(c.dirty.begin() + std::ptrdiff_t(i));
                    i = c.dirty.size();
                }
            c.dirty.push_back(part);
        }
    }
}

void ShadowCascades::on_dirt(std::span<const WorldRect> rects, const HeightMap& heights) {
    place_dirt(heights, pages_, rects);  // where the old surface is
    changed_.insert(changed_.end(), rects.begin(), rects.end());
}

glm::dvec2 ShadowCascades::snapped(const Cascade& c, const glm::dvec2& eye_m) const {
    const double texel = 2.0 * c.half_m / texels_;
    return glm::floor(eye_m / texel) * texel;
}

bool ShadowCascades::is_stale(const Cascade& c, const glm::dvec2& eye_m, uint64_t cut_hash,
                              bool refine) const {
    if (!c.valid) return true;
    // A still picture must not depend on how the camera came to its place.
    if (refine) return c.cut_hash != cut_hash || c.center_m != snapped(c, eye_m);
    if (c.cut_hash != cut_hash && update_ - c.drawn_in >= kCutPatience_frames) return true;
    const glm::dvec2 moved = glm::abs(eye_m - c.center_m);
    return std::max(moved.x, moved.y) > c.half_m * kWander;
}

void ShadowCascades::draw(gpu::Commands& commands, TerrainPass& terrain, const PatchSet& patches,
                          const HeightMap& heights, const glm::dvec3& camera_m, const Part& which) {
    const int index = which.index;
    const TexelRect& part = which.texels;
    Cascade& c = cascades_[size_t(index)];
    const glm::dvec2 eye(glm::dot(axes_.x, camera_m), glm::dot(axes_.y, camera_m));
    const int side = int(texels_);
    if (part == TexelRect{0, 0, side, side}) {
        c.center_m = snapped(c, eye);
        c.z_m = glm::dot(axes_.z, camera_m);
        c.valid = true;
        c.dirty.clear();
        c.urgent = false;
        c.cut_hash = patches.cut_hash;
        c.drawn_in = update_;
    } else if (c.cut_hash != patches.cut_hash) {
        c.cut_hash = kNoCut;  // a part is of another cut than the rest
    }

    const glm::dvec2 center = c.center_m - eye;
    const double depth = 0.5 + (glm::dot(axes_.z, camera_m) - c.z_m) / kDepthRange_m;
    const glm::dmat4 clip_from_rel = glm::transpose(
        glm::dmat4(glm::dvec4(axes_.x, -center.x) / c.half_m, glm::dvec4(axes_.y, -center.y) / c.half_m,
                   glm::dvec4(axes_.z / kDepthRange_m, depth), glm::dvec4(0, 0, 0, 1)));
    // The part fills the clip space of what is looked for in it.
    const glm::dvec2 low(part.x0, part.y0), high(part.x1, part.y1);
    const glm::dvec2 grow = double(side) / (high - low);
    const glm::dvec2 shift = (double(side) - low - high) / (high - low);
    const glm::dmat4 part_from_clip(glm::dvec4(grow.x, 0, 0, 0), glm::dvec4(0, grow.y, 0, 0),
                                    glm::dvec4(0, 0, 1, 0), glm::dvec4(shift, 0, 1));

    const int x = (index & 1) * side, y = (index >> 1) * side;
    const VkClearAttachment clear{VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {0.0f, 0}}};
    const VkRect2D area{{x + part.x0, y + part.y0}, {uint32_t(part.width()), uint32_t(part.height())}};
    const VkClearRect cleared{area, 0, 1};
    vkCmdClearAttachments(commands.handle(), 1, &clear, 1, &cleared);
    commands.set_viewport(float(x), float(y), float(side), float(side));
    commands.set_scissor(area.offset.x, area.offset.y, area.extent.width, area.extent.height);
    terrain.cmd_draw_shadow(commands, patches, heights, clip_from_rel, part_from_clip * clip_from_rel,
                            camera_m);
}

// Cascades that are stale, within the budget, and of the others what has changed.
std::vector<ShadowCascades::Part> ShadowCascades::choose(const glm::dvec2& eye_m, uint64_t cut_hash,
                                                         int budget, bool refine) {
    std::vector<Part> parts;
    drawn_ = parts_drawn_ = 0;
    settled_ = true;
    const int side = int(texels_);
    for (int i = 0; i < kCascadeCount; ++i) {
        Cascade& c = cascades_[size_t(i)];
        int64_t dirty_texels = 0;
        for (const TexelRect& part : c.dirty) dirty_texels += part.area();
        const bool mostly_dirty = dirty_texels > int64_t(side) * side / 2;
        if (mostly_dirty || is_stale(c, eye_m, cut_hash, refine)) {
            if (int(drawn_) < budget) {
                parts.push_back({i, {0, 0, side, side}});
                ++drawn_;
                continue;
            }
            settled_ = false;
        }
        if (!c.valid || mostly_dirty) continue;
        // What has changed shows at once, in or out of turn.
        if (refine || c.urgent || update_ - c.dirty_since >= kCutPatience_frames) {
            for (const TexelRect& part : c.dirty) parts.push_back({i, part});
            parts_drawn_ += uint32_t(c.dirty.size());
            c.dirty.clear();
            c.urgent = false;
        }
        settled_ = settled_ && c.dirty.empty() && c.cut_hash == cut_hash;
    }
    return parts;
}

void ShadowCascades::update(gpu::Commands& commands, TerrainPass& terrain, const PatchSet& patches,
                            const HeightMap& heights, const glm::dvec3& camera_m, const glm::dvec3& to_sun,
                            int budget, bool refine, shared::FrameUniforms& uniforms) {
    if (glm::dot(to_sun, axes_.z) < 1.0 - 1e-12) {
        axes_.z = to_sun;
        // The light's x axis is level, so that height moves a point along y and z only.
        const glm::dvec2 level = glm::dvec2(-to_sun.y, to_sun.x);
        const double n = glm::length(level);
        axes_.x = n > 1e-9 ? glm::dvec3(level / n, 0) : glm::dvec3(1, 0, 0);
        axes_.y = glm::cross(axes_.z, axes_.x);
        for (auto& cascade : cascades_) cascade.valid = false;
    }

    const glm::dvec2 eye(glm::dot(axes_.x, camera_m), glm::dot(axes_.y, camera_m));
    ++update_;
    place_dirt(heights, patches.pages, changed_);  // where the new surface is
    changed_.clear();
    pages_ = patches.pages;
    if (const std::vector<Part> parts = choose(eye, patches.cut_hash, budget, refine); !parts.empty()) {
        const auto pass = commands.pass("shadow cascades", {{atlas_, gpu::Access::depth_target}});
        commands.begin_rendering({atlas_.width(), atlas_.height()}, {},
                                 {.view = atlas_.view(), .load = VK_ATTACHMENT_LOAD_OP_LOAD});
        for (const Part& part : parts) draw(commands, terrain, patches, heights, camera_m, part);
        commands.end_rendering();
    }

    uniforms.light_x = glm::vec4(axes_.x, 0);
    uniforms.light_y = glm::vec4(axes_.y, 0);
    uniforms.light_z = glm::vec4(axes_.z, 0);
    const double eye_z = glm::dot(axes_.z, camera_m);
    for (int i = 0; i < kCascadeCount; ++i) {
        const Cascade& c = cascades_[size_t(i)];
        const float texel = float(2.0 * c.half_m / texels_);
        uniforms.cascade[i] = glm::vec4(glm::vec2(c.center_m - eye), float(1.0 / c.half_m),
                                        float(0.5 + (eye_z - c.z_m) / kDepthRange_m));
        uniforms.cascade_depth[i] =
            glm::vec4(float(1.0 / kDepthRange_m), texel, texel * kNormalBias_texels, c.valid ? 1.0f : 0.0f);
    }
}

}  // namespace loam
