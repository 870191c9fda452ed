#include "editor/session.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <type_traits>

#include "editor/fill.h"
#include "editor/image_file.h"
#include "editor/picture.h"
#include "runtime/base/log.h"
#include "runtime/base/units.h"

namespace loam {

namespace {

constexpr uint32_t kFramesInFlight = 2;
constexpr int64_t kLargestFill = int64_t(2048) * 2048;  // texels of one command
// Feedback is read back three frames later: the picture rests once so many frames in a row found nothing to
// improve.
constexpr int kRestingFrames = 4;
// The reference: geometry this many node sides around the camera at full detail (a few hundred patches), with
// slots for all of them.
constexpr double kReferenceSplitDistance = 6.0;
constexpr int kReferenceHeightSlots = 1024;
constexpr int kReferenceLayers_mb = 65'536;

Result<double> largest_height_m(const Document& document) {
    const auto lock = document.read_lock();
    const int mip = std::max(0, document.height_mip_count() - 1);
    const int width = ((document.settings().height_samples_x - 1) >> mip) + 1;
    const int height = ((document.settings().height_samples_y - 1) >> mip) + 1;
    std::vector<int32_t> mm(static_cast<size_t>(width) * static_cast<size_t>(height));
    document.read_heights_mm(mip, 0, 0, width, height, mm.data());
    return height_m_from_mm(*std::max_element(mm.begin(), mm.end()));
}

}  // namespace

struct Session::Recorder {
    std::filesystem::path path;
    std::FILE* file = nullptr;
    ~Recorder() {
        if (file) std::fclose(file);
    }
};

Session::Session() = default;
Session::~Session() {
    if (prints_)
        if (const auto laid = prints_->flush(); !laid)
            log(LogLevel::warning, "the last prints were not laid: {}", laid.message());
    if (device_) device_->wait_idle();
}

Result<std::unique_ptr<Session>> Session::open(const std::filesystem::path& project,
                                               const SessionDesc& desc) {
    auto document = Document::open(project, desc.mode);
    if (!document) return document.error();
    std::unique_ptr<Session> session(new Session());
    session->desc_ = desc;
    session->document_ = std::move(*document);
    session->prints_ = std::make_unique<Prints>(*session);
    return session;
}

Status Session::make_device() {
    if (device_) return {};
    auto device = gpu::Device::create(desc_.device);
    if (!device) return device.error();
    auto ring = gpu::FrameRing::create(**device, kFramesInFlight);
    if (!ring) return ring.error();
    device_ = std::move(*device);
    ring_ = std::move(*ring);
    return {};
}

Result<Renderer*> Session::renderer() {
    if (renderer_) return renderer_.get();
    LOAM_TRY(make_device());
    auto made = Renderer::create(*device_, *ring_, *document_, desc_.renderer);
    if (!made) return made.error();
    renderer_ = std::move(*made);
    query_heights_.reset();
    query_indices_.reset();
    return renderer_.get();
}

RendererDesc reference_renderer(RendererDesc desc) {
    desc.height_slots = std::max(desc.height_slots, kReferenceHeightSlots);
    desc.patch_split_distance = std::max(desc.patch_split_distance, kReferenceSplitDistance);
    desc.layer_budget_mb = std::max(desc.layer_budget_mb, kReferenceLayers_mb);  // it looks at them directly
    return desc;
}

float supersample_bias(int samples) {
    return -std::log2(static_cast<float>(std::max(1, samples)));
}

FrameSettings reference_frame(FrameSettings frame) {
    frame.shading = Shading::direct;
    frame.render_scale = 1.0f;
    frame.at_rest = true;
    return frame;
}

// --- edits ---

Result<Dirt> Session::apply(const Command& command) {
    // What was stepped on before is of the time that was.
    if (std::holds_alternative<TimeCommand>(command.body) && prints_->waiting() > 0) {
        auto printed = prints_->flush_for_frame();
        if (!printed) return printed;
        auto dirt = apply_one(command);
        if (dirt) append_dirt(*dirt, *printed);
        return dirt;
    }
    const auto* large = std::get_if<FillCommand>(&command.body);
    if (!large || document_->fill_texels(*large).area() <= kLargestFill) return apply_one(command);
    LOAM_TRY(check_command(command));
    Fill fill(*this, *large);
    Dirt all;
    while (!fill.done()) {
        auto dirt = fill.step();
        if (!dirt) return dirt;
        append_dirt(all, *dirt);
    }
    return all;
}

Result<Dirt> Session::apply_one(const Command& command) {
    auto dirt = document_->apply(command);
    if (!dirt) return dirt;
    spread(*dirt);
    if (renderer_ && dirt->layers) LOAM_TRY(renderer_->settings_changed(*ring_));
    if (recorder_) {
        const std::string line = to_json(command) + "\n";
        if (std::fputs(line.c_str(), recorder_->file) < 0 || std::fflush(recorder_->file) != 0) {
            log(LogLevel::error, "recording to {} stopped: {}", recorder_->path.string(),
                std::strerror(errno));
            recorder_.reset();
        }
    }
    return dirt;
}

void Session::spread(const Dirt& dirt) {
    if (renderer_) renderer_->on_dirt(dirt);
    if (query_heights_) query_heights_->on_dirt(dirt.height);
    if (query_indices_) query_indices_->on_dirt(dirt.index);
}

Dirt Session::poll_functions() {
    Dirt dirt = document_->poll_functions();
    if (!dirt.empty()) spread(dirt);
    return dirt;
}

Status Session::change_settings(const ProjectSettings& settings) {
    LOAM_TRY(document_->change_settings(settings));
    return renderer_ ? renderer_->settings_changed(*ring_) : Status();
}

Result<AddedLayer> Session::add_layer(const AddLayerRequest& request, const Progress& progress) {
    auto added = loam::add_layer(*document_, request, progress);
    if (!added) return added;
    if (renderer_) LOAM_TRY(renderer_->settings_changed(*ring_));
    return added;
}

Result<AddedImagery> Session::add_imagery(const AddImageryRequest& request, const Progress& progress) {
    auto added = loam::add_imagery(*document_, request, progress);
    if (!added) return added;
    if (renderer_) LOAM_TRY(renderer_->settings_changed(*ring_));
    return added;
}

Result<WeightsReport> Session::import_weights(const WeightsRequest& request, const Progress& progress) {
    auto report = loam::import_weights(*document_, request, progress);
    if (!report) return report;
    const Dirt dirt{.height = {}, .index = {document_->bounds()}, .texture = {}};
    spread(dirt);
    return report;
}

Status Session::record_to(const std::filesystem::path& file) {
    auto recorder = std::make_unique<Recorder>();
    recorder->path = file;
    recorder->file = std::fopen(file.c_str(), "a");
    if (!recorder->file) return error("cannot record to {}: {}", file.string(), std::strerror(errno));
    recorder_ = std::move(recorder);
    return {};
}

// --- pictures ---

Status Session::one_frame(Renderer& renderer, const Camera& camera, glm::uvec2 extent,
                          const FrameSettings& settings, Picture* picture) {
    auto frame = ring_->begin();
    if (!frame) return frame.error();
    gpu::Commands& commands = (*frame)->commands;
    LOAM_TRY(renderer.render(*ring_, commands, camera, extent, settings));
    if (picture) {
        gpu::Image& image = renderer.picture();
        const glm::uvec2 filled = renderer.picture_size();
        const size_t image_width = image.width();
        picture->width = static_cast<int>(filled.x);
        picture->height = static_cast<int>(filled.y);
        ring_->read_back(commands, image, [picture, filled, image_width](std::span<const std::byte> bytes) {
            const size_t row_bytes = size_t{4} * filled.x;
            picture->rgba.resize(row_bytes * filled.y);
            for (size_t row = 0; row < filled.y; ++row)
                std::memcpy(picture->rgba.data() + row * row_bytes, bytes.data() + row * image_width * 4,
                            row_bytes);
        });
    }
    LOAM_TRY(ring_->finish(**frame));
    ++frames_rendered_;
    return {};
}

Result<Picture> Session::settle(Renderer& renderer, const RenderRequest& request,
                                const FrameSettings& frame) {
    const glm::uvec2 extent(request.width, request.height);
    int resting = 0;
    last_render_settled_ = false;
    // Only the last frame is read back.
    for (int i = 0; i + 1 < request.max_frames && resting < kRestingFrames; ++i) {
        LOAM_TRY(one_frame(renderer, request.camera, extent, frame, nullptr));
        resting = renderer.settled() ? resting + 1 : 0;
    }
    last_render_settled_ = resting >= kRestingFrames;
    Picture picture;
    LOAM_TRY(one_frame(renderer, request.camera, extent, frame, &picture));
    return picture;
}

Result<Picture> Session::supersampled(Renderer& renderer, const RenderRequest& request,
                                      const FrameSettings& frame) {
    const int n = std::max(1, request.supersample);
    if (n == 1) return settle(renderer, request, frame);
    LinearAverage average;
    bool all_settled = true;
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            FrameSettings jittered = frame;
            jittered.jitter_px = {(i + 0.5) / n - 0.5, (j + 0.5) / n - 0.5};
            jittered.footprint_bias = supersample_bias(n);
            auto picture = settle(renderer, request, jittered);
            if (!picture) return picture;
            all_settled = all_settled && last_render_settled_;
            average.add(*picture);
        }
    last_render_settled_ = all_settled;
    return average.picture();
}

