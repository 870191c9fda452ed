// The layers' textures on the GPU: three 2D arrays with mips (see store/layer_file.h for the packing).
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/resources.h"
#include "runtime/store/project.h"

namespace loam {

class Document;

class LayerSet {
  public:
    // Loads every layer of the project (in parallel) and uploads. A project without layers gets one flat grey
    // layer.
    static Result<std::unique_ptr<LayerSet>> create(gpu::FrameRing& ring, const Document& document);
    // Takes the settings of the ground from the document again; makes or drops what they need.
    Status take_ground(gpu::FrameRing& ring, const GroundSettings& settings);

    gpu::Image albedo_reveal;           // RGBA8_SRGB view where possible, else UNORM: sampled in linear light
    gpu::Image normal_gloss_occlusion;  // RGBA8_UNORM
    gpu::Image metalness;               // R8_UNORM; 1x1 where no layer has metal
    gpu::Buffer parameters;  // LayerParams a layer (shaders/texture/compose_io.h): tile size and so on
    gpu::Sampler sampler;    // repeat, linear, nearest mip
    gpu::Image distortion;  // R16G16_SFLOAT (distortion.h); none without distortion
    GroundSettings ground;
    // What a shader binds as its distortion map: any texture where there is none.
    [[nodiscard]] gpu::Image& distortion_map() { return distortion ? distortion : albedo_reveal; }
    int count = 0;
    int size_texels = 0;  // of mip 0, all layers
    std::vector<double>
        tiles_m;  // world size of the whole texture a layer (a repeated small layer's is larger)
    bool has_metal = false;
    std::vector<std::vector<uint8_t>> thumbnails;  // 64x64 RGBA8 sRGB a layer, row 0 north, for the palette
    std::vector<std::string> names;
};

}  // namespace loam
