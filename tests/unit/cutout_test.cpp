// Cutouts: volumes against closed forms, pages against the plain rule, the table, queries and rays.
#include "runtime/document/cutout.h"

#include <cmath>
#include <limits>

#include <glm/geometric.hpp>

#include "runtime/document/dirt.h"
#include "runtime/maps/cutout_map.h"
#include "runtime/maps/height_map.h"
#include "tests/unit/map_fixture.h"

namespace loam {
namespace {

using test::MapFixture;
using test::MapFixtureDesc;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const MapFixtureDesc kGrounds[] = {
    {.samples_x = 300, .samples_y = 260},
    {.samples_x = 129, .samples_y = 65, .height_spacing_m = 0.3, .refine = 0},  // ends where a page does
    {.samples_x = 200, .samples_y = 333, .height_spacing_m = 7.7, .refine = 3}};

std::unique_ptr<CutoutMap> cpu_map(const Document& document) {
    auto map = CutoutMap::create(nullptr, document);
    EXPECT_TRUE(map.ok());
    return std::move(*map);
}

std::unique_ptr<HeightMap> cpu_heights(const Document& document) {
    auto heights = HeightMap::create(nullptr, document, {.gpu = false});
    EXPECT_TRUE(heights.ok());
    return std::move(*heights);
}

Operator prepared(const Cutout& cutout) {
    Operator op{.id = 1, .order = 1, .enabled = true, .shape = cutout};
    prepare(op);
    return op;
}

bool holds(const Operator& op, const glm::dvec3& place) {
    return loam::holds(std::get<Cutout>(op.shape), place);
}

std::vector<glm::dvec3> box_corners(const glm::dvec3& half) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.push_back(half * glm::dvec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1));
    return corners;
}

TEST(Cutout, VolumesHoldWhatTheirFormsSay) {
    std::mt19937 random(3);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution(low, high)(random);
    };
    const glm::dvec3 half(3, 2, 5);
    const Operator box = prepared({.form = CutoutForm::box, .half_m = half});
    const Operator hull = prepared({.form = CutoutForm::convex, .corners = box_corners(half)});
    const Operator tube = prepared({.form = CutoutForm::cylinder, .half_m = half});
    EXPECT_EQ(std::get<Cutout>(hull.shape).planes->size(), 6u);
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
        const glm::dvec3 p(real(-6, 6), real(-6, 6), real(-6, 6));
        const bool in_box = glm::all(glm::lessThanEqual(glm::abs(p), half));
        EXPECT_EQ(holds(box, p), in_box);
        EXPECT_EQ(holds(hull, p), in_box);
        const double round = (p.x / half.x) * (p.x / half.x) + (p.y / half.y) * (p.y / half.y);
        EXPECT_EQ(holds(tube, p), round <= 1 && std::abs(p.z) <= half.z);
        inside += in_box;
    }
    EXPECT_GT(inside, 100);
    EXPECT_TRUE(holds(box, half)) << "its surface is inside";
    EXPECT_TRUE(holds(hull, half));
    // Lying: its z along x.
    const Operator lying = prepared({.form = CutoutForm::box, .half_m = {1, 1, 5}, .direction = {-2, 0, 0}});
    EXPECT_TRUE(holds(lying, {4.9, 0.5, -0.5}));
    EXPECT_FALSE(holds(lying, {0, 0, 1.5}));
    EXPECT_FALSE(holds(lying, {5.1, 0, 0}));
    // At 16.8 km, turned, as at the origin.
    for (int i = 0; i < 500; ++i) {
        Cutout near = test::random_cutout(random, {0, 0}, 0, 4);
        Cutout far = near;
        const glm::dvec3 offset(16777.25, 16801.5, 812.125);
        far.center_m += offset;
        for (glm::dvec3& corner : far.corners) corner += offset;
        for (glm::dvec2& dab : far.dabs) dab += glm::dvec2(offset);
        const glm::dvec3 p(real(-5, 5), real(-5, 5), real(-5, 5));
        EXPECT_EQ(holds(prepared(near), p), holds(prepared(far), p + offset)) << i;
        const auto in_rects = [&](const std::vector<WorldRect>& rects) {
            return std::any_of(rects.begin(), rects.end(),
                               [&](const WorldRect& r) { return r.contains(p.x, p.y); });
        };
        if (holds(prepared(near), p)) EXPECT_TRUE(in_rects(rects_of(near)));
    }
}

