// Imagery: its file, its levels, and how it lies on the index map's grid.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "runtime/base/srgb.h"
#include "runtime/document/imagery.h"

namespace {

using namespace loam;

struct ImageryTest : testing::Test {
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("loam-imagery-" + std::to_string(::getpid()));
    std::filesystem::path file = folder / "a.imagery";
    ImageryTest() { std::filesystem::create_directories(folder); }
    ~ImageryTest() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    // texel(x, y): linear colour times cover, and cover.
    template <typename Texel>
    void write(const ImageryShape& shape, const Texel& texel) const {
        auto writer = ImageryWriter::create(file, shape);
        ASSERT_TRUE(writer.ok()) << writer.message();
        std::vector<glm::vec4> row(size_t(shape.width));
        for (int y = shape.height - 1; y >= 0; --y) {
            for (int x = 0; x < shape.width; ++x) row[size_t(x)] = texel(x, y);
            ASSERT_TRUE((*writer)->append_row(row).ok());
        }
        const Status finished = (*writer)->finish();
        ASSERT_TRUE(finished.ok()) << finished.message();
    }
};

ProjectSettings settings_of(double extent_m, double index_spacing_m) {
    ProjectSettings s;
    s.height_samples_x = s.height_samples_y = int(extent_m) + 1;
    s.index_spacing_m = index_spacing_m;
    return s;
}

glm::vec4 grey(uint8_t byte) {
    const float v = float(linear_of_srgb8(byte));
    return {v, v, v, 1};
}

TEST_F(ImageryTest, EveryTexelOfEveryLevelComesBack) {
    const ImageryShape shape{.width = 700, .height = 517, .spacing_m = 0.5};
    EXPECT_EQ(shape.level_count(), 3);
    write(shape, [](int x, int y) { return grey(uint8_t(x * 7 + y * 13)); });
    const auto opened = ImageryFile::open(file);
    ASSERT_TRUE(opened.ok()) << opened.message();
    EXPECT_EQ((*opened)->shape(), shape);
    std::vector<uint8_t> tile(size_t(4) * kImageryTile * kImageryTile);
    for (int ty = 0; ty < 3; ++ty)
        for (int tx = 0; tx < 3; ++tx) {
            ASSERT_TRUE((*opened)->read_tile(0, tx, ty, tile).ok());
            for (int j = 0; j < kImageryTile; ++j)
                for (int i = 0; i < kImageryTile; ++i) {
                    const int x = tx * kImageryTile + i, y = ty * kImageryTile + j;
                    const uint8_t* got = &tile[size_t(4) * size_t(j * kImageryTile + i)];
                    const bool inside = x < shape.width && y < shape.height;
                    ASSERT_EQ(got[0], inside ? uint8_t(x * 7 + y * 13) : 0) << x << ", " << y;
                    ASSERT_EQ(got[3], inside ? 255 : 0);
                }
        }
    // The coarsest level: means of four by four in linear light, of fewer at the far edges.
    ASSERT_TRUE((*opened)->read_tile(2, 0, 0, tile).ok());
    for (const auto& [x, y] : {std::pair(0, 0), {100, 77}, {174, 129}, {174, 3}}) {
        double sum = 0, count = 0;
        for (int j = 4 * y; j < std::min(4 * y + 4, shape.height); ++j)
            for (int i = 4 * x; i < std::min(4 * x + 4, shape.width); ++i, ++count)
                sum += linear_of_srgb8(uint8_t(i * 7 + j * 13));
        EXPECT_NEAR(tile[size_t(4) * size_t(y * kImageryTile + x)], srgb_of_linear(sum / count) * 255, 0.61)
            << x << ", " << y;
    }
}

// Where half of the texels have no cover, the others' colour is not darkened by them.
TEST_F(ImageryTest, CoarserLevelsTakeColoursFromWhatIsCovered) {
    write({.width = 512, .height = 300, .spacing_m = 1},
          [](int x, int) { return x % 2 == 0 ? grey(180) : glm::vec4(0); });
    const auto opened = ImageryFile::open(file);
    ASSERT_TRUE(opened.ok());
    std::vector<uint8_t> tile(size_t(4) * kImageryTile * kImageryTile);
    ASSERT_TRUE((*opened)->read_tile(1, 0, 0, tile).ok());
    EXPECT_EQ(tile[0], 180);
    EXPECT_EQ(tile[3], 128);
}

TEST_F(ImageryTest, DamageIsFoundAndSaid) {
    write({.width = 300, .height = 300, .spacing_m = 1}, [](int x, int y) { return grey(uint8_t(x ^ y)); });
    std::string bytes;
    {
        std::ifstream stream(file, std::ios::binary);
        bytes.assign(std::istreambuf_iterator<char>(stream), {});
    }
    const auto put = [&](const std::string& text) {
        std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
    };
    for (const size_t length : {size_t(0), size_t(10), size_t(60), bytes.size() / 2, bytes.size() - 1}) {
        put(bytes.substr(0, length));
        EXPECT_FALSE(ImageryFile::open(file).ok()) << length;
    }
    std::string other = bytes;
    other[8] = char(0xff), other[9] = char(0xff), other[10] = char(0xff);  // its width
    put(other);
    EXPECT_FALSE(ImageryFile::open(file).ok());
    other = bytes;
    other[100] = char(other[100] ^ 1);  // in the first tile
    put(other);
    const auto opened = ImageryFile::open(file);
    ASSERT_TRUE(opened.ok());
    std::vector<uint8_t> tile(size_t(4) * kImageryTile * kImageryTile);
    int failed = 0;
    for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) failed += !(*opened)->read_tile(0, x, y, tile).ok();
    EXPECT_EQ(failed, 1);
    // A writer that ends early leaves what was there.
    put(bytes);
    { auto writer = ImageryWriter::create(file, {.width = 4, .height = 4, .spacing_m = 1}); }
    EXPECT_TRUE(ImageryFile::open(file).ok());
    EXPECT_FALSE(std::filesystem::exists(file.string() + ".new"));
}

