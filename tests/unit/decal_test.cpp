// Decals, splines and volumes as data: the curve against its closed form, the carve, bounds, commands.
#include <cmath>
#include <cstdio>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "decal_fixture.h"
#include "document_fixture.h"
#include "runtime/document/command.h"
#include "runtime/document/operator_json.h"
#include "runtime/document/spline_path.h"

namespace {

using namespace loam;
using test::take;

Operator prepared(OperatorShape shape) {
    Operator op{1, 1, true, std::move(shape)};
    prepare(op);
    return op;
}

double distance_to(const SplineSegment& s, glm::dvec2 at, double* along = nullptr) {
    const glm::dvec2 away = at - s.from_m;
    const double a = std::clamp(away.x * s.direction.x + away.y * s.direction.y, 0.0, s.length_m);
    if (along) *along = a;
    return std::hypot(away.x - a * s.direction.x, away.y - a * s.direction.y);
}

// The largest distance of the curve from its segments, sideways and in height.
glm::dvec2 largest_error(std::span<const SplinePoint> points, const SplinePath& path) {
    glm::dvec2 worst(0);
    for (size_t piece = 0; 3 * piece + 3 < points.size(); ++piece)
        for (int i = 0; i <= 2000; ++i) {
            const SplinePoint p = bezier_at(points, piece, i / 2000.0);
            double nearest = 1e30, height = 0;
            for (const SplineSegment& s : path.segments()) {
                double along = 0;
                const double d = distance_to(s, {p.x_m, p.y_m}, &along);
                if (d >= nearest) continue;
                nearest = d;
                height = std::abs(p.z_m - (s.z_from_m + along / s.length_m * (s.z_to_m - s.z_from_m)));
            }
            worst = {std::max(worst.x, nearest), std::max(worst.y, height)};
        }
    return worst;
}

const std::vector<SplinePoint> kBend = {{0, 0, 5, 6},    {40, 0, 7, 6},   {80, 30, 12, 6}, {80, 80, 10, 8},
                                        {80, 130, 8, 8}, {20, 140, 4, 5}, {-30, 120, 2, 4}};

TEST(spline_path, lies_within_the_tolerance_and_takes_more_segments_for_less) {
    size_t before = 0;
    std::printf("  tolerance m  segments  largest error sideways m  in height m  length m\n");
    for (const double tolerance : {1.0, 0.1, 0.01, 0.001}) {
        const SplinePath path(kBend, tolerance);
        const glm::dvec2 error = largest_error(kBend, path);
        std::printf("  %11g  %8zu  %24.6f  %11.6f  %8.3f\n", tolerance, path.segments().size(), error.x,
                    error.y, path.length_m());
        EXPECT_LE(error.x, tolerance);
        EXPECT_LE(error.y, 2 * tolerance) << "in height beside what is nearest in plan";
        EXPECT_GE(path.segments().size(), before);
        before = path.segments().size();
    }
    EXPECT_GT(largest_error(kBend, SplinePath(kBend, 5)).x, 0.01) << "a coarse path is seen to be coarse";
}

TEST(spline_path, measures_a_quarter_circle) {
    // The cubic's own error of the radius is 0.03 %.
    const double r = 100, k = 0.5522847498 * r;
    const SplinePath path(std::vector<SplinePoint>{{r, 0, 0, 4}, {r, k, 0, 4}, {k, r, 0, 4}, {0, r, 0, 4}});
    EXPECT_NEAR(path.length_m(), r * std::acos(-1.0) / 2, 0.05);
    for (const SplineSegment& s : path.segments()) EXPECT_NEAR(std::hypot(s.from_m.x, s.from_m.y), r, 0.04);
}

TEST(spline_path, stands_hard_control_points) {
    const auto soundly = [](const std::vector<SplinePoint>& points) {
        const SplinePath path(points);
        double at = 0;
        for (const SplineSegment& s : path.segments()) {
            EXPECT_GT(s.length_m, 0);
            EXPECT_NEAR(std::hypot(s.direction.x, s.direction.y), 1, 1e-12);
            EXPECT_NEAR(s.start_m, at, 1e-6);
            at += s.length_m;
        }
        EXPECT_TRUE(std::isfinite(path.length_m()));
        EXPECT_LE(largest_error(points, path).x, SplinePath::kTolerance_m);
        return path.length_m();
    };
    EXPECT_NEAR(soundly({{0, 0, 0, 4}, {0, 0, 0, 4}, {50, 0, 0, 4}, {50, 0, 0, 4}}), 50, 1e-6)
        << "coincident ends";
    EXPECT_NEAR(soundly({{0, 0, 0, 4}, {20, 20, 0, 4}, {40, 40, 0, 4}, {60, 60, 0, 4}}), std::hypot(60, 60),
                1e-6)
        << "collinear";
    EXPECT_GT(soundly({{0, 0, 0, 4}, {90, 0, 0, 4}, {-40, 0, 0, 4}, {50, 0, 0, 4}}), 55)
        << "doubling back on a line";
    EXPECT_GT(soundly({{0, 0, 0, 4}, {50, 50, 0, 4}, {0, 50, 0, 4}, {50, 0, 0, 4}}), 60) << "a cusp";
    EXPECT_GT(soundly({{0, 0, 0, 4}, {60, 40, 0, 4}, {-60, 40, 0, 4}, {0, 0, 0, 4}}), 60) << "a loop";
    EXPECT_TRUE(SplinePath(std::vector<SplinePoint>(4, {7, 7, 0, 4})).segments().empty()) << "a point";
}

TEST(spline_path, a_piece_knows_the_nearest_of_all_segments_within_its_reach) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-60, 60), width(0.5, 9), share(0, 1);
    int looked_at = 0;
    for (int round = 0; round < 40; ++round) {
        std::vector<SplinePoint> points(10);
        for (SplinePoint& p : points) p = {place(random), place(random), 0, width(random)};
        const SplinePath path(points);
        for (const SplinePiece& piece : path.pieces())
            for (int i = 0; i < 20; ++i) {
                const WorldRect reach = piece.line.grown(path.half_width_m());
                const glm::dvec2 at(reach.min_x + share(random) * reach.width(),
                                    reach.min_y + share(random) * reach.height());
                uint32_t nearest = 0;
                double best = 1e30;
                for (uint32_t k = 0; k < path.segments().size(); ++k)
                    if (const double d = distance_to(path.segments()[k], at); d < best) best = d, nearest = k;
                if (best > path.half_width_m()) continue;
                ++looked_at;
                EXPECT_TRUE(std::binary_search(piece.near.begin(), piece.near.end(), nearest));
            }
    }
    EXPECT_GT(looked_at, 1000);
}

