// What a document's index map holds, finest level, row by row.
#pragma once

#include <vector>

#include "runtime/document/document.h"

namespace loam::test {

inline std::vector<IndexTexel> read_texels(const Document& document) {
    const glm::ivec2 size = document.index_size_texels();
    std::vector<IndexTexel> texels(size_t(size.x) * size_t(size.y));
    const auto lock = document.read_lock();
    document.read_index(0, 0, 0, size.x, size.y, texels.data());
    return texels;
}

inline std::vector<int> read_layers(const Document& document) {
    std::vector<int> layers;
    for (const IndexTexel& texel : read_texels(document)) layers.push_back(texel.layer);
    return layers;
}

}  // namespace loam::test
