#include "runtime/frame/renderer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "runtime/base/check.h"
#include "runtime/frame/announced_view.h"
#include "runtime/frame/debug_views.h"
#include "runtime/frame/resolve_pass.h"
#include "runtime/frame/sector_distances.h"
#include "runtime/frame/targets.h"
#include "runtime/frame/texture_swap.h"
#include "runtime/geometry/patch_tree.h"
#include "runtime/geometry/terrain_pass.h"
#include "runtime/maps/height_map.h"
#include "runtime/maps/index_map.h"
#include "runtime/scene/shadow_cascades.h"
#include "runtime/scene/sun_sky.h"
#include "runtime/texture/decals.h"
#include "runtime/texture/layer_set.h"

namespace loam {

using gpu::Access;

namespace {

// What a device profile changes. Software figures follow the measurements of the platform: about 50,000
// triangles a frame, one or two whole texture pages a frame, uncompressed pages (their samples are twice as
// fast there as BC1's).
struct ProfileDefaults {
    PageFormat page_format;
    int page_budget;
    int height_pages, index_pages, cutout_pages;  // composed a frame
    double split_distance;
    uint32_t shadow_texels;
    int shadow_budget;  // cascades drawn a frame
    Filter moving, resting;
};

ProfileDefaults profile_defaults(gpu::Profile profile) {
    if (profile == gpu::Profile::software)
        return {PageFormat::rgba8, 2, 12, 2, 16, 2.4, 1024, 1, Filter::bilinear, Filter::anisotropic_tiles};
    return {PageFormat::bc1x3,           12, 48, 4, 64, 4.0, 2048, 4, Filter::anisotropic_hardware,
            Filter::anisotropic_hardware};
}

int pages_per_side(Quality quality) {
    switch (quality) {
        case Quality::very_low:
            return 13;
        case Quality::low:
            return 16;
        case Quality::mid:
            return 22;
        case Quality::high:
            return 30;
        case Quality::ultra:
            return 42;
    }
    return 16;
}

// Outside the frustum the ground only casts shadows: tuned so that half the cache serves what is seen.
constexpr int kGrazingLevels = 4;  // of the index map, that direct shading asks for beside the finest
constexpr double kHiddenShare = 0.4;

constexpr double kFrameGoal_ms = 33;  // while someone works

// Jitter within a pixel is not another view.
bool same_view(const Camera& a, const Camera& b) {
    return a.position_m == b.position_m && a.yaw_rad == b.yaw_rad && a.pitch_rad == b.pitch_rad &&
           a.fov_y_rad == b.fov_y_rad;
}

}  // namespace

struct Renderer::Impl {
    Impl(gpu::Device& d, Document& doc, const RendererDesc& r)
        : device(d), document(doc), desc(r), defaults(profile_defaults(d.caps().profile)) {}

    gpu::Device& device;
    Document& document;
    RendererDesc desc;
    ProfileDefaults defaults;

    std::unique_ptr<HeightMap> heights;
    std::unique_ptr<IndexMap> indices;
    std::unique_ptr<CutoutMap> cutouts;
    std::unique_ptr<LayerSet> layers;
    TextureSwap textures;
    std::unique_ptr<TerrainPass> terrain;
    std::unique_ptr<ShadowCascades> shadows;
    FrameTargets targets;
    std::unique_ptr<ResolvePass> resolve;

    uint64_t frame = 0;
    std::chrono::steady_clock::time_point frame_start = std::chrono::steady_clock::now();
    glm::uvec2 picture_size{0};
    bool settled = false;
    bool changed = true;      // something changed since the last frame
    uint64_t view_frame = 0;  // the first frame of the present view
    PatchSet patches;
    std::optional<AnnouncedView> announced;
    Camera last_camera;
    double camera_speed_m_s = 0;
    std::vector<gpu::PassTime> pass_times;      // of the newest finished frame
    gpu::UploadSlice decals, paints, segments;  // of direct shading, this frame's
    bool has_decals = false, has_paints = false;
    FunctionList functions;           // that direct shading has shown
    gpu::UploadSlice facts, squares;  // of debug views, this frame's
    shared::FrameUniforms last_uniforms{};  // for resolve_again

