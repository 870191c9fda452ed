// The window's arithmetic: render scale, frame pacing, strokes, gait, cameras, tools. No window and no device.
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "editor/window/camera_controller.h"
#include "editor/window/frame_pacer.h"
#include "editor/window/render_scale.h"
#include "editor/window/stroke.h"

using namespace loam;
using namespace loam::window;

namespace {

// A device whose frame costs a + b · scale² milliseconds, ± `noise`.
struct Plant {
    double a_ms = 6, b_ms = 60, noise = 0;
    std::mt19937 random{7};
    double frame(double scale) {
        std::uniform_real_distribution<double> share(-noise, noise);
        return (a_ms + b_ms * scale * scale) * (1 + share(random));
    }
};

int run_frames(RenderScale& scale, Plant& plant, int count) {
    int changes = 0;
    for (int i = 0; i < count; ++i) {
        const float before = scale.scale();
        scale.add_frame(plant.frame(before));
        changes += scale.scale() != before;
    }
    return changes;
}

TEST(RenderScale, MeetsTheGoalFromEitherSide) {
    for (const float start : {0.3f, 0.6f, 1.0f})
        for (const double b : {20.0, 60.0, 120.0}) {
            RenderScale scale({.goal_ms = 33, .start = start});
            Plant plant{.b_ms = b};
            run_frames(scale, plant, 300);
            const double ms = plant.a_ms + b * scale.scale() * scale.scale();
            EXPECT_LE(ms, 33 * 1.06) << start << " " << b;
            // Not needlessly coarse: two steps more would miss the goal, or it is at its limit.
            const double finer = scale.scale() + 0.16;
            EXPECT_TRUE(scale.scale() >= 0.999f || plant.a_ms + b * finer * finer > 33 * 0.92) << start << " " << b;
        }
}

TEST(RenderScale, RestsOnceItHasArrived) {
    RenderScale scale({.goal_ms = 33, .start = 1.0f});
    Plant plant{.noise = 0.05};
    run_frames(scale, plant, 200);
    EXPECT_LE(run_frames(scale, plant, 1000), 2);
}

TEST(RenderScale, OneLateFrameChangesNothing) {
    RenderScale scale({.goal_ms = 33, .start = 0.6f});
    Plant plant;
    run_frames(scale, plant, 100);
    const float before = scale.scale();
    scale.add_frame(300);
    run_frames(scale, plant, 1);
    EXPECT_EQ(scale.scale(), before);
}

TEST(RenderScale, FollowsALoadWithinAFewFramesAndComesBack) {
    RenderScale scale({.goal_ms = 33, .start = 0.6f});
    Plant light{.b_ms = 40}, heavy{.b_ms = 160};
    run_frames(scale, light, 200);
    const float before = scale.scale();
    run_frames(scale, heavy, 12);
    EXPECT_LE(heavy.frame(scale.scale()), 33 * 1.1);
    run_frames(scale, light, 200);
    EXPECT_NEAR(scale.scale(), before, 0.06);
}

TEST(RenderScale, StaysWithinItsLimits) {
    RenderScale scale({.goal_ms = 33, .smallest = 0.3f, .largest = 1.0f, .start = 0.5f});
    Plant impossible{.a_ms = 100}, nothing{.a_ms = 1, .b_ms = 1};
    run_frames(scale, impossible, 200);
    EXPECT_FLOAT_EQ(scale.scale(), 0.3f);
    run_frames(scale, nothing, 200);
    EXPECT_FLOAT_EQ(scale.scale(), 1.0f);
    scale.add_frame(std::nan(""));
    scale.add_frame(-1);
    EXPECT_FLOAT_EQ(scale.scale(), 1.0f);
}

TEST(FramePacer, RefinesAfterQuietAndThenRests) {
    FramePacer pacer;
    pacer.changed(10);
    EXPECT_TRUE(pacer.due());
    for (int i = 0; i < FramePacer::kSettledFrames; ++i) pacer.drawn(true);
    EXPECT_FALSE(pacer.due()); // nothing new before the quiet time is over
    EXPECT_DOUBLE_EQ(pacer.wake_s(), 10 + FramePacer::kQuiet_s);
    pacer.advance(10.1);
    EXPECT_EQ(pacer.phase(), FramePacer::Phase::moving);
    pacer.advance(10.3);
    EXPECT_EQ(pacer.phase(), FramePacer::Phase::refining);
    for (int i = 0; i < FramePacer::kSettledFrames; ++i) {
        EXPECT_TRUE(pacer.due());
        pacer.drawn(true);
    }
    EXPECT_EQ(pacer.phase(), FramePacer::Phase::resting);
    EXPECT_FALSE(pacer.due());
    EXPECT_TRUE(std::isinf(pacer.wake_s()));
}

TEST(FramePacer, RefiningDoesNotFallBackForPagesThatItAskedForItself) {
    FramePacer pacer;
    pacer.changed(0);
    for (int i = 0; i < 8; ++i) pacer.drawn(true);
    pacer.advance(1);
    ASSERT_EQ(pacer.phase(), FramePacer::Phase::refining);
    for (int i = 0; i < 50; ++i) {
        pacer.drawn(false);
        pacer.advance(1 + i * 0.1);
        EXPECT_EQ(pacer.phase(), FramePacer::Phase::refining);
    }
    pacer.changed(9);
    EXPECT_EQ(pacer.phase(), FramePacer::Phase::moving);
}

TEST(FramePacer, ASceneThatNeverSettlesRestsAnyway) {
    FramePacer pacer;
    pacer.changed(0);
    int frames = 0;
    for (double now = 0; pacer.phase() != FramePacer::Phase::resting && frames < 10'000; now += 0.03, ++frames) {
        pacer.advance(now);
        pacer.drawn(false);
    }
    EXPECT_EQ(pacer.phase(), FramePacer::Phase::resting);
    EXPECT_LT(frames, 1000);
}

TEST(Stroke, DabsAreEquallyFarApartHoweverTheDragWasCut) {
    std::vector<glm::dvec2> whole, cut;
    StrokeSpacer a, b;
    a.begin({0, 0});
    a.extend({10, 0}, 0.7, whole);
    b.begin({0, 0});
    for (double x : {0.1, 0.15, 2.0, 2.0, 2.9, 7.31, 10.0}) b.extend({x, 0}, 0.7, cut);
    ASSERT_EQ(whole.size(), 15u);
    ASSERT_EQ(cut.size(), whole.size());
    for (size_t i = 0; i < whole.size(); ++i) {
        EXPECT_NEAR(whole[i].x, 0.7 * double(i), 1e-9);
        EXPECT_NEAR(cut[i].x, whole[i].x, 1e-9);
    }
}

TEST(Stroke, APressAloneIsOneDabAndALongJumpIsBounded) {
    StrokeSpacer spacer;
    std::vector<glm::dvec2> dabs;
    spacer.begin({3, 4});
    spacer.extend({3, 4}, 1, dabs);
    EXPECT_EQ(dabs.size(), 1u);
    dabs.clear();
    spacer.extend({3, 4}, 1, dabs);
    EXPECT_TRUE(dabs.empty());
    spacer.extend({100'003, 4}, 0.01, dabs);
    EXPECT_LE(dabs.size(), size_t(StrokeSpacer::kMostDabs) + 1);
}

TEST(Gait, FeetAlternateAStepApartBesideTheLineAndPointAlongIt) {
    Gait gait;
    const GaitDesc desc;
    std::vector<Footprint> prints;
    gait.begin({0, 0});
    for (int i = 1; i <= 100; ++i) gait.extend({0.1 * i, 0}, desc, 5, prints); // 10 m to the east
    ASSERT_NEAR(double(prints.size()), 10 / 0.75, 1.5);
    for (size_t i = 0; i < prints.size(); ++i) {
        EXPECT_EQ(prints[i].foot, int(i % 2));
        EXPECT_NEAR(prints[i].heading_rad, M_PI / 2, 1e-6);
        // Going east, left is north.
        EXPECT_NEAR(prints[i].y_m, (i % 2 == 0 ? 1 : -1) * desc.width_share * desc.length_m, 1e-6);
        if (i > 0) {
            EXPECT_NEAR(prints[i].x_m - prints[i - 1].x_m, 0.75, 1e-6);
        }
    }
}

TEST(Gait, ATremblingHandDoesNotTurnTheFeet) {
    Gait gait;
    std::vector<Footprint> prints;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> jitter(-0.04, 0.04);
    gait.begin({0, 0});
    for (int i = 1; i <= 200; ++i) gait.extend({jitter(random), 0.05 * i}, {}, 1, prints);
    ASSERT_GT(prints.size(), 8u);
    for (size_t i = 1; i < prints.size(); ++i) EXPECT_LT(std::abs(prints[i].heading_rad), 0.9);
}

CameraController controller(const Camera& camera, double ground_m = 0) {
    return CameraController(camera, [ground_m](double, double) { return ground_m; });
}

TEST(CameraController, OrbitKeepsThePivotWhereItIsInThePicture) {
    Camera camera{.position_m = {10, -40, 30}, .yaw_rad = 0.2, .pitch_rad = -0.5};
    CameraController c = controller(camera);
    const glm::dvec3 pivot(14, 6, 2);
    const auto place = [&](const Camera& eye) {
        const glm::dvec3 d = pivot - eye.position_m;
        return glm::dvec3(glm::dot(d, eye.right()), glm::dot(d, eye.forward()), glm::dot(d, eye.up()));
    };
    const glm::dvec3 before = place(camera);
    CameraInput input{.drag = CameraInput::Drag::orbit, .picture_px = {800, 600}, .under_cursor = pivot, .dt_s = 0.02};
    for (int i = 0; i < 20; ++i) {
        input.moved_px = {7.0, i % 2 ? 3.0 : -2.0};
        EXPECT_TRUE(c.update(input));
        EXPECT_NEAR(glm::length(place(c.camera()) - before), 0, 1e-6);
    }
}

TEST(CameraController, PanHoldsTheGroundUnderTheCursor) {
    Camera camera{.position_m = {0, 0, 50}, .pitch_rad = -1.2};
    CameraController c = controller(camera);
    const glm::dvec3 ray = camera.ray(300, 250, 800, 600);
    const glm::dvec3 held = camera.position_m + ray * (50 / -ray.z);
    CameraInput input{.drag = CameraInput::Drag::pan, .picture_px = {800, 600}, .under_cursor = held, .dt_s = 0.02};
    input.moved_px = {40, -25};
    c.update(input);
    const Camera& eye = c.camera();
    const glm::dvec4 clip = eye.clip_from_rel(800, 600) * glm::dvec4(held - eye.position_m, 1);
    EXPECT_NEAR((clip.x / clip.w * 0.5 + 0.5) * 800, 340, 0.5);
    EXPECT_NEAR((clip.y / clip.w * 0.5 + 0.5) * 600, 225, 0.5);
}

TEST(CameraController, ZoomComesNearerWithoutEverPassingTheGround) {
    Camera camera{.position_m = {0, 0, 5000}, .pitch_rad = -1.4};
    CameraController c = controller(camera);
    double last = 1e9;
    for (int i = 0; i < 80; ++i) {
        const Camera& eye = c.camera();
        const glm::dvec3 ray = eye.ray(400, 300, 800, 600);
        const glm::dvec3 hit = eye.position_m + ray * (eye.position_m.z / -ray.z);
        const double distance = glm::length(hit - eye.position_m);
        EXPECT_LE(distance, last + 1e-9);
        last = distance;
        c.update({.cursor_px = {400, 300}, .picture_px = {800, 600}, .under_cursor = hit, .wheel = 1, .dt_s = 0.02});
    }
    EXPECT_LT(last, 1.0);
    EXPECT_GE(c.camera().position_m.z, CameraController::kClearance_m - 1e-9);
}

TEST(CameraController, FlyingIsAsFastAsTheHeightSuggestsAndStops) {
    for (const double height : {1.0, 100.0, 10'000.0}) {
        CameraController c = controller({.position_m = {0, 0, height}, .pitch_rad = 0});
        CameraInput input{.drag = CameraInput::Drag::look, .picture_px = {800, 600}, .ahead = 1, .dt_s = 0.02};
        for (int i = 0; i < 50; ++i) EXPECT_TRUE(c.update(input));
        const double gone = c.camera().position_m.y;
        EXPECT_GT(gone, 0.3 * std::min(height, 4000.0));
        EXPECT_LT(gone, 2 * height + 1);
        input.drag = CameraInput::Drag::none;
        input.ahead = 0;
        for (int i = 0; i < 100; ++i) c.update(input);
        EXPECT_FALSE(c.moving());
    }
}

TEST(CameraController, StaysAboveTheGroundUnlessToldOtherwise) {
    CameraController c = controller({.position_m = {0, 0, 10}}, 20);
    EXPECT_TRUE(c.update({.dt_s = 0.02}));
    EXPECT_NEAR(c.camera().position_m.z, 20 + CameraController::kClearance_m, 1e-9);
    c.keep_above_ground = false;
    c.set_camera({.position_m = {0, 0, 5}});
    EXPECT_FALSE(c.update({.dt_s = 0.02}));
    EXPECT_NEAR(c.camera().position_m.z, 5, 1e-9);
}

TEST(CameraController, AJumpWaitsForItsPagesButNotForLong) {
    const Camera far{.position_m = {900, 900, 300}, .yaw_rad = 1};
    CameraController c = controller({.position_m = {0, 0, 50}});
    EXPECT_FALSE(c.destination());
    c.jump_to(far);
    ASSERT_TRUE(c.destination());
    EXPECT_EQ(c.destination()->position_m, far.position_m);
    EXPECT_TRUE(c.update({.dt_s = 0.02}));
    EXPECT_TRUE(c.moving());
    EXPECT_EQ(c.camera().position_m, glm::dvec3(0, 0, 50));
    c.arrive();
    EXPECT_EQ(c.camera().position_m, far.position_m);
    EXPECT_FALSE(c.moving() || c.destination());
    // Nobody says that it is ready.
    c.jump_to({.position_m = {0, 0, 50}});
    double waited_s = 0;
    while (c.moving()) c.update({.dt_s = 0.02}), waited_s += 0.02;
    EXPECT_NEAR(waited_s, CameraController::kLongestWait_s, 0.03);
    EXPECT_EQ(c.camera().position_m, glm::dvec3(0, 0, 50));
    // Steering ends it.
    c.jump_to(far);
    c.update({.drag = CameraInput::Drag::look, .dt_s = 0.02});
    EXPECT_FALSE(c.destination());
}

TEST(CameraController, AFlightTellsWhereItEnds) {
    CameraController c = controller({.position_m = {100, -500, 300}, .yaw_rad = 0.7, .pitch_rad = -0.3});
    c.frame({20, 30, 4}, 12);
    ASSERT_TRUE(c.destination());
    const Camera told = *c.destination();
    for (int i = 0; i < 40; ++i) c.update({.dt_s = 0.02});
    EXPECT_LT(glm::length(c.camera().position_m - told.position_m), 1e-9);
    EXPECT_EQ(c.camera().pitch_rad, told.pitch_rad);
    EXPECT_FALSE(c.destination());
}

TEST(CameraController, FramingBringsTheTargetToTheMiddle) {
    CameraController c = controller({.position_m = {100, -500, 300}, .yaw_rad = 0.7, .pitch_rad = -0.3});
    const glm::dvec3 target(20, 30, 4);
    c.frame(target, 12);
    for (int i = 0; i < 40; ++i) c.update({.dt_s = 0.02});
    EXPECT_FALSE(c.moving());
    const Camera& eye = c.camera();
    const glm::dvec3 d = target - eye.position_m;
    EXPECT_NEAR(glm::dot(glm::normalize(d), eye.forward()), 1, 1e-6);
    EXPECT_LT(glm::length(d), 12 * 6);
}

} // namespace
