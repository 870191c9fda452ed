#include "runtime/texture/layer_slots.h"

#include <algorithm>
#include <utility>

namespace loam {

LayerSlots::LayerSlots(int layer_count, int slot_count)
    : layers_(size_t(layer_count)), slots_(size_t(slot_count), kFree) {}

bool LayerSlots::all_resident(std::span<const uint32_t> layers) const {
    return std::all_of(layers.begin(), layers.end(), [&](uint32_t i) { return layers_[i].slot >= 0; });
}

bool LayerSlots::ready(std::span<const uint32_t> layers) const {
    return layers.size() > slots_.size() || all_resident(layers) ||
           std::any_of(layers.begin(), layers.end(), [&](uint32_t i) { return layers_[i].failed; });
}

void LayerSlots::want(std::span<const uint32_t> layers, float priority) {
    wishes_.push_back({priority, {layers.begin(), layers.end()}});
}

std::vector<uint32_t> LayerSlots::take_wishes() {
    std::stable_sort(wishes_.begin(), wishes_.end(),
                     [](const Wish& a, const Wish& b) { return a.priority > b.priority; });
    for (Layer& layer : layers_) layer.wanted = false;
    ++clock_;
    size_t wanted = 0;
    std::vector<uint32_t> load;
    for (const Wish& wish : wishes_) {
        const auto more = size_t(std::count_if(wish.layers.begin(), wish.layers.end(),
                                               [&](uint32_t i) { return !layers_[i].wanted; }));
        // Half of a page's layers are of no use to it, and in the way of other pages.
        if (wanted + more > slots_.size()) continue;
        wanted += more;
        for (const uint32_t i : wish.layers) {
            Layer& layer = layers_[i];
            if (!layer.wanted && layer.slot < 0 && !layer.loading && !layer.failed) load.push_back(i);
            layer.wanted = true;
            layer.used = clock_;
        }
    }
    wishes_.clear();
    return load;
}

int LayerSlots::place(uint32_t layer) {
    // Of keeping what is in a slot. What is wanted, or came in this round, stays: its copy is under way.
    const auto value = [&](uint32_t there) {
        if (there == kFree) return std::pair(0, uint64_t(0));
        return std::pair(layers_[there].used == clock_ ? 2 : 1, layers_[there].used);
    };
    const auto slot = std::min_element(slots_.begin(), slots_.end(),
                                       [&](uint32_t a, uint32_t b) { return value(a) < value(b); });
    if (slot == slots_.end() || value(*slot).first == 2) return -1;
    if (*slot != kFree) layers_[*slot].slot = -1;
    *slot = layer;
    layers_[layer].slot = int(slot - slots_.begin());
    layers_[layer].loading = false;
    layers_[layer].used = clock_;
    return layers_[layer].slot;
}

}  // namespace loam
