// The virtual texture on a device: pages composed, kept fresh by dirty rectangles, found through indirection,
// and equal to the same formulas evaluated directly.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "runtime/texture/decals.h"
#include "shaders/document/footprint_math.h"
#include "tests/gpu/texture_ask.h"
#include "tests/gpu/texture_world.h"

namespace {

using namespace loam;
using namespace loam::test;
using gpu::Access;
using TextureTest = gpu::GpuTest;

TEST_F(TextureTest, PagesAreComposedAndTheIndirectionFollowsTheTrees) {
    World w(small_desc(PageFormat::bc1x3));
    w.want_some_pages();
    w.run_frames(12);
    const auto s = w.texture->statistics();
    EXPECT_GE(s.resident_pages, 20u);
    EXPECT_EQ(s.missing_pages, 0u);
    EXPECT_EQ(s.live_sectors, 1u);
    const auto expected = w.texture->expected_indirection(), got = w.read_u32(w.texture->indirection());
    ASSERT_EQ(got.size(), expected.size());
    int wrong = 0, used = 0;
    for (size_t i = 0; i < got.size(); ++i)
        if (expected[i] != kUnusedIndirection) ++used, wrong += got[i] != expected[i];
    EXPECT_EQ(wrong, 0);
    EXPECT_GE(used, 64 * 64);
    EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
}

void random_edits(PageFormat format, int rounds, const std::vector<Channel>& channels = {}) {
    World w(small_desc(format), false, {.channels = channels});
    w.want_some_pages();
    w.run_frames(10);
    for (int round = 0; round < rounds; ++round) {
        for (int i = 0; i < 3; ++i) w.on_dirt(w.fixture.random_command());
        // Near the pages that are resident finely.
        FootprintsCommand prints;
        for (int i = 0; i < 2; ++i) {
            Footprint print;
            print.x_m = 64 + 20 + w.fixture.real(0, 2);
            print.y_m = 64 + 31 + w.fixture.real(0, 2);
            print.heading_rad = w.fixture.real(0, 6);
            prints.prints.push_back(print);
        }
        w.on_dirt(w.fixture.apply(prints));
        if (round % 3 == 1) {
            CraterCommand hot;
            hot.crater = {.x_m = 64 + 21 + w.fixture.real(-1, 1),
                          .y_m = 64 + 32,
                          .radius_m = w.fixture.real(0.3, 3),
                          .seed = uint32_t(round),
                          .heat = 0.9};
            w.on_dirt(w.fixture.apply(hot));
        }
        w.run_frames(1 + round % 3);
    }
    for (int i = 0; i < 200 && w.texture->statistics().dirty_pages > 0; ++i) w.run_frames(1);
    w.run_frames(2);
    ASSERT_EQ(w.texture->statistics().dirty_pages, 0u);
    EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    const auto s = w.texture->statistics();
    EXPECT_GT(s.rects_composed, s.pages_composed) << "rectangles, not pages, were composed again";
}

TEST_F(TextureTest, RandomEditsLeaveNoStaleTexelBc1) {
    random_edits(PageFormat::bc1x3, 8);
}
TEST_F(TextureTest, RandomEditsLeaveNoStaleTexelBc3) {
    random_edits(PageFormat::bc3x2, 6);
}
TEST_F(TextureTest, RandomEditsLeaveNoStaleTexelRgba8) {
    random_edits(PageFormat::rgba8, 6);
}

// Every texel that a print changes is drawn once, and hardly any other: whatever the level, the turn and the
// rectangle that is composed.
TEST_F(TextureTest, ThePartsOfAPrintCoverWhatItChangesOnce) {
    World w(small_desc(PageFormat::rgba8));
    const TextureLayout& layout = w.texture->layout();
    int changed = 0, drawn = 0, in_bounds = 0;
    for (int round = 0; round < 300; ++round) {
        const int depth = 5 + round % 4;
        PageId page{{true, 1, 1}, depth, 0, 0};
        const WorldRect sector = layout.square(PageId{{true, 1, 1}, 0, 0, 0});
        const Footprint print{.x_m = sector.min_x + w.fixture.real(0, 1) * sector.width(),
                              .y_m = sector.min_y + w.fixture.real(0, 1) * sector.height(),
                              .heading_rad = round % 7 == 0 ? 0.0 : w.fixture.real(0, 6.3),
                              .length_m = w.fixture.real(0.1, 1.5),
                              .foot = round % 2,
                              .seed = uint32_t(round)};
        page.x = int((print.x_m - sector.min_x) / layout.page_side_m(page));
        page.y = int((print.y_m - sector.min_y) / layout.page_side_m(page));
        w.on_dirt(w.fixture.apply(FootprintsCommand{{print}}));
        const TexelRect rect = round % 3 == 0 ? TexelRect{64, 40, 176, 200} : TexelRect{0, 0, 256, 256};
        DecalList list;
        {
            const auto lock = w.document().read_lock();
            add_decals(w.document(), *w.layers, LayerTier::whole, layout, page, rect, {rect.x0, rect.y0},
                       list);
        }
        w.fixture.apply(UndoCommand{});
        std::vector<int> times(256 * 256);
        for (const shared::DecalInstance& mark : list.marks)
            for (int y = mark.quad_min.y; y < mark.quad_min.y + mark.quad_size.y; ++y)
                for (int x = mark.quad_min.x; x < mark.quad_min.x + mark.quad_size.x; ++x) {
                    ASSERT_TRUE(x >= rect.x0 && x < rect.x1 && y >= rect.y0 && y < rect.y1);
                    ++times[size_t(y) * 256 + size_t(x)];
                }
        const WorldRect square = layout.square(page), bounds = bounds_of(print);
        const double texel_m = layout.texel_m(page);
        const glm::vec2 heading(std::sin(print.heading_rad), std::cos(print.heading_rad));
        for (int y = rect.y0; y < rect.y1; ++y)
            for (int x = rect.x0; x < rect.x1; ++x) {
                const glm::dvec2 at(square.min_x + (x + 0.5 - kPageBorder) * texel_m,
                                    square.min_y + (y + 0.5 - kPageBorder) * texel_m);
                const glm::vec2 offset = (at - glm::dvec2(print.x_m, print.y_m)) / print.length_m;
                const auto mark = shared::footprint_mark(shared::footprint_local(offset, heading), print.foot,
                                                         print.seed, float(texel_m / print.length_m / 2));
                const int count = times[size_t(y) * 256 + size_t(x)];
                ASSERT_LE(count, 1);
                ASSERT_TRUE(count == 1 || (mark.around == 0 && mark.pressed == 0)) << x << ", " << y;
                changed += mark.around > 0;
                drawn += count;
                in_bounds += bounds.contains(at.x, at.y);
            }
    }
    EXPECT_GT(changed, 50'000);
    EXPECT_LT(drawn, 0.9 * in_bounds);
}

// A print of 30 cm is nothing in pages of half a metre a texel, a crater of 4 m something in most.
TEST_F(TextureTest, PagesTooCoarseToShowADecalStayAsTheyAre) {
    World w(small_desc(PageFormat::rgba8));
    w.want_some_pages();
    w.run_frames(10);
    const auto dirtied_by = [&](const Dirt& dirt) {
        const auto before = w.texture->statistics();
        w.on_dirt(dirt);
        w.run_frames(3);
        EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
        return w.texture->statistics().pages_dirtied - before.pages_dirtied;
    };
    FootprintsCommand prints;
    prints.prints.push_back({.x_m = 64 + 20.5, .y_m = 64 + 31.5, .heading_rad = 0.7});
    const Dirt print = w.fixture.apply(prints);
    EXPECT_EQ(print.texture_size_m, size_m(prints.prints[0]));
    const auto few = dirtied_by(print);
    EXPECT_GT(few, 0u);
    const auto undone = w.fixture.apply(UndoCommand{});
    EXPECT_EQ(undone.texture_size_m, print.texture_size_m) << "the journal keeps it";
    EXPECT_EQ(dirtied_by(undone), few);
    Dirt of_no_size = print;
    of_no_size.texture_size_m = INFINITY;
    EXPECT_GT(dirtied_by(of_no_size), few) << "there are coarser pages, which the print left out";
}

TEST_F(TextureTest, DirtThatIsNotToldIsFound) {
    World w(small_desc(PageFormat::bc1x3));
    w.want_some_pages();
    w.run_frames(10);
    w.on_dirt(w.fixture.crater(64 + 21, 64 + 32, 2), false);
    w.run_frames(3);
    EXPECT_GT(need(w.texture->count_stale_pages(*w.ring)), 0u);
}

std::vector<Query> places_near_camera(World& w, float log2_texel) {
    std::vector<Query> queries;
    for (int i = 0; i < 2000; ++i)
        queries.push_back(
            {{float(w.fixture.real(-1.4, 0.4)), float(w.fixture.real(-1.4, 0.4))}, log2_texel, 0});
    return queries;
}

// The same place through the page cache and evaluated directly. rgba8: what is left is the cache's own
// sampling and rounding.
TEST_F(TextureTest, TheCacheShowsWhatDirectEvaluationGives) {
    World w(small_desc(PageFormat::rgba8), true);
    w.want_some_pages();
    w.run_frames(14);
    const float finest = std::log2(1.0f / float(kPagePayload));
    const auto queries = places_near_camera(w, finest);
    // The direct path reads index pages: keep the finest one here resident.
    const auto cached = ask(w, "test/vt_sample.comp", queries, false);
    const auto direct = ask(w, "test/direct.comp", queries, true);
    double worst_albedo = 0, worst_rest = 0, mean = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        EXPECT_GE(cached[i].sector, 1.0f) << "from the live sector";
        const glm::vec4 d = glm::abs(cached[i].albedo_gloss - direct[i].albedo_gloss);
        const glm::vec4 e = glm::abs(cached[i].normal_occlusion_metal - direct[i].normal_occlusion_metal);
        worst_albedo = std::max({worst_albedo, double(d.x), double(d.y), double(d.z)});
        worst_rest = std::max({worst_rest, double(d.w), double(e.x), double(e.y), double(e.z), double(e.w)});
        mean += d.x + d.y + d.z;
    }
    mean /= double(queries.size()) * 3;
    std::printf("cache against direct: albedo worst %.4f mean %.5f, rest worst %.4f\n", worst_albedo, mean,
                worst_rest);
    EXPECT_LT(mean, 0.003);
    EXPECT_LT(worst_albedo, 0.03);
    EXPECT_LT(worst_rest, 0.04);
}

// Of one layer everywhere: what is left is how well a format holds one value a channel. Five bits are 4.1/255
// at worst, but the encoder's palette lies denser; eight-bit channels are within rounding.
class FormatTest : public gpu::GpuTest, public ::testing::WithParamInterface<PageFormat> {};
INSTANTIATE_TEST_SUITE_P(Formats, FormatTest,
                         ::testing::Values(PageFormat::rgba8, PageFormat::bc1x3, PageFormat::bc1x4,
                                           PageFormat::bc3x2));

TEST_P(FormatTest, AFlatColourIsSampledWithinTheFormatsError) {
    World w(small_desc(GetParam()), true);
    // One layer everywhere: grass.
    PaintCommand paint;
    paint.dabs = {{150, 130}};
    paint.radius_m = 1000;
    paint.hardness = 1;
    paint.layer = "grass";
    paint.tint = glm::dvec3(1);
    w.on_dirt(w.fixture.apply(paint));
    w.want_some_pages();
    w.run_frames(14);
    const LayerTextures grass = make_layer(1, true);
    const auto answers = ask(w, "test/vt_sample.comp", places_near_camera(w, std::log2(1.0f / 248)), false);
    for (int c = 0; c < 3; ++c) {
        const double s = grass.albedo_reveal[0][size_t(c)] / 255.0;
        const double linear = s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
        for (const Answer& a : answers)
            ASSERT_NEAR(std::sqrt(a.albedo_gloss[c]), std::sqrt(linear), 3.0 / 255);
    }
    const auto& surface = grass.normal_gloss_occlusion[0];
    for (const Answer& a : answers) {
        ASSERT_NEAR(a.albedo_gloss.w, surface[2] / 255.0, 3.0 / 255);
        ASSERT_NEAR(a.normal_occlusion_metal.x, 0, 0.005);
        ASSERT_NEAR(a.normal_occlusion_metal.y, 0, 0.005);
        ASSERT_NEAR(a.normal_occlusion_metal.z, surface[3] / 255.0, 3.0 / 255);
        ASSERT_NEAR(a.normal_occlusion_metal.w, grass.metalness[0][0] / 255.0, 3.0 / 255);
    }
}

const std::vector<Channel> kAllChannels = {Channel::glint, Channel::scattering, Channel::emissive,
                                           Channel::thermal};

struct ChannelCase {
    PageFormat format;
    std::vector<Channel> channels;
};
class ChannelTest : public gpu::GpuTest, public ::testing::WithParamInterface<ChannelCase> {};
INSTANTIATE_TEST_SUITE_P(Formats, ChannelTest,
                         ::testing::Values(ChannelCase{PageFormat::rgba8, kAllChannels},
                                           ChannelCase{PageFormat::bc1x4, kAllChannels},
                                           ChannelCase{PageFormat::bc1x4, {Channel::thermal, Channel::glint}},
                                           ChannelCase{PageFormat::bc1x3, {Channel::emissive}}));

TEST_P(ChannelTest, RandomEditsLeaveNoStaleTexel) {
    random_edits(GetParam().format, 5, GetParam().channels);
}

// Channels decoded from pages against the same formulas without pages. Channels that the map has not got read
// 0. The control: a channel mistaken for another is far outside the tolerance, as the layers' amounts differ.
TEST_P(ChannelTest, PagesShowWhatDirectEvaluationGives) {
    const auto& [format, channels] = GetParam();
    World w(small_desc(format), true, {.channels = channels});
    ASSERT_EQ(w.texture->textures().count, channels.size() > 1 ? 4 : 3);
    w.want_some_pages();
    w.run_frames(14);
    const auto queries = places_near_camera(w, std::log2(1.0f / float(kPagePayload)));
    const auto cached = ask(w, "test/vt_sample.comp", queries, false);
    const auto direct = ask(w, "test/direct.comp", queries, true);
    for (size_t c = 0; c <= kChannelGlint; ++c) {  // depth is no light: parallax_test
        const bool held = std::find(channels.begin(), channels.end(), Channel(c)) != channels.end();
        double own = 0,
               other = 1;  // mean errors: against this channel, and against the most alike of the others
        for (size_t d = 0; d <= kChannelGlint; ++d) {
            double mean = 0;
            for (size_t i = 0; i < queries.size(); ++i)
                mean += std::abs(cached[i].channels[int(c)] - (held ? direct[i].channels[int(d)] : 0.0f));
            mean /= double(queries.size());
            if (d == c)
                own = mean;
            else
                other = std::min(other, mean);
        }
        if (!held) {
            EXPECT_EQ(own, 0) << kChannelNames[c];
            continue;
        }
        // Found 0.0015 with eight bits and 0.0045 in blocks at worst; 0.11 at least against another channel.
        EXPECT_LT(own, format == PageFormat::rgba8 ? 0.003 : 0.01) << kChannelNames[c];
        EXPECT_GT(other, 0.05) << kChannelNames[c];
    }
}

TEST_F(TextureTest, AFormatWithoutRoomForTheMapsChannelsIsRefused) {
    World w(small_desc(PageFormat::rgba8), true, {.channels = {Channel::scattering, Channel::glint}});
    for (const PageFormat format : {PageFormat::bc1x3, PageFormat::bc3x2}) {
        auto refused =
            VirtualTexture::create(gpu::test_device(), w.document(), *w.index, *w.layers, small_desc(format));
        ASSERT_FALSE(refused.ok());
        EXPECT_NE(refused.message().find("use bc1x4 or rgba8"), std::string::npos) << refused.message();
    }
}

TEST_F(TextureTest, Timing) {
    World w({.pages_per_side = 13, .indirection_size = 512, .format = PageFormat::bc1x3, .budget_pages = 4});
    w.want_some_pages();
    w.run_frames(12);
    const auto timed = [&](auto&& body, int repeats) {
        double best = 1e9;
        for (int i = 0; i < repeats; ++i) {
            const auto start = std::chrono::steady_clock::now();
            body();
            best = std::min(
                best,
                std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        }
        return best;
    };
    const auto one_frame = [&] {
        gpu::Frame* frame = need(w.ring->begin());
        w.record(frame->commands);
        need(w.ring->finish(*frame));
    };
    const double idle = timed(one_frame, 10);
    const double print = timed(
        [&] {
            FootprintsCommand prints;
            Footprint p;
            p.x_m = 64 + 20.5;
            p.y_m = 64 + 31.5;
            p.seed = 3;
            prints.prints.push_back(p);
            w.on_dirt(w.fixture.apply(prints));
            one_frame();
        },
        8);
    const WorldRect page_square{64 + 20, 64 + 31, 64 + 21, 64 + 32};
    const double page = timed(
        [&] {
            const WorldRect rects[] = {page_square};
            w.texture->on_dirt(rects, INFINITY);
            one_frame();
        },
        8);
    std::printf("idle frame %.2f ms, a footprint %.2f ms, a 1 m page with its ancestors %.2f ms\n", idle,
                print, page);
}

}  // namespace