Result<Picture> Session::render(const RenderRequest& request) {
    if (auto laid = prints_->flush_for_frame(); !laid) return laid.error();
    if (!request.reference) {
        auto renderer = this->renderer();
        if (!renderer) return renderer.error();
        return supersampled(**renderer, request, request.frame);
    }
    LOAM_TRY(make_device());
    auto reference = Renderer::create(*device_, *ring_, *document_, reference_renderer(desc_.renderer));
    if (!reference) return reference.error();
    RenderRequest direct = request;
    direct.frame = reference_frame(request.frame);
    direct.supersample = std::max(request.supersample, kReferenceSupersample);
    return supersampled(**reference, direct, direct.frame);
}

Status Session::step(const Camera& camera, int width, int height, const FrameSettings& settings, int frames) {
    if (auto laid = prints_->flush_for_frame(); !laid) return laid.error();
    auto renderer = this->renderer();
    if (!renderer) return renderer.error();
    for (int i = 0; i < frames; ++i)
        LOAM_TRY(one_frame(**renderer, camera, glm::uvec2(width, height), settings, nullptr));
    return {};
}

Status Session::set_quality(Quality quality, std::optional<PageFormat> page_format) {
    if (renderer_) LOAM_TRY(renderer_->set_quality(quality, page_format));
    desc_.renderer.quality = quality;
    desc_.renderer.page_format = page_format;
    desc_.renderer.texture.pages_per_side = desc_.renderer.texture.indirection_size = 0;
    return {};
}

