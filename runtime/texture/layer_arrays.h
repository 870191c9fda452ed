// Layers' textures as 2D arrays: a slot a layer, levels of the size that all layers have in common
// (layer_set.h).
#pragma once

#include <cstdint>

#include "runtime/base/result.h"
#include "runtime/gpu/commands.h"
#include "runtime/gpu/resources.h"
#include "runtime/store/layer_file.h"

namespace loam {

struct LayerArraysDesc {
    int size_texels = 1;  // of level 0 of the common size
    int first_level = 0;  // mip 0 of the arrays
    int slot_count = 1;
    bool has_metal = false;
};

class LayerArrays {
  public:
    static Result<LayerArrays> create(gpu::Device& device, const LayerArraysDesc& desc);

    gpu::Image albedo_reveal;           // RGBA8_SRGB, so that it is filtered in linear light
    gpu::Image normal_gloss_occlusion;  // RGBA8_UNORM
    gpu::Image metalness;               // R8_UNORM; 1x1 where no layer has metal

    [[nodiscard]] const LayerArraysDesc& desc() const { return desc_; }
    [[nodiscard]] uint64_t bytes() const {
        return albedo_reveal.bytes() + normal_gloss_occlusion.bytes() + metalness.bytes();
    }
    // One slot's texels, as cmd_fill copies them.
    [[nodiscard]] uint64_t slot_bytes() const { return slot_bytes(desc_); }
    [[nodiscard]] static uint64_t slot_bytes(const LayerArraysDesc& desc);
    // Of the layer's mips those that lie in the arrays' levels must be loaded.
    void write_slot(const LayerTextures& layer, uint8_t* out) const;
    // The images are in use as copy targets.
    void cmd_fill(gpu::Commands& commands, const gpu::Buffer& from, uint64_t offset, uint32_t slot) const;

  private:
    LayerArraysDesc desc_;
};

}  // namespace loam
