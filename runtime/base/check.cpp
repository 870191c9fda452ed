#include "runtime/base/check.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace loam {

namespace {
std::atomic<void (*)()> g_hook{nullptr};
}

void check_failed(const char* file, int line, const char* condition, const std::string& message) {
    std::fprintf(stderr, "loam: broken contract at %s:%d: %s (%s)\n", file, line, message.c_str(), condition);
    if (auto hook = g_hook.exchange(nullptr)) hook();
    std::abort();
}

void set_check_hook(void (*hook)()) {
    g_hook = hook;
}

} // namespace loam
