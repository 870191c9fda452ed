#include "runtime/store/zstd_frame.h"

#include <memory>

#include <zstd.h>

#include "runtime/base/check.h"

namespace loam {

namespace {

struct FreeContext {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

void append_zstd_frame(std::span<const uint8_t> bytes, int level, std::vector<uint8_t>& out) {
    thread_local const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
    LOAM_CHECK(context, "no memory for a zstd context");
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, level);
    ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
    const size_t start = out.size();
    out.resize(start + ZSTD_compressBound(bytes.size()));
    const size_t written =
        ZSTD_compress2(context.get(), out.data() + start, out.size() - start, bytes.data(), bytes.size());
    LOAM_CHECK(!ZSTD_isError(written), ZSTD_getErrorName(written));
    out.resize(start + written);
}

Status read_zstd_frame(std::span<const uint8_t> frame, std::span<uint8_t> bytes) {
    thread_local const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
    LOAM_CHECK(context, "no memory for a zstd context");
    // Exactly one frame: zstd would read several in a row, or none, as well.
    const size_t length = ZSTD_findFrameCompressedSize(frame.data(), frame.size());
    if (ZSTD_isError(length)) return error("damaged data: {}", ZSTD_getErrorName(length));
    if (length != frame.size())
        return error("damaged data: the frame has {} bytes, {} expected", length, frame.size());
    // Frame header: 4 bytes of magic, then the descriptor, whose bit 2 says that a checksum follows the
    // content.
    if (frame.size() < 5 || (frame[4] & 4) == 0) return error("damaged data: no checksum");
    const unsigned long long content = ZSTD_getFrameContentSize(frame.data(), frame.size());
    if (content != bytes.size()) return error("damaged data: wrong content size, {} expected", bytes.size());
    const size_t read =
        ZSTD_decompressDCtx(context.get(), bytes.data(), bytes.size(), frame.data(), frame.size());
    if (ZSTD_isError(read)) return error("damaged data: {}", ZSTD_getErrorName(read));
    if (read != bytes.size()) return error("damaged data: {} bytes, {} expected", read, bytes.size());
    return {};
}

}  // namespace loam
