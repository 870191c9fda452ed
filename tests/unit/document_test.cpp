// The document: commands, undo, mips, persistence, locks, failure of a transaction.
#include <sys/resource.h>
#include <csignal>
#include <cstring>
#include <fstream>
#include <set>
#include <thread>

#include "document_fixture.h"
#include "index_texels.h"
#include "runtime/base/units.h"
#include "runtime/document/dirt.h"

using namespace loam;
using namespace loam::test;

namespace {

Command command_of(const char* json) {
    return take(parse_command(json));
}

std::vector<int32_t> all_heights(const Document& document) {
    const auto& s = document.settings();
    std::vector<int32_t> heights(size_t(s.height_samples_x) * size_t(s.height_samples_y));
    const auto lock = document.read_lock();
    document.read_heights_mm(0, 0, 0, s.height_samples_x, s.height_samples_y, heights.data());
    return heights;
}

int32_t height_at(const Document& document, int x, int y) {
    int32_t height = 0;
    const auto lock = document.read_lock();
    document.read_heights_mm(0, x, y, 1, 1, &height);
    return height;
}

void expect_sound(const std::filesystem::path& folder) {
    const auto faults = Document::verify(folder);
    ASSERT_TRUE(faults.ok()) << faults.message();
    for (const std::string& fault : *faults) ADD_FAILURE() << fault;
}

bool covered(const std::vector<WorldRect>& rects, double x, double y) {
    for (const WorldRect& rect : rects)
        if (rect.contains(x, y)) return true;
    return false;
}

void expect_mips_are_samples(const Document& document) {
    const auto& s = document.settings();
    const auto finest = all_heights(document);
    const auto texels = read_texels(document);
    const glm::ivec2 size = document.index_size_texels();
    const auto lock = document.read_lock();
    for (int mip = 1; mip < document.height_mip_count(); ++mip) {
        const int width = ((s.height_samples_x - 1) >> mip) + 1,
                  height = ((s.height_samples_y - 1) >> mip) + 1;
        std::vector<int32_t> coarse(size_t(width) * size_t(height));
        document.read_heights_mm(mip, 0, 0, width, height, coarse.data());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                ASSERT_EQ(coarse[size_t(y * width + x)],
                          finest[size_t((y << mip) * s.height_samples_x + (x << mip))])
                    << "mip " << mip << " at " << x << ", " << y;
    }
    for (int mip = 1; mip < document.index_mip_count(); ++mip) {
        const int width = ((size.x - 1) >> mip) + 1, height = ((size.y - 1) >> mip) + 1;
        std::vector<IndexTexel> coarse(size_t(width) * size_t(height));
        document.read_index(mip, 0, 0, width, height, coarse.data());
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                ASSERT_TRUE(coarse[size_t(y * width + x)] ==
                            texels[size_t((y << mip) * size.x + (x << mip))]);
    }
}

}  // namespace

TEST(document, starts_flat_and_reads_clamped) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    EXPECT_EQ(document->height_mip_count(), 4);  // 301 -> 151 -> 76 -> 38
    EXPECT_EQ(document->index_size_texels(), glm::ivec2(601, 413));
    for (const int32_t height : all_heights(*document)) ASSERT_EQ(height, 12000);
    ASSERT_TRUE(document
                    ->apply(command_of(
                        R"({"cmd":"sculpt","mode":"raise","dabs":[[0,0]],"radius_m":5,"strength_m":3})"))
                    .ok());
    EXPECT_EQ(height_at(*document, 0, 0), 15000);
    EXPECT_EQ(height_at(*document, -50, -7), 15000) << "outside: the nearest sample";
    std::vector<int32_t> window(200 * 100);
    const auto lock = document->read_lock();
    document->read_heights_mm(0, -100, -50, 200, 100, window.data());
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 200; ++x) {
            int32_t single = 0;
            document->read_heights_mm(0, std::max(0, x - 100), std::max(0, y - 50), 1, 1, &single);
            ASSERT_EQ(window[size_t(y * 200 + x)], single);
        }
}

