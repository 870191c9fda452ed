#include "editor/packer/formats.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include <glm/geometric.hpp>

#include "editor/packer/error_metrics.h"
#include "runtime/base/job_queue.h"
#include "runtime/base/srgb.h"
#include "shaders/texture/bc3.h"
#include "shaders/texture/layer_math.h"

namespace loam {

namespace {

using shared::vec2;
using shared::vec3;

constexpr int kTexels = 16;
constexpr vec3 kEvenWeights(1.0f);

struct Block {
    vec3 color[kTexels];  // sRGB-encoded
    vec3 normal[kTexels];
    float gloss[kTexels], occlusion[kTexels], reveal[kTexels], metalness[kTexels];
};

struct Survey {
    std::vector<Block> blocks;
    int block_count = 0;
    float normal_scale = 1;  // the largest coordinate of the hemi-octahedral square
};

Survey survey_of(const LayerPlanes& planes) {
    Survey survey;
    const int side = planes.size_texels / 4;
    survey.block_count = side * side;
    const int step = std::max(
        1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(survey.block_count) / kMostBlocks))));
    for (int by = 0; by < side; by += step)
        for (int bx = 0; bx < side; bx += step) {
            Block& block = survey.blocks.emplace_back();
            for (int k = 0; k < kTexels; ++k) {
                const size_t i =
                    static_cast<size_t>(by * 4 + k / 4) * static_cast<size_t>(planes.size_texels) +
                    static_cast<size_t>(bx * 4 + k % 4);
                for (int c = 0; c < 3; ++c) block.color[k][c] = srgb_of_linear(planes.albedo[i][c]);
                block.normal[k] = planes.normal[i];
                block.gloss[k] = planes.gloss[i];
                block.occlusion[k] = planes.occlusion[i];
                block.reveal[k] = planes.reveal[i];
                block.metalness[k] = planes.metalness[i];
            }
        }
    float largest = 0;
    for (const glm::vec3& n : planes.normal) {
        const vec2 e = shared::layer_encode_hemioct(n);
        largest = std::max({largest, std::abs(e.x), std::abs(e.y)});
    }
    survey.normal_scale = largest > 0 ? largest : 1.0f;
    return survey;
}

float rounded(float v, float levels = 255.0f) {
    return std::round(std::clamp(v, 0.0f, 1.0f) * levels) / levels;
}

// --- ways to write a normal as two numbers 0…1 ---

enum class NormalCode { xy, hemioct, scaled, quadratic };
constexpr std::array kNormalCodes = {NormalCode::xy, NormalCode::hemioct, NormalCode::scaled,
                                     NormalCode::quadratic};

std::string_view code_name(NormalCode code) {
    switch (code) {
        case NormalCode::xy:
            return "x, y";
        case NormalCode::hemioct:
            return "hemi-octahedral";
        case NormalCode::scaled:
            return "hemi-octahedral, scaled";
        case NormalCode::quadratic:
            return "hemi-octahedral, scaled, quadratic";
    }
    return "";
}

vec2 encoded(vec3 normal, NormalCode code, float scale) {
    vec2 e = code == NormalCode::xy ? vec2(normal.x, normal.y) : shared::layer_encode_hemioct(normal);
    if (code == NormalCode::scaled || code == NormalCode::quadratic) e /= scale;
    if (code == NormalCode::quadratic)
        e = {shared::layer_encode_quadratic(e.x), shared::layer_encode_quadratic(e.y)};
    return {shared::layer_encode_signed(e.x), shared::layer_encode_signed(e.y)};
}

vec3 decoded(vec2 stored, NormalCode code, float scale) {
    vec2 e(shared::layer_decode_signed(stored.x), shared::layer_decode_signed(stored.y));
    if (code == NormalCode::quadratic)
        e = {shared::layer_decode_quadratic(e.x), shared::layer_decode_quadratic(e.y)};
    if (code == NormalCode::scaled || code == NormalCode::quadratic) e *= scale;
    return code == NormalCode::xy ? shared::layer_normal_of_xy(e) : shared::layer_decode_hemioct(e);
}

// --- measuring ---

// Errors of all texels of the sample; `body` writes those of a block.
std::vector<float> errors_of(const Survey& survey, const std::function<void(const Block&, float*)>& body) {
    std::vector<float> errors(survey.blocks.size() * kTexels);
    parallel_ranges(static_cast<int>(survey.blocks.size()), 256, [&](int begin, int end) {
        for (int b = begin; b < end; ++b)
            body(survey.blocks[static_cast<size_t>(b)], &errors[static_cast<size_t>(b) * kTexels]);
    });
    return errors;
}

FormatRow row_of(PackChannel channel, std::string format, double bytes_texel, std::vector<float> errors) {
    FormatRow row{.channel = channel, .format = std::move(format), .bytes_texel = bytes_texel};
    row.error = summary_of(std::move(errors));
    const ErrorLimit limit = limit_of(channel);
    row.fits = row.error.mean <= limit.mean && row.error.p95 <= limit.p95;
    return row;
}

