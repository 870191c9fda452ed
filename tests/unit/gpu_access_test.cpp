// Barriers between uses, without a device.
#include "runtime/gpu/access.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace loam::gpu {
namespace {

constexpr Access kAll[] = {Access::copy_source,     Access::copy_target,      Access::compute_sampled,
                           Access::compute_storage, Access::vertex_read,      Access::fragment_sampled,
                           Access::graphics_read,   Access::fragment_storage, Access::color_target,
                           Access::depth_target,    Access::depth_sampled,    Access::indirect_args,
                           Access::index_buffer,    Access::host_read,        Access::present};

bool covers(VkFlags64 set, VkFlags64 part) {
    return (part & ~set) == 0;
}

TEST(GpuAccess, EveryAccessIsKnown) {
    for (const Access access : kAll) {
        const AccessInfo info = access_info(access);
        EXPECT_NE(info.stages, 0u) << int(access);
        EXPECT_NE(info.layout, VK_IMAGE_LAYOUT_UNDEFINED) << int(access);
    }
}

TEST(GpuAccess, PairsNeedABarrierForWritesAndLayouts) {
    EXPECT_TRUE(needs_barrier(Access::compute_storage, Access::compute_storage, false));
    EXPECT_TRUE(needs_barrier(Access::compute_sampled, Access::compute_storage, false));
    EXPECT_FALSE(needs_barrier(Access::compute_sampled, Access::indirect_args, false));
    EXPECT_FALSE(needs_barrier(Access::compute_sampled, Access::fragment_sampled, true));
    EXPECT_TRUE(needs_barrier(Access::compute_sampled, Access::copy_source, true));
    EXPECT_FALSE(needs_barrier(Access::compute_sampled, Access::copy_source, false));
    EXPECT_TRUE(needs_barrier(Access::undefined, Access::compute_sampled, true));
    EXPECT_FALSE(needs_barrier(Access::undefined, Access::compute_storage, false));
}

TEST(GpuAccess, EachReadingStageWaitsForTheWriteOnce) {
    SyncState state;
    EXPECT_FALSE(advance(state, Access::compute_storage, false));  // nothing came before
    const auto vertex = advance(state, Access::vertex_read, false);
    ASSERT_TRUE(vertex);
    EXPECT_EQ(vertex->source_access, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    const auto fragment = advance(state, Access::fragment_sampled, false);
    ASSERT_TRUE(fragment) << "the vertex stage's barrier does not cover fragments";
    EXPECT_EQ(fragment->source_stages, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);
    EXPECT_EQ(fragment->source_access, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT);
    EXPECT_FALSE(advance(state, Access::graphics_read, false)) << "both are covered by now";
    EXPECT_FALSE(advance(state, Access::vertex_read, false));
}

TEST(GpuAccess, AWriteWaitsForAllReaders) {
    SyncState state = state_after(Access::copy_target);
    ASSERT_TRUE(advance(state, Access::vertex_read, false));
    ASSERT_TRUE(advance(state, Access::compute_sampled, false));
    const auto write = advance(state, Access::copy_target, false);
    ASSERT_TRUE(write);
    EXPECT_TRUE(covers(write->source_stages,
                       VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT));
}

TEST(GpuAccess, AChangeOfLayoutCountsAsAWrite) {
    SyncState state = state_after(Access::color_target);
    ASSERT_TRUE(advance(state, Access::compute_sampled, true));
    const auto fragment = advance(state, Access::fragment_sampled, true);
    ASSERT_TRUE(fragment) << "the new layout is visible to compute only";
    EXPECT_EQ(fragment->source_stages, VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT);  // chains with the change
    EXPECT_EQ(fragment->old_layout, fragment->new_layout);
}

TEST(GpuAccess, UndefinedKeepsTheUsersAndDropsTheContents) {
    SyncState state = state_after(Access::fragment_sampled);
    EXPECT_FALSE(advance(state, Access::undefined, true));
    const auto target = advance(state, Access::color_target, true);
    ASSERT_TRUE(target);
    EXPECT_EQ(target->old_layout, VK_IMAGE_LAYOUT_UNDEFINED);
    EXPECT_EQ(target->source_stages, VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT);
}

// A slow model beside the fast one: for every earlier use, the set of stages that execution after it is
// ordered behind, and for the last write, the pairs (stage, access) to which it is visible. Barriers extend
// both; each use must find itself ordered behind whatever it conflicts with.
struct Model {
    struct Event {
        VkFlags64 stages;          // where it ran
        VkFlags64 ordered_before;  // stages that wait for it by now
        VkFlags64 visible_stages = 0, visible_access = 0;
        bool write;
    };
    std::vector<Event> events;

    void barrier(const BarrierMasks& b) {
        for (Event& e : events) {
            const bool caught =
                covers(b.source_stages, e.stages) || (e.ordered_before & b.source_stages) != 0;
            if (!caught) continue;
            e.ordered_before |= b.target_stages;
            if (e.write) {
                e.visible_stages |= b.target_stages;
                e.visible_access |= b.target_access;
            }
        }
        if (b.old_layout != b.new_layout) {
            EXPECT_TRUE(std::ranges::all_of(events, [&](const Event& e) {
                return covers(e.ordered_before, b.target_stages);
            })) << "a layout changes while the image is in use";
        }
    }
    void use(const AccessInfo& info) {
        for (const Event& e : events) {
            if (!e.write && !info.writes) continue;
            EXPECT_TRUE(covers(e.ordered_before, info.stages)) << "not ordered";
            if (e.write) {
                EXPECT_TRUE(covers(e.visible_stages, info.stages) && covers(e.visible_access, info.access))
                    << "write not visible";
            }
        }
        // Once ordered behind a write, all before it is ordered too.
        if (info.writes) events.clear();
        events.push_back({.stages = info.stages, .ordered_before = 0, .write = info.writes});
    }
};

TEST(GpuAccess, RandomSequencesAreOrderedAndVisible) {
    std::mt19937 random(1);
    for (int run = 0; run < 2000; ++run) {
        const bool image = run % 2;
        SyncState state;
        Model model;
        for (int step = 0; step < 12; ++step) {
            const Access access = kAll[random() % (std::size(kAll) - 1)];  // all but present
            const VkImageLayout before = state.layout;
            const auto masks = advance(state, access, image);
            if (masks) {
                EXPECT_EQ(masks->old_layout, before);
                if (!image)  // layouts mean nothing to a buffer
                    model.barrier({masks->source_stages, masks->source_access, masks->target_stages,
                                   masks->target_access, VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_LAYOUT_GENERAL});
                else
                    model.barrier(*masks);
            }
            model.use(access_info(access));
            if (image) {
                EXPECT_EQ(state.layout, access_info(access).layout);
            }
            ASSERT_FALSE(::testing::Test::HasFailure()) << "run " << run << " step " << step;
        }
    }
}

}  // namespace
}  // namespace loam::gpu
