// Composition against a plain composer written from the talk's description ("One Material Per Vertex": the
// four index texels around a texel weigh bilinearly, equal layers are merged, alpha is doubled and clamped,
// layers are sorted, the lowest is opaque, reveal cuts the edge), in doubles, with loops and a sort; and the
// round trip of feedback until nothing is missing.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/mat4x4.hpp>

#include "shaders/frame/frame_io.h"
#include "tests/gpu/texture_world.h"

namespace {

using namespace loam;
using namespace loam::test;
using gpu::Access;
using ComposerTest = gpu::GpuTest;

constexpr double kIndexSpacing_m = 0.5;  // MapFixtureDesc's
constexpr double kSoftness = 0.25;       // of the reveal's edge

double linear_of(double srgb) {
    return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4);
}

struct RandomMap {
    int width = 0, height = 0;
    std::vector<IndexTexel> texels;
    [[nodiscard]] const IndexTexel& at(int x, int y) const {
        return texels[size_t(std::clamp(y, 0, height - 1)) * size_t(width) +
                      size_t(std::clamp(x, 0, width - 1))];
    }
};

// Speckles in some places, larger areas in others; tints that are not dark.
RandomMap write_random_map(World& w) {
    const glm::ivec2 size = w.document().index_size_texels();
    RandomMap map{size.x, size.y, std::vector<IndexTexel>(size_t(size.x) * size_t(size.y))};
    for (IndexTexel& t : map.texels) {
        t.layer = uint16_t(w.fixture.uniform(0, 4) == 0 ? w.fixture.uniform(1, 2) : 0);
        for (uint8_t& c : t.tint) c = uint8_t(w.fixture.uniform(128, 255));
    }
    BulkWriter writer(w.document());
    for (int y = 0; y < size.y; ++y)
        need(writer.write_index_rows(
            y, 1, std::span(map.texels).subspan(size_t(y) * size_t(size.x), size_t(size.x))));
    need(writer.finish());
    return map;
}

using Channels =
    std::array<double, 8>;  // albedo r g b linear, normal x y, gloss, occlusion as stored; reveal

Channels layer_at(const LayerTextures& layer, int mip, double u, double v) {
    const int side = std::max(1, int(layer.size_texels) >> mip);
    const double x = (u - std::floor(u)) * side - 0.5, y = (v - std::floor(v)) * side - 0.5;
    const int x0 = int(std::floor(x)), y0 = int(std::floor(y));
    Channels sum{};
    for (int corner = 0; corner < 4; ++corner) {
        const int i = corner & 1, j = corner >> 1;
        const double weight = (i ? x - x0 : 1 - (x - x0)) * (j ? y - y0 : 1 - (y - y0));
        const size_t at =
            (size_t((y0 + j + side) % side) * size_t(side) + size_t((x0 + i + side) % side)) * 4;
        const uint8_t* albedo = &layer.albedo_reveal[size_t(mip)][at];
        const uint8_t* surface = &layer.normal_gloss_occlusion[size_t(mip)][at];
        for (size_t c = 0; c < 3; ++c) sum[c] += weight * linear_of(albedo[c] / 255.0);
        for (size_t c = 0; c < 4; ++c) sum[3 + c] += weight * surface[c] / 255.0;
        sum[7] += weight * albedo[3] / 255.0;
    }
    return sum;
}

