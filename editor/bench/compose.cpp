// What composition costs without a frame around it: whole pages, and the parts of an edit (commit, plan,
// index pages, recording, GPU). Wall clock, submit to fence, best of several, minus an empty frame.
#include <algorithm>
#include <functional>
#include <numbers>

#include "editor/bench/bench.h"
#include "editor/bench/stage.h"
#include "runtime/texture/composer.h"
#include "runtime/texture/virtual_texture.h"

namespace loam::bench {

namespace {

constexpr int kRepeats = 15;
constexpr double kPixelsPerRadian = 500;  // about 960x540

// Mean number of layers that meet at a texel of the page.
double layers_met(const IndexTexel* texels) {
    double sum = 0;
    for (int y = kIndexBorder; y < kIndexBorder + kIndexPayload; ++y)
        for (int x = kIndexBorder; x < kIndexBorder + kIndexPayload; ++x) {
            const auto at = [&](int i, int j) { return texels[(y + j) * kIndexTexels + x + i].layer; };
            uint16_t l[4] = {at(0, 0), at(1, 0), at(0, 1), at(1, 1)};
            std::sort(l, l + 4);
            sum += double(std::unique(l, l + 4) - l);
        }
    return sum / (kIndexPayload * kIndexPayload);
}

Status bench_pages(Stage& stage, PageFormat format, BenchTable& table) {
    const TextureLayout layout = texture_layout(stage.document.bounds());
    auto maker = stage.page_maker(format, stage.document.settings().channels, 2, 2, true);
    if (!maker) return maker.error();
    // The plainest and the busiest page of two texels an index texel.
    ComposeJob plainest, busiest;
    double least = 1e9, most = -1;
    const int width = 1 << layout.default_log2_width;
    const int wanted = std::min(8, width);
    for (int i = 0; i < wanted * wanted; ++i) {
        ComposeJob job;
        job.page = {
            {}, layout.default_log2_width, (i % wanted) * width / wanted, (i / wanted) * width / wanted};
        job.rect = {0, 0, kPageTexels, kPageTexels};
        const WorldRect square = layout.square(job.page);
        job.index_page =
            stage.index->page_for_square(square.min_x, square.min_y, layout.page_side_m(job.page));
        if (!stage.index->map().exists(job.index_page)) continue;
        LOAM_TRY(stage.make_resident(job.index_page));
        job.index_slot = stage.index->map().slot_of(job.index_page);
        const double met = layers_met(stage.index->resident_page(job.index_page));
        if (met < least) least = met, plainest = job;
        if (met > most) most = met, busiest = job;
    }
    const auto add = [&](const char* name, double met, const std::vector<ComposeJob>& jobs) -> Status {
        for (const ComposeJob& job : jobs) LOAM_TRY(stage.make_resident(job.index_page));
        double best = 1e9, idle = 1e9, recording = 1e9;
        for (int i = 0; i < kRepeats; ++i) {
            auto ms = stage.timed_frame([&](gpu::Commands& commands) {
                return maker->composer->cmd_compose(*stage.ring, commands, jobs, maker->atlas);
            });
            if (!ms) return ms.error();
            best = std::min(best, ms->y);
            recording = std::min(recording, ms->x);
            auto none = stage.timed_frame([](gpu::Commands&) { return Status(); });
            if (!none) return none.error();
            idle = std::min(idle, none->y);
        }
        table.rows.push_back({{"rectangles", name},
                              {"layers met", rounded(met, 2)},
                              {"record ms", rounded(recording, 3)},
                              {"submit to fence ms", rounded(best - idle, 2)},
                              {"a rectangle ms", rounded((best - idle) / double(jobs.size()), 3)}});
        return {};
    };
    // Dirt of a footprint: the same small rectangle on twelve levels.
    std::vector<ComposeJob> small(12, busiest), large(12, busiest);
    for (size_t i = 0; i < small.size(); ++i)
        small[i].rect = {96, 96, i < 3 ? 192 : 112, i < 3 ? 192 : 112}, large[i].rect = {96, 96, 160, 160};
    LOAM_TRY(add("1 whole page, plain", least, {plainest}));
    LOAM_TRY(add("1 whole page, busy", most, {busiest}));
    LOAM_TRY(add("4 whole pages, busy", most, {busiest, busiest, busiest, busiest}));
    LOAM_TRY(add("12 squares of 64 texels", most, large));
    return add("3 squares of 96 and 9 of 16 texels", most, small);
}

Status bench_edits(Stage& stage, PageFormat format, BenchTable& table) {
    auto made = VirtualTexture::create(stage.device, stage.document, *stage.index, *stage.layers,
                                       {.pages_per_side = 16,
                                        .indirection_size = 512,
                                        .format = format,
                                        .max_live_sectors = 40,
                                        .budget_pages = 8});
    if (!made) return made.error();
    VirtualTexture& texture = **made;
    const glm::dvec2 c = stage.document.bounds().center();
    const glm::dvec2 place(std::floor(c.x / 64) * 64 + 21.5, std::floor(c.y / 64) * 64 + 30.5);
    TextureView view{.camera_m = {place.x, place.y - 4, 3}, .pixels_per_radian = kPixelsPerRadian};
    // Pages as a camera near the place would ask for: all of a few levels around it.
    std::vector<PageId> pages;
    const ImageId sector{true, int(place.x / 64), int(place.y / 64)};
    for (int depth = 0; depth <= 6; ++depth)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const double side = std::ldexp(64.0, -depth);
                const int px = int((place.x - sector.sector_x * 64.0) / side) + x,
                          py = int((place.y - sector.sector_y * 64.0) / side) + y;
                if (px >= 0 && py >= 0 && px < 1 << depth && py < 1 << depth)
                    pages.push_back({sector, depth, px, py});
            }
    pages.push_back({{}, texture.layout().default_log2_width, int(place.x / 64), int(place.y / 64)});
    texture.request_pages(pages);
    const auto frame = [&](double* plan_ms, double* index_ms) {
        return stage.timed_frame([&](gpu::Commands& commands) -> Status {
            view.frame = ++stage.frame;
            const double a = now_ms();
            texture.request_inputs(view);
            const double b = now_ms();
            LOAM_TRY(stage.index->update(*stage.ring, commands, stage.frame, 8));
            if (plan_ms) *plan_ms += b - a;
            if (index_ms) *index_ms = now_ms() - b;
            return texture.update(*stage.ring, commands, view);
        });
    };
    for (int i = 0; i < 60; ++i)
        if (auto ms = frame(nullptr, nullptr); !ms) return ms.error();

