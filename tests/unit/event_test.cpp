// Lives and events: what is there when, that winding back shows what was there, and that what they do to the
// ground is what they say.
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "document_fixture.h"
#include "map_fixture.h"
#include "runtime/document/operator_json.h"
#include "runtime/document/operator_set.h"
#include "runtime/maps/height_compose.h"
#include "runtime/maps/index_map.h"

namespace loam {
namespace {

using test::MapFixture;
using test::take;

TEST(Life, HasSixteenStepsARampAndIsAFunctionOfTheTime) {
    const Life life{.from_s = 10, .until_s = 50, .rise_s = 8, .fade_s = 16, .cool_s = 32, .weather_s = 4};
    EXPECT_FALSE(state_at(life, 9.999).there);
    EXPECT_EQ(state_at(life, 10).strength, 1.0 / 16);
    EXPECT_EQ(state_at(life, 14).strength, 9.0 / 16);
    EXPECT_EQ(state_at(life, 18).strength, 1);
    EXPECT_EQ(state_at(life, 42).strength, 0.5);
    EXPECT_EQ(state_at(life, 49.999).strength, 1.0 / 16);
    EXPECT_FALSE(state_at(life, 50).there);
    EXPECT_EQ(state_at(life, 10).heat, 1);
    EXPECT_EQ(state_at(life, 26).heat, 0.5);
    EXPECT_EQ(state_at(life, 45).heat, 0);
    EXPECT_EQ(state_at(life, 12).age, 0.5);
    EXPECT_EQ(state_at(life, 14).age, 1);
    // Every state says truly how long it lasts, and there are no more than the ramps' steps.
    std::set<double> begins;
    for (double t = 0; t < 60; t += 0.0137) {
        const LifeState state = state_at(life, t);
        ASSERT_LE(state.since_s, t);
        ASSERT_GT(state.until_s, t);
        for (const double other : {state.since_s, std::nextafter(state.until_s, -1e9)}) {
            if (!std::isfinite(other) || std::abs(other) > 1e300) continue;
            const LifeState same = state_at(life, other);
            ASSERT_EQ(same.there, state.there);
            ASSERT_EQ(same.strength, state.strength);
            ASSERT_EQ(same.heat, state.heat);
            ASSERT_EQ(same.age, state.age);
        }
        if (std::isfinite(state.since_s)) begins.insert(state.since_s);
    }
    EXPECT_LE(begins.size(), size_t(4 * kLifeSteps + 1));
    const LifeState ever = state_at({}, -1e9);
    EXPECT_TRUE(ever.there && ever.strength == 1 && ever.heat == 1 && ever.age == 0);
    EXPECT_TRUE(std::isinf(ever.since_s) && std::isinf(ever.until_s));
}

TEST(Life, BadOnesAreRefusedWithASentence) {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"cmd":"crater","x":1,"y":1,"life":{"rise_s":2}})",
         "a life that rises, cools or weathers needs \"from_s\", when that begins"},
        {R"({"cmd":"crater","x":1,"y":1,"life":{"fade_s":2}})",
         "a life that fades needs \"until_s\", when that ends"},
        {R"({"cmd":"crater","x":1,"y":1,"life":{"from_s":2,"until_s":2}})",
         "a life from 2 s until 2 s has no time in it"},
        {R"({"cmd":"crater","x":1,"y":1,"life":{"born":2}})", "crater: life: unknown key \"born\""},
        {R"({"cmd":"crater","x":1,"y":1,"life":3})", "crater: life must be an object, found number"},
        {R"({"cmd":"time","time_s":1e12})", "time_s is 1000000000000, must be"},
        {R"({"cmd":"event","event":"comet","x":1,"y":1})",
         "event: unknown event \"comet\" (known: crater, crater_line, barrage, crash, landslide, flood)"},
        {R"({"cmd":"event","event":"crater","x":1,"y":1,"life":{}})", "event: unknown key \"life\""},
        {R"({"cmd":"event","event":"crater","x":1,"y":1,"count":3})", "event: unknown key \"count\""},
        {R"({"cmd":"event","event":"crash","x":1,"y":1})", "event: \"to\" is missing"},
        {R"({"cmd":"event","event":"crash","x":1,"y":1,"to":[1,3],"width_m":6})",
         "the furrow of a crash is 2.00 m long, must be at least as long as it is wide (6 m)"},
        {R"({"cmd":"event","event":"barrage","x":1,"y":1,"count":20000})",
         "count is 20000, must be 1 … 10000"},
        {R"({"cmd":"event","event":"flood","x":1,"y":1})", "event: \"level_m\" is missing"},
        {R"({"cmd":"event","event":"crater","x":1,"y":1,"energy_j":0})", "energy_j is 0, must be"}};
    for (const auto& [json, expected] : cases) {
        const auto command = parse_command(json);
        ASSERT_FALSE(command.ok()) << json;
        EXPECT_EQ(command.message().substr(0, std::string(expected).size()), expected) << json;
    }
}

