// LOAM_CHECK: a broken contract is a bug in Loam. It stays alive in release builds: says where and what, runs the
// registered last-chance hook (which saves what can be saved), and aborts.
#pragma once

#include <string>

namespace loam {

[[noreturn]] void check_failed(const char* file, int line, const char* condition, const std::string& message);

// Called once before the abort; must not throw. Null clears it.
void set_check_hook(void (*hook)());

} // namespace loam

#define LOAM_CHECK(condition, message)                                       \
    do {                                                                     \
        if (!(condition)) [[unlikely]]                                       \
            ::loam::check_failed(__FILE__, __LINE__, #condition, (message)); \
    } while (false)
