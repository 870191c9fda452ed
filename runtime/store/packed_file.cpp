#include "runtime/store/packed_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "runtime/store/zstd_frame.h"

namespace loam {

namespace {

constexpr int kZstdLevel = 6;  // written once, read often

// On the disk when it returns; what was opened and could not be written is gone.
Status write_whole(const std::filesystem::path& file, std::span<const uint8_t> bytes) {
    const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0) return error("cannot write {}: {}", file.string(), std::strerror(errno));
    size_t written = 0;
    int failure = 0;
    while (written < bytes.size() && failure == 0) {
        const ssize_t step = ::write(descriptor, bytes.data() + written, bytes.size() - written);
        if (step >= 0)
            written += size_t(step);
        else if (errno != EINTR)
            failure = errno;
    }
    if (failure == 0 && ::fsync(descriptor) != 0) failure = errno;
    ::close(descriptor);
    if (failure != 0) {
        ::unlink(file.c_str());  // half of it helps nobody
        return error("cannot write {}: {}", file.string(), std::strerror(failure));
    }
    return {};
}

}  // namespace

void append_u32(uint32_t value, std::vector<uint8_t>& bytes) {
    for (int i = 0; i < 4; ++i) bytes.push_back(uint8_t(value >> (8 * i)));
}

uint32_t read_u32(const uint8_t* bytes) {
    return uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8 | uint32_t(bytes[2]) << 16 | uint32_t(bytes[3]) << 24;
}

void append_part(std::span<const uint8_t> part, std::vector<uint8_t>& bytes) {
    std::vector<uint8_t> frame;
    append_zstd_frame(part, kZstdLevel, frame);
    append_u32(uint32_t(frame.size()), bytes);
    bytes.insert(bytes.end(), frame.begin(), frame.end());
}

Status read_part(std::span<const uint8_t>& rest, std::span<uint8_t> out) {
    if (rest.size() < 4) return error("the file is cut short");
    const uint32_t length = read_u32(rest.data());
    rest = rest.subspan(4);
    if (length > rest.size()) return error("the file is cut short");
    LOAM_TRY(read_zstd_frame(rest.first(length), out));
    rest = rest.subspan(length);
    return {};
}

Status replace_file(const std::filesystem::path& file, std::span<const uint8_t> bytes) {
    std::filesystem::path temporary = file;
    temporary += ".new";
    LOAM_TRY(write_whole(temporary, bytes));
    std::error_code failure;
    std::filesystem::rename(temporary, file, failure);
    if (failure) return error("cannot replace {}: {}", file.string(), failure.message());
    return {};
}

Result<std::vector<uint8_t>> read_file(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) return error("cannot read {}: {}", file.string(), std::strerror(errno));
    const auto length = std::streamoff(stream.tellg());
    std::vector<uint8_t> bytes(size_t(std::max<std::streamoff>(0, length)));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (!stream && !bytes.empty()) return error("cannot read {}: {}", file.string(), std::strerror(errno));
    return bytes;
}

}  // namespace loam
