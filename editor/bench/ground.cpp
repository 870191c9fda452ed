#include "editor/bench/bench.h"

namespace loam::bench {

Result<BenchReport> bench_ground(const BenchRequest&) {
    return error("not in this build");
}

} // namespace loam::bench
