#include "editor/imagery_import.h"

#include <algorithm>
#include <cmath>
#include <deque>

#include "editor/image_file.h"
#include "runtime/base/srgb.h"
#include "runtime/document/imagery.h"

namespace loam {

namespace {

namespace fs = std::filesystem;

// What a texel of one axis is made of: samples from `first` on and their weights, which sum to 1.
struct Mix {
    int first = 0;
    std::vector<float> weights;
};

// The mean of the samples that lie in the texel; where samples are wider than texels, between their centres.
Mix mix_between(double from, double to, int samples) {
    Mix mix;
    if (to - from <= 1) {
        const double at = (from + to) / 2 - 0.5;
        const double low = std::floor(at);
        const int last = samples - 1;
        mix.first = std::clamp(int(low), 0, last);
        const int second = std::clamp(int(low) + 1, 0, last);
        if (second == mix.first)
            mix.weights = {1};
        else
            mix.weights = {float(1 - (at - low)), float(at - low)};
        return mix;
    }
    mix.first = std::clamp(int(std::floor(from)), 0, samples - 1);
    const int end = std::clamp(int(std::ceil(to)), mix.first + 1, samples);
    double sum = 0;
    for (int i = mix.first; i < end; ++i) {
        const double share = std::max(0.0, std::min(to, i + 1.0) - std::max(from, double(i)));
        mix.weights.push_back(float(share));
        sum += share;
    }
    if (sum <= 0) {  // beyond the picture's edge: its last sample
        mix.weights.assign(mix.weights.size(), 0.0f);
        mix.weights.back() = 1;
        sum = 1;
    }
    for (float& weight : mix.weights) weight = float(weight / sum);
    return mix;
}

// Of texels from the map's west or south; `extent_m` is the picture's.
std::vector<Mix> axis_mixes(int texels, double spacing_m, double extent_m, int samples) {
    std::vector<Mix> mixes;
    for (int i = 0; i < texels; ++i) {
        const double from = i * spacing_m / extent_m * samples;
        const double to = std::min(double(samples), (i + 1) * spacing_m / extent_m * samples);
        mixes.push_back(mix_between(from, std::max(from, to), samples));
    }
    return mixes;
}

// Samples to linear light times cover, and cover.
class Decoder {
  public:
    explicit Decoder(const ImageRows& rows) : channels_(size_t(rows.channel_count())), alpha_(rows.alpha_channel()) {
        switch (rows.kind()) {
            case SampleKind::unsigned_8:
                white_ = 255;
                break;
            case SampleKind::unsigned_16:
                white_ = 65535;
                break;
            case SampleKind::signed_16:
                white_ = 32767;
                break;
            case SampleKind::floating:
                white_ = 1;
                break;
        }
        const std::string& space = rows.color_space();
        const bool linear = space == "Linear" || space == "linear" || space == "scene_linear";
        is_linear_ = linear || (rows.kind() == SampleKind::floating && space != "sRGB");
        is_rgb_ = channels_ - (alpha_ >= 0 ? 1 : 0) >= 3;
    }
    glm::vec4 operator()(const float* sample) {
        glm::vec4 out(0);
        float cover = alpha_ >= 0 ? std::clamp(sample[alpha_] / white_, 0.0f, 1.0f) : 1.0f;
        for (int c = 0; c < 3; ++c) {
            const float value = sample[is_rgb_ ? c : 0] / white_;
            if (!std::isfinite(value)) {
                ++not_finite;
                return glm::vec4(0);
            }
            brightest = std::max(brightest, value);
            if (value < -0.001f || value > 1.001f) ++beyond;
            if (is_linear_)
                out[c] = std::clamp(value, 0.0f, 1.0f);
            else
                out[c] = white_ == 255 ? float(linear_of_srgb8(uint8_t(sample[is_rgb_ ? c : 0])))
                                       : linear_of_srgb(value);
        }
        if (!std::isfinite(cover)) cover = 0;
        return {out.x * cover, out.y * cover, out.z * cover, cover};
    }
    [[nodiscard]] bool is_rgb() const { return is_rgb_; }

    size_t not_finite = 0, beyond = 0;
    float brightest = 0;

