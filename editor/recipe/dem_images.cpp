// The only file here that knows OpenImageIO: reads the 16-bit grey pictures of real grounds.
#include <system_error>

#include <OpenImageIO/imageio.h>

#include "editor/recipe/ground_statistics.h"

namespace loam {

namespace {

// height = offset + sample * step; dx, dy are metres between samples. From the README beside the pictures.
struct KnownElevation {
    const char* file;
    double offset_m, step_m, dx_m, dy_m;
};
constexpr KnownElevation kKnown[] = {
    {"andes_s33w071.png", 250, 1, 78.2, 92.8}, {"plain_n53e027.png", 142, 1, 55.2, 92.8},
    {"coast_n51e001.png", -9, 1, 57.7, 92.8},  {"bigtujunga.png", 315, 1, 30, 30},
    {"halfdome.png", 1175, 0.05, 24.4, 30.9},  {"gabilan.png", 187, 0.01, 1, 1},
};

}  // namespace

Result<std::vector<ElevationMap>> load_known_elevations(const std::filesystem::path& folder) {
    std::vector<ElevationMap> maps;
    for (const KnownElevation& known : kKnown) {
        const std::filesystem::path file = folder / known.file;
        std::error_code code;
        if (!std::filesystem::exists(file, code)) continue;
        const auto input = OIIO::ImageInput::open(file.string());
        if (!input) return error("cannot read {}: {}", file.string(), OIIO::geterror());
        const OIIO::ImageSpec& spec = input->spec();
        std::vector<uint16_t> samples(static_cast<size_t>(spec.width) * spec.height * spec.nchannels);
        if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::UINT16, samples.data()))
            return error("cannot read {}: {}", file.string(), input->geterror());
        ElevationMap map{file.stem().string(), spec.width, spec.height, known.dx_m, known.dy_m, {}};
        map.height_m.resize(static_cast<size_t>(spec.width) * spec.height);
        for (size_t k = 0; k < map.height_m.size(); ++k)
            map.height_m[k] = static_cast<float>(known.offset_m + samples[k * spec.nchannels] * known.step_m);
        maps.push_back(std::move(map));
    }
    if (maps.empty()) return error("{} holds none of the known elevation pictures", folder.string());
    return maps;
}

}  // namespace loam
