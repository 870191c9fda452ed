// From the command to the first picture, as processes of their own: with warm caches, and with every shader
// cache empty.
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "editor/bench/bench.h"

extern char** environ;

namespace loam::bench {

namespace fs = std::filesystem;

namespace {

constexpr int kWarmRuns = 5;

// Environment of this process with the caches of Mesa and of Loam in `cache`.
std::vector<std::string> environment_with_cache(const fs::path& cache) {
    std::vector<std::string> out;
    for (char** entry = environ; *entry; ++entry) {
        const std::string_view text(*entry);
        if (!text.starts_with("MESA_SHADER_CACHE_DIR=") && !text.starts_with("XDG_CACHE_HOME="))
            out.emplace_back(text);
    }
    out.push_back("MESA_SHADER_CACHE_DIR=" + cache.string());
    out.push_back("XDG_CACHE_HOME=" + cache.string());
    return out;
}

// Milliseconds of `loam render PROJECT --max-frames 1`, process start and end included.
Result<double> first_picture_ms(const fs::path& project, const fs::path& cache, const BenchRequest& request) {
    const fs::path picture = cache / "first.png";
    std::vector<std::string> words{"loam",
                                   "render",
                                   project.string(),
                                   "--max-frames",
                                   "1",
                                   "--size",
                                   fmt::format("{}x{}", request.width, request.height),
                                   "-o",
                                   picture.string()};
    if (!request.session.device.device_filter.empty()) {
        words.emplace_back("--device");
        words.push_back(request.session.device.device_filter);
    }
    std::vector<std::string> environment = environment_with_cache(cache);
    std::vector<char*> argv, envp;
    for (std::string& word : words) argv.push_back(word.data());
    for (std::string& entry : environment) envp.push_back(entry.data());
    argv.push_back(nullptr);
    envp.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", 1 /* O_WRONLY */, 0);
    const double start_ms = now_ms();
    pid_t pid = 0;
    const int failure = posix_spawn(&pid, "/proc/self/exe", &actions, nullptr, argv.data(), envp.data());
    posix_spawn_file_actions_destroy(&actions);
    if (failure != 0) return error("cannot start loam: {}", std::strerror(failure));
    int status = 0;
    while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
    }
    const double ms = now_ms() - start_ms;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return error("loam render {} failed", project.string());
    return ms;
}

Result<Json> start_of(const std::string& name, const fs::path& project, const BenchRequest& request) {
    std::string pattern = (fs::temp_directory_path() / "loam-cache-XXXXXX").string();
    if (!::mkdtemp(pattern.data())) return error("cannot create a temporary folder");
    struct Remove {
        fs::path path;
        ~Remove() {
            std::error_code code;
            fs::remove_all(path, code);
        }
    } remove{pattern};
    auto cold = first_picture_ms(project, pattern, request);
    if (!cold) return cold.error();
    std::vector<double> warm;
    for (int i = 0; i < (request.quick ? 1 : kWarmRuns); ++i) {
        auto ms = first_picture_ms(project, pattern, request);
        if (!ms) return ms.error();
        warm.push_back(*ms);
    }
    return Json{{"map", name},
                {"empty caches ms", rounded(*cold, 0)},
                {"warm ms (median)", rounded(spread_of(warm).median, 0)},
                {"warm ms (max)", rounded(spread_of(warm).max, 0)}};
}

}  // namespace

Result<BenchReport> bench_start(const BenchRequest& request) {
    BenchTable table{
        fmt::format("from the command to the first picture, {}x{}", request.width, request.height), {}};
    const auto add = [&](const std::string& name, const fs::path& project) -> Status {
        auto row = start_of(name, project, request);
        if (!row) return row.error();
        table.rows.push_back(*row);
        return {};
    };
    LOAM_TRY(add(request.project.string(), request.project));
    for (const double side_m : {1024.0, 16384.0}) {
        auto flat = TemporaryProject::create_flat(request.project, side_m);
        if (!flat) return flat.error();
        LOAM_TRY(add(fmt::format("flat, {} m", side_m), flat->path()));
    }
    return BenchReport{table};
}

}  // namespace loam::bench