  private:
    size_t channels_;
    int alpha_;
    float white_ = 1;
    bool is_linear_ = false, is_rgb_ = false;
};

// The picture's rows become the map's, north first.
Status write_rows(ImageRows& rows, Decoder& decode, const WorldRect& bounds, const ImageryShape& shape,
                  ImageryWriter& writer, const Progress& progress) {
    const std::vector<Mix> columns = axis_mixes(shape.width, shape.spacing_m, bounds.max_x, rows.width());
    const size_t channels = size_t(rows.channel_count());
    std::deque<std::vector<glm::vec4>> held;  // rows of the picture, as wide as the map's
    int first_held = 0;
    std::vector<glm::vec4> texels(size_t(shape.width));
    for (int y = shape.height - 1; y >= 0; --y) {
        const double scale = rows.height() / bounds.max_y;
        const double from = std::max(0.0, (bounds.max_y - (y + 1) * shape.spacing_m) * scale);
        const double to = std::max(from, (bounds.max_y - y * shape.spacing_m) * scale);
        const Mix mix = mix_between(from, to, rows.height());
        for (; first_held < mix.first && !held.empty(); ++first_held) held.pop_front();
        while (first_held + int(held.size()) < mix.first + int(mix.weights.size())) {
            const auto row = rows.next();
            if (!row.ok()) return row.error();
            if (held.empty() && first_held < mix.first) {
                ++first_held;
                continue;
            }
            std::vector<glm::vec4>& out = held.emplace_back(size_t(shape.width));
            std::vector<glm::vec4> decoded(size_t(rows.width()));
            for (size_t x = 0; x < decoded.size(); ++x) decoded[x] = decode(row->data() + x * channels);
            for (size_t x = 0; x < out.size(); ++x)
                for (size_t k = 0; k < columns[x].weights.size(); ++k)
                    out[x] += columns[x].weights[k] * decoded[size_t(columns[x].first) + k];
        }
        for (size_t x = 0; x < texels.size(); ++x) {
            texels[x] = glm::vec4(0);
            for (size_t k = 0; k < mix.weights.size(); ++k)
                texels[x] += mix.weights[k] * held[size_t(mix.first - first_held) + k][x];
        }
        LOAM_TRY(writer.append_row(texels));
        if (y % 64 == 0)
            LOAM_TRY(step_progress(progress, 1 - double(y) / shape.height, "reading the picture"));
    }
    // What is cut short says so in its last rows.
    for (int row = first_held + int(held.size()); row < rows.height(); ++row)
        if (const auto rest = rows.next(); !rest.ok()) return rest.error();
    return {};
}

fs::path free_file(const fs::path& folder, std::string name) {
    for (char& c : name)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '_';
    if (name.empty()) name = "imagery";
    fs::path file = folder / (name + ".imagery");
    for (int i = 2; fs::exists(file); ++i) file = folder / fmt::format("{}_{}.imagery", name, i);
    return file;
}

void note_oddities(const ImageRows& rows, const Decoder& decoder, const WorldRect& bounds, AddedImagery& out) {
    const double aspect = (bounds.max_x / rows.width()) / (bounds.max_y / rows.height());
    if (aspect > 1.01 || aspect < 1 / 1.01)
        out.notes.push_back(fmt::format(
            "its pixels are {:.3g} x {:.3g} m on this map: the picture is stretched to the map's corners",
            bounds.max_x / rows.width(), bounds.max_y / rows.height()));
    if (!decoder.is_rgb()) out.notes.push_back("it has no colours: shown in grey");
    const int colours = rows.channel_count() - (rows.alpha_channel() >= 0 ? 1 : 0);
    if (colours > 3)
        out.notes.push_back(fmt::format("it has {} bands: the first three are shown", colours));
    if (decoder.not_finite > 0)
        out.notes.push_back(
            fmt::format("{} pixels were not finite: the layers show there", decoder.not_finite));
    if (decoder.beyond > 0)
        out.notes.push_back(fmt::format("{} numbers lay beyond black and white: clamped", decoder.beyond));
    if (decoder.brightest < 0.125f)
        out.notes.push_back(fmt::format(
            "its brightest number is {:.1f} % of white: stretch its contrast first if it looks dark",
            100 * decoder.brightest));
}

}  // namespace

Result<AddedImagery> add_imagery(Document& document, const AddImageryRequest& request,
                                 const Progress& progress) {
    ProjectSettings settings = document.settings();
    ImagerySettings& imagery = settings.imagery;
    imagery.strength = request.strength.value_or(imagery.strength);
    imagery.distance_m = request.distance_m.value_or(imagery.distance_m);
    const fs::path file = free_file(document.folder() / "imagery", request.file.stem().string());
    imagery.file = (fs::path("imagery") / file.filename()).string();
    LOAM_TRY(check_settings(settings));
    LOAM_TRY(document.check_writable());

    auto rows = ImageRows::open(request.file);
    if (!rows.ok()) return rows.error();
    const WorldRect bounds = document.bounds();
    AddedImagery added{.settings = imagery,
                       .width = (*rows)->width(),
                       .height = (*rows)->height(),
                       .shape = imagery_shape(settings, std::min(bounds.max_x / (*rows)->width(),
                                                                 bounds.max_y / (*rows)->height())),
                       .size_bytes = 0,
                       .notes = {}};
    std::error_code failure;
    fs::create_directories(file.parent_path(), failure);
    if (failure) return error("cannot make {}: {}", file.parent_path().string(), failure.message());
    auto writer = ImageryWriter::create(file, added.shape);
    if (!writer.ok()) return writer.error();
    Decoder decoder(**rows);
    LOAM_TRY(write_rows(**rows, decoder, bounds, added.shape, **writer, progress));
    LOAM_TRY((*writer)->finish());
    added.size_bytes = (*writer)->size_bytes();
    note_oddities(**rows, decoder, bounds, added);
    if (const Status changed = document.change_settings(settings); !changed.ok()) {
        fs::remove(file, failure);
        return changed.error();
    }
    return added;
}

}  // namespace loam