TEST(Event, IsTheSameAfterItsText) {
    std::mt19937 random(3);
    for (int i = 0; i < 300; ++i) {
        Operator op{.id = uint64_t(i + 1), .order = random() % 99};
        if (i % 3 == 0) {
            op.shape = test::random_earth(random, {10, 20}, 3, 8);
            op.life = test::random_life(random);
        } else {
            op.shape = test::random_event(random, {10, 20}, 3, 8);
        }
        const std::string text = operator_json(op);
        const Operator back = take(parse_operator(op.id, text));
        EXPECT_TRUE(back.life == op.life) << text;
        EXPECT_EQ(operator_json(back), text);
        if (const auto* event = std::get_if<Event>(&op.shape)) {
            EXPECT_TRUE(std::get<Event>(back.shape) == *event) << text;
            const auto parts = parts_of(op), again = parts_of(back);
            ASSERT_EQ(parts.size(), again.size());
            for (size_t k = 0; k < parts.size(); ++k) {
                EXPECT_EQ(operator_json(parts[k]), operator_json(again[k]));
                EXPECT_TRUE(check_shape(parts[k].shape).ok())
                    << check_shape(parts[k].shape).message() << text;
                EXPECT_TRUE(check_life(parts[k].life).ok()) << text;
            }
        }
    }
}

// The composed ground, as bits.
std::vector<double> heights(const Document& document, glm::ivec2 first = {-20, -20},
                            glm::ivec2 size = {340, 300}) {
    std::vector<double> out(size_t(size.x) * size_t(size.y));
    const auto lock = document.read_lock();
    compose_heights(document, document.settings().refine, first, size, out.data());
    return out;
}

TEST(Event, WindingBackShowsWhatWasThereBitForBit) {
    MapFixture ground({}, 5);
    Document& document = ground.document();
    const std::vector<double> base = heights(document);
    std::mt19937 random(9);
    for (int i = 0; i < 40; ++i)
        ground.apply(AddOperatorCommand{test::random_event(random, ground.place(), 0, ground.real(1, 12))});
    std::vector<std::pair<double, std::vector<double>>> seen;
    for (int i = 0; i < 30; ++i) {
        const double t = ground.real(-5, 180);
        ground.time(t);
        seen.emplace_back(t, heights(document));
    }
    for (int i = 29; i >= 0; --i) {
        ground.time(seen[size_t(i)].first);
        ASSERT_EQ(heights(document), seen[size_t(i)].second) << seen[size_t(i)].first;
    }
    ground.time(-10);
    EXPECT_EQ(heights(document), base) << "before anything happened";
    ground.time(150);
    EXPECT_NE(heights(document), base);
    // The time is kept with the project; the parts are the same ones when it is opened again.
    const auto late = heights(document);
    const auto folder = document.folder();
    while (document.can_undo()) ground.apply(UndoCommand{});
    EXPECT_EQ(heights(document), base);
    while (document.can_redo()) ground.apply(RedoCommand{});
    EXPECT_EQ(heights(document), late);
}

TEST(Event, TheTimeIsKeptWithTheProject) {
    test::TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = test::create_small(path);
    ASSERT_TRUE(
        document->apply(*parse_command(R"({"cmd":"event","event":"crater","x":50,"y":60,"start_s":3})"))
            .ok());
    const Dirt dirt = take(document->apply(Command{TimeCommand{3}}));
    EXPECT_FALSE(dirt.height.empty());
    const uint64_t digest = take(document->content_digest());
    document.reset();
    document = take(Document::open(path));
    EXPECT_EQ(document->time_s(), 3);
    EXPECT_EQ(take(document->content_digest()), digest);
    std::vector<const Operator*> found;
    const auto lock = document->read_lock();
    document->operators_over_height({49, 59, 51, 61}, 0, found);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Crater>(found[0]->shape));
}

