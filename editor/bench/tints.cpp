// Tints of the index map as BC1 beside exact ones: memory, time and picture. Source: Call of Duty talk,
// "Virtual Index & Color Map".
#include <cstdlib>

#include "editor/bench/stage.h"

namespace loam::bench {

namespace {

// Milliseconds that the CPU takes for the index page, all of it dirty: composing, packing, upload.
Result<double> index_page_ms(Stage& stage, const MapPage& page, int repeats) {
    const WorldRect rect = stage.index->map().page_rect(page);
    double best = 1e9;
    for (int i = 0; i < repeats; ++i) {
        auto ms = stage.timed_frame([&](gpu::Commands& commands) {
            stage.index->on_dirt({&rect, 1});
            stage.index->request(page, 1e6f);
            return stage.index->update(*stage.ring, commands, ++stage.frame, 1);
        });
        if (!ms) return ms.error();
        best = std::min(best, ms->x);
    }
    return best;
}

int worst_of(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    int worst = 0;
    for (size_t i = 0; i < a.size(); ++i)
        if (i % 4 != 3) worst = std::max(worst, std::abs(int(a[i]) - int(b[i])));
    return worst;
}

}  // namespace

Status add_tints(const BenchRequest& request, gpu::Device& device, BenchTable& table) {
    auto document = Document::open(request.project, OpenMode::read_only);
    if (!document) return document.error();
    const glm::dvec2 centre = (*document)->bounds().center();
    const TextureLayout layout = texture_layout((*document)->bounds());
    const int repeats = request.quick ? 3 : 15;
    for (const double side_m : {8.0, 64.0}) {
        // Of the image of the sector in the map's middle, 64 m a side.
        const ImageId image{true, int(centre.x / 64), int(centre.y / 64)};
        const PageId page{image, int(std::log2(64 / side_m)), 0, 0};
        std::vector<uint8_t> exact;
        for (const bool compressed : {false, true}) {
            auto stage = Stage::create(device, **document, {.compressed_tints = compressed});
            if (!stage) return stage.error();
            if (stage->index->compressed_tints() != compressed) continue;  // a device without BC1
            auto maker = stage->page_maker(PageFormat::rgba8, {}, 1, 1, false);
            if (!maker) return maker.error();
            auto job = stage->whole_page(page);
            if (!job) return job.error();
            auto index_ms = index_page_ms(*stage, job->index_page, repeats);
            if (!index_ms) return index_ms.error();
            auto made = stage->composed(*maker, *job, repeats);
            if (!made) return made.error();
            if (!compressed) exact = made->albedo;
            table.rows.push_back({{"tints", compressed ? "BC1" : "RGBA8"},
                                  {"page side m", rounded(layout.page_side_m(page), 0)},
                                  {"cache MB", rounded(double(stage->index->gpu_bytes()) / 1e6, 1)},
                                  {"index page ms", rounded(*index_ms, 2)},
                                  {"texture page ms", rounded(made->ms, 2)},
                                  {"rms of 255", rounded(albedo_rms(exact, made->albedo), 2)},
                                  {"worst of 255", worst_of(exact, made->albedo)}});
        }
    }
    return {};
}

}  // namespace loam::bench
