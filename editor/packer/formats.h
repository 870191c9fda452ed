// What a layer costs and loses in each format, in units that suit the channel, and which format is enough.
// Source: the Infinite Warfare talk, "Texture Packer": pick the metric by the data (the angle of normals, not
// the difference of colours), pick the format by the error. Differences: BC7 is not among the candidates
// (Loam has no encoder for it); the packed texture of normal, occlusion and gloss is BC3 here, its normal's y
// in the alpha.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "editor/packer/layer_planes.h"
#include "runtime/base/result.h"

namespace loam {

// ΔE is CIE76 under D65; angles are degrees; the others are differences of values 0…1.
struct ChannelError {
    double mean = 0, p95 = 0, max = 0;
};

enum class PackChannel { color, normal, gloss, occlusion, reveal, metalness };
[[nodiscard]] std::string_view channel_name(PackChannel channel);
[[nodiscard]] std::string_view channel_unit(PackChannel channel);  // "ΔE", "°", ""

// Errors that a channel may have: on the mean and on the worst twentieth. ΔE 2.3 is the least that eyes tell
// apart side by side; half a step of normals of eight bits is 0.3°; gloss, occlusion and metalness enter
// lighting as they are.
struct ErrorLimit {
    double mean, p95;
};
[[nodiscard]] ErrorLimit limit_of(PackChannel channel);

struct FormatRow {
    PackChannel channel = PackChannel::color;
    std::string format;      // "BC1", "BC5 hemi-octahedral, scaled, quadratic", …
    double bytes_texel = 0;  // of mip 0; mips add a third
    ChannelError error{};
    double psnr_db = 0;  // colour only; 0: none, 99: equal
    bool fits = false;   // within the channel's limit
    bool chosen = false;
};

// One texture for several channels, as the talk packs them.
struct FormatTable {
    std::vector<FormatRow> rows;    // the channels on their own
    std::vector<FormatRow> packed;  // normal, gloss and occlusion in one BC3 of 1 byte: a row a channel
    bool packed_fits = false;       // every channel of it is within its limit: then it is chosen
    double normal_scale = 1;        // that hemi-octahedral normals are divided by ("scaled")
    double bytes_before = 0;        // as the layer file holds it: RGBA8, RGBA8 and, with metal, R8
    double bytes_after = 0;         // of what was chosen
    int sampled_blocks = 0, blocks = 0;
};

// On mip 0, on blocks of 4x4 texels, evenly spread where there are more than kMostBlocks.
inline constexpr int kMostBlocks = 16384;
[[nodiscard]] FormatTable measure_formats(const LayerPlanes& planes);

}  // namespace loam
