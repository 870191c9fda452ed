// The passes that draw decals over composed texels: splines, terrain decals with the marks of craters and
// footprints, volumes, each recorded only when there is one. A project without splines never has
// their pipelines, and so on. Source: Call of Duty talk, "Composition". What differs: volumes are drawn
// by a fragment shader too, as fragment work is no slower than compute and blends in hardware.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/pipeline.h"
#include "runtime/gpu/resources.h"
#include "runtime/texture/decals.h"
#include "runtime/texture/layer_set.h"
#include "runtime/texture/page_format.h"

namespace loam {

class DecalPasses {
  public:
    DecalPasses(gpu::Device& device, const PageTextures& textures) : device_(&device), textures_(textures) {}
    // Makes the pipelines of craters and footprints, which come while playing, and those that the document's
    // operators need, so that no frame waits for them.
    Status warm_up(const Document& document, const LayerSet& layers);
    // used: of the scratch image; nothing is drawn outside.
    Status cmd_record(gpu::FrameRing& ring, gpu::Commands& commands, const Document& document,
                      const DecalList& list, LayerSet& layers, gpu::Image& scratch, VkExtent2D used);

  private:
    // Targets have one weight each: channels of different shares are drawn part by part (paint.frag).
    static constexpr size_t kParts = 4, kKinds = 5;
    using Pipelines = std::array<std::array<gpu::Pipeline, kParts>, kKinds>;
    // Of one function. Its shader is made again when its text is another.
    struct Function {
        uint64_t revision = 0;
        bool fails = false;
        Pipelines pipelines;
    };
    struct Uploads;
    [[nodiscard]] gpu::GraphicsDesc paint_desc(DecalKind kind, size_t part, const LayerSet& layers) const;
    Result<const gpu::Pipeline*> pipeline(DecalKind kind, size_t part, const LayerSet& layers);
    // Null: this version of the function cannot be drawn, which has been reported.
    const gpu::Pipeline* function_pipeline(const Document& document, const DecalFunction& function,
                                           DecalKind kind, size_t part, const LayerSet& layers);
    Status cmd_begin_counts(gpu::Commands& commands, const DecalList& list);
    void read_counts(gpu::FrameRing& ring, gpu::Commands& commands, const Document& document,
                     const DecalList& list);

    gpu::Device* device_;
    PageTextures textures_;
    Pipelines pipelines_;
    std::map<std::string, Function> functions_;
    gpu::Buffer counts_;  // of texels where functions gave no number, one a draw that shows one
};

}  // namespace loam
