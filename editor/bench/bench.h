// Benches: figures that docs/measurements.md quotes, each printed by one command.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "editor/import.h"
#include "editor/report.h"
#include "editor/session.h"

namespace loam::bench {

struct BenchRequest {
    std::filesystem::path project;
    SessionDesc session;
    int width = 960, height = 540;
    int frames = 300;              // frame
    double goal_ms = 33;           // frame
    int dabs = 0;                  // edits: a row; 0: up to 200, as many as some seconds allow
    std::optional<Camera> camera;  // resolve, quality, filter; none: views of their own
    std::filesystem::path dem;     // ground
    std::filesystem::path images;  // encoders: folder of photographs
    std::filesystem::path
        pictures;        // pop, quality: a folder for the pictures that figures speak of; empty: none
    bool quick = false;  // fewer settings and frames: for tests
};

// Rows of one table have the same keys.
struct BenchTable {
    std::string title;
    std::vector<Json> rows;
};
using BenchReport = std::vector<BenchTable>;

struct BenchName {
    const char* name;
    const char* summary;
    Result<BenchReport> (*run)(const BenchRequest& request);
};
[[nodiscard]] const std::vector<BenchName>& benches();

Result<BenchReport> bench_compose(const BenchRequest& request);
Result<BenchReport> bench_converge(const BenchRequest& request);
Result<BenchReport> bench_cost(const BenchRequest& request);
Result<BenchReport> bench_crater(const BenchRequest& request);
Result<BenchReport> bench_edits(const BenchRequest& request);
Result<BenchReport> bench_encoders(const BenchRequest& request);
Result<BenchReport> bench_events(const BenchRequest& request);
Result<BenchReport> bench_feedback(const BenchRequest& request);
Result<BenchReport> bench_filter(const BenchRequest& request);
Result<BenchReport> bench_flat(const BenchRequest& request);
Result<BenchReport> bench_frame(const BenchRequest& request);
Result<BenchReport> bench_functions(const BenchRequest& request);
Result<BenchReport> bench_ground(const BenchRequest& request);
Result<BenchReport> bench_materials(const BenchRequest& request);
Result<BenchReport> bench_pop(const BenchRequest& request);
Result<BenchReport> bench_quality(const BenchRequest& request);
Result<BenchReport> bench_resolve(const BenchRequest& request);
Result<BenchReport> bench_start(const BenchRequest& request);

[[nodiscard]] std::string to_text(const BenchReport& report);
[[nodiscard]] Json to_json(const BenchReport& report);

// --- shared steps ---
[[nodiscard]] double now_ms();  // steady
[[nodiscard]] double rounded(double value, int decimals);
struct Spread {
    double median = 0, p95 = 0, max = 0;
};
[[nodiscard]] Spread spread_of(std::vector<double> values);
[[nodiscard]] double percentile(std::vector<double> values, double share);  // 0 of none

// Without the writer's lock, so that several may look at one project.
Result<std::unique_ptr<Session>> open_read_only(const std::filesystem::path& project, SessionDesc desc);

// How the window draws while something moves, and at rest (editor/window/window_loop.cpp).
[[nodiscard]] FrameSettings moving_frame(float render_scale);
[[nodiscard]] FrameSettings still_frame();
// At rest with one texel between the axes, as direct shading takes it: what the two are compared with.
[[nodiscard]] FrameSettings trilinear_frame();

struct View {
    std::string name;
    Camera camera;
};
// Close ground; a slope looked along, three metres above it; from a height over the map to its far corner. Of
// a quick request the first only, or the request's own camera.
Result<std::vector<View>> views_of(const BenchRequest& request, Session& session);

struct MapPart {
    std::filesystem::path of;
    double part_m = 1024;  // side of the square copied from the middle; its spacings should divide 64 m
    double side_m = 1024;  // of the new map: the square is its south-west corner, the rest flat
    int layers = 0;        // > 0: a mosaic of so many, which repeat the files of the source's
    double mosaic_m = 4;   // a piece of it
};

// A project in a temporary folder, removed with the object.
class TemporaryProject {
  public:
    // A flat map of `side_m` with the layers of `like`, heights every metre; nothing is written, so every
    // page is all default.
    static Result<TemporaryProject> create_flat(const std::filesystem::path& like, double side_m);
    // A picture of heights imported, with the layers of `like` where its own have the same names.
    static Result<TemporaryProject> create_import(ImportRequest request, const std::filesystem::path& like);
    static Result<TemporaryProject> create_part(const MapPart& request);  // without operators
    static Result<TemporaryProject> create_copy(const std::filesystem::path& of);
    TemporaryProject(TemporaryProject&& other) noexcept;
    ~TemporaryProject();
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    TemporaryProject() = default;
    static Result<TemporaryProject> make_folder();
    std::filesystem::path path_;
};

// What one command costs: pages of every map, and milliseconds to the first changed and to the finished
// picture.
Result<Json> measure_edit(Session& session, const Camera& camera, int width, int height,
                          const Command& command);

// What pictures at rest are measured against: 64 samples a pixel, as 16 of grazing ground are 30 dB from
// them.
inline constexpr int kTruthSamples = 8;

// The reference, frame after frame: a session of its own renderer keeps its pages from one picture to the
// next.
class ReferenceView {
  public:
    static Result<ReferenceView> open(const std::filesystem::path& project, SessionDesc desc,
                                      int samples = kReferenceSupersample);
    Result<Picture> picture(const Camera& camera, int width, int height);

  private:
    ReferenceView(std::unique_ptr<Session> session, int samples)
        : session_(std::move(session)), samples_(samples) {}
    std::unique_ptr<Session> session_;
    int samples_;  // a pixel's side
};

// Milliseconds from submit to fence of the newest frame's resolve again, or of its floor; without settings of
// an empty frame.
Result<double> resolve_probe_ms(Session& session, const FrameSettings* settings,
                                Renderer::ResolveProbe probe);

}  // namespace loam::bench
