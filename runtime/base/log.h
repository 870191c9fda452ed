// One line a message on stderr; quiet by default below `warning`.
#pragma once

#include <string_view>

#include <fmt/core.h>

namespace loam {

enum class LogLevel { debug, info, warning, error };

void set_log_level(LogLevel lowest);
void log_line(LogLevel level, std::string_view text);

template <typename... Args>
void log(LogLevel level, fmt::format_string<Args...> format, Args&&... args) {
    log_line(level, fmt::format(format, std::forward<Args>(args)...));
}

} // namespace loam
