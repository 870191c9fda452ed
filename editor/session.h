// A session: device, document, renderer and recording together. The window, the Python module and the
// headless verbs all work through it, so that they cannot differ.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "editor/imagery_import.h"
#include "editor/layer_import.h"
#include "editor/prints.h"
#include "editor/weights_import.h"
#include "runtime/base/result.h"
#include "runtime/document/document.h"
#include "runtime/frame/camera.h"
#include "runtime/frame/renderer.h"
#include "runtime/gpu/device.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/maps/height_map.h"
#include "runtime/maps/index_map.h"

namespace loam {

struct SessionDesc {
    gpu::DeviceDesc device;
    RendererDesc renderer;
    OpenMode mode = OpenMode::read_write;
};

struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> rgba;  // sRGB-encoded, row 0 is the top
};

// What the ground pass wrote, for tests; row 0 is the top.
struct GroundBuffers {
    int width = 0, height = 0;
    std::vector<uint16_t> gbuffer;  // four halves a pixel, shaders/geometry/gbuffer.glsl
    std::vector<float> depth;       // reversed Z, 0 where there is no ground
};

// What the reference has beyond a view's own settings: patches six node sides around the camera at full
// detail (a few hundred), slots for all of them, 4 x 4 samples a pixel.
inline constexpr int kReferenceSupersample = 4;
// Of direct shading's footprint, log2: a sample of n x n covers its part of the pixel, so that the lit
// samples are averaged rather than what is lit.
[[nodiscard]] float supersample_bias(int samples);
[[nodiscard]] RendererDesc reference_renderer(RendererDesc desc);
[[nodiscard]] FrameSettings reference_frame(FrameSettings frame);

struct RenderRequest {
    Camera camera;
    int width = 1280, height = 720;
    FrameSettings frame;
    int max_frames = 600;    // until settled
    int supersample = 1;     // n x n jittered pictures averaged in linear light
    bool reference = false;  // direct shading, full geometry, at least 4 x 4 samples
};

class Session {
  public:
    static Result<std::unique_ptr<Session>> open(const std::filesystem::path& project,
                                                 const SessionDesc& desc);
    ~Session();

    Document& document() { return *document_; }
    // Feet and wheels of actors; laid with the next picture.
    Prints& prints() { return *prints_; }
    // The device and renderer are made at the first use: edits and queries of a script that renders nothing
    // need no GPU.
    Result<Renderer*> renderer();
    Status start_device() {
        return make_device();
    }  // the window: something is on screen before the renderer is there
    gpu::Device* device() { return device_.get(); }
    gpu::FrameRing* ring() { return ring_.get(); }

    // One door for edits: applies, tells the renderer, records. A fill that is larger than one command may be
    // is a group of them (fill.h).
    Result<Dirt> apply(const Command& command);
    Result<Dirt> apply_one(const Command& command);
    // Document::poll_functions, and what is rendered from now on.
    Dirt poll_functions();
    // Settings that may change (sun, ground, layers): the document's, and what is rendered from now on.
    Status change_settings(const ProjectSettings& settings);
    // The layer can be painted with, and is drawn, once this returns; a renderer loads the layers again.
    Result<AddedLayer> add_layer(const AddLayerRequest& request, const Progress& progress);
    // The same for imagery over the map.
    Result<AddedImagery> add_imagery(const AddImageryRequest& request, const Progress& progress);
    // Replaces the index map (weights_import.h).
    Result<WeightsReport> import_weights(const WeightsRequest& request, const Progress& progress);
    // Every command from now on is appended to this file, one JSON line each.
    Status record_to(const std::filesystem::path& file);

    // Renders frames until settled (or max_frames) and returns the picture.
    Result<Picture> render(const RenderRequest& request);
    // At the next use, or live: the picture keeps its texels until the new texture has them.
    Status set_quality(Quality quality, std::optional<PageFormat> page_format);
    // The camera will soon be there (none: no longer): its pages are made while other pictures are.
    Status announce(const std::optional<Camera>& camera);
    // `frames` frames, without waiting for the picture to settle.
    Status step(const Camera& camera, int width, int height, const FrameSettings& settings, int frames);
    // One more frame, and what its ground pass wrote.
    Result<GroundBuffers> ground_buffers(const Camera& camera, int width, int height);
    [[nodiscard]] int frames_rendered() const { return frames_rendered_; }
    [[nodiscard]] bool last_render_settled() const {
        return last_render_settled_;
    }  // else max_frames ended it

    // The composed ground under a point: the renderer's pages when there is one, else composed without a
    // device.
    Result<double> height_m(double x_m, double y_m);
    Result<glm::dvec3> normal(double x_m, double y_m);
    Result<IndexTexel> layer_at(double x_m, double y_m);
    static constexpr double kLongestRay_m = 50'000;
    Result<std::optional<glm::dvec3>> ray_cast(glm::dvec3 origin_m, glm::dvec3 direction,
                                               double max_m = kLongestRay_m, Holes holes = Holes::open);
    [[nodiscard]] bool is_cut(double x_m, double y_m) const;  // a hole; off the map: no
    // A view of the whole map from the south-west, above the ground.
    [[nodiscard]] Camera default_camera();

  private:
    Session();
    Status make_device();
    void spread(const Dirt& dirt);
    Status make_query_maps();  // for the queries of a session that has no renderer
    // Frames of `renderer` from one camera until another would not improve the picture; then the picture.
    Result<Picture> settle(Renderer& renderer, const RenderRequest& request, const FrameSettings& frame);
    Result<Picture> supersampled(Renderer& renderer, const RenderRequest& request,
                                 const FrameSettings& frame);
    Status one_frame(Renderer& renderer, const Camera& camera, glm::uvec2 extent, const FrameSettings& frame,
                     Picture* picture);

    struct Recorder;
    SessionDesc desc_;
    std::unique_ptr<Document> document_;
    std::unique_ptr<Prints> prints_;
    std::unique_ptr<gpu::Device> device_;
    std::unique_ptr<gpu::FrameRing> ring_;
    std::unique_ptr<Renderer> renderer_;
    std::unique_ptr<HeightMap> query_heights_;
    std::unique_ptr<IndexMap> query_indices_;
    std::unique_ptr<Recorder> recorder_;
    int frames_rendered_ = 0;
    bool last_render_settled_ = false;
};

// "x,y,z,yaw_deg,pitch_deg[,fov_deg]" as on the command line.
[[nodiscard]] Result<Camera> parse_camera(std::string_view text);
// "eye x,y,z,target x,y,z[,fov_deg]"
[[nodiscard]] Result<Camera> parse_look_at(std::string_view text);
Status save_png(const std::filesystem::path& file, const Picture& picture);

}  // namespace loam
