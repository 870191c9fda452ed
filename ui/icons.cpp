// Stroke programs: "M x y" moves, "L x y …" draws a polyline, "C x y r a0 a1" an arc (degrees, Y down), "D x
// y r" a filled disc, "W w" sets the stroke width. Coordinates at halves of the grid lie on pixel centres at
// 20 px, which is what keeps straight strokes crisp there.
#include "ui/icons.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>

#include "ui/geometry.h"

namespace loam::ui {
namespace {

constexpr float kGrid = 20.0f;
constexpr float kStroke = 1.5f;

struct Stroke {
    Vec2 a, b;
    float radius;  // half the width, in grid units
};

std::string_view program(Icon icon) {
    switch (icon) {
        case Icon::raise:
            return "M 2.5 16.5 L 5.5 16.5 C 10 16.5 4.5 180 360 M 14.5 16.5 L 17.5 16.5 M 10 8.5 L 10 2.5 M "
                   "7 5.3 L 10 2.3 13 5.3";
        case Icon::lower:
            return "M 2.5 11.5 L 5.5 11.5 C 10 11.5 4.5 180 0 M 14.5 11.5 L 17.5 11.5 M 10 2.5 L 10 10 M 7.2 "
                   "7.4 L 10 10.2 12.8 7.4";
        case Icon::smooth:
            return "M 2.5 8 L 4.5 4 6.5 8 8.5 4 10.5 8 12.5 4 14.5 8 16.5 4 17.5 6 M 2.5 14.5 C 6.25 14.5 "
                   "3.75 180 360 M 10 14.5 C 13.75 14.5 3.75 180 0";
        case Icon::flatten:
            return "M 2.5 13.5 L 17.5 13.5 M 10 2.5 L 10 9.5 M 7 6.8 L 10 9.8 13 6.8 M 5.5 17.5 L 14.5 17.5";
        case Icon::noise:
            return "M 2.5 12.5 L 5 8 7 11 10 3.5 12.5 13 14.5 9.5 17.5 14.5 M 2.5 17.5 L 17.5 17.5";
        case Icon::paint:
            return "M 16.8 3.2 L 9.3 10.7 M 16.8 3.2 L 11.3 12.7 M 9.3 10.7 L 11.3 12.7 M 9 11 C 6.6 13.6 "
                   "3.4 -60 90 M 11 13 C 6.8 12.8 4.2 0 90 M 6.6 17 L 3 17 M 3 17 C 2.2 13.6 3.5 20 76";
        case Icon::crater:
            return "M 1.5 12.5 L 4.5 7.5 6.5 7.5 C 10 7.5 3.7 180 0 M 13.5 7.5 L 15.5 7.5 18.5 12.5 M 1.5 "
                   "16.5 L 18.5 16.5";
        case Icon::footprints:
            return "M 4.3 9.2 L 3.5 5 C 5.5 4.8 2.0 175 370 M 7.5 5 L 7.1 9.2 L 4.3 9.2 M 4.5 11.4 L 6.9 "
                   "11.4 M 6.9 11.4 C 5.7 11.5 1.2 0 180 M 12.9 13.2 L 12.5 9 C 14.5 8.8 2.0 170 365 M 16.5 "
                   "9 L 15.7 13.2 L 12.9 13.2 M 13.1 15.4 L 15.5 15.4 M 15.5 15.4 C 14.3 15.5 1.2 0 180";
        case Icon::decal:
            return "M 10 2.5 L 17.5 10 10 17.5 2.5 10 10 2.5 M 6.5 10 L 10 6.5 M 8.2 12 L 12 8.2 M 10 13.5 L 13.5 10";
        case Icon::road:
            return "M 7.5 2.5 L 3 17.5 M 12.5 2.5 L 17 17.5 M 10 3 L 10 6 M 10 8.5 L 10 11.5 M 10 14 L 10 17.5";
        case Icon::stamp:
            return "M 3 17 L 17 17 M 3.5 13.5 L 3.5 11 8 11 8.4 8 M 16.5 13.5 L 16.5 11 12 11 11.6 8 M 3.5 "
                   "13.5 L "
                   "16.5 13.5 M 11.6 8 C 10 5.2 3.2 -60 240";
        case Icon::cutout:
            return "M 1.5 6.5 L 6.5 6.5 6.5 15.5 13.5 15.5 13.5 6.5 18.5 6.5";
        case Icon::event:
            return "M 10 1.8 L 10 5.5 M 10 14.5 L 10 18.2 M 1.8 10 L 5.5 10 M 14.5 10 L 18.2 10 M 4.2 4.2 L "
                   "6.6 6.6 "
                   "M 13.4 13.4 L 15.8 15.8 M 15.8 4.2 L 13.4 6.6 M 6.6 13.4 L 4.2 15.8 D 10 10 2.4";
        case Icon::undo:
            return "M 6.5 3.5 L 3 7 6.5 10.5 M 3 7 L 12 7 C 12 11.5 4.5 -90 90 M 12 16 L 7 16";
        case Icon::redo:
            return "M 13.5 3.5 L 17 7 13.5 10.5 M 17 7 L 8 7 C 8 11.5 4.5 270 90 M 8 16 L 13 16";
        case Icon::save:
            return "M 3.5 3.5 L 13.5 3.5 16.5 6.5 16.5 16.5 3.5 16.5 3.5 3.5 M 6.5 3.5 L 6.5 7.5 12.5 7.5 "
                   "12.5 3.5 M 6.5 16.5 L 6.5 11.5 13.5 11.5 13.5 16.5";
        case Icon::open:
            return "M 2.5 15.5 L 2.5 4.5 7.5 4.5 9.5 6.5 15.5 6.5 15.5 9 M 2.5 15.5 L 5 9.5 18 9.5 15.5 15.5 "
                   "2.5 15.5";
        case Icon::camera:
            return "M 2.5 6.5 L 6 6.5 7.5 4.5 12.5 4.5 14 6.5 17.5 6.5 17.5 15.5 2.5 15.5 2.5 6.5 C 10 10.8 "
                   "2.8 0 360";
        case Icon::layers:
            return "M 10 2.8 L 17.5 6.8 10 10.8 2.5 6.8 10 2.8 M 2.5 10.2 L 10 14.2 17.5 10.2 M 2.5 13.5 L "
                   "10 17.5 17.5 13.5";
        case Icon::eye:
            return "M 1.8 10 C 10 15 9.6 211 329 M 18.2 10 C 10 5 9.6 31 149 M 12.5 10 C 10 10 2.5 0 360";
        case Icon::eye_off:
            return "M 1.8 10 C 10 15 9.6 211 329 M 18.2 10 C 10 5 9.6 31 149 M 12.5 10 C 10 10 2.5 0 360 M "
                   "3.5 16.5 L 16.5 3.5";
        case Icon::search:
            return "C 8.5 8.5 5 0 360 M 12.2 12.2 L 17 17";
        case Icon::settings:
            return "M 2.5 5.5 L 10.5 5.5 M 15.5 5.5 L 17.5 5.5 M 2.5 14.5 L 4.5 14.5 M 9.5 14.5 L 17.5 14.5 "
                   "M 15 5.5 C 13 5.5 2.2 0 360 M 9 14.5 C 7 14.5 2.2 0 360";
        case Icon::play:
            return "M 6 3.8 L 16 10 6 16.2 6 3.8";
        case Icon::stop:
            return "M 5.5 5.5 L 14.5 5.5 14.5 14.5 5.5 14.5 5.5 5.5";
        case Icon::to_start:
            return "M 15.5 4 L 7 10 15.5 16 15.5 4 M 4.5 4 L 4.5 16";
        case Icon::plus:
            return "M 10 4 L 10 16 M 4 10 L 16 10";
        case Icon::minus:
            return "M 4 10 L 16 10";
        case Icon::trash:
            return "M 3.5 5.5 L 16.5 5.5 M 7.5 5.5 L 7.5 3.5 12.5 3.5 12.5 5.5 M 5.5 5.5 L 6 16.5 14 16.5 "
                   "14.5 5.5 M 8.5 8.5 L 8.5 13.5 M 11.5 8.5 L 11.5 13.5";
        case Icon::check:
            return "W 2 M 4 10.5 L 8.2 14.5 16 5.8";
        case Icon::cross:
            return "M 5 5 L 15 15 M 15 5 L 5 15";
        case Icon::chevron_right:
            return "M 7.5 5 L 12.5 10 7.5 15";
        case Icon::chevron_down:
            return "M 5 7.5 L 10 12.5 15 7.5";
        case Icon::sun:
            return "C 10 10 3.5 0 360 M 10 1.8 L 10 3.6 M 10 16.4 L 10 18.2 M 1.8 10 L 3.6 10 M 16.4 10 L "
                   "18.2 10 M 4.2 4.2 L 5.4 5.4 M 14.6 14.6 L 15.8 15.8 M 4.2 15.8 L 5.4 14.6 M 14.6 5.4 L "
                   "15.8 4.2";
        case Icon::info:
            return "C 10 10 7.3 0 360 M 10 9.5 L 10 14 D 10 6.5 1.0";
        case Icon::warning:
            return "M 10 3 L 17.8 16.5 2.2 16.5 10 3 M 10 8 L 10 12 D 10 14.2 0.9";
        case Icon::grid:
            return "M 3.5 3.5 L 16.5 3.5 16.5 16.5 3.5 16.5 3.5 3.5 M 10 3.5 L 10 16.5 M 3.5 10 L 16.5 10";
        case Icon::none:
        case Icon::count:
            break;
    }
    return {};
}

struct Reader {
    std::string_view rest;
    bool skip() {
        while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
        return !rest.empty();
    }
    bool number(float& value) {
        if (!skip()) return false;
        const auto [end, status] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
        if (status != std::errc()) return false;
        rest.remove_prefix(size_t(end - rest.data()));
        return true;
    }
};

std::vector<Stroke> parse(std::string_view text) {
    std::vector<Stroke> strokes;
    Reader in{text};
    Vec2 at;
    float radius = kStroke * 0.5f;
    while (in.skip()) {
        const char verb = in.rest.front();
        in.rest.remove_prefix(1);
        float v[5] = {};
        if (verb == 'M') {
            if (!in.number(at.x) || !in.number(at.y)) break;
        } else if (verb == 'W') {
            if (!in.number(v[0])) break;
            radius = v[0] * 0.5f;
        } else if (verb == 'L') {
            while (in.number(v[0]) && in.number(v[1])) {
                strokes.push_back({at, {v[0], v[1]}, radius});
                at = {v[0], v[1]};
            }
        } else if (verb == 'D') {
            if (!in.number(v[0]) || !in.number(v[1]) || !in.number(v[2])) break;
            strokes.push_back({{v[0], v[1]}, {v[0], v[1]}, v[2]});
        } else if (verb == 'C') {
            for (float& x : v)
                if (!in.number(x)) return strokes;
            constexpr int kPieces = 24;
            for (int i = 0; i <= kPieces; ++i) {
                const float t = v[3] + (v[4] - v[3]) * float(i) / float(kPieces);
                const float angle = t * std::numbers::pi_v<float> / 180.0f;
                const Vec2 p{v[0] + v[2] * std::cos(angle), v[1] + v[2] * std::sin(angle)};
                if (i > 0) strokes.push_back({at, p, radius});
                at = p;
            }
        } else {
            break;
        }
    }
    return strokes;
}

float segment_distance(Vec2 p, Vec2 a, Vec2 b) {
    const Vec2 d = b - a, q = p - a;
    const float length2 = d.x * d.x + d.y * d.y;
    const float t = length2 > 0 ? std::clamp((q.x * d.x + q.y * d.y) / length2, 0.0f, 1.0f) : 0.0f;
    return std::hypot(q.x - d.x * t, q.y - d.y * t);
}

}  // namespace

std::vector<uint8_t> rasterise_icon(Icon icon, int size_px) {
    std::vector<uint8_t> picture(size_t(size_px) * size_t(size_px));
    const std::vector<Stroke> strokes = parse(program(icon));
    const float scale = float(size_px) / kGrid;
    // A stroke is never thinner than 1.1 px, or small icons would fade.
    const float least = 0.55f / scale;
    for (int y = 0; y < size_px; ++y)
        for (int x = 0; x < size_px; ++x) {
            const Vec2 p{(float(x) + 0.5f) / scale, (float(y) + 0.5f) / scale};
            float distance = 1e9f;
            for (const Stroke& s : strokes)
                distance = std::min(distance, segment_distance(p, s.a, s.b) - std::max(s.radius, least));
            const float coverage = std::clamp(0.5f - distance * scale, 0.0f, 1.0f);
            picture[size_t(y) * size_t(size_px) + size_t(x)] = uint8_t(coverage * 255.0f + 0.5f);
        }
    return picture;
}

}  // namespace loam::ui