using ColorCode = std::function<void(const vec3 (&)[kTexels], vec3 (&)[kTexels])>;

FormatRow color_row(const Survey& survey, std::string format, double bytes_texel, const ColorCode& code) {
    std::vector<float> squares(survey.blocks.size() * kTexels);
    std::vector<float> differences = errors_of(survey, [&](const Block& block, float* out) {
        vec3 shown[kTexels];
        code(block.color, shown);
        float* square = &squares[static_cast<size_t>(&block - survey.blocks.data()) * kTexels];
        for (int k = 0; k < kTexels; ++k) {
            const vec3 rest = shown[k] - block.color[k];
            square[k] = dot(rest, rest) / 3;
            out[k] = delta_e(block.color[k], shown[k]);
        }
    });
    FormatRow row = row_of(PackChannel::color, std::move(format), bytes_texel, std::move(differences));
    row.psnr_db = psnr_of(squares);
    return row;
}

void add_colors(const Survey& survey, std::vector<FormatRow>& rows) {
    rows.push_back(color_row(survey, "BC1", 0.5, [](const vec3(&given)[kTexels], vec3(&shown)[kTexels]) {
        const auto block = shared::bc1_encode(given, kEvenWeights);
        for (int k = 0; k < kTexels; ++k) shown[k] = shared::bc1_decode(block, k);
    }));
    rows.push_back(color_row(survey, "R5G6B5", 2, [](const vec3(&given)[kTexels], vec3(&shown)[kTexels]) {
        for (int k = 0; k < kTexels; ++k) shown[k] = shared::bc1_unpack565(shared::bc1_pack565(given[k]));
    }));
    rows.push_back(
        color_row(survey, "RGB of RGBA8", 3, [](const vec3(&given)[kTexels], vec3(&shown)[kTexels]) {
            for (int k = 0; k < kTexels; ++k)
                shown[k] = {rounded(given[k].x), rounded(given[k].y), rounded(given[k].z)};
        }));
}

void through_bc4(const float (&given)[kTexels], float (&shown)[kTexels]) {
    const auto block = shared::bc4_encode(given);
    for (int k = 0; k < kTexels; ++k) shown[k] = shared::bc4_decode(block, k);
}

void add_normals(const Survey& survey, std::vector<FormatRow>& rows) {
    for (const bool compressed : {true, false})
        for (const NormalCode code : kNormalCodes)
            rows.push_back(
                row_of(PackChannel::normal, fmt::format("{} {}", compressed ? "BC5" : "RG8", code_name(code)),
                       compressed ? 1 : 2, errors_of(survey, [&](const Block& block, float* out) {
                           float first[kTexels], second[kTexels];
                           for (int k = 0; k < kTexels; ++k) {
                               const vec2 e = encoded(block.normal[k], code, survey.normal_scale);
                               first[k] = compressed ? e.x : rounded(e.x);
                               second[k] = compressed ? e.y : rounded(e.y);
                           }
                           if (compressed) {
                               float shown[kTexels];
                               through_bc4(first, shown);
                               std::copy(std::begin(shown), std::end(shown), first);
                               through_bc4(second, shown);
                               std::copy(std::begin(shown), std::end(shown), second);
                           }
                           for (int k = 0; k < kTexels; ++k)
                               out[k] = angle_deg(block.normal[k],
                                                  decoded({first[k], second[k]}, code, survey.normal_scale));
                       })));
}

void add_scalar(const Survey& survey, PackChannel channel, const float (Block::*values)[kTexels],
                std::vector<FormatRow>& rows) {
    const float first = (survey.blocks[0].*values)[0];
    rows.push_back(row_of(channel, "constant", 0, errors_of(survey, [&](const Block& block, float* out) {
                              for (int k = 0; k < kTexels; ++k) out[k] = std::abs((block.*values)[k] - first);
                          })));
    rows.push_back(row_of(channel, "BC4", 0.5, errors_of(survey, [&](const Block& block, float* out) {
                              float shown[kTexels];
                              through_bc4(block.*values, shown);
                              for (int k = 0; k < kTexels; ++k)
                                  out[k] = std::abs((block.*values)[k] - shown[k]);
                          })));
    rows.push_back(row_of(channel, "R8", 1, errors_of(survey, [&](const Block& block, float* out) {
                              for (int k = 0; k < kTexels; ++k)
                                  out[k] = std::abs((block.*values)[k] - rounded((block.*values)[k]));
                          })));
}

