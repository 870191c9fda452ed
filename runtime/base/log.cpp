#include "runtime/base/log.h"

#include <atomic>
#include <cstdio>

namespace loam {

namespace {
std::atomic<LogLevel> g_lowest{LogLevel::warning};
}

void set_log_level(LogLevel lowest) {
    g_lowest = lowest;
}

void log_line(LogLevel level, std::string_view text) {
    if (level < g_lowest.load()) return;
    static constexpr const char* kNames[] = {"debug", "info", "warning", "error"};
    std::fprintf(stderr, "loam: %s: %.*s\n", kNames[static_cast<int>(level)], static_cast<int>(text.size()),
                 text.data());
}

} // namespace loam
