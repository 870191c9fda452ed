#include "editor/picture.h"
#include "runtime/base/srgb.h"

#include <cmath>

#include <gtest/gtest.h>

namespace loam {
namespace {

Picture flat(int width, int height, uint8_t value) {
    return {width, height, std::vector<uint8_t>(static_cast<size_t>(width * height * 4), value)};
}

TEST(Picture, srgb_codes_survive_the_way_there_and_back) {
    for (int code = 0; code < 256; ++code)
        EXPECT_EQ(srgb8_of_linear(linear_of_srgb8(static_cast<uint8_t>(code))), code);
}

TEST(Picture, black_and_white_average_to_middle_grey_in_linear_light) {
    LinearAverage average;
    average.add(flat(2, 2, 0));
    average.add(flat(2, 2, 255));
    EXPECT_EQ(average.picture().rgba[0], 188);  // sRGB code of linear 0.5
    EXPECT_EQ(average.picture().rgba[3], 255);
}

TEST(Picture, psnr_is_infinite_for_equal_pictures_and_right_for_a_known_difference) {
    EXPECT_TRUE(std::isinf(psnr_db(flat(4, 4, 100), flat(4, 4, 100))));
    EXPECT_NEAR(psnr_db(flat(4, 4, 100), flat(4, 4, 110)), 20 * std::log10(25.5), 1e-9);
}

TEST(Picture, laplacian_energy_counts_detail_only) {
    EXPECT_EQ(laplacian_energy(flat(8, 8, 90)), 0);
    Picture dotted = flat(8, 8, 90);
    dotted.rgba[4 * (3 * 8 + 3)] = 200;
    EXPECT_GT(laplacian_energy(dotted), 0);
}

TEST(Picture, differing_share_counts_pixels_beyond_the_tolerance) {
    Picture a = flat(10, 1, 50), b = a;
    b.rgba[0] = 51;
    b.rgba[4] = 60;
    EXPECT_DOUBLE_EQ(differing_share(a, b, 1), 0.1);
    EXPECT_DOUBLE_EQ(differing_share(a, b, 0), 0.2);
}

TEST(Picture, a_step_is_the_mean_of_the_worst_tile_and_what_a_thousandth_of_the_pixels_exceed) {
    const Picture a = flat(40, 50, 100);  // 2000 pixels: two may differ by more
    EXPECT_EQ(picture_step(a, a).tile, 0);
    EXPECT_EQ(picture_step(a, a).pixel, 0);
    Picture b = a;
    for (size_t i = 0; i < 2; ++i) b.rgba[4 * i] = 200;
    EXPECT_DOUBLE_EQ(picture_step(a, b).tile, 200.0 / 64);
    EXPECT_EQ(picture_step(a, b).pixel, 0);
    b.rgba[4 * 2 + 1] = 93;
    EXPECT_EQ(picture_step(a, b).pixel, 7);
    b = flat(40, 50, 103);  // everywhere, the tiles cut off at the edge too
    EXPECT_DOUBLE_EQ(picture_step(a, b).tile, 3);
    EXPECT_EQ(picture_step(a, b).pixel, 3);
}

}  // namespace
}  // namespace loam
