// The virtual cutout map: one bit a vertex of the base height map, 4×2 of them a byte. Its pages are those of
// the height map at the base's level: 64² vertices and a border of 2, 68² bits, 578 bytes. Almost all ground
// is whole and some of it is gone, so a page table of a byte a page says so; only pages of both kinds have
// bits, at most 254 of them, the nearest to the camera (what is farther shows as ground and is counted). A
// place between vertices is cut where the bits around it, interpolated, are more than half: the outline is
// that of the base's vertices at every level of detail, so neighbouring levels meet at a rim. Source: Call of
// Duty talk, "Virtual Cutout Map", "Cutout Volumes".
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/base/rect.h"
#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/resources.h"
#include "runtime/maps/virtual_map.h"
#include "shaders/geometry/cutout_io.h"

namespace loam {

class Document;

using CutoutBits = std::array<uint8_t, kCutoutPageBytes>;
[[nodiscard]] bool bit_of(const CutoutBits& bits, int x, int y);  // texel with border, 0 … 67

enum class Holes { open, closed };  // for rays

enum class CutoutCover : uint8_t { ground, mixed, gone };

class CutoutMap {
  public:
    // `device` null: without GPU buffers, which are else made when the first page has bits.
    static Result<std::unique_ptr<CutoutMap>> create(gpu::Device* device, const Document& document);
    ~CutoutMap();

    // Where cutouts changed, and where heights did: volumes follow the ground.
    void on_dirt(std::span<const WorldRect> rects);
    void on_height_dirt(std::span<const WorldRect> rects);
    // Composes at most `new_pages` stale pages, the nearest to the camera first, and records the uploads; the
    // buffers can then be read by fragment shaders. `changed` grows by where what is shown is another.
    Status update(gpu::FrameRing& ring, gpu::Commands& commands, const glm::dvec3& camera_m, int new_pages,
                  std::vector<WorldRect>& changed);
    void update_without_gpu(const glm::dvec3& camera_m, int new_pages, std::vector<WorldRect>& changed);
    [[nodiscard]] bool has_work() const;

    // What is shown of a page of the height map.
    [[nodiscard]] CutoutCover cover_of(const MapPage& height_page) const;
    [[nodiscard]] const gpu::Buffer& table() const;  // bytes, in words: shaders/geometry/cutout.glsl
    [[nodiscard]] const gpu::Buffer& pages() const;
    [[nodiscard]] shared::CutoutPush push(const glm::dvec3& camera_m) const;

    struct Counts {
        uint32_t mixed = 0, gone = 0;  // pages
        uint32_t not_shown = 0;        // mixed ones beyond the 254 nearest
        uint32_t stale = 0;            // not composed yet
    };
    [[nodiscard]] Counts counts() const;
    [[nodiscard]] uint64_t gpu_bytes() const;

    // The bits of a page, a pure function of the document.
    static void compose(const Document& document, glm::ivec2 page, CutoutBits& bits);
    // Whether the ground is cut at a place, by the document alone: exact at once after an edit. Off the map:
    // no.
    [[nodiscard]] static bool is_cut(const Document& document, double x_m, double y_m);
    // Tests: composed pages without dirt that differ from what `document` gives.
    [[nodiscard]] uint32_t count_stale_pages(const Document& document) const;

  private:
    CutoutMap();
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace loam
