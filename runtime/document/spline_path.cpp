#include "runtime/document/spline_path.h"

#include <algorithm>
#include <cmath>

namespace loam {

namespace {

constexpr int kMaxDepth = 16;           // of halving a cubic
constexpr double kShortest_m = 1.0e-6;  // shorter chords are points
constexpr double kLongest_m = 16;       // a segment, or four widths: so that boxes stay tight on diagonals
constexpr double kWidestPiece_m = 48;   // a piece's box, or eight widths
constexpr uint32_t kMostSegments = 16;  // a piece

SplinePoint middle(const SplinePoint& a, const SplinePoint& b) {
    return {(a.x_m + b.x_m) * 0.5, (a.y_m + b.y_m) * 0.5, (a.z_m + b.z_m) * 0.5,
            (a.width_m + b.width_m) * 0.5, (a.roll_rad + b.roll_rad) * 0.5};
}

// How far p is from where the chord has its share t, sideways, in height, in half width and, by its bank, in
// height at its edge.
double distance_from_chord(const SplinePoint& p, const SplinePoint& a, const SplinePoint& b, double share) {
    const double dx = b.x_m - a.x_m, dy = b.y_m - a.y_m, squared = dx * dx + dy * dy;
    const double px = p.x_m - a.x_m, py = p.y_m - a.y_m;
    const double along = squared > 0 ? std::clamp((px * dx + py * dy) / squared, 0.0, 1.0) : 0.0;
    const double aside = std::hypot(px - along * dx, py - along * dy);
    // Height and width follow the share of the length, so a control point's own place along the chord counts.
    const double at = squared > 0 ? along : share;
    const double bank_from = std::tan(a.roll_rad), bank_to = std::tan(b.roll_rad);
    return std::max(
        {aside, std::abs(p.z_m - (a.z_m + at * (b.z_m - a.z_m))),
         std::abs(p.width_m - (a.width_m + at * (b.width_m - a.width_m))) * 0.5,
         std::abs(std::tan(p.roll_rad) - (bank_from + at * (bank_to - bank_from))) * p.width_m * 0.5});
}

}  // namespace

SplinePath::SplinePath(std::span<const SplinePoint> points, double tolerance_m) {
    double widest = 0;
    for (const SplinePoint& p : points) widest = std::max(widest, p.width_m);
    longest_m_ = std::max(kLongest_m, 4 * widest);
    for (size_t i = 0; i + 3 < points.size(); i += 3)
        subdivide({points[i], points[i + 1], points[i + 2], points[i + 3]}, tolerance_m, 0);
    make_pieces();
}

void SplinePath::subdivide(const SplinePoint (&p)[4], double tolerance_m, int depth) {
    const double chord = std::hypot(p[3].x_m - p[0].x_m, p[3].y_m - p[0].y_m);
    const bool flat = std::max(distance_from_chord(p[1], p[0], p[3], 1.0 / 3),
                               distance_from_chord(p[2], p[0], p[3], 2.0 / 3)) <= tolerance_m;
    if (depth == kMaxDepth || (flat && chord <= longest_m_)) {
        add_segment(p[0], p[3]);
        return;
    }
    const SplinePoint a = middle(p[0], p[1]), b = middle(p[1], p[2]), c = middle(p[2], p[3]);
    const SplinePoint ab = middle(a, b), bc = middle(b, c), at = middle(ab, bc);
    subdivide({p[0], a, ab, at}, tolerance_m, depth + 1);
    subdivide({at, bc, c, p[3]}, tolerance_m, depth + 1);
}

void SplinePath::add_segment(const SplinePoint& a, const SplinePoint& b) {
    const glm::dvec2 from(a.x_m, a.y_m), to(b.x_m, b.y_m);
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    half_width_m_ = std::max({half_width_m_, a.width_m * 0.5, b.width_m * 0.5});
    if (!(length > kShortest_m)) return;
    segments_.push_back({from, (to - from) / length, length, length_m_, a.z_m, b.z_m, a.width_m * 0.5,
                         b.width_m * 0.5, std::tan(a.roll_rad), std::tan(b.roll_rad)});
    length_m_ += length;
}

void SplinePath::make_pieces() {
    const double widest = std::max(kWidestPiece_m, 16 * half_width_m_);
    for (uint32_t i = 0; i < segments_.size(); ++i) {
        const SplineSegment& s = segments_[i];
        const glm::dvec2 to = s.from_m + s.direction * s.length_m;
        const WorldRect box{std::min(s.from_m.x, to.x), std::min(s.from_m.y, to.y),
                            std::max(s.from_m.x, to.x), std::max(s.from_m.y, to.y)};
        const WorldRect both = pieces_.empty() ? box : united(pieces_.back().line, box);
        if (pieces_.empty() || pieces_.back().count == kMostSegments ||
            std::max(both.width(), both.height()) > widest)
            pieces_.push_back({i, 0, box, {}});
        ++pieces_.back().count;
        pieces_.back().line = united(pieces_.back().line, box);
    }
    for (SplinePiece& piece : pieces_)
        for (const SplinePiece& other : pieces_) {
            if (!piece.line.grown(2 * half_width_m_).overlaps(other.line)) continue;
            for (uint32_t i = other.first; i < other.first + other.count; ++i) piece.near.push_back(i);
        }
}

std::vector<SplinePoint> bezier_through(std::span<const SplinePoint> places) {
    std::vector<SplinePoint> points;
    if (places.size() < 2) return points;
    const auto tangent = [&](size_t i, double SplinePoint::*member) {
        const SplinePoint &before = places[i > 0 ? i - 1 : 0],
                          &after = places[std::min(i + 1, places.size() - 1)];
        return (after.*member - before.*member) / 6;
    };
    const auto moved = [&](size_t i, double sign) {
        SplinePoint p = places[i];
        for (const auto member : {&SplinePoint::x_m, &SplinePoint::y_m, &SplinePoint::z_m})
            p.*member += sign * tangent(i, member);
        return p;
    };
    points.push_back(places[0]);
    for (size_t i = 0; i + 1 < places.size(); ++i) {
        points.push_back(moved(i, 1));
        points.push_back(moved(i + 1, -1));
        points.push_back(places[i + 1]);
    }
    return points;
}

SplinePoint bezier_at(std::span<const SplinePoint> points, size_t piece, double t) {
    const SplinePoint* p = points.data() + 3 * piece;
    const double u = 1 - t, w[4] = {u * u * u, 3 * u * u * t, 3 * u * t * t, t * t * t};
    SplinePoint at{0, 0, 0, 0, 0};
    for (int i = 0; i < 4; ++i) {
        at.x_m += w[i] * p[i].x_m;
        at.y_m += w[i] * p[i].y_m;
        at.z_m += w[i] * p[i].z_m;
        at.width_m += w[i] * p[i].width_m;
        at.roll_rad += w[i] * p[i].roll_rad;
    }
    return at;
}

}  // namespace loam
