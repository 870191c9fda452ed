// Live sectors: sizes by distance, places in the indirection texture under any traffic, what happens when it
// is full.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "runtime/texture/sector_set.h"

namespace {

using namespace loam;

constexpr double kAngle = 1.0 / 500;  // a texel at 1 m is 2 mm
constexpr double kRoot_m = 64.0 / kPagePayload;

SectorSetDesc desc(int log2_size, int max_live = 255, int default_log2_width = 5) {
    return {.layout = {.default_log2_width = default_log2_width, .default_log2_page = 0},
            .indirection_log2_size = log2_size,
            .max_live = max_live};
}

// Distance at which a texel of an image of this width is as fine as wanted.
double distance_for(int log2) {
    return kRoot_m / double(1 << log2) / kAngle;
}

TEST(SectorSet, ImagesAreSizedByDistance) {
    SectorSet sectors(desc(10));
    const std::vector<SectorDistance> near = {{{3, 3}, 0.0},
                                              {{4, 3}, distance_for(8) * 1.01},
                                              {{5, 3}, distance_for(4)},
                                              {{6, 3}, distance_for(1) * 1.01},
                                              {{7, 3}, distance_for(0) * 1.01}};
    sectors.update(near, kAngle, 1);
    ASSERT_EQ(sectors.live().size(), 4u) << "the last one is served by the default image";
    EXPECT_EQ(sectors.find({3, 3})->log2_width(), 8) << "256 x 256 pages at most";
    EXPECT_EQ(sectors.find({4, 3})->log2_width(), 8);
    EXPECT_EQ(sectors.find({5, 3})->log2_width(), 4);
    EXPECT_EQ(sectors.find({6, 3})->log2_width(), 1);
    EXPECT_NEAR(kRoot_m / 256, 0.001, 0.00001) << "about a millimetre a texel";
}

TEST(SectorSet, DistancesThatAreNoNumbersAreTheNearest) {
    SectorSet sectors(desc(10));
    const std::vector<SectorDistance> near = {{{1, 1}, std::nan("")}, {{2, 1}, -5.0}, {{3, 1}, INFINITY}};
    sectors.update(near, kAngle, 1);
    ASSERT_EQ(sectors.live().size(), 2u);
    EXPECT_EQ(sectors.find({1, 1})->log2_width(), 8);
    EXPECT_EQ(sectors.find({2, 1})->log2_width(), 8);
    for (const double texel_m : {0.0, 1e-30, double(INFINITY), double(std::nan(""))})
        EXPECT_LE(sectors.wanted_log2(texel_m), 8);
    EXPECT_EQ(sectors.wanted_log2(std::nan("")), -1);
}

TEST(SectorSet, GrowsAtOnceShrinksWithSlack) {
    SectorSet sectors(desc(10));
    const auto width_at = [&](double distance_m) {
        const SectorDistance near[] = {{{3, 3}, distance_m}};
        sectors.update(near, kAngle, 1);
        const LiveSector* s = sectors.find({3, 3});
        return s ? s->log2_width() : -1;
    };
    EXPECT_EQ(width_at(distance_for(3)), 3);
    EXPECT_EQ(width_at(distance_for(3) * 0.99), 4);
    EXPECT_EQ(width_at(distance_for(3) * 1.01), 4) << "slack";
    EXPECT_EQ(width_at(distance_for(3) * 1.2), 4);
    EXPECT_EQ(width_at(distance_for(3) * 1.3), 3);
    EXPECT_EQ(width_at(distance_for(0) * 1.2), 1);
    EXPECT_EQ(width_at(distance_for(0) * 1.3), -1);
}

TEST(SectorSet, TheTableNamesPlaceAndWidthOnceTheRootIsThere) {
    SectorSet sectors(desc(10));
    const SectorDistance near[] = {{{10, 10}, distance_for(5)}};
    sectors.update(near, kAngle, 1);
    std::vector<uint32_t> table(kSectorTableSide * kSectorTableSide);
    sectors.write_table({10, 10}, table);
    EXPECT_EQ(table[32 * 64 + 32], 0u);
    LiveSector& s = sectors.live()[0];
    s.in_table = true;
    sectors.write_table({10, 10}, table);
    EXPECT_EQ(table[32 * 64 + 32],
              uint32_t(s.id) | uint32_t(s.origin.x) << 8 | uint32_t(s.origin.y) << 18 | 5u << 28);
}

TEST(SectorSet, AFullIndirectionTextureHalvesTheLargestAndFarthest) {
    SectorSet sectors(desc(9));  // 512²: 262,144 texels, 1,024 of them the default image's
    std::vector<SectorDistance> near;
    for (int i = 0; i < 4; ++i) near.push_back({{i, 0}, distance_for(8) * (0.5 + 0.1 * i)});
    near.push_back({{9, 0}, distance_for(2)});
    sectors.update(near, kAngle, 1);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(sectors.find({i, 0})->log2_width(), 8);
    EXPECT_EQ(sectors.find({3, 0})->log2_width(), 7);
    EXPECT_EQ(sectors.find({9, 0})->log2_width(), 2) << "small ones keep theirs";
    EXPECT_EQ(sectors.capped_count(), 1);
    EXPECT_EQ(sectors.cap_log2(), 7);
    EXPECT_LE(sectors.used_texels(), sectors.capacity_texels());
    near.resize(1);
    sectors.update(near, kAngle, 2);
    EXPECT_EQ(sectors.capped_count(), 0);
}

TEST(SectorSet, WhereIdsAreShortSeenSectorsComeFirst) {
    SectorSet sectors(desc(10, 3));
    std::vector<SectorDistance> near;
    for (int i = 0; i < 6; ++i) near.push_back({{i, 0}, distance_for(3) * (1.0 + 0.05 * i)});
    sectors.update(near, kAngle, 1);
    ASSERT_EQ(sectors.live().size(), 3u);
    for (const LiveSector& s : sectors.live()) EXPECT_LT(s.sector.x, 3) << "the nearest";
    const uint64_t later = 1 + SectorSet::kSeenFrames + 5;
    sectors.seen({0, 0}, later);
    sectors.seen({1, 0}, later);  // but not sector 2
    sectors.update(near, kAngle, later);
    EXPECT_NE(sectors.find({0, 0}), nullptr);
    EXPECT_NE(sectors.find({1, 0}), nullptr);
    EXPECT_EQ(sectors.find({2, 0}), nullptr) << "gave way to one that may be seen";
}

// The indirection texture as the shader makes it.
struct Mirror {
    int side;
    std::vector<uint32_t> texels;  // side high, 1.5 times as wide
    [[nodiscard]] int width() const { return side * 3 / 2; }
    void apply(SectorSet& sectors, bool lose_one) {
        std::vector<shared::IndirectionFill> fills;
        sectors.default_tree().take_fills({0, 0}, side, fills);
        for (LiveSector& s : sectors.live()) s.tree->take_fills(s.origin, side, fills);
        if (lose_one && fills.size() > 2) fills.erase(fills.begin() + 1);
        for (const auto& f : fills)
            for (int y = 0; y < f.size; ++y)
                for (int x = 0; x < f.size; ++x) texels[size_t((f.y + y) * width() + f.x + x)] = f.value;
    }
    [[nodiscard]] int differing(const SectorSet& sectors) const {
        int wrong = 0;
        const auto compare = [&](const PageTree& tree, glm::ivec2 origin) {
            for (int level = 0; level <= tree.log2_width(); ++level) {
                const int depth = tree.log2_width() - level;
                const glm::ivec2 at = shared::vt_level_origin(level, side) + (origin >> level);
                for (int y = 0; y < 1 << depth; ++y)
                    for (int x = 0; x < 1 << depth; ++x)
                        wrong += texels[size_t((at.y + y) * width() + at.x + x)] != tree.shown(depth, x, y);
            }
        };
        compare(sectors.default_tree(), {0, 0});
        for (const LiveSector& s : sectors.live()) compare(*s.tree, s.origin);
        return wrong;
    }
};

struct Traffic {
    int wrong = 0;
    int resized = 0, capped_steps = 0, most_live = 0;
};

// An eye that wanders over ground with pages coming and going.
Traffic random_traffic(int steps, bool lose_fills, int log2_size) {
    std::mt19937 random(17);
    const auto real = [&](double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random);
    };
    SectorSet sectors(desc(log2_size, 40));
    Mirror mirror{1 << log2_size, std::vector<uint32_t>(size_t(3) << (2 * log2_size - 1), 0xdeadbeefu)};
    const WorldRect bounds{0, 0, 2048, 2048};
    glm::dvec3 eye(700, 700, 10);
    Traffic traffic;
    for (int step = 0; step < steps; ++step) {
        if (random() % 100 == 0) eye = {real(0, 2048), real(0, 2048), real(0.3, 100)};
        eye += glm::dvec3(real(-8, 8), real(-8, 8), 0);
        eye.z = std::clamp(eye.z * real(0.85, 1.176), 0.3, 100.0);
        auto near = flat_sector_distances(bounds, eye, 170);
        // Now and then sizes that no eye asks for, which cut the texture up.
        for (SectorDistance& s : near)
            if (step % 4 == 0 && random() % 6 == 0) s.distance_m = distance_for(0) / real(1, 40);
        const SectorSet::Changes changes = sectors.update(near, kAngle, uint64_t(step));
        traffic.resized += int(changes.resized.size());
        traffic.capped_steps += sectors.capped_count() > 0;
        traffic.most_live = std::max(traffic.most_live, int(sectors.live().size()));
        // The places are aligned, inside, disjoint: counted by what is used.
        int64_t area = int64_t(1) << (2 * sectors.default_tree().log2_width());
        for (const LiveSector& s : sectors.live()) {
            EXPECT_EQ(s.origin.x & ((1 << s.log2_width()) - 1), 0);
            EXPECT_EQ(s.origin.y & ((1 << s.log2_width()) - 1), 0);
            area += int64_t(1) << (2 * s.log2_width());
        }
        EXPECT_EQ(area, sectors.used_texels());
        for (int i = 0; i < 6 && !sectors.live().empty(); ++i) {
            LiveSector& s = sectors.live()[random() % sectors.live().size()];
            const int depth = int(random() % uint32_t(s.log2_width() + 1));
            const uint32_t mask = (1u << depth) - 1;
            s.tree->set(depth, int(random() & mask), int(random() & mask),
                        random() % 3 == 0 ? kNoPage : uint32_t(random() & 0xffffff));
        }
        mirror.apply(sectors, lose_fills);
        // Comparing is the slow part: every step at first, then now and then.
        if (step < 100 || step % 50 == 0) traffic.wrong += mirror.differing(sectors);
    }
    return traffic;
}

