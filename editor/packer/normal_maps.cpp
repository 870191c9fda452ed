#include "editor/packer/normal_maps.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "shaders/texture/layer_math.h"

namespace loam {

namespace {

constexpr size_t kSureTexels = 32 * 32;  // of fewer a correlation is chance
constexpr double kSureCorrelation =
    0.15;                             // photographed grounds have 0.5–0.95, noise of JPEG blocks below 0.05
constexpr double kCloseSlope = 0.05;  // z below this counts as this: slopes stay finite
constexpr float kLengthTolerance = 0.1f;  // 8 bits and JPEG leave vectors within 0.05 of length 1

}  // namespace

double upward_green(const std::vector<glm::vec3>& normals, int width, int height) {
    if (width < 3 || height < 3) return 0;
    const auto slope = [&](int x, int y, int axis) {
        const glm::vec3& n = normals[static_cast<size_t>((y + height) % height) * static_cast<size_t>(width) +
                                     static_cast<size_t>((x + width) % width)];
        return -n[axis] / std::max(static_cast<double>(n.z), kCloseSlope);
    };
    double product = 0, first = 0, second = 0;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const double a = slope(x, y + 1, 0) - slope(x, y - 1, 0),
                         b = slope(x + 1, y, 1) - slope(x - 1, y, 1);
            product += a * b;
            first += a * a;
            second += b * b;
        }
    return first * second > 0 ? product / std::sqrt(first * second) : 0;
}

Result<std::vector<glm::vec3>> normals_of(const MapImage& map, std::optional<NormalDirection> told,
                                          std::optional<NormalDirection> named,
                                          std::vector<std::string>& notes,
                                          std::vector<std::string>& warnings) {
    // Two channels are x and y (as block compression leaves them), or grey and alpha: grey normals there are
    // none.
    if (map.channels.size() < 2) return error("the normal map has one channel, expected x, y and z");
    const size_t count = map.channels[0].v.size();
    const auto extremes = [&](size_t c) {
        const auto [low, high] = std::minmax_element(map.channels[c].v.begin(), map.channels[c].v.end());
        return std::pair(*low, *high);
    };
    const bool is_signed = map.is_float && (extremes(0).first < 0 || extremes(1).first < 0);
    if (is_signed) notes.push_back("the normal map holds negative numbers: taken as vectors");
    const bool has_z = map.channels.size() >= 3 && extremes(2).second > 0.01f;
    if (!has_z) notes.push_back("the normal map has no blue: z follows from x and y");
    // In integers the middle code is 0; floats are 0.5 + n / 2.
    const auto decoded = [&](float v) {
        if (is_signed) return v;
        return map.is_float ? 2 * v - 1 : shared::layer_decode_signed(v);
    };
    std::vector<glm::vec3> normals(count);
    size_t wrong_length = 0, below = 0, without = 0;
    for (size_t i = 0; i < count; ++i) {
        glm::vec3 n(decoded(map.channels[0].v[i]), decoded(map.channels[1].v[i]), 0);
        n.z = has_z ? decoded(map.channels[2].v[i]) : std::sqrt(std::max(0.0f, 1 - n.x * n.x - n.y * n.y));
        const bool is_below = has_z && n.z < 0;
        if (is_below) {
            n.z = 0;
            ++below;
        }
        const float length = glm::length(n);
        if (length < 1e-3f) {
            n = {0, 0, 1};
            ++without;
        } else {
            if (!is_below && std::abs(length - 1) > kLengthTolerance) ++wrong_length;
            n /= length;
        }
        normals[i] = n;
    }
    const auto say = [&](size_t many, std::string_view what) {
        if (many > 0) warnings.push_back(fmt::format("{} of {} normals {}", many, count, what));
    };
    say(wrong_length, "are not of length 1 and are normalised");
    say(below, "point below the ground and are laid flat on it");
    say(without, "have no length and stand upright");

    const double upward = upward_green(normals, map.width(), map.height());
    const bool sure = std::abs(upward) > kSureCorrelation && count >= kSureTexels;
    const NormalDirection seen = upward < 0 ? NormalDirection::dx : NormalDirection::gl;
    const auto title = [](NormalDirection d) { return d == NormalDirection::dx ? "DirectX" : "OpenGL"; };
    NormalDirection used = NormalDirection::gl;
    if (told) {
        used = *told;
    } else if (named) {
        used = *named;
    } else if (sure) {
        used = seen;
        notes.push_back(
            fmt::format("normals taken as {} (green {}): their slopes fit together so (correlation {:.2f})",
                        title(used), used == NormalDirection::dx ? "down" : "up", std::abs(upward)));
    } else {
        notes.push_back("neither name nor slopes say which way green points: taken as OpenGL, up");
    }
    if ((told || named) && sure && seen != used)
        warnings.push_back(fmt::format("the normals are {} {}, but their slopes fit {} (correlation {:.2f})",
                                       told ? "said to be" : "named", title(used), title(seen),
                                       std::abs(upward)));
    if (used == NormalDirection::dx)
        for (glm::vec3& n : normals) n.y = -n.y;
    return normals;
}

std::vector<glm::vec3> normals_of_heights(const Plane& height_texels) {
    const int size = height_texels.width;
    std::vector<glm::vec3> normals(height_texels.v.size());
    const auto h = [&](int x, int y) { return height_texels.at((x + size) % size, (y + size) % size); };
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            normals[static_cast<size_t>(y) * static_cast<size_t>(size) + static_cast<size_t>(x)] =
                glm::normalize(
                    glm::vec3(0.5f * (h(x - 1, y) - h(x + 1, y)), 0.5f * (h(x, y - 1) - h(x, y + 1)), 1));
    return normals;
}

}  // namespace loam
