// Handles: taking one to where it is changes nothing, taking it elsewhere puts it there, and what comes of it
// is an operator that the document takes.
#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "decal_fixture.h"
#include "editor/window/handles.h"
#include "runtime/document/command.h"
#include "runtime/document/operator_json.h"

namespace loam::window {
namespace {

std::string text_of(const OperatorShape& shape) {
    return operator_json(Operator{.id = 1, .order = 1, .shape = shape});
}

OperatorShape random_shape(std::mt19937& random, int kind) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const glm::dvec2 at(real(0, 300), real(0, 300));
    switch (kind) {
        case 0:
            return Crater{.x_m = at.x, .y_m = at.y, .radius_m = real(1, 30), .depth_m = real(0, 5)};
        case 1:
            return Footprint{.x_m = at.x, .y_m = at.y, .heading_rad = real(-3, 3), .length_m = real(0.2, 2)};
        case 2:
            return test::random_cutout(random, at, 4, 10);
        case 3:
            return test::random_earth(random, at, 4, 10);
        case 4:
            return test::random_event(random, at, 4, 10);
        case 5:
            return Stamp{.image = "a",
                         .x_m = at.x,
                         .y_m = at.y,
                         .half_m = {real(1, 9), -real(1, 9)},
                         .heading_rad = real(-3, 3)};
        default:
            return test::random_decal(random, at, 10);
    }
}

TEST(Handles, GoWhereTheyAreTakenAndTheDocumentTakesWhatComesOfIt) {
    std::mt19937 random(5);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    int dragged_count = 0;
    for (int i = 0; i < 700; ++i) {
        const OperatorShape shape = random_shape(random, i % 7);
        const std::vector<Handle> handles = handles_of(shape);
        ASSERT_FALSE(handles.empty());
        EXPECT_TRUE(handles[0].role == Handle::Role::move);
        for (size_t k = 0; k < handles.size(); ++k) {
            const Handle& handle = handles[k];
            const glm::dvec2 to = handle.at_m + glm::dvec2(real(-6, 6), real(-6, 6));
            const OperatorShape moved = dragged(shape, handle, {to, 7}, 4);
            EXPECT_TRUE(moved.index() == shape.index());
            const auto* event = std::get_if<Event>(&moved);
            if (event && event->kind == EventKind::crash && !check_shape(moved).ok())
                continue;  // too short: said
            const auto* cutout = std::get_if<Cutout>(&moved);
            if (cutout && cutout->form == CutoutForm::convex && !check_shape(moved).ok()) continue;  // flat: said
            ASSERT_TRUE(check_shape(moved).ok()) << check_shape(moved).message() << text_of(moved);
            const std::vector<Handle> after = handles_of(moved);
            ASSERT_EQ(after.size(), handles.size());
            ++dragged_count;
            // A radius' and a side's handle go as far as they were taken, in their own direction.
            const bool free = handle.role != Handle::Role::radius && handle.role != Handle::Role::side;
            const double missed = free ? glm::length(after[k].at_m - to)
                                       : std::abs(glm::length(after[k].at_m - after[k].from_m) -
                                                  std::max(glm::length(to - handle.from_m), 0.1));
            EXPECT_LT(missed, 1.01) << text_of(shape);  // limits of small ones
            if (free && handle.role != Handle::Role::turn) EXPECT_LT(missed, 1e-6) << text_of(shape);
        }
        // Nowhere: the same bits, but for those of a turn.
        const OperatorShape same = dragged(shape, handles[0], {handles[0].at_m, 4}, 4);
        if (i % 7 != 2) EXPECT_EQ(text_of(same), text_of(shape));
    }
    EXPECT_GT(dragged_count, 1500);
}

TEST(Handles, BoxesInSpaceTurnAroundTheUprightAndGrow) {
    for (const glm::dvec3& direction : {glm::dvec3(0, 0, -1), glm::dvec3(0, 0, 2), glm::dvec3(0.3, -0.4, -1),
                                        glm::dvec3(1, 0.2, -0.4), glm::dvec3(1e-8, 0, -1)}) {
        VolumeDecal volume{
            .center_m = {50, 60, 10}, .half_m = {3, -2, 4}, .direction = direction, .roll_rad = 0.7};
        std::vector<Handle> handles = handles_of(volume);
        ASSERT_EQ(handles.size(), 3u);
        for (const glm::dvec2& away : {glm::dvec2(9, 0), glm::dvec2(-5, -7), glm::dvec2(0.1, -4)}) {
            const glm::dvec2 to = glm::dvec2(50, 60) + away;
            const auto turned = std::get<VolumeDecal>(dragged(volume, handles[1], {to, 0}, 0));
            EXPECT_LT(glm::length(handles_of(turned)[1].at_m - to), 1e-6);
            EXPECT_NEAR(glm::normalize(turned.direction).z, glm::normalize(direction).z, 1e-12)
                << "as steep as before";
            EXPECT_EQ(turned.half_m.x, 3);
            EXPECT_LT(turned.half_m.y, 0) << "mirrored as before";
            EXPECT_EQ(turned.center_m, volume.center_m);
            const auto wider = std::get<VolumeDecal>(dragged(volume, handles[2], {to, 0}, 0));
            EXPECT_NEAR(glm::length(handles_of(wider)[2].at_m - glm::dvec2(50, 60)), glm::length(away), 1e-6);
            EXPECT_EQ(wider.direction, volume.direction);
        }
    }
    const Cutout box{.form = CutoutForm::box, .center_m = {5, 6, 1}, .half_m = {3, 2, 4}};
    EXPECT_EQ(handles_of(box).size(), 3u);
    const OperatorShape brush = Cutout{.form = CutoutForm::brush, .dabs = {{1, 2}}, .radius_m = 2};
    EXPECT_EQ(std::get<Cutout>(dragged(brush, handles_of(brush)[1], {1, 7, 0}, 0)).radius_m, 5);
    const OperatorShape hull =
        Cutout{.form = CutoutForm::convex, .corners = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, 4}}};
    const auto pulled = std::get<Cutout>(dragged(hull, handles_of(hull)[2], {9, 1, 3}, 1));
    EXPECT_EQ(pulled.corners[1], glm::dvec3(9, 1, 2)) << "as high above the ground as it was";
    EXPECT_EQ(pulled.corners[3], glm::dvec3(1, 1, 4));
    // Lying on its side, what is upright has no handle.
    EXPECT_EQ(handles_of(VolumeDecal{.half_m = {3, 2, 4}, .direction = {1, 0, 0}}).size(), 2u);
}

TEST(Handles, ATangentTurnsTheOneAcrossItsAnchor) {
    SplineDecal spline;
    for (int i = 0; i < 7; ++i) spline.points.push_back({10.0 * i, 0, 1, 4});
    const OperatorShape shape = spline;
    const std::vector<Handle> handles = handles_of(shape);
    ASSERT_EQ(handles.size(), 8u);
    const Handle& tangent = handles[5];  // control point 4, after the anchor 3
    ASSERT_EQ(tangent.index, 4);
    const auto moved = std::get<SplineDecal>(dragged(shape, tangent, {30, 20, 0}, 0));
    EXPECT_NEAR(moved.points[2].x_m, 30, 1e-9);
    EXPECT_NEAR(moved.points[2].y_m, -10, 1e-9) << "straight across, as far away as it was";
    const auto anchor = std::get<SplineDecal>(dragged(shape, handles[4], {30, 5, 3}, 1));
    for (const size_t i : {2, 3, 4}) EXPECT_EQ(anchor.points[i].y_m, 5);
    EXPECT_EQ(anchor.points[3].z_m, 3) << "as high above the ground as it was";
    EXPECT_EQ(anchor.points[1].y_m, 0);
}

}  // namespace
}  // namespace loam::window
