#include "editor/weights_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "editor/row_mix.h"
#include "runtime/base/srgb.h"
#include "runtime/store/layer_file.h"
#include "shaders/texture/ompv.h"

namespace loam {

namespace {

namespace fs = std::filesystem;

struct Mask {
    std::unique_ptr<ImageRows> picture;
    std::vector<size_t> layers;  // of its channels: places in Weights::layers
    std::unique_ptr<RowMixer> mixer;
};

// What an index shows on the average: of one layer, or of two.
struct Candidate {
    uint16_t index = 0;
    size_t first = 0, second = 0;  // places in Weights::layers
    double share = 0;              // of the second
    glm::dvec3 color{0};           // linear
};

struct Weights {
    std::vector<uint16_t> layers;  // that have a mask
    std::vector<glm::dvec3> colors;
    std::vector<Mask> masks;
    std::vector<Candidate> candidates;
};

std::vector<std::string> split(const std::string& text, char at) {
    std::vector<std::string> parts(1);
    for (const char c : text)
        if (c == at)
            parts.emplace_back();
        else
            parts.back() += c;
    return parts;
}

// Of a layer: its mean colour, and how much of it a threshold lets through.
struct LayerFacts {
    glm::dvec3 color{0};
    std::vector<uint8_t> reveal;
    [[nodiscard]] double share_at(double threshold) const {
        double sum = 0;
        for (const uint8_t r : reveal) sum += double(shared::ompv_cover(float(threshold), float(r) / 255));
        return sum / double(std::max<size_t>(1, reveal.size()));
    }
};

Result<LayerFacts> facts_of(const fs::path& file) {
    const auto textures = load_layer(file);
    if (!textures.ok()) return textures.error();
    LayerFacts facts;
    const auto& coarsest = textures->albedo_reveal.back();
    for (int c = 0; c < 3; ++c) facts.color[c] = linear_of_srgb8(coarsest[size_t(c)]);
    const auto& fine =
        textures->albedo_reveal[size_t(std::max(0, textures->mip_count - 8))];  // at most 128 x 128
    for (size_t i = 3; i < fine.size(); i += 4) facts.reveal.push_back(fine[i]);
    return facts;
}

// Of the map's vertices: each is the mean of the square around it.
std::vector<PixelMix> vertex_mixes(int vertices, double spacing_m, double extent_m, int pixels,
                                   bool from_north) {
    std::vector<PixelMix> mixes;
    for (int i = 0; i < vertices; ++i) {
        const int vertex = from_north ? vertices - 1 - i : i;
        const double at_m = std::min(vertex * spacing_m, extent_m);
        const double at = (from_north ? extent_m - at_m : at_m) / extent_m * pixels;
        const double half = 0.5 * spacing_m / extent_m * pixels;
        mixes.push_back(mix_between(at - half, at + half, pixels));
    }
    return mixes;
}

Status open_masks(const Document& document, const fs::path& folder, Weights& out) {
    std::error_code failure;
    if (!fs::is_directory(folder, failure)) return error("there is no folder {}", folder.string());
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(folder, failure))
        if (entry.is_regular_file() && entry.path().filename().string()[0] != '.')
            files.push_back(entry.path());
    if (failure) return error("{} cannot be read: {}", folder.string(), failure.message());
    std::sort(files.begin(), files.end());
    if (files.empty())
        return error("{} holds no pictures; one a layer is expected: grass.png", folder.string());
    const ProjectSettings& settings = document.settings();
    const glm::ivec2 size = document.index_size_texels();
    const WorldRect bounds = document.bounds();
    for (const fs::path& file : files) {
        Mask mask;
        const std::vector<std::string> names = split(file.stem().string(), '+');
        for (const std::string& name : names) {
            const int layer = document.layer_index(name);
            if (layer < 0 || settings.layers[size_t(layer)].blend)
                return error(
                    "{}: the project has no layer \"{}\"; pictures are named after layers, grass.png or "
                    "grass+rock.png",
                    file.string(), name);
            if (std::find(out.layers.begin(), out.layers.end(), layer) != out.layers.end())
                return error("{}: there are weights of \"{}\" already", file.string(), name);
            mask.layers.push_back(out.layers.size());
            out.layers.push_back(uint16_t(layer));
        }
        auto picture = ImageRows::open(file);
        if (!picture.ok()) return picture.error();
        const int channels = (*picture)->channel_count();
        if (names.size() > 4 || int(names.size()) > channels)
            return error("{} names {} layers and has {} channels (at most 4 count)", file.string(),
                         names.size(), channels);
        mask.picture = std::move(*picture);
        const float white = white_of(mask.picture->kind());
        mask.mixer = std::make_unique<RowMixer>(
            *mask.picture,
            vertex_mixes(size.x, settings.index_spacing_m, bounds.max_x, mask.picture->width(), false),
            vertex_mixes(size.y, settings.index_spacing_m, bounds.max_y, mask.picture->height(), true),
            [white, count = int(names.size())](const float* pixel) {
                glm::vec4 weights(0);
                for (int c = 0; c < count; ++c)
                    weights[c] = std::isfinite(pixel[c]) ? std::max(0.0f, pixel[c] / white) : 0.0f;
                return weights;
            });
        out.masks.push_back(std::move(mask));
    }
    return {};
}

Status find_candidates(const Document& document, bool transitions, Weights& out) {
    const ProjectSettings& settings = document.settings();
    std::vector<LayerFacts> facts;
    for (size_t i = 0; i < out.layers.size(); ++i) {
        auto read = facts_of(document.folder() / settings.layers[out.layers[i]].file);
        if (!read.ok()) return read.error();
        facts.push_back(std::move(*read));
        out.colors.push_back(facts.back().color);
        out.candidates.push_back({out.layers[i], i, i, 0, facts.back().color});
    }
    const auto place_of = [&](const std::string& name) -> std::optional<size_t> {
        const auto found = std::find(out.layers.begin(), out.layers.end(), document.layer_index(name));
        if (found == out.layers.end()) return {};
        return size_t(found - out.layers.begin());
    };
    for (size_t i = 0; transitions && i < settings.layers.size(); ++i) {
        const auto& blend = settings.layers[i].blend;
        if (!blend || blend->removed) continue;
        const auto from = place_of(blend->from), to = place_of(blend->to);
        if (!from || !to) continue;
        const double share = facts[*to].share_at(blend->threshold);
        out.candidates.push_back(
            {uint16_t(i), *from, *to, share, (1 - share) * out.colors[*from] + share * out.colors[*to]});
    }
    std::sort(out.candidates.begin(), out.candidates.end(),
              [](const Candidate& a, const Candidate& b) { return a.index < b.index; });
    return {};
}

// The nearest by weights; of equal ones the first.
const Candidate& nearest(const std::vector<Candidate>& candidates, const std::vector<double>& weights) {
    const Candidate* best = nullptr;
    double least = 0;
    for (const Candidate& c : candidates) {
        const double shown = (1 - c.share) * weights[c.first] + c.share * weights[c.second];
        const double distance = (1 - c.share) * (1 - c.share) + c.share * c.share - 2 * shown;
        if (!best || distance < least) best = &c, least = distance;
    }
    return *best;
}

double encoded_distance2(const glm::dvec3& a, const glm::dvec3& b) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) sum += std::pow(255 * (srgb_of_linear(a[c]) - srgb_of_linear(b[c])), 2) / 3;
    return sum;
}

