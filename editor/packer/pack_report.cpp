#include "editor/packer/pack_report.h"

#include <cmath>
#include <fstream>

#include "runtime/store/packed_file.h"

namespace loam {

namespace {

constexpr const char* kVersion = "loam pack 1";

// Four digits: what a person reads, and the same text on any machine.
double short_number(double value) {
    if (value == 0 || !std::isfinite(value)) return 0;
    const double scale = std::pow(10, 3 - std::floor(std::log10(std::abs(value))));
    return std::round(value * scale) / scale;
}

PackJson row_json(const FormatRow& row) {
    PackJson json = {{"channel", channel_name(row.channel)},
                     {"format", row.format},
                     {"bytes_texel", row.bytes_texel},
                     {"unit", channel_unit(row.channel)},
                     {"mean", short_number(row.error.mean)},
                     {"p95", short_number(row.error.p95)},
                     {"max", short_number(row.error.max)},
                     {"fits", row.fits},
                     {"chosen", row.chosen}};
    if (row.channel == PackChannel::color) json["psnr_db"] = std::round(row.psnr_db * 100) / 100;
    return json;
}

PackJson report_json(const std::string& source, int size, const FusedRoundTrip& fused,
                     const FormatTable& table) {
    PackJson rows = PackJson::array(), packed = PackJson::array(), limits = PackJson::object();
    for (const FormatRow& row : table.rows) rows.push_back(row_json(row));
    for (const FormatRow& row : table.packed) packed.push_back(row_json(row));
    for (const PackChannel c : {PackChannel::color, PackChannel::normal, PackChannel::gloss,
                                PackChannel::occlusion, PackChannel::reveal, PackChannel::metalness})
        limits[std::string(channel_name(c))] = {{"mean", limit_of(c).mean}, {"p95", limit_of(c).p95}};
    return {{"made_by", kVersion},
            {"source", source},
            {"size_texels", size},
            {"bytes_texel_before", table.bytes_before},
            {"bytes_texel_after", table.bytes_after},
            {"normal_scale", short_number(table.normal_scale)},
            {"sampled_blocks", table.sampled_blocks},
            {"blocks", table.blocks},
            {"fused_round_trip",
             {{"mean", short_number(fused.mean)},
              {"max", short_number(fused.max)},
              {"mean_8bit", short_number(fused.mean_8bit)},
              {"max_8bit", short_number(fused.max_8bit)},
              {"mean_lit", short_number(fused.mean_lit)},
              {"max_lit", short_number(fused.max_lit)}}},
            {"limits", limits},
            {"rows", rows},
            {"packed", packed},
            {"notes", PackJson::array()},
            {"warnings", PackJson::array()}};
}

std::string table_text(const PackJson& rows) {
    std::string text;
    for (const PackJson& row : rows) {
        const double bytes = row.at("bytes_texel").get<double>();
        text += fmt::format(
            "{} {:<10} {:<52} {:>4}  {:>8.4g} {:>8.4g} {:>8.4g} {:<3}{}\n",
            row.at("chosen").get<bool>() ? "*"
            : row.at("fits").get<bool>() ? " "
                                         : "-",
            row.at("channel").get<std::string>(), row.at("format").get<std::string>(), bytes,
            row.at("mean").get<double>(), row.at("p95").get<double>(), row.at("max").get<double>(),
            row.at("unit").get<std::string>(),
            row.contains("psnr_db") ? fmt::format("{:.1f} dB", row.at("psnr_db").get<double>()) : "");
    }
    return text;
}

// Mean error of a channel before (the last row of the channel: eight bits a value) and after.
std::pair<double, double> errors_of(const PackJson& report, std::string_view channel) {
    std::pair<double, double> found{0, 0};
    for (const char* list : {"rows", "packed"})
        for (const PackJson& row : report.at(list)) {
            if (row.at("channel").get<std::string>() != channel) continue;
            const std::string format = row.at("format").get<std::string>();
            const double mean = row.at("mean").get<double>();
            if (format == "RGB of RGBA8" || format == "RG8 x, y" || format == "R8") found.first = mean;
            if (row.at("chosen").get<bool>()) found.second = mean;
        }
    return found;
}

}  // namespace

PackJson pack_report(const std::string& source, const PackedFolder& packed, const FormatTable& table) {
    PackJson json = report_json(source, packed.planes.size_texels, packed.fused, table);
    json["notes"] = packed.notes;
    json["warnings"] = packed.warnings;
    return json;
}

PackJson pack_report(const std::string& source, const LayerPlanes& planes, const FormatTable& table) {
    return report_json(source, planes.size_texels, fused_round_trip(planes), table);
}

std::string pack_text(const PackJson& report) {
    std::string text;
    for (const PackJson& note : report.at("notes")) text += note.get<std::string>() + "\n";
    for (const PackJson& warning : report.at("warnings"))
        text += "warning: " + warning.get<std::string>() + "\n";
    text += fmt::format("{}x{} texels\n\n", report.at("size_texels").get<int>(),
                        report.at("size_texels").get<int>());
    text +=
        fmt::format("  {:<10} {:<52} B/tx  {:>8} {:>8} {:>8}\n", "channel", "format", "mean", "p95", "max");
    text += table_text(report.at("rows")) + table_text(report.at("packed"));
    const PackJson& fused = report.at("fused_round_trip");
    text += fmt::format(
        "\n* chosen, - beyond its limit. {} bytes a texel before, {} after (a third more with mips)\n",
        report.at("bytes_texel_before").get<double>(), report.at("bytes_texel_after").get<double>());
    text += fmt::format(
        "specular to fused albedo and back: mean {:.2g}, largest {:.2g}; in 8 bits {:.2g}, {:.2g}\n",
        fused.at("mean").get<double>(), fused.at("max").get<double>(), fused.at("mean_8bit").get<double>(),
        fused.at("max_8bit").get<double>());
    return text;
}

std::string pack_line(const std::string& name, const PackJson& report) {
    std::string text = fmt::format(
        "{:<16} {:>5} {:>4.3g} → {:<4.3g}", name, report.at("size_texels").get<int>(),
        report.at("bytes_texel_before").get<double>(), report.at("bytes_texel_after").get<double>());
    for (const char* channel : {"colour", "normal", "gloss", "occlusion", "reveal"}) {
        const auto [before, after] = errors_of(report, channel);
        text += fmt::format("  {} {:.2g} → {:.2g}", channel, before, after);
    }
    const PackJson& fused = report.at("fused_round_trip");
    return text + fmt::format("  specular and back {:.1g}, 8 bits {:.2g}", fused.at("max").get<double>(),
                              fused.at("max_8bit").get<double>());
}

std::filesystem::path report_file_of(const std::filesystem::path& layer_file) {
    std::filesystem::path file = layer_file;
    return file.replace_extension(".json");
}

Status save_pack_report(const std::filesystem::path& file, const PackJson& report) {
    const std::string text = report.dump(1) + "\n";
    return replace_file(file, {reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

Result<PackJson> report_of_layer(const std::filesystem::path& layer_file) {
    std::ifstream stream(report_file_of(layer_file), std::ios::binary);
    if (stream) {
        const PackJson json = PackJson::parse(stream, nullptr, false);
        if (json.is_object() && json.value("made_by", std::string()) == kVersion) return json;
    }
    const auto textures = load_layer(layer_file);
    if (!textures) return textures.error();
    const LayerPlanes planes = planes_of(*textures);
    return pack_report(layer_file.filename().string(), planes, measure_formats(planes));
}

}  // namespace loam