TEST(spline, a_long_diagonal_road_dirties_a_narrow_strip) {
    SplineDecal road;
    road.points = {{0, 0, 0, 6}, {2300, 2400, 10, 6}, {4700, 4600, 20, 6}, {7000, 7100, 30, 6}};
    road.carve = 1;
    road.shoulder_m = 4;
    const Operator op = prepared(road);
    double area = 0;
    for (const WorldRect& rect : op.height_rects()) {
        area += rect.width() * rect.height();
        EXPECT_LT(std::max(rect.width(), rect.height()), 120);
    }
    EXPECT_GT(road.points.back().x_m * road.points.back().y_m, 49e6);
    EXPECT_LT(area, 2e6) << "of 50 km² that its one box has";
}

TEST(spline, carves_its_profile_by_position_only) {
    SplineDecal road;
    road.points = kBend;
    road.carve = 1;
    road.shoulder_m = 5;
    const Operator op = prepared(road);
    const SplinePath& path = *std::get<SplineDecal>(op.shape).path;
    const double spacing = 0.7;
    const auto compose = [&](int i0, int j0, int size) {
        std::vector<double> heights(size_t(size * size), 50.0);
        apply_height(op, {heights.data(), size, size, size, i0 * spacing, j0 * spacing, spacing});
        return heights;
    };
    const int size = 320, i0 = -100, j0 = -60;
    const auto whole = compose(i0, j0, size);
    const WorldRect bounds = op.height_bounds();
    int changed = 0, on_road = 0;
    double steepest = 0;
    for (int j = 0; j < size; ++j)
        for (int i = 0; i < size; ++i) {
            const glm::dvec2 at((i0 + i) * spacing, (j0 + j) * spacing);
            const double height = whole[size_t(j * size + i)];
            changed += height != 50.0;
            if (!bounds.grown(1e-4).contains(at.x, at.y)) {
                ASSERT_EQ(height, 50.0);
            }
            double best = 1e30, profile = 0, half = 0;
            for (const SplineSegment& s : path.segments()) {
                double along = 0;
                if (const double d = distance_to(s, at, &along); d < best) {
                    best = d;
                    profile = s.z_from_m + along / s.length_m * (s.z_to_m - s.z_from_m);
                    half = s.half_from_m + along / s.length_m * (s.half_to_m - s.half_from_m);
                }
            }
            if (best < half) {
                ++on_road;
                ASSERT_NEAR(height, profile, 1e-6) << "places are rounded to 2^-20 m";
            }
            if (best > half + 5) {
                ASSERT_EQ(height, 50.0);
            }
            if (i > 0) steepest = std::max(steepest, std::abs(height - whole[size_t(j * size + i - 1)]));
        }
    EXPECT_GT(on_road, 1000);
    EXPECT_GT(changed, on_road);
    EXPECT_LT(steepest, 1.5 * 48 / 5 * spacing * 1.3) << "the shoulder is a ramp";
    for (const auto& [i1, j1] : {std::pair{-10, 0}, {40, 20}, {90, 130}, {110, 60}}) {
        const auto part = compose(i1, j1, 31);
        for (int j = 0; j < 31; ++j)
            for (int i = 0; i < 31; ++i)
                ASSERT_EQ(part[size_t(j * 31 + i)], whole[size_t((j + j1 - j0) * size + i + i1 - i0)]);
    }
    SplineDecal moved = road;
    moved.points[2].z_m += 1;
    std::vector<double> other(size_t(size * size), 50.0);
    apply_height(prepared(moved), {other.data(), size, size, size, i0 * spacing, j0 * spacing, spacing});
    EXPECT_NE(other, whole) << "another profile is seen";
}

