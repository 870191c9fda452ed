#include "runtime/store/packed_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include "runtime/store/zstd_frame.h"

namespace loam {

namespace {

constexpr int kZstdLevel = 6;  // written once, read often

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

Result<PartReader> PartReader::open(const std::filesystem::path& file) {
    PartReader reader;
    reader.stream_.open(file, std::ios::binary | std::ios::ate);
    if (!reader.stream_) return error("cannot read {}: {}", file.string(), std::strerror(errno));
    reader.rest_ = uint64_t(std::max<std::streamoff>(0, std::streamoff(reader.stream_.tellg())));
    reader.stream_.seekg(0);
    return reader;
}

Status PartReader::read(std::span<uint8_t> out) {
    if (out.size() > rest_) return error("the file is cut short");
    stream_.read(reinterpret_cast<char*>(out.data()), std::streamsize(out.size()));
    if (!stream_) return error("it cannot be read: {}", std::strerror(errno));
    rest_ -= out.size();
    return {};
}

Result<uint32_t> PartReader::part_length() {
    uint8_t bytes[4];
    LOAM_TRY(read(bytes));
    const uint32_t length = read_u32(bytes);
    if (length > rest_) return error("the file is cut short");
    return length;
}

Status PartReader::read_part(std::span<uint8_t> out) {
    const auto length = part_length();
    if (!length.ok()) return length.error();
    std::vector<uint8_t> frame(*length);
    LOAM_TRY(read(frame));
    return read_zstd_frame(frame, out);
}

Status PartReader::skip_part() {
    const auto length = part_length();
    if (!length.ok()) return length.error();
    stream_.seekg(*length, std::ios::cur);
    if (!stream_) return error("it cannot be read: {}", std::strerror(errno));
    rest_ -= *length;
    return {};
}

ReplacedFile::ReplacedFile(std::filesystem::path file, int descriptor)
    : file_(std::move(file)), temporary_(file_), descriptor_(descriptor) {
    temporary_ += ".new";
}

ReplacedFile::ReplacedFile(ReplacedFile&& other) noexcept
    : file_(std::move(other.file_)),
      temporary_(std::move(other.temporary_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      size_bytes_(other.size_bytes_) {}

ReplacedFile::~ReplacedFile() {
    if (descriptor_ < 0) return;
    ::close(descriptor_);
    ::unlink(temporary_.c_str());  // half of it helps nobody
}

Result<ReplacedFile> ReplacedFile::create(const std::filesystem::path& file) {
    std::filesystem::path temporary = file;
    temporary += ".new";
    const int descriptor = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor < 0) return error("cannot write {}: {}", temporary.string(), std::strerror(errno));
    return ReplacedFile(file, descriptor);
}

Status ReplacedFile::append(std::span<const uint8_t> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return error("cannot write {}: {}", temporary_.string(), std::strerror(errno));
        bytes = bytes.subspan(size_t(written));
        size_bytes_ += uint64_t(written);
    }
    return {};
}

Status ReplacedFile::commit() {
    if (::fsync(descriptor_) != 0)
        return error("cannot write {}: {}", temporary_.string(), std::strerror(errno));
    std::error_code failure;
    std::filesystem::rename(temporary_, file_, failure);
    if (failure) return error("cannot replace {}: {}", file_.string(), failure.message());
    ::close(std::exchange(descriptor_, -1));
    return {};
}

Status replace_file(const std::filesystem::path& file, std::span<const uint8_t> bytes) {
    auto replaced = ReplacedFile::create(file);
    if (!replaced.ok()) return replaced.error();
    LOAM_TRY(replaced->append(bytes));
    return replaced->commit();
}

}  // namespace loam