Status Session::announce(const std::optional<Camera>& camera) {
    auto renderer = this->renderer();
    if (!renderer) return renderer.error();
    (*renderer)->announce(camera);
    return {};
}

Result<GroundBuffers> Session::ground_buffers(const Camera& camera, int width, int height) {
    auto renderer = this->renderer();
    if (!renderer) return renderer.error();
    auto frame = ring_->begin();
    if (!frame) return frame.error();
    gpu::Commands& commands = (*frame)->commands;
    LOAM_TRY((*renderer)->render(*ring_, commands, camera, glm::uvec2(width, height), {}));
    const glm::uvec2 filled = (*renderer)->picture_size();
    GroundBuffers buffers{int(filled.x), int(filled.y), {}, {}};
    const auto read_back = [&](gpu::Image& image, auto& texels, size_t per_pixel) {
        using Value = typename std::remove_reference_t<decltype(texels)>::value_type;
        const size_t row_values = filled.x * per_pixel, pitch_values = image.width() * per_pixel;
        texels.resize(row_values * filled.y);
        ring_->read_back(
            commands, image,
            [&texels, rows = filled.y, row_values, pitch_values](std::span<const std::byte> bytes) {
                for (size_t row = 0; row < rows; ++row)
                    std::memcpy(texels.data() + row * row_values,
                                bytes.data() + row * pitch_values * sizeof(Value),
                                row_values * sizeof(Value));
            });
    };
    read_back((*renderer)->gbuffer(), buffers.gbuffer, 4);
    // Only 32-bit depth is floats; elsewhere the list stays empty.
    if (device_->caps().depth_stencil == VK_FORMAT_D32_SFLOAT_S8_UINT)
        read_back((*renderer)->depth(), buffers.depth, 1);
    LOAM_TRY(ring_->finish(**frame));
    ++frames_rendered_;
    return buffers;
}

