#include "editor/imagery_import.h"

#include <algorithm>
#include <cmath>

#include "editor/project_folder.h"
#include "editor/row_mix.h"
#include "runtime/base/srgb.h"
#include "runtime/document/imagery.h"

namespace loam {

namespace {

namespace fs = std::filesystem;

// Samples to linear light times cover, and cover.
class Decoder {
  public:
    explicit Decoder(const ImageRows& rows)
        : channels_(size_t(rows.channel_count())), alpha_(rows.alpha_channel()) {
        white_ = white_of(rows.kind());
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

// Of texels from the map's west; with `from_north` from its north.
std::vector<PixelMix> texel_mixes(int texels, double spacing_m, double extent_m, int pixels,
                                  bool from_north) {
    std::vector<PixelMix> mixes;
    for (int i = 0; i < texels; ++i) {
        const double low_m = from_north ? extent_m - (texels - i) * spacing_m : i * spacing_m;
        mixes.push_back(mix_between(std::max(0.0, low_m) / extent_m * pixels,
                                    std::min(extent_m, low_m + spacing_m) / extent_m * pixels, pixels));
    }
    return mixes;
}

// The picture's rows become the map's, north first.
Status write_rows(ImageRows& picture, Decoder& decode, const WorldRect& bounds, const ImageryShape& shape,
                  ImageryWriter& writer, const Progress& progress) {
    RowMixer mixer(picture, texel_mixes(shape.width, shape.spacing_m, bounds.max_x, picture.width(), false),
                   texel_mixes(shape.height, shape.spacing_m, bounds.max_y, picture.height(), true),
                   [&](const float* pixel) { return decode(pixel); });
    for (int y = shape.height - 1; y >= 0; --y) {
        const auto row = mixer.next();
        if (!row.ok()) return row.error();
        LOAM_TRY(writer.append_row(*row));
        if (y % 64 == 0)
            LOAM_TRY(step_progress(progress, 1 - double(y) / shape.height, "reading the picture"));
    }
    return mixer.finish();
}

void note_oddities(const ImageRows& rows, const Decoder& decoder, const WorldRect& bounds,
                   AddedImagery& out) {
    const double aspect = (bounds.max_x / rows.width()) / (bounds.max_y / rows.height());
    if (aspect > 1.01 || aspect < 1 / 1.01)
        out.notes.push_back(fmt::format(
            "its pixels are {:.3g} x {:.3g} m on this map: the picture is stretched to the map's corners",
            bounds.max_x / rows.width(), bounds.max_y / rows.height()));
    if (!decoder.is_rgb()) out.notes.push_back("it has no colours: shown in grey");
    const int colours = rows.channel_count() - (rows.alpha_channel() >= 0 ? 1 : 0);
    if (colours > 3) out.notes.push_back(fmt::format("it has {} bands: the first three are shown", colours));
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

ProjectSettings settings_with(const ProjectSettings& now, const AddImageryRequest& request,
                              const fs::path& file) {
    ProjectSettings settings = now;
    ImagerySettings& imagery = settings.imagery;
    imagery.strength = request.strength.value_or(imagery.strength);
    imagery.distance_m = request.distance_m.value_or(imagery.distance_m);
    imagery.file = (fs::path("imagery") / file.filename()).string();
    return settings;
}

}  // namespace

Result<std::unique_ptr<ImageryImport>> ImageryImport::plan(const Document& document,
                                                           const AddImageryRequest& request) {
    std::unique_ptr<ImageryImport> import(new ImageryImport);
    import->request_ = request;
    import->file_ = free_file(document.folder() / "imagery", request.file.stem().string(), {".imagery"});
    import->settings_ = settings_with(document.settings(), request, import->file_);
    LOAM_TRY(check_settings(import->settings_));
    LOAM_TRY(document.check_writable());
    return import;
}

ImageryImport::~ImageryImport() {
    std::error_code code;
    if (!adopted_ && !file_.empty()) fs::remove(file_, code);
}

Status ImageryImport::make(const Progress& progress) {
    auto rows = ImageRows::open(request_.file);
    if (!rows.ok()) return rows.error();
    const WorldRect bounds = settings_.bounds();
    added_.width = (*rows)->width();
    added_.height = (*rows)->height();
    added_.shape =
        imagery_shape(settings_, std::min(bounds.max_x / (*rows)->width(), bounds.max_y / (*rows)->height()));
    std::error_code failure;
    fs::create_directories(file_.parent_path(), failure);
    if (failure) return error("cannot make {}: {}", file_.parent_path().string(), failure.message());
    auto writer = ImageryWriter::create(file_, added_.shape);
    if (!writer.ok()) return writer.error();
    Decoder decoder(**rows);
    LOAM_TRY(write_rows(**rows, decoder, bounds, added_.shape, **writer, progress));
    LOAM_TRY((*writer)->finish());
    added_.size_bytes = (*writer)->size_bytes();
    note_oddities(**rows, decoder, bounds, added_);
    return {};
}

Result<AddedImagery> ImageryImport::adopt(Document& document) {
    const ProjectSettings settings = settings_with(document.settings(), request_, file_);
    LOAM_TRY(document.change_settings(settings));
    added_.settings = settings.imagery;
    adopted_ = true;
    return added_;
}

Result<AddedImagery> add_imagery(Document& document, const AddImageryRequest& request,
                                 const Progress& progress) {
    auto import = ImageryImport::plan(document, request);
    if (!import) return import.error();
    LOAM_TRY((*import)->make(progress));
    return (*import)->adopt(document);
}

}  // namespace loam
