#include "editor/settings.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include "editor/nearest_word.h"
#include "editor/text_numbers.h"

namespace loam {

namespace {

using Target = std::variant<int*, uint32_t*, double*, FeedbackCells*>;

struct Setting {
    const char* name;
    Target (*target)(RendererDesc&);
    double low, high;  // of numbers
    const char* help;
};

constexpr std::array<std::pair<const char*, FeedbackCells>, 3> kCells = {
    {{"grid", FeedbackCells::grid},
     {"eighth", FeedbackCells::eighth},
     {"every_pixel", FeedbackCells::every_pixel}}};

using R = RendererDesc;
constexpr Setting kSettings[] = {
    {"texture.pages_per_side", [](R& r) -> Target { return &r.texture.pages_per_side; }, 0, 64,
     "pages a side of the physical texture; 0: by quality"},
    {"texture.indirection_size", [](R& r) -> Target { return &r.texture.indirection_size; }, 0, 1024,
     "texels a side of the indirection texture, a power of two; 0: by quality"},
    {"texture.max_live_sectors", [](R& r) -> Target { return &r.texture.max_live_sectors; }, 0, 255,
     "sectors with an image of their own"},
    {"texture.budget_pages", [](R& r) -> Target { return &r.texture.budget_pages; }, 0, 64,
     "pages composed a frame; 0: by device"},
    {"texture.budget_ms", [](R& r) -> Target { return &r.texture.budget_ms; }, 0, 1000,
     "milliseconds of composition a frame, instead of a number of pages; 0: budget_pages"},
    {"texture.feedback", [](R& r) -> Target { return &r.texture.feedback_cells; }, 0, 0,
     "cells that say what is wanted: grid is 240x136, eighth an eighth of the picture with 64 frames of "
     "jitter"},
    {"texture.threshold_share", [](R& r) -> Target { return &r.texture.feedback_rules.threshold_share; }, 0,
     1, "share of the cells below which a page is not wanted, unless it is visible"},
    {"texture.velocity_horizon_s", [](R& r) -> Target { return &r.texture.feedback_rules.horizon_s; }, 0, 60,
     "pages that the camera crosses faster than this count for less"},
    {"texture.cache_divisor", [](R& r) -> Target { return &r.texture.feedback_rules.cache_divisor; }, 1, 64,
     "at most this part of the physical texture is requested by a picture in motion"},
    {"texture.first_retry_frames", [](R& r) -> Target { return &r.texture.pool_rules.first_retry_frames; }, 1,
     100'000, "until a page that lacks inputs is composed again; then twice as long"},
    {"texture.last_retry_frames", [](R& r) -> Target { return &r.texture.pool_rules.last_retry_frames; }, 1,
     100'000, "and at most so long"},
    {"texture.age_frames", [](R& r) -> Target { return &r.texture.pool_rules.age_frames; }, 1, 100'000,
     "a page not requested for so long may be recycled"},
    {"texture.hidden_divisor", [](R& r) -> Target { return &r.texture.hidden_divisor; }, 1, 1024,
     "at most this part of the physical texture is kept for sectors that are not seen"},
    {"texture.hidden_depth", [](R& r) -> Target { return &r.texture.hidden_depth; }, 0, 8,
     "their page is 1/2^this of their image wide"},
    {"geometry.split_distance", [](R& r) -> Target { return &r.patch_split_distance; }, 0, 64,
     "patches nearer than so many of their sides are split; 0: by device"},
    {"height.pages", [](R& r) -> Target { return &r.height_slots; }, 16, 2048, "pages of the height cache"},
    {"layers.budget_mb", [](R& r) -> Target { return &r.layer_budget_mb; }, 1, 65'536,
     "memory for layers' textures, MB; what does not fit is read when pages need it"},
    {"index.pages", [](R& r) -> Target { return &r.index_slots; }, 16, 2048, "pages of the index cache"},
};

std::string value_text(const Target& target) {
    if (const auto* cells = std::get_if<FeedbackCells*>(&target)) {
        for (const auto& [name, value] : kCells)
            if (value == **cells) return name;
    }
    if (const auto* number = std::get_if<double*>(&target)) return fmt::format("{:.6g}", **number);
    if (const auto* count = std::get_if<uint32_t*>(&target)) return fmt::format("{}", **count);
    if (const auto* count = std::get_if<int*>(&target)) return fmt::format("{}", **count);
    return "";
}

std::string range_text(const Setting& setting, const Target& target) {
    if (!std::holds_alternative<FeedbackCells*>(target))
        return fmt::format("{} … {}", setting.low, setting.high);
    std::string names;
    for (const auto& [name, value] : kCells) names += names.empty() ? name : fmt::format(", {}", name);
    return names;
}

Status change(const Setting& setting, const Target& target, std::string_view value) {
    if (const auto* cells = std::get_if<FeedbackCells*>(&target)) {
        for (const auto& [name, choice] : kCells)
            if (value == name) {
                **cells = choice;
                return {};
            }
        return error("{} is one of {}, not \"{}\"", setting.name, range_text(setting, target), value);
    }
    const auto number = parse_number(value);
    if (!number) return error("{}: {}", setting.name, number.message());
    if (*number < setting.low || *number > setting.high)
        return error("{} is {}, not {}", setting.name, range_text(setting, target), value);
    if (const auto* real = std::get_if<double*>(&target)) {
        **real = *number;
        return {};
    }
    const auto whole = parse_integer(value);
    if (!whole) return error("{}: {}", setting.name, whole.message());
    if (const auto* count = std::get_if<int*>(&target)) **count = int(*whole);
    if (const auto* count = std::get_if<uint32_t*>(&target)) **count = uint32_t(*whole);
    return {};
}

}  // namespace

std::vector<SettingText> list_settings(const RendererDesc& desc) {
    RendererDesc copy = desc;
    std::vector<SettingText> list;
    for (const Setting& s : kSettings) {
        const Target target = s.target(copy);
        list.push_back({s.name, value_text(target), range_text(s, target), s.help});
    }
    return list;
}

Status change_setting(RendererDesc& desc, std::string_view name, std::string_view value) {
    std::vector<std::string> names;
    for (const Setting& s : kSettings) {
        if (name == s.name) return change(s, s.target(desc), value);
        names.emplace_back(s.name);
    }
    const std::string nearest = nearest_word(name, names);
    if (nearest.empty()) return error("unknown setting \"{}\", loam info --settings lists them", name);
    return error("unknown setting \"{}\", did you mean {}?", name, nearest);
}

Status change_settings(RendererDesc& desc, std::string_view text) {
    RendererDesc changed = desc;
    while (!text.empty()) {
        const std::string_view one = text.substr(0, text.find(','));
        text.remove_prefix(std::min(text.size(), one.size() + 1));
        const size_t equals = one.find('=');
        if (equals == std::string_view::npos) return error("\"{}\" is not NAME=VALUE", one);
        LOAM_TRY(change_setting(changed, one.substr(0, equals), one.substr(equals + 1)));
    }
    desc = changed;
    return {};
}

}  // namespace loam
