// The cut over random states of the cache, against brute force on the grid of the finest pages.
#include "runtime/geometry/patch_tree.h"

#include <bit>
#include <map>
#include <set>

#include "tests/unit/map_fixture.h"

#include <glm/gtc/matrix_transform.hpp>

namespace loam {
namespace {

using test::MapFixture;

// Reversed Z, infinite far plane, Vulkan's clip space; yaw clockwise from north.
glm::dmat4 clip_from_rel(double yaw, double pitch, double fov_y, double aspect) {
    const glm::dvec3 forward(std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch),
                             std::sin(pitch));
    const glm::dvec3 right(std::cos(yaw), -std::sin(yaw), 0);
    const glm::dvec3 down = glm::cross(forward, right);
    const double f = 1 / std::tan(fov_y / 2);
    const glm::dmat4 rows(glm::dvec4(right * f / aspect, 0), glm::dvec4(down * f, 0),
                          glm::dvec4(0, 0, 0, 0.1), glm::dvec4(forward, 0));
    return glm::transpose(rows);
}

std::unique_ptr<HeightMap> cpu_map(const Document& document, int slot_count) {
    auto map = HeightMap::create(nullptr, document, {.slot_count = slot_count, .gpu = false});
    EXPECT_TRUE(map.ok());
    return std::move(*map);
}

PatchView random_view(MapFixture& ground) {
    PatchView view;
    view.camera_m = glm::dvec3(ground.place(), ground.real(-10, 200));
    view.clip_from_rel = clip_from_rel(ground.real(0, 6.3), ground.real(-1.5, 1), ground.real(0.2, 1.6), 1.6);
    view.split_distance = ground.real(0.5, 6);
    return view;
}

// Any set of pages, not only what a camera leads to.
void random_residency(HeightMap& map, MapFixture& ground, uint64_t& frame) {
    for (int i = ground.uniform(0, 40); i > 0; --i) {
        MapPage page = ground.page(map.map());
        for (float priority = 1; page.level <= map.map().root().level;
             page = {page.level + 1, page.x / 2, page.y / 2}, ++priority)
            for (int k = 0; k < 4; ++k)
                if (ground.uniform(0, 5))
                    map.request({page.level, (page.x & ~1) + (k & 1), (page.y & ~1) + (k >> 1)}, priority);
    }
    map.update_without_gpu(++frame, ground.uniform(1, 60));
}

// Which patch covers each page of level 0; -1: none.
struct Cover {
    Cover(const VirtualMap& map, const PatchSet& set) : width(map.pages_x(0)), height(map.pages_y(0)) {
        owner.assign(size_t(width * height), -1);
        for (size_t p = 0; p < set.pages.size(); ++p) {
            const MapPage& page = set.pages[p];
            for (int y = page.y << page.level; y < (page.y + 1) << page.level; ++y)
                for (int x = page.x << page.level; x < (page.x + 1) << page.level; ++x) {
                    if (x >= width || y >= height) continue;
                    overlaps += owner[size_t(y * width + x)] >= 0 ? 1 : 0;
                    owner[size_t(y * width + x)] = int(p);
                }
        }
    }
    int at(int x, int y) const {
        return x < 0 || y < 0 || x >= width || y >= height ? -1 : owner[size_t(y * width + x)];
    }
    int width, height, overlaps = 0;
    std::vector<int> owner;
};

// A vertex as the shader computes it.
struct Vertex {
    glm::ivec2 step;  // of the whole map
    glm::vec2 rel_m;
    float height_m;
    auto key() const {
        return std::tuple(std::bit_cast<uint32_t>(rel_m.x), std::bit_cast<uint32_t>(rel_m.y),
                          std::bit_cast<uint32_t>(height_m));
    }
};

Vertex vertex(const PatchSet& set, const HeightMap& map, size_t p, glm::ivec2 k) {
    const shared::PatchInstance& patch = set.patches[p];
    const auto snapped = [](int v, uint32_t delta) { return (v >> delta) << delta; };
    if (k.x == 0) k.y = snapped(k.y, patch.lod_deltas & 15u);
    if (k.x == kPatchQuads) k.y = snapped(k.y, (patch.lod_deltas >> 8) & 15u);
    if (k.y == 0) k.x = snapped(k.x, (patch.lod_deltas >> 4) & 15u);
    if (k.y == kPatchQuads) k.x = snapped(k.x, (patch.lod_deltas >> 12) & 15u);
    const glm::ivec2 step = patch.origin + k * patch.stride;
    const glm::vec2 free_m = glm::vec2(step) * float(set.step_m) + glm::vec2(set.origin_rel_m);
    const glm::ivec2 texel = kPatchBorder + k * kPatchQuadTexels;
    const HeightPage* page = map.resident_page(set.pages[p]);
    return {step + set.origin_step, glm::min(free_m, glm::vec2(set.map_edge_rel_m)),
            page->heights_m[size_t(texel.y * kPatchTexels + texel.x)]};
}

// Side 0 west, 1 south, 2 east, 3 north.
std::vector<Vertex> edge(const PatchSet& set, const HeightMap& map, size_t p, int side) {
    std::vector<Vertex> vertices;
    for (int i = 0; i <= kPatchQuads; ++i) {
        const int far = side >= 2 ? kPatchQuads : 0;
        vertices.push_back(vertex(set, map, p, side % 2 == 0 ? glm::ivec2(far, i) : glm::ivec2(i, far)));
    }
    return vertices;
}

// Deltas by looking at every neighbouring square, and edges that coincide bit for bit.
void check_stitching(const PatchSet& set, const HeightMap& map) {
    const Cover cover(map.map(), set);
    ASSERT_EQ(cover.overlaps, 0);
    for (const int owner : cover.owner) ASSERT_GE(owner, 0);
    for (size_t p = 0; p < set.pages.size(); ++p) {
        const MapPage& page = set.pages[p];
        ASSERT_EQ(set.patches[p].slot, uint32_t(map.map().slot_of(page)));
        ASSERT_EQ(set.patches[p].stride, 1 << page.level);
        const int x0 = page.x << page.level, y0 = page.y << page.level, side = 1 << page.level;
        const glm::ivec2 beside[4] = {{x0 - 1, y0}, {x0, y0 - 1}, {x0 + side, y0}, {x0, y0 + side}};
        for (int s = 0; s < 4; ++s) {
            int delta = 0;
            std::set<int> neighbours;
            for (int i = 0; i < side; ++i) {
                const glm::ivec2 at = beside[s] + (s % 2 == 0 ? glm::ivec2(0, i) : glm::ivec2(i, 0));
                const int other = cover.at(at.x, at.y);
                if (other < 0) continue;
                neighbours.insert(other);
                delta = std::max(delta, set.pages[size_t(other)].level - page.level);
            }
            ASSERT_LE(delta, 4);
            ASSERT_EQ((set.patches[p].lod_deltas >> (4 * s)) & 15u, uint32_t(delta));
            const std::vector<Vertex> mine = edge(set, map, p, s);
            for (const int other : neighbours) {
                const int along = s % 2 == 0 ? 1 : 0;
                const std::vector<Vertex> theirs = edge(set, map, size_t(other), (s + 2) % 4);
                // The piece of the edge that both share, as sets of vertices by place.
                const int low = std::max(mine.front().step[along], theirs.front().step[along]);
                const int high = std::min(mine.back().step[along], theirs.back().step[along]);
                std::map<int, decltype(mine[0].key())> a, b;
                for (const Vertex& v : mine)
                    if (v.step[along] >= low && v.step[along] <= high) a[v.step[along]] = v.key();
                for (const Vertex& v : theirs)
                    if (v.step[along] >= low && v.step[along] <= high) b[v.step[along]] = v.key();
                ASSERT_EQ(a, b) << "level " << page.level << " beside " << set.pages[size_t(other)].level;
            }
        }
    }
}

// Points all over the patches that lie in the frustum belong to patches counted visible.
void check_culling(const PatchSet& set, const HeightMap& map, const PatchView& view) {
    for (size_t p = size_t(set.visible_count); p < set.patches.size(); ++p)
        for (int y = 0; y < kPatchQuads; ++y)
            for (int x = 0; x < kPatchQuads; ++x) {
                const Vertex a = vertex(set, map, p, {x, y}), b = vertex(set, map, p, {x + 1, y});
                const Vertex c = vertex(set, map, p, {x + 1, y + 1});
                for (int k = 0; k < 4; ++k) {
                    const float wa = k == 0 ? 1 : 0.3f,
                                wb = k == 1   ? 0.7f
                                     : k == 0 ? 0
                                              : 0.35f,
                                wc = 1 - wa - wb;
                    const glm::vec2 rel = a.rel_m * wa + b.rel_m * wb + c.rel_m * wc;
                    const double z =
                        double(a.height_m * wa + b.height_m * wb + c.height_m * wc) - view.camera_m.z;
                    const glm::dvec4 clip = view.clip_from_rel * glm::dvec4(rel, z, 1);
                    const bool seen = clip.w > 0 && std::abs(clip.x) <= clip.w &&
                                      std::abs(clip.y) <= clip.w && clip.z <= clip.w;
                    ASSERT_FALSE(seen);
                }
            }
}

TEST(PatchTree, AnyCacheGivesOneWatertightCover) {
    for (const int refine : {0, 2}) {
        MapFixture ground({.samples_x = 900, .samples_y = 700, .height_spacing_m = 0.7, .refine = refine},
                          21);
        for (int i = 0; i < 4; ++i) ground.random_command();
        uint64_t frame = 0;
        std::set<uint64_t> cuts;
        int visible = 0, hidden = 0, deepest = 0;
        for (int i = 0; i < 60; ++i) {
            const auto map = cpu_map(ground.document(), ground.uniform(1, 144));
            for (int k = ground.uniform(1, 3); k > 0; --k) random_residency(*map, ground, frame);
            const PatchView view = random_view(ground);
            const PatchSet set = select_patches(*map, view);
            ASSERT_FALSE(set.patches.empty());
            check_stitching(set, *map);
            check_culling(set, *map, view);
            if (HasFatalFailure()) return;
            cuts.insert(set.cut_hash);
            visible += set.visible_count;
            hidden += int(set.patches.size()) - set.visible_count;
            for (const auto& patch : set.patches)
                for (int s = 0; s < 4; ++s)
                    deepest = std::max(deepest, int(patch.lod_deltas >> (4 * s) & 15u));
        }
        EXPECT_GT(cuts.size(), 15u);
        EXPECT_GT(visible, 100);
        EXPECT_GT(hidden, 100);
        EXPECT_GE(deepest, 2);
    }
}

// Only one corner is resident in depth: the distance alone would put level 0 beside the root's children.
TEST(PatchTree, NeighboursDifferByAWholeQuadAtMost) {
    MapFixture ground({.samples_x = 4097, .samples_y = 4097, .refine = 2}, 4);
    const auto map = cpu_map(ground.document(), 144);
    const int root = map->map().root().level;
    ASSERT_GE(root, 7);
    uint64_t frame = 0;
    // The pages around a vertical line through the map's middle, west of it only.
    for (int level = root - 1; level >= 0; --level) {
        const int middle = 1 << (root - 1 - level);
        for (int k = 0; k < 4; ++k)
            map->request({level, std::max(middle - 2 + (k & 1), 0), k >> 1}, float(level + 1));
        if (level == root - 1)
            for (int k = 0; k < 4; ++k) map->request({level, k & 1, k >> 1}, 100);
    }
    map->update_without_gpu(++frame, 144);
    PatchView view;
    view.camera_m = glm::dvec3(map->map().page_rect({root - 1, 0, 0}).max_x - 1, 1, 2);
    view.clip_from_rel = clip_from_rel(0, 0, 1, 1);
    view.split_distance = 4;
    const PatchSet set = select_patches(*map, view);
    check_stitching(set, *map);
    int deepest = 0, finest = root;
    for (size_t p = 0; p < set.patches.size(); ++p) {
        finest = std::min(finest, set.pages[p].level);
        for (int s = 0; s < 4; ++s)
            deepest = std::max(deepest, int(set.patches[p].lod_deltas >> (4 * s) & 15u));
    }
    const int most = int(std::log2(kPatchQuads));
    EXPECT_EQ(deepest, most);
    EXPECT_EQ(finest, root - 1 - most);  // beside a page of level root - 1
}

PatchSet settle(HeightMap& map, const PatchView& view, uint64_t& frame, int& frames) {
    for (frames = 0; frames < 1000; ++frames) {
        PatchSet set = select_patches(map, view);
        map.update_without_gpu(++frame, 4);
        if (!map.has_work()) return set;
    }
    ADD_FAILURE() << "never at rest";
    return {};
}

TEST(PatchTree, ACameraAtRestComesToRestWithTheFinestPagesBelowIt) {
    MapFixture ground({.samples_x = 1025, .samples_y = 1025, .refine = 2}, 4);
    for (const int slots : {144, 60, 8}) {
        const auto map = cpu_map(ground.document(), slots);
        uint64_t frame = 0;
        for (const glm::dvec2 at : {glm::dvec2(400, 300), glm::dvec2(900, 20), glm::dvec2(0, 1024)}) {
            PatchView view;
            view.camera_m = glm::dvec3(at, map->height_m(at.x, at.y) + 0.01);  // 1 cm above the ground
            view.clip_from_rel = clip_from_rel(0.7, -0.2, 1, 1.6);
            int frames = 0;
            const PatchSet set = settle(*map, view, frame, frames);
            EXPECT_LT(frames, 120);
            check_stitching(set, *map);
            check_culling(set, *map, view);
            if (slots < 60) continue;
            bool finest = false;
            for (const MapPage& page : set.pages)
                finest = finest || (page.level == 0 && map->map().page_rect(page).contains(
                                                           std::min(at.x, 1023.9), std::min(at.y, 1023.9)));
            EXPECT_TRUE(finest);
        }
    }
}

TEST(PatchTree, LevelLimitsAreKept) {
    MapFixture ground({.samples_x = 500, .samples_y = 500, .refine = 1}, 4);
    const auto map = cpu_map(ground.document(), 144);
    uint64_t frame = 0;
    int frames = 0;
    PatchView view;
    view.camera_m = {100, 100, 30};
    view.clip_from_rel = clip_from_rel(0.7, -0.2, 1, 1.6);
    view.min_level = 2;
    for (const MapPage& page : settle(*map, view, frame, frames).pages) EXPECT_GE(page.level, 2);
    view.max_level = 2;
    for (const MapPage& page : settle(*map, view, frame, frames).pages) EXPECT_EQ(page.level, 2);
}

TEST(PatchTree, TheFarCornerOfTheLargestMapIsWatertight) {
    // Base samples 8 m apart, so that the map is quick to make; pages down to 0.5 m.
    MapFixture ground(
        {.samples_x = 2101, .samples_y = 2101, .height_spacing_m = 8, .refine = 4, .index_spacing_m = 16}, 4);
    const auto map = cpu_map(ground.document(), 144);
    uint64_t frame = 0;
    for (const double height_m : {0.01, 500.0, 10'000.0}) {
        const glm::dvec2 at(16'799.5, 16'799.2);
        PatchView view;
        view.camera_m = glm::dvec3(at, map->height_m(at.x, at.y) + height_m);
        view.clip_from_rel = clip_from_rel(3.9, -0.5, 1, 1.6);  // looking back over the map
        int frames = 0;
        const PatchSet set = settle(*map, view, frame, frames);
        check_stitching(set, *map);
        check_culling(set, *map, view);
        const glm::dvec3 low = glm::dvec3(0, 0, map->height_m(0, 0)) - view.camera_m;
        for (size_t p = 0; p < set.pages.size(); ++p) {
            if (set.pages[p].x != 0 || set.pages[p].y != 0) continue;
            const Vertex v = vertex(set, *map, p, {0, 0});
            EXPECT_NEAR(double(v.rel_m.x), low.x, 0.002);
            EXPECT_NEAR(double(v.rel_m.y), low.y, 0.002);
        }
    }
}

TEST(PatchTree, AnEmptyCacheDrawsNothingAndAsksForTheRoot) {
    MapFixture ground({});
    const auto map = cpu_map(ground.document(), 10);
    EXPECT_TRUE(select_patches(*map, {}).patches.empty());
    map->update_without_gpu(1, 1);
    EXPECT_EQ(select_patches(*map, {}).patches.size(), 1u);
}

TEST(PatchTree, AShadowsPatchesAreThoseItsSquareSees) {
    MapFixture ground({.samples_x = 1025, .samples_y = 1025, .refine = 2}, 4);
    const auto map = cpu_map(ground.document(), 144);
    uint64_t frame = 0;
    int frames = 0;
    PatchView view;
    view.camera_m = {400, 300, 10};
    view.clip_from_rel = clip_from_rel(0.7, -0.2, 1, 1.6);
    const PatchSet set = settle(*map, view, frame, frames);
    const double half = 40;  // straight from above
    const glm::dmat4 from_above =
        glm::transpose(glm::dmat4(glm::dvec4(1 / half, 0, 0, 0), glm::dvec4(0, 1 / half, 0, 0),
                                  glm::dvec4(0, 0, 1e-4, 0.5), glm::dvec4(0, 0, 0, 1)));
    const auto seen = patches_in(set, *map, from_above);
    std::set<uint32_t> expected;
    for (uint32_t p = 0; p < set.pages.size(); ++p)
        if (map->map().page_rect(set.pages[p]).overlaps({360, 260, 440, 340})) expected.insert(p);
    EXPECT_EQ(std::set<uint32_t>(seen.begin(), seen.end()), expected);
    EXPECT_LT(seen.size(), set.patches.size());
}

}  // namespace
}  // namespace loam