TEST(Cutout, HullsOfOddCorners) {
    const glm::dvec3 a(0), b(10, 0, 0), c(0, 10, 0), d(0, 0, 10);
    EXPECT_EQ(hull_planes({a, b, c, d})->size(), 4u);
    EXPECT_EQ(hull_planes({a, b, c, d, a, b, {1, 1, 1}})->size(), 4u) << "twice, and within";
    EXPECT_FALSE(hull_planes({}).ok());
    EXPECT_FALSE(hull_planes({a, a, a, a}).ok());
    EXPECT_FALSE(hull_planes({a, b, {5, 0, 0}, {2, 0, 0}}).ok()) << "on a line";
    EXPECT_FALSE(hull_planes({a, b, c, {3, 3, 0}}).ok()) << "in a plane";
    EXPECT_FALSE(hull_planes({a, b, c, {3, 3, 1e-9}}).ok()) << "all but in a plane";
    EXPECT_TRUE(hull_planes({a, b * 1e-3, c * 1e-3, d * 1e-3}).ok()) << "a centimetre";
    EXPECT_TRUE(hull_planes({a, b * 500.0, c * 500.0, d * 0.01}).ok()) << "wide and thin";
}

TEST(Cutout, CommandsReadAndAreRefused) {
    std::mt19937 random(8);
    for (int i = 0; i < 200; ++i) {
        Cutout cutout = test::random_cutout(random, {100, 50}, 10, 8);
        if (cutout.form == CutoutForm::convex && !hull_planes(cutout.corners).ok()) continue;
        const Command command{.body = AddOperatorCommand{cutout}};
        const auto read = parse_command(to_json(command));
        ASSERT_TRUE(read.ok()) << read.message();
        EXPECT_EQ(std::get<Cutout>(std::get<AddOperatorCommand>(read->body).shape), cutout)
            << to_json(command);
    }
    const std::pair<const char*, const char*> refused[] = {
        {R"({"cmd":"cutout"})", "cutout: \"form\" is missing"},
        {R"({"cmd":"cutout","form":"ball"})",
         "cutout: unknown form \"ball\" (known: box, cylinder, convex, brush)"},
        {R"({"cmd":"cutout","form":"box"})", "cutout: \"at\" is missing"},
        {R"({"cmd":"cutout","form":"box","at":[0,0,0],"half_m":[1,0,1]})",
         "half_m is 0, must be 0.01 … 5000 m"},
        {R"({"cmd":"cutout","form":"box","at":[0,0,0],"direction":[0,0,0]})",
         "the direction of a cutout has no length, it must point where the cutout projects"},
        {R"({"cmd":"cutout","form":"brush","dabs":[[0,0]],"radius_m":-1})",
         "radius_m is -1, must be 0.01 … 5000"},
        {R"({"cmd":"cutout","form":"brush","dabs":[[0,0]],"at":[0,0,0]})",
         "cutout: unknown key \"at\" (known: cmd, dabs, fill, form, group, life, radius_m)"},
        {R"({"cmd":"cutout","form":"convex","corners":[[0,0,0]]})",
         "a convex cutout has 1 corners, must be 4 … 32"},
        {R"({"cmd":"cutout","form":"convex","corners":[[0,0,0],[1,0,0],[0,1,0],[1,1,0]]})",
         "the corners of a convex cutout span no volume: give four or more that do not lie in one plane"}};
    for (const auto& [text, sentence] : refused) {
        const auto read = parse_command(text);
        ASSERT_FALSE(read.ok()) << text;
        EXPECT_EQ(read.message(), sentence);
    }
}

