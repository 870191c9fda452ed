#include "runtime/frame/resolve_pass.h"

#include <algorithm>

#include "runtime/document/decal_function.h"
#include "runtime/frame/debug_views.h"
#include "runtime/gpu/shader_library.h"
#include "shaders/frame/debug_io.h"
#include "shaders/frame/parallax_math.h"
#include "shaders/frame/tiles_io.h"

namespace loam {

using gpu::Access;

namespace {

constexpr const char* kDirect = "frame/resolve_direct.frag";
constexpr const char* kDirectWithFunctions = "frame/resolve_direct.frag:functions";
constexpr uint32_t kMaterialSlot = 5;  // VT_FIRST_SLOT and DIRECT_FIRST_SLOT of the resolve shaders
constexpr uint32_t kTileSlot = 20;     // tile.vert

// Look-ups that the taps of a class are shared among.
constexpr int probes_of(int taps) {
    return std::max(1, taps / kProbeTaps);
}
// Probes of hardware anisotropy, for eight to one: a sampler's taps reach half the probe's axis, so two of at
// most four to one stay within a page's border.
constexpr int kHardwareProbes = 2;

// Where no layer asks nothing is evaluated.
int parallax_steps(const LayerSet& layers, const FrameSettings& settings) {
    constexpr int kMost = 1024;
    return layers.deepest > 0 ? std::clamp(settings.parallax_steps, 0, kMost) : 0;
}

void use_material(gpu::Commands& commands, const ResolveInputs& in, bool direct) {
    LayerArrays& layers = in.layers.arrays(in.layers.direct_tier());
    if (direct)
        commands.use({{in.indices.indices(), Access::fragment_sampled},
                      {in.indices.tints(), Access::fragment_sampled},
                      {in.indices.imagery(), Access::fragment_sampled},
                      {in.indices.page_table(), Access::fragment_sampled},
                      {in.texture.direct_params(), Access::fragment_sampled},
                      {in.texture.direct_places(), Access::fragment_sampled},
                      {layers.albedo_reveal, Access::fragment_sampled},
                      {layers.normal_gloss_occlusion, Access::fragment_sampled},
                      {layers.metalness, Access::fragment_sampled},
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

std::vector<gpu::Bound> cached_material(const ResolveInputs& in, const gpu::Sampler& sampler) {
    constexpr uint32_t s = kMaterialSlot;
    return {{s, in.texture.params()},
            {s + 1, in.texture.sector_table()},
            {s + 2, in.texture.indirection().view(), in.texture.nearest_sampler()},
            {s + 3, in.texture.atlas(0).view(), sampler},
            {s + 4, in.texture.atlas(1).view(), sampler},
            {s + 5, in.texture.atlas(2).view(), sampler},
            {s + 6, in.texture.atlas(3).view(), sampler}};
}

std::vector<gpu::Bound> direct_material(const ResolveInputs& in, bool smooth) {
    constexpr uint32_t s = kMaterialSlot;
    const gpu::Sampler& sampler = smooth ? in.layers.smooth_sampler : in.layers.sampler;
    const LayerArrays& layers = in.layers.arrays(in.layers.direct_tier());
    return {{s, in.texture.direct_params()},
            {s + 1, in.texture.direct_places()},
            {s + 2, in.indices.page_table()},
            {s + 3, in.indices.indices().view(), in.texture.nearest_sampler()},
            {s + 4, in.indices.tints().view(), in.texture.nearest_sampler()},
            {s + 5, layers.albedo_reveal.view(), sampler},
            {s + 6, layers.normal_gloss_occlusion.view(), sampler},
            {s + 7, layers.metalness.view(), sampler},
            {s + 8, *in.decals.buffer, in.decals.offset, in.decals.size_bytes},
            {s + 9, in.layers.distortion_map().view(), in.layers.sampler},
            {s + 10, *in.paints.buffer, in.paints.offset, in.paints.size_bytes},
            {s + 11, *in.segments.buffer, in.segments.offset, in.segments.size_bytes},
            {s + 12, in.indices.imagery().view(), in.texture.nearest_sampler()}};
}

std::vector<gpu::Bound> floor_material(const ResolveInputs& in) {
    return {{kMaterialSlot, in.texture.atlas(0).view(), in.texture.sampler()},
            {kMaterialSlot + 1, in.texture.atlas(1).view(), in.texture.sampler()},
            {kMaterialSlot + 2, in.texture.atlas(2).view(), in.texture.sampler()}};
}

}  // namespace

Result<ResolvePass> ResolvePass::create(gpu::Device& device, const LayerSet& layers,
                                        const PageTextures& textures, Filter moving, Filter resting) {
    ResolvePass pass(device);
    LOAM_TRY(pass.make_fixed());
    for (const bool at_rest : {false, true}) {
        const FrameSettings settings{.at_rest = at_rest, .filter = at_rest ? resting : moving};
        Variant v = pass.variant(settings, ResolvePart::all, false, false);
        v.parallax_steps = parallax_steps(layers, settings);
        for (v.taps = v.tiles ? 1 : v.taps; v.taps <= kMaxTaps; v.taps *= 2) {
            if (v.tiles) v.probes = probes_of(v.taps);
            if (auto made = pass.pipeline(v, layers, textures); !made) return made.error();
            if (!v.tiles) break;
        }
    }
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

ResolvePass::Variant ResolvePass::variant(const FrameSettings& settings, ResolvePart part,
                                          bool has_decals, bool has_paints) const {
    using Ground = Variant::Ground;
    Variant v{.fine_shadows = settings.at_rest};
    if (part == ResolvePart::floor) {
        v.ground = Ground::floor;
    } else if (settings.shading != Shading::virtual_texture) {
        v.ground = settings.shading == Shading::direct ? Ground::direct : Ground::direct_texels;
        v.decals = has_decals || has_paints;
        v.paints = has_paints;
    } else {
        v.debug = settings.debug != DebugView::none;
        v.map = debug_is_map(settings.debug);
        v.two_mips = *settings.filter != Filter::bilinear;
        // Debug views show the same places of the same pages however many taps there are.
        v.tiles = *settings.filter == Filter::anisotropic_tiles && !v.debug;
        v.hardware = *settings.filter == Filter::anisotropic_hardware;
        if (v.hardware) {
            v.taps = kMaxTaps;
            v.probes = kHardwareProbes;
        }
    }
    return v;
}

Result<gpu::Pipeline*> ResolvePass::pipeline(const Variant& v, const LayerSet& layers,
                                             const PageTextures& textures) {
    using Ground = Variant::Ground;
    if (textures.layout != layout_ || textures.placement != placement_) pipelines_.clear();
    layout_ = textures.layout;
    placement_ = textures.placement;
    gpu::Pipeline& pipeline = pipelines_[v];
    if (pipeline) return &pipeline;
    const bool direct = v.ground == Ground::direct || v.ground == Ground::direct_texels;
    const bool floor = v.ground == Ground::floor;
    gpu::GraphicsDesc d{
        .name = direct ? "resolve direct" : "resolve",
        .vertex_shader = v.tiles ? "frame/tile.vert" : "frame/fullscreen.vert",
        .fragment_shader = direct    ? (v.functions ? kDirectWithFunctions : kDirect)
                           : floor   ? "frame/resolve_floor.frag"
                           : v.map   ? "frame/resolve_map.frag"
                           : v.debug ? "frame/resolve_debug.frag"
                                     : "frame/resolve.frag",
        .push_bytes = sizeof(shared::ResolvePush),
        // 0: fine shadows, 20: both mips of a page, 21: layers with metal, 22: decals, 23: of materials,
        // 25: texels, 26: taps, 27: look-ups they are shared among, 28: the sampler's own anisotropy, 30, 31:
        // the page's layout and channels, 40: tile hiding, 41: distortion, 42: transitions, 43: layers
        // between their mips, 44: vista UVs, 45: imagery, 46: steps of parallax.
        .constants = {{0, v.fine_shadows},
                      {20, v.two_mips},
                      {21, layers.has_metal ? 1u : 0u},
                      {22, v.decals},
                      {23, v.paints},
                      {25, v.ground == Ground::direct_texels},
                      {26, uint32_t(v.taps)},
                      {27, uint32_t(v.probes)},
                      {28, v.hardware},
                      {30, textures.layout},
                      {31, textures.placement},
                      {40, layers.ground.tile_hiding},
                      {41, layers.ground.distortion_amplitude_m > 0},
                      {42, layers.has_transitions},
                      {43, v.smooth_layers()},
                      {44, layers.ground.has_vista()},
                      {45, layers.imagery.is_on()},
                      {46, uint32_t(v.parallax_steps)}},
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
        d.bindings.push_back(gpu::storage_buffer(kMaterialSlot + buffers + images + 2));
        d.bindings.push_back(gpu::storage_buffer(kMaterialSlot + buffers + images + 3));
        d.bindings.push_back(gpu::sampled_image(kMaterialSlot + buffers + images + 4));
    }
    if (v.debug) d.bindings.push_back(gpu::storage_buffer(kDebugFactsSlot));
    if (v.map) {
        d.bindings.push_back(gpu::storage_buffer(kDebugSquaresSlot));
        d.stencil = {};  // over the whole picture
    }
    if (v.tiles) d.bindings.push_back(gpu::storage_buffer(kTileSlot));
    auto made = gpu::Pipeline::create(*device_, d);
    if (!made) return made.error();
    pipeline = std::move(*made);
    return &pipeline;
}

Status ResolvePass::take_functions(const FunctionList& functions) {
    if (functions == functions_) return {};
    std::vector<const DecalFunction*> list;
    for (const auto& function : functions) list.push_back(function.get());
    const Status made = device_->shaders().make(kDirectWithFunctions, kDirect, shader_texts(list));
    if (!made.ok()) return error("{}", plain_message(made.message()));
    functions_ = functions;
    std::erase_if(pipelines_, [](const auto& made_before) { return made_before.first.functions; });
    return {};
}

void ResolvePass::take_settings() {
    std::erase_if(pipelines_, [](const auto& made) {
        return made.first.ground == Variant::Ground::direct ||
               made.first.ground == Variant::Ground::direct_texels;
    });
}

// A draw a class: the pixels of its tiles, with its taps.
Status ResolvePass::cmd_tiles(gpu::Commands& commands, const ResolveInputs& in, Variant v, int most_taps,
                              std::vector<gpu::Bound> bound, shared::ResolvePush push) {
    bound.emplace_back(kTileSlot, tiles_.list());
    push.tiles_across = tiles_.tiles().x;
    for (int c = 0; c < kTapClasses && 1 << c <= most_taps; ++c) {
        v.taps = 1 << c;
        v.probes = probes_of(v.taps);
        auto resolve = pipeline(v, in.layers, in.texture.textures());
        if (!resolve) return resolve.error();
        commands.bind(**resolve, bound);
        push.first_tile = tiles_.first_tile(c);
        commands.push(**resolve, push);
        commands.draw_indirect(tiles_.draws(), uint64_t(c) * sizeof(shared::TileDraw));
    }
    return {};
}

Status ResolvePass::cmd_record(gpu::Commands& commands, const ResolveInputs& in,
                               const FrameSettings& settings, ResolvePart part) {
    Variant v = variant(settings, part, in.has_decals, in.has_paints);
    if (part != ResolvePart::floor) v.parallax_steps = parallax_steps(in.layers, settings);
    if (v.paints && in.functions && !in.functions->empty()) {
        LOAM_TRY(take_functions(*in.functions));
        v.functions = true;
    }
    const bool floor = part == ResolvePart::floor, direct = settings.shading != Shading::virtual_texture;
    use_material(commands, in, direct);
    if (v.hardware && !anisotropic_.handle()) {
        auto made = gpu::Sampler::create(*device_, {.mip_mode = VK_SAMPLER_MIPMAP_MODE_LINEAR,
                                                    .max_anisotropy = float(kMaxTaps / v.probes)});
        if (!made) return made.error();
        anisotropic_ = std::move(*made);
    }
    if (v.tiles) {
        LOAM_TRY(tiles_.cmd_classify(*device_, commands, in.targets.gbuffer, point_, in.size,
                                     filter_rule(*settings.filter, settings.most_taps)));
        commands.use({{tiles_.draws(), Access::indirect_args}, {tiles_.list(), Access::vertex_read}});
    }

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
    if (part == ResolvePart::sky || (part == ResolvePart::all && !v.map)) {
        commands.bind(sky_, {frame_bound});
        commands.draw(3);
    }

    if (part == ResolvePart::sky) {
        commands.end_rendering();
        return {};
    }

    std::vector<gpu::Bound> bound = {
        frame_bound,
        {1, in.targets.depth.depth_view(), point_, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL},
        {2, in.targets.gbuffer.view(), point_},
        {3, in.targets.occlusion.view(), point_},
        {4, in.shadows.atlas().view(), in.shadows.sampler()},
    };
    const std::vector<gpu::Bound> material =
        floor    ? floor_material(in)
        : direct ? direct_material(in, v.smooth_layers())
                 : cached_material(in, v.hardware ? anisotropic_ : in.texture.sampler());
    bound.insert(bound.end(), material.begin(), material.end());
    if (v.debug) bound.emplace_back(kDebugFactsSlot, *in.facts.buffer, in.facts.offset, in.facts.size_bytes);
    if (v.map)
        bound.emplace_back(kDebugSquaresSlot, *in.squares.buffer, in.squares.offset, in.squares.size_bytes);
    shared::ResolvePush push{};
    push.debug_view = uint32_t(settings.debug);
    push.footprint_bias = settings.footprint_bias;
    push.deepest_m = in.layers.deepest * kParallaxDepth_m;
    if (v.tiles) {
        LOAM_TRY(cmd_tiles(commands, in, v, settings.most_taps, std::move(bound), push));
    } else {
        auto resolve = pipeline(v, in.layers, in.texture.textures());
        if (!resolve) return resolve.error();
        commands.bind(**resolve, bound);
        commands.push(**resolve, push);
        commands.draw(3);
    }
    commands.end_rendering();
    return {};
}

}  // namespace loam
