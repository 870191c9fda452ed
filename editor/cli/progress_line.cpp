#include "editor/cli/progress_line.h"

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include <fmt/core.h>

namespace loam::cli {

namespace {

constexpr int kBarCells = 30;
volatile std::sig_atomic_t interrupted = 0;

void on_signal(int) {
    interrupted = 1;
}

}  // namespace

ProgressLine::ProgressLine() : is_terminal_(::isatty(STDERR_FILENO) != 0) {
    interrupted = 0;
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
}

ProgressLine::~ProgressLine() {
    if (is_terminal_ && shown_percent_ >= 0) fmt::print(stderr, "\r\x1b[K");
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

Progress ProgressLine::callback() {
    return [this](double share, std::string_view what) { return show(share, what); };
}

Going ProgressLine::show(double share, std::string_view what) {
    if (interrupted) return Going::cancel;
    const int percent = static_cast<int>(100.0 * std::clamp(share, 0.0, 1.0));
    if (is_terminal_) {
        if (percent == shown_percent_ && what == shown_what_) return Going::on;
        const int filled = percent * kBarCells / 100;
        std::string bar;
        for (int i = 0; i < kBarCells; ++i) bar += i < filled ? "█" : "░";
        fmt::print(stderr, "\r{} {:3d} %  {}\x1b[K", bar, percent, what);
        std::fflush(stderr);
        shown_percent_ = percent;
        shown_what_ = what;
    } else if (percent / 10 > std::max(0, shown_percent_) / 10) {
        fmt::print(stderr, "{:3d} %  {}\n", percent, what);
        shown_percent_ = percent;
    }
    return Going::on;
}

}  // namespace loam::cli