// The rule in plain words: operators in order, each vertex of the base.
TEST(CutoutMap, PagesAreWhatThePlainRuleSays) {
    int all_cut = 0;
    for (const MapFixtureDesc& desc : kGrounds) {
        MapFixture ground(desc, 5);
        for (int i = 0; i < 12; ++i) ground.cutout();
        ground.crater(ground.document().bounds().max_x / 2, ground.document().bounds().max_y / 2, 20);
        const auto heights = cpu_heights(ground.document());
        const std::vector<Operator> operators = ground.document().operators();
        const glm::ivec2 last(desc.samples_x - 1, desc.samples_y - 1), pages = (last + 63) / 64;
        int cut = 0, differ = 0, close = 0;
        for (int py = 0; py < pages.y; ++py)
            for (int px = 0; px < pages.x; ++px) {
                CutoutBits bits;
                CutoutMap::compose(ground.document(), {px, py}, bits);
                for (int y = 0; y < kCutoutTexels; y += 3)
                    for (int x = 0; x < kCutoutTexels; ++x) {
                        const glm::ivec2 vertex = glm::ivec2(px, py) * 64 - 2 + glm::ivec2(x, y);
                        if (vertex.x < 0 || vertex.y < 0 || vertex.x > last.x || vertex.y > last.y) continue;
                        const glm::dvec2 at = glm::dvec2(vertex) * desc.height_spacing_m;
                        const double z = heights->height_m(at.x, at.y);
                        bool is = false, near = false;
                        for (const Operator& op : operators)
                            if (const auto* c = std::get_if<Cutout>(&op.shape)) {
                                if (loam::holds(*c, {at, z})) is = !c->fill;
                                // Heights of pages are floats: what is that close to a surface may be either.
                                const bool above = loam::holds(*c, {at, z + 1e-3}),
                                           below = loam::holds(*c, {at, z - 1e-3});
                                near = near || above != below;
                            }
                        cut += is;
                        close += near;
                        differ += is != bit_of(bits, x, y) && !near;
                    }
            }
        EXPECT_EQ(differ, 0);
        all_cut += cut;
        EXPECT_LT(close, cut / 10 + 50);
    }
    EXPECT_GT(all_cut, 1000);
}

TEST(CutoutMap, PagesAfterAnyHistoryEqualPagesFromNothing) {
    for (const MapFixtureDesc& desc : kGrounds) {
        MapFixture ground(desc, 17);
        const auto map = cpu_map(ground.document());
        std::vector<WorldRect> changed;
        const auto update = [&] {
            while (map->has_work()) map->update_without_gpu({10, 10, 5}, 3, changed);
        };
        const auto take = [&](const Dirt& dirt) {
            map->on_dirt(dirt.cutout);
            map->on_height_dirt(dirt.height);
        };
        uint32_t most_mixed = 0;
        for (int i = 0; i < 240; ++i) {
            take(i % 3 == 0 ? ground.cutout() : ground.random_command());
            EXPECT_EQ(map->count_stale_pages(ground.document()), 0u)
                << "what is not marked is right, command " << i;
            if (i % 6 != 5) continue;
            update();
            ASSERT_EQ(map->count_stale_pages(ground.document()), 0u) << "command " << i;
            most_mixed = std::max(most_mixed, map->counts().mixed);
        }
        EXPECT_GT(most_mixed, 0u);
        // Negative control: dirt that is lost shows; that of heights too.
        const glm::dvec2 middle = ground.document().bounds().center();
        Cutout lost{.form = CutoutForm::brush};
        lost.dabs = {middle};
        lost.radius_m = 5 * desc.height_spacing_m;
        lost.fill = CutoutMap::is_cut(ground.document(), middle.x, middle.y);
        ground.apply(AddOperatorCommand{lost});
        EXPECT_GT(map->count_stale_pages(ground.document()), 0u);
        // All of it deleted: ground.
        for (const Operator& op : ground.document().operators())
            take(ground.apply(RemoveOperatorCommand{op.id}));
        map->on_dirt(std::vector{ground.document().bounds()});
        update();
        EXPECT_EQ(map->counts().mixed + map->counts().gone, 0u);
    }
}

TEST(CutoutMap, VolumesFollowTheGround) {
    MapFixture ground({}, 2);
    const glm::dvec2 at(100, 100);
    const auto heights = cpu_heights(ground.document());
    const double z = heights->height_m(at.x, at.y);
    ground.apply(
        AddOperatorCommand{Cutout{.form = CutoutForm::box, .center_m = {at, z}, .half_m = {6, 6, 3}}});
    const auto map = cpu_map(ground.document());
    std::vector<WorldRect> changed;
    map->update_without_gpu({}, 100, changed);
    EXPECT_TRUE(CutoutMap::is_cut(ground.document(), at.x, at.y));
    const Dirt dirt = ground.crater(at.x, at.y, 40);  // 16 m deep: the ground leaves the box
    EXPECT_TRUE(dirt.cutout.empty());
    EXPECT_FALSE(CutoutMap::is_cut(ground.document(), at.x, at.y));
    EXPECT_GT(map->count_stale_pages(ground.document()), 0u) << "until it is told";
    map->on_height_dirt(dirt.height);
    map->update_without_gpu({}, 100, changed);
    EXPECT_EQ(map->count_stale_pages(ground.document()), 0u);
    ground.apply(UndoCommand{});
    EXPECT_TRUE(CutoutMap::is_cut(ground.document(), at.x, at.y));
}

