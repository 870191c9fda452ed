// No seam between pages: a checkerboard on level ground, seen at grazing angles, against the supersampled
// reference. Pixels at page borders may be no farther from it than pixels of the same picture row inside
// pages, for every filter.
#include <unistd.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <span>

#include "editor/picture.h"
#include "editor/session.h"
#include "runtime/base/check.h"
#include "runtime/maps/half.h"
#include "runtime/store/layer_file.h"
#include "runtime/texture/page_id.h"
#include "tests/gpu/test_device.h"

namespace {

using namespace loam;
using SeamTest = gpu::GpuTest;

constexpr int kWidth = 224, kHeight = 126;

// Squares of an eighth of a metre and a little, so that nothing repeats with the pages.
LayerTextures checkerboard() {
    LayerTextures t;
    t.size_texels = 64;
    t.albedo_reveal.resize(1);
    t.normal_gloss_occlusion.resize(1);
    t.metalness.resize(1);
    for (int i = 0; i < 64 * 64; ++i) {
        const bool white = (i % 64 / 8 + i / 64 / 8) % 2 != 0;
        const uint8_t v = white ? 220 : 60;
        t.albedo_reveal[0].insert(t.albedo_reveal[0].end(), {v, v, v, 128});
        t.normal_gloss_occlusion[0].insert(t.normal_gloss_occlusion[0].end(), {128, 128, 40, 255});
        t.metalness[0].push_back(0);
    }
    build_layer_mips(t);
    return t;
}

// A plain of 512 m in a temporary folder.
struct Plain {
    Plain() {
        folder = std::filesystem::temp_directory_path() / ("loam-seam-" + std::to_string(::getpid()));
        ProjectSettings settings;
        settings.name = "seam";
        settings.height_samples_x = settings.height_samples_y = 513;
        settings.index_spacing_m = 1;
        settings.layers = {{"check", "layers/check.layer", 1.07}};
        auto made = Document::create(folder, settings);
        LOAM_CHECK(made.ok(), made.ok() ? "" : made.message());
        std::filesystem::create_directories(folder / "layers");
        const Status saved = save_layer(folder / "layers/check.layer", checkerboard());
        LOAM_CHECK(saved.ok(), saved.ok() ? "" : saved.message());
    }
    ~Plain() {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }
    std::filesystem::path folder;
};

template <typename T>
T need(Result<T> result) {
    LOAM_CHECK(result.ok(), result.ok() ? "" : result.message());
    return std::move(result.value());
}

struct Seam {
    double border = 0, inside = 0;  // squares of the error summed; inside weighted by the rows' border pixels
    int border_pixels = 0;
    uint32_t levels = 0;  // a bit a size of page
    void add(const Seam& other) {
        border += other.border;
        inside += other.inside;
        border_pixels += other.border_pixels;
        levels |= other.levels;
    }
};

// spoil_px: pixels at borders are taken from so far beside, as a seam would look.
// The error at borders of the pages that pixels want, against the same rows' pixels that are not near one.
Seam measure(const Picture& picture, const Picture& truth, const GroundBuffers& ground, const Camera& camera,
             const FilterRule& rule, size_t spoil_px = 0) {
    Seam seam;
    const glm::dmat4 rel_from_clip = glm::inverse(camera.clip_from_rel(kWidth, kHeight, {0, 0}));
    for (int y = 0; y < kHeight; ++y) {
        double square[2] = {0, 0};
        int count[2] = {0, 0};
        for (int x = 0; x < kWidth; ++x) {
            const size_t i = size_t(y) * kWidth + size_t(x);
            const float log2_long = float_from_half(ground.gbuffer[i * 4 + 2]),
                        log2_short = float_from_half(ground.gbuffer[i * 4 + 3]);
            if (!(log2_long > -19)) continue;  // sky
            const glm::dvec4 clip((x + 0.5) / kWidth * 2 - 1, (y + 0.5) / kHeight * 2 - 1, 0.5, 1);
            const glm::dvec4 ray = rel_from_clip * clip;
            const glm::dvec3 d = glm::dvec3(ray) / ray.w;
            if (d.z >= 0) continue;
            const glm::dvec3 at = camera.position_m + d * (-camera.position_m.z / d.z);
            if (std::max(std::abs(at.x - 256), std::abs(at.y - 256)) > 200) continue;  // near the map's edge
            const float wanted =
                shared::filter_log2_texel(log2_long, log2_short, rule.short_share, rule.log2_taps);
            const double texel_m =
                std::exp2(std::floor(wanted - std::log2(64.0 / kPagePayload))) * 64.0 / kPagePayload;
            const double page_m = texel_m * kPagePayload;
            double away_m = 1e9;
            for (int c = 0; c < 2; ++c)
                away_m = std::min(away_m, std::abs(at[c] / page_m - std::round(at[c] / page_m)) * page_m);
            // Where a tap beyond the border would be.
            const bool border = away_m < std::max(4 * texel_m, 0.5 * std::exp2(double(log2_long)));
            const size_t from = border && size_t(x) + spoil_px < kWidth ? i + spoil_px : i;
            double e = 0;
            for (size_t c = 0; c < 3; ++c)
                e += std::pow(double(picture.rgba[from * 4 + c]) - double(truth.rgba[i * 4 + c]), 2) / 3;
            square[border] += e;
            ++count[border];
            seam.levels |= 1u << uint32_t(std::clamp(std::lround(std::log2(page_m)) + 10, 0l, 31l));
        }
        if (count[0] < 20 || count[1] < 5) continue;
        seam.border += square[1];
        seam.inside += square[0] / count[0] * count[1];
        seam.border_pixels += count[1];
    }
    return seam;
}

TEST_F(SeamTest, BordersOfPagesAreNoFartherFromTheReferenceThanTheirInside) {
    const Plain plain;
    struct Way {
        const char* name;
        Filter filter;
        int taps;
    };
    const Way all_ways[] = {
        {"bilinear", Filter::bilinear, 1},         {"trilinear", Filter::trilinear, 1},
        {"tiles 2", Filter::anisotropic_tiles, 2}, {"tiles 4", Filter::anisotropic_tiles, 4},
        {"tiles 8", Filter::anisotropic_tiles, 8}, {"hardware", Filter::anisotropic_hardware, 8}};
    SessionDesc desc{.device = {.validation = true},
                     .renderer = {.quality = Quality::high, .page_format = PageFormat::rgba8},
                     .mode = OpenMode::read_only};
    auto session = need(Session::open(plain.folder, desc));
    // Software devices take tiles in the place of the sampler's own.
    need(session->renderer());
    const std::span ways = std::span(all_ways).first(
        std::size(all_ways) - (session->device()->caps().profile == gpu::Profile::software ? 1 : 0));
    // Turned so that the footprints' long axes lie across borders of both directions. In the narrow views a
    // page is some part of the distance to it, as in a large picture; in the wide one pages span several
    // mips.
    const Camera cameras[] = {Camera::look_at({200.3, 198.7, 1.6}, {208, 204, 0}, 0.25),
                              Camera::look_at({301.1, 220.9, 1.6}, {294, 228, 0}, 0.25),
                              Camera::look_at({200.3, 198.7, 1.6}, {208, 204, 0}, 0.8)};
    std::vector<Seam> seams(ways.size());
    Seam spoilt;
    std::vector<double> decibels(ways.size());
    for (const Camera& camera : cameras) {
        const Picture truth =
            need(session->render({.camera = camera, .width = kWidth, .height = kHeight, .reference = true}));
        GroundBuffers ground;  // of the first picture that rests
        for (size_t i = 0; i < ways.size(); ++i) {
            FrameSettings frame;
            frame.filter = ways[i].filter;
            frame.most_taps = ways[i].taps;
            frame.page_budget = 40;
            const Picture picture =
                need(session->render({.camera = camera, .width = kWidth, .height = kHeight, .frame = frame}));
            EXPECT_TRUE(session->last_render_settled()) << ways[i].name;
            if (ground.gbuffer.empty()) ground = need(session->ground_buffers(camera, kWidth, kHeight));
            seams[i].add(measure(picture, truth, ground, camera, filter_rule(ways[i].filter, ways[i].taps)));
            if (ways[i].taps == kMaxTaps)
                spoilt.add(
                    measure(picture, truth, ground, camera, filter_rule(ways[i].filter, ways[i].taps), 1));
            decibels[i] += psnr_db(picture, truth) / double(std::size(cameras));
            if (const char* folder = std::getenv("LOAM_TEST_PICTURES")) {
                (void)save_png(std::filesystem::path(folder) / (std::string(ways[i].name) + ".png"), picture);
                (void)save_png(std::filesystem::path(folder) / "reference.png", truth);
            }
        }
    }
    for (size_t i = 0; i < ways.size(); ++i) {
        const Seam& seam = seams[i];
        const double border = std::sqrt(seam.border / seam.border_pixels),
                     inside = std::sqrt(seam.inside / seam.border_pixels);
        std::printf("%-10s %5d border pixels of %d page sizes, error %.2f at borders, %.2f inside, %.2f dB\n",
                    ways[i].name, seam.border_pixels, std::popcount(seam.levels), border, inside,
                    decibels[i]);
        EXPECT_GT(seam.border_pixels, 1000) << ways[i].name;
        EXPECT_GE(std::popcount(seam.levels), 3) << ways[i].name << ": pages of different depth";
        EXPECT_LT(border, 1.15 * inside + 0.5) << ways[i].name;
    }
    EXPECT_GT(spoilt.border, 1.5 * spoilt.inside) << "pixels from one beside are a seam";
    EXPECT_GT(decibels[4], decibels[1] + 1) << "taps bring the picture nearer to the reference";
    EXPECT_EQ(session->device()->validation_message_count(), 0u);
}

}  // namespace