// Pages composed, and dirt, follow what changed: the time moves past nothing without cost, and a step of one
// crater touches only its ground.
TEST(Event, DirtIsWhatChanged) {
    MapFixture ground({.channels = {Channel::emissive}}, 2);
    ground.apply(AddOperatorCommand{Event{.kind = EventKind::crater,
                                          .x_m = 100,
                                          .y_m = 100,
                                          .energy_j = 4.184e6 * 1000,
                                          .start_s = 10,
                                          .cool_s = 16,
                                          .weather_s = 0}});
    EXPECT_TRUE(ground.time(9).empty()) << "nothing happens before";
    Dirt dirt = ground.time(10.5);
    constexpr double reach = 4 * 3.2;  // a radius of 4 m
    ASSERT_FALSE(dirt.height.empty());
    for (const WorldRect& rect : dirt.height) EXPECT_LE(rect.width(), 2 * reach);
    dirt = ground.time(11.5);
    EXPECT_TRUE(dirt.height.empty() && dirt.index.empty()) << "it cools";
    EXPECT_FALSE(dirt.texture.empty());
    EXPECT_TRUE(ground.time(11.6).empty()) << "within a step";
    ground.time(40);
    EXPECT_TRUE(ground.time(1000).empty()) << "all is over";

    MapFixture cold({}, 2);  // without a channel that shows heat
    cold.apply(AddOperatorCommand{
        Event{.kind = EventKind::crater, .x_m = 100, .y_m = 100, .start_s = 10, .cool_s = 16}, {}});
    EXPECT_FALSE(cold.time(10.5).empty());
    EXPECT_TRUE(cold.time(20).empty());
}

TEST(Event, LandslidesKeepTheirMass) {
    MapFixture ground({.relief_m = 0}, 2);
    for (const bool stated : {true, false}) {
        Event slide = default_event(EventKind::landslide);
        slide.x_m = 150;
        slide.y_m = 130;
        slide.radius_m = 30;
        slide.volume_m3 = 4000;
        if (stated) slide.to_m = glm::dvec2(210, 150);
        slide.duration_s = 10;
        const std::vector<double> before = heights(ground.document());
        ground.apply(AddOperatorCommand{slide});
        for (const double t : {0.5, 3.0, 6.0, 10.0}) {
            ground.time(t);
            const std::vector<double> after = heights(ground.document());
            double sum = 0, moved = 0;
            for (size_t i = 0; i < after.size(); ++i) {
                sum += after[i] - before[i];
                moved += std::abs(after[i] - before[i]) / 2;
            }
            EXPECT_LT(std::abs(sum), 0.001 * slide.volume_m3) << t;  // at 1 m a sample
            if (t == 10.0 && stated) EXPECT_GT(moved, 0.8 * slide.volume_m3);
        }
        ground.apply(UndoCommand{});
        ground.time(0);
        EXPECT_EQ(heights(ground.document()), before);
    }
}

TEST(Event, ALandslideWithoutAnEndRunsDownhill) {
    MapFixture ground({.relief_m = 40}, 2);
    Document& document = ground.document();
    const auto height_at = [&](glm::dvec2 at) {
        int32_t mm = 0;
        const auto lock = document.read_lock();
        document.read_heights_mm(0, int(at.x), int(at.y), 1, 1, &mm);
        return mm * 0.001;
    };
    for (int i = 0; i < 20; ++i) {
        Event slide = default_event(EventKind::landslide);
        const glm::dvec2 from(ground.real(40, 250), ground.real(40, 210));
        slide.x_m = from.x;
        slide.y_m = from.y;
        slide.radius_m = 8;
        ground.apply(AddOperatorCommand{slide});
        const Event stored = std::get<Event>(document.operators().back().shape);
        ASSERT_TRUE(stored.to_m.has_value()) << "the document found it, and the journal has it";
        EXPECT_LT(height_at(*stored.to_m), height_at(from) + 3);
    }
}