class Converter {
  public:
    Converter(const Weights& weights, bool tint, uint16_t fallback)
        : weights_(weights),
          tint_(tint),
          fallback_(fallback),
          sums_(weights.layers.size()),
          counts_(weights.layers.size()) {}

    // `painted`: by layer, as they are in the pictures.
    IndexTexel take(std::vector<double>& painted) {
        ++texels_;
        double sum = 0;
        for (const double w : painted) sum += w;
        if (sum <= 0) {
            ++unweighted_;
            return {.layer = fallback_};
        }
        glm::dvec3 color(0);
        for (size_t k = 0; k < painted.size(); ++k) {
            painted[k] /= sum;
            sums_[k] += painted[k];
            color += painted[k] * weights_.colors[k];
        }
        const Candidate& chosen = nearest(weights_.candidates, painted);
        counts_[chosen.first] += 1 - chosen.share;
        counts_[chosen.second] += chosen.share;
        kept_ += chosen.first == chosen.second ? painted[chosen.first]
                                               : std::min(1 - chosen.share, painted[chosen.first]) +
                                                     std::min(chosen.share, painted[chosen.second]);
        IndexTexel texel{.layer = chosen.index};
        glm::dvec3 shown = chosen.color;
        plain_ += encoded_distance2(shown, color);
        for (int c = 0; tint_ && c < 3; ++c) {
            const double wanted = chosen.color[c] > 0 ? color[c] / chosen.color[c] : 1;
            texel.tint[c] = srgb8_of_linear(wanted);
            shown[c] = chosen.color[c] * linear_of_srgb8(texel.tint[c]);
        }
        tinted_ += encoded_distance2(shown, color);
        return texel;
    }

