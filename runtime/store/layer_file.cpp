// | bytes | meaning |
// | --- | --- |
// | 0–7 | "LOAMLYR1" |
// | 8–11 | size in texels, little endian |
// | then, a mip from finest to 1x1, albedo_reveal, normal_gloss_occlusion, metalness: | |
// | … | a part (packed_file.h) |
#include "runtime/store/layer_file.h"

#include <algorithm>
#include <cstring>

#include "runtime/base/check.h"
#include "runtime/store/packed_file.h"

namespace loam {

namespace {

constexpr char kMagic[] = "LOAMLYR1";
constexpr size_t kHeadBytes = 12;

int mips_of(int size) {
    int count = 1;
    while (size >> count > 0) ++count;
    return count;
}

Status read_texture(std::span<const uint8_t>& rest, size_t bytes, std::vector<uint8_t>& out) {
    out.resize(bytes);
    return read_part(rest, out);
}

Result<LayerTextures> read_textures(std::span<const uint8_t> bytes) {
    if (bytes.size() < kHeadBytes || std::memcmp(bytes.data(), kMagic, 8) != 0)
        return error("not a layer file");
    const uint32_t size = read_u32(bytes.data() + 8);
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
    std::vector<uint8_t> bytes(kMagic, kMagic + 8);
    append_u32(uint32_t(textures.size_texels), bytes);
    for (size_t mip = 0; mip < size_t(textures.mip_count); ++mip)
        for (const auto* texture :
             {&textures.albedo_reveal, &textures.normal_gloss_occlusion, &textures.metalness})
            append_part(texture->at(mip), bytes);
    return replace_file(file, bytes);
}

Result<LayerTextures> load_layer(const std::filesystem::path& file) {
    const auto bytes = read_file(file);
    if (!bytes.ok()) return bytes.error();
    auto textures = read_textures(*bytes);
    if (!textures.ok()) return error("{}: {}", file.string(), textures.message());
    return textures;
}

}  // namespace loam
