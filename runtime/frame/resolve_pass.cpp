#include "runtime/frame/resolve_pass.h"

#include "shaders/frame/resolve_io.h"

namespace loam {

using gpu::Access;

namespace {

constexpr uint32_t kMaterialSlot = 5;  // VT_FIRST_SLOT and DIRECT_FIRST_SLOT of the resolve shaders

void use_material(gpu::Commands& commands, const ResolveInputs& in, bool direct) {
    if (direct)
        commands.use({{in.indices.indices(), Access::fragment_sampled},
                      {in.indices.tints(), Access::fragment_sampled},
                      {in.indices.page_table(), Access::fragment_sampled},
                      {in.texture.direct_params(), Access::fragment_sampled},
                      {in.texture.direct_places(), Access::fragment_sampled},
                      {in.layers.albedo_reveal, Access::fragment_sampled},
                      {in.layers.normal_gloss_occlusion, Access::fragment_sampled},
                      {in.layers.metalness, Access::fragment_sampled},
                      {in.layers.distortion_map(), Access::fragment_sampled}});
    else
        commands.use({{in.texture.params(), Access::fragment_sampled},
                      {in.texture.sector_table(), Access::fragment_sampled},
                      {in.texture.indirection(), Access::fragment_sampled},
                      {in.texture.atlas(0), Access::fragment_sampled},
                      {in.texture.atlas(1), Access::fragment_sampled},
                      {in.texture.atlas(2), Access::fragment_sampled},
                      {in.texture.atlas(3), Access::fragment_sampled}});
}

std::vector<gpu::Bound> cached_material(const ResolveInputs& in) {
    constexpr uint32_t s = kMaterialSlot;
    return {{s, in.texture.params()},
            {s + 1, in.texture.sector_table()},
            {s + 2, in.texture.indirection().view(), in.texture.nearest_sampler()},
            {s + 3, in.texture.atlas(0).view(), in.texture.sampler()},
            {s + 4, in.texture.atlas(1).view(), in.texture.sampler()},
            {s + 5, in.texture.atlas(2).view(), in.texture.sampler()},
            {s + 6, in.texture.atlas(3).view(), in.texture.sampler()}};
}

std::vector<gpu::Bound> direct_material(const ResolveInputs& in) {
    constexpr uint32_t s = kMaterialSlot;
    return {{s, in.texture.direct_params()},
            {s + 1, in.texture.direct_places()},
            {s + 2, in.indices.page_table()},
            {s + 3, in.indices.indices().view(), in.texture.nearest_sampler()},
            {s + 4, in.indices.tints().view(), in.texture.nearest_sampler()},
            {s + 5, in.layers.albedo_reveal.view(), in.layers.sampler},
            {s + 6, in.layers.normal_gloss_occlusion.view(), in.layers.sampler},
            {s + 7, in.layers.metalness.view(), in.layers.sampler},
            {s + 8, *in.decals.buffer, in.decals.offset, in.decals.size_bytes},
            {s + 9, in.layers.distortion_map().view(), in.layers.sampler}};
}

std::vector<gpu::Bound> floor_material(const ResolveInputs& in) {
    return {{kMaterialSlot, in.texture.atlas(0).view(), in.texture.sampler()},
            {kMaterialSlot + 1, in.texture.atlas(1).view(), in.texture.sampler()},
            {kMaterialSlot + 2, in.texture.atlas(2).view(), in.texture.sampler()}};
}

}  // namespace

Result<ResolvePass> ResolvePass::create(gpu::Device& device, const LayerSet& layers,
                                        const PageTextures& textures) {
    ResolvePass pass(device);
    LOAM_TRY(pass.make_fixed());
    for (Kind kind : {Kind::fast, Kind::fine})
        if (auto made = pass.pipeline(kind, layers, textures); !made) return made.error();
    return pass;
}

Status ResolvePass::make_fixed() {
    auto point = gpu::Sampler::create(*device_, {.filter = VK_FILTER_NEAREST});
    if (!point) return point.error();
    point_ = std::move(*point);
    auto made = gpu::Pipeline::create(
        *device_,
        gpu::GraphicsDesc{
            .name = "sky",
            .vertex_shader = "frame/fullscreen.vert",
            .fragment_shader = "frame/sky.frag",
            .bindings = {gpu::storage_buffer(0)},
            .color_formats = {kPictureFormat},
            .depth_format = device_->caps().depth_stencil,
            .stencil = {
                .enable = true, .compare = VK_COMPARE_OP_NOT_EQUAL, .reference = 1, .write_mask = 0}});
    if (!made) return made.error();
    sky_ = std::move(*made);
    return {};
}

Result<gpu::Pipeline*> ResolvePass::pipeline(Kind kind, const LayerSet& layers,
                                             const PageTextures& textures) {
    if (textures.layout != layout_ || textures.placement != placement_) pipelines_ = {};
    layout_ = textures.layout;
    placement_ = textures.placement;
    gpu::Pipeline& pipeline = pipelines_[size_t(kind)];
    if (pipeline) return &pipeline;
    const bool texels = kind == Kind::texels || kind == Kind::texels_decals;
    const bool direct = texels || kind == Kind::direct || kind == Kind::direct_decals;
    const bool floor = kind == Kind::floor || kind == Kind::floor_fine;
    gpu::GraphicsDesc d{
        .name = direct ? "resolve direct" : "resolve",
        .vertex_shader = "frame/fullscreen.vert",
        .fragment_shader = direct  ? "frame/resolve_direct.frag"
                           : floor ? "frame/resolve_floor.frag"
                                   : "frame/resolve.frag",
        .push_bytes = sizeof(shared::ResolvePush),
        // 0: fine shadows, 1: debug views, 20: both mips of a page, 21: layers with metal, 22: decals, 25:
        // texels, 30, 31: the page's layout and channels, 40: tile hiding, 41: distortion,
        // 42: transitions.
        .constants = {{0, kind == Kind::fast || kind == Kind::floor ? 0u : 1u},
                      {1, kind == Kind::debug ? 1u : 0u},
                      {20, kind == Kind::fast ? 0u : 1u},
                      {21, layers.has_metal ? 1u : 0u},
                      {22, kind == Kind::direct_decals || kind == Kind::texels_decals ? 1u : 0u},
                      {25, texels ? 1u : 0u},
                      {30, textures.layout},
                      {31, textures.placement},
                      {40, layers.ground.tile_hiding},
                      {41, layers.ground.distortion_amplitude_m > 0},
                      {42, layers.has_transitions}},
        .color_formats = {kPictureFormat},
        .depth_format = device_->caps().depth_stencil,
        .stencil = {.enable = true, .compare = VK_COMPARE_OP_EQUAL, .reference = 1, .write_mask = 0}};
    d.bindings = {gpu::storage_buffer(0), gpu::sampled_image(1), gpu::sampled_image(2), gpu::sampled_image(3),
                  gpu::sampled_image(4)};
    // Then the material's: shaders/texture/direct.glsl or vt_sample.glsl, from slot 5.
    const uint32_t buffers = direct ? 3 : floor ? 0 : 2, images = direct ? 5 : floor ? 3 : 5;
    for (uint32_t i = 0; i < buffers + images; ++i)
        d.bindings.push_back(i < buffers ? gpu::storage_buffer(kMaterialSlot + i)
                                         : gpu::sampled_image(kMaterialSlot + i));
    if (direct) {
        d.bindings.push_back(gpu::storage_buffer(kMaterialSlot + buffers + images));
        d.bindings.push_back(gpu::sampled_image(kMaterialSlot + buffers + images + 1));
    }
    auto made = gpu::Pipeline::create(*device_, d);
    if (!made) return made.error();
    pipeline = std::move(*made);
    return &pipeline;
}

void ResolvePass::take_settings() {
    for (const Kind kind : {Kind::direct, Kind::direct_decals, Kind::texels, Kind::texels_decals})
        pipelines_[size_t(kind)] = {};
}

Status ResolvePass::cmd_record(gpu::Commands& commands, const ResolveInputs& in,
                               const FrameSettings& settings, ResolvePart part) {
    const bool floor = part == ResolvePart::floor;
    const bool direct = settings.shading != Shading::virtual_texture;
    const bool texels = settings.shading == Shading::direct_texels;
    const Kind kind = floor                     ? settings.fine_filter ? Kind::floor_fine : Kind::floor
                      : direct && in.has_decals ? texels ? Kind::texels_decals : Kind::direct_decals
                      : direct                  ? texels ? Kind::texels : Kind::direct
                      : settings.debug != DebugView::none ? Kind::debug
                      : settings.fine_filter              ? Kind::fine
                                                          : Kind::fast;
    auto resolve = pipeline(kind, in.layers, in.texture.textures());
    if (!resolve) return resolve.error();
    use_material(commands, in, direct);

    const auto pass = commands.pass("resolve", {{in.targets.picture, Access::color_target},
                                                {in.targets.depth, Access::depth_sampled},
                                                {in.targets.gbuffer, Access::fragment_sampled},
                                                {in.targets.occlusion, Access::fragment_sampled},
                                                {in.shadows.atlas(), Access::fragment_sampled}});
    const gpu::ColorTarget colors[] = {{in.targets.picture.view(), VK_ATTACHMENT_LOAD_OP_DONT_CARE, {}}};
    commands.begin_rendering({in.size.x, in.size.y}, colors,
                             {.view = in.targets.depth.view(), .has_stencil = true, .read_only = true});
    commands.set_viewport(0, 0, float(in.size.x), float(in.size.y));

    const gpu::Bound frame_bound(0, *in.uniforms.buffer, in.uniforms.offset, in.uniforms.size_bytes);
    if (part == ResolvePart::all) {
        commands.bind(sky_, {frame_bound});
        commands.draw(3);
    }

    std::vector<gpu::Bound> bound = {
        frame_bound,
        {1, in.targets.depth.depth_view(), point_, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL},
        {2, in.targets.gbuffer.view(), point_},
        {3, in.targets.occlusion.view(), point_},
        {4, in.shadows.atlas().view(), in.shadows.sampler()},
    };
    const std::vector<gpu::Bound> material = floor    ? floor_material(in)
                                             : direct ? direct_material(in)
                                                      : cached_material(in);
    bound.insert(bound.end(), material.begin(), material.end());
    commands.bind(**resolve, bound);
    commands.push(**resolve, shared::ResolvePush{uint32_t(settings.debug), settings.footprint_bias});
    commands.draw(3);
    commands.end_rendering();
    return {};
}

}  // namespace loam
