#include "runtime/texture/layer_stream.h"

#include "runtime/base/log.h"

namespace loam {

namespace {
constexpr size_t kMostLoads = 4;  // under way, each with its own staging
}

LayerStream::LayerStream(LayerArrays& arrays, std::filesystem::path folder, std::vector<std::string> files)
    : slots(int(files.size()), arrays.desc().slot_count),
      arrays_(arrays),
      folder_(std::move(folder)),
      files_(std::move(files)) {}

Status LayerStream::begin_load(gpu::Device& device, uint32_t layer) {
    auto staging = gpu::Buffer::create(device, {.name = "layer staging",
                                                .size_bytes = arrays_.slot_bytes(),
                                                .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                                .memory = gpu::MemoryUse::upload});
    if (!staging.ok()) return staging.error();
    auto load = std::make_shared<Load>(Load{layer, std::move(*staging), {}});
    slots.begin_load(layer);
    ++under_way_;
    workers_.push([this, load, file = folder_ / files_[layer]] {
        const auto textures = load_layer(file);
        if (textures.ok())
            arrays_.write_slot(*textures, load->staging.as<uint8_t>());
        else
            load->failure = textures.message();
        const std::lock_guard lock(mutex_);
        finished_.push_back(load);
    });
    return {};
}

Status LayerStream::update(gpu::FrameRing& ring, gpu::Commands& commands, bool wait) {
    for (const uint32_t layer : slots.take_wishes()) {
        if (under_way_ + came_.size() >= kMostLoads) break;  // the pages will ask again
        LOAM_TRY(begin_load(ring.device(), layer));
    }
    if (wait) workers_.wait_idle();
    {
        const std::lock_guard lock(mutex_);
        under_way_ -= finished_.size();
        came_.insert(came_.end(), finished_.begin(), finished_.end());
        finished_.clear();
    }
    std::erase_if(came_, [&](const std::shared_ptr<Load>& load) {
        if (load->failure.empty()) return false;
        log(LogLevel::warning, "{}; its layer shows blurred until the project is opened again",
            load->failure);
        slots.fail(load->layer);
        return true;
    });
    bool in_use = false;
    std::erase_if(came_, [&](const std::shared_ptr<Load>& load) {
        const int slot = slots.place(load->layer);
        if (slot < 0) return false;
        if (!in_use)
            commands.use({{arrays_.albedo_reveal, gpu::Access::copy_target},
                          {arrays_.normal_gloss_occlusion, gpu::Access::copy_target},
                          {arrays_.metalness, gpu::Access::copy_target}});
        in_use = true;
        arrays_.cmd_fill(commands, load->staging, 0, uint32_t(slot));
        ++load_count_;
        return true;  // the staging buffer rests until the frame is done
    });
    return {};
}

}  // namespace loam
