// Height and index pages on a device, and the prepass drawn from them.
#include "runtime/geometry/terrain_pass.h"

#include <cstring>
#include <set>

#include "runtime/maps/half.h"
#include "runtime/maps/height_compose.h"
#include "runtime/maps/index_map.h"
#include "runtime/maps/tint_blocks.h"
#include "tests/gpu/test_device.h"
#include "tests/unit/map_fixture.h"

namespace loam {
namespace {

using gpu::Access;
using gpu::test_device;
using Geometry = gpu::GpuTest;

constexpr uint32_t kWidth = 320, kHeight = 200;
constexpr double kNear_m = 0.1, kFov_rad = 1.2;

template <typename T>
T need(Result<T> result) {
    LOAM_CHECK(result.ok(), result.ok() ? "" : result.message());
    return std::move(result.value());
}
void need(const Status& status) {
    LOAM_CHECK(status.ok(), status.ok() ? "" : status.message());
}

template <typename T>
std::vector<T> copied(std::span<const std::byte> bytes) {
    std::vector<T> values(bytes.size() / sizeof(T));
    std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    return values;
}

struct Axes {
    glm::dvec3 right, down, forward;
};

Axes axes(double yaw, double pitch) {
    const glm::dvec3 forward(std::sin(yaw) * std::cos(pitch), std::cos(yaw) * std::cos(pitch),
                             std::sin(pitch));
    const glm::dvec3 right(std::cos(yaw), -std::sin(yaw), 0);
    return {right, glm::cross(forward, right), forward};
}

glm::dmat4 clip_from_rel(const Axes& a) {  // reversed Z, infinite far plane
    const double f = 1 / std::tan(kFov_rad / 2), aspect = double(kWidth) / kHeight;
    return glm::transpose(glm::dmat4(glm::dvec4(a.right * f / aspect, 0), glm::dvec4(a.down * f, 0),
                                     glm::dvec4(0, 0, 0, kNear_m), glm::dvec4(a.forward, 0)));
}

struct Picture {
    std::vector<uint16_t> gbuffer;
    std::vector<uint8_t> occlusion, stencil;
    std::vector<float> depth;
    PatchSet patches;
};

class Scene {
  public:
    explicit Scene(Document& document)
        : ring(need(gpu::FrameRing::create(test_device(), 2))),
          heights(need(HeightMap::create(&test_device(), document, {}))),
          indices(need(IndexMap::create(&test_device(), document, {}))) {
        const auto image = [](const char* name, VkFormat format, VkImageUsageFlags usage) {
            gpu::ImageDesc desc;
            desc.name = name;
            desc.format = format;
            desc.width = kWidth;
            desc.height = kHeight;
            desc.usage = usage | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
            return need(gpu::Image::create(test_device(), desc));
        };
        const VkFormat depth_format = test_device().caps().depth_stencil;
        gbuffer = image("gbuffer", VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        occlusion = image("occlusion", VK_FORMAT_R8_UNORM, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
        depth = image("depth", depth_format, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        shadow = image("shadow", VK_FORMAT_D32_SFLOAT, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
        gpu::BufferDesc desc;
        desc.name = "depth copy";
        desc.size_bytes = kWidth * kHeight * 8;
        depth_copy = need(gpu::Buffer::create(test_device(), desc));
        terrain =
            need(TerrainPass::create(test_device(), {gbuffer.format(), occlusion.format()}, depth_format));
    }

    void settle(const PatchView& view) {
        for (int i = 0; i < 300 && (i == 0 || heights->has_work() || indices->has_work()); ++i) {
            gpu::Frame* frame = need(ring->begin());
            (void)select_patches(*heights, view);
            for (int k = 0; k < 8; ++k) indices->request({0, k % 3, k / 3}, 1);
            need(heights->update(*ring, frame->commands, frame->number, 8));
            need(indices->update(*ring, frame->commands, frame->number, 8));
            need(ring->finish(*frame));
        }
        EXPECT_FALSE(heights->has_work());
    }

    void copy_aspect(gpu::Commands& commands, gpu::Image& image, VkImageAspectFlags aspect, uint64_t offset) {
        VkBufferImageCopy region{};
        region.bufferOffset = offset;
        region.imageSubresource = {aspect, 0, 0, 1};
        region.imageExtent = {kWidth, kHeight, 1};
        vkCmdCopyImageToBuffer(commands.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               depth_copy.handle(), 1, &region);
    }

    Picture draw(const PatchView& view, bool as_shadow = false) {
        Picture picture;
        gpu::Frame* frame = need(ring->begin());
        gpu::Commands& commands = frame->commands;
        picture.patches = select_patches(*heights, view);
        need(heights->update(*ring, commands, frame->number, 0));
        need(terrain.upload(*ring, commands, picture.patches));
        gpu::Image& target = as_shadow ? shadow : depth;
        gpu::DepthTarget depth_target;
        depth_target.view = target.view();
        depth_target.load = VK_ATTACHMENT_LOAD_OP_CLEAR;
        depth_target.has_stencil = !as_shadow;
        if (as_shadow) {
            const auto pass = commands.pass("shadow", {{shadow, Access::depth_target}});
            commands.begin_rendering({kWidth, kHeight}, {}, depth_target);
            terrain.cmd_draw_shadow(commands, picture.patches, *heights, view.clip_from_rel,
                                    view.clip_from_rel, view.camera_m);
            commands.end_rendering();
        } else {
            const auto pass = commands.pass("prepass", {{depth, Access::depth_target},
                                                        {gbuffer, Access::color_target},
                                                        {occlusion, Access::color_target},
                                                        {heights->heights(), Access::vertex_read},
                                                        {heights->normals(), Access::fragment_sampled}});
            const gpu::ColorTarget colors[] = {{gbuffer.view(), VK_ATTACHMENT_LOAD_OP_CLEAR, {}},
                                               {occlusion.view(), VK_ATTACHMENT_LOAD_OP_CLEAR, {}}};
            commands.begin_rendering({kWidth, kHeight}, colors, depth_target);
            terrain.cmd_draw_prepass(commands, picture.patches, *heights, glm::mat4(view.clip_from_rel),
                                     view.camera_m);
            commands.end_rendering();
        }
        commands.use({{target, Access::copy_source}, {depth_copy, Access::copy_target}});
        copy_aspect(commands, target, VK_IMAGE_ASPECT_DEPTH_BIT, 0);
        if (!as_shadow) copy_aspect(commands, target, VK_IMAGE_ASPECT_STENCIL_BIT, kWidth * kHeight * 4);
        ring->read_back(
            commands, depth_copy, 0, depth_copy.size_bytes(), [&](std::span<const std::byte> bytes) {
                picture.depth = copied<float>(bytes.first(kWidth * kHeight * 4));
                picture.stencil = copied<uint8_t>(bytes.subspan(kWidth * kHeight * 4, kWidth * kHeight));
            });
        if (!as_shadow) {
            ring->read_back(commands, gbuffer, [&](std::span<const std::byte> bytes) {
                picture.gbuffer = copied<uint16_t>(bytes);
            });
            ring->read_back(commands, occlusion, [&](std::span<const std::byte> bytes) {
                picture.occlusion = copied<uint8_t>(bytes);
            });
        }
        need(ring->finish(*frame));
        return picture;
    }

    std::unique_ptr<gpu::FrameRing> ring;
    std::unique_ptr<HeightMap> heights;
    std::unique_ptr<IndexMap> indices;
    gpu::Image gbuffer, occlusion, depth, shadow;
    gpu::Buffer depth_copy;
    TerrainPass terrain;
};

// The world place that a pixel's depth says.
glm::dvec3 place_of(uint32_t x, uint32_t y, float depth, const Axes& a, glm::dvec3 camera_m) {
    const double f = std::tan(kFov_rad / 2), aspect = double(kWidth) / kHeight;
    const double along = kNear_m / double(depth);
    const double u = ((x + 0.5) / kWidth * 2 - 1) * f * aspect, v = ((y + 0.5) / kHeight * 2 - 1) * f;
    return camera_m + (a.forward + a.right * u + a.down * v) * along;
}

TEST_F(Geometry, APictureFromAboveHasNoHoleAndTheHeightsOfTheQueries) {
    test::MapFixture ground({.samples_x = 1025, .samples_y = 1025, .refine = 2, .relief_m = 3});
    ground.crater(480, 500, 12);
    Scene scene(ground.document());
    const Axes a = axes(0.4, -1.45);
    PatchView view;
    view.camera_m = {500, 500, 130};
    view.clip_from_rel = clip_from_rel(a);
    view.split_distance = 2;
    scene.settle(view);
    const Picture picture = scene.draw(view);
    ASSERT_EQ(picture.depth.size(), kWidth * kHeight);
    std::set<uint32_t> levels;
    for (int i = 0; i < picture.patches.visible_count; ++i)
        levels.insert(picture.patches.patches[size_t(i)].level);
    EXPECT_GE(levels.size(), 2u);

    double worst_m = 0;
    for (uint32_t y = 0; y < kHeight; ++y)
        for (uint32_t x = 0; x < kWidth; ++x) {
            const size_t i = y * kWidth + x;
            ASSERT_GT(picture.depth[i], 0.0f) << "hole at " << x << ", " << y;
            ASSERT_EQ(picture.stencil[i], 1);
            const glm::dvec3 place = place_of(x, y, picture.depth[i], a, view.camera_m);
            worst_m = std::max(worst_m, std::abs(place.z - scene.heights->height_m(place.x, place.y)));

            float g[4];
            for (int c = 0; c < 4; ++c) g[c] = float_from_half(picture.gbuffer[i * 4 + size_t(c)]);
            ASSERT_TRUE(std::isfinite(g[0]) && std::isfinite(g[1]) && g[0] * g[0] + g[1] * g[1] <= 1);
            // Straight from above a pixel's footprint is its angle times the distance, about as long as wide.
            const double pixel_m = 2 * std::tan(kFov_rad / 2) / kHeight * (view.camera_m.z - place.z);
            ASSERT_NEAR(g[2], std::log2(pixel_m), 2.5);
            ASSERT_LE(g[3], g[2]);
            ASSERT_GE(g[3], -20.0f);
            ASSERT_GT(picture.occlusion[i], 20);
        }
    // Patches are drawn from every fourth sample, and the ground is rough by 0.3 m a sample.
    EXPECT_LT(worst_m, 1.5);
    EXPECT_GT(worst_m, 0);
}

TEST_F(Geometry, NearTheHorizonNothingIsNanAndTheMapsEdgeIsSharp) {
    test::MapFixture ground(
        {.samples_x = 300, .samples_y = 280, .height_spacing_m = 1.3, .refine = 1, .relief_m = 3});
    Scene scene(ground.document());
    const WorldRect bounds = ground.document().bounds();
    PatchView view;
    view.camera_m = {bounds.max_x - 3, bounds.max_y - 4,
                     scene.heights->height_m(bounds.max_x - 3, bounds.max_y - 4) + 0.01};
    for (const double pitch : {0.0, -0.3, -1.2}) {
        const Axes a = axes(0.8, pitch);
        view.clip_from_rel = clip_from_rel(a);
        scene.settle(view);
        const Picture picture = scene.draw(view);
        size_t covered = 0;
        for (uint32_t y = 0; y < kHeight; ++y)
            for (uint32_t x = 0; x < kWidth; ++x) {
                const size_t i = y * kWidth + x;
                for (size_t c = 0; c < 4; ++c) {
                    const float value = float_from_half(picture.gbuffer[i * 4 + c]);
                    ASSERT_TRUE(std::isfinite(value));
                    ASSERT_TRUE(value >= -20 && value <= 14);
                }
                ASSERT_EQ(picture.stencil[i], picture.depth[i] > 0 ? 1 : 0);
                if (picture.depth[i] == 0) continue;
                ++covered;
                const glm::dvec3 place = place_of(x, y, picture.depth[i], a, view.camera_m);
                ASSERT_TRUE(bounds.grown(0.01).contains(place.x, place.y));
            }
        EXPECT_GT(covered, 500u);
    }
}

TEST_F(Geometry, AShadowHasTheDepthsOfThePrepass) {
    test::MapFixture ground({.samples_x = 500, .samples_y = 500, .refine = 1, .relief_m = 3});
    Scene scene(ground.document());
    PatchView view;
    view.camera_m = {200, 200, 60};
    view.clip_from_rel = clip_from_rel(axes(0.4, -0.6));
    scene.settle(view);
    const Picture prepass = scene.draw(view), shadow = scene.draw(view, true);
    EXPECT_EQ(prepass.depth, shadow.depth);
    EXPECT_GT(*std::max_element(shadow.depth.begin(), shadow.depth.end()), 0.0f);
}

TEST_F(Geometry, TheArraysHoldWhatTheCpuHas) {
    test::MapFixture ground({.samples_x = 500, .samples_y = 500, .refine = 1});
    Scene scene(ground.document());
    PatchView view;
    view.camera_m = {200, 200, 60};
    view.clip_from_rel = clip_from_rel(axes(0.4, -0.6));
    scene.settle(view);
    for (int i = 0; i < 8; ++i) {  // rectangles of edits
        const Dirt dirt = ground.random_command();
        scene.heights->on_dirt(dirt.height);
        scene.indices->on_dirt(dirt.index);
        scene.settle(view);
    }
    // Layer 0 is the root's slot.
    ASSERT_EQ(scene.heights->map().slot_of(scene.heights->map().root()), 0);
    ASSERT_EQ(scene.indices->map().slot_of(scene.indices->map().root()), 0);
    std::vector<float> heights;
    std::vector<uint16_t> normals, layers;
    std::vector<glm::uvec2> tint_blocks;
    std::vector<uint32_t> table;
    gpu::Frame* frame = need(scene.ring->begin());
    const auto keep = [](auto& out) {
        return [&out](std::span<const std::byte> bytes) {
            out = copied<typename std::remove_reference_t<decltype(out)>::value_type>(bytes);
        };
    };
    scene.ring->read_back(frame->commands, scene.heights->heights(), keep(heights));
    scene.ring->read_back(frame->commands, scene.heights->normals(), keep(normals));
    scene.ring->read_back(frame->commands, scene.indices->indices(), keep(layers));
    scene.ring->read_back(frame->commands, scene.indices->tints(), keep(tint_blocks));
    scene.ring->read_back(frame->commands, scene.indices->page_table(), 0,
                          scene.indices->map().table_entry_count() * sizeof(uint32_t), keep(table));
    need(scene.ring->finish(*frame));

    const HeightPage* root = scene.heights->resident_page(scene.heights->map().root());
    EXPECT_EQ(heights, root->heights_m);
    EXPECT_EQ(normals, root->normals);
    EXPECT_EQ(scene.heights->count_stale_pages(ground.document()), 0u);
    EXPECT_EQ(scene.indices->count_stale_pages(ground.document()), 0u);
    const IndexTexel* texels = scene.indices->resident_page(scene.indices->map().root());
    ASSERT_EQ(layers.size(), size_t(kIndexTexels * kIndexTexels));
    for (size_t i = 0; i < layers.size(); ++i) {
        ASSERT_EQ(layers[i], texels[i].layer);
    }
    constexpr int kAcross = kIndexTexels / kTintBlockTexels;
    std::vector<glm::uvec2> blocks(size_t(kAcross) * kAcross);
    encode_tint_blocks({texels, layers.size()}, kIndexTexels, {0, 0, kAcross, kAcross}, blocks);
    EXPECT_EQ(tint_blocks, blocks);
    const VirtualMap& map = scene.indices->map();
    for (int level = 0; level <= map.root().level; ++level)
        for (int y = 0; y < map.pages_y(level); ++y)
            for (int x = 0; x < map.pages_x(level); ++x) {
                const int slot = map.slot_of({level, x, y});
                ASSERT_EQ(table[map.level_offset(level) + uint32_t(y * map.pages_x(level) + x)],
                          slot < 0 ? uint32_t(VirtualMap::kNoSlot) : uint32_t(slot));
            }
}

}  // namespace
}  // namespace loam
