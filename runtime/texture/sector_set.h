// Which sectors are live, their ids and places in the indirection texture.
//
// A sector is wanted when feedback sees it through a default page that is too coarse. It becomes live when it
// is inside the live radius and there is an id, a place and room under the limit; a nearer sector drives out
// the farthest one only when that is kFarther times as far away. It stops being live when nobody wanted or
// saw it for kIdleFrames, or beyond kLeave times the radius. When all is full, farther sectors stay on the
// default image: coarser, never wrong. Source: Call of Duty talk, "Adaptive Virtual Texture", "Virtual
// Image". Differs: images of one size, no resizing.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "runtime/texture/feedback.h"
#include "runtime/texture/indirection_allocator.h"
#include "runtime/texture/page_tree.h"

namespace loam {

struct LiveSector {
    glm::ivec2 sector{0};
    int id = 0;            // 1 … 255
    glm::ivec2 origin{0};  // in the indirection texture
    uint64_t last_wanted = 0;
    bool in_table = false;  // its root page is usable: shaders look at it
    std::unique_ptr<PageTree> tree;
    [[nodiscard]] ImageId image() const { return {true, sector.x, sector.y}; }
};

struct SectorSetDesc {
    TextureLayout layout;
    int indirection_log2_size = 10;
    int max_live = 64;
    WorldRect bounds;
};

class SectorSet {
  public:
    static constexpr uint64_t kIdleFrames = 240;
    static constexpr double kLeave = 1.25, kFarther = 1.25;

    explicit SectorSet(const SectorSetDesc& desc);

    [[nodiscard]] PageTree& default_tree() { return default_tree_; }
    [[nodiscard]] const PageTree& default_tree() const { return default_tree_; }
    [[nodiscard]] std::vector<LiveSector>& live() { return live_; }
    [[nodiscard]] const std::vector<LiveSector>& live() const { return live_; }
    [[nodiscard]] LiveSector* find(glm::ivec2 sector);
    [[nodiscard]] PageTree* tree_of(const ImageId& image);  // null: not live
    [[nodiscard]] FeedbackImages images() const;

    void want(glm::ivec2 sector, uint64_t frame);
    // Distances are horizontal. Returns the images that stopped being live.
    std::vector<ImageId> update(glm::dvec2 camera_m, double radius_m, uint64_t frame);

    // kSectorTableSide² entries around the camera's sector.
    void write_table(glm::ivec2 camera_sector, std::span<uint32_t> out) const;

  private:
    struct Wanted {
        glm::ivec2 sector;
        uint64_t frame;
    };
    void drop(size_t index, std::vector<ImageId>& dropped);
    bool add(glm::ivec2 sector, uint64_t frame);

    SectorSetDesc desc_;
    PageTree default_tree_;
    IndirectionAllocator allocator_;
    std::vector<LiveSector> live_;
    std::vector<Wanted> wanted_;
};

}  // namespace loam
