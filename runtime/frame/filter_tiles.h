// Tiles of 8x8 pixels by how many taps their footprints need: a list and an indirect draw a class, made on
// the GPU from the g-buffer, so that only pixels along steep views pay for anisotropy. Source: Far Cry 5,
// "Terrain Classification Pass". Nothing is allocated before the first use.
#pragma once

#include <glm/vec2.hpp>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/texture/filter.h"

namespace loam {

class FilterTiles {
  public:
    // Reads the g-buffer; the lists are of a picture of `size_px`.
    Status cmd_classify(gpu::Device& device, gpu::Commands& commands, gpu::Image& gbuffer,
                        const gpu::Sampler& point, glm::uvec2 size_px, const FilterRule& rule);

    [[nodiscard]] gpu::Buffer& draws() { return draws_; }  // TileDraw a class
    [[nodiscard]] gpu::Buffer& list() { return list_; }
    [[nodiscard]] glm::uvec2 tiles() const { return tiles_; }
    [[nodiscard]] uint32_t first_tile(int tap_class) const {
        return uint32_t(tap_class) * tiles_.x * tiles_.y;
    }
    [[nodiscard]] uint64_t bytes() const { return draws_.size_bytes() + list_.size_bytes(); }

  private:
    Status ensure(gpu::Device& device);
    gpu::Pipeline classify_;
    gpu::Buffer draws_, list_;
    glm::uvec2 tiles_{0};
};

}  // namespace loam
