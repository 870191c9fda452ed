// Figures as JSON: what `loam info --json`, the benches and the Python module give out.
#pragma once

#include <nlohmann/json.hpp>

#include "editor/session.h"
#include "runtime/document/function_library.h"

namespace loam {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json to_report(const Dirt& dirt);
[[nodiscard]] Json to_report(const Document::Statistics& statistics);
[[nodiscard]] Json to_report(const ProjectSettings& settings);
[[nodiscard]] Json to_report(const FrameStatistics& statistics);
[[nodiscard]] Json to_report(const VirtualTexture::Statistics& statistics);
[[nodiscard]] Json to_report(const WeightsReport& report);
// Of the functions of decals: what each is, its parameters, and what is wrong with it.
[[nodiscard]] Json function_report(FunctionLibrary& functions);
[[nodiscard]] Json memory_report(Session& session);  // needs a device

}  // namespace loam
