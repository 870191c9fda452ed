#include "editor/recipe/layer_canvas.h"

#include <algorithm>
#include <cmath>

namespace loam::recipe {

Canvas::Canvas(int size)
    : size_(size * 2), mask_(size * 2 - 1), texels_(static_cast<size_t>(size_) * size_) {}

void Canvas::draw(const Stroke& s) {
    const float n = static_cast<float>(size_), texel = 1.0f / n;
    const int steps = std::max(2, static_cast<int>(s.length * n / 0.6f));
    float x = s.x, y = s.y, angle = s.angle;
    for (int k = 0; k < steps; ++k) {
        const float t = static_cast<float>(k) / static_cast<float>(steps - 1);
        const float c = std::cos(angle), sn = std::sin(angle);
        const float half = 0.5f * s.width * mix(1.0f, std::sqrt(1.0f - t), s.taper);
        const float height = mix(s.root_height, s.tip_height, t) + s.arch * 4 * t * (1 - t);
        const glm::vec3 colour = s.root_colour + (s.tip_colour - s.root_colour) * t;
        const int across = static_cast<int>(half * n / 0.6f);
        for (int a = -across; a <= across; ++a) {
            const float off = static_cast<float>(a) * 0.6f * texel, share = half > 0 ? off / half : 0.0f;
            Texel& to = at(static_cast<int>(std::floor((x - sn * off) * n)),
                           static_cast<int>(std::floor((y + c * off) * n)));
            // A folded blade is a shallow V seen from above; a twig is round.
            const float z = height + half * (s.keel > 0 ? s.keel * std::fabs(share)
                                                        : std::sqrt(std::max(0.0f, 1 - share * share)));
            if (z <= to.height) continue;
            to.height = z;
            to.albedo = colour * (s.keel > 0 ? 0.84f + 0.16f * std::fabs(share) + (a < 0 ? 0.0f : 0.12f)
                                             : 1.05f - 0.25f * share * share);
            to.gloss = s.gloss;
        }
        x += c * s.length / static_cast<float>(steps), y += sn * s.length / static_cast<float>(steps);
        angle += s.bend / static_cast<float>(steps);
    }
}

void Canvas::draw(const Stone& s) {
    constexpr int kMostCuts = 9, kFacets = 5;
    Chance chance(s.seed);
    const int cuts = 5 + static_cast<int>(chance.unit() * 4.99f);
    float cx[kMostCuts], cy[kMostCuts], far[kMostCuts], bevel[kMostCuts];
    const float turn = chance.range(0, 6.283f), stretch = chance.range(0.65f, 1.0f),
                axis = chance.range(0, 3.1416f);
    for (int k = 0; k < cuts; ++k) {
        const float a =
            turn + 6.2832f * (static_cast<float>(k) + 0.35f * chance.bell()) / static_cast<float>(cuts);
        cx[k] = std::cos(a), cy[k] = std::sin(a);
        const float along = std::cos(a - axis);
        far[k] = s.radius * mix(stretch, 1.0f, along * along) * chance.range(0.7f, 0.9f);
        bevel[k] = chance.range(0.8f, 3.0f);
    }
    float fx[kFacets], fy[kFacets], fz[kFacets];
    for (int k = 0; k < kFacets; ++k) {
        fx[k] = chance.bell() * 0.55f, fy[k] = chance.bell() * 0.55f;
        fz[k] = s.thickness * chance.range(0.75f, 1.1f);
    }
    const float grain = 34.0f / std::max(s.radius * 40, 1.0f);
    around(s.x, s.y, s.radius, [&](float dx, float dy, Texel& to) {
        const float ragged = s.radius * 0.07f * noise(dx * grain * 40, dy * grain * 40, s.seed);
        float edge = 1e9f, side = 1e9f;
        for (int k = 0; k < cuts; ++k) {
            const float inside = far[k] - (dx * cx[k] + dy * cy[k]) + ragged;
            edge = std::min(edge, inside);
            side = std::min(side, inside * bevel[k]);
        }
        const float round = s.radius * s.radius * 0.72f - dx * dx - dy * dy;
        if (s.roundness > 0.5f ? round <= 0 : edge <= 0) return;
        float top = 1e9f;
        int facet = 0;
        for (int k = 0; k < kFacets; ++k) {
            const float z = fz[k] + fx[k] * dx + fy[k] * dy;
            if (z < top) top = z, facet = k;
        }
        float z = std::min(top, side);
        if (s.roundness > 0.5f) z = s.thickness * std::sqrt(std::max(round, 0.0f)) / (0.85f * s.radius);
        z = s.bottom + z + s.radius * 0.025f * noise(dx * 160, dy * 160, s.seed + 3);
        if (z <= to.height) return;
        to.height = z;
        // Facets weather differently; edges are worn light.
        const float tone = 0.9f + 0.04f * static_cast<float>(facet) +
                           0.13f * fractal(dx * 90, dy * 90, s.seed + 5, 3) +
                           0.16f * (1 - smooth_step(0.0f, 0.12f * s.radius, std::fabs(top - side)));
        to.albedo = s.colour * std::max(tone, 0.3f);
        to.gloss = s.gloss;
    });
}

void Canvas::draw(const Leaf& l) {
    const float c = std::cos(l.angle), sn = std::sin(l.angle), half = 0.5f * l.length;
    Chance chance(l.seed);
    const float tilt_x = chance.bell() * 0.25f, tilt_y = chance.bell() * 0.25f, phase = chance.unit() * 6.28f;
    around(l.x, l.y, half * 1.1f, [&](float dx, float dy, Texel& to) {
        const float u = (dx * c + dy * sn) / half;
        const float v = (dy * c - dx * sn) / (0.5f * l.width);
        if (u < -1 || u > 1) return;
        float outline = std::pow(std::max(1 - u * u, 0.0f), 0.6f) * (1.0f - 0.25f * u);
        if (l.lobes > 0)
            outline *=
                0.62f +
                0.38f * std::fabs(std::cos((u * l.lobes + 0.3f) * 3.1416f + (v > 0 ? phase * 0.1f : 0.0f)));
        outline += 0.05f * noise(u * 7, v > 0 ? 1.5f : 8.5f, l.seed);
        const float a = std::fabs(v);
        if (a > outline) return;
        const float rib = smooth_step(0.07f, 0.0f, a);
        const float vein = std::fabs(std::sin((u * 5.0f - a * 1.6f) * 3.1416f));
        const float fold =
            l.curl * 0.5f * l.width * (v * v + 0.4f * u * u + 0.3f * std::sin(u * 4 + phase) * v);
        const float z = l.bottom + (dx * tilt_x + dy * tilt_y) + fold + 0.015f * l.width * (vein - rib);
        if (z <= to.height) return;
        to.height = z;
        const float tone = 0.86f + 0.25f * fractal(dx * 120, dy * 120, l.seed + 2, 3) + 0.12f * rib +
                           0.07f * smooth_step(0.25f, 0.0f, vein) -
                           0.22f * smooth_step(0.75f, 1.0f, a / std::max(outline, 0.01f));
        to.albedo = l.colour * std::max(tone, 0.25f);
        to.gloss = 0.28f;
    });
}

}  // namespace loam::recipe
