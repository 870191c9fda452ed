// What packing found, as JSON and as text; kept beside the layer file as NAME.json.
#pragma once

#include <filesystem>
#include <string>

#include <nlohmann/json.hpp>

#include "editor/packer/formats.h"
#include "editor/packer/pack_folder.h"

namespace loam {

using PackJson = nlohmann::ordered_json;

// `source`: where the maps came from, as a person would name it.
[[nodiscard]] PackJson pack_report(const std::string& source, const PackedFolder& packed,
                                   const FormatTable& table);
// Of a layer file without its folder.
[[nodiscard]] PackJson pack_report(const std::string& source, const LayerPlanes& planes,
                                   const FormatTable& table);
// Notes, warnings and the table.
[[nodiscard]] std::string pack_text(const PackJson& report);
// One line: what was chosen and its errors, before and after.
[[nodiscard]] std::string pack_line(const std::string& name, const PackJson& report);

[[nodiscard]] std::filesystem::path report_file_of(const std::filesystem::path& layer_file);
[[nodiscard]] Status save_pack_report(const std::filesystem::path& file, const PackJson& report);
// The one beside a layer file; measured anew where there is none, or one that cannot be read.
[[nodiscard]] Result<PackJson> report_of_layer(const std::filesystem::path& layer_file);

}  // namespace loam
