#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "editor/session.h"
#include "editor/text_numbers.h"

namespace loam {
namespace {

TEST(CameraText, degrees_become_radians) {
    const auto camera = parse_camera("1, -2.5 ,3e2,90,-45,60");
    ASSERT_TRUE(camera.ok()) << camera.message();
    EXPECT_EQ(camera->position_m, glm::dvec3(1, -2.5, 300));
    EXPECT_DOUBLE_EQ(camera->yaw_rad, std::numbers::pi / 2);
    EXPECT_DOUBLE_EQ(camera->pitch_rad, -std::numbers::pi / 4);
    EXPECT_DOUBLE_EQ(camera->fov_y_rad, std::numbers::pi / 3);
}

TEST(CameraText, the_field_of_view_may_be_left_out) {
    const auto camera = parse_camera("0,0,10,0,0");
    ASSERT_TRUE(camera.ok());
    EXPECT_DOUBLE_EQ(camera->fov_y_rad, Camera().fov_y_rad);
}

TEST(CameraText, what_is_no_camera_is_refused) {
    for (const char* text : {"", "1", "1,2,3,4", "1,2,3,4,5,6,7", "1,2,3,4,x", "1,2,3,4,", "1,2,nan,4,5",
                             "1,2,inf,4,5", "0,0,0,0,91", "0,0,0,0,0,0", "0,0,0,0,0,180", "1;2;3;4;5"})
        EXPECT_FALSE(parse_camera(text).ok()) << text;
}

TEST(CameraText, look_at_points_from_eye_to_target) {
    const auto camera = parse_look_at("0,0,10,0,100,10");
    ASSERT_TRUE(camera.ok()) << camera.message();
    const glm::dvec3 forward = camera->forward();
    EXPECT_NEAR(forward.x, 0, 1e-12);
    EXPECT_NEAR(forward.y, 1, 1e-12);
    EXPECT_NEAR(forward.z, 0, 1e-12);
    EXPECT_FALSE(parse_look_at("1,2,3,1,2,3").ok());
}

TEST(TextNumbers, the_whole_text_must_be_a_number) {
    EXPECT_EQ(parse_number("+12").value(), 12);
    EXPECT_EQ(parse_number("-.5").value(), -0.5);
    for (const char* text : {"", " 1", "1 ", "1x", "0x10", "+-1", "nan", "inf", "1e999"})
        EXPECT_FALSE(parse_number(text).ok()) << text;
    EXPECT_FALSE(parse_integer("1.5").ok());
    EXPECT_FALSE(parse_integer("99999999999999999999").ok());
}

}  // namespace
}  // namespace loam