TEST(spline, its_ends_fade) {
    SplineDecal road;
    road.points = {{0, 0, 0, 6}, {30, 0, 0, 6}, {60, 0, 0, 6}, {90, 0, 0, 6}};
    road.carve = 1;
    road.fade_m = 20;
    const Operator op = prepared(road);
    std::vector<double> row(101, 10.0);
    apply_height(op, {row.data(), 101, 1, 101, -5, 0, 1});
    EXPECT_EQ(row[0], 10.0);
    EXPECT_NEAR(row[5], 10.0, 1e-12) << "at the end itself";
    EXPECT_NEAR(row[15], 5.0, 1e-9) << "half way";
    EXPECT_NEAR(row[50], 0.0, 1e-12);
}

TEST(volume, its_axes_are_right_angled_and_its_bounds_hold_its_corners) {
    std::mt19937 random(3);
    for (int round = 0; round < 200; ++round) {
        const OperatorShape shape = test::random_decal(random, {30, 40}, 5);
        const Operator op = prepared(shape);
        const auto* volume = std::get_if<VolumeDecal>(&op.shape);
        if (!volume) continue;
        const VolumeAxes axes = axes_of(*volume);
        EXPECT_NEAR(glm::dot(axes.x, axes.y), 0, 1e-12);
        EXPECT_NEAR(glm::dot(axes.z, volume->direction), -glm::length(volume->direction), 1e-12);
        EXPECT_NEAR(glm::length(glm::cross(axes.x, axes.y) - axes.z), 0, 1e-12);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at = volume->center_m + axes.x * volume->half_m.x * (corner & 1 ? 1.0 : -1.0) +
                                  axes.y * volume->half_m.y * (corner & 2 ? 1.0 : -1.0) +
                                  axes.z * volume->half_m.z * (corner & 4 ? 1.0 : -1.0);
            EXPECT_TRUE(op.texture_bounds().grown(1e-9).contains(at.x, at.y));
        }
        EXPECT_TRUE(op.height_bounds().empty());
    }
    const VolumeAxes down = axes_of(VolumeDecal{});
    EXPECT_NEAR(down.x.x, 1, 1e-12) << "from straight above x is east";
    EXPECT_NEAR(down.y.y, 1, 1e-12);
}

