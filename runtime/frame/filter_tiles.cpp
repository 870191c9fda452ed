#include "runtime/frame/filter_tiles.h"

#include <array>

#include "shaders/frame/tiles_io.h"

namespace loam {

using gpu::Access;

namespace {
constexpr uint32_t kGroup = 32;  // local_size_x of classify_tiles.comp
}

Status FilterTiles::ensure(gpu::Device& device) {
    if (!classify_) {
        auto pipeline = gpu::Pipeline::create(
            device, gpu::ComputeDesc{
                        .name = "classify tiles",
                        .shader = "frame/classify_tiles.comp",
                        .bindings = {gpu::sampled_image(0), gpu::storage_buffer(1), gpu::storage_buffer(2)},
                        .push_bytes = sizeof(shared::ClassifyPush),
                        .constants = {}});
        if (!pipeline) return pipeline.error();
        auto draws = gpu::Buffer::create(
            device, {.name = "tile draws",
                     .size_bytes = kTapClasses * sizeof(shared::TileDraw),
                     .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT});
        if (!draws) return draws.error();
        classify_ = std::move(*pipeline);
        draws_ = std::move(*draws);
    }
    const uint64_t wanted_bytes = uint64_t(kTapClasses) * tiles_.x * tiles_.y * sizeof(uint32_t);
    if (list_ && list_.size_bytes() >= wanted_bytes) return {};
    auto list = gpu::Buffer::create(
        device,
        {.name = "tile lists", .size_bytes = wanted_bytes, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    if (!list) return list.error();
    list_ = std::move(*list);
    return {};
}

Status FilterTiles::cmd_classify(gpu::Device& device, gpu::Commands& commands, gpu::Image& gbuffer,
                                 const gpu::Sampler& point, glm::uvec2 size_px, const FilterRule& rule) {
    tiles_ = (size_px + uint32_t(kTileSide_px - 1)) / uint32_t(kTileSide_px);
    LOAM_TRY(ensure(device));
    const std::array<shared::TileDraw, kTapClasses> none = [] {
        std::array<shared::TileDraw, kTapClasses> draws{};
        for (auto& draw : draws) draw.vertex_count = 6;
        return draws;
    }();
    commands.use({{draws_, Access::copy_target}});
    vkCmdUpdateBuffer(commands.handle(), draws_.handle(), 0, sizeof none, none.data());
    const auto pass = commands.pass("classify tiles", {{gbuffer, Access::compute_sampled},
                                                       {draws_, Access::compute_storage},
                                                       {list_, Access::compute_storage}});
    commands.bind(classify_, {{0, gbuffer.view(), point}, {1, draws_}, {2, list_}});
    commands.push(
        shared::ClassifyPush{glm::ivec2(size_px), glm::ivec2(tiles_), rule.short_share, rule.log2_taps});
    commands.dispatch((tiles_.x * tiles_.y + kGroup - 1) / kGroup);
    return {};
}

}  // namespace loam
