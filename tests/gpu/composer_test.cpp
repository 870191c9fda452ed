// Composition against a plain composer (plain_composer.h); and the round trip of feedback until nothing is
// missing.
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include <glm/mat4x4.hpp>

#include "runtime/document/imagery.h"
#include "shaders/frame/frame_io.h"
#include "tests/gpu/plain_composer.h"
#include "tests/gpu/texture_ask.h"
#include "tests/gpu/texture_world.h"

namespace {

using namespace loam;
using namespace loam::test;
using gpu::Access;
using ComposerTest = gpu::GpuTest;

struct Difference {
    double worst = 0, mean = 0;
    int64_t above_one = 0, count = 0;
};

struct Compared {
    Difference difference;
    std::set<int> turns;  // of the reference
};

GroundSettings everything_on() {
    return {.distortion_amplitude_m = 0.45, .distortion_period_m = 11.3, .tile_hiding = true};
}

// Of compare_pages' pages the coarser ones have some or all of it.
GroundSettings with_vista(GroundSettings ground) {
    ground.vista_scale = 6;
    ground.vista_distance_m = 20;
    return ground;
}

PlainWorld plain_world(World& w, const RandomMap& map, bool flat_layers) {
    PlainWorld plain{.map = map, .tiles_m = w.layers->tiles_m, .ground = w.document().settings().ground};
    const std::vector<LayerEntry>& entries = w.document().settings().layers;
    for (int i = 0; i < int(entries.size()); ++i) {
        plain.layers.push_back(make_layer(i + 1, flat_layers));
        if (const auto& blend = entries[size_t(i)].blend)
            plain.transitions[i] = {w.document().layer_index(blend->from),
                                    w.document().layer_index(blend->to), blend->threshold};
    }
    return plain;
}

// Between layers of all reveals, at both ends and between them; and one whose place in the order is above
// all.
std::vector<LayerEntry> some_transitions() {
    const auto transition = [](const char* name, const char* from, const char* to, double threshold) {
        return LayerEntry{.name = name, .file = "", .blend = LayerEntry::Blend{from, to, threshold}};
    };
    return {transition("none", "grass", "layer 4", 0), transition("some", "dirt", "grass", 0.35),
            transition("half", "grass", "scree", 0.5), transition("whole", "scree", "layer 3", 1),
            transition("back", "layer 5", "dirt", 0.7)};
}

// All texels of some pages, borders included. `believed`: what the reference is told of the ground.
Compared compare_pages(bool flat_layers, const GroundSettings& ground = {},
                       const std::optional<GroundSettings>& believed = {},
                       const std::vector<LayerEntry>& transitions = {}, double threshold_error = 0,
                       bool compressed_tints = true, bool believed_compressed = true) {
    World w(small_desc(PageFormat::rgba8), flat_layers,
            {.layers = 9, .ground = ground, .transitions = transitions},
            {.compressed_tints = compressed_tints});
    RandomMap map = write_random_map(w);
    map.compressed_tints = map.compressed_tints && believed_compressed;
    PlainWorld plain = plain_world(w, map, flat_layers);
    if (believed) plain.ground = *believed;
    for (auto& [layer, transition] : plain.transitions) transition.threshold += threshold_error;
    w.want_some_pages();
    w.run_frames(14);
    const int side = small_desc(PageFormat::rgba8).pages_per_side;
    std::array<std::vector<uint32_t>, 3> atlas;
    for (int which = 0; which < 3; ++which) atlas[size_t(which)] = w.read_u32(w.texture->atlas(which));
    const int finest = w.texture->layout().default_log2_width;
    struct Asked {
        PageId page;
        int index_level;
    };
    const Asked pages[] = {{{{true, 1, 1}, 6, 20, 31}, 0},
                           {{{true, 1, 1}, 6, 21, 32}, 0},
                           {{{true, 1, 1}, 3, 2, 3}, 0},
                           {{{}, finest, 1, 1}, 0},
                           {{{}, finest - 1, 0, 0}, 1}};
    Compared result;
    Difference& d = result.difference;
    for (const auto& [page, level] : pages) {
        const int place = w.texture->place_of(page);
        EXPECT_GE(place, 0) << "depth " << page.depth;
        if (place < 0) continue;
        const WorldRect square = w.texture->layout().square(page);
        const double texel_m = w.texture->layout().texel_m(page);
        for (int y = 0; y < kPageTexels; ++y)
            for (int x = 0; x < kPageTexels; ++x) {
                const glm::dvec2 world(square.min_x + (x - kPageBorder + 0.5) * texel_m,
                                       square.min_y + (y - kPageBorder + 0.5) * texel_m);
                const auto wanted = stored_texel(plain_material(plain, world, texel_m, level, &result.turns));
                const size_t at = size_t(place / side * kPageTexels + y) * size_t(side * kPageTexels) +
                                  size_t(place % side * kPageTexels + x);
                for (size_t which = 0; which < 3; ++which)
                    for (size_t c = 0; c < 3; ++c) {
                        const double error =
                            std::abs(double(atlas[which][at] >> (8 * c) & 0xff) - wanted[which][c]);
                        d.worst = std::max(d.worst, error);
                        d.mean += error;
                        d.above_one += error > 1;
                        ++d.count;
                    }
            }
    }
    d.mean /= double(std::max<int64_t>(d.count, 1));
    std::printf("%s layers%s%s%s: worst %.2f/255, mean %.3f/255, above 1/255: %.4f %%\n",
                flat_layers ? "flat" : "rough", ground.tile_hiding ? ", tile hiding" : "",
                ground.distortion_amplitude_m > 0 ? ", distortion" : "",
                transitions.empty() ? "" : ", transitions", d.worst, d.mean,
                100.0 * double(d.above_one) / double(std::max<int64_t>(d.count, 1)));
    return result;
}

// Rounding to a byte is half a step; the tint's cubic (ompv.h) is the rest.
TEST_F(ComposerTest, FlatLayersAreWithinOneStepOfThePlainComposer) {
    for (const GroundSettings& ground :
         {GroundSettings{}, everything_on(), with_vista({}), with_vista(everything_on())}) {
        const Difference d = compare_pages(true, ground).difference;
        EXPECT_GT(d.count, 0);
        EXPECT_LE(d.worst, 1.0);
        EXPECT_EQ(d.above_one, 0);
    }
}

// Where the device samples no BC1. The control: tints believed exact that are blocks.
TEST_F(ComposerTest, TintsNeedNoCompression) {
    const Difference d = compare_pages(true, {}, {}, {}, 0, false).difference;
    EXPECT_LE(d.worst, 1.0);
    EXPECT_EQ(d.above_one, 0);
    EXPECT_GT(compare_pages(true, {}, {}, {}, 0, true, false).difference.worst, 5);
}

// A device filters with 8 bits of fraction at least, and a reveal's error counts four times where it cuts an
// edge.
TEST_F(ComposerTest, RoughLayersAreWithinTheFiltersTolerance) {
    for (const GroundSettings& ground :
         {GroundSettings{}, everything_on(), with_vista({}), with_vista(everything_on())}) {
        const Compared compared = compare_pages(false, ground);
        const Difference& d = compared.difference;
        EXPECT_GT(d.count, 0);
        EXPECT_LE(d.worst, 3.0);
        EXPECT_LT(d.mean, 0.5);
        EXPECT_LT(double(d.above_one), 0.02 * double(d.count));
        EXPECT_EQ(compared.turns.size(), ground.tile_hiding ? 16u : 1u) << "every turn was seen";
    }
}

// Imagery of random colours and cover, finer than any page, with levels of its own.
void lay_imagery(World& w, PlainWorld& plain, double strength, double distance_m) {
    ProjectSettings settings = w.document().settings();
    const ImageryShape shape = imagery_shape(settings, 0.01);
    plain.imagery_width = shape.width;
    plain.imagery_height = shape.height;
    for (int i = 0; i < shape.width * shape.height; ++i) {
        const auto byte = [&] { return uint8_t(w.fixture.uniform(0, 255)); };
        plain.imagery_texels.push_back(
            {byte(), byte(), byte(), uint8_t(w.fixture.uniform(0, 3) == 0 ? 0 : byte())});
    }
    std::filesystem::create_directories(w.document().folder() / "imagery");
    auto writer = need(ImageryWriter::create(w.document().folder() / "imagery/random.imagery", shape));
    std::vector<glm::vec4> row(size_t(shape.width));
    for (int y = shape.height - 1; y >= 0; --y) {
        for (int x = 0; x < shape.width; ++x) {
            const auto& t = plain.imagery_texels[size_t(y) * size_t(shape.width) + size_t(x)];
            const double cover = t[3] / 255.0;
            row[size_t(x)] = glm::vec4(linear_of(t[0] / 255.0) * cover, linear_of(t[1] / 255.0) * cover,
                                       linear_of(t[2] / 255.0) * cover, cover);
        }
        need(writer->append_row(row));
    }
    need(writer->finish());
    settings.imagery = plain.imagery = {"imagery/random.imagery", strength, distance_m};
    need(w.document().change_settings(settings));
    need(w.index->take_settings());
    need(w.layers->take_settings(*w.ring, settings));
    need(w.texture->take_settings());
}

// Pages of full weight, of some and of none, where the layers are known to a byte; laid over a living world.
TEST_F(ComposerTest, ImageryIsWithinOneStepOfThePlainComposer) {
    World w(small_desc(PageFormat::rgba8), true, {.layers = 9, .ground = everything_on()});
    const RandomMap map = write_random_map(w);
    PlainWorld plain = plain_world(w, map, true);
    const int side = small_desc(PageFormat::rgba8).pages_per_side;
    // Its place in the texture may be another one later.
    const auto root_page = [&] {
        const int place = w.texture->place_of({{}, 0, 0, 0});
        EXPECT_GE(place, 0);
        const std::vector<uint32_t> all = w.read_u32(w.texture->atlas(0));
        std::vector<uint32_t> page;
        for (int y = 0; y < kPageTexels; ++y) {
            const auto row = all.begin() + ptrdiff_t(place / side * kPageTexels + y) * side * kPageTexels +
                             ptrdiff_t(place % side) * kPageTexels;
            page.insert(page.end(), row, row + kPageTexels);
        }
        return page;
    };
    w.want_some_pages();
    w.run_frames(40);
    const std::vector<uint32_t> bare = root_page();
    lay_imagery(w, plain, 0.8, 60);
    w.want_some_pages();
    w.run_frames(40);
    EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    EXPECT_NE(root_page(), bare);
    const std::vector<uint32_t> atlas = w.read_u32(w.texture->atlas(0));
    const int finest = w.texture->layout().default_log2_width;
    int weighted = 0;
    for (const auto& [page, level] : {std::pair<PageId, int>{{{true, 1, 1}, 6, 20, 31}, 0},
                                      {{{true, 1, 1}, 1, 0, 0}, 0},
                                      {{{true, 1, 1}, 0, 0, 0}, 0},
                                      {{{}, finest - 1, 0, 0}, 1},
                                      {{{}, finest - 2, 0, 0}, 2}}) {
        const int place = w.texture->place_of(page);
        ASSERT_GE(place, 0) << "depth " << page.depth;
        const WorldRect square = w.texture->layout().square(page);
        const double texel_m = w.texture->layout().texel_m(page);
        double worst = 0, weight = 0;
        for (int y = 0; y < kPageTexels; ++y)
            for (int x = 0; x < kPageTexels; ++x) {
                const glm::dvec2 world(square.min_x + (x - kPageBorder + 0.5) * texel_m,
                                       square.min_y + (y - kPageBorder + 0.5) * texel_m);
                weight = std::max(weight, plain_imagery(plain, world, texel_m, level).w);
                const auto wanted = stored_texel(plain_material(plain, world, texel_m, level));
                const uint32_t got =
                    atlas[size_t(place / side * kPageTexels + y) * size_t(side * kPageTexels) +
                          size_t(place % side * kPageTexels + x)];
                for (size_t c = 0; c < 3; ++c)
                    worst = std::max(worst, std::abs(double(got >> (8 * c) & 0xff) - wanted[0][c]));
            }
        std::printf("imagery, texel %.0f mm, level %d: weight up to %.2f, worst %.2f/255\n", texel_m * 1000,
                    level, weight, worst);
        // The imagery's levels are bytes; dark ones are a step and a half of a page's root.
        EXPECT_LE(worst, level == 0 ? 1.01 : 2.0);
        weighted += weight > 0;
    }
    EXPECT_GE(weighted, 3);
    EXPECT_LT(weighted, 5) << "near the camera it costs nothing and shows nothing";
    // Taken away, nothing of it is left.
    ProjectSettings settings = w.document().settings();
    settings.imagery = {};
    need(w.document().change_settings(settings));
    need(w.index->take_settings());
    need(w.layers->take_settings(*w.ring, settings));
    need(w.texture->take_settings());
    w.want_some_pages();
    w.run_frames(40);
    EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    EXPECT_EQ(root_page(), bare);
}

// The comparisons above can fail: a reference that is not told of a setting is far off.
TEST_F(ComposerTest, AReferenceWithoutTheSettingsDiffers) {
    GroundSettings less = everything_on();
    less.tile_hiding = false;
    EXPECT_GT(compare_pages(false, everything_on(), less).difference.worst, 20);
    less = everything_on();
    less.distortion_amplitude_m *= 0.9;
    EXPECT_GT(compare_pages(true, everything_on(), less).difference.worst, 20);
    less = with_vista({});
    less.vista_distance_m *= 1.2;
    EXPECT_GT(compare_pages(false, with_vista({}), less).difference.worst, 5);
}

// Where the magnified lookup weighs otherwise in the coarser page, a page's second mip is made of that page's
// texels, so that nothing is seen of the step; the mean of the first would be far off. Elsewhere it is the
// mean.
TEST_F(ComposerTest, WithVistaTheSecondMipIsWhatTheCoarserPageShows) {
    World w(small_desc(PageFormat::rgba8), false, {.layers = 9, .ground = with_vista({})});
    write_random_map(w);
    w.want_some_pages();
    w.run_frames(14);
    const TextureLayout& layout = w.texture->layout();
    const int row = w.texture->desc().pages_per_side * kPageTexels;
    const std::vector<uint32_t> mip0 = w.read_u32(w.texture->atlas(0)),
                                mip1 = w.read_u32(w.texture->atlas(0), 1);
    const auto green = [](uint32_t texel) { return double(texel >> 8 & 0xff); };
    const auto corner = [&](const PageId& page) {
        const int place = w.texture->place_of(page), side = w.texture->desc().pages_per_side;
        EXPECT_GE(place, 0);
        return glm::ivec2(place % side, place / side) * kPageTexels;
    };
    int steps = 0;
    for (int depth = 6; depth > 0; --depth) {
        const PageId page{{true, 1, 1}, depth, 20 >> (6 - depth), 31 >> (6 - depth)};
        const PageId coarser = *layout.coarser(page);
        const double weight = plain_vista(with_vista({}), layout.texel_m(page)),
                     next = plain_vista(with_vista({}), layout.texel_m(coarser));
        const glm::ivec2 own = corner(page), from = corner(coarser);
        double to_coarser = 0, to_mean = 0, count = 0;
        for (int y = 0; y < kPagePayload / 2; ++y)
            for (int x = 0; x < kPagePayload / 2; ++x, ++count) {
                const glm::ivec2 first = own + kPageBorder + glm::ivec2(2 * x, 2 * y);
                double square = 0;
                for (int k = 0; k < 4; ++k)
                    square +=
                        0.25 * std::pow(green(mip0[size_t((first.y + k / 2) * row + first.x + k % 2)]), 2);
                const double second = green(mip1[size_t(first.y / 2 * (row / 2) + first.x / 2)]);
                const glm::ivec2 there =
                    from + kPageBorder + glm::ivec2(page.x & 1, page.y & 1) * (kPagePayload / 2);
                to_coarser += std::abs(second - green(mip0[size_t((there.y + y) * row + there.x + x)]));
                to_mean += std::abs(second - std::sqrt(square));
            }
        to_coarser /= count, to_mean /= count;
        std::printf(
            "texel %.0f mm, vista %.2f then %.2f: off the coarser page %.2f/255, off the mean %.2f/255\n",
            layout.texel_m(page) * 1000, weight, next, to_coarser, to_mean);
        if (weight == next) {
            EXPECT_LT(to_mean, 0.6) << "rounded twice";
        } else {
            EXPECT_LT(to_coarser, 0.05) << "what is left: the index map's next level";
            EXPECT_GT(to_mean, 1.5) << "the step that there would be";
            ++steps;
        }
    }
    EXPECT_GE(steps, 2);
}

TEST_F(ComposerTest, TransitionsAreAsThePlainComposerHasThem) {
    for (const GroundSettings& ground : {GroundSettings{}, everything_on()}) {
        const Difference flat = compare_pages(true, ground, {}, some_transitions()).difference;
        EXPECT_LE(flat.worst, 1.0);
        const Difference rough = compare_pages(false, ground, {}, some_transitions()).difference;
        EXPECT_LE(rough.worst, 3.5) << "two edges cut by filtered reveal maps, one in the other";
        EXPECT_LT(rough.mean, 0.5);
        EXPECT_LT(double(rough.above_one), 0.03 * double(rough.count));
    }
    EXPECT_GT(compare_pages(false, {}, {}, some_transitions(), 0.05).difference.worst, 10)
        << "a wrong threshold is seen";
}

// Exactly on vertices, halfway between two and between four, where weights tie: the direct path takes any
// place.
TEST_F(ComposerTest, VerticesAndTiesAreAsThePlainComposerHasThem) {
    for (const GroundSettings& ground : {GroundSettings{}, GroundSettings{.tile_hiding = true}}) {
        World w(small_desc(PageFormat::rgba8), true, {.layers = 9, .ground = ground});
        const RandomMap map = write_random_map(w);
        const PlainWorld plain = plain_world(w, map, true);
        w.want_some_pages();
        w.run_frames(14);
        const float log2_texel = std::log2(1.0f / float(kPagePayload));
        std::vector<Query> queries;
        for (int j = -8; j < 8; ++j)
            for (int i = -8; i < 8; ++i)
                queries.push_back({{float(i) * 0.25f, float(j) * 0.25f}, log2_texel, 0});
        const auto got = ask(w, "test/direct.comp", queries, true);
        double worst = 0;
        for (size_t i = 0; i < queries.size(); ++i) {
            const glm::dvec2 world = glm::dvec2(w.view.camera_m) + glm::dvec2(queries[i].rel_m);
            const Channels wanted = plain_material(plain, world, 1.0 / kPagePayload, 0);
            for (int c = 0; c < 3; ++c)
                worst = std::max(worst, std::abs(std::sqrt(double(got[i].albedo_gloss[c])) -
                                                 std::sqrt(wanted[size_t(c)])));
            worst = std::max(worst, std::abs(double(got[i].albedo_gloss.w) - wanted[5]));
        }
        std::printf("vertices and ties%s: worst %.2f/255\n", ground.tile_hiding ? ", tile hiding" : "",
                    worst * 255);
        EXPECT_LE(worst * 255, 1.0);
    }
}

// Dirt of an index edit reaches as far as distortion does: nothing that was composed before is stale.
TEST_F(ComposerTest, EditsUnderEverySettingLeaveNoStaleTexel) {
    for (const GroundSettings& ground : {everything_on(), with_vista(everything_on())}) {
        World w(small_desc(PageFormat::rgba8), false, {.ground = ground});
        w.want_some_pages();
        w.run_frames(14);
        for (int i = 0; i < 12; ++i) {
            PaintCommand paint;
            paint.dabs = {glm::dvec2(w.view.camera_m) +
                          glm::dvec2(w.fixture.real(-6, 6), w.fixture.real(-6, 6))};
            paint.radius_m = w.fixture.real(0.2, 2);
            paint.layer = i % 2 ? "scree" : "dirt";
            paint.tint = glm::dvec3(w.fixture.real(0, 1), 0.5, 0.25);
            w.on_dirt(w.fixture.apply(paint));
            w.run_frames(3);
        }
        w.run_frames(20);
        EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    }
}

// Settings change live: pages follow, and what is off takes no memory.
TEST_F(ComposerTest, SettingsOfTheGroundChangeLive) {
    World w(small_desc(PageFormat::rgba8));
    w.want_some_pages();
    w.run_frames(14);
    const auto before = w.read_u32(w.texture->atlas(0));
    EXPECT_FALSE(w.layers->distortion);
    const auto change = [&](const GroundSettings& ground) {
        ProjectSettings settings = w.document().settings();
        settings.ground = ground;
        need(w.layers->take_settings(*w.ring, settings));
        need(w.texture->take_settings());
        w.run_frames(30);
        EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    };
    change(everything_on());
    EXPECT_TRUE(w.layers->distortion);
    EXPECT_NE(w.read_u32(w.texture->atlas(0)), before);
    change({});
    EXPECT_FALSE(w.layers->distortion);
    EXPECT_EQ(w.read_u32(w.texture->atlas(0)), before) << "off is as if it had never been on";
}

// A transition is made, painted, changed and removed while pages are there.
TEST_F(ComposerTest, TransitionsChangeLive) {
    World w(small_desc(PageFormat::rgba8), false);
    w.want_some_pages();
    w.run_frames(14);
    const uint64_t texture_bytes = w.layers->gpu_bytes();
    const auto change = [&](const std::optional<LayerEntry::Blend>& blend) {
        ProjectSettings settings = w.document().settings();
        settings.layers.resize(3);
        if (blend) settings.layers.push_back({.name = "t", .file = "", .blend = blend});
        need(w.document().change_settings(settings));
        ASSERT_TRUE(w.layers->has_textures_of(settings)) << "no texture is loaded again";
        need(w.layers->take_settings(*w.ring, settings));
        need(w.texture->take_settings());
        w.run_frames(30);
        EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    };
    change(LayerEntry::Blend{"grass", "dirt", 0.5});
    PaintCommand paint;
    paint.dabs = {glm::dvec2(w.view.camera_m)};
    paint.radius_m = 3;
    paint.layer = "t";
    w.on_dirt(w.fixture.apply(paint));
    w.run_frames(30);
    const auto half = w.read_u32(w.texture->atlas(0));
    change(LayerEntry::Blend{"grass", "dirt", 0.8});
    const auto more = w.read_u32(w.texture->atlas(0));
    EXPECT_NE(more, half);
    change(LayerEntry::Blend{"grass", "dirt", 0.5});
    EXPECT_EQ(w.read_u32(w.texture->atlas(0)), half);
    change(LayerEntry::Blend{"grass", "dirt", 1});
    const auto all = w.read_u32(w.texture->atlas(0));
    change(LayerEntry::Blend{"grass", "dirt", 0.8, true});
    EXPECT_EQ(w.read_u32(w.texture->atlas(0)), all) << "removed: it shows dirt, which it was nearer to";
    EXPECT_EQ(w.layers->gpu_bytes(), texture_bytes);
}

// --- feedback ---

// A camera straight above level ground: depth and g-buffer are constants.
struct FlatScene {
    static constexpr uint32_t kWidth = 240, kHeight = 136;
    explicit FlatScene(World& world) : w(world) {
        gpu::Device& device = gpu::test_device();
        const VkImageUsageFlags sampled = VK_IMAGE_USAGE_SAMPLED_BIT;
        depth = need(
            gpu::Image::create(device, {.name = "depth",
                                        .format = device.caps().depth_stencil,
                                        .width = kWidth,
                                        .height = kHeight,
                                        .usage = sampled | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT}));
        gbuffer = need(gpu::Image::create(device, {.name = "gbuffer",
                                                   .format = VK_FORMAT_R16G16B16A16_SFLOAT,
                                                   .width = kWidth,
                                                   .height = kHeight,
                                                   .usage = sampled | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT}));
    }
    void frame(double above_m) {
        w.view.camera_m.z = above_m;
        constexpr float kNear = 0.05f, kFocal = 1.8f;
        const float footprint = std::log2(float(above_m) * 2 / (kFocal * float(kHeight)));
        shared::FrameUniforms u{};
        const float aspect = float(kWidth) / float(kHeight);
        const glm::mat4 clip(glm::vec4(kFocal / aspect, 0, 0, 0), glm::vec4(0, -kFocal, 0, 0),
                             glm::vec4(0, 0, 0, -1), glm::vec4(0, 0, kNear, 0));
        u.clip_from_rel = clip;
        u.rel_from_clip = glm::inverse(clip);
        u.picture_px = {kWidth, kHeight};
        gpu::Frame* f = need(w.ring->begin());
        gpu::Commands& c = f->commands;
        w.record(c);
        const auto slice = w.ring->upload(sizeof u);
        std::memcpy(slice.data, &u, sizeof u);
        {
            auto pass = c.pass("scene", {{depth, Access::depth_target}, {gbuffer, Access::color_target}});
            const gpu::ColorTarget colors[] = {
                {gbuffer.view(), VK_ATTACHMENT_LOAD_OP_CLEAR, {{0, 0, footprint, footprint}}}};
            c.begin_rendering({kWidth, kHeight}, colors,
                              {.view = depth.view(),
                               .load = VK_ATTACHMENT_LOAD_OP_CLEAR,
                               .clear = {kNear / float(above_m), 0},
                               .has_stencil = true});
            c.end_rendering();
        }
        need(w.texture->record_feedback(*w.ring, c,
                                        {.depth = depth,
                                         .gbuffer = gbuffer,
                                         .uniforms = *slice.buffer,
                                         .uniforms_offset = slice.offset,
                                         .picture_px = {kWidth, kHeight}}));
        need(w.ring->end(*f));
    }
    // Frames until the texture says that the view is complete; -1: never.
    int settle(double above_m) {
        const uint64_t first = w.frame_number + 1;
        for (int i = 1; i <= 120; ++i) {
            frame(above_m);
            if (w.texture->settled() && w.texture->last_feedback_frame() >= first) return i;
        }
        return -1;
    }
    World& w;
    gpu::Image depth, gbuffer;
};

TEST_F(ComposerTest, FeedbackBringsWhatTheViewWantsAndThenRests) {
    VirtualTextureDesc desc = small_desc(PageFormat::rgba8);
    desc.pages_per_side = 12;
    World w(desc);
    FlatScene scene(w);
    const auto page_under_camera = [&](int depth) {
        const double side = std::ldexp(64.0, -depth);
        return PageId{
            {true, 1, 1}, depth, int((w.view.camera_m.x - 64) / side), int((w.view.camera_m.y - 64) / side)};
    };
    // 4 m above: a pixel is 4 * 2 / (1.8 * 136) = 3.3 cm, three mips above the finest texel of 4 mm.
    w.view.pixels_per_radian = 1.8 * 136 / 2;
    const int frames = scene.settle(4);
    ASSERT_GT(frames, 3) << "feedback takes its frames";
    EXPECT_EQ(w.texture->statistics().missing_pages, 0u);
    EXPECT_GE(w.texture->place_of(page_under_camera(3)), 0);
    EXPECT_LT(w.texture->place_of(page_under_camera(5)), 0) << "nobody asked for so fine a page";
    // At rest nothing is composed.
    const auto rested = w.texture->statistics();
    for (int i = 0; i < 5; ++i) scene.frame(4);
    EXPECT_TRUE(w.texture->settled());
    EXPECT_EQ(w.texture->statistics().rects_composed, rested.rects_composed);
    // Dirt in view: not settled until it is composed, and composed in the next frame.
    w.on_dirt(w.fixture.crater(w.view.camera_m.x, w.view.camera_m.y, 0.5));
    EXPECT_FALSE(w.texture->settled());
    scene.frame(4);
    EXPECT_GT(w.texture->statistics().rects_composed, rested.rects_composed);
    ASSERT_GT(scene.settle(4), 0);
    EXPECT_EQ(need(w.texture->count_stale_pages(*w.ring)), 0u);
    // Nearer: finer pages come.
    ASSERT_GT(scene.settle(1), 0);
    EXPECT_GE(w.texture->place_of(page_under_camera(5)), 0);
}

}  // namespace
