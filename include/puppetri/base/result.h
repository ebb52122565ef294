// SPDX-License-Identifier: MIT
// Result<T, E>: a value or the reason why there is none. Named like std::expected, so that it can
// become an alias of it.
#pragma once
#include <utility>
#include <variant>

#include "puppetri/base/require.h"

namespace puppetri {

template <class E>
class Unexpected {
 public:
    constexpr explicit Unexpected(E error) : error_(std::move(error)) {}
    constexpr E& error() { return error_; }

 private:
    E error_;
};

template <class T, class E>
class [[nodiscard]] Result {
 public:
    using value_type = T;
    using error_type = E;

    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Unexpected<E> error) : state_(std::in_place_index<1>, std::move(error.error())) {}

    bool has_value() const { return state_.index() == 0; }
    explicit operator bool() const { return has_value(); }

    // Needs has_value(); aborts otherwise.
    T& value() & { return *checked(std::get_if<0>(&state_)); }
    const T& value() const& { return *checked(std::get_if<0>(&state_)); }
    T&& value() && { return std::move(*checked(std::get_if<0>(&state_))); }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(*this).value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    // Needs !has_value(); aborts otherwise.
    E& error() & { return *checked(std::get_if<1>(&state_)); }
    const E& error() const& { return *checked(std::get_if<1>(&state_)); }
    E&& error() && { return std::move(*checked(std::get_if<1>(&state_))); }

 private:
    template <class P>
    static P checked(P pointer) {
        PUP_REQUIRE(pointer != nullptr);
        return pointer;
    }
    std::variant<T, E> state_;
};

struct Ok {};

}  // namespace puppetri

#define PUP_CONCAT_(a, b) a##b
#define PUP_CONCAT(a, b) PUP_CONCAT_(a, b)
#define PUP_TRY_(name, declaration, expression)                 \
    auto name = (expression);                                   \
    if (!name.has_value()) {                                    \
        return ::puppetri::Unexpected(std::move(name).error()); \
    }                                                           \
    declaration = std::move(name).value()
// PUP_TRY(T x, f()): x = value of f(), or return f()'s error. Two statements: brace the branch it
// stands in.
#define PUP_TRY(declaration, expression) \
    PUP_TRY_(PUP_CONCAT(pup_try_, __LINE__), declaration, expression)
