// Figures as JSON: what `loam info --json`, the benches and the Python module give out.
#pragma once

#include <nlohmann/json.hpp>

#include "editor/session.h"

namespace loam {

using Json = nlohmann::ordered_json;

[[nodiscard]] Json to_report(const Dirt& dirt);
[[nodiscard]] Json to_report(const Document::Statistics& statistics);
[[nodiscard]] Json to_report(const ProjectSettings& settings);
[[nodiscard]] Json to_report(const FrameStatistics& statistics);
[[nodiscard]] Json to_report(const VirtualTexture::Statistics& statistics);
[[nodiscard]] Json to_report(const WeightsReport& report);
[[nodiscard]] Json memory_report(Session& session);  // needs a device

}  // namespace loam