TEST(document, sculpts_and_survives_reopening) {
    TemporaryFolder folder;
    uint64_t digest = 0;
    std::vector<int32_t> heights;
    {
        const auto document = create_small(folder.path() / "p");
        const auto dirt = take(document->apply(command_of(
            R"({"cmd":"sculpt","mode":"raise","dabs":[[100,100]],"radius_m":10,"strength_m":0.5,"hardness":0.5})")));
        ASSERT_EQ(dirt.height.size(), 1u);
        EXPECT_TRUE(dirt.index.empty());
        EXPECT_NEAR(dirt.height[0].min_x, 100 - 12, 1.01);
        EXPECT_NEAR(dirt.height[0].max_y, 100 + 12, 1.01);
        EXPECT_EQ(height_at(*document, 100, 100), 12500);
        EXPECT_EQ(height_at(*document, 111, 100), 12000);
        ASSERT_TRUE(document
                        ->apply(command_of(
                            R"({"cmd":"paint","dabs":[[50,50]],"radius_m":5,"layer":"scree","hardness":1})"))
                        .ok());
        ASSERT_TRUE(
            document->apply(command_of(R"({"cmd":"crater","x":200,"y":100,"radius_m":10,"seed":7})")).ok());
        digest = take(document->content_digest());
        heights = all_heights(*document);
    }
    const auto document = take(Document::open(folder.path() / "p"));
    EXPECT_EQ(take(document->content_digest()), digest);
    EXPECT_EQ(all_heights(*document), heights);
    EXPECT_EQ(document->operators().size(), 1u);
    EXPECT_EQ(take(document->history(10)).size(), 3u);
    EXPECT_NE(take(document->history(1))[0].json.find("crater"), std::string::npos) << "newest first";
    expect_sound(folder.path() / "p");
}

TEST(document, dirt_covers_every_change_and_is_tight) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    std::mt19937 random(3);
    for (int i = 0; i < 120; ++i) {
        const Command command = random_command(random, 20);
        const auto heights = all_heights(*document);
        const auto texels = read_texels(*document);
        const auto dirt = document->apply(command);
        if (!dirt.ok()) continue;
        EXPECT_LE(dirt->height.size(), 64u);
        const auto heights_after = all_heights(*document);
        const auto texels_after = read_texels(*document);
        const int width = document->settings().height_samples_x;
        for (size_t k = 0; k < heights.size(); ++k)
            if (heights[k] != heights_after[k]) {
                const double x = double(int(k) % width), y = double(int(k) / width);
                for (const double dx : {-2.0, 0.0, 2.0})
                    for (const double dy : {-2.0, 0.0, 2.0})
                        ASSERT_TRUE(covered(dirt->height, x + dx, y + dy)) << to_json(command);
            }
        const int texel_width = document->index_size_texels().x;
        for (size_t k = 0; k < texels.size(); ++k)
            if (!(texels[k] == texels_after[k])) {
                ASSERT_TRUE(covered(dirt->index, int(k) % texel_width * 0.5, int(k) / texel_width * 0.5));
            }
    }
    // A long stroke over the map gives few rectangles, which cover little more than the stroke.
    SculptCommand stroke;
    for (int i = 0; i <= 100; ++i) stroke.dabs.push_back({20 + i * 2.5, 20 + i * 1.5});
    stroke.radius_m = 6;
    const auto dirt = take(document->apply({stroke}));
    EXPECT_LE(dirt.height.size(), 8u);
    double area = 0;
    for (const WorldRect& rect : dirt.height) area += rect.width() * rect.height();
    EXPECT_LT(area, 0.6 * 266 * 166);
}

// Journals were once written without the size of decals, and then without cutouts.
TEST(document, dirt_of_an_older_journal_is_of_any_size) {
    Dirt dirt;
    dirt.texture = {{1, 2, 3, 4}};
    dirt.texture_size_m = 0.25;
    std::vector<uint8_t> bytes = dirt_bytes(dirt);
    auto now = dirt_of(bytes);
    ASSERT_TRUE(now.ok()) << now.message();
    EXPECT_EQ(now->texture_size_m, 0.25);
    EXPECT_EQ(now->texture, dirt.texture);
    bytes.resize(bytes.size() - sizeof(uint32_t) - sizeof(double));  // how many cutouts, and the size
    auto older = dirt_of(bytes);
    ASSERT_TRUE(older.ok()) << older.message();
    EXPECT_EQ(older->texture, dirt.texture);
    EXPECT_EQ(older->texture_size_m, INFINITY);
    bytes.pop_back();
    EXPECT_FALSE(dirt_of(bytes).ok());
}

