// What the analysis of a feedback buffer costs: 32,640 values, on one core, from a picture-like buffer to one
// that no picture gives.
#include <algorithm>
#include <random>
#include <unordered_set>

#include "editor/bench/bench.h"
#include "runtime/texture/feedback.h"

namespace loam::bench {

namespace {

constexpr int kColumns = 240, kRows = 136, kRuns = 100;
constexpr int kImages = 255, kLog2Width = 8;  // as many and as wide as there can be
constexpr uint32_t kCapacity = 42 * 42;

FeedbackImages images() {
    FeedbackImages images;
    images.valid.fill(true);
    images.log2_width.fill(kLog2Width);
    for (int id = 1; id <= kImages; ++id) images.image[static_cast<size_t>(id)] = {true, id % 16, id / 16};
    return images;
}

uint32_t value(uint32_t mip, uint32_t id, uint32_t x, uint32_t y) {
    return mip << kFeedbackMipShift | id << 16 | y << 8 | x;
}

using Buffer = std::vector<uint32_t>;

// Bands of mips as on ground that goes to the horizon: coarser and narrower upwards, sky above.
Buffer coherent() {
    Buffer values;
    for (uint32_t row = 0; row < kRows; ++row)
        for (uint32_t column = 0; column < kColumns; ++column) {
            const uint32_t mip = std::min(6u, 480 / (row + 1)), id = 1 + column / 48 + 5 * (row / 34);
            values.push_back(row < 20 ? kNoTerrain : value(mip, id, column >> mip, row * 2 >> mip));
        }
    return values;
}

Buffer noise() {
    std::mt19937 random(3);
    Buffer values;
    for (int i = 0; i < kColumns * kRows; ++i) {
        const uint32_t mip = static_cast<uint32_t>(random() % 9), side = 256u >> mip;
        values.push_back(value(mip, static_cast<uint32_t>(random() % 256),
                               static_cast<uint32_t>(random()) % side,
                               static_cast<uint32_t>(random()) % side));
    }
    return values;
}

// A hundred and more far apart pages in every image.
Buffer all_different() {
    Buffer values;
    for (uint32_t i = 0; i < kColumns * kRows; ++i) {
        const uint32_t id = i % 256, k = i / 256;
        values.push_back(value(0, id, k % 16 * 16, k / 16 * 16));
    }
    return values;
}

Json measure(const char* name, const Buffer& values, bool exact, int runs) {
    const FeedbackImages known = images();
    std::vector<double> times;
    FeedbackResult result;
    for (int i = -2; i < runs; ++i) {
        const double start_ms = now_ms();
        result = analyse_feedback({.values = values,
                                   .images = &known,
                                   .layout = {.default_log2_width = kLog2Width, .default_log2_page = 0},
                                   .capacity_pages = kCapacity,
                                   .speed_m_s = exact ? 0.0 : 10.0,
                                   .exact = exact,
                                   .is_visible = [](const PageId&) { return false; }});
        if (i >= 0) times.push_back(now_ms() - start_ms);
    }
    return Json{{"values", name},
                {"every cell counts", exact},
                {"different", std::unordered_set<uint32_t>(values.begin(), values.end()).size()},
                {"requests", result.requests.size()},
                {"median ms", rounded(percentile(times, 0.5), 3)},
                {"p99 ms", rounded(percentile(times, 0.99), 3)},
                {"least ms", rounded(percentile(times, 0), 3)}};
}

}  // namespace

Result<BenchReport> bench_feedback(const BenchRequest& request) {
    BenchTable table{fmt::format("analysis of {} feedback values on one core", kColumns * kRows), {}};
    const int runs = request.quick ? 5 : kRuns;
    const std::pair<const char*, Buffer> buffers[] = {
        {"coherent", coherent()}, {"noise", noise()}, {"all different", all_different()}};
    for (const auto& [name, values] : buffers)
        for (const bool exact : {false, true}) table.rows.push_back(measure(name, values, exact, runs));
    return BenchReport{table};
}

}  // namespace loam::bench
