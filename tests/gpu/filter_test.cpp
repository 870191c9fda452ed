// Filtering the virtual texture on a device: the page that a footprint wants against the same arithmetic in
// C++ and closed forms, and taps that read nothing of other pages.
#include <cmath>
#include <cstring>
#include <limits>

#include "shaders/geometry/pixel_ellipse_math.h"
#include "tests/gpu/texture_world.h"

namespace {

using namespace loam;
using namespace loam::test;
using gpu::Access;
using FilterTest = gpu::GpuTest;

// Runs `shader` over `queries`; slots as in shaders/test/vt_taps.glsl, of vt_place.comp without images.
template <typename Answer, typename Query>
std::vector<Answer> ask(World& w, const char* shader, const std::vector<Query>& queries, bool samples,
                        std::vector<gpu::SpecConstant> constants) {
    VirtualTexture& t = *w.texture;
    std::vector<gpu::Binding> bindings;
    for (uint32_t slot = 0; slot < 4; ++slot) bindings.push_back(gpu::storage_buffer(slot));
    for (uint32_t slot = 4; slot < (samples ? 9u : 4u); ++slot) bindings.push_back(gpu::sampled_image(slot));
    auto pipeline =
        need(gpu::Pipeline::create(gpu::test_device(), gpu::ComputeDesc{.name = "ask",
                                                                        .shader = shader,
                                                                        .bindings = bindings,
                                                                        .push_bytes = 4,
                                                                        .constants = std::move(constants)}));
    auto answers =
        need(gpu::Buffer::create(gpu::test_device(), {.name = "answers",
                                                      .size_bytes = queries.size() * sizeof(Answer),
                                                      .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
    std::vector<Answer> got(queries.size());
    gpu::Frame* frame = need(w.ring->begin());
    const auto slice = w.ring->upload(queries.size() * sizeof(Query));
    std::memcpy(slice.data, queries.data(), queries.size() * sizeof(Query));
    gpu::Commands& c = frame->commands;
    {
        auto pass = c.pass("ask", {{answers, Access::compute_storage},
                                   {t.params(), Access::compute_sampled},
                                   {t.sector_table(), Access::compute_sampled},
                                   {t.indirection(), Access::compute_sampled},
                                   {t.atlas(0), Access::compute_sampled},
                                   {t.atlas(1), Access::compute_sampled},
                                   {t.atlas(2), Access::compute_sampled},
                                   {t.atlas(3), Access::compute_sampled}});
        std::vector<gpu::Bound> bound = {{0, *slice.buffer, slice.offset, queries.size() * sizeof(Query)},
                                         {1, answers},
                                         {2, t.params()},
                                         {3, t.sector_table()}};
        if (samples) {
            bound.emplace_back(4, t.indirection().view(), t.nearest_sampler());
            for (uint32_t i = 0; i < 4; ++i) bound.emplace_back(5 + i, t.atlas(int(i)).view(), t.sampler());
        }
        c.bind(pipeline, bound);
        c.push(pipeline, uint32_t(queries.size()));
        c.dispatch(uint32_t(queries.size() + 63) / 64);
    }
    w.ring->read_back(c, answers, 0, queries.size() * sizeof(Answer), [&](std::span<const std::byte> bytes) {
        std::memcpy(got.data(), bytes.data(), bytes.size());
    });
    need(w.ring->finish(*frame));
    return got;
}

struct PlaceQuery {
    glm::ivec2 sector_delta;
    glm::vec2 offset_m, dx, dy;
};
struct PlaceAnswer {
    float log2_long, log2_short, axis, log2_texel, wanted, spacing_m;
    glm::vec2 direction, pages;
    glm::ivec2 cell;
    uint32_t id;
    int32_t tap_class;
};

// Sector corners, page borders from both sides, and places between; footprints from nothing to not a number.
std::vector<PlaceQuery> hard_queries(World& w) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity(),
                    kNan = std::numeric_limits<float>::quiet_NaN();
    std::vector<float> offsets = {0, std::nextafter(64.0f, 0.0f), std::nextafter(0.0f, 1.0f)};
    for (const float border : {1.0f, 20.0f, 32.0f, 63.0f})
        for (const float at : {std::nextafter(border, 0.0f), border, std::nextafter(border, 64.0f)})
            offsets.push_back(at);
    for (int i = 0; i < 6; ++i) offsets.push_back(float(w.fixture.real(0, 64)));
    std::vector<glm::vec2> steps;
    for (const float a : {0.0f, 1e-30f, 0.003f, -0.02f, 1.0f, 700.0f, 1e20f, kInfinity, kNan})
        for (const float b : {0.0f, 0.001f, -0.3f, 3e38f, -kInfinity, kNan}) steps.emplace_back(a, b);
    std::vector<PlaceQuery> queries;
    for (const glm::ivec2 sector : {glm::ivec2(0), glm::ivec2(0), glm::ivec2(0), glm::ivec2(-1, 0),
                                    glm::ivec2(2, 3), glm::ivec2(-40, 1000), glm::ivec2(1 << 20)})
        for (const float x : offsets)
            for (size_t i = 0; i < steps.size(); ++i)
                queries.push_back({sector,
                                   {x, offsets[i % offsets.size()]},
                                   steps[i],
                                   steps[(i * 7 + queries.size()) % steps.size()]});
    return queries;
}

TEST_F(FilterTest, MipChoiceIsTheSameArithmeticOnBothSides) {
    World w(small_desc(PageFormat::rgba8));
    w.view.filter = filter_rule(Filter::anisotropic_tiles, kMaxTaps);
    w.want_some_pages();
    w.run_frames(8);
    const std::vector<PlaceQuery> queries = hard_queries(w);
    const auto answers = ask<PlaceAnswer>(w, "test/vt_place.comp", queries, false, {});
    const int default_width = w.texture->layout().default_log2_width;
    const float sector_root = float(std::log2(64.0 / kPagePayload));
    constexpr int kWidth = 6;  // the camera's sector has 64 x 64 pages
    size_t live = 0, unknown = 0, tapped = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const PlaceQuery& q = queries[i];
        const PlaceAnswer& a = answers[i];
        const shared::PixelEllipse e = shared::pixel_ellipse(q.dx, q.dy);
        ASSERT_NEAR(a.log2_long, e.log2_long, 1e-4) << i;
        // The short axis is a difference: it is as exact as the long one.
        ASSERT_NEAR(std::exp2(a.log2_short), std::exp2(e.log2_short), 2e-6 * std::exp2(e.log2_long)) << i;
        const float wanted = shared::filter_log2_texel(a.log2_long, a.log2_short, w.view.filter.short_share,
                                                       w.view.filter.log2_taps);
        ASSERT_NEAR(a.log2_texel, wanted, 1e-4) << i;
        ASSERT_EQ(a.tap_class, shared::filter_class(a.log2_long - a.log2_texel)) << i;
        ASSERT_NEAR(a.spacing_m, shared::filter_spacing_m(a.log2_long, a.log2_texel, kMaxTaps),
                    1e-3 * std::exp2(a.log2_long))
            << i;
        ASSERT_NEAR(glm::length(a.direction), 1, 1e-3) << i;
        tapped += a.tap_class == 3;

        // The image and the place in it, in double precision.
        const bool is_live = q.sector_delta == glm::ivec2(0) && wanted < sector_root + 1;
        ASSERT_EQ(a.id != 0, is_live) << i;
        const int width = is_live ? kWidth : default_width;
        const glm::dvec2 sector =
            glm::dvec2(q.sector_delta) + (is_live ? 0.0 : 1.0);  // the camera is in (1, 1)
        const glm::dvec2 in_image = is_live ? glm::dvec2(q.offset_m) : sector * 64.0 + glm::dvec2(q.offset_m);
        const double finest = is_live ? 64.0 / (1 << kWidth) : 64.0;
        ASSERT_TRUE(std::isfinite(a.wanted) && a.wanted <= float(width)) << i;
        ASSERT_NEAR(a.wanted, std::min(double(width), wanted - std::log2(finest / kPagePayload)), 1e-4) << i;
        for (int c = 0; c < 2; ++c) {
            const double page = std::clamp(std::floor(in_image[c] / finest), 0.0, double((1 << width) - 1));
            ASSERT_GE(a.cell[c], 0);
            ASSERT_LT(a.cell[c], 1 << width);
            if (is_live) {
                ASSERT_EQ(a.cell[c], int(page)) << i << ": borders belong to the page that begins there";
            } else if (std::abs(in_image[c]) < 1e5) {
                ASSERT_NEAR(a.cell[c], page,
                            std::abs(in_image[c] / finest - std::round(in_image[c] / finest)) < 1e-3)
                    << i;
            }
        }
        live += is_live;
        const glm::vec2 sum = q.dx + q.dy;
        if (std::isnan(sum.x) || std::isnan(sum.y)) {
            ++unknown;
            ASSERT_EQ(a.id, 0u) << "a footprint that is not a number is seen in the default image";
            ASSERT_EQ(a.wanted, float(default_width));
        }
    }
    EXPECT_GT(live, 100u);
    EXPECT_GT(unknown, 100u);
    EXPECT_GT(tapped, 100u);
}

struct TapQuery {
    glm::vec2 rel_m, axis;
    float log2_long, log2_short;
};

// Pages of one colour with pages of another beside them in the atlas and nowhere near in the world: whatever
// a footprint's shape, nothing of the other colour may be seen. Returns the largest difference of the
// albedo's roots over all footprints.
double largest_leak(World& w, const char* shader, int taps, bool hardware) {
    std::vector<TapQuery> queries;
    const float finest = std::log2(1.0f / float(kPagePayload));
    for (int i = 0; i < 20'000; ++i) {
        const double angle = w.fixture.real(0, 3.15);
        // Within some texels of a border, of any of the four pages (their corner is at -0.5, -0.5 from the
        // camera).
        glm::vec2 at(w.fixture.real(-1.5, 0.5), w.fixture.real(-1.5, 0.5));
        const int side = i % 2;
        at[side] =
            float(w.fixture.uniform(-3, 1)) * 0.5f + float(w.fixture.real(-6, 6)) / float(kPagePayload);
        at = glm::clamp(at, -1.499f, 0.499f);
        // The texel wanted is the short axis, up to twice the page's. Where the taps are fewer than the ratio
        // of the axes, they would lie farther apart than the border allows: there the limit binds.
        const float log2_short = finest + float(w.fixture.real(0, 0.99)), ratio = float(w.fixture.real(0, 3));
        queries.push_back(
            {at, {float(std::cos(angle)), float(std::sin(angle))}, log2_short + ratio, log2_short});
    }
    const int probes = hardware ? 4 : std::max(1, taps / kProbeTaps);
    const auto answers = ask<glm::vec4>(
        w, shader, queries, true, {{20, 1}, {26, uint32_t(taps)}, {27, uint32_t(probes)}, {28, hardware}});
    double worst = 0;
    glm::vec3 expected = glm::sqrt(glm::vec3(answers[0]));
    for (const glm::vec4& a : answers) {
        EXPECT_TRUE(a.w >= 100 && a.w - 100 * std::floor(a.w / 100) == 0)
            << "a finest page of the live sector";
        for (int c = 0; c < 3; ++c) worst = std::max(worst, double(std::abs(std::sqrt(a[c]) - expected[c])));
    }
    return worst;
}

TEST_F(FilterTest, TapsSeeNothingOfOtherPages) {
    VirtualTextureDesc desc = small_desc(PageFormat::rgba8);
    desc.pages_per_side = 13;  // at most a third of the places is asked for
    World w(desc, true);
    w.view.filter = filter_rule(Filter::anisotropic_tiles, kMaxTaps);
    PaintCommand paint;
    paint.radius_m = 1000;
    paint.hardness = 1;
    paint.dabs = {{150, 130}};
    paint.layer = "grass";
    paint.tint = glm::dvec3(1);
    w.on_dirt(w.fixture.apply(paint));
    paint.radius_m = 6;
    paint.dabs = {{64 + 42, 64 + 32}};
    paint.tint = glm::dvec3(0, 0, 0);
    w.on_dirt(w.fixture.apply(paint));
    // In turns, so that they are neighbours in the atlas.
    std::vector<PageId> pages;
    for (int i = 0; i < 4; ++i) {
        pages.push_back({{true, 1, 1}, 6, 20 + i % 2, 31 + i / 2});
        for (int k = 0; k < 4; ++k)
            pages.push_back({{true, 1, 1}, 6, 40 + i % 2 + 2 * (k % 2), 30 + i / 2 + 2 * (k / 2)});
    }
    w.texture->request_pages(pages);
    w.run_frames(14);
    for (const int taps : {1, 2, 4, 8}) {
        const double leak = largest_leak(w, "test/vt_taps.comp", taps, false);
        EXPECT_LT(leak, 2.0 / 255) << taps << " taps";
    }
    EXPECT_GT(largest_leak(w, "test/vt_taps_wide.comp", 4, false), 5.0 / 255)
        << "taps that reach farther would see other pages";
}

}  // namespace
