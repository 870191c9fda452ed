// Places looked up in the virtual texture or evaluated directly, by the shaders that the resolve uses.
#pragma once

#include <cstring>
#include <vector>

#include "tests/gpu/texture_world.h"

namespace loam::test {

struct Query {
    glm::vec2 rel_m;
    float log2_texel, unused;
};
struct Answer {
    glm::vec4 albedo_gloss, normal_occlusion_metal, channels;
    float shown_mip, sector, unused[2];
};

inline std::vector<Answer> ask(World& w, const char* shader, const std::vector<Query>& queries, bool direct) {
    gpu::Device& device = gpu::test_device();
    std::vector<gpu::Binding> bindings = {gpu::storage_buffer(0), gpu::storage_buffer(1),
                                          gpu::storage_buffer(2), gpu::storage_buffer(3)};
    if (direct) bindings.push_back(gpu::storage_buffer(4));
    for (uint32_t slot = direct ? 5 : 4; slot < (direct ? 10u : 9u); ++slot)
        bindings.push_back(gpu::sampled_image(slot));
    for (uint32_t slot : {11u, 14u})
        if (direct) bindings.push_back(gpu::sampled_image(slot));
    auto pipeline = need(gpu::Pipeline::create(
        device, gpu::ComputeDesc{.name = "ask",
                                 .shader = shader,
                                 .bindings = bindings,
                                 .push_bytes = 4,
                                 .constants = {{30, w.texture->textures().layout},
                                               {31, w.texture->textures().placement},
                                               {40, w.layers->ground.tile_hiding},
                                               {41, w.layers->ground.distortion_amplitude_m > 0},
                                               {42, w.layers->has_transitions},
                                               {44, w.layers->ground.has_vista()},
                                               {45, w.layers->imagery.is_on()}}}));
    auto answers = need(gpu::Buffer::create(device, {.name = "answers",
                                                     .size_bytes = queries.size() * sizeof(Answer),
                                                     .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
    std::vector<Answer> got(queries.size());
    gpu::Frame* frame = need(w.ring->begin());
    const auto slice = w.ring->upload(queries.size() * sizeof(Query));
    std::memcpy(slice.data, queries.data(), queries.size() * sizeof(Query));
    gpu::Commands& c = frame->commands;
    VirtualTexture& t = *w.texture;
    if (direct) {
        LayerArrays& layers = w.layers->arrays(w.layers->direct_tier());
        auto pass = c.pass("ask", {{answers, gpu::Access::compute_storage},
                                   {t.direct_params(), gpu::Access::compute_sampled},
                                   {t.direct_places(), gpu::Access::compute_sampled},
                                   {w.index->page_table(), gpu::Access::compute_sampled},
                                   {w.index->indices(), gpu::Access::compute_sampled},
                                   {w.index->tints(), gpu::Access::compute_sampled},
                                   {w.index->imagery(), gpu::Access::compute_sampled},
                                   {layers.albedo_reveal, gpu::Access::compute_sampled},
                                   {layers.normal_gloss_occlusion, gpu::Access::compute_sampled},
                                   {layers.metalness, gpu::Access::compute_sampled},
                                   {w.layers->distortion_map(), gpu::Access::compute_sampled}});
        c.bind(pipeline, {{0, *slice.buffer, slice.offset, queries.size() * sizeof(Query)},
                          {1, answers},
                          {2, t.direct_params()},
                          {3, t.direct_places()},
                          {4, w.index->page_table()},
                          {5, w.index->indices().view(), t.nearest_sampler()},
                          {6, w.index->tints().view(), t.nearest_sampler()},
                          {7, layers.albedo_reveal.view(), w.layers->sampler},
                          {8, layers.normal_gloss_occlusion.view(), w.layers->sampler},
                          {9, layers.metalness.view(), w.layers->sampler},
                          {11, w.layers->distortion_map().view(), w.layers->sampler},
                          {14, w.index->imagery().view(), t.nearest_sampler()}});
        c.push(pipeline, uint32_t(queries.size()));
        c.dispatch(uint32_t(queries.size() + 63) / 64);
    } else {
        auto pass = c.pass("ask", {{answers, gpu::Access::compute_storage},
                                   {t.params(), gpu::Access::compute_sampled},
                                   {t.sector_table(), gpu::Access::compute_sampled},
                                   {t.indirection(), gpu::Access::compute_sampled},
                                   {t.atlas(0), gpu::Access::compute_sampled},
                                   {t.atlas(1), gpu::Access::compute_sampled},
                                   {t.atlas(2), gpu::Access::compute_sampled},
                                   {t.atlas(3), gpu::Access::compute_sampled}});
        c.bind(pipeline, {{0, *slice.buffer, slice.offset, queries.size() * sizeof(Query)},
                          {1, answers},
                          {2, t.params()},
                          {3, t.sector_table()},
                          {4, t.indirection().view(), t.nearest_sampler()},
                          {5, t.atlas(0).view(), t.sampler()},
                          {6, t.atlas(1).view(), t.sampler()},
                          {7, t.atlas(2).view(), t.sampler()},
                          {8, t.atlas(3).view(), t.sampler()}});
        c.push(pipeline, uint32_t(queries.size()));
        c.dispatch(uint32_t(queries.size() + 63) / 64);
    }
    w.ring->read_back(c, answers, 0, queries.size() * sizeof(Answer), [&](std::span<const std::byte> bytes) {
        std::memcpy(got.data(), bytes.data(), bytes.size());
    });
    need(w.ring->finish(*frame));
    return got;
}

}  // namespace loam::test
