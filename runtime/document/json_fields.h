// Reading JSON objects field by field, for the files that turn commands and operators into text. Internal to
// this folder.
#pragma once

#include <cmath>
#include <set>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace loam {

using Json = nlohmann::json;

struct Refused {
    std::string message;
};

template <typename... Args>
[[noreturn]] void refuse(fmt::format_string<Args...> format, Args&&... args) {
    throw Refused{fmt::format(format, std::forward<Args>(args)...)};
}

// An object's fields: every one asked for is marked, and finish() refuses what nobody asked for.
class Fields {
  public:
    Fields(const Json& object, std::string place) : object_(object), place_(std::move(place)) {
        if (!object.is_object()) refuse("{} must be an object, found {}", place_, object.type_name());
    }
    [[nodiscard]] const std::string& place() const { return place_; }

    const Json* find(const char* key) {
        known_.insert(key);
        const auto found = object_.find(key);
        return found == object_.end() ? nullptr : &*found;
    }
    const Json& need(const char* key) {
        if (const Json* value = find(key)) return *value;
        refuse("{}: \"{}\" is missing", place_, key);
    }

    double number(const char* key) { return number_of(need(key), key); }
    double number(const char* key, double otherwise) {
        const Json* value = find(key);
        return value ? number_of(*value, key) : otherwise;
    }
    uint64_t whole(const char* key, uint64_t most) { return whole_of(need(key), key, most); }
    uint64_t whole(const char* key, uint64_t most, uint64_t otherwise) {
        const Json* value = find(key);
        return value ? whole_of(*value, key, most) : otherwise;
    }
    bool truth(const char* key, bool otherwise) { return find(key) ? truth(key) : otherwise; }
    bool truth(const char* key) {
        const Json& value = need(key);
        if (!value.is_boolean())
            refuse("{}: \"{}\" must be true or false, found {}", place_, key, value.type_name());
        return value.get<bool>();
    }
    std::string text(const char* key) { return text_of(need(key), key); }
    std::string text_of(const Json& value, const char* key) const {
        if (!value.is_string()) refuse("{}: \"{}\" must be a text, found {}", place_, key, value.type_name());
        return value.get<std::string>();
    }
    double number_of(const Json& value, const std::string& what) const {
        if (!value.is_number())
            refuse("{}: \"{}\" must be a number, found {}", place_, what, value.type_name());
        const double number = value.get<double>();
        if (!std::isfinite(number)) refuse("{}: \"{}\" must be a finite number", place_, what);
        return number;
    }
    const Json& list(const char* key) {
        const Json& value = need(key);
        if (!value.is_array()) refuse("{}: \"{}\" must be a list, found {}", place_, key, value.type_name());
        return value;
    }

    void finish() const {
        for (const auto& [key, value] : object_.items()) {
            if (known_.count(key) != 0) continue;
            std::string known;
            for (const std::string& name : known_) {
                if (!known.empty()) known += ", ";
                known += name;
            }
            refuse("{}: unknown key \"{}\" (known: {})", place_, key, known);
        }
    }

  private:
    uint64_t whole_of(const Json& value, const char* key, uint64_t most) const {
        if (!value.is_number_integer())
            refuse("{}: \"{}\" must be a whole number, found {}", place_, key,
                   value.is_number() ? value.dump() : value.type_name());
        if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
            refuse("{}: \"{}\" is {}, must be 0 … {}", place_, key, value.dump(), most);
        return value.get<uint64_t>();
    }

    const Json& object_;
    std::string place_;
    std::set<std::string> known_;
};

inline constexpr uint64_t kMaxU32 = 0xffffffffu;
inline constexpr uint64_t kMaxId = uint64_t(1) << 62;

}  // namespace loam
