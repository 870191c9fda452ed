// The sun's shadow: four cascades around the camera in one depth atlas, each kept until the sun, the ground
// inside it or the camera has moved, so that a steady view draws none. The light looks along -z of its own
// axes; a cascade is a square of light space, snapped to its texels so that shadows do not crawl. Depth grows
// towards the sun (reversed, like the picture's). Where only ground has changed, only the texels that its old
// and new surface cover are drawn again: an edit costs an edit.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "runtime/base/rect.h"
#include "runtime/geometry/patch_tree.h"
#include "runtime/geometry/terrain_pass.h"
#include "runtime/gpu/commands.h"
#include "shaders/frame/frame_io.h"

namespace loam {

class ShadowCascades {
  public:
    static Result<ShadowCascades> create(gpu::Device& device, uint32_t cascade_texels);

    // Heights inside are about to change: to be called while `heights` still holds what was drawn.
    void on_dirt(std::span<const WorldRect> rects, const HeightMap& heights);
    // Decides which cascades are stale, draws them (at most `budget`, nearest first) and fills the uniforms.
    // `refine`: also draw cascades again that are off centre or show another cut of the ground than the
    // picture: a still picture must not depend on how the camera came to its place.
    void update(gpu::Commands& commands, TerrainPass& terrain, const PatchSet& patches,
                const HeightMap& heights, const glm::dvec3& camera_m, const glm::dvec3& to_sun, int budget,
                bool refine, shared::FrameUniforms& uniforms);

    [[nodiscard]] gpu::Image& atlas() { return atlas_; }
    [[nodiscard]] const gpu::Sampler& sampler() const { return sampler_; }
    [[nodiscard]] bool settled() const { return settled_; }
    // Drawn by the last update: whole cascades, and rectangles within others.
    [[nodiscard]] uint32_t drawn() const { return drawn_; }
    [[nodiscard]] uint32_t parts_drawn() const { return parts_drawn_; }

  private:
    struct Cascade {
        bool valid = false;
        std::vector<TexelRect> dirty;  // of its own square
        bool urgent = false;           // some of it is wide enough to be seen
        uint64_t dirty_since = 0;      // which update
        glm::dvec2 center_m{0};  // light space of the world
        double z_m = 0;          // light-space height of depth 0.5
        double half_m = 0;
        uint64_t cut_hash = 0;
        uint64_t drawn_in = 0;  // which update
    };
    struct Axes {
        glm::dvec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    };
    // The light-space centre that the cascade has when it is drawn now.
    [[nodiscard]] glm::dvec2 snapped(const Cascade& c, const glm::dvec2& eye_m) const;
    [[nodiscard]] bool is_stale(const Cascade& c, const glm::dvec2& eye_m, uint64_t cut_hash,
                                bool refine) const;
    // The texels of a cascade's square that the ground in `rect` may cover, as `pages` draw it; grown by what
    // triangles reach beyond their vertices.
    [[nodiscard]] TexelRect covered(const Cascade& c, const HeightMap& heights,
                                    std::span<const MapPage> pages, const WorldRect& rect) const;
    void place_dirt(const HeightMap& heights, std::span<const MapPage> pages,
                    std::span<const WorldRect> rects);
    // Of a cascade's square; all of it: the cascade is placed anew.
    struct Part {
        int index;
        TexelRect texels;
    };
    [[nodiscard]] std::vector<Part> choose(const glm::dvec2& eye_m, uint64_t cut_hash, int budget,
                                           bool refine);
    void draw(gpu::Commands& commands, TerrainPass& terrain, const PatchSet& patches,
              const HeightMap& heights, const glm::dvec3& camera_m, const Part& part);

    gpu::Image atlas_;
    gpu::Sampler sampler_;
    uint32_t texels_ = 1024;
    std::array<Cascade, kCascadeCount> cascades_;
    Axes axes_;
    uint64_t update_ = 0;
    bool settled_ = false;
    uint32_t drawn_ = 0, parts_drawn_ = 0;
    std::vector<MapPage> pages_;      // of the patches of the last update
    std::vector<WorldRect> changed_;  // since then
};

}  // namespace loam