TEST(CutoutMap, CoversOfEveryLevel) {
    for (const MapFixtureDesc& desc : kGrounds) {
        MapFixture ground(desc, 9);
        const WorldRect bounds = ground.document().bounds();
        const glm::dvec2 size(bounds.max_x, bounds.max_y);
        ground.apply(AddOperatorCommand{Cutout{.form = CutoutForm::box,
                                               .center_m = {size * 0.45, 0},
                                               .half_m = {size.x * 0.44, size.y * 0.44, 4000}}});
        ground.cutout();
        const auto map = cpu_map(ground.document());
        std::vector<WorldRect> changed;
        while (map->has_work()) map->update_without_gpu({}, 5, changed);
        EXPECT_FALSE(changed.empty());
        const auto heights = cpu_heights(ground.document());
        const VirtualMap& pages = heights->map();
        int seen[3] = {};
        for (int level = desc.refine; level <= pages.root().level; ++level)
            for (int y = 0; y < pages.pages_y(level); ++y)
                for (int x = 0; x < pages.pages_x(level); ++x) {
                    const CutoutCover cover = map->cover_of({level, x, y});
                    ++seen[int(cover)];
                    const WorldRect rect = intersected(pages.page_rect({level, x, y}), bounds);
                    for (int i = 0; i < 60; ++i) {
                        const double px = ground.real(rect.min_x, rect.max_x),
                                     py = ground.real(rect.min_y, rect.max_y);
                        const bool cut = CutoutMap::is_cut(ground.document(), px, py);
                        if (cover == CutoutCover::ground) ASSERT_FALSE(cut);
                        if (cover == CutoutCover::gone) ASSERT_TRUE(cut);
                    }
                    // Finer levels lie in the page that holds them.
                    if (level == desc.refine && level > 0)
                        EXPECT_EQ(map->cover_of({level - 1, 2 * x + 1, 2 * y}), cover);
                }
        EXPECT_GT(seen[int(CutoutCover::mixed)], 0);
        if (desc.samples_x > 150) EXPECT_GT(seen[int(CutoutCover::gone)], 0);
        if (desc.samples_x > 150) EXPECT_GT(seen[int(CutoutCover::ground)], 0);
    }
}

TEST(CutoutMap, TheNearestPagesAreShownWhereThereAreTooMany) {
    MapFixture ground({.samples_x = 64 * 20 + 1, .samples_y = 64 * 20 + 1});
    Cutout many{.form = CutoutForm::brush};
    many.radius_m = 4;
    for (int y = 0; y < 20; ++y)
        for (int x = 0; x < 20; ++x) many.dabs.emplace_back(x * 64 + 32, y * 64 + 32);
    const Dirt dirt = ground.apply(AddOperatorCommand{many});
    EXPECT_FALSE(dirt.cutout.empty());
    const auto map = cpu_map(ground.document());
    std::vector<WorldRect> changed;
    const auto look_from = [&](double x, double y) {
        do map->update_without_gpu({x, y, 5}, 50, changed);
        while (map->has_work());
        EXPECT_EQ(map->counts().mixed, 400u);
        EXPECT_EQ(map->counts().not_shown, 400u - kMaxCutoutPages);
        double farthest_shown = 0, nearest_hidden = 1e9;
        int shown = 0;
        for (int py = 0; py < 20; ++py)
            for (int px = 0; px < 20; ++px) {
                const double distance =
                    glm::distance(glm::dvec2(px * 64 + 32, py * 64 + 32), glm::dvec2(x, y));
                const bool is = map->cover_of({2, px, py}) == CutoutCover::mixed;
                shown += is;
                if (is)
                    farthest_shown = std::max(farthest_shown, distance);
                else
                    nearest_hidden = std::min(nearest_hidden, distance);
            }
        EXPECT_EQ(shown, kMaxCutoutPages);
        EXPECT_LE(farthest_shown, nearest_hidden + 1e-9);
    };
    look_from(0, 0);
    look_from(1280, 640);
    changed.clear();
    look_from(1280, 640);
    EXPECT_TRUE(changed.empty());
    EXPECT_EQ(map->count_stale_pages(ground.document()), 0u);
    // Queries see all of them.
    for (const glm::dvec2& dab : many.dabs) EXPECT_TRUE(CutoutMap::is_cut(ground.document(), dab.x, dab.y));
}