TEST(document, a_command_touching_nothing_is_fine) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    const uint64_t digest = take(document->content_digest());
    const auto dirt = take(
        document->apply(command_of(R"({"cmd":"sculpt","mode":"raise","dabs":[[9000,9000]],"radius_m":5})")));
    EXPECT_TRUE(dirt.empty());
    EXPECT_TRUE(take(document->apply(command_of(R"({"cmd":"sculpt","mode":"smooth","dabs":[]})"))).empty());
    EXPECT_EQ(take(document->content_digest()), digest);
    EXPECT_TRUE(document->undo().ok());
    EXPECT_TRUE(document->undo().ok());
    EXPECT_EQ(document->undo().message(), "nothing to undo");
    expect_sound(folder.path() / "p");
}

TEST(document, a_brush_finer_than_the_map_still_moves_the_nearest_sample) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(10, 190);
    for (int i = 0; i < 50; ++i) {
        SculptCommand poke{.mode = SculptMode::raise, .dabs = {{place(random), place(random)}}};
        poke.radius_m = 0.02;
        poke.strength = 0.001;
        const int x = int(std::floor(poke.dabs[0].x + 0.5)), y = int(std::floor(poke.dabs[0].y + 0.5));
        const int32_t before = height_at(*document, x, y);
        ASSERT_FALSE(take(document->apply({poke})).height.empty());
        EXPECT_GT(height_at(*document, x, y), before);
    }
}

TEST(document, smoothing_and_flattening_do_what_they_say) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    ASSERT_TRUE(document
                    ->apply(command_of(
                        R"({"cmd":"sculpt","mode":"raise","dabs":[[100,100]],"radius_m":1,"strength_m":10})"))
                    .ok());
    const int32_t spike = height_at(*document, 100, 100);
    ASSERT_GT(spike, 20000);
    ASSERT_TRUE(document
                    ->apply(command_of(
                        R"({"cmd":"sculpt","mode":"smooth","dabs":[[100,100]],"radius_m":8,"strength":1})"))
                    .ok());
    EXPECT_LT(height_at(*document, 100, 100), spike - 3000);
    EXPECT_GT(height_at(*document, 102, 100), 12000);
    int32_t low = INT32_MAX, high = 0;
    for (int i = 0; i < 20; ++i)
        ASSERT_TRUE(
            document
                ->apply(command_of(
                    R"({"cmd":"sculpt","mode":"smooth","dabs":[[100,100]],"radius_m":8,"strength":1})"))
                .ok());
    for (const int32_t height : all_heights(*document))
        low = std::min(low, height), high = std::max(high, height);
    EXPECT_GE(low, 12000) << "averaging never overshoots";
    EXPECT_LT(high, 12500);
    ASSERT_TRUE(
        document
            ->apply(command_of(
                R"({"cmd":"sculpt","mode":"flatten","dabs":[[100,100]],"radius_m":10,"strength":1,"hardness":1,"target_m":50})"))
            .ok());
    EXPECT_EQ(height_at(*document, 100, 100), 50000);
    EXPECT_EQ(height_at(*document, 106, 104), 50000);
    EXPECT_EQ(height_at(*document, 111, 100), 12000);
}

