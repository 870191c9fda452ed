// Arguments of `loam VERB …`: each verb states its options, the parser checks them, help is written from the
// same table.
#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "editor/nearest_word.h"
#include "editor/session.h"
#include "editor/text_numbers.h"
#include "runtime/base/result.h"

namespace loam::cli {

enum class ValueKind { none, text, number, integer, size, camera, look_at, numbers };

struct Option {
    const char* name;  // "--size"; "-o" is allowed, too
    ValueKind kind = ValueKind::none;
    const char* value = "";  // as shown in help: "WxH"
    const char* help = "";
    int count = 1;  // values that follow; with 0 … 1 of `none` there are none
};

struct Positional {
    const char* name;  // "PROJECT"
    const char* help;
};

class Args {
  public:
    [[nodiscard]] const std::string& positional(size_t i) const { return positionals_[i]; }
    [[nodiscard]] bool has(std::string_view option) const { return values_.contains(std::string(option)); }
    // The parser has checked the values' form: these cannot fail, and return `otherwise` when the option is
    // absent.
    [[nodiscard]] std::string text(std::string_view option, std::string_view otherwise = "") const;
    [[nodiscard]] double number(std::string_view option, double otherwise, size_t which = 0) const;
    [[nodiscard]] int integer(std::string_view option, int otherwise) const;
    [[nodiscard]] PixelSize size(std::string_view option, PixelSize otherwise) const;
    [[nodiscard]] std::vector<double> numbers(std::string_view option) const;

  private:
    friend Result<Args> parse_args(std::span<const Positional>, std::span<const Option>,
                                   std::span<const std::string>);
    std::vector<std::string> positionals_;
    std::map<std::string, std::vector<std::string>> values_;
};

// Every positional is needed. "--name=value" and "--name value" are the same. "--" ends the options.
[[nodiscard]] Result<Args> parse_args(std::span<const Positional> positionals,
                                      std::span<const Option> options,
                                      std::span<const std::string> arguments);

}  // namespace loam::cli