TEST(CutoutMap, QueriesAndRaysSeeTheHole) {
    MapFixture ground({});
    const auto heights = cpu_heights(ground.document());
    const auto is_cut = [&](double x, double y) { return CutoutMap::is_cut(ground.document(), x, y); };
    const glm::dvec3 down(0, 0, -1);
    EXPECT_TRUE(heights->ray_cast({150, 130, 100}, down, 1e4));
    EXPECT_FALSE(is_cut(150, 130));
    Cutout hole{.form = CutoutForm::brush};
    hole.dabs = {{150, 130}, {0, 0}};
    hole.radius_m = 6;
    ground.apply(AddOperatorCommand{hole});
    EXPECT_TRUE(is_cut(150, 130));
    EXPECT_TRUE(is_cut(0, 0));
    for (const double odd : {kNan, double(INFINITY), -1e9, -0.01}) EXPECT_FALSE(is_cut(odd, 0));
    EXPECT_FALSE(is_cut(ground.document().bounds().max_x, ground.document().bounds().max_y));
    EXPECT_FALSE(heights->ray_cast({150, 130, 100}, down, 1e4)) << "there is nothing below";
    EXPECT_TRUE(heights->ray_cast({150, 130, 100}, down, 1e4, Holes::closed));
    EXPECT_TRUE(heights->ray_cast({150, 140, 100}, down, 1e4));
    // The outline: where the bits between vertices are half, from above as the query says.
    int cut = 0;
    for (int i = 0; i < 4000; ++i) {
        const double x = ground.real(140, 160), y = ground.real(120, 140);
        const auto hit = heights->ray_cast({x, y, 100}, down, 1e4);
        EXPECT_EQ(!hit.has_value(), is_cut(x, y)) << x << ", " << y;
        if (hit) EXPECT_NEAR(hit->z, heights->height_m(x, y), 1e-6);
        const double from_m = glm::distance(glm::dvec2(x, y), hole.dabs[0]);
        if (from_m < 5) EXPECT_TRUE(is_cut(x, y));
        if (from_m > 7) EXPECT_FALSE(is_cut(x, y));
        cut += is_cut(x, y);
    }
    EXPECT_NEAR(cut / 4000.0, M_PI * 36 / 400, 0.03);
    // A grazing ray goes on behind the hole.
    const double z = heights->height_m(150, 130);
    const glm::dvec3 eye(150 - 30, 130, z + 15), slant = glm::normalize(glm::dvec3(150, 130, z) - eye);
    const auto through = heights->ray_cast(eye, slant, 1e4),
               closed = heights->ray_cast(eye, slant, 1e4, Holes::closed);
    ASSERT_TRUE(closed);
    if (through) EXPECT_GT(glm::distance(*through, eye), glm::distance(*closed, eye) - 1e-6);
    // Closed again.
    hole.fill = true;
    ground.apply(AddOperatorCommand{hole});
    EXPECT_FALSE(is_cut(150, 130));
    EXPECT_TRUE(heights->ray_cast({150, 130, 100}, down, 1e4));
}

TEST(CutoutMap, JournalsOfBeforeAreRead) {
    const Dirt dirt{.height = {{0, 0, 1, 1}}, .index = {}, .texture = {{2, 2, 3, 3}}, .texture_size_m = 0.5};
    std::vector<uint8_t> bytes = dirt_bytes(dirt);
    bytes.resize(bytes.size() - 4);  // the count of no cutouts
    const auto before = dirt_of(bytes);
    ASSERT_TRUE(before.ok()) << before.message();
    EXPECT_EQ(before->texture, dirt.texture);
    EXPECT_EQ(before->texture_size_m, 0.5);
    EXPECT_TRUE(before->cutout.empty());
    Dirt with = dirt;
    with.cutout = {{4, 4, 5, 5}, {6, 6, 7, 7}};
    EXPECT_EQ(dirt_of(dirt_bytes(with))->cutout, with.cutout);
    bytes = dirt_bytes(with);
    bytes.pop_back();
    EXPECT_FALSE(dirt_of(bytes).ok());
}

TEST(CutoutMap, UndoIsExactAndReopeningKeeps) {
    MapFixture ground({}, 4);
    for (int i = 0; i < 5; ++i) ground.random_command();
    const auto before = ground.document().content_digest();
    for (int i = 0; i < 8; ++i) ground.cutout();
    const auto with = ground.document().content_digest();
    EXPECT_NE(*before, *with);
    for (int i = 0; i < 8; ++i) ground.apply(UndoCommand{});
    EXPECT_EQ(*ground.document().content_digest(), *before);
    for (int i = 0; i < 8; ++i) ground.apply(RedoCommand{});
    EXPECT_EQ(*ground.document().content_digest(), *with);
}

}  // namespace
}  // namespace loam
