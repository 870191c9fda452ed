// Frames in flight: command buffers, descriptor pools, timestamps, and rings for upload and readback.
//
//     FrameRing ring(device, 2);
//     auto frame = ring.begin();              // waits until the frame two before has finished
//     auto bytes = ring.upload(size);         // valid for this frame
//     ... record into frame->commands ...
//     ring.end(*frame, {});                   // submits
//
// A readback requested in frame N is delivered by the first `begin` after the GPU passed frame N, in order of frames.
// Each frame begun must be ended, even when nothing could be recorded. One ring records at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "runtime/gpu/commands.h"
#include "runtime/gpu/device.h"

namespace loam::gpu {

struct UploadSlice {
    Buffer* buffer = nullptr;
    uint64_t offset = 0;
    void* data = nullptr;
    uint64_t size_bytes = 0;
    template <typename T>
    [[nodiscard]] T* as() const { return static_cast<T*>(data); }
};

struct Frame {
    uint64_t number = 0; // 1, 2, …
    Commands commands;
};

struct SubmitSync { // window only
    VkSemaphore wait_acquired = VK_NULL_HANDLE;
    VkSemaphore signal_rendered = VK_NULL_HANDLE;
};

class FrameRing {
  public:
    static Result<std::unique_ptr<FrameRing>> create(Device& device, uint32_t frames_in_flight);
    ~FrameRing();
    FrameRing(const FrameRing&) = delete;

    Result<Frame*> begin();
    Status end(Frame& frame, const SubmitSync& sync = {});
    Status finish(Frame& frame); // end, then wait for this frame: headless renders and tests

    // Host memory for this frame, aligned to 256 bytes; may be copied from, or read as storage, uniform, index or
    // indirect buffer without a Use. Grows by blocks as needed.
    UploadSlice upload(uint64_t size_bytes);
    // Copies from a buffer into host memory once the commands so far have run; `done` is called from a later `begin`
    // (or from `finish`) with the bytes.
    void read_back(Commands& commands, Buffer& source, uint64_t offset, uint64_t size_bytes,
                   std::function<void(std::span<const std::byte>)> done);
    // The same from a mip of layer 0 of an image; rows are tightly packed. Of a depth image its depth, 4
    // bytes a texel.
    void read_back(Commands& commands, Image& source, std::function<void(std::span<const std::byte>)> done,
                   uint32_t mip = 0);

    // Timestamps of the newest finished frame, in order of recording (see platform notes: display only).
    [[nodiscard]] std::span<const PassTime> pass_times() const;
    [[nodiscard]] Device& device() { return device_; }
    [[nodiscard]] uint64_t ring_bytes() const; // host memory held by the rings

  private:
    friend class Commands;
    struct Slot;
    explicit FrameRing(Device& device);
    Status make_slot(Slot& slot);
    void deliver(Slot& slot);
    void deliver_finished();
    VkDescriptorSet allocate_set(VkDescriptorSetLayout layout);
    uint32_t open_timer(const char* name);
    void close_timer(uint32_t query);
    Device& device_;
    std::vector<std::unique_ptr<Slot>> slots_;
    Slot* current_ = nullptr; // between begin and end
    size_t next_slot_ = 0;
    std::vector<PassTime> pass_times_;
};

} // namespace loam::gpu
