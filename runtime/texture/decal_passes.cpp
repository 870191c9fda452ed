#include "runtime/texture/decal_passes.h"

#include <cstring>
#include <span>

#include "runtime/document/document.h"
#include "runtime/texture/paint_decals.h"
#include "shaders/texture/compose_io.h"

namespace loam {

namespace {

using gpu::Access;

constexpr VkColorComponentFlags kR = VK_COLOR_COMPONENT_R_BIT, kG = VK_COLOR_COMPONENT_G_BIT,
                                kB = VK_COLOR_COMPONENT_B_BIT, kRgb = kR | kG | kB;
// Channels of the three textures that a part writes; the optional ones, in the third's blue and in a fourth, stay
// as they are.
constexpr VkColorComponentFlags kPartMasks[][3] = {
    {kRgb, kRgb, kR | kG}, {kRgb, kR, kR}, {0, kG, kG}, {0, kB, 0}};
constexpr const char* kPassNames[] = {"texture splines", "texture decals", "texture volumes"};

bool is_paint(DecalKind kind) {
    return kind != DecalKind::crater && kind != DecalKind::footprint;
}

uint32_t paint_kind(DecalKind kind) {
    return kind == DecalKind::spline   ? kPaintSpline
           : kind == DecalKind::volume ? kPaintVolume
                                       : kPaintTerrain;
}

// Storage bindings may not be empty: a list of none is one element that nobody reads.
template <typename T>
gpu::UploadSlice upload(gpu::FrameRing& ring, const std::vector<T>& list) {
    const uint64_t bytes = std::max<size_t>(list.size(), 1) * sizeof(T);
    gpu::UploadSlice slice = ring.upload(bytes);
    if (!list.empty()) std::memcpy(slice.data, list.data(), list.size() * sizeof(T));
    slice.size_bytes = bytes;
    return slice;
}

}  // namespace

struct DecalPasses::Uploads {
    gpu::UploadSlice marks, paints, segments, heights;
};

Result<const gpu::Pipeline*> DecalPasses::pipeline(DecalKind kind, size_t part, const LayerSet& layers) {
    gpu::Pipeline& pipeline = pipelines_[size_t(kind)][part];
    if (pipeline) return &pipeline;
    static constexpr const char* kNames[kKinds] = {"crater decal", "footprint decal", "terrain decal",
                                                   "splined decal", "volume decal"};
    const size_t targets = size_t(textures_.scratch_layers);
    gpu::GraphicsDesc desc{.name = kNames[size_t(kind)],
                           .vertex_shader = "texture/decal.vert",
                           .fragment_shader = kind == DecalKind::crater ? "texture/decal_crater.frag"
                                                                        : "texture/decal_footprint.frag",
                           .bindings = {gpu::storage_buffer(0)},
                           .constants = {{31, textures_.placement}},
                           .color_formats = std::vector(targets, VK_FORMAT_R8G8B8A8_UNORM),
                           .blends = std::vector(targets, gpu::Blend::alpha),
                           .write_masks = {kPartMasks[part], kPartMasks[part] + 3},
                           .stencil = {}};
    desc.write_masks.resize(targets, 0);
    if (kind == DecalKind::crater) desc.write_masks.assign(targets, kRgb);
    if (is_paint(kind)) {
        desc.vertex_shader = "texture/paint.vert";
        desc.fragment_shader = "texture/paint.frag";
        desc.bindings = {gpu::storage_buffer(0), gpu::storage_buffer(1), gpu::storage_buffer(2),
                         gpu::sampled_image(3),  gpu::sampled_image(4),  gpu::sampled_image(5)};
        desc.constants = {{0, paint_kind(kind)}, {1, uint32_t(part)}, {2, layers.has_metal ? 1u : 0u}};
    }
    auto made = gpu::Pipeline::create(*device_, desc);
    if (!made.ok()) return made.error();
    pipeline = std::move(*made);
    return &pipeline;
}

Status DecalPasses::warm_up(const Document& document, const LayerSet& layers) {
    for (const DecalKind kind : {DecalKind::crater, DecalKind::footprint})
        if (auto made = pipeline(kind, 0, layers); !made.ok()) return made.error();
    const auto lock = document.read_lock();
    std::vector<const Operator*> operators;
    constexpr double kEverywhere_m = 1.0e7;
    document.operators_over_texture({-kEverywhere_m, -kEverywhere_m, kEverywhere_m, kEverywhere_m},
                                    operators);
    for (const Operator* op : operators) {
        const DecalKind kind = std::holds_alternative<Crater>(op->shape)         ? DecalKind::crater
                               : std::holds_alternative<Footprint>(op->shape)    ? DecalKind::footprint
                               : std::holds_alternative<TerrainDecal>(op->shape) ? DecalKind::terrain
                               : std::holds_alternative<SplineDecal>(op->shape)  ? DecalKind::spline
                                                                                 : DecalKind::volume;
        if (auto made = pipeline(kind, 0, layers); !made.ok()) return made.error();
    }
    return {};
}

Status DecalPasses::cmd_record(gpu::FrameRing& ring, gpu::Commands& commands, const DecalList& list,
                               LayerSet& layers, gpu::Image& scratch, VkExtent2D used) {
    if (list.marks.empty() && list.paints.empty()) return {};
    const Uploads up{upload(ring, list.marks), upload(ring, list.paints), upload(ring, list.segments),
                     upload(ring, list.heights_m)};
    std::vector<gpu::ColorTarget> targets;
    for (uint32_t layer = 0; layer < scratch.layer_count(); ++layer)
        targets.push_back({scratch.layer_view(0, layer)});
    const auto bound = [](uint32_t slot, const gpu::UploadSlice& slice) {
        return gpu::Bound(slot, *slice.buffer, slice.offset, slice.size_bytes);
    };
    for (size_t which = 0; which < kDecalPasses; ++which) {
        if (list.runs[which].empty()) continue;
        if (!list.paints.empty())
            for (const LayerTier tier : {LayerTier::whole, LayerTier::tail}) {
                LayerArrays& arrays = layers.arrays(tier);
                commands.use({{arrays.albedo_reveal, Access::fragment_sampled},
                              {arrays.normal_gloss_occlusion, Access::fragment_sampled},
                              {arrays.metalness, Access::fragment_sampled}});
            }
        auto pass = commands.pass(kPassNames[which], {{scratch, Access::color_target}});
        commands.begin_rendering(used, targets);
        commands.set_viewport(0, 0, kScratchWidth, kScratchHeight);
        commands.set_scissor(0, 0, used.width, used.height);
        for (const DecalRun& run : list.runs[which])
            for (size_t part = run.even ? 0 : 1; part < (run.even ? 1 : kParts); ++part) {
                auto made = pipeline(run.kind, part, layers);
                if (!made.ok()) return made.error();
                const LayerArrays& arrays = layers.arrays(run.tier);
                if (is_paint(run.kind))
                    commands.bind(**made, {bound(0, up.paints),
                                           bound(1, up.segments),
                                           bound(2, up.heights),
                                           {3, arrays.albedo_reveal.view(), layers.sampler},
                                           {4, arrays.normal_gloss_occlusion.view(), layers.sampler},
                                           {5, arrays.metalness.view(), layers.sampler}});
                else
                    commands.bind(**made, {bound(0, up.marks)});
                commands.draw(6, run.count, 0, run.first);
            }
        commands.end_rendering();
    }
    return {};
}

}  // namespace loam