    [[nodiscard]] WeightsReport report(const ProjectSettings& settings) const {
        WeightsReport r;
        r.texels = texels_;
        const double weighted = double(std::max<int64_t>(1, texels_ - unweighted_));
        for (size_t k = 0; k < sums_.size(); ++k)
            r.shares.push_back(
                {settings.layers[weights_.layers[k]].name, sums_[k] / weighted, counts_[k] / weighted});
        r.kept = kept_ / weighted;
        r.unweighted = double(unweighted_) / double(std::max<int64_t>(1, texels_));
        r.color_rms = std::sqrt(tinted_ / weighted);
        r.color_rms_plain = std::sqrt(plain_ / weighted);
        return r;
    }

  private:
    const Weights& weights_;
    bool tint_;
    uint16_t fallback_;
    int64_t texels_ = 0, unweighted_ = 0;
    double kept_ = 0, plain_ = 0, tinted_ = 0;
    std::vector<double> sums_, counts_;
};

}  // namespace

Result<WeightsReport> import_weights(Document& document, const WeightsRequest& request,
                                     const Progress& progress) {
    LOAM_TRY(document.check_writable());
    const ProjectSettings& settings = document.settings();
    Weights weights;
    LOAM_TRY(open_masks(document, request.folder, weights));
    LOAM_TRY(find_candidates(document, request.transitions, weights));

    const glm::ivec2 size = document.index_size_texels();
    Converter converter(weights, request.tint, settings.default_layer);
    // The pictures come from the north, the map is written from the south.
    std::vector<IndexTexel> texels(size_t(size.x) * size_t(size.y));
    std::vector<double> painted(weights.layers.size());
    for (int y = size.y - 1; y >= 0; --y) {
        std::vector<std::span<const glm::vec4>> rows;
        for (const Mask& mask : weights.masks) {
            const auto row = mask.mixer->next();
            if (!row.ok()) return row.error();
            rows.push_back(*row);
        }
        for (int x = 0; x < size.x; ++x) {
            for (size_t m = 0; m < rows.size(); ++m)
                for (size_t c = 0; c < weights.masks[m].layers.size(); ++c)
                    painted[weights.masks[m].layers[c]] = double(rows[m][size_t(x)][int(c)]);
            texels[size_t(y) * size_t(size.x) + size_t(x)] = converter.take(painted);
        }
        if (y % 64 == 0)
            LOAM_TRY(step_progress(progress, 0.8 * (1 - double(y) / size.y), "reading the weights"));
    }
    for (const Mask& mask : weights.masks) LOAM_TRY(mask.mixer->finish());
    WeightsReport report = converter.report(settings);
    if (report.unweighted > 0)
        report.notes.push_back(fmt::format("{:.1f} % of the map has no weights: layer {} there",
                                           100 * report.unweighted,
                                           settings.layers[settings.default_layer].name));
    LOAM_TRY(step_progress(progress, 0.85, "writing the index map"));
    BulkWriter writer(document);
    LOAM_TRY(writer.write_index_rows(0, size.y, texels));
    LOAM_TRY(writer.finish());
    return report;
}

}  // namespace loam
