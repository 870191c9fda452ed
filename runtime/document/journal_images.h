// What a command replaced: previous blobs of pages, previous texts of operators and of transitions in the
// layer list, as the bytes of a journal row. Undo and redo are one operation, `swap_images`: the rows of the
// tables, or the list's entries, and the images change places. A list never gets shorter: a transition that
// was not there becomes a removed one.
//
// An image: | 1 byte kind (0 page, 1 operator, 2 transition) | 8 bytes key or id | 1 byte present | 4 bytes
// length | bytes
// |
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/page_store.h"
#include "runtime/store/project.h"

namespace loam {

struct RowImage {
    enum class Kind : uint8_t { page = 0, op = 1, transition = 2 };
    Kind kind = Kind::page;
    int64_t key = 0;                            // of a transition its place in the layer list
    std::optional<std::vector<uint8_t>> bytes;  // none: no such row
};

[[nodiscard]] std::vector<uint8_t> image_bytes(const std::vector<RowImage>& images);
[[nodiscard]] Result<std::vector<RowImage>> images_of(std::span<const uint8_t> bytes);

// Rows that a map gained (or, negative, lost).
struct PageBalance {
    int64_t height = 0, index = 0;
};

// What images of transitions change: a copy of the settings, made by the first of them.
struct SettingsEdit {
    const ProjectSettings& current;
    std::optional<ProjectSettings> changed{};
};

// Writes each image into its table, or the settings, and puts what was there in its place. Inside a
// transaction of the caller's.
Status swap_images(PageStore& store, std::vector<RowImage>& images, PageBalance& balance,
                   SettingsEdit& settings);

}  // namespace loam
