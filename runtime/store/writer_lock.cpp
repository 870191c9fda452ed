#include "runtime/store/writer_lock.h"

#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace loam {

Result<WriterLock> WriterLock::acquire(const std::filesystem::path& folder) {
    const std::filesystem::path file = folder / "terrain.lock";
    WriterLock lock;
    lock.descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (lock.descriptor_ < 0)
        return error("cannot write in {}: {}; open the project read-only or change the folder's permissions",
                     folder.string(), std::strerror(errno));
    if (flock(lock.descriptor_, LOCK_EX | LOCK_NB) != 0) {
        if (errno == EWOULDBLOCK)
            return error("{} is open for writing elsewhere; close the other editor or open it read-only",
                         folder.string());
        return error("cannot lock {}: {}", file.string(), std::strerror(errno));
    }
    return lock;
}

WriterLock::~WriterLock() {
    if (descriptor_ >= 0) close(descriptor_);
}

WriterLock& WriterLock::operator=(WriterLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

}  // namespace loam
