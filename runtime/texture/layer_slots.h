// Which layers' textures are in which slots, where there are fewer slots than layers: decisions only. Slots
// are given to what pages need for their composition, the most wanted page first and each page's layers
// together, and taken from what no page has wanted for longest.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace loam {

class LayerSlots {
  public:
    LayerSlots(int layer_count, int slot_count);

    [[nodiscard]] int slot_of(uint32_t layer) const { return layers_[layer].slot; }  // -1: none
    [[nodiscard]] int slot_count() const { return int(slots_.size()); }
    [[nodiscard]] bool all_resident(std::span<const uint32_t> layers) const;
    // As good as it will be: all there, or some that never come, or more than there are slots.
    [[nodiscard]] bool ready(std::span<const uint32_t> layers) const;

    // A page waits for these layers, each named once.
    void want(std::span<const uint32_t> layers, float priority);
    // Takes the wishes so far as what counts until the next call, and returns the layers to load for them,
    // most wanted first: neither there, nor on their way, nor failed.
    [[nodiscard]] std::vector<uint32_t> take_wishes();
    void begin_load(uint32_t layer) { layers_[layer].loading = true; }
    // A layer that came: its slot, or -1 as long as all are wanted for others. None is given twice in a round.
    [[nodiscard]] int place(uint32_t layer);
    void fail(uint32_t layer) { layers_[layer] = {.failed = true}; }

  private:
    struct Layer {
        int slot = -1;
        bool loading = false, failed = false, wanted = false;
        uint64_t used = 0;  // the last round that wanted it or gave it its slot
    };
    struct Wish {
        float priority;
        std::vector<uint32_t> layers;
    };
    static constexpr uint32_t kFree = ~0u;
    std::vector<Layer> layers_;
    std::vector<uint32_t> slots_;  // the layer in each
    std::vector<Wish> wishes_;
    uint64_t clock_ = 0;
};

}  // namespace loam
