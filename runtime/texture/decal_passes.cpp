#include "runtime/texture/decal_passes.h"

#include <cstring>
#include <span>

#include "runtime/document/document.h"
#include "runtime/document/function_library.h"
#include "runtime/gpu/shader_library.h"
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
constexpr const char* kKindNames[] = {"crater decal", "footprint decal", "terrain decal", "splined decal",
                                      "volume decal"};
constexpr const char* kPassNames[] = {"texture splines", "texture decals", "texture volumes"};

bool is_paint(DecalKind kind) {
    return kind != DecalKind::crater && kind != DecalKind::footprint;
}

uint32_t paint_kind(DecalKind kind) {
    return kind == DecalKind::spline   ? kPaintSpline
           : kind == DecalKind::volume ? kPaintVolume
                                       : kPaintTerrain;
}

// A count's place: what a storage buffer's offset is a multiple of on every device.
constexpr uint64_t kCountStride = 256;

// The functions of the draws that show one, in order; draws of a pass may not write into one place.
std::vector<std::string> counted_draws(const DecalList& list, size_t parts) {
    std::vector<std::string> names;
    for (const auto& runs : list.runs)
        for (const DecalRun& run : runs)
            if (run.function > 0)
                names.insert(names.end(), run.even ? 1 : parts - 1, list.functions[run.function - 1]->name);
    return names;
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

gpu::GraphicsDesc DecalPasses::paint_desc(DecalKind kind, size_t part, const LayerSet& layers) const {
    const size_t targets = size_t(textures_.scratch_layers);
    gpu::GraphicsDesc desc{
        .name = kKindNames[size_t(kind)],
        .vertex_shader = "texture/paint.vert",
        .fragment_shader = "texture/paint.frag",
        .bindings = {gpu::storage_buffer(0), gpu::storage_buffer(1), gpu::storage_buffer(2),
                     gpu::sampled_image(3), gpu::sampled_image(4), gpu::sampled_image(5)},
        .constants = {{0, paint_kind(kind)}, {1, uint32_t(part)}, {2, layers.has_metal ? 1u : 0u}},
        .color_formats = std::vector(targets, VK_FORMAT_R8G8B8A8_UNORM),
        .blends = std::vector(targets, gpu::Blend::alpha),
        .write_masks = {kPartMasks[part], kPartMasks[part] + 3},
        .stencil = {}};
    desc.write_masks.resize(targets, 0);
    return desc;
}

Result<const gpu::Pipeline*> DecalPasses::pipeline(DecalKind kind, size_t part, const LayerSet& layers) {
    gpu::Pipeline& pipeline = pipelines_[size_t(kind)][part];
    if (pipeline) return &pipeline;
    gpu::GraphicsDesc desc = paint_desc(kind, part, layers);
    if (!is_paint(kind)) {
        desc.vertex_shader = "texture/decal.vert";
        desc.fragment_shader =
            kind == DecalKind::crater ? "texture/decal_crater.frag" : "texture/decal_footprint.frag";
        desc.bindings = {gpu::storage_buffer(0)};
        desc.constants = {{31, textures_.placement}};
    }
    if (kind == DecalKind::crater) desc.write_masks.assign(desc.write_masks.size(), kRgb);
    auto made = gpu::Pipeline::create(*device_, desc);
    if (!made.ok()) return made.error();
    pipeline = std::move(*made);
    return &pipeline;
}

const gpu::Pipeline* DecalPasses::function_pipeline(const Document& document, const DecalFunction& function,
                                                    DecalKind kind, size_t part, const LayerSet& layers) {
    Function& made = functions_[function.name];
    const std::string shader = "texture/paint.frag:" + function.name;
    const auto fail = [&](const std::string& message) {
        made.fails = true;
        document.functions().report(function.name, message);
    };
    if (made.revision != function.revision) {
        made.revision = function.revision;
        made.fails = false;
        const DecalFunction* only = &function;
        const Status compiled =
            device_->shaders().make(shader, "texture/paint.frag", shader_texts({&only, 1}));
        if (!compiled.ok()) fail(plain_message(compiled.message()));
        made.pipelines = {};
    }
    if (made.fails) return nullptr;
    gpu::Pipeline& pipeline = made.pipelines[size_t(kind)][part];
    if (pipeline) return &pipeline;
    gpu::GraphicsDesc desc = paint_desc(kind, part, layers);
    desc.fragment_shader = shader;
    desc.bindings.push_back(gpu::storage_buffer(6));
    auto created = gpu::Pipeline::create(*device_, desc);
    if (!created.ok()) {
        fail(created.message());
        return nullptr;
    }
    pipeline = std::move(*created);
    return &pipeline;
}

Status DecalPasses::warm_up(const Document& document, const LayerSet& layers) {
    for (const DecalKind kind : {DecalKind::crater, DecalKind::footprint})
        if (auto made = pipeline(kind, 0, layers); !made.ok()) return made.error();
    for (const OperatorShape& shape : document.drawn_kinds()) {
        const DecalKind kind = std::holds_alternative<Crater>(shape)         ? DecalKind::crater
                               : std::holds_alternative<Footprint>(shape)    ? DecalKind::footprint
                               : std::holds_alternative<TerrainDecal>(shape) ? DecalKind::terrain
                               : std::holds_alternative<SplineDecal>(shape)  ? DecalKind::spline
                                                                             : DecalKind::volume;
        const DecalMaterial* material = material_of(shape);
        if (!material || material->function.empty()) {
            if (auto made = pipeline(kind, 0, layers); !made.ok()) return made.error();
        } else if (const auto function = document.functions().shown(material->function)) {
            (void)function_pipeline(document, *function, kind, 0, layers);
        }
    }
    return {};
}

Status DecalPasses::cmd_begin_counts(gpu::Commands& commands, const DecalList& list) {
    const uint64_t bytes = counted_draws(list, kParts).size() * kCountStride;
    if (bytes == 0) return {};
    if (counts_.size_bytes() < bytes) {
        auto made = gpu::Buffer::create(*device_, {.name = "decal function counts",
                                                   .size_bytes = std::max<uint64_t>(bytes, 16 * kCountStride),
                                                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
        if (!made.ok()) return made.error();
        counts_ = std::move(*made);
    }
    commands.use({{counts_, Access::copy_target}});
    vkCmdFillBuffer(commands.handle(), counts_.handle(), 0, VK_WHOLE_SIZE, 0);
    commands.use({{counts_, Access::fragment_storage}});
    return {};
}

void DecalPasses::read_counts(gpu::FrameRing& ring, gpu::Commands& commands, const Document& document,
                              const DecalList& list) {
    std::vector<std::string> names = counted_draws(list, kParts);
    if (names.empty()) return;
    const uint64_t bytes_read = names.size() * kCountStride;
    ring.read_back(
        commands, counts_, 0, bytes_read,
        [names = std::move(names), &functions = document.functions()](std::span<const std::byte> bytes) {
            for (size_t i = 0; i < names.size(); ++i) {
                uint32_t texels = 0;
                std::memcpy(&texels, bytes.data() + i * kCountStride, sizeof texels);
                if (texels > 0) functions.count_failed(names[i], texels);
            }
        });
}

Status DecalPasses::cmd_record(gpu::FrameRing& ring, gpu::Commands& commands, const Document& document,
                               const DecalList& list, LayerSet& layers, gpu::Image& scratch,
                               VkExtent2D used) {
    if (list.marks.empty() && list.paints.empty()) return {};
    const Uploads up{upload(ring, list.marks), upload(ring, list.paints), upload(ring, list.segments),
                     upload(ring, list.heights_m)};
    std::vector<gpu::ColorTarget> targets;
    for (uint32_t layer = 0; layer < scratch.layer_count(); ++layer)
        targets.push_back({scratch.layer_view(0, layer)});
    const auto bound = [](uint32_t slot, const gpu::UploadSlice& slice) {
        return gpu::Bound(slot, *slice.buffer, slice.offset, slice.size_bytes);
    };
    LOAM_TRY(cmd_begin_counts(commands, list));
    uint64_t counted = 0;
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
        for (const DecalRun& run : list.runs[which]) {
            const LayerArrays& arrays = layers.arrays(run.tier);
            std::vector<gpu::Bound> all = {bound(0, up.marks)};
            if (is_paint(run.kind))
                all = {bound(0, up.paints),
                       bound(1, up.segments),
                       bound(2, up.heights),
                       {3, arrays.albedo_reveal.view(), layers.sampler},
                       {4, arrays.normal_gloss_occlusion.view(), layers.sampler},
                       {5, arrays.metalness.view(), layers.sampler}};
            const size_t without_count = all.size();
            for (size_t part = run.even ? 0 : 1; part < (run.even ? 1 : kParts); ++part) {
                const gpu::Pipeline* drawn = nullptr;
                if (run.function > 0) {
                    all.erase(all.begin() + std::ptrdiff_t(without_count), all.end());
                    all.emplace_back(6, counts_, kCountStride * counted++, sizeof(uint32_t));
                    drawn = function_pipeline(document, *list.functions[run.function - 1], run.kind, part,
                                              layers);
                    if (!drawn) continue;
                } else {
                    auto made = pipeline(run.kind, part, layers);
                    if (!made.ok()) return made.error();
                    drawn = *made;
                }
                commands.bind(*drawn, all);
                commands.draw(6, run.count, 0, run.first);
            }
        }
        commands.end_rendering();
    }
    read_counts(ring, commands, document, list);
    return {};
}

}  // namespace loam
