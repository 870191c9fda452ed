// One edit, measured: wall clock from the command to the pictures (each frame is waited for), counters before
// and after.
#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr int kMaxFrames = 600;

struct Pictures {
    double first_changed_ms = -1, settled_ms = 0;
    int first_changed_frame = -1, frames = 0;
};

// Frames until the picture rests. `before` is the picture that rested before the change.
Result<Pictures> watch(Session& session, const RenderRequest& request, const Picture& before,
                       double start_ms) {
    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    Pictures seen;
    RenderRequest one = request;
    one.max_frames = 1;
    int resting = 0;
    while (seen.frames < kMaxFrames && resting < 4) {
        auto picture = session.render(one);
        if (!picture) return picture.error();
        ++seen.frames;
        const double at_ms = now_ms() - start_ms;
        if (seen.first_changed_frame < 0 && picture->rgba != before.rgba) {
            seen.first_changed_frame = seen.frames;
            seen.first_changed_ms = at_ms;
        }
        if (resting == 0) seen.settled_ms = at_ms;
        resting = (*renderer)->settled() ? resting + 1 : 0;
    }
    return seen;
}

}  // namespace

Result<Json> measure_edit(Session& session, const Camera& camera, int width, int height,
                          const Command& command) {
    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    RenderRequest request{.camera = camera, .width = width, .height = height, .frame = {}};
    auto before = session.render(request);
    if (!before) return before.error();
    const FrameStatistics a = (*renderer)->statistics();
    const double start_ms = now_ms();
    auto dirt = session.apply(command);
    if (!dirt) return dirt.error();
    const double applied_ms = now_ms() - start_ms;
    auto seen = watch(session, request, *before, start_ms);
    if (!seen) return seen.error();
    const FrameStatistics b = (*renderer)->statistics();
    return Json{{"apply ms", rounded(applied_ms, 2)},
                {"first changed ms",
                 seen->first_changed_frame < 0 ? Json() : Json(rounded(seen->first_changed_ms, 1))},
                {"in frame", seen->first_changed_frame < 0 ? Json() : Json(seen->first_changed_frame)},
                {"settled ms", rounded(seen->settled_ms, 1)},
                {"height dirtied", b.height.pages_dirtied - a.height.pages_dirtied},
                {"height composed", b.height.pages_composed - a.height.pages_composed},
                {"height texels", b.height.texels_composed - a.height.texels_composed},
                {"index dirtied", b.index.pages_dirtied - a.index.pages_dirtied},
                {"index composed", b.index.pages_composed - a.index.pages_composed},
                {"index texels", b.index.texels_composed - a.index.texels_composed},
                {"texture dirtied", b.texture.pages_dirtied - a.texture.pages_dirtied},
                {"texture composed", b.texture.pages_composed - a.texture.pages_composed},
                {"texture rects", b.texture.rects_composed - a.texture.rects_composed},
                {"texture texels", b.texture.texels_composed - a.texture.texels_composed}};
}

Result<double> resolve_probe_ms(Session& session, const FrameSettings* settings,
                                Renderer::ResolveProbe probe) {
    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    gpu::FrameRing& ring = *session.ring();
    auto frame = ring.begin();
    if (!frame) return frame.error();
    if (settings) LOAM_TRY((*renderer)->resolve_again(ring, (*frame)->commands, *settings, probe));
    const double start_ms = now_ms();
    LOAM_TRY(ring.finish(**frame));
    return now_ms() - start_ms;
}

Result<std::unique_ptr<Session>> open_read_only(const std::filesystem::path& project, SessionDesc desc) {
    desc.mode = OpenMode::read_only;
    return Session::open(project, desc);
}

Result<ReferenceView> ReferenceView::open(const std::filesystem::path& project, SessionDesc desc,
                                          int samples) {
    desc.renderer = reference_renderer(desc.renderer);
    auto session = open_read_only(project, desc);
    if (!session) return session.error();
    return ReferenceView(std::move(*session), samples);
}

Result<Picture> ReferenceView::picture(const Camera& camera, int width, int height) {
    RenderRequest request{.camera = camera, .width = width, .height = height, .frame = reference_frame({})};
    request.frame.footprint_bias = supersample_bias(samples_);
    auto renderer = session_->renderer();
    if (!renderer) return renderer.error();
    for (int i = 0, resting = 0; i < request.max_frames && resting < 2; ++i) {
        LOAM_TRY(session_->step(camera, width, height, request.frame, 1));
        resting = (*renderer)->settled() ? resting + 1 : 0;
    }
    request.max_frames = 1;  // samples within a pixel are no other view
    request.supersample = samples_;
    return session_->render(request);
}

}  // namespace loam::bench
