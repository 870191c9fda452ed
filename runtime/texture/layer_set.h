// The layers' textures on the GPU (store/layer_file.h has the packing): whole where they fit the memory set
// aside for them; else the coarse tail of each, and whole ones by the use that pages make of them. A file
// that several layers name is there once; transitions have no textures.
#pragma once

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/store/project.h"
#include "runtime/texture/layer_arrays.h"
#include "runtime/texture/layer_stream.h"
#include "shaders/texture/compose_io.h"

namespace loam {

class Document;

// Which arrays something is composed of.
enum class LayerTier : uint8_t { whole, tail };

// What a part of a page is composed of.
struct LayerNeeds {
    std::vector<uint32_t> files;  // of layers, each once
    bool tail_suffices = true;    // its texels are so coarse that no finer level is looked at
};

class LayerSet {
  public:
    static constexpr uint64_t kBudgetBytes = uint64_t(1) << 30;
    // Loads every layer of the project (in parallel) and uploads; where they take more than the budget, their
    // tails. A project without layers gets one flat grey layer.
    static Result<std::unique_ptr<LayerSet>> create(gpu::FrameRing& ring, const Document& document,
                                                    uint64_t budget_bytes = kBudgetBytes);
    // False: other files than the ones loaded, so that a new set has to be made.
    [[nodiscard]] bool has_textures_of(const ProjectSettings& settings) const;
    // Takes everything else: the ground's settings, names, tile sizes, transitions; makes or drops what they
    // need.
    Status take_settings(gpu::FrameRing& ring, const ProjectSettings& settings);
    // The part of a LayerPlace that is the same everywhere, and its level of detail in the tier's arrays.
    void fill_place(int layer, LayerTier tier, shared::LayerPlace& place) const;
    [[nodiscard]] LayerArrays& arrays(LayerTier tier) {
        return tier == LayerTier::tail && stream_ ? tail_ : whole_;
    }
    // Of shading any place at once, which cannot say beforehand what it will look at.
    [[nodiscard]] LayerTier direct_tier() const { return stream_ ? LayerTier::tail : LayerTier::whole; }

    // Not all layers are there whole. What follows is called only then.
    [[nodiscard]] bool streams() const { return stream_ != nullptr; }
    // Of the tail's arrays, levels of the common size.
    [[nodiscard]] int first_tail_level() const { return tail_.desc().first_level; }
    // Adds a layer with textures of its own, looked up at a level.
    void add_need(uint32_t layer, double level, LayerNeeds& needs) const;
    // To be composed of.
    [[nodiscard]] LayerTier tier_of(const LayerNeeds& needs) const;
    // It will not get any better by waiting.
    [[nodiscard]] bool ready(const LayerNeeds& needs) const {
        return needs.tail_suffices || stream_->slots.ready(needs.files);
    }
    [[nodiscard]] LayerSlots& slots() { return stream_->slots; }
    // See LayerStream; without streaming nothing.
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, bool wait);
    // Rectangles of pages are aligned to so many texels: blocks of both mips, or what a second mip composed
    // for itself needs.
    [[nodiscard]] int rect_texels() const { return changes_afar() ? 16 : 8; }
    // Something weighs by the distance that a page's texels are meant for.
    [[nodiscard]] bool changes_afar() const { return ground.has_vista() || imagery.is_on(); }
    [[nodiscard]] bool is_transition(uint32_t layer) const { return blends_[layer].first != layer; }
    // The layers whose textures it shows: of a transition two, else twice itself.
    [[nodiscard]] std::array<uint32_t, 2> sides_of(uint32_t layer) const {
        return {blends_[layer].first, blends_[layer].second};
    }

    [[nodiscard]] uint64_t gpu_bytes() const { return whole_.bytes() + tail_.bytes() + distortion.bytes(); }
    struct Statistics {
        int files = 0, slots = 0;  // slots for whole ones; as many where all fit
        uint64_t loads = 0;        // since then, while streaming
    };
    [[nodiscard]] Statistics statistics() const;

    gpu::Sampler sampler;         // repeat, linear, nearest mip
    gpu::Sampler smooth_sampler;  // blends mips, for direct shading at rest
    gpu::Image distortion;        // R16G16_SFLOAT (distortion.h); none without distortion
    GroundSettings ground;
    ImagerySettings imagery;
    std::vector<LayerEntry> entries;  // the list that was taken last
    // What a shader binds as its distortion map: any texture where there is none.
    [[nodiscard]] gpu::Image& distortion_map() { return distortion ? distortion : whole_.albedo_reveal; }
    int count = 0;
    int size_texels = 0;  // of mip 0, all layers
    std::vector<double>
        tiles_m;  // world size of the whole texture a layer (a repeated small layer's is larger)
    bool has_metal = false;
    bool has_transitions = false;
    float deepest = 0;  // greatest amount of depth of a layer, on a map that has the channel; 0: no parallax
    static constexpr int kThumbnailLog2 = 6, kThumbnail = 1 << kThumbnailLog2;
    std::vector<std::vector<uint8_t>>
        thumbnails;  // kThumbnail² RGBA8 sRGB a layer, row 0 north, for the palette
    std::vector<std::string> names;

  private:
    struct Source {
        uint32_t file = 0, first = 0, second = 0;
        float threshold = 0;
    };
    struct File {
        std::string name;                // empty: the flat grey of a project without layers
        double repeats = 1;              // of the layer's own texture along a side of the common size
        std::vector<uint8_t> thumbnail;  // with the reveal map as alpha
    };
    Status load(gpu::FrameRing& ring, const Document& document, uint64_t budget_bytes);
    Status fill(gpu::FrameRing& ring, LayerArrays& arrays, const std::vector<LayerTextures>& layers);
    void make_thumbnails();
    std::vector<File> files_;
    std::vector<Source> blends_;  // a layer
    uint32_t placement_ = 0;      // of the map's optional channels in pages
    LayerArrays whole_, tail_;
    std::unique_ptr<LayerStream> stream_;
};

}  // namespace loam
