#include "editor/cli/args.h"

#include <algorithm>
#include <limits>

#include "runtime/base/check.h"

namespace loam::cli {

namespace {

Status check_value(const Option& option, const std::string& value) {
    const auto named = [&](const std::string& message) { return error("{}: {}", option.name, message); };
    switch (option.kind) {
        case ValueKind::none:
        case ValueKind::text:
            return {};
        case ValueKind::number:
            if (auto v = parse_number(value); !v) return named(v.message());
            return {};
        case ValueKind::integer: {
            auto v = parse_integer(value);
            if (!v) return named(v.message());
            if (*v < std::numeric_limits<int>::min() || *v > std::numeric_limits<int>::max())
                return named(fmt::format("{} is too large", value));
            return {};
        }
        case ValueKind::size:
            if (auto v = parse_size(value); !v) return named(v.message());
            return {};
        case ValueKind::camera:
            if (auto v = parse_camera(value); !v) return named(v.message());
            return {};
        case ValueKind::look_at:
            if (auto v = parse_look_at(value); !v) return named(v.message());
            return {};
        case ValueKind::numbers:
            if (auto v = parse_numbers(value); !v) return named(v.message());
            return {};
    }
    return {};
}

Error unknown_option(const std::string& name, std::span<const Option> options) {
    std::vector<std::string> names;
    for (const Option& option : options) names.emplace_back(option.name);
    const std::string nearest = nearest_word(name, names);
    if (nearest.empty()) return error("unknown option {}", name);
    return error("unknown option {}, did you mean {}?", name, nearest);
}

bool looks_like_option(const std::string& word) {
    // "-5" and "-.5" are numbers.
    return word.size() > 1 && word[0] == '-' && !(word[1] >= '0' && word[1] <= '9') && word[1] != '.';
}

}  // namespace

Result<Args> parse_args(std::span<const Positional> positionals, std::span<const Option> options,
                        std::span<const std::string> arguments) {
    Args args;
    bool options_ended = false;
    for (size_t i = 0; i < arguments.size(); ++i) {
        const std::string& word = arguments[i];
        if (options_ended || !looks_like_option(word)) {
            if (args.positionals_.size() == positionals.size())
                return error("unexpected argument \"{}\"", word);
            args.positionals_.push_back(word);
            continue;
        }
        if (word == "--") {
            options_ended = true;
            continue;
        }
        const size_t equals = word.find('=');
        const std::string name = word.substr(0, equals);
        const auto option =
            std::find_if(options.begin(), options.end(), [&](const Option& o) { return name == o.name; });
        if (option == options.end()) return unknown_option(name, options);
        if (args.values_.contains(name)) return error("option {} is given twice", name);
        std::vector<std::string>& values = args.values_[name];
        if (option->kind == ValueKind::none) {
            if (equals != std::string::npos) return error("option {} takes no value", name);
            continue;
        }
        if (equals != std::string::npos) values.push_back(word.substr(equals + 1));
        while (static_cast<int>(values.size()) < option->count) {
            if (i + 1 >= arguments.size())
                return error("option {} needs {} ({})", name,
                             option->count == 1 ? "a value" : fmt::format("{} values", option->count),
                             option->value);
            values.push_back(arguments[++i]);
        }
        for (const std::string& value : values) LOAM_TRY(check_value(*option, value));
    }
    if (args.positionals_.size() < positionals.size())
        return error("{} is missing ({})", positionals[args.positionals_.size()].name,
                     positionals[args.positionals_.size()].help);
    return args;
}

std::string Args::text(std::string_view option, std::string_view otherwise) const {
    const auto found = values_.find(std::string(option));
    return found == values_.end() || found->second.empty() ? std::string(otherwise) : found->second[0];
}

double Args::number(std::string_view option, double otherwise, size_t which) const {
    const auto found = values_.find(std::string(option));
    if (found == values_.end()) return otherwise;
    LOAM_CHECK(which < found->second.size(), std::string(option));
    return parse_number(found->second[which]).value();
}

int Args::integer(std::string_view option, int otherwise) const {
    return has(option) ? static_cast<int>(parse_integer(text(option)).value()) : otherwise;
}

PixelSize Args::size(std::string_view option, PixelSize otherwise) const {
    return has(option) ? parse_size(text(option)).value() : otherwise;
}

std::vector<double> Args::numbers(std::string_view option) const {
    return has(option) ? parse_numbers(text(option)).value() : std::vector<double>{};
}

}  // namespace loam::cli
