// Transitions placed by painting: no square of four texels shows a layer that has no business there, and what
// is placed follows from the painted map alone.
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "runtime/document/transitions.h"
#include "tests/unit/index_texels.h"
#include "tests/unit/map_fixture.h"

namespace {

using namespace loam;
using namespace loam::test;

constexpr int kLayers = 4;

LayerEntry transition(const char* name, const char* from, const char* to, bool removed = false) {
    return {.name = name, .file = "", .blend = LayerEntry::Blend{from, to, 0.5, removed}};
}

// grass 0, dirt 1, scree 2, layer 3 3; then the transitions.
MapFixtureDesc desc() {
    return {.samples_x = 100,
            .samples_y = 80,
            .index_spacing_m = 1,
            .layers = kLayers,
            .ground = {},
            .transitions = {transition("grass to dirt", "grass", "dirt"),
                            transition("dirt to scree", "dirt", "scree"),
                            transition("scree to grass", "scree", "grass"),
                            transition("gone", "dirt", "grass", true), transition("again", "grass", "dirt")}};
}

void paint(MapFixture& f, const std::string& layer, glm::dvec2 at, double radius_m, bool transitions,
           double strength = 1) {
    PaintCommand command;
    command.dabs = {at};
    command.radius_m = radius_m;
    command.layer = layer;
    command.strength = strength;
    command.transitions = transitions;
    f.apply(command);
}

// The layers that texel (x, y) shows.
std::set<int> shown(const std::vector<Transition>& transitions, int layer) {
    for (const Transition& t : transitions)
        if (t.layer == layer) return {t.from, t.to};
    return {layer};
}

TEST(transitions, no_square_shows_a_hidden_third_layer) {
    MapFixture f(desc());
    const auto transitions = transitions_of(f.document().settings());
    const glm::ivec2 size = f.document().index_size_texels();
    const auto plain_of = [&](int layer) {
        for (const Transition& t : transitions)
            if (t.layer == layer) return int(t.from);
        return layer;
    };
    const char* names[kLayers] = {"grass", "dirt", "scree", "layer 3"};
    paint(f, "grass", {50, 40}, 200, true);
    int placed = 0;
    for (int step = 0; step < 60; ++step) {
        paint(f, names[f.uniform(0, kLayers - 1)], {f.real(0, 99), f.real(0, 79)}, f.real(0.5, 14), true,
              f.uniform(0, 2) ? 1 : 0.6);
        const std::vector<int> map = read_layers(f.document());
        const auto at = [&](int x, int y) { return map[size_t(y) * size_t(size.x) + size_t(x)]; };
        for (int y = 0; y + 1 < size.y; ++y)
            for (int x = 0; x + 1 < size.x; ++x) {
                std::set<int> visible, plain;
                bool holds_one = false;
                for (int k = 0; k < 4; ++k) {
                    const int layer = at(x + k % 2, y + k / 2);
                    holds_one |= layer >= kLayers;
                    visible.merge(shown(transitions, layer));
                    plain.insert(plain_of(layer));
                }
                if (!holds_one) continue;
                ++placed;
                ASSERT_EQ(visible.size(), 2u) << "step " << step << " at " << x << ", " << y;
                ASSERT_TRUE(std::includes(visible.begin(), visible.end(), plain.begin(), plain.end()));
            }
    }
    EXPECT_GT(placed, 1000);
}

TEST(transitions, what_is_placed_follows_from_the_painted_map) {
    MapFixture once(desc()), twice(desc());
    for (MapFixture* f : {&once, &twice}) {
        paint(*f, "grass", {50, 40}, 200, false);
        for (int i = 0; i < 12; ++i)
            paint(*f, i % 3 ? "dirt" : "scree", {i * 8.0, 20 + 3.0 * i}, 4 + i % 5, f == &twice);
    }
    EXPECT_NE(read_layers(once.document()), read_layers(twice.document())) << "the comparison can fail";
    // Tint alone changes no layer: what it touches is placed.
    for (MapFixture* f : {&once, &twice})
        for (int pass = 0; pass < (f == &once ? 1 : 2); ++pass) {
            PaintCommand everywhere;
            everywhere.dabs = {{50, 40}};
            everywhere.radius_m = 200;
            everywhere.tint = glm::dvec3(1);
            everywhere.transitions = true;
            f->apply(everywhere);
        }
    EXPECT_EQ(read_layers(once.document()), read_layers(twice.document()));
}

TEST(transitions, painting_over_a_border_takes_its_transition_away) {
    MapFixture f(desc());
    paint(f, "grass", {50, 40}, 200, true);
    const auto before = read_layers(f.document());
    paint(f, "dirt", {50, 40}, 6, true);
    const auto ring = read_layers(f.document());
    const int grass_to_dirt = kLayers;
    EXPECT_GT(std::count(ring.begin(), ring.end(), grass_to_dirt), 20);
    EXPECT_EQ(std::count(ring.begin(), ring.end(), kLayers + 4), 0) << "the first of two is placed";
    EXPECT_EQ(std::count(ring.begin(), ring.end(), kLayers + 3), 0) << "a removed one is not";
    paint(f, "grass", {50, 40}, 9, true);
    EXPECT_EQ(read_layers(f.document()), before) << "no ring of dirt is left under the grass";
    f.apply(UndoCommand{});
    EXPECT_EQ(read_layers(f.document()), ring);
}

}  // namespace