TEST(decals, are_the_same_after_their_text) {
    std::mt19937 random(11);
    for (int i = 0; i < 300; ++i) {
        const Operator op{uint64_t(i + 1), random(), i % 2 == 0, test::random_decal(random, {10, 20}, 6)};
        const Operator back = take(parse_operator(op.id, operator_json(op)));
        EXPECT_EQ(back.order, op.order);
        EXPECT_TRUE(back.shape.index() == op.shape.index());
        std::visit(
            [&]<typename Kind>(const Kind& kind) {
                if constexpr (!std::is_same_v<Kind, Crater> && !std::is_same_v<Kind, Footprint>) {
                    EXPECT_TRUE(std::get<Kind>(back.shape) == kind) << operator_json(op);
                }
            },
            op.shape);
        EXPECT_EQ(operator_json(back), operator_json(op));
    }
}

TEST(decals, bad_ones_are_refused_with_one_sentence) {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"cmd":"decal","x":1})", "decal: \"y\" is missing"},
        {R"({"cmd":"decal","x":1,"y":1,"half_m":[0,1]})", "half_m is 0, must be ±0.01 … 5000 m"},
        {R"({"cmd":"decal","x":1,"y":1,"half_m":[1,9000]})", "half_m is 9000, must be ±0.01 … 5000 m"},
        {R"({"cmd":"decal","x":1,"y":1,"half_m":3})", "decal: \"half_m\" must be 2 numbers"},
        {R"({"cmd":"decal","x":1,"y":1,"outline":"star"})",
         "decal: unknown outline \"star\" (known: rectangle, ellipse)"},
        {R"({"cmd":"decal","x":1,"y":1,"opacity":2})", "opacity is 2, must be 0 … 1"},
        {R"({"cmd":"decal","x":1,"y":1,"channels":{"heat":1}})", "decal: channels: unknown key \"heat\""},
        {R"({"cmd":"spline","points":[[0,0],[1,0],[2,0]]})",
         "a spline has 3 control points, must be 4, 7, 10"},
        {R"({"cmd":"spline","points":[[0,0],[1,0],[2,0],[3]]})",
         "spline: control point 3 must be [x, y], [x, y, z], [x, y, z, width] or [x, y, z, width, roll]"},
        {R"({"cmd":"spline","points":[[0,0],[1,0],[2,0],[3,0]],"carve":1})",
         "spline: control point 0 has no z, a carve needs every one"},
        {R"({"cmd":"spline","points":[[0,0],[1,0],[2,0],[3,0]],"width_m":0})",
         "the width at control point 0 is 0, must be 0.02 … 1000"},
        {R"({"cmd":"spline","points":[[5,5],[5,5],[5,5],[5,5]]})",
         "the control points of a spline all lie at one place"},
        {R"({"cmd":"spline","points":[[0,0],[1,null],[2,0],[3,0]]})",
         "spline: \"points[1]\" must be a number, found null"},
        {R"({"cmd":"spline","points":[[0,0],[300000,0],[2,0],[3,0]]})",
         "the control points of a spline span 599999 m, the limit is 200000 m"},
        {R"({"cmd":"volume","at":[0,0,0],"direction":[0,0,0]})",
         "the direction of a volume has no length, it must point where the volume projects"},
        {R"({"cmd":"volume","at":[0,0]})", "volume: \"at\" must be 3 numbers"},
        {R"({"cmd":"volume","at":[0,0,0],"half_m":[1,1,-1]})", "half_m is -1, must be 0.01 … 5000 m"},
        {R"({"cmd":"edit","id":1,"kind":"tree"})",
         "edit: unknown kind \"tree\" (known: crater, footprint, decal, spline, volume, stamp, cutout, "
         "slide, flood, event)"},
        {R"({"cmd":"reorder","id":1})", "reorder: \"order\" is missing"},
    };
    for (const auto& [json, expected] : cases) {
        const auto command = parse_command(json);
        ASSERT_FALSE(command.ok()) << json;
        EXPECT_EQ(command.message().substr(0, std::string(expected).size()), expected) << json;
    }
    SplineDecal bad;
    bad.points = kBend;
    bad.points[3].x_m = std::nan("");
    EXPECT_EQ(check_shape(bad).message().substr(0, 26), "control point 3 is at (nan");
    TerrainDecal decal;
    decal.half_m.x = INFINITY;
    EXPECT_FALSE(check_shape(decal).ok());
}