TEST(SectorSet, AnyTrafficLeavesTheIndirectionAsIfRebuilt) {
    const Traffic t = random_traffic(10'000, false, 8);
    EXPECT_EQ(t.wrong, 0);
    EXPECT_GT(t.resized, 500);
    EXPECT_GT(t.capped_steps, 10);
    EXPECT_GT(t.most_live, 10);
}

TEST(SectorSet, ASquareThatFitsByItsAreaIsNeverRefused) {
    SectorSet sectors(desc(8));  // 256²: sixteen squares of 64², in the first the default image's 32²
    std::vector<SectorDistance> near;
    for (int i = 0; i < 15; ++i) near.push_back({{i, 0}, distance_for(6)});
    sectors.update(near, kAngle, 1);
    ASSERT_EQ(sectors.live().size(), 15u);
    // One stays in each of the three quarters that the default image is not in.
    std::vector<SectorDistance> kept;
    for (const glm::ivec2 quarter : {glm::ivec2(1, 0), glm::ivec2(0, 1), glm::ivec2(1, 1)})
        for (const LiveSector& s : sectors.live())
            if (s.origin / 128 == quarter) {
                kept.push_back({s.sector, distance_for(6)});
                break;
            }
    ASSERT_EQ(kept.size(), 3u);
    sectors.update(kept, kAngle, 2);
    EXPECT_EQ(sectors.repack_count(), 0u);
    kept.push_back({{20, 20}, distance_for(7)});
    sectors.update(kept, kAngle, 3);
    ASSERT_NE(sectors.find({20, 20}), nullptr);
    EXPECT_EQ(sectors.find({20, 20})->log2_width(), 7);
    EXPECT_EQ(sectors.repack_count(), 1u);
    EXPECT_EQ(sectors.capped_count(), 0);
}

TEST(SectorSet, ALostSquareIsSeen) {
    EXPECT_GT(random_traffic(200, true, 8).wrong, 0);
}

}  // namespace