TEST(document, painting_fills_a_solid_disc_and_keeps_to_slopes) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    ASSERT_TRUE(
        document
            ->apply(command_of(
                R"({"cmd":"paint","dabs":[[100,100]],"radius_m":5,"layer":"scree","strength":1,"hardness":1,"tint":[0.5,1,0]})"))
            .ok());
    const auto texels = read_texels(*document);
    const int width = document->index_size_texels().x;
    for (int y = 0; y < document->index_size_texels().y; ++y)
        for (int x = 0; x < width; ++x) {
            const bool inside = std::hypot(x * 0.5 - 100, y * 0.5 - 100) <= 5;
            const IndexTexel& texel = texels[size_t(y * width + x)];
            ASSERT_EQ(texel.layer, inside ? 2 : 0) << x << ", " << y;
            ASSERT_EQ(texel.tint[0], inside ? 128 : 255);
            ASSERT_EQ(texel.tint[2], inside ? 0 : 255);
        }
    // Half strength: about half of the texels, and a second dab of the same seed adds none.
    const char* half =
        R"({"cmd":"paint","dabs":[[200,100]],"radius_m":15,"layer":"dirt","strength":0.5,"hardness":1,"seed":4})";
    ASSERT_TRUE(document->apply(command_of(half)).ok());
    const auto count = [&] {
        size_t n = 0;
        for (const IndexTexel& texel : read_texels(*document)) n += texel.layer == 1;
        return n;
    };
    const double share = double(count()) / (3.14159 * 30 * 30);
    EXPECT_NEAR(share, 0.5, 0.05);
    const size_t before = count();
    ASSERT_TRUE(document->apply(command_of(half)).ok());
    EXPECT_EQ(count(), before);
    // Slope: a steep cone is painted, the flat around it is not.
    ASSERT_TRUE(
        document
            ->apply(command_of(
                R"({"cmd":"sculpt","mode":"raise","dabs":[[60,160]],"radius_m":10,"strength_m":20,"hardness":0})"))
            .ok());
    ASSERT_TRUE(
        document
            ->apply(command_of(
                R"({"cmd":"paint","dabs":[[60,160]],"radius_m":20,"layer":"dirt","hardness":1,"min_slope_rad":0.5})"))
            .ok());
    const auto sloped = read_texels(*document);
    EXPECT_EQ(sloped[size_t(320 * width + 120 + 10)].layer, 1);  // 5 m east of the top
    EXPECT_EQ(sloped[size_t(320 * width + 120 + 30)].layer, 0);  // 15 m: flat
    expect_mips_are_samples(*document);
}

// Texel by texel: a rectangle's lower edges belong to it and its upper ones do not; masks look at the ground.
TEST(document, fills_replace_a_layer_where_the_ground_lets_them) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    const auto apply = [&](const char* json) {
        const auto dirt = document->apply(command_of(json));
        ASSERT_TRUE(dirt.ok()) << dirt.message();
    };
    const glm::ivec2 size = document->index_size_texels();
    const auto at = [&](const std::vector<IndexTexel>& texels, double x_m, double y_m) {
        return texels[size_t(int(y_m * 2) * size.x + int(x_m * 2))];
    };
    apply(R"({"cmd":"paint","dabs":[[100,100]],"radius_m":20,"layer":"dirt","hardness":1})");
    const auto before = read_texels(*document);
    apply(R"({"cmd":"fill","rect":[90,90,110,100],"layer":"scree","replace":"dirt","tint":[0,1,1]})");
    const auto after = read_texels(*document);
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            const size_t i = size_t(y * size.x + x);
            const bool inside = x >= 180 && x < 220 && y >= 180 && y < 200 && before[i].layer == 1;
            ASSERT_EQ(after[i].layer, inside ? 2 : before[i].layer) << x << ", " << y;
            ASSERT_EQ(after[i].tint[0], inside ? 0 : 255);
        }
    // Adjoining halves meet once: a tint of half strength is the same on both sides and on the line.
    apply(R"({"cmd":"fill","rect":[200,20,210,30],"tint":[0,0,0],"strength":0.5})");
    apply(R"({"cmd":"fill","rect":[210,20,220,30],"tint":[0,0,0],"strength":0.5})");
    const auto halves = read_texels(*document);
    for (double x = 200; x < 220; x += 0.5) ASSERT_EQ(at(halves, x, 25).tint[0], 128) << x;
    EXPECT_EQ(at(halves, 220, 25).tint[0], 255);
    // Heights: only the top of a hill.
    apply(R"({"cmd":"sculpt","mode":"raise","dabs":[[60,160]],"radius_m":10,"strength_m":20,"hardness":0})");
    apply(R"({"cmd":"fill","layer":"scree","min_height_m":22})");
    const auto high = read_texels(*document);
    EXPECT_EQ(at(high, 60, 160).layer, 2);
    EXPECT_EQ(at(high, 69, 160).layer, 0) << "12 m and a little";
    // Noise: patches, neither nothing nor all, and what is left out is as it was.
    apply(R"({"cmd":"fill","layer":"dirt","noise":1,"noise_size_m":6,"seed":5})");
    size_t taken = 0, changed_tint = 0;
    const auto patches = read_texels(*document);
    for (size_t i = 0; i < patches.size(); ++i) {
        taken += patches[i].layer == 1 && high[i].layer != 1;
        changed_tint += patches[i].tint[0] != high[i].tint[0];
    }
    EXPECT_GT(double(taken), 0.2 * double(patches.size()));
    EXPECT_LT(double(taken), 0.8 * double(patches.size()));
    EXPECT_EQ(changed_tint, 0u);
    expect_mips_are_samples(*document);
    // A fill that finds nothing is no step; undoing all of them brings the first map back.
    const uint64_t revision = document->revision();
    apply(R"({"cmd":"fill","rect":[-500,-500,-10,-10],"layer":"dirt"})");
    EXPECT_EQ(document->revision(), revision);
    for (int i = 0; i < 6; ++i) ASSERT_TRUE(document->undo().ok());
    EXPECT_EQ(read_texels(*document), before);
}

