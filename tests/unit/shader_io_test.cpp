// Structs shared by GLSL and C++ have the same layout on both sides: the offsets in the compiled SPIR-V against offsetof.
#include <cstddef>
#include <cstring>
#include <map>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/gpu/embedded_shaders.h"
#include "shaders/frame/debug_io.h"
#include "shaders/frame/frame_io.h"
#include "shaders/frame/resolve_io.h"
#include "shaders/frame/tiles_io.h"
#include "shaders/geometry/geometry_io.h"
#include "shaders/texture/compose_io.h"
#include "shaders/texture/paint_io.h"
#include "shaders/texture/texture_io.h"

namespace {

using namespace loam;

// struct name → member name → byte offset, of every struct in a module.
using Layouts = std::map<std::string, std::map<std::string, uint32_t>>;

void add_layouts(std::span<const uint32_t> words, Layouts& out) {
    constexpr uint32_t kOpName = 5, kOpMemberName = 6, kOpMemberDecorate = 72, kOffset = 35;
    std::map<uint32_t, std::string> names;
    std::map<std::pair<uint32_t, uint32_t>, std::string> member_names;
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> offsets;
    for (size_t i = 5; i < words.size();) {
        const uint32_t op = words[i] & 0xffff, count = words[i] >> 16;
        if (count == 0) break;
        const char* text = reinterpret_cast<const char*>(&words[i]);
        if (op == kOpName) names[words[i + 1]] = text + 8;
        if (op == kOpMemberName) member_names[{words[i + 1], words[i + 2]}] = text + 12;
        if (op == kOpMemberDecorate && words[i + 3] == kOffset) offsets[{words[i + 1], words[i + 2]}] = words[i + 4];
        i += count;
    }
    for (const auto& [key, offset] : offsets) out[names[key.first]][member_names[key]] = offset;
}

const Layouts& layouts() {
    static const Layouts all = [] {
        Layouts found;
        for (const auto& shader : gpu::embedded_shaders()) add_layouts(shader.words, found);
        return found;
    }();
    return all;
}

struct Member {
    const char* name;
    size_t offset;
};

void expect_layout(const char* name, size_t size, std::initializer_list<Member> members) {
    const auto found = layouts().find(name);
    ASSERT_NE(found, layouts().end()) << name << " is in no shader";
    for (const Member& m : members) {
        const auto offset = found->second.find(m.name);
        ASSERT_NE(offset, found->second.end()) << name << "." << m.name;
        EXPECT_EQ(offset->second, m.offset) << name << "." << m.name;
        EXPECT_LT(offset->second, size);
    }
    EXPECT_EQ(found->second.size(), members.size()) << name << ": members that the test does not list";
}

#define AT(type, member) {#member, offsetof(shared::type, member)}

TEST(ShaderIo, FrameUniforms) {
    expect_layout("FrameUniforms", sizeof(shared::FrameUniforms),
                  {AT(FrameUniforms, clip_from_rel), AT(FrameUniforms, rel_from_clip), AT(FrameUniforms, sun_direction),
                   AT(FrameUniforms, sun_irradiance), AT(FrameUniforms, sun_above), AT(FrameUniforms, sky_ambient),
                   AT(FrameUniforms, ground_bounce), AT(FrameUniforms, haze_color), AT(FrameUniforms, haze_sunward),
                   AT(FrameUniforms, picture_px), AT(FrameUniforms, inv_picture_px),
                   AT(FrameUniforms, frame), AT(FrameUniforms, flags), AT(FrameUniforms, light_x),
                   AT(FrameUniforms, light_y), AT(FrameUniforms, light_z), AT(FrameUniforms, cascade),
                   AT(FrameUniforms, cascade_depth)});
}

TEST(ShaderIo, ResolvePush) {
    expect_layout("ResolvePush", sizeof(shared::ResolvePush),
                  {AT(ResolvePush, debug_view), AT(ResolvePush, footprint_bias), AT(ResolvePush, deepest_m),
                   AT(ResolvePush, first_tile), AT(ResolvePush, tiles_across)});
}

TEST(ShaderIo, ClassifyPush) {
    expect_layout("ClassifyPush", sizeof(shared::ClassifyPush),
                  {AT(ClassifyPush, picture_px), AT(ClassifyPush, tiles), AT(ClassifyPush, short_share), AT(ClassifyPush, log2_taps)});
}

TEST(ShaderIo, TileDraw) {
    expect_layout("TileDraw", sizeof(shared::TileDraw),
                  {AT(TileDraw, vertex_count), AT(TileDraw, instance_count), AT(TileDraw, first_vertex), AT(TileDraw, first_instance)});
}

TEST(ShaderIo, LayerPlace) {
    expect_layout("LayerPlace", sizeof(shared::LayerPlace),
                  {AT(LayerPlace, offset), AT(LayerPlace, scale), AT(LayerPlace, lod_bias),
                   AT(LayerPlace, slot), AT(LayerPlace, first), AT(LayerPlace, second),
                   AT(LayerPlace, threshold), AT(LayerPlace, vista_offset), AT(LayerPlace, vista_scale),
                   AT(LayerPlace, vista_lod_bias), AT(LayerPlace, channels)});
}

TEST(ShaderIo, EncodePush) {
    expect_layout("EncodePush", sizeof(shared::EncodePush), {AT(EncodePush, tile_count), AT(EncodePush, weights)});
}

TEST(ShaderIo, VtParams) {
    expect_layout(
        "VtParams", sizeof(shared::VtParams),
        {AT(VtParams, camera_sector), AT(VtParams, camera_offset_m), AT(VtParams, table_origin),
         AT(VtParams, default_log2_width), AT(VtParams, indirection_size), AT(VtParams, inv_atlas_pages),
         AT(VtParams, mip_bias), AT(VtParams, frame), AT(VtParams, flags),
         AT(VtParams, default_pages_per_sector), AT(VtParams, default_log2_texel),
         AT(VtParams, sector_log2_root), AT(VtParams, short_share), AT(VtParams, log2_taps)});
}

TEST(ShaderIo, FeedbackPush) {
    expect_layout("FeedbackPush", sizeof(shared::FeedbackPush),
                  {AT(FeedbackPush, cells), AT(FeedbackPush, jitter), AT(FeedbackPush, footprint_log2)});
}

TEST(ShaderIo, DebugFacts) {
    expect_layout("VtPlaceFacts", sizeof(shared::VtPlaceFacts),
                  {AT(VtPlaceFacts, state), AT(VtPlaceFacts, age), AT(VtPlaceFacts, popularity), AT(VtPlaceFacts, dirt),
                   AT(VtPlaceFacts, cost), AT(VtPlaceFacts, decals)});
    expect_layout("VtImageSquare", sizeof(shared::VtImageSquare),
                  {AT(VtImageSquare, x), AT(VtImageSquare, y), AT(VtImageSquare, size), AT(VtImageSquare, id)});
}

TEST(ShaderIo, PaintDecal) {
    expect_layout("PaintDecal", sizeof(shared::PaintDecal),
                  {AT(PaintDecal, center_m),
                   AT(PaintDecal, axis_x),
                   AT(PaintDecal, axis_y),
                   AT(PaintDecal, axis_z),
                   AT(PaintDecal, half_m),
                   AT(PaintDecal, phase),
                   AT(PaintDecal, tiles_per_m),
                   AT(PaintDecal, lod_bias),
                   AT(PaintDecal, layer),
                   AT(PaintDecal, colour),
                   AT(PaintDecal, gloss),
                   AT(PaintDecal, metalness),
                   AT(PaintDecal, opacity),
                   AT(PaintDecal, edge),
                   AT(PaintDecal, deep_edge),
                   AT(PaintDecal, rough),
                   AT(PaintDecal, seed),
                   AT(PaintDecal, ellipse),
                   AT(PaintDecal, albedo_share),
                   AT(PaintDecal, normal_share),
                   AT(PaintDecal, gloss_share),
                   AT(PaintDecal, metal_share),
                   AT(PaintDecal, occlusion_share),
                   AT(PaintDecal, first_segment),
                   AT(PaintDecal, segment_count),
                   AT(PaintDecal, own_first),
                   AT(PaintDecal, own_count),
                   AT(PaintDecal, length_m),
                   AT(PaintDecal, fade_m),
                   AT(PaintDecal, function),
                   AT(PaintDecal, parameters_a),
                   AT(PaintDecal, parameters_b)});
}

TEST(ShaderIo, PaintSegment) {
    expect_layout("PaintSegment", sizeof(shared::PaintSegment),
                  {AT(PaintSegment, from_m), AT(PaintSegment, direction), AT(PaintSegment, length_m),
                   AT(PaintSegment, half_from_m), AT(PaintSegment, half_to_m), AT(PaintSegment, start_m),
                   AT(PaintSegment, phase)});
}

TEST(ShaderIo, PaintInstance) {
    expect_layout("PaintInstance", sizeof(shared::PaintInstance),
                  {AT(PaintInstance, quad_min), AT(PaintInstance, quad_size), AT(PaintInstance, page_shift),
                   AT(PaintInstance, texel_m), AT(PaintInstance, grid_scale), AT(PaintInstance, grid_origin),
                   AT(PaintInstance, grid_min), AT(PaintInstance, grid_first), AT(PaintInstance, grid_width),
                   AT(PaintInstance, grid_spacing_m), AT(PaintInstance, decal)});
}

TEST(ShaderIo, ADifferentLayoutIsFound) {
    Layouts wrong = layouts();
    ASSERT_TRUE(wrong.count("ResolvePush"));
    EXPECT_NE(wrong["ResolvePush"]["debug_view"], offsetof(shared::ResolvePush, footprint_bias));
}

} // namespace