// A banked road's profile by its closed form: across it, over the shoulder, and along a roll that grows.
TEST(spline, rolls_its_carved_profile) {
    SplineDecal road{
        .points = {{0, 50, 10, 8, 0.2}, {40, 50, 10, 8, 0.2}, {80, 50, 10, 8, 0.2}, {120, 50, 10, 8, 0.2}}};
    road.carve = 1;
    road.shoulder_m = 4;
    const auto height_at = [](const Operator& op, double x, double y) {
        double height = 3;
        apply_height(op, {&height, 1, 1, 1, x, y, 1});
        return height;
    };
    const Operator level = prepared(road);
    for (const double across : {-3.5, -1.0, 0.0, 2.0, 3.9})  // to the right of the way is south
        EXPECT_NEAR(height_at(level, 60, 50 - across), 10 - std::tan(0.2) * across, 1e-6) << across;
    const double edge_m = 10 - std::tan(0.2) * 4;
    EXPECT_NEAR(height_at(level, 60, 50 - 6), 3 + 0.5 * (edge_m - 3), 1e-6) << "half way down the shoulder";
    EXPECT_EQ(height_at(level, 60, 50 - 8.01), 3);
    for (size_t i = 0; i < 4; ++i) road.points[i].roll_rad = 0.4 * double(i) / 3;
    const Operator growing = prepared(road);
    for (const double x : {10.0, 47.0, 111.0}) {
        const double bank = std::tan(0.4 * x / 120);
        EXPECT_NEAR(height_at(growing, x, 47), 10 - 3 * bank, 0.011) << "to a centimetre at its edge";
    }
    road.points[2].roll_rad = 1.3;
    EXPECT_NE(
        check_command({AddOperatorCommand{road, {}}}).message().find("the roll at control point 2 is 1.3"),
        std::string::npos);
}

