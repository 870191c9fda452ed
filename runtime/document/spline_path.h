// A splined decal's curve as straight segments. Bezier pieces are halved until the control polygon is flat:
// its inner points lie within the tolerance of the chord (in height, width and bank too), which bounds the
// curve's own distance, as a Bezier curve lies in the hull of its control points. All in doubles.
//
// Segments come in pieces of a few, each with a box of its own: what a long road touches is a row of small
// rectangles. A piece also lists every segment whose reach may meet its own, so that the nearest segment to
// any place within a piece's reach can be told from the piece alone: who draws a place follows from the
// place, not from what else is drawn.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "runtime/base/rect.h"
#include "runtime/document/ground_decal.h"

namespace loam {

struct SplineSegment {
    glm::dvec2 from_m{0}, direction{0};  // unit
    double length_m = 0;
    double start_m = 0;  // arc length from the beginning
    double z_from_m = 0, z_to_m = 0;
    double half_from_m = 0, half_to_m = 0;  // of the width
    double bank_from = 0, bank_to = 0;      // fall to the right, metres a metre
};

struct SplinePiece {
    uint32_t first = 0, count = 0;  // its own segments
    WorldRect line;                 // of its own segments' middle line
    std::vector<uint32_t> near;     // its own and all whose boxes, both grown by the texture's reach, overlap
};

class SplinePath {
  public:
    static constexpr double kTolerance_m = 0.01;
    // Of no length: no segments, and `length_m` is 0.
    explicit SplinePath(std::span<const SplinePoint> points, double tolerance_m = kTolerance_m);

    [[nodiscard]] std::span<const SplineSegment> segments() const { return segments_; }
    [[nodiscard]] std::span<const SplinePiece> pieces() const { return pieces_; }
    [[nodiscard]] double length_m() const { return length_m_; }
    [[nodiscard]] double half_width_m() const { return half_width_m_; }  // the largest

  private:
    void subdivide(const SplinePoint (&p)[4], double tolerance_m, int depth);
    void add_segment(const SplinePoint& a, const SplinePoint& b);
    void make_pieces();

    std::vector<SplineSegment> segments_;
    std::vector<SplinePiece> pieces_;
    double length_m_ = 0, half_width_m_ = 0, longest_m_ = 0;
};

// The Bezier control points of a smooth curve through places (Catmull-Rom), for whoever draws by clicking.
[[nodiscard]] std::vector<SplinePoint> bezier_through(std::span<const SplinePoint> places);
// The place at t of the piece that begins at control point 3 * piece: for tests and handles.
[[nodiscard]] SplinePoint bezier_at(std::span<const SplinePoint> points, size_t piece, double t);

}  // namespace loam
