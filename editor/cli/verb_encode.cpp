#include <nlohmann/json.hpp>

#include "editor/cli/verb.h"
#include "editor/encode.h"
#include "runtime/texture/block_decoder.h"

namespace loam::cli {

namespace {

double rounded(double value) {
    return std::round(value * 100) / 100;
}

Status run(const Args& args) {
    auto format = parse_block_format(args.text("--format", "astc6x6"));
    if (!format) return format.error();
    if (!args.has("-o")) return error("-o FILE is missing: say where the texture goes");
    const std::filesystem::path file = args.text("-o");
    LOAM_TRY(check_texture_name(file, *format));
    glm::vec3 weights(1);
    for (int c = 0; c < 3; ++c) {
        weights[c] = static_cast<float>(args.number("--weights", 1, static_cast<size_t>(c)));
        if (!(weights[c] >= 0 && weights[c] <= 1000))
            return error("--weights {} is outside 0 … 1000", weights[c]);
    }
    auto image = read_rgba8(args.positional(0), kMaxEncodeSide);
    if (!image) return image.error();
    gpu::DeviceDesc desc;
    desc.device_filter = args.text("--device");
    desc.validation = args.has("--validation");
    auto device = gpu::Device::create(desc);
    if (!device) return device.error();
    auto encoded = encode_image(**device, *image, *format, weights);
    if (!encoded) return encoded.error();
    LOAM_TRY(write_texture(file, *encoded));
    if (args.has("--shown")) {
        const RgbaImage shown = decode_image(*encoded);
        LOAM_TRY(write_rgba8_png(args.text("--shown"), shown.width, shown.height, shown.rgba));
    }
    if ((*device)->validation_message_count() > 0)
        return error("{} validation messages", (*device)->validation_message_count());
    const bool one_channel = *format == BlockFormat::bc4;
    const glm::dvec4 errors = encoded->mean_square;
    const double blocks = static_cast<double>(encoded->blocks.size()) / shape_of(*format).bytes;
    const nlohmann::ordered_json json = {
        {"size", {encoded->width, encoded->height}},
        {"bytes", encoded->blocks.size()},
        {"blocks", blocks},
        {"ms", rounded(encoded->encode_ms)},
        {"blocks_per_s", std::round(blocks / std::max(encoded->encode_ms, 1e-3) * 1000)},
        {"psnr_db", rounded(decibels(one_channel ? errors.x : (errors.x + errors.y + errors.z) / 3))},
        {"alpha_psnr_db", rounded(decibels(errors.w))}};
    if (args.has("--json"))
        fmt::print("{}\n", json.dump(2));
    else
        fmt::print("{}x{} texels, {} bytes of blocks, {} dB, {} blocks a second\n", encoded->width,
                   encoded->height, encoded->blocks.size(), json["psnr_db"].get<double>(),
                   json["blocks_per_s"].get<double>());
    return {};
}

}  // namespace

Verb encode_verb() {
    return {
        .name = "encode",
        .summary = "writes a picture as a block-compressed texture",
        .positionals = {{"IMAGE", "png, jpg, tif …; 8 bits a channel are kept, row 0 stays the first row"}},
        .options =
            {{"-o", ValueKind::text, "FILE", "the texture: .astc, or .dds for the bc formats"},
             {"--format", ValueKind::text, "F",
              "astc6x6 (3.6 bits a texel; default), astc4x4 (8), bc1, bc1-fine (4), bc3 (8) or bc4 (red, 4)"},
             {"--weights", ValueKind::number, "R G B", "of the channels' squared errors; default 1 1 1", 3},
             {"--shown", ValueKind::text, "FILE", "a png of what a device will show"},
             {"--device", ValueKind::text, "NAME", "part of the Vulkan device's name, or its number"},
             {"--validation", ValueKind::none, "", "Vulkan validation; its messages fail the command"},
             {"--json", ValueKind::none, "", "print figures as JSON"}},
        .run = run};
}

}  // namespace loam::cli
