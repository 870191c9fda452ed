// The outliner's list and what it does, without a window.
#include <filesystem>

#include <unistd.h>

#include <gtest/gtest.h>

#include "editor/window/app.h"

namespace loam::window {
namespace {

class Objects : public testing::Test {
  protected:
    Objects() {
        folder_ = std::filesystem::temp_directory_path() / ("loam-objects-" + std::to_string(::getpid()));
        std::filesystem::remove_all(folder_);
        ProjectSettings settings;
        settings.name = "objects";
        settings.height_samples_x = settings.height_samples_y = 65;
        settings.layers = {{"grass", "layers/grass.layer"}, {"rock", "layers/rock.layer"}};
        EXPECT_TRUE(Document::create(folder_, settings).ok());
        auto opened = Session::open(folder_, {});
        EXPECT_TRUE(opened.ok()) << opened.message();
        session_ = std::move(*opened);
        app_.emplace(*session_, ui::Theme{});
    }
    ~Objects() override {
        app_.reset();
        session_.reset();
        std::filesystem::remove_all(folder_);
    }
    void add(OperatorShape shape) {
        if (const auto* crater = std::get_if<Crater>(&shape))
            EXPECT_TRUE(app_->apply({CraterCommand{*crater}}));
        else
            EXPECT_TRUE(app_->apply({AddOperatorCommand{std::move(shape)}}));
    }
    std::vector<uint64_t> ids() {
        std::vector<uint64_t> ids;
        for (const ObjectRow& row : app_->objects()) ids.push_back(row.id);
        return ids;
    }
    std::filesystem::path folder_;
    std::unique_ptr<Session> session_;
    std::optional<App> app_;
};

TEST_F(Objects, TheLastEvaluatedIsFirstAndAMoveChangesTwoPlaces) {
    EXPECT_TRUE(app_->objects().empty());
    EXPECT_EQ(app_->selected_row(), nullptr);
    for (int i = 0; i < 3; ++i) add(Crater{.x_m = 20.0 + i, .y_m = 30, .radius_m = 5});
    TerrainDecal decal;
    decal.material.layer = "rock";
    add(decal);
    add(Cutout{.form = CutoutForm::brush, .dabs = {{10, 10}}, .radius_m = 2});
    const std::vector<uint64_t> start = ids();
    ASSERT_EQ(start.size(), 5u);
    EXPECT_TRUE(std::is_sorted(start.rbegin(), start.rend()));
    EXPECT_EQ(app_->objects()[0].title, fmt::format("Cutout {}", start[0]));
    EXPECT_EQ(app_->objects()[1].title, fmt::format("Decal {} · rock", start[1]));
    EXPECT_TRUE(app_->objects()[0].bounds.contains(10, 10));
    EXPECT_LT(app_->objects()[0].bounds.width(), 4.1);

    app_->move_object(start[3], true);
    EXPECT_EQ(ids(), (std::vector{start[0], start[1], start[3], start[2], start[4]}));
    app_->move_object(start[3], true);
    app_->move_object(start[3], false);
    EXPECT_EQ(ids(), (std::vector{start[0], start[1], start[3], start[2], start[4]}));
    // At either end there is nowhere to go, and nobody else moves.
    app_->move_object(start[0], true);
    app_->move_object(start[4], false);
    app_->move_object(12345, true);
    EXPECT_EQ(ids(), (std::vector{start[0], start[1], start[3], start[2], start[4]}));
    // A move is one step of the history.
    for (int i = 0; i < 3; ++i) app_->undo_step();
    EXPECT_EQ(ids(), start);
}

TEST_F(Objects, EqualOrdersAreToldApart) {
    for (int i = 0; i < 3; ++i) add(Crater{.x_m = 20.0 + i, .y_m = 30, .radius_m = 5});
    const std::vector<uint64_t> start = ids();
    for (const uint64_t id : start) ASSERT_TRUE(app_->apply({ReorderCommand{.id = id, .order = 7}}));
    EXPECT_EQ(ids(), start) << "the id decides";
    app_->move_object(start[1], true);
    EXPECT_EQ(ids(), (std::vector{start[1], start[0], start[2]}));
    app_->move_object(start[0], false);
    EXPECT_EQ(ids(), (std::vector{start[1], start[2], start[0]}));
}

TEST_F(Objects, HidingAndRemovingAreCommands) {
    add(Crater{.x_m = 20, .y_m = 30, .radius_m = 5});
    const double hollow = app_->height_at(20, 30);
    app_->selected_object = ids()[0];
    app_->show_object(app_->selected_object, false);
    EXPECT_FALSE(app_->selected_row()->enabled);
    EXPECT_GT(app_->height_at(20, 30), hollow + 1);
    app_->show_object(app_->selected_object, true);
    EXPECT_EQ(app_->height_at(20, 30), hollow);
    app_->frame_object();
    app_->remove_object(app_->selected_object);
    EXPECT_TRUE(app_->objects().empty());
    EXPECT_EQ(app_->selected_object, 0u);
    app_->undo_step();
    EXPECT_EQ(app_->height_at(20, 30), hollow);
    EXPECT_EQ(app_->objects().size(), 1u);
}

}  // namespace
}  // namespace loam::window