TEST_F(ImageryTest, ItsTexelsAreNoFinerThanThePictureNorTheGrid) {
    const ProjectSettings s = settings_of(1000, 1);
    EXPECT_EQ(imagery_shape(s, 0.1), (ImageryShape{2000, 2000, 0.5}));
    EXPECT_EQ(imagery_shape(s, 1.99), (ImageryShape{1000, 1000, 1}));
    EXPECT_EQ(imagery_shape(s, 2.0), (ImageryShape{500, 500, 2}));
    EXPECT_EQ(imagery_shape(s, 1000), (ImageryShape{2, 2, 512}));  // a picture of one pixel
    // 16.8 km at the finest: below the file's limit.
    EXPECT_LE(imagery_shape(settings_of(16'800, 0.25), 0.01).width, 1 << 18);
}

// On the grid: the file's own levels, those above the last, and finer ones between its texels.
TEST_F(ImageryTest, LevelsOfTheGridAreTheFilesOrBetweenItsTexels) {
    const ProjectSettings s = settings_of(1000, 1);
    const ImageryShape shape = imagery_shape(s, 4.5);
    ASSERT_EQ(shape, (ImageryShape{250, 250, 4}));
    write(shape, [](int x, int y) { return grey(uint8_t(x < 125 ? 40 + y % 2 : 200)); });
    const auto imagery = Imagery::open(file, s);
    ASSERT_TRUE(imagery.ok()) << imagery.message();
    const auto at = [&](int level, int x, int y) {
        uint32_t texel = 0;
        (*imagery)->read(level, x, y, 1, 1, &texel);
        return texel & 0xff;
    };
    EXPECT_EQ(at(3, 3, 4), 40u);  // the file's level 0 is the grid's level 3
    EXPECT_EQ(at(3, 3, 5), 41u);
    EXPECT_EQ(at(3, -20, -9), 40u);  // beyond the map the nearest inside
    EXPECT_EQ(at(3, 3000, 3000), 200u);
    EXPECT_EQ(at(9, 0, 0), 40u);  // coarser than the file's last level
    // Level 0 has eight texels a texel of the file: halfway between 124 and 125 it is half of both.
    EXPECT_EQ(at(0, 124 * 8 + 1, 4 * 8 + 3), 40u);
    EXPECT_NEAR(at(0, 124 * 8 + 7, 4 * 8 + 3), 40 + 160 * (3.5 / 8), 1);
    EXPECT_NEAR(at(0, 125 * 8, 4 * 8 + 3), 40 + 160 * (4.5 / 8), 1);
    EXPECT_EQ(at(0, 125 * 8 + 5, 4 * 8 + 3), 200u);
    // One window or many: the same texels.
    std::vector<uint32_t> whole(size_t(40) * 30), one(1);
    (*imagery)->read(1, 240, 310, 40, 30, whole.data());
    for (int i = 0; i < 40 * 30; i += 7) {
        (*imagery)->read(1, 240 + i % 40, 310 + i / 40, 1, 1, one.data());
        ASSERT_EQ(one[0], whole[size_t(i)]) << i;
    }
    // Another map's.
    const auto other = Imagery::open(file, settings_of(1001, 1));
    ASSERT_FALSE(other.ok());
    EXPECT_NE(other.message().find("another map"), std::string::npos) << other.message();
}

}  // namespace
