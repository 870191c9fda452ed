// Which sectors are live, how large their virtual images are, their ids and places in the indirection
// texture.
//
// A sector is live when texels finer than the default image's may be wanted in it: by its distance from the
// camera. Its image is as wide as its nearest point needs, from one page to 256 x 256. It grows at once and
// shrinks when the camera has gone a quarter farther than needed, so that nothing flickers; a changed image
// gets a new square of the indirection texture, which is filled in the frame that switches to it.
//
// When all would take more than the indirection texture has, images lose their slack, then the largest and
// farthest are halved until they fit: coarser, never wrong. When a square is refused although there is room,
// everything is placed anew, largest first, which cannot fail: with squares of power-of-two sides placed in
// falling order (the default image in its corner), the free texels are whole aligned squares of the side in
// question and at most one broken one, and the number of whole ones is the free area divided by the square's,
// rounded down; so a square that fits by area fits. Source: Call of Duty talk, "Adaptive Virtual Texture",
// "Virtual Image", "Dynamic Resizing".
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

// The nearest that an eye comes to the ground of a sector, metres.
struct SectorDistance {
    glm::ivec2 sector{0};
    double distance_m = 0;
};

struct LiveSector {
    glm::ivec2 sector{0};
    int id = 0;            // 1 … 255
    glm::ivec2 origin{0};  // in the indirection texture
    double distance_m = 0;
    uint64_t last_seen = 0;
    bool in_table = false;  // its root page is usable: shaders look at it
    std::unique_ptr<PageTree> tree;
    [[nodiscard]] ImageId image() const { return {true, sector.x, sector.y}; }
    [[nodiscard]] int log2_width() const { return tree->log2_width(); }
};

struct SectorSetDesc {
    TextureLayout layout;
    int indirection_log2_size = 10;
    int max_live = 255;
};

class SectorSet {
  public:
    static constexpr double kSlack = 1.25;        // of the distance, before an image shrinks or ends
    static constexpr uint64_t kSeenFrames = 120;  // a sector not seen for longer gives way to one that is

    explicit SectorSet(const SectorSetDesc& desc);

    [[nodiscard]] PageTree& default_tree() { return default_tree_; }
    [[nodiscard]] const PageTree& default_tree() const { return default_tree_; }
    [[nodiscard]] std::vector<LiveSector>& live() { return live_; }
    [[nodiscard]] const std::vector<LiveSector>& live() const { return live_; }
    [[nodiscard]] LiveSector* find(glm::ivec2 sector);
    [[nodiscard]] PageTree* tree_of(const ImageId& image);  // null: not live
    [[nodiscard]] const PageTree* tree_of(const ImageId& image) const;
    [[nodiscard]] FeedbackImages images() const;

    // log2 of the width in pages that texels of `texel_m` need; -1 when the default image has them.
    [[nodiscard]] int wanted_log2(double texel_m) const;
    // A texel seen from a distance of 1 m is texel_angle_rad metres wide. `near`: every sector that may have
    // to be live, each once. Trees of resized images are empty.
    struct Changes {
        std::vector<ImageId> dropped, resized;
        bool moved = false;  // any image is somewhere else
    };
    Changes update(std::span<const SectorDistance> near, double texel_angle_rad, uint64_t frame);
    void seen(glm::ivec2 sector, uint64_t frame);

    // kSectorTableSide² entries around a sector.
    void write_table(glm::ivec2 middle_sector, std::span<uint32_t> out) const;

    [[nodiscard]] int64_t used_texels() const { return capacity_texels() - allocator_.free_texels(); }
    [[nodiscard]] int64_t capacity_texels() const { return int64_t(1) << (2 * desc_.indirection_log2_size); }
    // Images that are smaller than the picture could use, as the indirection texture is full; and the largest
    // width given to one.
    [[nodiscard]] int capped_count() const { return capped_count_; }
    [[nodiscard]] int cap_log2() const { return cap_log2_; }
    [[nodiscard]] uint64_t repack_count() const { return repack_count_; }

  private:
    struct Target {
        glm::ivec2 sector;
        double distance_m;
        int log2;        // to be given
        int least_log2;  // without slack
        bool known;      // live now
    };
    [[nodiscard]] std::vector<Target> targets(std::span<const SectorDistance> near, double texel_angle_rad,
                                              uint64_t frame);
    void fit(std::vector<Target>& targets);
    void place(const std::vector<Target>& targets, uint64_t frame, Changes& changes);
    void repack();
    [[nodiscard]] int free_id() const;

    SectorSetDesc desc_;
    PageTree default_tree_;
    IndirectionAllocator allocator_;
    std::vector<LiveSector> live_;
    int capped_count_ = 0, cap_log2_ = kMaxSectorLog2Width;
    uint64_t repack_count_ = 0;
};

// Distances of all sectors of a map within `radius_m` of an eye over flat ground at height 0: for tests and
// benches of the texture alone; the renderer knows the ground.
[[nodiscard]] std::vector<SectorDistance> flat_sector_distances(const WorldRect& bounds,
                                                                const glm::dvec3& eye_m, double radius_m);

}  // namespace loam