// Gloss, normal, occlusion in the colour, the normal's other half in the alpha.
std::vector<FormatRow> packed_rows(const Survey& survey, NormalCode code) {
    const size_t count = survey.blocks.size() * kTexels;
    std::vector<float> gloss(count), normal(count), occlusion(count);
    parallel_ranges(static_cast<int>(survey.blocks.size()), 256, [&](int begin, int end) {
        for (int b = begin; b < end; ++b) {
            const Block& block = survey.blocks[static_cast<size_t>(b)];
            shared::vec4 given[kTexels];
            for (int k = 0; k < kTexels; ++k) {
                const vec2 e = encoded(block.normal[k], code, survey.normal_scale);
                given[k] = {block.gloss[k], e.x, block.occlusion[k], e.y};
            }
            const auto bits = shared::bc3_encode(given, kEvenWeights);
            for (int k = 0; k < kTexels; ++k) {
                const shared::vec4 shown = shared::bc3_decode(bits, k);
                const size_t at = static_cast<size_t>(b) * kTexels + static_cast<size_t>(k);
                gloss[at] = std::abs(shown.x - block.gloss[k]);
                occlusion[at] = std::abs(shown.z - block.occlusion[k]);
                normal[at] =
                    angle_deg(block.normal[k], decoded({shown.y, shown.w}, code, survey.normal_scale));
            }
        }
    });
    const std::string format = fmt::format("BC3 of gloss, normal, occlusion; {}", code_name(code));
    return {row_of(PackChannel::normal, format, 1, std::move(normal)),
            row_of(PackChannel::gloss, format, 0, std::move(gloss)),
            row_of(PackChannel::occlusion, format, 0, std::move(occlusion))};
}

bool all_fit(const std::vector<FormatRow>& rows) {
    return std::all_of(rows.begin(), rows.end(), [](const FormatRow& row) { return row.fits; });
}

// The cheapest that fits, of equal ones the nearest; where none fits, the nearest of all.
FormatRow* choose(std::vector<FormatRow>& rows, PackChannel channel) {
    FormatRow* best = nullptr;
    const auto before = [](const FormatRow& a, const FormatRow& b) {
        if (a.fits != b.fits) return a.fits;
        if (a.fits && a.bytes_texel != b.bytes_texel) return a.bytes_texel < b.bytes_texel;
        return a.error.mean < b.error.mean;
    };
    for (FormatRow& row : rows)
        if (row.channel == channel && (!best || before(row, *best))) best = &row;
    return best;
}

}  // namespace

std::string_view channel_name(PackChannel channel) {
    constexpr std::string_view names[] = {"colour", "normal", "gloss", "occlusion", "reveal", "metalness"};
    return names[static_cast<size_t>(channel)];
}

std::string_view channel_unit(PackChannel channel) {
    return channel == PackChannel::color ? "ΔE" : channel == PackChannel::normal ? "°" : "";
}

ErrorLimit limit_of(PackChannel channel) {
    switch (channel) {
        case PackChannel::color:
            return {2.3, 6};
        case PackChannel::normal:
            return {2, 5};
        case PackChannel::gloss:
        case PackChannel::occlusion:
            return {0.015, 0.04};
        case PackChannel::reveal:
            return {0.02, 0.06};  // moves an edge within its softness of 0.25
        case PackChannel::metalness:
            return {0.005, 0.02};
    }
    return {0, 0};
}

FormatTable measure_formats(const LayerPlanes& planes) {
    const Survey survey = survey_of(planes);
    FormatTable table;
    table.normal_scale = survey.normal_scale;
    table.blocks = survey.block_count;
    table.sampled_blocks = static_cast<int>(survey.blocks.size());
    add_colors(survey, table.rows);
    add_normals(survey, table.rows);
    add_scalar(survey, PackChannel::gloss, &Block::gloss, table.rows);
    add_scalar(survey, PackChannel::occlusion, &Block::occlusion, table.rows);
    add_scalar(survey, PackChannel::reveal, &Block::reveal, table.rows);
    add_scalar(survey, PackChannel::metalness, &Block::metalness, table.rows);
    for (const NormalCode code : {NormalCode::xy, NormalCode::quadratic}) {
        std::vector<FormatRow> rows = packed_rows(survey, code);
        if (table.packed.empty() || rows[0].error.mean < table.packed[0].error.mean)
            table.packed = std::move(rows);
    }

    constexpr PackChannel kAlone[] = {PackChannel::color, PackChannel::reveal, PackChannel::metalness};
    constexpr PackChannel kPacked[] = {PackChannel::normal, PackChannel::gloss, PackChannel::occlusion};
    std::vector<FormatRow*> chosen;
    for (const PackChannel channel : kAlone) chosen.push_back(choose(table.rows, channel));
    double separate = 0;
    for (const PackChannel channel : kPacked) separate += choose(table.rows, channel)->bytes_texel;
    table.packed_fits = all_fit(table.packed);
    if (table.packed_fits && separate > 1)
        for (FormatRow& row : table.packed) chosen.push_back(&row);
    else
        for (const PackChannel channel : kPacked) chosen.push_back(choose(table.rows, channel));
    for (FormatRow* row : chosen) {
        row->chosen = true;
        table.bytes_after += row->bytes_texel;
    }
    const bool has_metal =
        std::any_of(planes.metalness.begin(), planes.metalness.end(), [](float m) { return m > 0; });
    table.bytes_before = has_metal ? 9 : 8;
    return table;
}

}  // namespace loam
