// Pages of different character to compress, and the encoders of others to compare with: parts of `loam bench
// encoders`.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "editor/bench/bench.h"
#include "runtime/texture/block_encoder.h"

namespace loam::bench {

using Texels = std::vector<uint8_t>;  // RGBA8 of a page of kPageTexels a side

// The three textures of a composed page: albedo; gloss, normal x, occlusion; metalness, normal y. A
// photograph has the first only.
struct EncoderPage {
    std::string name;
    std::array<Texels, 3> textures;
};
// Eight pages: a square metre of each of five layers, 64 m of the map's middle, a crater, noise. Of the
// project's copy.
[[nodiscard]] Result<std::vector<EncoderPage>> composed_pages(gpu::Device& device,
                                                              const std::filesystem::path& project);
// The middle of every picture in the folder, or, in folders below it, of every albedo.*.
[[nodiscard]] Result<std::vector<EncoderPage>> photograph_pages(const std::filesystem::path& folder);

// A page compressed: channels' mean squared errors, and milliseconds it took.
struct PageResult {
    glm::dvec4 mean_square{0.0};
    double ms = 0;
};
struct OtherEncoder {
    std::string name;
    BlockFormat format = BlockFormat::bc1;
    std::function<Result<PageResult>(const Texels& page, glm::vec3 weights)> run;
};
// libsquish and stb_dxt where they were found at build time, Arm's astcenc where it is installed; each on one
// core (astcenc: as it wishes).
[[nodiscard]] std::vector<OtherEncoder> other_encoders();

}  // namespace loam::bench
