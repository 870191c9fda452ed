// A number between two limits: drag (Shift: ten times finer), arrow keys, or typed after a double click or
// Enter.
#pragma once

#include <optional>
#include <string>

#include "ui/controls.h"

namespace loam::ui {

struct SliderDesc {
    double min = 0, max = 1;
    double step = 0;  // values snap to min + n · step; 0: continuous
    int decimals = 2;
    std::string_view unit{};     // "m", "°"
    bool logarithmic = false;  // equal distances are equal ratios; needs 0 < min
    std::string_view tooltip{};
};
Edit slider(Ui& ui, std::string_view label, double& value, const SliderDesc& desc);
Edit slider(Ui& ui, std::string_view label, float& value, const SliderDesc& desc);
Edit slider(Ui& ui, std::string_view label, int& value, SliderDesc desc);  // whole numbers

// The arithmetic, apart for tests.
[[nodiscard]] double clamped(double value, const SliderDesc& desc);  // NaN becomes min
[[nodiscard]] double slider_fraction(double value, const SliderDesc& desc);
[[nodiscard]] double slider_value(double fraction, const SliderDesc& desc);
// "12", "1.5", "1,5", with spaces or the unit around; nothing for garbage, NaN and infinities.
[[nodiscard]] std::optional<double> parse_number(std::string_view text, std::string_view unit = {});
[[nodiscard]] std::string format_number(double value, int decimals);

}  // namespace loam::ui
