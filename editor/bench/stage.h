// Index pages, layers and frames without a renderer: for benches of composition alone.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "editor/bench/bench.h"
#include "runtime/maps/index_map.h"
#include "runtime/texture/composer.h"
#include "runtime/texture/layer_set.h"

namespace loam::bench {

// A composer and the page textures that it writes.
struct PageMaker {
    PageAtlas atlas;
    std::unique_ptr<Composer> composer;
};

struct Stage {
    gpu::Device& device;
    Document& document;
    std::unique_ptr<gpu::FrameRing> ring;
    std::unique_ptr<LayerSet> layers;
    std::unique_ptr<IndexMap> index;
    uint64_t frame = 0;

    static Result<Stage> create(gpu::Device& device, Document& document, const IndexMapDesc& maps = {}) {
        Stage stage{device, document, {}, {}, {}};
        auto ring = gpu::FrameRing::create(device, 2);
        if (!ring) return ring.error();
        stage.ring = std::move(*ring);
        auto layers = LayerSet::create(*stage.ring, document, UINT64_MAX);
        if (!layers) return layers.error();
        stage.layers = std::move(*layers);
        auto index = IndexMap::create(&device, document, maps);
        if (!index) return index.error();
        stage.index = std::move(*index);
        return stage;
    }
    // Milliseconds of recording and from submit to fence.
    Result<glm::dvec2> timed_frame(const std::function<Status(gpu::Commands&)>& record) {
        auto begun = ring->begin();
        if (!begun) return begun.error();
        const double start_ms = now_ms();
        LOAM_TRY(record((*begun)->commands));
        const double recorded_ms = now_ms();
        LOAM_TRY(ring->finish(**begun));
        return glm::dvec2(recorded_ms - start_ms, now_ms() - recorded_ms);
    }
    Result<PageMaker> page_maker(PageFormat format, std::span<const Channel> channels, int columns, int rows,
                                 bool decals) {
        auto textures = page_textures(format, channels);
        if (!textures) return textures.error();
        auto atlas = make_page_atlas(device, *textures, columns, rows);
        if (!atlas) return atlas.error();
        auto composer = Composer::create(device, document, *index, *layers, texture_layout(document.bounds()),
                                         *textures, decals);
        if (!composer) return composer.error();
        return PageMaker{std::move(*atlas), std::move(*composer)};
    }
    // A page by itself, its inputs resident.
    Result<ComposeJob> whole_page(const PageId& page) {
        const TextureLayout layout = texture_layout(document.bounds());
        const WorldRect square = layout.square(page);
        ComposeJob job{.page = page, .rect = {0, 0, kPageTexels, kPageTexels}, .index_page = {}};
        job.index_page = index->page_for_square(square.min_x, square.min_y, layout.page_side_m(page));
        LOAM_TRY(make_resident(job.index_page));
        job.index_slot = index->map().slot_of(job.index_page);
        return job;
    }
    // Milliseconds a page: the best of some frames that compose it four times, less an empty one.
    Result<double> page_ms(PageMaker& maker, const ComposeJob& job, int repeats) {
        const std::vector<ComposeJob> jobs(4, job);
        double best = 1e9, idle = 1e9;
        for (int i = 0; i < repeats; ++i) {
            auto ms = timed_frame([&](gpu::Commands& commands) {
                return maker.composer->cmd_compose(*ring, commands, jobs, maker.atlas);
            });
            if (!ms) return ms.error();
            best = std::min(best, ms->y);
            auto none = timed_frame([](gpu::Commands&) { return Status(); });
            if (!none) return none.error();
            idle = std::min(idle, none->y);
        }
        return (best - idle) / double(jobs.size());
    }
    struct Composed {
        double ms = 0;
        std::vector<uint8_t> albedo;  // RGBA8, the page's
    };
    // By a maker of one page whose textures are not compressed.
    Result<Composed> composed(PageMaker& maker, const ComposeJob& job, int repeats) {
        auto ms = page_ms(maker, job, repeats);
        if (!ms) return ms.error();
        Composed out{*ms, {}};
        auto read = timed_frame([&](gpu::Commands& commands) -> Status {
            ring->read_back(commands, maker.atlas[0], [&](std::span<const std::byte> bytes) {
                const auto* from = reinterpret_cast<const uint8_t*>(bytes.data());
                out.albedo.assign(from, from + bytes.size());
            });
            return {};
        });
        if (!read) return read.error();
        return out;
    }
    Status make_resident(const MapPage& page) {
        for (int i = 0; i < 50; ++i) {
            auto ms = timed_frame([&](gpu::Commands& commands) {
                index->request(page, 1e6f);
                return index->update(*ring, commands, ++frame, 8);
            });
            if (!ms) return ms.error();
            if (index->resident_page(page) && !index->has_work()) return {};
        }
        return error("an index page did not become resident");
    }
};

// Of albedo as pages keep it, of 255.
[[nodiscard]] inline double albedo_rms(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i)
        if (i % 4 != 3) sum += (double(a[i]) - b[i]) * (double(a[i]) - b[i]);
    return std::sqrt(sum / (double(a.size()) * 0.75));
}

// Tables of `bench materials`.
Status add_tints(const BenchRequest& request, gpu::Device& device, BenchTable& table);
Status add_parallax(const BenchRequest& request, BenchTable& table);
Status add_masks(const BenchRequest& request, gpu::Device& device, BenchTable& table);
Status add_vista_steps(const BenchRequest& request, gpu::Device& device, BenchTable& table);

}  // namespace loam::bench
