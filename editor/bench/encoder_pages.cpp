#include "editor/bench/encoder_pages.h"

#include <algorithm>
#include <cstring>
#include <random>

#include "editor/bench/stage.h"
#include "editor/image_file.h"
#include "runtime/texture/composer.h"

namespace loam::bench {

namespace {

constexpr int kLayerPages = 5;
constexpr int kMetreDepth = 6;  // below a sector of 64 m

std::vector<int> chosen_layers(const ProjectSettings& settings) {
    std::vector<int> chosen;
    const auto take = [&](int layer) {
        if (std::ssize(chosen) < kLayerPages &&
            std::find(chosen.begin(), chosen.end(), layer) == chosen.end())
            chosen.push_back(layer);
    };
    const int count = static_cast<int>(settings.layers.size());
    for (const char* name : {"snow", "grass", "forest_floor", "scree", "cliff", "rock"})
        for (int i = 0; i < count; ++i)
            if (settings.layers[static_cast<size_t>(i)].name == name) take(i);
    for (int i = 0; i < count; ++i) take(i);
    return chosen;
}

// A place well within ground of the layer.
std::optional<glm::dvec2> place_of(const Document& document, int layer) {
    const glm::ivec2 size = document.index_size_texels();
    const double spacing_m = document.settings().index_spacing_m;
    constexpr int kWindow = 5;
    std::vector<IndexTexel> row(static_cast<size_t>(size.x) * kWindow);
    const auto lock = document.read_lock();
    for (int y = 0; y + kWindow <= size.y; y += kWindow) {
        document.read_index(0, 0, y, size.x, kWindow, row.data());
        for (int x = 0; x + kWindow <= size.x; x += kWindow) {
            bool all = true;
            for (int j = 0; j < kWindow && all; ++j)
                for (int i = 0; i < kWindow; ++i)
                    all =
                        all &&
                        row[static_cast<size_t>(j) * static_cast<size_t>(size.x) + static_cast<size_t>(x + i)]
                                .layer == layer;
            if (all) return glm::dvec2(x + kWindow / 2, y + kWindow / 2) * spacing_m;
        }
    }
    return std::nullopt;
}

PageId metre_page(glm::dvec2 at) {
    const glm::dvec2 sector = glm::floor(at / 64.0), inside = glm::floor(at - sector * 64.0);
    return {{true, static_cast<int>(sector.x), static_cast<int>(sector.y)},
            kMetreDepth,
            static_cast<int>(inside.x),
            static_cast<int>(inside.y)};
}

Result<ComposeJob> job_of(Stage& stage, const TextureLayout& layout, const PageId& page, int column) {
    ComposeJob job;
    job.page = page;
    job.rect = {0, 0, kPageTexels, kPageTexels};
    job.target = {column, 0};
    const WorldRect square = layout.square(page);
    job.index_page = stage.index->page_for_square(square.min_x, square.min_y, layout.page_side_m(page));
    LOAM_TRY(stage.make_resident(job.index_page));
    return job;
}

Result<std::array<Texels, 3>> composed(Stage& stage, std::vector<ComposeJob>& jobs) {
    for (ComposeJob& job : jobs) {
        LOAM_TRY(stage.make_resident(job.index_page));
        job.index_slot = stage.index->map().slot_of(job.index_page);
    }
    auto maker = stage.page_maker(PageFormat::rgba8, {}, static_cast<int>(jobs.size()), 1, true);
    if (!maker) return maker.error();
    std::array<Texels, 3> bytes;
    auto ms = stage.timed_frame([&](gpu::Commands& commands) -> Status {
        LOAM_TRY(maker->composer->cmd_compose(*stage.ring, commands, jobs, maker->atlas));
        for (size_t which = 0; which < 3; ++which)
            stage.ring->read_back(commands, maker->atlas[which],
                                  [&bytes, which](std::span<const std::byte> got) {
                                      bytes[which].resize(got.size());
                                      std::memcpy(bytes[which].data(), got.data(), got.size());
                                  });
        return {};
    });
    if (!ms) return ms.error();
    return bytes;
}

// A square of kPageTexels out of a wider picture.
Texels cut(const std::vector<uint8_t>& rgba, int width, int x0, int y0) {
    Texels page(size_t{kPageTexels} * kPageTexels * 4);
    for (int y = 0; y < kPageTexels; ++y)
        std::memcpy(
            &page[static_cast<size_t>(y) * kPageTexels * 4],
            &rgba[(static_cast<size_t>(y0 + y) * static_cast<size_t>(width) + static_cast<size_t>(x0)) * 4],
            size_t{kPageTexels} * 4);
    return page;
}

EncoderPage noise_page() {
    std::mt19937 random(1);
    EncoderPage page{"noise", {}};
    for (Texels& texels : page.textures) {
        texels.resize(size_t{kPageTexels} * kPageTexels * 4);
        for (uint8_t& byte : texels) byte = static_cast<uint8_t>(random() % 256);
        for (size_t i = 3; i < texels.size(); i += 4) texels[i] = 255;
    }
    return page;
}

}  // namespace

Result<std::vector<EncoderPage>> composed_pages(gpu::Device& device, const std::filesystem::path& project) {
    auto copy = TemporaryProject::create_copy(project);
    if (!copy) return copy.error();
    auto document = Document::open(copy->path(), OpenMode::read_write);
    if (!document) return document.error();
    const glm::dvec2 middle = glm::dvec2((*document)->bounds().width(), (*document)->bounds().height()) / 2.0;
    const glm::dvec2 crater = middle + glm::dvec2(32.5, 32.5);
    auto dirt =
        (*document)->apply({CraterCommand{{.x_m = crater.x, .y_m = crater.y, .radius_m = 2, .seed = 7}}});
    if (!dirt) return dirt.error();
    auto stage = Stage::create(device, **document);
    if (!stage) return stage.error();
    const TextureLayout layout = texture_layout((*document)->bounds());

    std::vector<std::string> names;
    std::vector<ComposeJob> jobs;
    const auto add = [&](const std::string& name, const PageId& page) -> Status {
        auto job = job_of(*stage, layout, page, static_cast<int>(jobs.size()));
        if (!job) return job.error();
        jobs.push_back(*job);
        names.push_back(name);
        return {};
    };
    for (const int layer : chosen_layers((*document)->settings()))
        if (const auto place = place_of(**document, layer))
            LOAM_TRY(
                add((*document)->settings().layers[static_cast<size_t>(layer)].name, metre_page(*place)));
    const glm::ivec2 sector(middle / 64.0 - 1.0);
    LOAM_TRY(add("64 m", {{}, layout.default_log2_width, std::max(sector.x, 0), std::max(sector.y, 0)}));
    LOAM_TRY(add("crater", metre_page(crater + glm::dvec2(1.5, 0))));
    auto bytes = composed(*stage, jobs);
    if (!bytes) return bytes.error();
    std::vector<EncoderPage> pages;
    for (size_t i = 0; i < jobs.size(); ++i) {
        pages.push_back({names[i], {}});
        for (size_t which = 0; which < 3; ++which)
            pages.back().textures[which] = cut((*bytes)[which], kPageTexels * static_cast<int>(jobs.size()),
                                               static_cast<int>(i) * kPageTexels, 0);
    }
    pages.push_back(noise_page());
    return pages;
}

Result<std::vector<EncoderPage>> photograph_pages(const std::filesystem::path& folder) {
    std::error_code code;
    std::vector<std::pair<std::string, std::filesystem::path>> files;
    for (std::filesystem::recursive_directory_iterator at(folder, code), end; !code && at != end;
         at.increment(code)) {
        const std::string extension = at->path().extension().string();
        if (extension != ".jpg" && extension != ".png" && extension != ".tif") continue;
        if (at.depth() == 0) files.emplace_back(at->path().stem().string(), at->path());
        if (at.depth() == 1 && at->path().stem() == "albedo")
            files.emplace_back(at->path().parent_path().filename().string(), at->path());
    }
    if (code) return error("{} cannot be read: {}", folder.string(), code.message());
    if (files.empty()) return error("{} holds no picture and no folder with an albedo.jpg", folder.string());
    std::sort(files.begin(), files.end());
    std::vector<EncoderPage> pages;
    for (const auto& [name, file] : files) {
        auto image = read_rgba8(file, 16384);
        if (!image) return image.error();
        if (image->width < kPageTexels || image->height < kPageTexels)
            return error("{} has {} x {} pixels, a page takes {}", file.string(), image->width, image->height,
                         kPageTexels);
        pages.push_back({name,
                         {cut(image->rgba, image->width, (image->width - kPageTexels) / 2,
                              (image->height - kPageTexels) / 2),
                          {},
                          {}}});
    }
    return pages;
}

}  // namespace loam::bench