Camera Session::default_camera() {
    const WorldRect bounds = document_->bounds();
    const glm::dvec2 size(bounds.width(), bounds.height());
    const auto ground_m = [&](glm::dvec2 at) {
        const auto height = height_m(at.x, at.y);
        return height ? *height : 0.0;
    };
    // Over the corner, high enough to look over most of what is before it: the ground fills the foot of the
    // picture and the far edge meets the sky in its upper third.
    const glm::dvec2 corner = size * glm::dvec2(0.06, 0.04), middle = size * 0.55;
    const double side = std::max(size.x, size.y);
    const auto top = largest_height_m(*document_);
    const double over_corner_m = ground_m(corner) + 0.13 * side;
    const double eye_m =
        std::max(over_corner_m, top ? std::min(*top + 0.02 * side, over_corner_m + 0.1 * side) : 0.0);
    return Camera::look_at({corner, eye_m}, {middle, ground_m(middle) + 0.02 * side}, 0.9);
}

// --- queries ---

Status Session::make_query_maps() {
    if (query_heights_) return {};
    auto heights = HeightMap::create(nullptr, *document_, {.gpu = false});
    if (!heights) return heights.error();
    auto indices = IndexMap::create(nullptr, *document_, {.gpu = false});
    if (!indices) return indices.error();
    query_heights_ = std::move(*heights);
    query_indices_ = std::move(*indices);
    return {};
}

Result<double> Session::height_m(double x_m, double y_m) {
    if (renderer_) return renderer_->height_m(x_m, y_m);
    LOAM_TRY(make_query_maps());
    return query_heights_->height_m(x_m, y_m);
}

Result<glm::dvec3> Session::normal(double x_m, double y_m) {
    if (renderer_) return renderer_->normal(x_m, y_m);
    LOAM_TRY(make_query_maps());
    return query_heights_->normal(x_m, y_m);
}

Result<IndexTexel> Session::layer_at(double x_m, double y_m) {
    if (renderer_) return renderer_->layer_at(x_m, y_m);
    LOAM_TRY(make_query_maps());
    return query_indices_->texel_at(x_m, y_m);
}

Result<std::optional<glm::dvec3>> Session::ray_cast(glm::dvec3 origin_m, glm::dvec3 direction, double max_m,
                                                    Holes holes) {
    if (renderer_) return renderer_->ray_cast(origin_m, direction, max_m, holes);
    LOAM_TRY(make_query_maps());
    return query_heights_->ray_cast(origin_m, direction, max_m, holes);
}

bool Session::is_cut(double x_m, double y_m) const {
    return CutoutMap::is_cut(*document_, x_m, y_m);
}

Status save_png(const std::filesystem::path& file, const Picture& picture) {
    return write_rgba8_png(file, picture.width, picture.height, picture.rgba);
}

}  // namespace loam
