// The texture packer's parts: names, resampling, normals, metrics, formats.
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <glm/geometric.hpp>

#include "editor/packer/error_metrics.h"
#include "editor/packer/map_files.h"
#include "editor/packer/normal_maps.h"
#include "runtime/base/srgb.h"

namespace loam {
namespace {

// --- names ---

TEST(MapNames, TheLastWordThatMeansAMapDecides) {
    const struct {
        const char* stem;
        MapKind kind;
    } expected[] = {
        {"Ground037_1K-JPG_Color", MapKind::color},
        {"aerial_beach_01_diff_1k", MapKind::color},
        {"albedo", MapKind::color},
        {"T_Rock_BaseColor", MapKind::color},
        {"rough_metal_plate_diff_2k", MapKind::color},
        {"Ground037_1K-PNG_NormalGL", MapKind::normal},
        {"aerial_beach_01_nor_dx_1k", MapKind::normal},
        {"normal", MapKind::normal},
        {"snow_02_rough_1k", MapKind::roughness},
        {"rock_Roughness", MapKind::roughness},
        {"cliff_gloss", MapKind::gloss},
        {"wall-Smoothness", MapKind::gloss},
        {"Ground037_AmbientOcclusion", MapKind::occlusion},
        {"sand_AO", MapKind::occlusion},
        {"Ground037_Displacement", MapKind::height},
        {"snow_02_disp_1k", MapKind::height},
        {"height", MapKind::height},
        {"plate_Metalness", MapKind::metalness},
        {"plate_spec", MapKind::specular},
        {"moss_reveal", MapKind::reveal},
    };
    for (const auto& [stem, kind] : expected) {
        const NameMeaning meaning = meaning_of_name(stem);
        ASSERT_TRUE(meaning.kind) << stem;
        EXPECT_EQ(*meaning.kind, kind) << stem;
    }
    EXPECT_TRUE(meaning_of_name("leaves_Opacity").ignored);
    for (const char* stem : {"readme", "", "Ground037", "aorta", "colors_of_autumn2"})
        EXPECT_FALSE(meaning_of_name(stem).kind) << stem;
}

TEST(MapNames, DirectionsOfNormals) {
    EXPECT_EQ(meaning_of_name("a_NormalGL").direction, NormalDirection::gl);
    EXPECT_EQ(meaning_of_name("a_nor_gl_4k").direction, NormalDirection::gl);
    EXPECT_EQ(meaning_of_name("a_NormalDX").direction, NormalDirection::dx);
    EXPECT_EQ(meaning_of_name("a_normal_DirectX").direction, NormalDirection::dx);
    EXPECT_EQ(meaning_of_name("a_normaldx").direction, NormalDirection::dx);
    EXPECT_FALSE(meaning_of_name("a_normal").direction);
}

// --- resampling ---

Plane noise(int width, int height, uint32_t seed) {
    Plane plane{width, height, std::vector<float>(size_t(width) * size_t(height))};
    std::mt19937 random(seed);
    for (float& v : plane.v) v = float(random() % 1001) / 1000;
    return plane;
}

double mean_of(const Plane& plane) {
    double sum = 0;
    for (const float v : plane.v) sum += v;
    return sum / double(plane.v.size());
}

TEST(Resampled, EqualSizesAreEqualAndOthersKeepTheMean) {
    const Plane plane = noise(64, 64, 1);
    EXPECT_EQ(resampled(plane, 1, 1, 64).v, plane.v);
    EXPECT_NE(resampled(plane, 1, 1, 32).v, plane.v);
    for (const int size : {4, 16, 32, 128})
        EXPECT_NEAR(mean_of(resampled(plane, 1, 1, size)), mean_of(plane), 1e-5) << size;
    const Plane half = resampled(noise(64, 32, 2), 1, 2, 64);
    for (size_t i = 0; i < 64 * 32; ++i) ASSERT_EQ(half.v[i], half.v[i + 64 * 32]);
}

TEST(Resampled, OneTexelAndThreeByFive) {
    const Plane one = resampled(Plane{1, 1, {0.3f}}, 1, 1, 16);
    for (const float v : one.v) EXPECT_NEAR(v, 0.3f, 1e-6f);
    const Plane odd = resampled(noise(3, 5, 3), 1, 1, 8);
    for (const float v : odd.v) EXPECT_TRUE(v >= 0 && v <= 1);
    EXPECT_NEAR(mean_of(odd), mean_of(noise(3, 5, 3)), 0.05);
}

TEST(Resampled, WrapsOverTheEdges) {
    Plane spike{8, 8, std::vector<float>(64, 0.0f)};
    spike.v[0] = 1;
    const Plane fine = resampled(spike, 1, 1, 16);
    EXPECT_GT(fine.at(15, 15), 0.05f);
    EXPECT_EQ(fine.at(8, 8), 0.0f);
}

// --- normals ---

Plane hills(int size, float depth) {
    Plane plane{size, size, std::vector<float>(size_t(size) * size_t(size))};
    const float step = 6.28318531f / float(size);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            plane.v[size_t(y * size + x)] = depth * (std::sin(3 * step * float(x) + 2 * step * float(y)) +
                                                     std::cos(5 * step * float(y) - 2 * step * float(x)));
    return plane;
}

MapImage map_of(const std::vector<glm::vec3>& normals, int size) {
    MapImage map;
    for (int c = 0; c < 3; ++c) {
        Plane plane{size, size, {}};
        for (const glm::vec3& n : normals) plane.v.push_back((128 + std::round(127 * n[c])) / 255);
        map.channels.push_back(plane);
    }
    return map;
}

struct Said {
    std::vector<std::string> notes, warnings;
};

TEST(Normals, SlopesTellWhichWayGreenPoints) {
    std::vector<glm::vec3> normals = normals_of_heights(hills(64, 2));
    EXPECT_GT(upward_green(normals, 64, 64), 0.95);
    Said said;
    const auto up = normals_of(map_of(normals, 64), {}, {}, said.notes, said.warnings);
    for (glm::vec3& n : normals) n.y = -n.y;
    EXPECT_LT(upward_green(normals, 64, 64), -0.95);
    const auto down = normals_of(map_of(normals, 64), {}, {}, said.notes, said.warnings);
    ASSERT_TRUE(up && down);
    for (size_t i = 0; i < up->size(); ++i) ASSERT_LT(angle_deg((*up)[i], (*down)[i]), 0.5f);
    EXPECT_EQ(said.notes.size(), 2u);
    EXPECT_TRUE(said.warnings.empty());
    // A name that contradicts the slopes is followed, and doubted aloud.
    ASSERT_TRUE(normals_of(map_of(normals, 64), {}, NormalDirection::gl, said.notes, said.warnings));
    EXPECT_EQ(said.warnings.size(), 1u);
    const std::vector<glm::vec3> flat(64 * 64, glm::vec3(0, 0, 1));
    EXPECT_EQ(upward_green(flat, 64, 64), 0.0);
    EXPECT_EQ(upward_green(flat, 1, 1), 0.0);
}

TEST(Normals, OddVectorsAreMendedAndCounted) {
    std::vector<glm::vec3> normals(16, glm::vec3(0, 0, 1));
    normals[1] = {0.3f, 0, 0.2f};   // too short
    normals[2] = {0, 0, 0};         // nothing
    normals[3] = {0.8f, 0, -0.6f};  // below
    normals[4] = {1, 0, 0};         // on the rim
    Said said;
    const auto mended = normals_of(map_of(normals, 4), NormalDirection::gl, {}, said.notes, said.warnings);
    ASSERT_TRUE(mended);
    for (const glm::vec3& n : *mended) {
        EXPECT_NEAR(glm::length(n), 1.0f, 1e-5f);
        EXPECT_GE(n.z, 0.0f);
    }
    EXPECT_LT(angle_deg((*mended)[0], glm::vec3(0, 0, 1)), 1e-4f);
    EXPECT_EQ((*mended)[2], glm::vec3(0, 0, 1));
    EXPECT_NEAR((*mended)[4].x, 1.0f, 1e-6f);
    EXPECT_EQ(said.warnings.size(), 3u);
    MapImage two = map_of(normals_of_heights(hills(16, 1)), 16);
    const auto whole = normals_of(two, NormalDirection::gl, {}, said.notes, said.warnings);
    two.channels.pop_back();
    const auto rebuilt = normals_of(two, NormalDirection::gl, {}, said.notes, said.warnings);
    ASSERT_TRUE(whole && rebuilt);
    for (size_t i = 0; i < whole->size(); ++i) EXPECT_LT(angle_deg((*whole)[i], (*rebuilt)[i]), 1.5f);
    two.channels.pop_back();
    EXPECT_FALSE(normals_of(two, NormalDirection::gl, {}, said.notes, said.warnings));
}

// --- metrics ---

TEST(Metrics, KnownColourDifferences) {
    EXPECT_EQ(delta_e({0.2f, 0.5f, 0.1f}, {0.2f, 0.5f, 0.1f}), 0.0f);
    EXPECT_NEAR(delta_e({0, 0, 0}, {1, 1, 1}), 100.0f, 0.02f);
    EXPECT_NEAR(delta_e({1, 0, 0}, {0, 1, 0}), 170.58f,
                0.1f);  // Lab 53.24 80.09 67.20 and 87.73 -86.18 83.18
}

TEST(Metrics, SmallAnglesAndSummaries) {
    EXPECT_NEAR(angle_deg({0, 0, 1}, glm::normalize(glm::vec3(1e-5f, 0, 1))), 1e-5f * 57.29578f, 1e-7f);
    EXPECT_NEAR(angle_deg({1, 0, 0}, {-1, 0, 0}), 180.0f, 1e-4f);
    std::vector<float> errors;
    for (int i = 0; i <= 100; ++i) errors.push_back(float(100 - i));
    const ChannelError e = summary_of(errors);
    EXPECT_EQ(e.mean, 50);
    EXPECT_EQ(e.p95, 95);
    EXPECT_EQ(e.max, 100);
    EXPECT_EQ(psnr_of(std::vector<float>{0, 0}), 99);
    EXPECT_NEAR(psnr_of(std::vector<float>{0.01f, 0.01f}), 20, 1e-4);
}

// --- formats ---

LayerPlanes ground(int size, float depth) {
    LayerPlanes planes;
    planes.size_texels = size;
    planes.normal = normals_of_heights(hills(size, depth));
    const Plane spots = resampled(noise(16, 16, 9), 1, 1, size);
    for (const float v : spots.v) {
        planes.albedo.push_back(glm::vec3(0.3f, 0.2f, 0.1f) * (0.5f + v));
        planes.gloss.push_back(0.2f + 0.2f * v);
        planes.occlusion.push_back(1 - 0.5f * v);
        planes.reveal.push_back(v);
        planes.metalness.push_back(0);
    }
    return planes;
}

const FormatRow& row(const FormatTable& table, PackChannel channel, std::string_view format) {
    for (const FormatRow& r : table.rows)
        if (r.channel == channel && r.format == format) return r;
    throw std::runtime_error("no such row");
}

TEST(Formats, EightBitsAreWithinHalfAStepAndCompressionCostsMore) {
    const FormatTable table = measure_formats(ground(64, 1));
    for (const PackChannel c : {PackChannel::gloss, PackChannel::occlusion, PackChannel::reveal}) {
        EXPECT_LE(row(table, c, "R8").error.max, 0.5 / 255 + 1e-6);
        EXPECT_GE(row(table, c, "BC4").error.mean, 0);
        EXPECT_GT(row(table, c, "constant").error.mean, row(table, c, "BC4").error.mean);
    }
    EXPECT_LT(row(table, PackChannel::normal, "RG8 x, y").error.max, 2);
    EXPECT_GT(row(table, PackChannel::color, "RGB of RGBA8").psnr_db,
              row(table, PackChannel::color, "BC1").psnr_db);
    EXPECT_LT(table.bytes_after, table.bytes_before);
    EXPECT_EQ(table.sampled_blocks, 256);
    int chosen = 0;
    for (const auto* rows : {&table.rows, &table.packed})
        for (const FormatRow& r : *rows) chosen += r.chosen;
    EXPECT_EQ(chosen, 6);
}

TEST(Formats, QuadraticScalingIsForAlmostFlatMaps) {
    const FormatTable flat = measure_formats(ground(64, 0.02f)), steep = measure_formats(ground(64, 6));
    const auto error = [](const FormatTable& t, const char* format) {
        return row(t, PackChannel::normal, format).error.mean;
    };
    EXPECT_LT(error(flat, "RG8 hemi-octahedral, scaled"), 0.2 * error(flat, "RG8 x, y"));
    EXPECT_GT(error(steep, "RG8 hemi-octahedral, scaled, quadratic"),
              0.5 * error(steep, "RG8 hemi-octahedral"));
    EXPECT_LT(flat.normal_scale, 0.1);
}

TEST(Formats, ConstantsCostNothingAndExtremesAreFinite) {
    LayerPlanes planes = ground(8, 1);
    for (size_t i = 0; i < planes.albedo.size(); ++i) {
        planes.albedo[i] = glm::vec3(0);
        planes.normal[i] = {0, 0, 1};
        planes.gloss[i] = 0;
        planes.metalness[i] = 1;
    }
    const FormatTable table = measure_formats(planes);
    EXPECT_TRUE(row(table, PackChannel::metalness, "constant").chosen);
    EXPECT_EQ(table.bytes_before, 9);
    for (const auto* rows : {&table.rows, &table.packed})
        for (const FormatRow& r : *rows) EXPECT_TRUE(std::isfinite(r.error.max)) << r.format;
    for (const FormatRow& r : table.rows) {
        if (r.channel != PackChannel::normal) continue;
        EXPECT_LT(r.error.max, 1e-3) << r.format;
    }
    EXPECT_LT(row(table, PackChannel::color, "BC1").error.max, 1e-3);
}

TEST(LayerPlanes, BytesAndBack) {
    const LayerPlanes planes = ground(16, 1);
    const LayerPlanes back = planes_of(textures_of(planes));
    for (size_t i = 0; i < planes.albedo.size(); ++i) {
        EXPECT_LT(angle_deg(planes.normal[i], back.normal[i]), 1.0f);
        EXPECT_NEAR(planes.gloss[i], back.gloss[i], 0.5 / 255 + 1e-6);
        EXPECT_LT(delta_e({srgb_of_linear(planes.albedo[i].x), srgb_of_linear(planes.albedo[i].y),
                           srgb_of_linear(planes.albedo[i].z)},
                          {srgb_of_linear(back.albedo[i].x), srgb_of_linear(back.albedo[i].y),
                           srgb_of_linear(back.albedo[i].z)}),
                  0.7f);
    }
    const LayerTextures again = textures_of(back);
    EXPECT_EQ(again.normal_gloss_occlusion[0], textures_of(planes).normal_gloss_occlusion[0]);
    EXPECT_EQ(again.albedo_reveal[0], textures_of(planes).albedo_reveal[0]);
}

}  // namespace
}  // namespace loam
