// The middle of a project's map as a project of its own, on a map of any size, with any number of layers.
#include <algorithm>
#include <cmath>

#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr int kRows = 256;  // a write

uint32_t hash(uint32_t x, uint32_t y) {
    uint32_t h = x * 0x9E3779B1u ^ (y * 0x85EBCA77u + 0x27D4EB2Fu);
    h ^= h >> 15;
    h *= 0x2C1B3C6Du;
    h ^= h >> 12;
    h *= 0x297A2D39u;
    return h ^ h >> 15;
}

// Cells of a jittered grid, `cell` texels a side: which one a texel is nearest to, as a number.
uint32_t mosaic_cell(int i, int j, int cell) {
    uint32_t nearest = 0;
    float best = 1e30f;
    for (int y = j / cell - 1; y <= j / cell + 1; ++y)
        for (int x = i / cell - 1; x <= i / cell + 1; ++x) {
            const uint32_t h = hash(static_cast<uint32_t>(x), static_cast<uint32_t>(y));
            const float dx =
                (static_cast<float>(x) + static_cast<float>(h & 0xff) / 256.0f) * static_cast<float>(cell) -
                static_cast<float>(i);
            const float dy = (static_cast<float>(y) + static_cast<float>(h >> 8 & 0xff) / 256.0f) *
                                 static_cast<float>(cell) -
                             static_cast<float>(j);
            if (dx * dx + dy * dy < best) {
                best = dx * dx + dy * dy;
                nearest = h >> 16;
            }
        }
    return nearest;
}

// Rows [0, part) are read from the middle of the source's map, the rest is `fallback`.
template <typename Sample, typename Read, typename Write>
Status copy_part(int part, int columns, int rows, const Sample& fallback, const Read& read,
                 const Write& write) {
    std::vector<Sample> out(static_cast<size_t>(columns) * kRows);
    std::vector<Sample> in(static_cast<size_t>(part) * kRows);
    for (int row = 0; row < rows; row += kRows) {
        const int count = std::min(kRows, rows - row), filled = std::clamp(part - row, 0, count);
        std::fill(out.begin(), out.end(), fallback);
        if (filled > 0) read(row, filled, in.data());
        for (int k = 0; k < filled; ++k)
            std::copy_n(in.data() + static_cast<size_t>(k) * part, part,
                        out.data() + static_cast<size_t>(k) * columns);
        LOAM_TRY(write(row, count, std::span<const Sample>(out).first(static_cast<size_t>(columns) * count)));
    }
    return {};
}

}  // namespace

Result<TemporaryProject> TemporaryProject::create_part(const MapPart& request) {
    auto source = Document::open(request.of, OpenMode::read_only);
    if (!source) return source.error();
    ProjectSettings settings = (*source)->settings();
    const WorldRect whole = (*source)->bounds();
    const double spacing = settings.height_spacing_m, index_spacing = settings.index_spacing_m;
    const double part_m = std::min({request.part_m, request.side_m, whole.width(), whole.height()});
    // Multiples of 64 m, where both maps have samples.
    const auto corner = [&](double extent) {
        return std::max(0.0, std::floor((extent - part_m) / 128) * 64);
    };
    const glm::dvec2 from(corner(whole.width()), corner(whole.height()));
    const int height_part = static_cast<int>(part_m / spacing) + 1,
              index_part = static_cast<int>(part_m / index_spacing) + 1;

    auto project = make_folder();
    if (!project) return project;
    std::error_code code;
    if (std::filesystem::exists(request.of / "layers"))
        std::filesystem::copy(request.of / "layers", project->path_ / "layers",
                              std::filesystem::copy_options::recursive, code);
    if (code) return error("cannot copy the layers of {}: {}", request.of.string(), code.message());
    settings.height_samples_x = settings.height_samples_y = static_cast<int>(request.side_m / spacing) + 1;
    std::vector<int32_t> heights(static_cast<size_t>(height_part) * height_part);
    const auto lock = (*source)->read_lock();
    (*source)->read_heights_mm(0, static_cast<int>(from.x / spacing), static_cast<int>(from.y / spacing),
                               height_part, height_part, heights.data());
    const int32_t lowest_mm = *std::min_element(heights.begin(), heights.end());
    settings.default_height_mm = lowest_mm;
    if (request.layers > 0) {
        if (settings.layers.empty()) return error("{} has no layers to repeat", request.of.string());
        const std::vector<LayerEntry> kinds = settings.layers;
        settings.layers.clear();
        for (int i = 0; i < request.layers; ++i) {
            settings.layers.push_back(kinds[static_cast<size_t>(i) % kinds.size()]);
            settings.layers.back().name = fmt::format("layer {}", i);
        }
        settings.default_layer = 0;
    }
    auto document = Document::create(project->path_, settings);
    if (!document) return document.error();
    BulkWriter writer(**document);
    LOAM_TRY(copy_part<int32_t>(
        height_part, settings.height_samples_x, settings.height_samples_y, lowest_mm,
        [&](int row, int count, int32_t* out) {
            std::copy_n(heights.data() + static_cast<size_t>(row) * height_part,
                        static_cast<size_t>(count) * height_part, out);
        },
        [&](int row, int count, std::span<const int32_t> mm) {
            return writer.write_height_rows(row, count, mm);
        }));
    const glm::ivec2 size = (*document)->index_size_texels();
    const int index_width = std::min({index_part, size.x, size.y});
    const int cell = std::max(1, static_cast<int>(request.mosaic_m / index_spacing));
    LOAM_TRY(copy_part<IndexTexel>(
        index_width, size.x, size.y, IndexTexel{.layer = settings.default_layer},
        [&](int row, int count, IndexTexel* out) {
            (*source)->read_index(0, static_cast<int>(from.x / index_spacing),
                                  static_cast<int>(from.y / index_spacing) + row, index_width, count, out);
            if (request.layers > 0)
                for (int j = 0; j < count; ++j)
                    for (int i = 0; i < index_width; ++i)
                        out[static_cast<size_t>(j) * index_width + i].layer = static_cast<uint16_t>(
                            mosaic_cell(i, row + j, cell) % static_cast<uint32_t>(request.layers));
        },
        [&](int row, int count, std::span<const IndexTexel> texels) {
            return writer.write_index_rows(row, count, texels);
        }));
    LOAM_TRY(writer.finish());
    return project;
}

}  // namespace loam::bench
