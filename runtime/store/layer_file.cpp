// | bytes | meaning |
// | --- | --- |
// | 0–7 | "LOAMLYR1" |
// | 8–11 | size in texels, little endian |
// | then, a mip from finest to 1x1, albedo_reveal, normal_gloss_occlusion, metalness: | |
// | 4 | length of the frame, little endian |
// | length | zstd frame with checksum |
#include "runtime/store/layer_file.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

#include "runtime/base/check.h"
#include "runtime/store/zstd_frame.h"

namespace loam {

namespace {

constexpr char kMagic[] = "LOAMLYR1";
constexpr size_t kHeadBytes = 12;
constexpr int kZstdLevel = 6;  // written once, read often

void put_u32(uint8_t* bytes, uint32_t value) {
    for (int i = 0; i < 4; ++i) bytes[i] = uint8_t(value >> (8 * i));
}
uint32_t get_u32(const uint8_t* bytes) {
    return uint32_t(bytes[0]) | uint32_t(bytes[1]) << 8 | uint32_t(bytes[2]) << 16 | uint32_t(bytes[3]) << 24;
}

int mips_of(int size) {
    int count = 1;
    while (size >> count > 0) ++count;
    return count;
}

Status read_texture(std::span<const uint8_t>& rest, size_t bytes, std::vector<uint8_t>& out) {
    if (rest.size() < 4) return error("the file is cut short");
    const uint32_t length = get_u32(rest.data());
    rest = rest.subspan(4);
    if (length > rest.size()) return error("the file is cut short");
    out.resize(bytes);
    LOAM_TRY(read_zstd_frame(rest.first(length), out));
    rest = rest.subspan(length);
    return {};
}

Result<LayerTextures> read_textures(std::span<const uint8_t> bytes) {
    if (bytes.size() < kHeadBytes || std::memcmp(bytes.data(), kMagic, 8) != 0)
        return error("not a layer file");
    const uint32_t size = get_u32(bytes.data() + 8);
    if (size < 4 || size > 4096 || (size & (size - 1)) != 0)
        return error("its size is {} texels, must be a power of two from 4 to 4096", size);
    LayerTextures textures;
    textures.size_texels = int(size);
    textures.mip_count = mips_of(int(size));
    auto rest = bytes.subspan(kHeadBytes);
    for (int mip = 0; mip < textures.mip_count; ++mip) {
        const size_t texels = size_t(size >> mip) * size_t(size >> mip);
        LOAM_TRY(read_texture(rest, 4 * texels, textures.albedo_reveal.emplace_back()));
        LOAM_TRY(read_texture(rest, 4 * texels, textures.normal_gloss_occlusion.emplace_back()));
        LOAM_TRY(read_texture(rest, texels, textures.metalness.emplace_back()));
    }
    if (!rest.empty()) return error("{} bytes too many at the end", rest.size());
    const auto& metal = textures.metalness[0];
    textures.has_metal = std::any_of(metal.begin(), metal.end(), [](uint8_t m) { return m > 0; });
    return textures;
}

}  // namespace

Status save_layer(const std::filesystem::path& file, const LayerTextures& textures) {
    LOAM_CHECK(textures.mip_count == mips_of(textures.size_texels),
               "build_layer_mips comes before save_layer");
    std::vector<uint8_t> bytes(kHeadBytes);
    std::memcpy(bytes.data(), kMagic, 8);
    put_u32(bytes.data() + 8, uint32_t(textures.size_texels));
    for (size_t mip = 0; mip < size_t(textures.mip_count); ++mip)
        for (const auto* texture :
             {&textures.albedo_reveal, &textures.normal_gloss_occlusion, &textures.metalness}) {
            const size_t head = bytes.size();
            bytes.resize(head + 4);
            append_zstd_frame(texture->at(mip), kZstdLevel, bytes);
            put_u32(bytes.data() + head, uint32_t(bytes.size() - head - 4));
        }
    std::filesystem::path temporary = file;
    temporary += ".new";
    {
        std::ofstream stream(temporary, std::ios::binary);
        stream.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
        stream.close();
        if (!stream) return error("cannot write {}: {}", temporary.string(), std::strerror(errno));
    }
    std::error_code failure;
    std::filesystem::rename(temporary, file, failure);
    if (failure) return error("cannot replace {}: {}", file.string(), failure.message());
    return {};
}

Result<LayerTextures> load_layer(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    if (!stream) return error("cannot read {}: {}", file.string(), std::strerror(errno));
    const auto length = std::streamoff(stream.tellg());
    std::vector<uint8_t> bytes(size_t(std::max<std::streamoff>(0, length)));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(bytes.size()));
    if (!stream && !bytes.empty()) return error("cannot read {}: {}", file.string(), std::strerror(errno));
    auto textures = read_textures(bytes);
    if (!textures.ok()) return error("{}: {}", file.string(), textures.message());
    return textures;
}

}  // namespace loam
