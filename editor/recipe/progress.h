// How a long recipe tells where it is and asks whether to go on.
#pragma once

#include <functional>
#include <string_view>

#include "runtime/base/result.h"

namespace loam {

enum class Going { on, cancel };

// Share 0 … 1 of the whole, and what is being done ("eroding at 8 m"). Called from the thread that runs the
// recipe.
using Progress = std::function<Going(double share, std::string_view what)>;

inline constexpr const char* kCancelled = "cancelled";  // the message of the error a cancelled recipe returns

[[nodiscard]] inline Status step_progress(const Progress& progress, double share, std::string_view what) {
    if (progress && progress(share, what) == Going::cancel) return Error{kCancelled};
    return {};
}
// The part [from, to] of `whole` as a progress of its own.
[[nodiscard]] inline Progress part_of(const Progress& whole, double from, double to) {
    if (!whole) return {};
    return [&whole, from, to](double share, std::string_view what) {
        return whole(from + (to - from) * share, what);
    };
}

}  // namespace loam
