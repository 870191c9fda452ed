// A whole project from a recipe, small: what was generated is what the document gives back.
#include <gtest/gtest.h>

#include <filesystem>

#include "editor/recipe/index_map.h"
#include "editor/recipe/make_project.h"
#include "runtime/base/units.h"
#include "runtime/document/document.h"

namespace loam {
namespace {

class RecipeProject : public testing::Test {
  protected:
    void SetUp() override {
        folder_ =
            std::filesystem::temp_directory_path() /
            ("loam_recipe_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
        std::filesystem::remove_all(folder_);
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }
    std::filesystem::path folder_;
};

TEST_F(RecipeProject, HoldsTheGroundItWasMadeFrom) {
    const RecipeRequest request{"plain", 100, 5};
    const Status made = make_project(folder_, request, {}, 64);
    ASSERT_TRUE(made) << made.message();
    auto document = Document::open(folder_);
    ASSERT_TRUE(document) << document.message();
    const auto ground = make_ground(request, {});
    ASSERT_TRUE(ground);
    const ProjectSettings settings = (*document)->settings();
    EXPECT_EQ(settings.layers.size(), layer_recipe_names().size());
    ASSERT_EQ(settings.height_samples_x, ground->size);
    const auto lock = (*document)->read_lock();
    std::vector<int32_t> row(static_cast<size_t>(ground->size));
    for (const int j : {0, ground->size / 2, ground->size - 1}) {
        (*document)->read_heights_mm(0, 0, j, ground->size, 1, row.data());
        for (int i = 0; i < ground->size; ++i)
            ASSERT_EQ(row[static_cast<size_t>(i)],
                      height_mm_from_m(ground->height_m[static_cast<size_t>(j) * ground->size + i]));
    }
    const glm::ivec2 size = (*document)->index_size_texels();
    std::vector<IndexTexel> index(static_cast<size_t>(size.x) * size.y);
    (*document)->read_index(0, 0, 0, size.x, size.y, index.data());
    for (const IndexTexel& t : index) ASSERT_LT(t.layer, settings.layers.size());
    for (const LayerEntry& layer : settings.layers)
        EXPECT_TRUE(load_layer(folder_ / layer.file)) << layer.file;
}

TEST_F(RecipeProject, IsNotMadeOverAnother) {
    ASSERT_TRUE(make_project(folder_, {"plain", 64, 1}, {}, 64));
    EXPECT_FALSE(make_project(folder_, {"plain", 64, 2}, {}, 64));
}

TEST_F(RecipeProject, HeightsAloneGetAnIndexMap) {
    ProjectSettings settings;
    settings.height_samples_x = 90, settings.height_samples_y = 60;  // not square
    settings.height_spacing_m = 2;
    settings.index_spacing_m = 1;
    auto layers = make_layers_for(folder_, 1, 64);
    ASSERT_TRUE(layers) << layers.message();
    settings.layers = *layers;
    auto document = Document::create(folder_, settings);
    ASSERT_TRUE(document) << document.message();
    std::vector<int32_t> mm(90 * 60);
    for (int k = 0; k < 90 * 60; ++k)
        mm[static_cast<size_t>(k)] = k % 90 < 45 ? 0 : (k % 90 - 45) * 3500;  // flat, then 60°
    {
        BulkWriter writer(**document);
        ASSERT_TRUE(writer.write_height_rows(0, 60, mm));
        ASSERT_TRUE(writer.finish());
    }
    const Status made = make_index_from_heights(**document, {});
    ASSERT_TRUE(made) << made.message();
    const auto lock = (*document)->read_lock();
    std::vector<IndexTexel> row(170);
    (*document)->read_index(0, 0, 60, 170, 1, row.data());
    const auto rock = static_cast<uint16_t>((*document)->layer_index("rock")),
               snow = static_cast<uint16_t>((*document)->layer_index("snow"));
    int flat_rock = 0, steep_rock = 0;
    for (int i = 0; i < 75; ++i) flat_rock += row[static_cast<size_t>(i)].layer == rock;
    for (int i = 100; i < 170; ++i)
        steep_rock += row[static_cast<size_t>(i)].layer == rock || row[static_cast<size_t>(i)].layer == snow;
    EXPECT_LT(flat_rock, 5);
    EXPECT_GT(steep_rock, 45) << "of 70 texels at 60 degrees";
}

}  // namespace
}  // namespace loam
