#include "editor/report.h"

namespace loam {

namespace {

Json rects(const std::vector<WorldRect>& list) {
    Json out = Json::array();
    for (const WorldRect& r : list) out.push_back({r.min_x, r.min_y, r.max_x, r.max_y});
    return out;
}

Json counters(const VirtualMap::Counters& c) {
    return {{"pages_composed", c.pages_composed},
            {"texels_composed", c.texels_composed},
            {"pages_dirtied", c.pages_dirtied},
            {"ejected", c.ejected}};
}

}  // namespace

Json to_report(const Dirt& dirt) {
    return {{"height", rects(dirt.height)},
            {"index", rects(dirt.index)},
            {"texture", rects(dirt.texture)},
            {"cutout", rects(dirt.cutout)}};
}

Json function_report(FunctionLibrary& functions) {
    Json list = Json::array();
    for (const std::string& name : functions.names()) {
        const auto function = functions.find(name);
        Json entry = {{"name", name}};
        if (function) {
            entry["says"] = (*function)->says;
            entry["steps"] = (*function)->steps;
            entry["parameters"] = Json::object();
            for (const FunctionParameter& p : (*function)->parameters)
                entry["parameters"][p.name] = {
                    {"value", p.value}, {"min", p.min}, {"max", p.max}, {"says", p.says}};
        }
        list.push_back(std::move(entry));
    }
    const auto errors = functions.errors();
    const auto failed = functions.failed_texels();
    for (Json& entry : list) {
        const std::string name = entry["name"];
        if (const auto wrong = errors.find(name); wrong != errors.end()) entry["error"] = wrong->second;
        if (const auto texels = failed.find(name); texels != failed.end())
            entry["failed_texels"] = texels->second;
    }
    return list;
}

Json to_report(const WeightsReport& r) {
    Json shares = Json::array();
    for (const auto& share : r.shares)
        shares.push_back({{"layer", share.layer}, {"weight", share.weight}, {"texels", share.texels}});
    return {{"texels", r.texels},
            {"kept", r.kept},
            {"unweighted", r.unweighted},
            {"color_rms", r.color_rms},
            {"color_rms_plain", r.color_rms_plain},
            {"layers", std::move(shares)},
            {"notes", r.notes}};
}

Json to_report(const Document::Statistics& s) {
    return {{"height_pages", s.height_pages},
            {"index_pages", s.index_pages},
            {"database_bytes", s.database_bytes},
            {"operators", s.operators},
            {"loaded_operators", s.loaded_operators},
            {"operator_nodes", s.operator_nodes},
            {"loaded_nodes", s.loaded_nodes},
            {"node_reads", s.node_reads},
            {"commands", s.commands},
            {"cached_pages", s.cached_pages},
            {"cache_bytes", s.cache_bytes}};
}

Json to_report(const ProjectSettings& s) {
    const WorldRect bounds = s.bounds();
    Json layers = Json::array();
    for (const LayerEntry& layer : s.layers) {
        layers.push_back({{"name", layer.name}});
        Json& row = layers.back();
        if (layer.blend) {
            row["blend"] = {layer.blend->from, layer.blend->to};
            row["threshold"] = layer.blend->threshold;
            if (layer.blend->removed) row["removed"] = true;
            continue;
        }
        row["file"] = layer.file;
        row["tile_m"] = layer.tile_m;
        for (size_t c = 0; c < kChannelNames.size(); ++c)
            if (layer.channels[c] != 0) row[kChannelNames[c]] = layer.channels[c];
    }
    Json channels = Json::array();
    for (const Channel channel : s.channels) channels.push_back(kChannelNames[size_t(channel)]);
    return {{"name", s.name},
            {"size_m", {bounds.width(), bounds.height()}},
            {"height_samples", {s.height_samples_x, s.height_samples_y}},
            {"height_spacing_m", s.height_spacing_m},
            {"refine", s.refine},
            {"index_spacing_m", s.index_spacing_m},
            {"sun_azimuth_rad", s.sun_azimuth_rad},
            {"sun_elevation_rad", s.sun_elevation_rad},
            {"haze_per_km", s.haze_per_km},
            {"ground",
             {{"distortion_amplitude_m", s.ground.distortion_amplitude_m},
              {"distortion_period_m", s.ground.distortion_period_m},
              {"tile_hiding", s.ground.tile_hiding},
              {"vista_scale", s.ground.vista_scale},
              {"vista_distance_m", s.ground.vista_distance_m}}},
            {"imagery",
             {{"file", s.imagery.file},
              {"strength", s.imagery.strength},
              {"distance_m", s.imagery.distance_m}}},
            {"palette", s.palette},
            {"channels", channels},
            {"layers", layers}};
}

Json to_report(const VirtualTexture::Statistics& t) {
    const VirtualTexture::Sharpness& sharp = t.sharpness;
    return {{"resident_pages", t.resident_pages},
            {"capacity_pages", t.capacity_pages},
            {"live_sectors", t.live_sectors},
            {"requested_pages", t.requested_pages},
            {"missing_pages", t.missing_pages},
            {"dirty_pages", t.dirty_pages},
            {"low_res_pages", t.low_res_pages},
            {"hidden_pages", t.hidden_pages},
            {"announced_missing", t.announced_missing},
            {"indirection_texels", t.indirection_texels},
            {"indirection_capacity", t.indirection_capacity},
            {"capped_images", t.capped_images},
            {"feedback_cells", t.feedback_cells},
            {"terrain_cells", sharp.cells},
            {"sharp_share", sharp.cells > 0 ? double(sharp.coarser[0]) / sharp.cells : 0.0},
            {"page_ms", t.page_ms},
            {"pages_dirtied", t.pages_dirtied},
            {"pages_composed", t.pages_composed},
            {"rects_composed", t.rects_composed},
            {"texels_composed", t.texels_composed},
            {"gpu_bytes", t.gpu_bytes}};
}

Json to_report(const FrameStatistics& s) {
    Json memory = Json::object(), passes = Json::array();
    for (const MemoryRow& row : s.memory) memory[row.name] = row.bytes;
    for (const gpu::PassTime& pass : s.passes)
        passes.push_back({{"pass", std::string(pass.name)}, {"gpu_ms", pass.gpu_ms}});
    return {{"patches", s.patches},
            {"patches_visible", s.patches_visible},
            {"triangles", s.triangles},
            {"height_pages", s.height_pages},
            {"index_pages", s.index_pages},
            {"shadow_cascades_drawn", s.shadow_cascades_drawn},
            {"shadow_parts_drawn", s.shadow_parts_drawn},
            {"height", counters(s.height)},
            {"index", counters(s.index)},
            {"texture", to_report(s.texture)},
            {"layers", {{"files", s.layers.files}, {"slots", s.layers.slots}, {"loads", s.layers.loads}}},
            {"cutouts",
             {{"mixed", s.cutouts.mixed},
              {"gone", s.cutouts.gone},
              {"not_shown", s.cutouts.not_shown},
              {"stale", s.cutouts.stale}}},
            {"memory_bytes", memory},
            {"passes", passes}};
}

Json memory_report(Session& session) {
    const gpu::Device& device = *session.device();
    return {{"device", device.allocated_bytes(gpu::MemoryUse::device)},
            {"upload", device.allocated_bytes(gpu::MemoryUse::upload)},
            {"readback", device.allocated_bytes(gpu::MemoryUse::readback)},
            {"rings", session.ring()->ring_bytes()}};
}

}  // namespace loam
