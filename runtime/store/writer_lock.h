// One writer a project: an exclusive flock on `terrain.lock`. A file of its own, because closing any
// descriptor of terrain.db would drop SQLite's POSIX locks on it. The kernel lets go of it when the process
// ends, however it ends.
#pragma once

#include <filesystem>

#include "runtime/base/result.h"

namespace loam {

class WriterLock {
  public:
    static Result<WriterLock> acquire(const std::filesystem::path& folder);
    WriterLock() = default;
    ~WriterLock();
    WriterLock(WriterLock&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
    WriterLock& operator=(WriterLock&& other) noexcept;

  private:
    int descriptor_ = -1;
};

}  // namespace loam
