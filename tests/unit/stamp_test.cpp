// Stamps: their file, what a place gets of them, and what they do to samples.
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

#include "runtime/document/operator.h"
#include "runtime/document/stamp_library.h"
#include "runtime/store/packed_file.h"
#include "runtime/store/stamp_file.h"

namespace {

using namespace loam;

std::shared_ptr<StampImage> picture(int width, int height, bool colors, bool cover, uint32_t seed = 1) {
    std::mt19937 random(seed);
    auto image = std::make_shared<StampImage>();
    image->width = width;
    image->height = height;
    for (int i = 0; i < width * height; ++i) {
        image->heights.push_back(uint16_t(random()));
        for (int c = 0; colors && c < 3; ++c) image->colors.push_back(uint8_t(random()));
        if (cover) image->cover.push_back(uint8_t(random()));
    }
    return image;
}

Stamp stamp_with(std::shared_ptr<const StampImage> image) {
    Stamp stamp;
    stamp.image = "any";
    stamp.picture = std::move(image);
    return stamp;
}

TEST(stamp, file_comes_back_and_a_damaged_one_is_refused) {
    const auto file = std::filesystem::temp_directory_path() / "loam_stamp_test.stamp";
    for (const auto& [colors, cover] :
         {std::pair{false, false}, {true, false}, {false, true}, {true, true}}) {
        const auto image = picture(37, 5, colors, cover);
        ASSERT_TRUE(save_stamp(file, *image).ok());
        const auto back = load_stamp(file);
        ASSERT_TRUE(back.ok()) << back.message();
        EXPECT_EQ(back->width, 37);
        EXPECT_EQ(back->height, 5);
        EXPECT_EQ(back->heights, image->heights);
        EXPECT_EQ(back->colors, image->colors);
        EXPECT_EQ(back->cover, image->cover);
    }
    auto reader = PartReader::open(file);
    ASSERT_TRUE(reader.ok());
    std::vector<uint8_t> whole(reader->rest_bytes());
    ASSERT_TRUE(reader->read(whole).ok());
    for (size_t length = 0; length < whole.size(); ++length) {
        ASSERT_TRUE(replace_file(file, std::span(whole).first(length)).ok());
        const auto cut = load_stamp(file);
        ASSERT_FALSE(cut.ok()) << length;
        EXPECT_NE(cut.message().find("loam_stamp_test.stamp"), std::string::npos) << "it says which file";
    }
    for (const size_t at : {size_t(0), size_t(8), size_t(16), whole.size() / 2, whole.size() - 1}) {
        std::vector<uint8_t> changed = whole;
        changed[at] ^= 0x40;
        ASSERT_TRUE(replace_file(file, changed).ok());
        EXPECT_FALSE(load_stamp(file).ok()) << at;
    }
    std::filesystem::remove(file);
}

TEST(stamp, sample_goes_through_the_texels_and_stays_between_black_and_white) {
    Stamp stamp = stamp_with(picture(16, 8, true, false));
    stamp.half_m = {32, 16};
    stamp.edge = 0;
    stamp.colour = true;
    const StampImage& image = *stamp.picture;
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 16; ++x) {
            const size_t texel = size_t(y * 16 + x);
            const StampSample sample = StampSampler(stamp)((x + 0.5) * 4 - 32, (y + 0.5) * 4 - 16);
            ASSERT_NEAR(sample.height, image.heights[texel] / 65535.0, 1e-12);
            ASSERT_NEAR(sample.color.y, image.colors[3 * texel + 1] / 255.0, 1e-12);
            ASSERT_EQ(sample.weight, 1);
        }
    std::mt19937 random(2);
    std::uniform_real_distribution<double> real(-40, 40);
    stamp.edge = 0.5;
    stamp.heading_rad = 0.7;
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
        const double dx = real(random), dy = real(random);
        const StampSample sample = StampSampler(stamp)(dx, dy);
        ASSERT_TRUE(sample.height >= 0 && sample.height <= 1 && sample.weight >= 0 && sample.weight <= 1);
        inside += sample.weight > 0;
        if (std::hypot(dx, dy) > std::hypot(32, 16)) {
            ASSERT_EQ(sample.weight, 0);
        }
        if (sample.weight == 0) {
            ASSERT_EQ(StampSampler(stamp).stamped_m(7.25, dx, dy), 7.25);
        }
    }
    EXPECT_GT(inside, 500);
    // Turned by a right angle clockwise: what was north is east.
    stamp.heading_rad = 1.5707963267948966;
    Stamp straight = stamp;
    straight.heading_rad = 0;
    EXPECT_NEAR(StampSampler(stamp)(9, -20).height, StampSampler(straight)(20, 9).height, 1e-9);
    // Mirrored.
    Stamp mirrored = straight;
    mirrored.half_m.x = -32;
    EXPECT_NEAR(StampSampler(mirrored)(11, 3).height, StampSampler(straight)(-11, 3).height, 1e-12);
}

TEST(stamp, pictures_of_one_texel_and_of_none) {
    Stamp dot = stamp_with(picture(1, 1, true, true));
    dot.edge = 0;
    for (const double at : {-50.0, -3.0, 0.0, 49.9, 50.0}) {
        EXPECT_NEAR(StampSampler(dot)(at, 0).height, dot.picture->heights[0] / 65535.0, 1e-12);
        EXPECT_NEAR(StampSampler(dot)(at, 0).weight, dot.picture->cover[0] / 255.0, 1e-12);
    }
    const Stamp none = stamp_with(nullptr);
    EXPECT_EQ(StampSampler(none).stamped_m(3, 0, 0), 3);
    EXPECT_FALSE(changes_heights(none) || changes_index(none));
    EXPECT_TRUE(Operator{.shape = none}.height_bounds().empty());
}

TEST(stamp, modes_do_what_they_say) {
    auto grey = std::make_shared<StampImage>();
    grey->width = grey->height = 1;
    grey->heights = {65535};
    Stamp stamp = stamp_with(grey);
    stamp.edge = 0;
    stamp.height_m = 20;
    stamp.base_m = 100;
    const auto on = [&](StampMode mode, double ground_m, double strength = 1) {
        stamp.mode = mode;
        stamp.strength = strength;
        return StampSampler(stamp).stamped_m(ground_m, 1, 1);
    };
    EXPECT_EQ(on(StampMode::add, 5), 25) << "without the base";
    EXPECT_EQ(on(StampMode::max, 5), 120);
    EXPECT_EQ(on(StampMode::max, 130), 130);
    EXPECT_EQ(on(StampMode::min, 5), 5);
    EXPECT_EQ(on(StampMode::min, 130), 120);
    EXPECT_EQ(on(StampMode::blend, 130), 120);
    EXPECT_EQ(on(StampMode::blend, 130, 0.5), 125);
    EXPECT_EQ(on(StampMode::max, 5, 0), 5);
    stamp.height_m = -20;
    EXPECT_EQ(on(StampMode::add, 5), -15);
}

TEST(stamp, names_cannot_leave_the_folder) {
    for (const char* name : {"", ".", "..", ".hidden", "../up", "a/b", "a\\b", "nul\nline", "caf\xc3\xa9"})
        EXPECT_FALSE(check_stamp_name(name).ok()) << name;
    EXPECT_FALSE(check_stamp_name(std::string(101, 'a')).ok());
    for (const char* name : {"ridge", "Ridge 2", "a.b-c_d"}) EXPECT_TRUE(check_stamp_name(name).ok()) << name;
}

}  // namespace
