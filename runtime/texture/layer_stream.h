// Reads layers' textures into slots while pictures are made (layer_slots.h says which). Source: Call of Duty
// talk, "Streamer Connection"; here what pages need says what is loaded, not the camera's distance.
#pragma once

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/base/job_queue.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/texture/layer_arrays.h"
#include "runtime/texture/layer_slots.h"

namespace loam {

class LayerStream {
  public:
    // `arrays` outlives the stream. Files are relative to the folder.
    LayerStream(LayerArrays& arrays, std::filesystem::path folder, std::vector<std::string> files);

    LayerSlots slots;
    // Before pages are composed: takes up what has come, and begins to load what is wanted. `wait`: not
    // before what is on its way has come.
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, bool wait);
    [[nodiscard]] uint64_t load_count() const { return load_count_; }

  private:
    struct Load {
        uint32_t layer = 0;
        gpu::Buffer staging;
        std::string failure;
    };
    Status begin_load(gpu::Device& device, uint32_t layer);
    LayerArrays& arrays_;
    std::filesystem::path folder_;
    std::vector<std::string> files_;
    std::vector<std::shared_ptr<Load>> came_;  // in no slot yet
    size_t under_way_ = 0;
    uint64_t load_count_ = 0;
    std::mutex mutex_;
    std::vector<std::shared_ptr<Load>> finished_;  // by the worker
    JobQueue workers_{2};                          // last: they end before what it writes to
};

}  // namespace loam