// The closed form of a decal's displacement along its axes, at the origin and in the far corner of a large
// map.
TEST(terrain_decal, displaces_the_ground_where_it_covers_it) {
    for (const double corner_m : {0.0, 16'800.0})
        for (const auto outline : {DecalOutline::rectangle, DecalOutline::ellipse})
            for (const double edge : {0.0, 0.25, 1.0}) {
                TerrainDecal decal{.x_m = corner_m, .y_m = corner_m, .half_m = {-4, 2}, .heading_rad = 0.5};
                decal.outline = outline;
                decal.displacement_m = -0.75;
                decal.material.edge = edge;
                const Operator op = prepared(decal);
                ASSERT_EQ(op.height_rects().size(), 1u);
                EXPECT_EQ(op.height_bounds(), op.texture_bounds());
                const auto displaced_m = [&](double along_x_m, double along_y_m) {
                    const double s = std::sin(0.5), c = std::cos(0.5);
                    double height = 100;
                    apply_height(op, {&height, 1, 1, 1, corner_m + c * along_x_m + s * along_y_m,
                                      corner_m - s * along_x_m + c * along_y_m, 1});
                    return height - 100;
                };
                EXPECT_EQ(displaced_m(4.01, 0), 0);
                EXPECT_EQ(displaced_m(0, -2.01), 0);
                if (outline == DecalOutline::ellipse)
                    EXPECT_EQ(displaced_m(3.9, 1.9), 0) << "its corners are cut";
                EXPECT_NEAR(displaced_m(0, 0), -0.75, 1e-9);
                if (edge == 0) {
                    EXPECT_NEAR(displaced_m(3.99, 0), -0.75, 1e-9);
                    continue;
                }
                // Half way into the soft edge it is half as deep: the ramp is even about its middle.
                EXPECT_NEAR(displaced_m(0, 2 - edge), -0.375, 1e-5);
                EXPECT_NEAR(displaced_m(outline == DecalOutline::ellipse ? 4 - 2 * edge : 4 - edge, 0),
                            -0.375, 1e-5);
            }
    TerrainDecal wild{.half_m = {5, 5}};
    wild.displacement_m = std::nan("");
    EXPECT_FALSE(check_command({AddOperatorCommand{wild, {}}}).ok());
    wild.displacement_m = 51;
    EXPECT_NE(check_command({AddOperatorCommand{wild, {}}}).message().find("displacement_m is 51"),
              std::string::npos);
}

TEST(decals, are_added_edited_reordered_and_undone) {
    test::TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = test::create_small(path);
    const uint64_t empty = take(document->content_digest());
    const auto apply = [&](const char* json) { return take(document->apply(*parse_command(json))); };
    Dirt dirt = apply(R"({"cmd":"decal","x":50,"y":60,"half_m":[4,2],"layer":"dirt"})");
    ASSERT_EQ(dirt.texture.size(), 1u);
    EXPECT_TRUE(dirt.height.empty() && dirt.index.empty());
    EXPECT_EQ(dirt.texture[0], (WorldRect{46, 58, 54, 62}));
    apply(R"({"cmd":"spline","points":[[0,0,1],[50,10,2],[100,10,3],[150,80,4]],"width_m":5,"carve":1})");
    apply(R"({"cmd":"volume","at":[20,20,12],"half_m":[3,3,3]})");
    dirt = apply(R"({"cmd":"edit","id":1,"kind":"decal","x":80,"y":60,"half_m":[1,1]})");
    EXPECT_EQ(dirt.texture.size(), 2u) << "where it was and where it is";
    apply(R"({"cmd":"reorder","id":1,"order":9})");
    EXPECT_EQ(document->operators().back().id, 1u);
    EXPECT_EQ(document->apply(*parse_command(R"({"cmd":"decal","x":0,"y":0,"layer":"lava"})")).message(),
              "unknown layer \"lava\" (known: grass, dirt, scree)");
    EXPECT_EQ(document->apply(*parse_command(R"({"cmd":"reorder","id":77,"order":1})")).message(),
              "there is no operator 77");
    const uint64_t full = take(document->content_digest());
    document.reset();
    document = take(Document::open(path));
    EXPECT_EQ(take(document->content_digest()), full);
    EXPECT_TRUE(take(Document::verify(path)).empty());
    while (document->can_undo()) ASSERT_TRUE(document->undo().ok());
    EXPECT_EQ(take(document->content_digest()), empty);
    while (document->can_redo()) ASSERT_TRUE(document->redo().ok());
    EXPECT_EQ(take(document->content_digest()), full);
    EXPECT_NE(empty, full);
}

}  // namespace
