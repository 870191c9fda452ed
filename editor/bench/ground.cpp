// Slopes and curvatures of the recipes beside those of real elevation data.
#include <sstream>

#include "editor/bench/bench.h"
#include "editor/recipe/ground_statistics.h"

namespace loam::bench {

Result<BenchReport> bench_ground(const BenchRequest& request) {
    std::ostringstream out;
    LOAM_TRY(loam::bench_ground(request.dem, out, BenchFormat::table));
    return BenchReport{{out.str(), {}}};
}

}  // namespace loam::bench