    Status create_texture(gpu::FrameRing& ring);
    [[nodiscard]] PageFormat page_format() const;
    [[nodiscard]] VirtualTextureDesc texture_desc() const;
    [[nodiscard]] TextureSources texture_sources() { return {device, document, *indices, *layers}; }
    [[nodiscard]] VirtualTexture& texture() { return textures.shown(); }
    [[nodiscard]] const VirtualTexture& texture() const { return textures.shown(); }
    // The settings with the device's own filter where they name none.
    [[nodiscard]] FrameSettings with_filter(FrameSettings settings) const {
        if (!settings.filter) settings.filter = settings.at_rest ? defaults.resting : defaults.moving;
        // The software device's sampler weighs texels far outside the footprint, those of other pages too, and
        // takes twelve times as long as one tap.
        const bool no_hardware =
            device.caps().profile == gpu::Profile::software || device.caps().max_anisotropy < kProbeTaps;
        if (*settings.filter == Filter::anisotropic_hardware && no_hardware)
            settings.filter = Filter::anisotropic_tiles;
        return settings;
    }
    [[nodiscard]] shared::FrameUniforms uniforms(const Camera& camera, glm::uvec2 size,
                                                 const FrameSettings& settings) const;
    void request_direct_pages(double pixels_per_radian, double footprint_bias);
    void upload_direct_decals(gpu::FrameRing& ring, double pixels_per_radian, double footprint_bias);
    Status announced_feedback(gpu::FrameRing& ring, gpu::Commands& commands, const FrameSettings& settings);
    void upload_debug(gpu::FrameRing& ring, DebugView view);
    Status cmd_heights_view(gpu::Commands& commands, const gpu::UploadSlice& uniform_slice,
                            const FrameSettings& settings);
    [[nodiscard]] double speed_m_s(const Camera& camera, double seconds);
    [[nodiscard]] ResolveInputs resolve_inputs(const gpu::UploadSlice& uniform_slice);
};

Renderer::Renderer() = default;
Renderer::~Renderer() = default;

Result<std::unique_ptr<Renderer>> Renderer::create(gpu::Device& device, gpu::FrameRing& ring,
                                                   Document& document, const RendererDesc& desc) {
    std::unique_ptr<Renderer> renderer(new Renderer);
    renderer->impl_ = std::make_unique<Impl>(device, document, desc);
    Impl& r = *renderer->impl_;

    auto heights = HeightMap::create(&device, document, {.slot_count = desc.height_slots});
    if (!heights) return heights.error();
    r.heights = std::move(*heights);
    auto indices = IndexMap::create(&device, document, {.slot_count = desc.index_slots});
    if (!indices) return indices.error();
    r.indices = std::move(*indices);
    auto cutouts = CutoutMap::create(&device, document);
    if (!cutouts) return cutouts.error();
    r.cutouts = std::move(*cutouts);
    LOAM_TRY(r.create_texture(ring));
    auto terrain =
        TerrainPass::create(device, {kGbufferFormat, kOcclusionFormat}, device.caps().depth_stencil);
    if (!terrain) return terrain.error();
    r.terrain = std::make_unique<TerrainPass>(std::move(*terrain));
    auto shadows = ShadowCascades::create(device, desc.shadows ? r.defaults.shadow_texels : 1);
    if (!shadows) return shadows.error();
    r.shadows = std::make_unique<ShadowCascades>(std::move(*shadows));
    auto resolve =
        ResolvePass::create(device, *r.layers, r.texture().textures(), r.defaults.moving, r.defaults.resting);
    if (!resolve) return resolve.error();
    r.resolve = std::make_unique<ResolvePass>(std::move(*resolve));
    return renderer;
}

PageFormat Renderer::Impl::page_format() const {
    const PageFormat format = desc.page_format.value_or(
        format_with_room(defaults.page_format, document.settings().channels.size()));
    return is_compressed(format) && !device.caps().bc ? PageFormat::rgba8 : format;
}

VirtualTextureDesc Renderer::Impl::texture_desc() const {
    VirtualTextureDesc wanted = desc.texture;
    wanted.format = page_format();
    if (wanted.pages_per_side == 0) wanted.pages_per_side = pages_per_side(desc.quality);
    if (wanted.indirection_size == 0) wanted.indirection_size = desc.quality >= Quality::high ? 1024 : 512;
    if (wanted.budget_pages == 0) wanted.budget_pages = defaults.page_budget;
    return wanted;
}

Status Renderer::Impl::create_texture(gpu::FrameRing& ring) {
    auto set = LayerSet::create(ring, document, uint64_t(desc.layer_budget_mb) << 20);
    if (!set) return set.error();
    textures.clear();
    layers = std::move(*set);
    return textures.replace(texture_sources(), texture_desc());
}

Status Renderer::set_quality(Quality quality, std::optional<PageFormat> page_format) {
    Impl& r = *impl_;
    const RendererDesc before = r.desc;
    r.desc.quality = quality;
    r.desc.page_format = page_format;
    r.desc.texture.pages_per_side = r.desc.texture.indirection_size = 0;
    const VirtualTextureDesc wanted = r.texture_desc(), &shown = r.texture().desc();
    r.changed = true;
    if (wanted.pages_per_side == shown.pages_per_side && wanted.indirection_size == shown.indirection_size &&
        wanted.format == shown.format) {
        r.textures.cancel();
        return {};
    }
    const Status made = r.textures.prepare(r.texture_sources(), wanted);
    if (!made) r.desc = before;
    return made;
}

Quality Renderer::quality() const {
    return impl_->desc.quality;
}
PageFormat Renderer::page_format() const {
    return impl_->page_format();
}

Status Renderer::settings_changed(gpu::FrameRing& ring) {
    Impl& r = *impl_;
    r.changed = true;
    const ProjectSettings& settings = r.document.settings();
    LOAM_TRY(r.indices->take_settings());
    if (!r.layers->has_textures_of(settings)) {
        r.resolve->take_settings();
        return r.create_texture(ring);
    }
    if (r.layers->ground == settings.ground && r.layers->imagery == settings.imagery &&
        r.layers->entries == settings.layers)
        return {};
    LOAM_TRY(r.layers->take_settings(ring, settings));
    r.resolve->take_settings();
    return r.textures.take_settings();
}

shared::FrameUniforms Renderer::Impl::uniforms(const Camera& camera, glm::uvec2 size,
                                               const FrameSettings& settings) const {
    shared::FrameUniforms u{};
    const glm::dmat4 clip = camera.clip_from_rel(size.x, size.y, settings.jitter_px);
    u.clip_from_rel = glm::mat4(clip);
    u.rel_from_clip = glm::mat4(glm::inverse(clip));
    const ProjectSettings& project = document.settings();
    fill_sun_sky(
        {project.sun_azimuth_rad, project.sun_elevation_rad, project.haze_per_km, camera.position_m.z}, u);
    u.picture_px = glm::vec2(size);
    u.inv_picture_px = 1.0f / glm::vec2(size);
    u.frame = uint32_t(frame);
    return u;
}

// Direct shading looks up any place of the index map: every page under the visible patches, at the level that
// the nearest pixel of the patch reads (shaders/texture/direct.glsl).
void Renderer::Impl::request_direct_pages(double pixels_per_radian, double footprint_bias) {
    const VirtualMap& map = indices->map();
    const glm::dvec3 eye = last_camera.position_m;
    for (int i = 0; i < patches.visible_count; ++i) {
        const shared::PatchInstance& patch = patches.patches[size_t(i)];
        const glm::dvec2 corner = glm::dvec2(patches.origin_step + patch.origin) * patches.step_m;
        const double side = patch.stride * patches.step_m * kPatchQuads;
        const WorldRect rect =
            intersected({corner.x, corner.y, corner.x + side, corner.y + side}, map.desc().bounds);
        if (rect.empty()) continue;
        const double near = std::max(rect.distance(eye.x, eye.y), 1.0);
        const double wanted =
            std::floor(std::log2(near / pixels_per_radian / map.desc().spacing_m) + 1.0 + footprint_bias);
        const int finest = int(std::clamp(wanted, 0.0, double(map.desc().level_count - 1)));
        // Where the ground is seen at a grazing angle a pixel covers more of it, and a level that is not
        // there would be taken from a coarser one.
        const int coarsest = std::min(finest + kGrazingLevels, map.desc().level_count - 1);
        for (int level = finest; level <= coarsest; ++level) {
            const double page = map.page_size_m(level);
            for (int y = int(rect.min_y / page); y <= int(rect.max_y / page); ++y)
                for (int x = int(rect.min_x / page); x <= int(rect.max_x / page); ++x)
                    indices->request({level, x, y}, float((1 + level - finest) / near));
        }
    }
}

void Renderer::Impl::upload_direct_decals(gpu::FrameRing& ring, double pixels_per_radian,
                                          double footprint_bias) {
    std::vector<WorldRect> ground;
    for (int i = 0; i < patches.visible_count; ++i) {
        const shared::PatchInstance& patch = patches.patches[size_t(i)];
        const glm::dvec2 corner = glm::dvec2(patches.origin_step + patch.origin) * patches.step_m;
        const double side = patch.stride * patches.step_m * kPatchQuads;
        ground.push_back({corner.x, corner.y, corner.x + side, corner.y + side});
    }
    const DirectDecals found = direct_decals(document, *layers,
                                             {.camera_m = last_camera.position_m,
                                              .pixels_per_radian = pixels_per_radian,
                                              .footprint_bias = footprint_bias,
                                              .ground = ground},
                                             functions);
    has_decals = !found.decals.empty();
    has_paints = !found.paints.empty();
    const auto upload = [&ring]<typename T>(const std::vector<T>& list) {
        const gpu::UploadSlice slice = ring.upload(std::max<size_t>(list.size(), 1) * sizeof(T));
        std::copy(list.begin(), list.end(), slice.as<T>());
        return slice;
    };
    decals = upload(found.decals);
    paints = upload(found.paints);
    segments = upload(found.segments);
}

ResolveInputs Renderer::Impl::resolve_inputs(const gpu::UploadSlice& uniform_slice) {
    return {.targets = targets,
            .shadows = *shadows,
            .texture = texture(),
            .indices = *indices,
            .layers = *layers,
            .size = picture_size,
            .uniforms = uniform_slice,
            .decals = decals,
            .paints = paints,
            .segments = segments,
            .has_decals = has_decals,
            .has_paints = has_paints,
            .functions = &functions,
            .facts = facts,
            .squares = squares};
}

void Renderer::Impl::upload_debug(gpu::FrameRing& ring, DebugView view) {
    const auto upload = [&](const auto& values) {
        const gpu::UploadSlice slice = ring.upload(values.size() * sizeof(values[0]));
        std::memcpy(slice.data, values.data(), slice.size_bytes);
        return slice;
    };
    using DecalCount = VirtualTexture::DecalCount;
    facts = upload(texture().place_facts(view == DebugView::decals ? DecalCount::counted : DecalCount::none));
    std::vector<shared::VtImageSquare> images = texture().image_squares();
    images.push_back({});  // ends the list
    squares = upload(images);
}

// The sky, and the ground by the levels of its height pages.
Status Renderer::Impl::cmd_heights_view(gpu::Commands& commands, const gpu::UploadSlice& uniform_slice,
                                        const FrameSettings& settings) {
    LOAM_TRY(resolve->cmd_record(commands, resolve_inputs(uniform_slice), settings, ResolvePart::sky));
    const auto pass = commands.pass("height levels", {{targets.picture, Access::color_target},
                                                      {targets.depth, Access::depth_sampled},
                                                      {heights->heights(), Access::vertex_read},
                                                      {heights->normals(), Access::fragment_sampled}});
    const gpu::ColorTarget colors[] = {{targets.picture.view(), VK_ATTACHMENT_LOAD_OP_LOAD, {}}};
    commands.begin_rendering({picture_size.x, picture_size.y}, colors,
                             {.view = targets.depth.view(), .has_stencil = true, .read_only = true});
    commands.set_viewport(0, 0, float(picture_size.x), float(picture_size.y));
    LOAM_TRY(
        terrain->cmd_draw_levels(commands, patches, *heights, last_uniforms.clip_from_rel, kPictureFormat));
    commands.end_rendering();
    return {};
}

void Renderer::on_dirt(const Dirt& dirt) {
    Impl& r = *impl_;
    r.changed = true;
    r.shadows->on_dirt(dirt.height, *r.heights);
    r.heights->on_dirt(dirt.height);
    r.indices->on_dirt(dirt.index);
    r.cutouts->on_dirt(dirt.cutout);
    r.cutouts->on_height_dirt(dirt.height);
    r.textures.on_dirt(dirt);
}

void Renderer::announce(const std::optional<Camera>& camera) {
    Impl& r = *impl_;
    if (!camera) {
        r.announced.reset();
        return;
    }
    if (!r.announced) r.announced.emplace();
    r.announced->camera = *camera;
    r.changed = true;
}

// What the announced place's picture will want.
Status Renderer::Impl::announced_feedback(gpu::FrameRing& ring, gpu::Commands& commands,
                                          const FrameSettings& settings) {
    AnnouncedView& a = *announced;
    LOAM_TRY(a.targets.ensure(device, a.size));
    LOAM_TRY(terrain->upload(ring, commands, a.patches));
    const shared::FrameUniforms u = uniforms(a.camera, a.size, settings);
    const gpu::UploadSlice slice = ring.upload(sizeof(u));
    *slice.as<shared::FrameUniforms>() = u;
    cmd_prepass(commands, *terrain, a.targets, *heights, a.patches, a.size, u.clip_from_rel);
    return texture().record_feedback(ring, commands,
                                     {.depth = a.targets.depth,
                                      .gbuffer = a.targets.gbuffer,
                                      .uniforms = *slice.buffer,
                                      .uniforms_offset = slice.offset,
                                      .picture_px = a.size,
                                      .eye = Eye::announced,
                                      .footprint_log2 = a.footprint_log2});
}

// Smoothed over a few frames; a jump is no speed.
double Renderer::Impl::speed_m_s(const Camera& camera, double seconds) {
    constexpr double kJump_m = 64;
    const double moved_m = glm::length(camera.position_m - last_camera.position_m);
    const double now = moved_m < kJump_m && seconds > 0 ? moved_m / seconds : 0.0;
    camera_speed_m_s = moved_m < kJump_m ? 0.7 * camera_speed_m_s + 0.3 * now : 0.0;
    return camera_speed_m_s;
}

// The frame, top to bottom.
Status Renderer::render(gpu::FrameRing& ring, gpu::Commands& commands, const Camera& camera,
                        glm::uvec2 extent, const FrameSettings& wanted) {
    Impl& r = *impl_;
    const FrameSettings settings = r.with_filter(wanted);
    ++r.frame;
    r.pass_times.assign(ring.pass_times().begin(), ring.pass_times().end());
    const auto now = std::chrono::steady_clock::now();
    const double last_frame_ms = std::chrono::duration<double, std::milli>(now - r.frame_start).count();
    r.frame_start = now;
    const float scale = std::clamp(settings.render_scale, 0.1f, 1.0f);
    const glm::uvec2 size = glm::max(glm::uvec2(glm::round(glm::vec2(extent) * scale)), glm::uvec2(8));
    LOAM_TRY(r.targets.ensure(r.device, glm::max(extent, size)));
    if (!same_view(camera, r.last_camera) || size != r.picture_size) r.view_frame = r.frame;
    r.picture_size = size;
    const double speed_m_s = r.speed_m_s(camera, last_frame_ms / 1000);
    r.last_camera = camera;

    shared::FrameUniforms u = r.uniforms(camera, size, settings);

    // Holes first: they say which patches are drawn, and how.
    std::vector<WorldRect> opened;
    LOAM_TRY(r.cutouts->update(ring, commands, camera.position_m, r.defaults.cutout_pages, opened));
    r.shadows->on_dirt(opened, *r.heights);

    // Pages: the cut of the height map, what it lacks, and what the texture needs of the index map.
    const double split =
        r.desc.patch_split_distance > 0 ? r.desc.patch_split_distance : r.defaults.split_distance;
    r.patches =
        select_patches(*r.heights, {.camera_m = camera.position_m,
                                    .clip_from_rel = camera.clip_from_rel(size.x, size.y, settings.jitter_px),
                                    .split_distance = split,
                                    .hidden_share = kHiddenShare,
                                    .cutouts = r.cutouts.get()});
    const double pixels_per_radian = size.y * 0.5 / std::tan(camera.fov_y_rad * 0.5);
    std::vector<SectorDistance> near =
        sector_distances(r.patches, *r.heights, r.texture().live_radius_m(pixels_per_radian, 0));
    if (r.announced) {
        r.announced->prepare(*r.heights, *r.cutouts, size, split);
        const double there = size.y * 0.5 / std::tan(r.announced->camera.fov_y_rad * 0.5);
        std::vector<SectorDistance> far =
            sector_distances(r.announced->patches, *r.heights, r.texture().live_radius_m(there, 0));
        for (SectorDistance& s : far) s.distance_m *= pixels_per_radian / there;
        merge_nearer(near, far);
    }
    const TextureView view{
        .camera_m = camera.position_m,
        .pixels_per_radian = pixels_per_radian,
        .near = near,
        .speed_m_s = speed_m_s,
        .announced_m = r.announced ? std::optional(r.announced->camera.position_m) : std::nullopt,
        .frame = r.frame,
        .same_since = r.view_frame,
        .still = settings.at_rest,
        .filter = filter_rule(*settings.filter, settings.most_taps),
        .budget_pages = settings.page_budget,
        // In motion and work frames are waited for.
        .goal_ms = settings.at_rest ? 0.0 : kFrameGoal_ms,
        .last_frame_ms = last_frame_ms};
    r.document.trim_operators();
    r.textures.request_inputs(view, settings.shading == Shading::virtual_texture);
    if (settings.shading != Shading::virtual_texture) {
        r.request_direct_pages(view.pixels_per_radian, settings.footprint_bias);
        r.upload_direct_decals(ring, view.pixels_per_radian, settings.footprint_bias);
    }
    LOAM_TRY(r.heights->update(ring, commands, r.frame, r.defaults.height_pages));
    LOAM_TRY(r.indices->update(ring, commands, r.frame, r.defaults.index_pages));
    LOAM_TRY(r.layers->update(ring, commands, view.goal_ms == 0));
    LOAM_TRY(r.textures.update(ring, commands, view));
    if (r.announced && settings.shading == Shading::virtual_texture)
        LOAM_TRY(r.announced_feedback(ring, commands, settings));
    LOAM_TRY(r.terrain->upload(ring, commands, r.patches));

    // Shadows: only the cascades that something has changed in.
    if (r.desc.shadows)
        r.shadows->update(commands, *r.terrain, r.patches, *r.heights, camera.position_m,
                          sun_direction({.azimuth_rad = r.document.settings().sun_azimuth_rad,
                                         .elevation_rad = r.document.settings().sun_elevation_rad}),
                          r.defaults.shadow_budget, settings.at_rest, u);

    const gpu::UploadSlice slice = ring.upload(sizeof(u));
    *slice.as<shared::FrameUniforms>() = u;

    // Depth, stencil, geometric normal, footprint.
    cmd_prepass(commands, *r.terrain, r.targets, *r.heights, r.patches, size, u.clip_from_rel);
    // Which pages the picture would like to have.
    if (settings.shading == Shading::virtual_texture)
        LOAM_TRY(r.textures.record_feedback(ring, commands,
                                            {.depth = r.targets.depth,
                                             .gbuffer = r.targets.gbuffer,
                                             .uniforms = *slice.buffer,
                                             .uniforms_offset = slice.offset,
                                             .picture_px = size}));
    // Sky, then the terrain's pixels from the virtual texture.
    r.last_uniforms = u;
    if (settings.debug != DebugView::none) r.upload_debug(ring, settings.debug);
    if (settings.debug == DebugView::heights)
        LOAM_TRY(r.cmd_heights_view(commands, slice, settings));
    else
        LOAM_TRY(r.resolve->cmd_record(commands, r.resolve_inputs(slice), settings, ResolvePart::all));
    commands.use({{r.targets.picture, Access::fragment_sampled}});

    const bool asked = settings.shading != Shading::virtual_texture ||
                       (r.texture().settled() && r.texture().last_feedback_frame() >= r.view_frame);
    r.settled = !r.changed && asked && !r.textures.pending() && !r.heights->has_work() &&
                !r.cutouts->has_work() && !r.indices->has_work() && (!r.desc.shadows || r.shadows->settled());
    r.changed = false;
    return {};
}

Status Renderer::resolve_again(gpu::FrameRing& ring, gpu::Commands& commands, const FrameSettings& settings,
                               ResolveProbe probe) {
    Impl& r = *impl_;
    const gpu::UploadSlice slice = ring.upload(sizeof(r.last_uniforms));
    *slice.as<shared::FrameUniforms>() = r.last_uniforms;
    return r.resolve->cmd_record(commands, r.resolve_inputs(slice), r.with_filter(settings),
                                 probe == ResolveProbe::floor ? ResolvePart::floor : ResolvePart::ground);
}

gpu::Image& Renderer::picture() {
    return impl_->targets.picture;
}
glm::uvec2 Renderer::picture_size() const {
    return impl_->picture_size;
}
gpu::Image& Renderer::gbuffer() {
    return impl_->targets.gbuffer;
}
FilterTiles& Renderer::filter_tiles() {
    return impl_->resolve->tiles();
}
gpu::Image& Renderer::depth() {
    return impl_->targets.depth;
}
bool Renderer::settled() const {
    return impl_->settled;
}

uint32_t Renderer::pending_pages() const {
    const auto t = impl_->texture().statistics();
    return t.missing_pages + t.dirty_pages + (impl_->heights->has_work() ? 1 : 0) +
           (impl_->indices->has_work() ? 1 : 0) + (impl_->cutouts->has_work() ? 1 : 0);
}

double Renderer::height_m(double x_m, double y_m) {
    return impl_->heights->height_m(x_m, y_m);
}
glm::dvec3 Renderer::normal(double x_m, double y_m) {
    return impl_->heights->normal(x_m, y_m);
}
IndexTexel Renderer::layer_at(double x_m, double y_m) {
    return impl_->indices->texel_at(x_m, y_m);
}
std::optional<glm::dvec3> Renderer::ray_cast(glm::dvec3 origin_m, glm::dvec3 direction, double max_m,
                                             Holes holes) {
    return impl_->heights->ray_cast(origin_m, direction, max_m, holes);
}
const LayerSet& Renderer::layers() const {
    return *impl_->layers;
}

FrameStatistics Renderer::statistics() const {
    const Impl& r = *impl_;
    FrameStatistics s;
    s.patches = uint32_t(r.patches.patches.size());
    s.patches_visible = uint32_t(r.patches.visible_count);
    s.triangles = s.patches_visible * kPatchQuads * kPatchQuads * 2;
    r.heights->map().for_each_resident([&](const MapPage&, int, const TexelRect&) { ++s.height_pages; });
    r.indices->map().for_each_resident([&](const MapPage&, int, const TexelRect&) { ++s.index_pages; });
    s.shadow_cascades_drawn = r.shadows->drawn();
    s.shadow_parts_drawn = r.shadows->parts_drawn();
    s.texture = r.texture().statistics();
    s.passes = r.pass_times;
    s.height = r.heights->map().counters();
    s.index = r.indices->map().counters();
    s.layers = r.layers->statistics();
    s.cutouts = r.cutouts->counts();
    s.memory = {{"height pages (GPU)", r.heights->gpu_bytes()},
                {"height pages (CPU)", r.heights->cpu_bytes()},
                {"index pages (GPU)", r.indices->gpu_bytes()},
                {"cutout pages (GPU)", r.cutouts->gpu_bytes()},
                {"virtual texture", s.texture.gpu_bytes},
                {"layers", r.layers->gpu_bytes()},
                {"shadow atlas", r.shadows->atlas().bytes()},
                {"frame targets", r.targets.bytes() + r.resolve->tiles().bytes()}};
    return s;
}

Result<uint32_t> Renderer::count_stale_pages(gpu::FrameRing& ring) {
    Impl& r = *impl_;
    auto stale = r.texture().count_stale_pages(ring);
    if (!stale) return stale.error();
    return *stale + r.heights->count_stale_pages(r.document) + r.indices->count_stale_pages(r.document) +
           r.cutouts->count_stale_pages(r.document);
}

}  // namespace loam
