// The indirection texture on a device under any traffic: an eye that wanders and jumps, images that grow and
// shrink, pages that come, are dirtied and give way; at all times it is what the quad trees say, texel for
// texel, and no page in a tree is one that is being composed or has been recycled. (sector_set_test.cpp does
// the same for the trees alone.)
#include <algorithm>
#include <cmath>

#include "tests/gpu/texture_world.h"

namespace {

using namespace loam;
using namespace loam::test;
using gpu::Access;
using TextureTraffic = gpu::GpuTest;

constexpr int kSteps = 2'500;                          // sector_set_test.cpp takes 10,000 without a device
constexpr int kCompareAlways = 30, kCompareEach = 50;  // steps: reading back is the slow part
constexpr double kLowest_m = 0.4, kHighest_m = 60;     // of the eye

VirtualTextureDesc traffic_desc() {
    // Small on all sides, so that everything gives way to something: 36 pages, 64² indirection texels for
    // up to nine sectors.
    return {.pages_per_side = 6,
            .indirection_size = 64,
            .format = PageFormat::rgba8,
            .max_live_sectors = 9,
            .budget_pages = 1};
}

int differing_texels(World& w) {
    const auto expected = w.texture->expected_indirection(), got = w.read_u32(w.texture->indirection());
    LOAM_CHECK(got.size() == expected.size(), "one expected word a texel");
    int wrong = 0;
    for (size_t i = 0; i < got.size(); ++i)
        wrong += expected[i] != kUnusedIndirection && got[i] != expected[i];
    return wrong;
}

// Pages of the images there are, at any depth, some of them near the eye.
std::vector<PageId> random_pages(World& w) {
    std::vector<PageId> pages;
    const int sectors_x = int(w.document().bounds().max_x / kSectorSize_m);
    const int sectors_y = int(w.document().bounds().max_y / kSectorSize_m);
    for (int i = 0; i < 5; ++i) {
        PageId page;
        const bool live = w.fixture.uniform(0, 2) > 0;
        page.image = live ? ImageId{true, w.fixture.uniform(0, sectors_x), w.fixture.uniform(0, sectors_y)}
                          : ImageId{};
        page.depth = w.fixture.uniform(0, live ? 5 : w.texture->layout().default_log2_width);
        page.x = w.fixture.uniform(0, (1 << page.depth) - 1);
        page.y = w.fixture.uniform(0, (1 << page.depth) - 1);
        pages.push_back(page);
    }
    return pages;
}

void wander(World& w) {
    glm::dvec3& eye = w.view.camera_m;
    const WorldRect bounds = w.document().bounds();
    if (w.fixture.uniform(0, 99) == 0)
        eye = {w.fixture.real(0, bounds.max_x), w.fixture.real(0, bounds.max_y),
               kLowest_m * std::pow(kHighest_m / kLowest_m, w.fixture.real(0, 1))};
    eye.x = std::clamp(eye.x + w.fixture.real(-3, 3), bounds.min_x, bounds.max_x);
    eye.y = std::clamp(eye.y + w.fixture.real(-3, 3), bounds.min_y, bounds.max_y);
    eye.z = std::clamp(eye.z * w.fixture.real(0.93, 1.075), kLowest_m, kHighest_m);
}

TEST_F(TextureTraffic, TheIndirectionIsAlwaysWhatTheTreesSay) {
    World w(traffic_desc(), true);
    w.view.pixels_per_radian = 300;
    int wrong = 0, compared = 0;
    uint64_t most_live = 0, capped = 0;
    for (int step = 0; step < kSteps; ++step) {
        wander(w);
        if (step % 12 == 0) w.texture->request_pages(random_pages(w));
        if (step % 9 == 0)
            w.on_dirt(w.fixture.uniform(0, 3) > 0
                          ? w.fixture.crater(w.view.camera_m.x, w.view.camera_m.y, w.fixture.real(0.2, 1))
                          : w.fixture.random_command());
        w.run_frames(1);
        const std::string fault = w.texture->tree_fault();
        ASSERT_EQ(fault, "") << "step " << step;
        const auto statistics = w.texture->statistics();
        most_live = std::max<uint64_t>(most_live, statistics.live_sectors);
        capped += statistics.capped_images > 0;
        if (step >= kCompareAlways && step % kCompareEach != 0) continue;
        wrong += differing_texels(w);
        ++compared;
    }
    EXPECT_EQ(wrong, 0) << "in " << compared << " comparisons";
    const auto end = w.texture->statistics();
    EXPECT_GT(most_live, 4u);
    EXPECT_GT(capped, 50u) << "the indirection texture was full now and then";
    EXPECT_GT(end.pages_composed, 10u * end.capacity_pages) << "every place was used again and again";
    EXPECT_GT(end.pages_dirtied, 1000u);
    for (int i = 0; i < 300 && w.texture->statistics().dirty_pages > 0; ++i) w.run_frames(1);
    w.run_frames(2);
    EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    EXPECT_EQ(differing_texels(w), 0);
}

TEST_F(TextureTraffic, AWrongTexelIsSeen) {
    World w(traffic_desc(), true);
    w.want_some_pages();
    w.run_frames(12);
    ASSERT_EQ(differing_texels(w), 0);
    auto fill = need(gpu::Pipeline::create(
        gpu::test_device(), gpu::ComputeDesc{.name = "wrong fill",
                                             .shader = "texture/indirection.comp",
                                             .bindings = {gpu::storage_image(0), gpu::storage_buffer(1)},
                                             .constants = {}}));
    gpu::Frame* frame = need(w.ring->begin());
    const auto slice = w.ring->upload(sizeof(shared::IndirectionFill));
    *slice.as<shared::IndirectionFill>() = {1, 2, 1, 0x01020304u};
    {
        auto pass = frame->commands.pass("wrong fill", {{w.texture->indirection(), Access::compute_storage}});
        frame->commands.bind(fill, {{0, w.texture->indirection().mip_view(0)},
                                    {1, *slice.buffer, slice.offset, sizeof(shared::IndirectionFill)}});
        frame->commands.dispatch(1);
    }
    need(w.ring->finish(*frame));
    EXPECT_EQ(differing_texels(w), 1);
}

}  // namespace