    PaintCommand paint;
    paint.dabs = {place};
    paint.radius_m = 10;
    paint.tint = {{0.9, 0.5, 0.3}};
    SculptCommand raise;
    raise.dabs = {place};
    raise.radius_m = 10;
    FootprintsCommand print;
    print.prints = {{.x_m = place.x, .y_m = place.y, .heading_rad = std::numbers::pi / 5}};
    const CraterCommand crater{{.x_m = place.x, .y_m = place.y, .radius_m = 10, .seed = 7}};
    struct Row {
        const char* name;
        Command command;
    };
    for (const Row& row : {Row{"footprint", {print}}, Row{"paint dab, 10 m", {paint}},
                           Row{"raise dab, 10 m", {raise}}, Row{"crater, 10 m", {crater}}}) {
        double apply = 1e9, plan = 1e9, index = 1e9, record = 1e9, gpu = 1e9, idle = 1e9;
        int frames = 0;
        VirtualTexture::Statistics before, after, first;
        for (int i = 0; i < kRepeats; ++i) {
            before = texture.statistics();
            const double a = now_ms();
            auto dirt = stage.document.apply(row.command);
            if (!dirt) return dirt.error();
            const double b = now_ms();
            stage.index->on_dirt(dirt->index);
            texture.on_index_dirt(dirt->index);
            texture.on_dirt(dirt->texture, dirt->texture_size_m);
            double plan_ms = now_ms() - b, index_ms = 0;
            auto ms = frame(&plan_ms, &index_ms);
            if (!ms) return ms.error();
            first = texture.statistics();
            apply = std::min(apply, b - a);
            plan = std::min(plan, plan_ms);
            index = std::min(index, index_ms);
            record = std::min(record, ms->x - index_ms);
            gpu = std::min(gpu, ms->y);
            for (frames = 1; texture.statistics().dirty_pages > 0 && frames < 100; ++frames)
                if (auto more = frame(nullptr, nullptr); !more) return more.error();
            after = texture.statistics();
            // Back to the ground before: edits must not pile up.
            auto undone = stage.document.apply({UndoCommand{}});
            if (!undone) return undone.error();
            stage.index->on_dirt(undone->index);
            texture.on_index_dirt(undone->index);
            texture.on_dirt(undone->texture, undone->texture_size_m);
            for (int k = 0; k == 0 || (texture.statistics().dirty_pages > 0 && k < 100); ++k)
                if (auto more = frame(nullptr, nullptr); !more) return more.error();
            for (int k = 0; k < 2; ++k) {
                auto none = frame(nullptr, nullptr);
                if (!none) return none.error();
                idle = std::min(idle, none->y);
            }
        }
        table.rows.push_back({{"edit", row.name},
                              {"commit ms", rounded(apply, 2)},
                              {"plan ms", rounded(plan, 3)},
                              {"index ms", rounded(index, 3)},
                              {"record ms", rounded(record, 3)},
                              {"GPU ms, first frame", rounded(gpu - idle, 2)},
                              {"rectangles, first frame", first.rects_composed - before.rects_composed},
                              {"texels, first frame", first.texels_composed - before.texels_composed},
                              {"frames", frames},
                              {"rectangles", after.rects_composed - before.rects_composed},
                              {"texels", after.texels_composed - before.texels_composed}});
    }
    return {};
}

}  // namespace

Result<BenchReport> bench_compose(const BenchRequest& request) {
    auto copy = TemporaryProject::create_copy(request.project);
    if (!copy) return copy.error();
    auto document = Document::open(copy->path(), OpenMode::read_write);
    if (!document) return document.error();
    auto device = gpu::Device::create(request.session.device);
    if (!device) return device.error();
    auto stage = Stage::create(**device, **document);
    if (!stage) return stage.error();
    BenchReport report;
    const std::vector<Channel>& channels = (*document)->settings().channels;
    for (const PageFormat format :
         {PageFormat::rgba8, format_with_room(PageFormat::bc1x3, channels.size()), PageFormat::bc3x2}) {
        if (is_compressed(format) && !(*device)->caps().bc) continue;
        if (!page_textures(format, channels)) continue;
        const char* name = page_format_name(format);
        report.push_back({fmt::format("{} pages: rectangles composed, best of {}", name, kRepeats), {}});
        LOAM_TRY(bench_pages(*stage, format, report.back()));
        report.push_back({fmt::format("{} pages: edits, best of {}", name, kRepeats), {}});
        LOAM_TRY(bench_edits(*stage, format, report.back()));
    }
    return report;
}

}  // namespace loam::bench
