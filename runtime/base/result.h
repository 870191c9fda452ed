// Errors of the world (files, devices, shaders, scripts) travel as values; bugs of ours abort (check.h).
//
// An error is one clear sentence: what was wrong, where, what to do. It starts lower case and ends without a
// stop, so that callers can put "cannot open project: " before it.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

#include <fmt/core.h>

namespace loam {

struct Error {
    std::string message;
};

// error("page {} of {} is cut short", a, b)
template <typename... Args>
[[nodiscard]] Error error(fmt::format_string<Args...> format, Args&&... args) {
    return Error{fmt::format(format, std::forward<Args>(args)...)};
}

template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    [[nodiscard]] bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    [[nodiscard]] T& value() & { return std::get<0>(state_); }
    [[nodiscard]] const T& value() const& { return std::get<0>(state_); }
    [[nodiscard]] T&& value() && { return std::get<0>(std::move(state_)); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    [[nodiscard]] const std::string& message() const { return std::get<1>(state_).message; }
    [[nodiscard]] Error error() const { return std::get<1>(state_); }

  private:
    std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}

    [[nodiscard]] bool ok() const { return !error_.has_value(); }
    explicit operator bool() const { return ok(); }
    [[nodiscard]] const std::string& message() const { return error_->message; }
    [[nodiscard]] Error error() const { return *error_; }

  private:
    std::optional<Error> error_;
};

using Status = Result<void>;

} // namespace loam

// Evaluates a Status or Result and returns its error from the enclosing function, if any.
#define LOAM_TRY(expression)                                     \
    do {                                                         \
        if (auto loam_status_ = (expression); !loam_status_.ok()) \
            return loam_status_.error();                         \
    } while (false)
