// The layers' textures on the GPU: three 2D arrays with mips (see store/layer_file.h for the packing). A file
// that several layers name is there once; transitions have no textures.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/resources.h"
#include "runtime/store/project.h"
#include "shaders/texture/compose_io.h"

namespace loam {

class Document;

class LayerSet {
  public:
    // Loads every layer of the project (in parallel) and uploads. A project without layers gets one flat grey
    // layer.
    static Result<std::unique_ptr<LayerSet>> create(gpu::FrameRing& ring, const Document& document);
    // False: other files than the ones loaded, so that a new set has to be made.
    [[nodiscard]] bool has_textures_of(const ProjectSettings& settings) const;
    // Takes everything else: the ground's settings, names, tile sizes, transitions; makes or drops what they
    // need.
    Status take_settings(gpu::FrameRing& ring, const ProjectSettings& settings);
    // The part of a LayerPlace that is the same everywhere.
    void fill_place(int layer, shared::LayerPlace& place) const;
    // Rectangles of pages are aligned to so many texels: blocks of both mips, or what a second mip composed
    // for itself needs.
    [[nodiscard]] int rect_texels() const { return changes_afar() ? 16 : 8; }
    // Something weighs by the distance that a page's texels are meant for.
    [[nodiscard]] bool changes_afar() const { return ground.has_vista() || imagery.is_on(); }
    [[nodiscard]] bool is_transition(uint32_t layer) const { return blends_[layer].first != layer; }

    gpu::Image albedo_reveal;           // RGBA8_SRGB view where possible, else UNORM: sampled in linear light
    gpu::Image normal_gloss_occlusion;  // RGBA8_UNORM
    gpu::Image metalness;               // R8_UNORM; 1x1 where no layer has metal
    gpu::Sampler sampler;               // repeat, linear, nearest mip
    gpu::Sampler smooth_sampler;        // blends mips, for direct shading at rest
    gpu::Image distortion;              // R16G16_SFLOAT (distortion.h); none without distortion
    GroundSettings ground;
    ImagerySettings imagery;
    std::vector<LayerEntry> entries;  // the list that was taken last
    // What a shader binds as its distortion map: any texture where there is none.
    [[nodiscard]] gpu::Image& distortion_map() { return distortion ? distortion : albedo_reveal; }
    int count = 0;
    int size_texels = 0;  // of mip 0, all layers
    std::vector<double>
        tiles_m;  // world size of the whole texture a layer (a repeated small layer's is larger)
    bool has_metal = false;
    bool has_transitions = false;
    std::vector<std::vector<uint8_t>> thumbnails;  // 64x64 RGBA8 sRGB a layer, row 0 north, for the palette
    std::vector<std::string> names;

  private:
    struct Source {
        uint32_t slot = 0, first = 0, second = 0;
        float threshold = 0;
    };
    struct Slot {
        std::string file;                // empty: the flat grey of a project without layers
        double repeats = 1;              // of the layer's own texture along a side of the slot
        std::vector<uint8_t> thumbnail;  // with the reveal map as alpha
    };
    void make_thumbnails();
    std::vector<Slot> slots_;
    std::vector<Source> blends_;  // a layer
};

}  // namespace loam
