#include "editor/cli/progress_line.h"
#include "editor/cli/verb.h"
#include "editor/packer/pack_report.h"

namespace loam::cli {

namespace {

struct Packed {
    PackJson report;
    LayerTextures textures;
};

Result<Packed> pack(const Args& args, const Progress& progress) {
    const std::filesystem::path source = args.positional(0);
    const std::string name = source.lexically_normal().filename().string();
    if (source.extension() == ".layer") {
        auto textures = load_layer(source);
        if (!textures) return textures.error();
        LOAM_TRY(step_progress(progress, 0.3, "measuring formats"));
        const LayerPlanes planes = planes_of(*textures);
        return Packed{pack_report(name, planes, measure_formats(planes)), std::move(*textures)};
    }
    auto request = pack_request(args, source.string());
    if (!request) return request.error();
    auto packed = pack_folder(*request, part_of(progress, 0, 0.5));
    if (!packed) return packed.error();
    LOAM_TRY(step_progress(progress, 0.5, "measuring formats"));
    const FormatTable table = measure_formats(packed->planes);
    return Packed{pack_report(name, *packed, table), textures_of(packed->planes)};
}

Status run(const Args& args) {
    const std::filesystem::path out = args.text("-o");
    if (args.has("-o") && out.extension() != ".layer") return error("-o {} must end in .layer", out.string());
    Result<Packed> packed = [&] {
        ProgressLine progress;
        return pack(args, progress.callback());
    }();
    if (!packed) return packed.error();
    if (args.has("-o")) {
        LOAM_TRY(save_layer(out, packed->textures));
        LOAM_TRY(save_pack_report(report_file_of(out), packed->report));
    }
    fmt::print("{}", args.has("--json") ? packed->report.dump(2) + "\n" : pack_text(packed->report));
    return {};
}

}  // namespace

Verb pack_verb() {
    return {
        .name = "pack",
        .summary = "packs a folder of material maps and measures what each format loses",
        .positionals = {{"FOLDER",
                         "maps by the usual names (…_Color, _NormalGL, _Roughness, …), or a .layer file"}},
        .options = with_pack_options(
            {{"-o", ValueKind::text, "FILE", "write FILE.layer, and the report beside it as FILE.json"},
             {"--json", ValueKind::none, "", "print the report as JSON"}}),
        .run = run,
        .notes =
            "Maps: colour, normal, roughness or gloss, occlusion, height or reveal, metalness or specular. "
            "Only the "
            "colour is\nneeded; what is missing is made up, and said."};
}

}  // namespace loam::cli