TEST(document, ten_thousand_raises_saturate) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    SculptCommand raise;
    raise.dabs.assign(10000, {100, 100});
    raise.radius_m = 4;
    raise.strength = 10;
    ASSERT_TRUE(document->apply({raise}).ok());
    EXPECT_EQ(height_at(*document, 100, 100), kHeightLimit_mm);
    raise.mode = SculptMode::lower;
    for (int i = 0; i < 2; ++i) ASSERT_TRUE(document->apply({raise}).ok());
    EXPECT_EQ(height_at(*document, 100, 100), -kHeightLimit_mm);
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(document->undo().ok());
    EXPECT_EQ(height_at(*document, 100, 100), 12000);
}

TEST(document, undo_and_redo_are_exact_over_random_commands) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = create_small(path);
    std::mt19937 random(11);
    std::vector<uint64_t> digests{take(document->content_digest())};  // after each undo step
    std::vector<std::vector<int32_t>> some_heights;
    uint64_t group = 0;
    std::vector<bool> continues;  // the command belongs to the group of the one before
    int applied = 0;
    while (applied < 500) {
        const bool same_group = group != 0 && random() % 3 != 0;
        if (!same_group) group = random() % 2 == 0 ? document->next_group() : 0;
        Command command = random_command(random, 30);
        command.group = group;
        const auto dirt = document->apply(command);
        // A fill that finds nothing to do is no step, nor is moving the time.
        if (!dirt.ok() || std::holds_alternative<TimeCommand>(command.body) ||
            (std::holds_alternative<FillCommand>(command.body) && dirt->empty())) {
            if (!same_group) group = 0;
            continue;
        }
        ++applied;
        const uint64_t digest = take(document->content_digest());
        if (same_group && continues.size() == digests.size() - 1 && !continues.empty())
            digests.back() = digest;
        else
            digests.push_back(digest), continues.push_back(false);
        if (applied == 250) {
            document.reset();
            document = take(Document::open(path));
        }
    }
    const std::set<uint64_t> distinct(digests.begin(), digests.end());
    EXPECT_GT(distinct.size(), digests.size() * 3 / 4) << "negative control: most steps change the digest";
    expect_mips_are_samples(*document);
    const auto heights = all_heights(*document);
    const auto texels = read_texels(*document);
    for (size_t i = digests.size() - 1; i > 0; --i) {
        const auto dirt = document->undo();
        ASSERT_TRUE(dirt.ok()) << dirt.message();
        ASSERT_EQ(take(document->content_digest()), digests[i - 1]) << "undoing step " << i;
        if (i == digests.size() / 2) {
            document.reset();
            document = take(Document::open(path));
        }
    }
    EXPECT_FALSE(document->can_undo());
    for (const int32_t height : all_heights(*document)) ASSERT_EQ(height, 12000);
    EXPECT_TRUE(document->operators().empty());
    EXPECT_EQ(document->statistics().height_pages, 0u);
    expect_sound(path);
    for (size_t i = 1; i < digests.size(); ++i) {
        ASSERT_TRUE(document->redo().ok());
        ASSERT_EQ(take(document->content_digest()), digests[i]) << "redoing step " << i;
    }
    EXPECT_FALSE(document->can_redo());
    EXPECT_EQ(document->redo().message(), "nothing to redo");
    EXPECT_EQ(all_heights(*document), heights);
    EXPECT_TRUE(read_texels(*document) == texels);
    expect_sound(path);
}

