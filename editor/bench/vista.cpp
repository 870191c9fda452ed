// Vista UVs (shaders/texture/vista.h): the step in the picture where a page gives way to the one of twice its texel,
// which weighs the magnified lookup otherwise. The page's second mip is what is seen up to there.
#include <array>
#include <cmath>
#include <cstring>

#include "editor/bench/bench.h"
#include "editor/bench/stage.h"
#include "runtime/texture/composer.h"
#include "shaders/texture/vista.h"

namespace loam::bench {

namespace {

constexpr double kMap_m = 256, kMosaic_m = 16, kVistaFrom_m = 12;

using Texels = std::vector<std::array<uint8_t, 4>>;

Texels texels_of(std::span<const std::byte> bytes) {
    Texels texels(bytes.size() / 4);
    std::memcpy(texels.data(), bytes.data(), bytes.size());
    return texels;
}

struct Composed {
    Texels mip0, mip1;  // of albedo, as stored
};

Result<Composed> compose(Stage& stage, PageMaker& maker, const ComposeJob& job) {
    Composed out;
    auto ms = stage.timed_frame([&](gpu::Commands& commands) -> Status {
        LOAM_TRY(maker.composer->cmd_compose(*stage.ring, commands, {&job, 1}, maker.atlas));
        stage.ring->read_back(commands, maker.atlas[0], [&](auto bytes) { out.mip0 = texels_of(bytes); });
        stage.ring->read_back(
            commands, maker.atlas[0], [&](auto bytes) { out.mip1 = texels_of(bytes); }, 1);
        return {};
    });
    if (!ms) return ms.error();
    return out;
}

// RMS over three channels, and the mean's own difference, in codes of 255.
struct Step {
    double squares = 0, sum = 0;
    int64_t count = 0;
    void add(double difference) {
        squares += difference * difference;
        sum += difference;
        ++count;
    }
    [[nodiscard]] Json rms() const { return rounded(std::sqrt(squares / double(count)), 2); }
};

}  // namespace

Status add_vista_steps(const BenchRequest& request, gpu::Device& device, BenchTable& table) {
    table.title =
        fmt::format("Vista UVs, 8 times magnified from {} m: the step from a page's second mip to the page of "
                    "twice its texel, albedo, rms/255",
                    kVistaFrom_m);
    auto project = TemporaryProject::create_part(
        {.of = request.project, .part_m = kMap_m, .side_m = kMap_m, .layers = 4, .mosaic_m = kMosaic_m});
    if (!project) return project.error();
    auto document = Document::open(project->path(), OpenMode::read_write);
    if (!document) return document.error();
    ProjectSettings settings = (*document)->settings();
    settings.ground.vista_scale = 8;
    settings.ground.vista_distance_m = kVistaFrom_m;
    LOAM_TRY((*document)->change_settings(settings));
    auto stage = Stage::create(device, **document);
    if (!stage) return stage.error();
    auto maker = stage->page_maker(PageFormat::rgba8, settings.channels, 1, 1, false);
    if (!maker) return maker.error();
    const TextureLayout layout = texture_layout((*document)->bounds());
    const int pages_a_row = kPageTexels;  // the atlas is one page
    for (int depth = 6; depth >= 1; --depth) {
        const PageId page{{true, 1, 1}, depth, (1 << depth) / 2 + 1, (1 << depth) / 2};
        const PageId coarser = *layout.coarser(page);
        auto job = stage->whole_page(page);
        if (!job) return job.error();
        auto own = compose(*stage, *maker, *job);
        if (!own) return own.error();
        auto next_job = stage->whole_page(coarser);
        if (!next_job) return next_job.error();
        auto next = compose(*stage, *maker, *next_job);
        if (!next) return next.error();
        Step mean_of_first, as_composed;
        constexpr int kHalf = kPagePayload / 2;
        for (int y = 0; y < kHalf; ++y)
            for (int x = 0; x < kHalf; ++x) {
                const int border = kPageBorder;
                const auto& truth = next->mip0[size_t(border + (page.y & 1) * kHalf + y) * size_t(pages_a_row) +
                                               size_t(border + (page.x & 1) * kHalf + x)];
                const auto& second = own->mip1[size_t(border / 2 + y) * size_t(pages_a_row / 2) +
                                               size_t(border / 2 + x)];
                for (size_t c = 0; c < 3; ++c) {
                    double square = 0;
                    for (int k = 0; k < 4; ++k) {
                        const double v = own->mip0[size_t(border + 2 * y + k / 2) * size_t(pages_a_row) +
                                                   size_t(border + 2 * x + k % 2)][c];
                        square += 0.25 * v * v;
                    }
                    mean_of_first.add(std::sqrt(square) - double(truth[c]));
                    as_composed.add(double(second[c]) - double(truth[c]));
                }
            }
        const double texel_m = layout.texel_m(page);
        const auto weight = [&](double of_m) {
            return rounded(shared::vista_weight(float(std::log2(of_m)),
                                                float(far_log2_begin(settings.ground.vista_distance_m))),
                           2);
        };
        table.rows.push_back({{"texel mm", rounded(texel_m * 1000, 1)},
                              {"weight", weight(texel_m)},
                              {"weight of the next", weight(2 * texel_m)},
                              {"mean of the first mip", mean_of_first.rms()},
                              {"as it is", as_composed.rms()}});
    }
    return {};
}

}  // namespace loam::bench
