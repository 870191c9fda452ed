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

Result<int> read_head(PartReader& file) {
    uint8_t head[kHeadBytes];
    if (!file.read(head).ok() || std::memcmp(head, kMagic, 8) != 0) return error("not a layer file");
    const uint32_t size = read_u32(head + 8);
    if (size < 4 || size > 4096 || (size & (size - 1)) != 0)
        return error("its size is {} texels, must be a power of two from 4 to 4096", size);
    return int(size);
}

Status read_texture(PartReader& file, size_t bytes, std::vector<uint8_t>& out) {
    out.resize(bytes);
    return file.read_part(out);
}

Result<LayerTextures> read_textures(PartReader& file, int first_mip) {
    const auto size = read_head(file);
    if (!size.ok()) return size.error();
    LayerTextures textures;
    textures.size_texels = *size;
    textures.mip_count = mips_of(*size);
    for (int mip = 0; mip < textures.mip_count; ++mip) {
        const size_t texels = size_t(*size >> mip) * size_t(*size >> mip);
        auto& albedo = textures.albedo_reveal.emplace_back();
        auto& normal = textures.normal_gloss_occlusion.emplace_back();
        auto& metal = textures.metalness.emplace_back();
        if (mip >= first_mip) {
            LOAM_TRY(read_texture(file, 4 * texels, albedo));
            LOAM_TRY(read_texture(file, 4 * texels, normal));
        } else {
            LOAM_TRY(file.skip_part());
            LOAM_TRY(file.skip_part());
        }
        if (mip >= first_mip || mip == 0)
            LOAM_TRY(read_texture(file, texels, metal));
        else
            LOAM_TRY(file.skip_part());
        if (mip == 0)
            textures.has_metal = std::any_of(metal.begin(), metal.end(), [](uint8_t m) { return m > 0; });
        if (mip < first_mip) metal.clear();
    }
    if (file.rest_bytes() > 0) return error("{} bytes too many at the end", file.rest_bytes());
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

Result<LayerTextures> load_layer(const std::filesystem::path& file, int first_mip) {
    auto reader = PartReader::open(file);
    if (!reader.ok()) return reader.error();
    auto textures = read_textures(*reader, first_mip);
    if (!textures.ok()) return error("{}: {}", file.string(), textures.message());
    return textures;
}

Result<int> layer_size(const std::filesystem::path& file) {
    auto reader = PartReader::open(file);
    if (!reader.ok()) return reader.error();
    const auto size = read_head(*reader);
    if (!size.ok()) return error("{}: {}", file.string(), size.message());
    return size;
}

}  // namespace loam