TEST(document, a_new_command_drops_what_was_undone_and_ids_are_not_reused) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = create_small(path);
    const Command crater = command_of(R"({"cmd":"crater","x":200,"y":100,"radius_m":10})");
    ASSERT_TRUE(document->apply(crater).ok());
    ASSERT_TRUE(document->apply(crater).ok());
    ASSERT_TRUE(document->undo().ok());
    EXPECT_TRUE(document->can_redo());
    document.reset();
    document = take(Document::open(path));
    EXPECT_TRUE(document->can_redo());
    ASSERT_TRUE(document->apply(crater).ok());
    EXPECT_FALSE(document->can_redo());
    ASSERT_EQ(document->operators().size(), 2u);
    EXPECT_EQ(document->operators()[0].id, 1u);
    EXPECT_EQ(document->operators()[1].id, 3u);
    EXPECT_EQ(take(document->history(10)).size(), 2u);
    EXPECT_EQ(document->apply(command_of(R"({"cmd":"remove","id":2})")).message(), "there is no operator 2");
    ASSERT_TRUE(document->apply(command_of(R"({"cmd":"operator","id":3,"enabled":false})")).ok());
    std::vector<const Operator*> found;
    {
        const auto lock = document->read_lock();
        document->operators_over_height({190, 90, 210, 110}, 0, found);
    }
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0]->id, 1u);
    expect_sound(path);
}

TEST(document, refuses_what_is_out_of_range_and_changes_nothing) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    const uint64_t digest = take(document->content_digest()), revision = document->revision();
    SculptCommand sculpt{.mode = SculptMode::raise, .dabs = {{0, std::nan("")}}};
    EXPECT_NE(document->apply({sculpt}).message().find("dab 0"), std::string::npos);
    sculpt.dabs = {{1, 1}};
    sculpt.radius_m = 6000;
    EXPECT_NE(document->apply({sculpt}).message().find("radius_m is 6000"), std::string::npos);
    PaintCommand paint;
    paint.dabs = {{1, 1}};
    EXPECT_EQ(document->apply({paint}).message(), "paint needs a layer or a tint");
    paint.layer = "lava";
    EXPECT_EQ(document->apply({paint}).message(), "unknown layer \"lava\" (known: grass, dirt, scree)");
    EXPECT_EQ(take(document->content_digest()), digest);
    EXPECT_EQ(document->revision(), revision);
    EXPECT_FALSE(document->can_undo());
}

TEST(document, a_second_writer_is_refused) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = create_small(path);
    const auto second = Document::open(path);
    ASSERT_FALSE(second.ok());
    EXPECT_NE(second.message().find("open for writing elsewhere"), std::string::npos) << second.message();
    auto reader = take(Document::open(path, OpenMode::read_only));
    const Command crater = command_of(R"({"cmd":"crater","x":200,"y":100,"radius_m":10})");
    EXPECT_NE(reader->apply(crater).message().find("read-only"), std::string::npos);
    EXPECT_FALSE(reader->undo().ok());
    EXPECT_TRUE(document->apply(crater).ok());
    document.reset();
    EXPECT_TRUE(Document::open(path).ok());
}

