// Formats of pages: how many textures, and where optional channels go.
#include <gtest/gtest.h>

#include "runtime/texture/page_format.h"

namespace {

using namespace loam;

PageTextures made(PageFormat format, std::vector<Channel> channels) {
    auto textures = page_textures(format, channels);
    EXPECT_TRUE(textures.ok()) << (textures.ok() ? "" : textures.message());
    return textures.ok() ? *textures : PageTextures{};
}

TEST(PageFormat, ATextureAndAScratchLayerMoreOnlyForASecondChannel) {
    for (const PageFormat format : {PageFormat::bc1x3, PageFormat::bc1x4, PageFormat::rgba8}) {
        EXPECT_EQ(made(format, {}).count, 3);
        EXPECT_EQ(made(format, {Channel::glint}).count, 3);
        EXPECT_EQ(made(format, {Channel::glint}).scratch_layers, 3);
    }
    for (const PageFormat format : {PageFormat::bc1x4, PageFormat::rgba8}) {
        EXPECT_EQ(made(format, {Channel::glint, Channel::thermal}).count, 4);
        EXPECT_EQ(made(format, {Channel::glint, Channel::thermal}).scratch_layers, 4);
    }
    EXPECT_EQ(made(PageFormat::bc3x2, {}).count, 2);
    EXPECT_EQ(made(PageFormat::bc3x2, {}).scratch_layers, 3);
}

TEST(PageFormat, ChannelsHavePlacesOfTheirOwnInTheOrderOfTheirNames) {
    using shared::page_channel_place;
    const uint32_t all =
        made(PageFormat::bc1x4, {Channel::glint, Channel::emissive, Channel::thermal, Channel::scattering})
            .placement;
    for (uint32_t c = 0; c < kMostChannels; ++c) EXPECT_EQ(page_channel_place(all, c), c + 1);
    EXPECT_EQ(page_channel_place(all, kChannelDepth), 0u);
    const uint32_t two = made(PageFormat::bc1x4, {Channel::depth, Channel::glint}).placement;
    EXPECT_EQ(page_channel_place(two, kChannelGlint), 1u);
    EXPECT_EQ(page_channel_place(two, kChannelDepth), 2u);
    EXPECT_TRUE(shared::page_has_fourth(two));
    EXPECT_TRUE(shared::page_has_fourth(all));
    const uint32_t one = made(PageFormat::bc1x3, {Channel::glint}).placement;
    EXPECT_EQ(page_channel_place(one, kChannelGlint), 1u);
    EXPECT_EQ(page_channel_place(one, kChannelThermal), 0u);
    EXPECT_FALSE(shared::page_has_fourth(one));
    EXPECT_EQ(made(PageFormat::rgba8, {}).placement, 0u);
}

TEST(PageFormat, NoRoomIsRefusedByName) {
    const auto bc1 = page_textures(PageFormat::bc1x3, std::vector{Channel::glint, Channel::thermal});
    ASSERT_FALSE(bc1.ok());
    EXPECT_EQ(
        bc1.message(),
        "pages of the format bc1 hold 1 optional channel, this map's [texture] has 2; use bc1x4 or rgba8");
    const auto bc3 = page_textures(PageFormat::bc3x2, std::vector{Channel::glint});
    ASSERT_FALSE(bc3.ok());
    EXPECT_NE(bc3.message().find("bc3 hold 0 optional channels"), std::string::npos);
    EXPECT_EQ(format_with_room(PageFormat::bc1x3, 1), PageFormat::bc1x3);
    EXPECT_EQ(format_with_room(PageFormat::bc1x3, 2), PageFormat::bc1x4);
    EXPECT_EQ(format_with_room(PageFormat::rgba8, 4), PageFormat::rgba8);
}

}  // namespace
