#include "runtime/document/dirt.h"

#include <algorithm>
#include <cmath>

#include "runtime/document/byte_stream.h"

namespace loam {

namespace {

double area(const WorldRect& rect) {
    return rect.empty() ? 0 : rect.width() * rect.height();
}

// Joins neighbours in the list until nothing more joins. Looking back a few places only keeps it linear;
// pages come row by row, so that what touches is near.
void join_near(std::vector<WorldRect>& rects) {
    constexpr size_t kLookBack = 24;
    constexpr double kGrowth = 1.2;  // a joined rectangle may cover this much more than both
    size_t before = 0;
    do {
        before = rects.size();
        std::vector<WorldRect> joined;
        for (const WorldRect& rect : rects) {
            bool done = false;
            const size_t first = joined.size() > kLookBack ? joined.size() - kLookBack : 0;
            for (size_t i = joined.size(); i > first && !done; --i) {
                const WorldRect both = united(joined[i - 1], rect);
                done = area(both) <= kGrowth * (area(joined[i - 1]) + area(rect));
                if (done) joined[i - 1] = both;
            }
            if (!done) joined.push_back(rect);
        }
        rects.swap(joined);
    } while (rects.size() < before);
}

void join_best_pair(std::vector<WorldRect>& rects) {
    size_t best_a = 0, best_b = 1;
    double best = INFINITY;
    for (size_t a = 0; a < rects.size(); ++a)
        for (size_t b = a + 1; b < rects.size(); ++b) {
            const double growth = area(united(rects[a], rects[b])) - area(rects[a]) - area(rects[b]);
            if (growth < best) best = growth, best_a = a, best_b = b;
        }
    rects[best_a] = united(rects[best_a], rects[best_b]);
    rects.erase(rects.begin() + std::ptrdiff_t(best_b));
}

void write_rects(ByteWriter& writer, const std::vector<WorldRect>& rects) {
    writer.u32(uint32_t(rects.size()));
    for (const WorldRect& rect : rects)
        for (const double edge : {rect.min_x, rect.min_y, rect.max_x, rect.max_y}) writer.real(edge);
}

std::vector<WorldRect> read_rects(ByteReader& reader) {
    std::vector<WorldRect> rects;
    const uint32_t count = reader.u32();
    for (uint32_t i = 0; i < count && reader.ok(); ++i) {
        WorldRect rect;
        rect.min_x = reader.real();
        rect.min_y = reader.real();
        rect.max_x = reader.real();
        rect.max_y = reader.real();
        rects.push_back(rect);
    }
    return rects;
}

}  // namespace

void merge_rects(std::vector<WorldRect>& rects, size_t most) {
    std::erase_if(rects, [](const WorldRect& rect) { return rect.empty(); });
    join_near(rects);
    // Choosing the best of all pairs is cubic: thin out long lists by joining neighbours first.
    while (rects.size() > 256) {
        for (size_t i = 0; 2 * i < rects.size(); ++i)
            rects[i] = 2 * i + 1 < rects.size() ? united(rects[2 * i], rects[2 * i + 1]) : rects[2 * i];
        rects.resize((rects.size() + 1) / 2);
    }
    while (rects.size() > most) join_best_pair(rects);
}

void append_dirt(Dirt& to, const Dirt& more) {
    to.height.insert(to.height.end(), more.height.begin(), more.height.end());
    to.index.insert(to.index.end(), more.index.begin(), more.index.end());
    to.texture.insert(to.texture.end(), more.texture.begin(), more.texture.end());
    to.cutout.insert(to.cutout.end(), more.cutout.begin(), more.cutout.end());
    to.texture_size_m = std::max(to.texture_size_m, more.texture_size_m);
    to.layers |= more.layers;
}

void append_dirt(Dirt& to, const Operator& op) {
    if (!op.enabled) return;
    const auto append = [](std::vector<WorldRect>& rects, const std::vector<WorldRect>& more) {
        rects.insert(rects.end(), more.begin(), more.end());
    };
    append(to.height, op.height_rects());
    append(to.index, op.index_rects());
    append(to.texture, op.texture_rects());
    append(to.cutout, op.cutout_rects());
    to.texture_size_m = std::max(to.texture_size_m, op.texture_size_m());
}

std::vector<uint8_t> dirt_bytes(const Dirt& dirt) {
    ByteWriter writer;
    for (const auto* rects : {&dirt.height, &dirt.index, &dirt.texture}) write_rects(writer, *rects);
    writer.real(dirt.texture_size_m);
    write_rects(writer, dirt.cutout);
    return writer.take();
}

Result<Dirt> dirt_of(std::span<const uint8_t> bytes) {
    ByteReader reader(bytes);
    Dirt dirt;
    for (auto* rects : {&dirt.height, &dirt.index, &dirt.texture}) *rects = read_rects(reader);
    // Journals were once written without it, and then without cutouts.
    dirt.texture_size_m = reader.at_end() ? INFINITY : reader.real();
    if (!reader.at_end()) dirt.cutout = read_rects(reader);
    if (!reader.at_end() || std::isnan(dirt.texture_size_m))
        return error("damaged rectangles of a command in the journal");
    return dirt;
}

}  // namespace loam
