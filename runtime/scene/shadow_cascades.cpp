#include "runtime/scene/shadow_cascades.h"

#include <cmath>

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

void ShadowCascades::on_dirt(std::span<const WorldRect> rects) {
    for (auto& cascade : cascades_) {
        for (const WorldRect& rect : rects) {
            // The rectangle's disc in light space, for any height: compare across the light's x axis only,
            // which is level.
            const glm::dvec2 c = rect.center();
            const double radius = std::hypot(rect.width(), rect.height()) * 0.5;
            const double across = axes_.x.x * c.x + axes_.x.y * c.y;
            cascade.dirty |= std::abs(across - cascade.center_m.x) < cascade.half_m + radius;
        }
    }
}

glm::dvec2 ShadowCascades::snapped(const Cascade& c, const glm::dvec2& eye_m) const {
    const double texel = 2.0 * c.half_m / texels_;
    return glm::floor(eye_m / texel) * texel;
}

bool ShadowCascades::is_stale(const Cascade& c, const glm::dvec2& eye_m, uint64_t cut_hash,
                              bool refine) const {
    if (!c.valid || c.dirty) return true;
    // A still picture must not depend on how the camera came to its place.
    if (refine) return c.cut_hash != cut_hash || c.center_m != snapped(c, eye_m);
    if (c.cut_hash != cut_hash && update_ - c.drawn_in >= kCutPatience_frames) return true;
    const glm::dvec2 moved = glm::abs(eye_m - c.center_m);
    return std::max(moved.x, moved.y) > c.half_m * kWander;
}

Status ShadowCascades::draw(gpu::Commands& commands, TerrainPass& terrain, const PatchSet& patches,
                            const HeightMap& heights, const glm::dvec3& camera_m, int index) {
    Cascade& c = cascades_[size_t(index)];
    const glm::dvec2 eye(glm::dot(axes_.x, camera_m), glm::dot(axes_.y, camera_m));
    c.center_m = snapped(c, eye);
    c.z_m = glm::dot(axes_.z, camera_m);
    c.valid = true;
    c.dirty = false;
    c.cut_hash = patches.cut_hash;
    c.drawn_in = update_;

    const glm::dvec2 center = c.center_m - eye;
    const glm::dmat4 clip_from_rel = glm::transpose(
        glm::dmat4(glm::dvec4(axes_.x, -center.x) / c.half_m, glm::dvec4(axes_.y, -center.y) / c.half_m,
                   glm::dvec4(axes_.z / kDepthRange_m, 0.5), glm::dvec4(0, 0, 0, 1)));

    const int side = int(texels_), x = (index & 1) * side, y = (index >> 1) * side;
    commands.begin_rendering({atlas_.width(), atlas_.height()}, {},
                             {.view = atlas_.view(), .load = VK_ATTACHMENT_LOAD_OP_LOAD});
    const VkClearAttachment clear{VK_IMAGE_ASPECT_DEPTH_BIT, 0, {.depthStencil = {0.0f, 0}}};
    const VkClearRect area{{{x, y}, {texels_, texels_}}, 0, 1};
    vkCmdClearAttachments(commands.handle(), 1, &clear, 1, &area);
    commands.set_viewport(float(x), float(y), float(side), float(side));
    terrain.cmd_draw_shadow(commands, patches, heights, clip_from_rel, camera_m);
    commands.end_rendering();
    return {};
}

Status ShadowCascades::update(gpu::Commands& commands, TerrainPass& terrain, const PatchSet& patches,
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
    drawn_ = 0;
    settled_ = true;
    bool opened = false;
    for (int i = 0; i < kCascadeCount; ++i) {
        if (!is_stale(cascades_[size_t(i)], eye, patches.cut_hash, refine)) {
            settled_ = settled_ && cascades_[size_t(i)].cut_hash == patches.cut_hash;
            continue;
        }
        if (int(drawn_) >= budget) {
            settled_ = false;
            continue;
        }
        if (!opened) commands.use({{atlas_, gpu::Access::depth_target}});
        opened = true;
        const auto pass = commands.pass("shadow cascade", {{atlas_, gpu::Access::depth_target}});
        LOAM_TRY(draw(commands, terrain, patches, heights, camera_m, i));
        ++drawn_;
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
    return {};
}

}  // namespace loam
