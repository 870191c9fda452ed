// The tools: from presses and drags over the ground to commands.
#include <gtest/gtest.h>

#include "editor/window/tools.h"

using namespace loam;
using namespace loam::window;

namespace {

struct Bench {
    uint64_t groups = 0;
    ToolController tools{{.next_group = [this] { return ++groups; }, .layer_at = [](double, double) { return std::string("rock"); }}};
    std::vector<Command> all;

    void step(double x, double y, bool pressed, bool released, double dt_s = 0.03, ToolInput extra = {}) {
        ToolInput input = extra;
        input.ground = glm::dvec3(x, y, 12);
        input.pressed = pressed;
        input.held = !released;
        input.released = released;
        input.dt_s = dt_s;
        for (Command& command : tools.update(input)) all.push_back(std::move(command));
    }
    template <typename T>
    const T& body(size_t i) const { return std::get<T>(all.at(i).body); }
};

TEST(Tools, AStrokeIsOneGroupAndItsDabsAreAQuarterOfTheRadiusApart) {
    Bench b;
    b.tools.brush().radius_m = 4;
    b.step(0, 0, true, false);
    b.step(3, 0, false, false);
    b.step(7, 0, false, true);
    b.step(0, 0, true, false);
    b.step(0, 0, false, true);
    size_t dabs = 0;
    for (size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(b.all[i].group, 1u);
        dabs += b.body<SculptCommand>(i).dabs.size();
    }
    EXPECT_EQ(dabs, 8u); // 0, 1, … 7
    EXPECT_EQ(b.all[3].group, 2u);
    EXPECT_FALSE(b.tools.stroking());
}

TEST(Tools, HoldingStillKeepsWorkingAtTheSameRateForAnyFrameRate) {
    for (const double dt : {0.008, 0.033, 0.1}) {
        Bench b;
        b.step(5, 5, true, false, dt);
        for (double t = 0; t < 1.0; t += dt) b.step(5, 5, false, false, dt);
        size_t dabs = 0;
        for (size_t i = 0; i < b.all.size(); ++i) dabs += b.body<SculptCommand>(i).dabs.size();
        EXPECT_NEAR(double(dabs), 1 + ToolController::kHeldDabsPerSecond, 2.0) << dt;
    }
}

TEST(Tools, ModifiersTurnAStroke) {
    Bench b;
    b.step(0, 0, true, false, 0.03, {.ctrl = true});
    EXPECT_EQ(b.body<SculptCommand>(0).mode, SculptMode::lower);
    b.step(0, 0, false, true);
    b.all.clear();
    b.step(0, 0, true, false, 0.03, {.shift = true});
    EXPECT_EQ(b.body<SculptCommand>(0).mode, SculptMode::smooth);
}

TEST(Tools, FlattenGoesToWhereTheStrokeBeganAndCtrlPicks) {
    Bench b;
    b.tools.tool = Tool::flatten;
    b.step(0, 0, true, false);
    EXPECT_DOUBLE_EQ(b.body<SculptCommand>(0).target_m, 12);
    b.step(0, 0, false, true);
    b.all.clear();
    b.step(0, 0, true, false, 0.03, {.ctrl = true});
    b.step(0, 0, false, true);
    EXPECT_TRUE(b.all.empty());
    EXPECT_TRUE(b.tools.settings.flatten_fixed);
    EXPECT_DOUBLE_EQ(b.tools.settings.flatten_target_m, 12);
}

TEST(Tools, PaintNeedsALayerOrATintAndCtrlPicksTheLayer) {
    Bench b;
    b.tools.tool = Tool::paint;
    b.step(0, 0, true, false);
    b.step(0, 0, false, true);
    EXPECT_TRUE(b.all.empty());
    b.step(0, 0, true, false, 0.03, {.ctrl = true});
    b.step(0, 0, false, true);
    EXPECT_EQ(b.tools.settings.layer, "rock");
    b.step(0, 0, true, false);
    EXPECT_EQ(b.body<PaintCommand>(0).layer, "rock");
}

TEST(Tools, ACraterIsPlacedOnReleaseAndADragSetsItsRadius) {
    Bench b;
    b.tools.tool = Tool::crater;
    b.tools.brush().radius_m = 8;
    b.step(100, 100, true, false);
    EXPECT_TRUE(b.all.empty());
    b.step(101, 100, false, true, 0.03, {.moved_px = 2});
    EXPECT_DOUBLE_EQ(b.body<CraterCommand>(0).crater.radius_m, 8);
    b.step(100, 100, true, false);
    b.step(120, 100, false, true, 0.03, {.moved_px = 90});
    const Crater& dragged = b.body<CraterCommand>(1).crater;
    EXPECT_DOUBLE_EQ(dragged.radius_m, 20);
    EXPECT_DOUBLE_EQ(dragged.x_m, 100);
    EXPECT_DOUBLE_EQ(dragged.depth_m, 20 * b.tools.settings.crater_depth_share);
    EXPECT_NE(dragged.seed, b.body<CraterCommand>(0).crater.seed);
}

TEST(Tools, AClickLeavesOneFootprintAndADragATrail) {
    Bench b;
    b.tools.tool = Tool::footprints;
    b.step(0, 0, true, false);
    b.step(0, 0, false, true, 0.03, {.camera_yaw_rad = 0.4});
    ASSERT_EQ(b.all.size(), 1u);
    EXPECT_DOUBLE_EQ(b.body<FootprintsCommand>(0).prints.at(0).heading_rad, 0.4);
    b.all.clear();
    b.step(0, 0, true, false);
    b.step(0, 6, false, false);
    b.step(0, 6, false, true);
    ASSERT_EQ(b.all.size(), 1u);
    EXPECT_GE(b.body<FootprintsCommand>(0).prints.size(), 7u);
}

TEST(Tools, OverTheSkyNothingHappensAndTheStrokeIsNotJoinedAcrossIt) {
    Bench b;
    b.tools.brush().radius_m = 4;
    b.tools.update({.pressed = true, .held = true});
    EXPECT_FALSE(b.tools.stroking());
    b.step(0, 0, true, false);
    b.tools.update({.held = true, .dt_s = 0.03});
    b.all.clear();
    b.step(100, 0, false, false);
    EXPECT_EQ(b.body<SculptCommand>(0).dabs.size(), 1u);
}

TEST(Tools, ALostCaptureEndsTheStroke) {
    Bench b;
    b.step(0, 0, true, false);
    EXPECT_TRUE(b.tools.stroking());
    b.tools.update({.ground = glm::dvec3(0)});
    EXPECT_FALSE(b.tools.stroking());
}

TEST(Tools, ADecalTurnsTowardsTheDragAndTakesTheBrush) {
    Bench b;
    b.tools.tool = Tool::decal;
    b.tools.settings.layer = "rock";
    b.tools.brush() = {.radius_m = 3, .strength = 0.8, .hardness = 0.75};
    b.tools.settings.decal.stretch = 2;
    b.step(10, 10, true, false);
    b.step(20, 10, false, false, 0.03, {.moved_px = 40});
    EXPECT_EQ(b.tools.outlines({}).size(), 1u);
    b.step(20, 10, false, true, 0.03, {.moved_px = 40});
    ASSERT_EQ(b.all.size(), 1u);
    const auto decal = std::get<TerrainDecal>(b.body<AddOperatorCommand>(0).shape);
    EXPECT_DOUBLE_EQ(decal.x_m, 10);
    EXPECT_NEAR(decal.heading_rad, 1.5707963, 1e-6) << "east";
    EXPECT_EQ(decal.half_m, glm::dvec2(3, 6));
    EXPECT_EQ(decal.material.layer, "rock");
    EXPECT_DOUBLE_EQ(decal.material.edge, 0.25);
    EXPECT_TRUE(b.tools.outlines({}).empty());
}

TEST(Tools, ACutoutIsBrushedOrPlacedAndCtrlCloses) {
    Bench b;
    b.tools.tool = Tool::cutout;
    b.tools.brush().radius_m = 4;
    b.step(10, 10, true, false);
    b.step(16, 10, false, false);
    b.step(16, 10, false, false, 3.0);  // resting adds nothing
    b.step(16, 10, false, true);
    ASSERT_FALSE(b.all.empty());
    size_t dabs = 0;
    for (size_t i = 0; i < b.all.size(); ++i) {
        const auto cutout = std::get<Cutout>(b.body<AddOperatorCommand>(i).shape);
        EXPECT_EQ(cutout.form, CutoutForm::brush);
        EXPECT_EQ(cutout.radius_m, 4);
        EXPECT_FALSE(cutout.fill);
        EXPECT_EQ(b.all[i].group, b.all[0].group);
        dabs += cutout.dabs.size();
    }
    EXPECT_EQ(dabs, 7u) << "a quarter of the radius apart";

    // A box turned as a decal is, closing.
    b.all.clear();
    b.tools.settings.cutout = {.form = CutoutForm::box, .stretch = 2, .depth_m = 3};
    b.step(10, 10, true, false, 0.03, {.ctrl = true});
    b.step(20, 10, false, false, 0.03, {.moved_px = 40});
    EXPECT_EQ(b.tools.outlines({}).size(), 1u);
    b.step(20, 10, false, true, 0.03, {.moved_px = 40});
    ASSERT_EQ(b.all.size(), 1u);
    const auto box = std::get<Cutout>(b.body<AddOperatorCommand>(0).shape);
    EXPECT_TRUE(box.fill);
    EXPECT_EQ(box.half_m, glm::dvec3(4, 8, 3));
    EXPECT_TRUE(holds(box, box.center_m + glm::dvec3(7.9, 0, 2.9))) << "its length lies to the east";
    EXPECT_FALSE(holds(box, box.center_m + glm::dvec3(0, 7.9, 0)));
    EXPECT_TRUE(check_command(b.all[0]).ok());
}

TEST(Tools, ARoadGoesFromClickToClickUntilItsLastPlaceIsClickedAgain) {
    Bench b;
    b.tools.tool = Tool::road;
    b.tools.brush().radius_m = 2;
    const auto click = [&](double x, double y) {
        b.step(x, y, true, false);
        b.step(x, y, false, true);
    };
    click(0, 0);
    EXPECT_TRUE(b.all.empty());
    EXPECT_FALSE(b.tools.end_road().has_value()) << "one place is no road";
    click(0, 0);
    click(50, 0);
    b.step(50, 0, true, false); // a place is dragged
    b.step(60, 20, false, false, 0.03, {.moved_px = 50});
    b.step(60, 20, false, true, 0.03, {.moved_px = 50});
    EXPECT_TRUE(b.all.empty());
    click(100, 0);
    EXPECT_TRUE(b.tools.drawing_road());
    EXPECT_EQ(b.tools.outlines({}).size(), 2u);
    click(100, 0);
    ASSERT_EQ(b.all.size(), 1u);
    const auto road = std::get<SplineDecal>(b.body<AddOperatorCommand>(0).shape);
    ASSERT_EQ(road.points.size(), 7u);
    EXPECT_EQ(road.points[3], (SplinePoint{60, 20, 12, 4}));
    EXPECT_EQ(road.carve, 1);
    EXPECT_FALSE(b.tools.drawing_road());
    click(0, 0);
    click(30, 0);
    b.tools.cancel();
    EXPECT_FALSE(b.tools.end_road().has_value());
}

} // namespace