// What a texel stores in the three textures, 0 … 255.
std::array<std::array<double, 3>, 3> plain_texel(const RandomMap& map,
                                                 const std::vector<LayerTextures>& layers,
                                                 const std::vector<double>& tiles_m, glm::dvec2 world,
                                                 double texel_m) {
    struct Merged {
        double alpha = 0;
        glm::dvec3 tint{0};
    };
    std::map<int, Merged> merged;  // sorted by layer
    const glm::dvec2 at = world / kIndexSpacing_m, corner = glm::floor(at), f = at - corner;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < 2; ++i) {
            const IndexTexel& t = map.at(int(corner.x) + i, int(corner.y) + j);
            const double weight = (i ? f.x : 1 - f.x) * (j ? f.y : 1 - f.y);
            if (weight <= 0) continue;
            Merged& m = merged[t.layer];
            m.alpha += weight;
            m.tint += weight * glm::dvec3(t.tint[0], t.tint[1], t.tint[2]) / 255.0;
        }
    Channels shown{};
    bool lowest = true;
    for (const auto& [layer, m] : merged) {
        const double tile_m = tiles_m[size_t(layer)];
        const LayerTextures& textures = layers[size_t(layer)];
        const int mip =
            std::max(0, int(std::floor(std::log2(texel_m * textures.size_texels / tile_m) + 0.5)));
        Channels c = layer_at(textures, mip, world.x / tile_m, world.y / tile_m);
        for (int k = 0; k < 3; ++k) c[size_t(k)] *= linear_of(m.tint[k] / m.alpha);
        const double alpha = std::clamp(2 * m.alpha, 0.0, 1.0);
        const double cover =
            lowest ? 1 : std::clamp((alpha * (1 + kSoftness) - (1 - c[7])) / kSoftness, 0.0, 1.0);
        for (size_t k = 0; k < 7; ++k) shown[k] += (c[k] - shown[k]) * cover;
        lowest = false;
    }
    const auto normal = [](double stored) { return 130 + 125 * ((stored * 255 - 128) / 127); };
    return {{{255 * std::sqrt(shown[0]), 255 * std::sqrt(shown[1]), 255 * std::sqrt(shown[2])},
             {255 * shown[5], normal(shown[3]), 255 * shown[6]},
             {0, normal(shown[4]), 0}}};
}

struct Difference {
    double worst = 0, mean = 0;
    int64_t above_one = 0, count = 0;
};

// All texels of some pages, borders included.
Difference compare_pages(bool flat_layers) {
    World w(small_desc(PageFormat::rgba8), flat_layers);
    const RandomMap map = write_random_map(w);
    std::vector<LayerTextures> layers;
    for (int i = 1; i <= 3; ++i) layers.push_back(make_layer(i, flat_layers));
    w.want_some_pages();
    w.run_frames(14);
    const int side = small_desc(PageFormat::rgba8).pages_per_side;
    std::array<std::vector<uint32_t>, 3> atlas;
    for (int which = 0; which < 3; ++which) atlas[size_t(which)] = w.read_u32(w.texture->atlas(which));
    const int finest = w.texture->layout().default_log2_width;
    const PageId pages[] = {
        {{true, 1, 1}, 6, 20, 31}, {{true, 1, 1}, 6, 21, 32}, {{true, 1, 1}, 3, 2, 3}, {{}, finest, 1, 1}};
    Difference d;
    for (const PageId& page : pages) {
        const int place = w.texture->place_of(page);
        EXPECT_GE(place, 0) << "depth " << page.depth;
        if (place < 0) continue;
        const WorldRect square = w.texture->layout().square(page);
        const double texel_m = w.texture->layout().texel_m(page);
        for (int y = 0; y < kPageTexels; ++y)
            for (int x = 0; x < kPageTexels; ++x) {
                const glm::dvec2 world(square.min_x + (x - kPageBorder + 0.5) * texel_m,
                                       square.min_y + (y - kPageBorder + 0.5) * texel_m);
                const auto wanted = plain_texel(map, layers, w.layers->tiles_m, world, texel_m);
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
    std::printf("%s layers: worst %.2f/255, mean %.3f/255, above 1/255: %.4f %%\n",
                flat_layers ? "flat" : "rough", d.worst, d.mean,
                100.0 * double(d.above_one) / double(std::max<int64_t>(d.count, 1)));
    return d;
}

// Rounding to a byte is half a step; the tint's cubic (ompv.h) is the rest.
TEST_F(ComposerTest, FlatLayersAreWithinOneStepOfThePlainComposer) {
    const Difference d = compare_pages(true);
    EXPECT_GT(d.count, 0);
    EXPECT_LE(d.worst, 1.0);
    EXPECT_EQ(d.above_one, 0);
}

// A device filters with 8 bits of fraction at least, and a reveal's error counts four times where it cuts an
// edge.
TEST_F(ComposerTest, RoughLayersAreWithinTheFiltersTolerance) {
    const Difference d = compare_pages(false);
    EXPECT_GT(d.count, 0);
    EXPECT_LE(d.worst, 2.5);
    EXPECT_LT(d.mean, 0.5);
    EXPECT_LT(double(d.above_one), 0.02 * double(d.count));
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