TEST(document, creating_over_a_project_is_refused) {
    TemporaryFolder folder;
    create_small(folder.path() / "p").reset();
    const auto again = Document::create(folder.path() / "p", small_settings());
    ASSERT_FALSE(again.ok());
    EXPECT_NE(again.message().find("already holds a project"), std::string::npos);
    ProjectSettings bad = small_settings();
    bad.index_spacing_m = 0.3;
    EXPECT_NE(Document::create(folder.path() / "q", bad).message().find("power of two"), std::string::npos);
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "q"));
}

TEST(document, settings_can_change_where_pages_do_not_depend_on_them) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = create_small(path);
    ProjectSettings settings = document->settings();
    settings.sun_azimuth_rad = 1.25;
    settings.layers.push_back({"lava", "layers/lava.layer", 1.0});
    ASSERT_TRUE(document->change_settings(settings).ok());
    settings.height_spacing_m = 2;
    EXPECT_EQ(document->change_settings(settings).message(),
              "height_spacing_m cannot change once a project exists");
    document.reset();
    document = take(Document::open(path));
    EXPECT_EQ(document->settings().sun_azimuth_rad, 1.25);
    EXPECT_EQ(document->layer_index("lava"), 3);
    EXPECT_EQ(document->roles().scorched, 1);
}

// A file size limit stands in for a full disk: SQLite's writes fail in the middle of a transaction.
TEST(document, a_failed_transaction_leaves_the_old_state) {
    TemporaryFolder folder;
    const auto path = folder.path() / "p";
    auto document = create_small(path);
    ASSERT_TRUE(document
                    ->apply(command_of(
                        R"({"cmd":"sculpt","mode":"raise","dabs":[[100,100]],"radius_m":30,"strength_m":5})"))
                    .ok());
    const uint64_t digest = take(document->content_digest()), revision = document->revision();
    const auto heights = all_heights(*document);
    PaintCommand paint;  // dithered noise over the whole map: some 60 KB
    paint.dabs = {{150, 100}};
    paint.radius_m = 200;
    paint.layer = "scree";
    paint.strength = 0.5;
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit tight = before;
    tight.rlim_cur = std::filesystem::file_size(path / "terrain.db-wal") + 20 * 1024;
    setrlimit(RLIMIT_FSIZE, &tight);
    const auto status = document->apply({paint});
    setrlimit(RLIMIT_FSIZE, &before);
    ASSERT_FALSE(status.ok());
    EXPECT_NE(status.message().find("terrain.db"), std::string::npos) << status.message();
    EXPECT_EQ(take(document->content_digest()), digest);
    EXPECT_EQ(document->revision(), revision);
    for (const IndexTexel& texel : read_texels(*document)) ASSERT_EQ(texel.layer, 0);
    EXPECT_EQ(all_heights(*document), heights);
    ASSERT_TRUE(document->apply({paint}).ok()) << "works again with room";
    ASSERT_TRUE(document->undo().ok());
    EXPECT_EQ(take(document->content_digest()), digest);
    expect_sound(path);
}

TEST(document, readers_see_whole_commands) {
    TemporaryFolder folder;
    const auto document = create_small(folder.path() / "p");
    std::atomic<bool> stop{false};
    std::atomic<int> torn{0}, reads{0};
    const auto read = [&] {
        std::vector<int32_t> heights(301 * 207);
        while (!stop) {
            const auto lock = document->read_lock();
            document->read_heights_mm(0, 0, 0, 301, 207, heights.data());
            for (const int32_t height : heights) torn += height != heights[0];
            ++reads;
        }
    };
    std::thread first(read), second(read);
    // The whole map up, bit by bit, and back: always flat.
    const Command up = command_of(
        R"({"cmd":"sculpt","mode":"raise","dabs":[[150,100]],"radius_m":1000,"strength_m":1,"hardness":1})");
    for (int i = 0; i < 20; ++i) {
        const auto applied = document->apply(up);
        ASSERT_TRUE(applied.ok()) << applied.message();
        if (i % 3 == 2) {
            EXPECT_TRUE(document->undo().ok());
        }
    }
    while (reads < 4) std::this_thread::yield();
    stop = true;
    first.join();
    second.join();
    EXPECT_EQ(torn, 0);
}
