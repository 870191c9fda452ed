// The demo interface on a device: equal to the CPU's rasteriser, without validation messages, and written as
// pictures (ui_<scale>.ppm in the build folder) for people to look at.
#include <cstdio>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "runtime/gpu/upload.h"
#include "tests/unit/ui_demo.h"
#include "tests/unit/ui_raster.h"
#include "ui/renderer.h"

namespace loam::ui {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

struct UiRender : testing::Test {
    std::unique_ptr<gpu::Device> device;
    std::unique_ptr<gpu::FrameRing> ring;
    void SetUp() override {
        auto made = gpu::Device::create({.device_filter = "", .validation = true, .instance_extensions = {}});
        if (!made) GTEST_SKIP() << "no device: " << made.message();
        device = std::move(*made);
        auto frames = gpu::FrameRing::create(*device, 2);
        ASSERT_TRUE(frames.ok());
        ring = std::move(*frames);
    }
    void TearDown() override {
        if (device) {
            EXPECT_EQ(device->validation_message_count(), 0u);
        }
    }
    std::vector<uint8_t> draw(UiRenderer& renderer, const DrawList& list, GlyphAtlas& atlas, uint32_t w,
                              uint32_t h, Color clear) {
        std::vector<uint8_t> rgba;
        auto target = gpu::Image::create(
            *device, {.name = "target",
                      .format = kFormat,
                      .width = w,
                      .height = h,
                      .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
        EXPECT_TRUE(target.ok());
        auto frame = ring->begin();
        EXPECT_TRUE(frame.ok());
        gpu::Commands& commands = (*frame)->commands;
        EXPECT_TRUE(renderer.prepare(*ring, commands, list, atlas).ok());
        {
            auto pass = commands.pass("ui", {{*target, gpu::Access::color_target}});
            const gpu::ColorTarget color{
                .view = target->view(),
                .load = VK_ATTACHMENT_LOAD_OP_CLEAR,
                .clear = {{float(clear.r) / 255.0f, float(clear.g) / 255.0f, float(clear.b) / 255.0f, 1.0f}}};
            commands.begin_rendering({w, h}, std::span(&color, 1));
            renderer.cmd_record(commands, {w, h});
            commands.end_rendering();
        }
        ring->read_back(commands, *target, [&](std::span<const std::byte> bytes) {
            const auto* p = reinterpret_cast<const uint8_t*>(bytes.data());
            rgba.assign(p, p + bytes.size());
        });
        EXPECT_TRUE(ring->finish(**frame).ok());
        return rgba;
    }
};

void write_picture(const std::string& name, const std::vector<uint8_t>& rgba, uint32_t w, uint32_t h) {
    const char* folder = std::getenv("LOAM_BINARY_DIR");
    FILE* file = std::fopen(((folder ? folder : ".") + ("/" + name)).c_str(), "wb");
    if (!file) return;
    std::fprintf(file, "P6 %u %u 255\n", w, h);
    for (size_t i = 0; i + 3 < rgba.size(); i += 4) std::fwrite(&rgba[i], 1, 3, file);
    std::fclose(file);
}

// One step of 8 bits a blend may round differently; a dozen layers lie over one another at most.
constexpr int kTolerance = 3;

TEST_F(UiRender, TheDemoEqualsTheCpuAtEveryScale) {
    auto renderer = UiRenderer::create(*device, kFormat);
    ASSERT_TRUE(renderer.ok()) << renderer.message();
    for (const float scale : {1.0f, 1.5f}) {
        Harness h(scale);
        h.size = {1280 * scale, 800 * scale};
        Demo demo;
        const auto build = [&](Ui& ui) { demo.build(ui); };
        h.click({30 * scale, 18 * scale}, build);  // the File menu is open: shadow, overlay, clip
        const auto w = uint32_t(h.size.x), height = uint32_t(h.size.y);
        const Color clear = h.ui->theme.window;
        const auto rgba = draw(*renderer, *h.last.draw, h.text->atlas(), w, height, clear);
        write_picture("ui_" + std::to_string(int(scale * 100)) + ".ppm", rgba, w, height);

        Canvas canvas(int(w), int(height), clear);
        rasterise(*h.last.draw, h.text->atlas(), canvas);
        const auto expected = canvas.bytes();
        ASSERT_EQ(rgba.size(), size_t(w) * height * 4);
        size_t wrong = 0, lit = 0;
        for (size_t i = 0; i < size_t(w) * height; ++i)
            for (size_t c = 0; c < 3; ++c) {
                wrong += std::abs(int(rgba[i * 4 + c]) - int(expected[i * 3 + c])) > kTolerance;
                lit += rgba[i * 4 + c] > 150;
            }
        EXPECT_EQ(wrong, 0u) << "scale " << scale;
        EXPECT_GT(lit, 5000u);
    }
}

TEST_F(UiRender, PicturesAreDrawnAndARemovedOneIsNot) {
    auto renderer = UiRenderer::create(*device, kFormat);
    ASSERT_TRUE(renderer.ok()) << renderer.message();
    auto image =
        gpu::Image::create(*device, {.name = "red",
                                     .format = kFormat,
                                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
    ASSERT_TRUE(image.ok());
    auto frame = ring->begin();
    ASSERT_TRUE(frame.ok());
    const std::array<std::byte, 4> red{std::byte{255}, std::byte{0}, std::byte{0}, std::byte{255}};
    gpu::upload_to_image(*ring, (*frame)->commands, *image, 0, 0, 0, 0, 1, 1, red);
    (*frame)->commands.use({{*image, gpu::Access::fragment_sampled}});
    ASSERT_TRUE(ring->finish(**frame).ok());

    const TextureId id = renderer->add_image(image->view());
    GlyphAtlas atlas;
    DrawList list;
    list.clear({0, 0, 64, 64});
    list.image({16, 16, 32, 32}, id);
    auto rgba = draw(*renderer, list, atlas, 64, 64, Color::hex(0x000000));
    EXPECT_EQ(rgba[(32 * 64 + 32) * 4], 255);
    EXPECT_EQ(rgba[(32 * 64 + 10) * 4], 0);
    renderer->remove_image(id);
    rgba = draw(*renderer, list, atlas, 64, 64, Color::hex(0x000000));
    EXPECT_EQ(rgba[(32 * 64 + 32) * 4], 0);
}

}  // namespace
}  // namespace loam::ui
