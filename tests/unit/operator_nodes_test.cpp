// Decals that are read when somebody looks: whatever is in memory, what a document answers is the same.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>
#include <glm/common.hpp>

#include "document_fixture.h"
#include "runtime/document/function_library.h"
#include "runtime/document/operator_json.h"
#include "runtime/document/operator_nodes.h"
#include "runtime/store/page_store.h"

namespace {

using namespace loam;
using test::take;

constexpr double kSide_m = 16'800;

ProjectSettings large_settings() {
    ProjectSettings settings = test::small_settings();
    settings.height_samples_x = settings.height_samples_y = 4201;
    settings.height_spacing_m = 4;
    settings.index_spacing_m = 4;
    return settings;
}

std::vector<std::string> texts_of(const std::vector<const Operator*>& operators) {
    std::vector<std::string> texts;
    for (const Operator* op : operators) texts.push_back(std::to_string(op->id) + operator_json(*op));
    return texts;
}

// What a walk over all of them finds; with a texel, of what shows in texels of that size.
std::vector<const Operator*> walk(const std::vector<Operator>& all, const WorldRect& rect, double texel_m) {
    std::vector<const Operator*> found;
    for (const Operator& op : all) {
        const auto rects = op.texture_rects();
        if (op.enabled && 2 * op.texture_size_m() > texel_m &&
            std::any_of(rects.begin(), rects.end(), [&](const WorldRect& r) { return r.overlaps(rect); }))
            found.push_back(&op);
    }
    return found;
}

WorldRect random_rect(std::mt19937& random) {
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    const double x = real(-500, kSide_m), y = real(-500, kSide_m), size = std::exp2(real(-3, 14.5));
    return {x, y, x + size * real(0, 1), y + size * real(0, 1)};
}

// Decals of some centimetres to some kilometres, all over a map and beyond its edges; some of everything
// else.
void add_decals(Document& document, std::mt19937& random, int count) {
    for (int i = 0; i < count; ++i) {
        const auto real = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        const glm::dvec2 at(real(-200, kSide_m + 200), real(-200, kSide_m + 200));
        const double size_m = std::exp2(real(-1, i % 20 ? 4 : 9.5));
        OperatorShape shape = test::random_decal(random, at, size_m);
        if (i % 5 == 0) shape = Crater{at.x, at.y, size_m, 0, uint32_t(i)};
        if (i % 7 == 0) shape = test::random_earth(random, at, 12, size_m);
        if (i % 11 == 0) shape = Footprint{at.x, at.y, real(-3, 3), 0.3};
        if (auto* spline = std::get_if<SplineDecal>(&shape); spline && i % 2) spline->carve = 0;
        const Life life = i % 10 == 0 ? test::random_life(random) : Life{};
        Command command{AddOperatorCommand{shape, life}};
        if (const auto* print = std::get_if<Footprint>(&shape))
            command.body = FootprintsCommand{{*print}, life};
        const auto dirt = document.apply(command);
        ASSERT_TRUE(dirt.ok()) << dirt.message();
    }
}

TEST(operator_nodes, a_question_finds_what_a_walk_over_all_finds_and_reads_no_more_than_its_nodes) {
    const test::TemporaryFolder folder;
    std::mt19937 random(11);
    {
        const auto document = take(Document::create(folder.path() / "p", large_settings()));
        add_decals(*document, random, 1500);
        ASSERT_TRUE(document->apply({SetOperatorCommand{7, false}}).ok());
    }
    const auto document = take(Document::open(folder.path() / "p"));
    const std::vector<Operator> all = document->operators();
    ASSERT_EQ(all.size(), 1500u);
    const auto opened = document->statistics();
    EXPECT_EQ(opened.operators, 1500u);
    EXPECT_EQ(opened.node_reads, 0u);
    EXPECT_LT(opened.loaded_operators, 400u) << "those that carve or have a life";
    EXPECT_GT(opened.operator_nodes, 100u);

    std::vector<const Operator*> found;
    {
        const auto lock = document->read_lock();
        document->operators_over_texture({4000, 4000, 4010, 4010}, 0.04, found);
    }
    EXPECT_LE(document->statistics().loaded_nodes, 200u) << "a few of every size and kind";
    const auto coarse_before = document->statistics().node_reads;
    {
        const auto lock =
            document->read_lock();  // a page of the whole map: of those as wide as its texels only
        document->operators_over_texture({0, 0, kSide_m, kSide_m}, 66, found);
    }
    EXPECT_LE(document->statistics().node_reads - coarse_before, 400u);
    EXPECT_LT(document->statistics().loaded_operators, 900u);

    for (int question = 0; question < 600; ++question) {
        if (question % 50 == 0) document->trim_operators(size_t(random() % 300));
        const WorldRect rect = random_rect(random);
        const double texel_m =
            question % 3 ? std::exp2(std::uniform_real_distribution<double>(-10, 7)(random)) : 0;
        const auto lock = document->read_lock();
        document->operators_over_texture(rect, texel_m, found);
        ASSERT_TRUE(std::is_sorted(found.begin(), found.end(), [](const Operator* a, const Operator* b) {
            return evaluated_before(*a, *b);
        }));
        std::vector<const Operator*> shown;  // it may give some that are too small
        for (const Operator* op : found)
            if (2 * op->texture_size_m() > texel_m) shown.push_back(op);
        // Those with a life are shown in the state of the time.
        std::vector<Operator> now;
        for (const Operator& op : all) {
            const LifeState state = state_at(op.life, document->time_s());
            if (!state.there) continue;
            now.push_back(op);
            now.back().shape = shape_in(op.shape, state);
        }
        ASSERT_EQ(texts_of(shown), texts_of(walk(now, rect, texel_m)))
            << rect.min_x << " " << rect.min_y << " " << rect.width() << " texel " << texel_m;
        document->operators_over_ground(rect, found);
        std::vector<const Operator*> volumes = walk(now, rect, 0);
        std::erase_if(volumes, [](const Operator* op) {
            return !std::holds_alternative<VolumeDecal>(op->shape) &&
                   !std::holds_alternative<Flood>(op->shape);
        });
        ASSERT_EQ(texts_of(found), texts_of(volumes));
    }
    document->trim_operators(0);
    EXPECT_EQ(document->statistics().loaded_nodes, 0u);
    EXPECT_EQ(document->statistics().loaded_operators, opened.loaded_operators);
}

// Heights and layers on grids of every step, by what nodes give for the step and by all there are.
TEST(operator_nodes, grids_of_any_step_see_in_their_nodes_all_that_changes_them) {
    const test::TemporaryFolder folder;
    std::mt19937 random(21);
    for (const double spacing_m : {1.0, 0.7, 8.0}) {
        const auto path = folder.path() / std::to_string(spacing_m);
        ProjectSettings settings = test::small_settings();
        settings.height_samples_x = settings.height_samples_y = 2001;
        settings.height_spacing_m = spacing_m;
        settings.index_spacing_m = spacing_m > 2 ? 16 : 2;
        settings.refine = 0;
        const double side_m = 2000 * spacing_m, area_m = std::min(side_m, 400.0);
        const auto real = [&](double low, double high) {
            return std::uniform_real_distribution<double>(low, high)(random);
        };
        {
            const auto document = take(Document::create(path, settings));
            for (int i = 0; i < 800; ++i) {
                // Some exactly on samples of coarse grids, where the smallest counts.
                glm::dvec2 at(real(0, area_m), real(0, area_m));
                if (i % 3 == 0) at = glm::round(at / (16 * spacing_m)) * (16 * spacing_m);
                const double size_m = std::exp2(real(-2, 5));
                OperatorShape shape = Crater{at.x, at.y, size_m, 0, uint32_t(i)};
                if (i % 4 == 1) shape = Footprint{at.x, at.y, real(-3, 3), std::min(size_m, 40.0)};
                if (i % 4 == 2) {
                    TerrainDecal decal{.x_m = at.x, .y_m = at.y, .half_m = {size_m, size_m / 2}};
                    decal.displacement_m = 0.5;
                    shape = decal;
                }
                if (i % 4 == 3) {
                    shape = Slide{.x_m = at.x,
                                  .y_m = at.y,
                                  .radius_m = size_m,
                                  .to_m = at + 3 * size_m,
                                  .to_radius_m = size_m};
                    auto& slide = std::get<Slide>(shape);
                    slide.volume_m3 = size_m;
                    slide.way = 0.5;
                }
                Command command{AddOperatorCommand{shape, {}}};
                if (const auto* print = std::get_if<Footprint>(&shape))
                    command.body = FootprintsCommand{{*print}, {}};
                const auto dirt = document->apply(command);
                ASSERT_TRUE(dirt.ok()) << dirt.message();
            }
        }
        // Someone asks for a finer height map later.
        ProjectSettings finer = take(load_project(path));
        finer.refine = 3;
        ASSERT_TRUE(save_project(path, finer).ok());
        const auto document = take(Document::open(path));
        EXPECT_EQ(document->statistics().loaded_operators, 0u);
        const std::vector<Operator> all = document->operators();
        const ResolvedRoles roles{1, 2};
        constexpr int kGrid = 40;
        size_t touched = 0;
        for (int question = 0; question < 400; ++question) {
            document->trim_operators(0);  // else what an earlier question read would be found as well
            const bool heights = question % 2 == 0;
            const double step_m =
                (heights ? spacing_m / 8 : settings.index_spacing_m) * std::exp2(random() % 11);
            const glm::ivec2 first(glm::dvec2(real(-0.1, 1), real(-0.1, 1)) * area_m / step_m);
            const glm::dvec2 low = glm::dvec2(first) * step_m;
            const WorldRect rect{low.x, low.y, low.x + (kGrid - 1) * step_m, low.y + (kGrid - 1) * step_m};
            std::vector<const Operator*> found;
            const auto lock = document->read_lock();
            if (heights || question % 4 == 1) {
                document->operators_over_height(rect, step_m, found);
                std::vector<double> some(kGrid * kGrid, 100), every(kGrid * kGrid, 100);
                for (const Operator* op : found)
                    apply_height(*op, {some.data(), kGrid, kGrid, kGrid, low.x, low.y, step_m});
                for (const Operator& op : all)
                    apply_height(op, {every.data(), kGrid, kGrid, kGrid, low.x, low.y, step_m});
                ASSERT_EQ(some, every) << "step " << step_m << " at " << low.x << ", " << low.y;
                touched += some != std::vector<double>(kGrid * kGrid, 100);
            } else {
                document->operators_over_index(rect, step_m, found);
                std::vector<IndexTexel> some(kGrid * kGrid), every(kGrid * kGrid);
                for (const Operator* op : found)
                    apply_index(*op, roles, {some.data(), kGrid, kGrid, kGrid, low.x, low.y, step_m}, {});
                for (const Operator& op : all)
                    apply_index(op, roles, {every.data(), kGrid, kGrid, kGrid, low.x, low.y, step_m}, {});
                ASSERT_EQ(some, every) << "step " << step_m << " at " << low.x << ", " << low.y;
                touched += some != std::vector<IndexTexel>(kGrid * kGrid);
            }
        }
        EXPECT_GT(touched, 60u) << "spacing " << spacing_m;
        // A grid over all of the map reads those that its samples meet, and such as share their nodes.
        document->trim_operators(0);
        std::vector<const Operator*> found;
        const auto lock = document->read_lock();
        document->operators_over_height({0, 0, side_m, side_m}, spacing_m * 32, found);
        EXPECT_LT(document->statistics().loaded_operators, 700u);
    }
}

// Two documents, one of which forgets all that it can after every command and is closed now and then.
TEST(operator_nodes, what_is_in_memory_makes_no_difference_to_commands_undo_and_dirt) {
    const test::TemporaryFolder folder;
    const auto keeps = test::create_small(folder.path() / "keeps");
    auto forgets = test::create_small(folder.path() / "forgets");
    std::mt19937 random(5);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    uint64_t added = 0;
    const auto random_step = [&]() -> Command {
        const uint64_t id = 1 + random() % (added + 2);
        const auto shape = [&] { return test::random_decal(random, {real(-5, 300), real(-5, 200)}, 4); };
        switch (random() % 9) {
            case 0:
                return {SetOperatorCommand{id, random() % 2 == 0}};
            case 1:
                return {ReorderCommand{.id = id, .order = random() % 50}};
            case 2:
                return {RemoveOperatorCommand{id}};
            case 3:
                return {EditOperatorCommand{.id = id, .shape = shape()}};
            case 4:
                return {EditOperatorCommand{.id = id, .shape = shape(), .life = test::random_life(random)}};
            case 5:
                return {UndoCommand{}};
            case 6:
                return {RedoCommand{}};
            default:
                ++added;
                return {AddOperatorCommand{shape(), random() % 4 ? Life{} : test::random_life(random)}};
        }
    };
    int applied = 0;
    uint64_t reads = 0;
    for (int step = 0; step < 800; ++step) {
        const Command command = random_step();
        const auto a = keeps->apply(command), b = forgets->apply(command);
        ASSERT_EQ(a.ok(), b.ok());
        applied += a.ok();
        if (a.ok()) {
            ASSERT_EQ(a->texture, b->texture) << to_json(command);
            ASSERT_EQ(a->height, b->height);
            ASSERT_EQ(a->texture_size_m, b->texture_size_m);
        } else {
            ASSERT_EQ(a.message(), b.message());
        }
        forgets->trim_operators(0);
        if (step % 100 == 99) {
            reads += forgets->statistics().node_reads;
            forgets.reset();
            forgets = take(Document::open(folder.path() / "forgets"));
        }
        ASSERT_EQ(keeps->statistics().operators, forgets->statistics().operators) << to_json(command);
    }
    EXPECT_GT(applied, 500);
    EXPECT_EQ(take(keeps->content_digest()), take(forgets->content_digest()));
    EXPECT_GT(reads, 100u);
    std::vector<const Operator*> a, b;
    for (int question = 0; question < 100; ++question) {
        const double x = real(-10, 300), y = real(-10, 200), size = real(0, 60);
        const auto lock_a = keeps->read_lock(), lock_b = forgets->read_lock();
        keeps->operators_over_texture({x, y, x + size, y + size}, 0, a);
        forgets->operators_over_texture({x, y, x + size, y + size}, 0, b);
        ASSERT_EQ(texts_of(a), texts_of(b));
    }
    while (keeps->can_undo()) ASSERT_TRUE(keeps->undo().ok());
    EXPECT_EQ(keeps->statistics().operators, 0u);
    EXPECT_EQ(keeps->statistics().operator_nodes, 0u);
    EXPECT_TRUE(keeps->drawn_kinds().empty());
    EXPECT_TRUE(take(Document::verify(folder.path() / "forgets")).empty());
}

TEST(operator_nodes, who_lists_operators_is_told_which_changed) {
    const test::TemporaryFolder folder;
    const auto document = test::create_small(folder.path() / "p");
    std::mt19937 random(3);
    const uint64_t before = document->revision();
    EXPECT_EQ(document->changed_operators(before), std::vector<uint64_t>());
    ASSERT_TRUE(document->apply({AddOperatorCommand{test::random_decal(random, {50, 50}, 4), {}}}).ok());
    ASSERT_TRUE(document->apply({CraterCommand{{60, 60, 5}}}).ok());
    const uint64_t both = document->revision();
    EXPECT_EQ(document->changed_operators(before), (std::vector<uint64_t>{1, 2}));
    ASSERT_TRUE(document->undo().ok());
    EXPECT_EQ(document->changed_operators(both), std::vector<uint64_t>{2});
    EXPECT_EQ(document->timed_operators().size(), 0u);
    FootprintsCommand prints;
    prints.prints.resize(20'000, Footprint{50, 50});
    ASSERT_TRUE(document->apply({prints}).ok());
    EXPECT_EQ(document->changed_operators(both), std::nullopt) << "too many: the list is to be read";
    EXPECT_EQ(document->changed_operators(document->revision()), std::vector<uint64_t>());
}

TEST(operator_nodes, a_reader_keeps_what_it_had_of_what_another_program_moves) {
    const test::TemporaryFolder folder;
    const auto writer = test::create_small(folder.path() / "p");
    ASSERT_TRUE(writer->apply({AddOperatorCommand{TerrainDecal{.x_m = 10, .y_m = 10}, {}}}).ok());
    ASSERT_TRUE(writer->apply({AddOperatorCommand{TerrainDecal{.x_m = 290, .y_m = 200}, {}}}).ok());
    const auto reader = take(Document::open(folder.path() / "p", OpenMode::read_only));
    std::vector<const Operator*> found;
    const auto seen = [&](double x, double y) {
        const auto lock = reader->read_lock();
        reader->operators_over_texture({x - 1, y - 1, x + 1, y + 1}, 0, found);
        return found.size();
    };
    EXPECT_EQ(seen(10, 10), 1u);
    ASSERT_TRUE(writer->apply({EditOperatorCommand{1, TerrainDecal{.x_m = 289, .y_m = 200}, {}}}).ok());
    EXPECT_EQ(seen(290, 200), 1u) << "the other one";
    EXPECT_EQ(seen(10, 10), 1u);
}

TEST(operator_nodes, a_changed_function_dirties_decals_that_were_not_read) {
    const test::TemporaryFolder folder;
    {
        const auto document = test::create_small(folder.path() / "p");
        TerrainDecal decal{.x_m = 100, .y_m = 100};
        decal.material.function = "cracks";
        ASSERT_TRUE(document->apply({AddOperatorCommand{decal, {}}}).ok());
    }
    const auto document = take(Document::open(folder.path() / "p"));
    const auto kinds = document->drawn_kinds();
    ASSERT_EQ(kinds.size(), 1u);
    EXPECT_EQ(material_of(kinds[0])->function, "cracks");
    const std::string text = take(document->functions().text("cracks"));
    const Dirt dirt = take(document->apply({FunctionCommand{.name = "cracks", .text = text + "\n"}}));
    EXPECT_EQ(document->statistics().node_reads, 0u);
    ASSERT_EQ(dirt.texture.size(), 1u);
    EXPECT_TRUE(dirt.texture[0].contains(100, 100));
    EXPECT_LT(dirt.texture[0].width(), 5);
}

// The format before there were nodes: read-only it is read as it is, for writing it is given them.
TEST(operator_nodes, a_database_of_the_first_format_is_brought_up_to_date) {
    const test::TemporaryFolder folder;
    const auto project = folder.path() / "p";
    uint64_t digest = 0;
    {
        const auto document = take(Document::create(project, large_settings()));
        std::mt19937 random(8);
        add_decals(*document, random, 120);
        digest = take(document->content_digest());
    }
    {
        auto database = take(Database::open(project / "terrain.db", DatabaseMode::read_write));
        ASSERT_TRUE(database
                        .execute("DROP INDEX operator_node; ALTER TABLE operator DROP COLUMN node; "
                                 "ALTER TABLE operator DROP COLUMN function; PRAGMA user_version = 1;")
                        .ok());
    }
    const WorldRect everywhere{-1e5, -1e5, 1e5, 1e5};
    std::vector<const Operator*> found;
    std::vector<std::string> texts;
    {
        const auto document = take(Document::open(project, OpenMode::read_only));
        EXPECT_EQ(document->statistics().operators, 120u);
        EXPECT_EQ(document->statistics().operator_nodes, 0u);
        EXPECT_EQ(take(document->content_digest()), digest);
        EXPECT_TRUE(document->find_operator(3));
        const auto lock = document->read_lock();
        document->operators_over_texture(everywhere, 0, found);
        texts = texts_of(found);
    }
    EXPECT_EQ(take(Document::verify(project)), std::vector<std::string>());
    for (int time = 0; time < 2; ++time) {
        const auto document = take(Document::open(project));
        EXPECT_EQ(document->statistics().operators, 120u);
        EXPECT_GT(document->statistics().operator_nodes, 20u);
        EXPECT_LT(document->statistics().loaded_operators, 60u);
        EXPECT_EQ(take(document->content_digest()), digest);
        const auto lock = document->read_lock();
        document->operators_over_texture(everywhere, 0, found);
        EXPECT_EQ(texts_of(found), texts);
    }
    EXPECT_EQ(take(Document::verify(project)), std::vector<std::string>());
}

TEST(operator_nodes, a_damaged_row_costs_its_decal_and_is_found_by_verify) {
    const test::TemporaryFolder folder;
    const auto project = folder.path() / "p";
    {
        const auto document = test::create_small(project);
        for (const double x : {100.0, 101.0, 102.0})
            ASSERT_TRUE(document->apply({AddOperatorCommand{TerrainDecal{.x_m = x, .y_m = 50}, {}}}).ok());
    }
    {
        auto store = take(PageStore::open(project / "terrain.db", DatabaseMode::read_write));
        const auto row = *take(store.read_operator(2));
        ASSERT_TRUE(store.write_operator(2, row.json.substr(0, 30), OperatorNode{*row.node, ""}).ok());
        const auto other = *take(store.read_operator(3));
        ASSERT_TRUE(store.write_operator(3, other.json, OperatorNode{*other.node + 5, ""}).ok());
    }
    const auto document = take(Document::open(project));
    std::vector<const Operator*> found;
    {
        const auto lock = document->read_lock();
        document->operators_over_texture({0, 0, 2000, 2000}, 0, found);
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0]->id, 1u);
    }
    EXPECT_FALSE(document->find_operator(2));
    EXPECT_FALSE(document->apply({RemoveOperatorCommand{2}}).ok());
    const auto faults = take(Document::verify(project));
    ASSERT_EQ(faults.size(), 2u);
    EXPECT_NE(faults[0].find("operator 2"), std::string::npos) << faults[0];
    EXPECT_NE(faults[1].find("operator 3 is kept at another place"), std::string::npos) << faults[1];
    // What the sentence says mends it.
    ASSERT_TRUE(document->apply({EditOperatorCommand{3, TerrainDecal{.x_m = 102, .y_m = 51}, {}}}).ok());
    ASSERT_TRUE(document->undo().ok());
    EXPECT_EQ(take(Document::verify(project)).size(), 1u);
}

}  // namespace