TEST(Event, AFloodWetsWhatLiesBelowIt) {
    MapFixture ground({.relief_m = 10}, 4);
    Document& document = ground.document();
    const auto indices = take(IndexMap::create(nullptr, document, {.slot_count = 4, .gpu = false}));
    const VirtualMap& map = indices->map();
    ground.apply(AddOperatorCommand{Event{.kind = EventKind::flood,
                                          .x_m = 150,
                                          .y_m = 130,
                                          .radius_m = 70,
                                          .level_m = 3,
                                          .from_m = -30,
                                          .layer = "scree",
                                          .start_s = 1,
                                          .duration_s = 10}});
    const auto count_wet = [&] {
        std::vector<IndexTexel> texels(size_t(kIndexTexels) * kIndexTexels);
        int wet = 0, differing = 0;
        const double spacing = map.spacing_m(0);
        IndexMap::compose(document, map, {0, 0, 0}, {0, 0, kIndexTexels, kIndexTexels}, texels);
        std::vector<double> ground_m(texels.size());
        const auto lock = document.read_lock();
        ground_at(document, spacing, {-kIndexBorder, -kIndexBorder}, glm::ivec2(kIndexTexels),
                  ground_m.data());
        for (int j = 0; j < kIndexTexels; ++j)
            for (int i = 0; i < kIndexTexels; ++i) {
                const size_t k = size_t(j) * kIndexTexels + size_t(i);
                const double x = (i - kIndexBorder) * spacing - 150, y = (j - kIndexBorder) * spacing - 130;
                const bool below = ground_m[k] < 3 && x * x + y * y < 70 * 70;
                wet += below;
                if (below && texels[k].layer != 2) ++differing;
            }
        return std::pair(wet, differing);
    };
    EXPECT_GT(count_wet().second, 0) << "not yet";
    ground.time(20);
    const auto [wet, differing] = count_wet();
    EXPECT_GT(wet, 1000);
    EXPECT_EQ(differing, 0);
    // It follows the ground: what is dug below the level becomes wet, by dirt of the index.
    const Dirt dirt = ground.crater(150, 130, 12);
    EXPECT_FALSE(dirt.index.empty());
    EXPECT_EQ(count_wet().second, 0);
}

TEST(Event, ManyCratersOnOneSpotStayFiniteAndAreUndoneExactly) {
    MapFixture ground({}, 6);
    const std::vector<double> before = heights(ground.document(), {110, 90}, {80, 80});
    for (int i = 0; i < 10; ++i)
        ground.apply(AddOperatorCommand{Event{.kind = EventKind::crater_line,
                                              .x_m = 150,
                                              .y_m = 130,
                                              .to_m = glm::dvec2(150, 130),
                                              .energy_j = 1e9,
                                              .count = 1000,
                                              .seed = uint32_t(i)}});
    double lowest = 0;
    for (const double height_m : heights(ground.document(), {110, 90}, {80, 80})) {
        ASSERT_TRUE(std::isfinite(height_m));
        lowest = std::min(lowest, height_m);
    }
    EXPECT_LT(lowest, -1000) << "ten thousand bowls";
    EXPECT_GE(lowest, -20'000) << "saturates";
    for (int i = 0; i < 10; ++i) ground.apply(UndoCommand{});
    EXPECT_EQ(heights(ground.document(), {110, 90}, {80, 80}), before);
}

TEST(Event, CostsItsParametersOnDisk) {
    MapFixture ground({}, 6);
    Document& document = ground.document();
    ground.apply(AddOperatorCommand{default_event(EventKind::crater)});
    Event line = default_event(EventKind::crater_line);
    line.to_m = glm::dvec2(300, 0);
    line.count = 1000;
    ground.apply(AddOperatorCommand{line});
    ground.apply(AddOperatorCommand{default_event(EventKind::barrage)});
    for (const uint64_t id : {1, 2, 3}) EXPECT_LT(document.event_cost(id).stored_bytes, 300u);
    EXPECT_EQ(document.event_cost(1).parts, 1u);
    EXPECT_EQ(document.event_cost(2).parts, 1000u);
    EXPECT_EQ(document.event_cost(3).parts, 1200u);
    EXPECT_LT(document.event_cost(3).memory_bytes, 1'000'000u);
    EXPECT_EQ(document.event_cost(9).parts, 0u);
}

// However many operators there are elsewhere, moving the time looks at those whose state ends.
TEST(Event, MovingTheTimeLooksAtNothingElse) {
    OperatorSet set;
    for (uint64_t i = 1; i <= 100'000; ++i) {
        Operator op{
            .id = i,
            .order = i,
            .shape = Crater{.x_m = double(i % 1000) * 10, .y_m = double(i / 1000) * 100, .radius_m = 2}};
        if (i % 2) op.life = {.from_s = 1000.0 + double(i)};
        set.set(op);
    }
    Dirt dirt;
    set.set_time(999, dirt);
    EXPECT_TRUE(dirt.empty());
    set.set_time(1003, dirt);
    EXPECT_EQ(dirt.height.size(), 2u) << "1 and 3 have begun";
    Dirt back;
    set.set_time(0, back);
    EXPECT_EQ(back.height, dirt.height);
}

TEST(Event, ImpactsHaveTheSizeOfTheirEnergy) {
    EXPECT_NEAR(2 * crater_radius_m(4.184e6), 0.8, 1e-12) << "a kilogram";
    EXPECT_NEAR(2 * crater_radius_m(4.184e9), 8, 1e-9) << "a tonne";
    EXPECT_NEAR(crater_radius_m(default_event(EventKind::crater).energy_j), 10, 0.05);
}

}  // namespace
}  // namespace loam
