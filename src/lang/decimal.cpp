// SPDX-License-Identifier: MIT
// Reading decimals exactly: the digits as one integer, times a power of ten.
#include "puppetri/lang/decimal.h"

#include <algorithm>
#include <cstdint>

namespace puppetri::lang {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// Of the text behind the `e`. Beyond 1000 nothing fits anyway.
std::optional<int> exponent_of(std::string_view text) {
    const bool negative = text.starts_with('-');
    if (negative || text.starts_with('+')) {
        text.remove_prefix(1);
    }
    if (text.empty() || !std::all_of(text.begin(), text.end(), is_digit)) {
        return std::nullopt;
    }
    int power = 0;
    for (const char d : text) {
        power = std::min(power * 10 + (d - '0'), 1000);
    }
    return negative ? -power : power;
}

}  // namespace

std::optional<Rational> parse_decimal(std::string_view text) {
    std::int64_t digits = 0;
    int exponent = 0;
    bool fits = true, point = false, any = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '.' && !point) {
            point = true;
        } else if ((c == 'e' || c == 'E') && any) {
            const std::optional<int> power = exponent_of(text.substr(i + 1));
            if (!power) {
                return std::nullopt;
            }
            exponent += *power;
            break;
        } else if (is_digit(c)) {
            any = true;
            fits = fits && digits <= (INT64_MAX - (c - '0')) / 10;
            digits = fits ? digits * 10 + (c - '0') : digits;
            exponent -= point ? 1 : 0;
        } else {
            return std::nullopt;
        }
    }
    if (!any || !fits) {
        return std::nullopt;
    }
    if (digits == 0) {
        return Rational{0};
    }
    const std::optional<Rational> scale = power(Rational{10}, exponent);
    return scale ? multiply(Rational{digits}, *scale) : std::nullopt;
}

}  // namespace puppetri::lang
