// SPDX-License-Identifier: MIT
// Decimals to doubles and back, exactly, by whole numbers of any size. Slow (about a microsecond)
// and the same everywhere.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "puppetri/base/bit_cast.h"
#include "puppetri/base/natural.h"
#include "puppetri/base/require.h"
#include "puppetri/base/text.h"

namespace puppetri {
namespace {

// A finite double as mantissa * 2^exponent.
struct Binary {
    std::uint64_t mantissa;
    int exponent;
    bool lowest_of_its_power;  // the gap below it is half the gap above
};
Binary split(double size) {
    const std::uint64_t bits = puppetri::bit_cast<std::uint64_t>(size);
    const std::uint64_t fraction = bits & 0xFFFFFFFFFFFFFu;
    const int biased = static_cast<int>(bits >> 52) & 0x7FF;
    if (biased == 0) {
        return {.mantissa = fraction, .exponent = -1074, .lowest_of_its_power = false};
    }
    return {.mantissa = fraction | std::uint64_t{1} << 52,
            .exponent = biased - 1075,
            .lowest_of_its_power = fraction == 0 && biased > 1};
}

// 0.d1 d2 d3 ... * 10^point
struct Decimal {
    std::string digits;
    int point = 0;
};

// The value is r / s; half the gaps to the neighbours are below / s and above / s. Digits are
// produced until the rest identifies the double (its own bounds included when its mantissa is even,
// as readers round ties to even). Source  Steele and White (see text.h), algorithm FPP squared; the
// fixup loop of section 4 in its simplest form.
Decimal shortest(double size) {
    const Binary x = split(size);
    const bool even = x.mantissa % 2 == 0;
    Natural r(x.mantissa);
    Natural s(1);
    Natural below(1);
    Natural above(1);
    const unsigned wider = x.lowest_of_its_power ? 1 : 0;
    r <<= 1 + wider;
    s <<= 1 + wider;
    above <<= wider;
    if (x.exponent >= 0) {
        const unsigned bits = static_cast<unsigned>(x.exponent);
        r <<= bits;
        below <<= bits;
        above <<= bits;
    } else {
        s <<= static_cast<unsigned>(-x.exponent);
    }
    const auto overshoots = [&] {  // r + above beyond s
        Natural sum = r;
        sum += above;
        return even ? sum >= s : sum > s;
    };
    // 10^(point - 1) <= value < 10^point: an estimate that is at most a little low, then corrected.
    const int binary_size = x.exponent + static_cast<int>(std::bit_width(x.mantissa));
    Decimal decimal;
    decimal.point = static_cast<int>((binary_size - 1) * 30103 / 100000) - 1;
    if (decimal.point > 0) {
        s.multiply_power_of_ten(static_cast<unsigned>(decimal.point));
    } else {
        const unsigned up = static_cast<unsigned>(-decimal.point);
        r.multiply_power_of_ten(up);
        below.multiply_power_of_ten(up);
        above.multiply_power_of_ten(up);
    }
    while (overshoots()) {
        s *= 10;
        ++decimal.point;
    }
    for (;;) {
        r *= 10;
        below *= 10;
        above *= 10;
        char digit = '0';
        while (r >= s) {
            r -= s;
            ++digit;
        }
        const bool low = even ? r <= below : r < below;
        const bool high = overshoots();
        if (!low && !high) {
            decimal.digits += digit;
            continue;
        }
        Natural twice = r;
        twice <<= 1;
        const bool up = high && (!low || twice > s || (twice == s && (digit - '0') % 2 != 0));
        decimal.digits += static_cast<char>(up ? digit + 1 : digit);
        return decimal;
    }
}

std::optional<std::string> not_finite(double x) {
    if (x != x) {
        return "NaN";
    }
    if (std::fabs(x) == std::numeric_limits<double>::infinity()) {
        return x > 0 ? "Infinity" : "-Infinity";
    }
    return std::nullopt;
}

// "00123", 3 -> "00.123"; zeros are put in front as needed.
std::string with_point(std::string digits, unsigned decimals) {
    if (digits.size() <= decimals) {
        digits.insert(0, decimals + 1 - digits.size(), '0');
    }
    if (decimals != 0) {
        digits.insert(digits.size() - decimals, 1, '.');
    }
    return digits;
}

}  // namespace

std::string number_to_text(double x) {
    if (const std::optional<std::string> name = not_finite(x)) {
        return *name;
    }
    if (x == 0) {
        return "0";
    }
    const Decimal d = shortest(std::fabs(x));
    const int count = static_cast<int>(d.digits.size());
    std::string text = x < 0 ? "-" : "";
    if (d.point >= count && d.point <= 21) {
        text += d.digits;
        text.append(static_cast<std::size_t>(d.point - count), '0');
    } else if (d.point > 0 && d.point <= 21) {
        text += d.digits.substr(0, static_cast<std::size_t>(d.point)) + "." +
                d.digits.substr(static_cast<std::size_t>(d.point));
    } else if (d.point > -6 && d.point <= 0) {
        text += "0.";
        text.append(static_cast<std::size_t>(-d.point), '0');
        text += d.digits;
    } else {
        const int exponent = d.point - 1;
        text += d.digits[0];
        if (count > 1) {
            text += "." + d.digits.substr(1);
        }
        text += exponent < 0 ? "e-" : "e+";
        text += std::to_string(exponent < 0 ? -exponent : exponent);
    }
    return text;
}

std::string number_to_text_fixed(double x, unsigned decimals) {
    PUP_REQUIRE(decimals <= 20);
    if (const std::optional<std::string> name = not_finite(x)) {
        return *name;
    }
    const Binary b = split(std::fabs(x));
    Natural n(b.mantissa);
    n.multiply_power_of_ten(decimals);
    if (b.exponent >= 0) {
        n <<= static_cast<unsigned>(b.exponent);
    }
    bool half = false;
    bool more = false;
    for (int i = b.exponent; i < 0 && !(n.zero() && !half); ++i) {
        more = more || half;
        half = n.divide(2) != 0;
    }
    if (half && (more || n.odd())) {
        n += 1;
    }
    const bool negative = x < 0 && !n.zero();
    return (negative ? "-" : "") + with_point(n.decimal(), decimals);
}

std::string decimal_to_text(std::int64_t numerator, unsigned decimals) {
    const std::uint64_t size = numerator < 0 ? 0 - static_cast<std::uint64_t>(numerator)
                                             : static_cast<std::uint64_t>(numerator);
    return (numerator < 0 ? "-" : "") + with_point(std::to_string(size), decimals);
}

namespace {

// digits * 10^exponent, as written. Of more than 800 digits the rest can only break a tie.
struct Written {
    std::string digits;  // without leading zeros
    int exponent = 0;
    bool negative = false;
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<Written> read_written(std::string_view text) {
    constexpr std::size_t kMostDigits = 800;
    constexpr int kLargestExponent = 100000;
    Written w;
    std::size_t i = 0;
    if (i < text.size() && (text[i] == '-' || text[i] == '+')) {
        w.negative = text[i++] == '-';
    }
    bool any = false;
    bool point = false;
    for (; i < text.size() && (is_digit(text[i]) || (text[i] == '.' && !point)); ++i) {
        if (text[i] == '.') {
            point = true;
            continue;
        }
        any = true;
        if (w.digits.size() < kMostDigits) {
            if (text[i] != '0' || !w.digits.empty()) {
                w.digits += text[i];
            }
            w.exponent -= point ? 1 : 0;
        } else {
            w.digits.back() = text[i] != '0' && w.digits.back() == '0' ? '1' : w.digits.back();
            w.exponent += point ? 0 : 1;
        }
    }
    if (!any) {
        return std::nullopt;
    }
    if (i < text.size() && (text[i] == 'e' || text[i] == 'E')) {
        ++i;
        bool minus = false;
        if (i < text.size() && (text[i] == '-' || text[i] == '+')) {
            minus = text[i++] == '-';
        }
        if (i >= text.size()) {
            return std::nullopt;
        }
        int exponent = 0;
        for (; i < text.size() && is_digit(text[i]); ++i) {
            exponent = std::min(exponent * 10 + (text[i] - '0'), kLargestExponent);
        }
        w.exponent += minus ? -exponent : exponent;
    }
    if (i != text.size()) {
        return std::nullopt;
    }
    return w;
}

double power_of_two(int k) {  // -1022 <= k <= 1023
    return puppetri::bit_cast<double>(static_cast<std::uint64_t>(k + 1023) << 52);
}

// n / d, both above 0, as the nearest double: a quotient of 53 bits (fewer for subnormals) by
// shifting and subtracting.
std::optional<double> nearest_quotient(Natural n, Natural d) {
    int exponent = static_cast<int>(n.bit_count()) - static_cast<int>(d.bit_count());
    if (exponent > 1025) {
        return std::nullopt;
    }
    if (exponent < -1080) {
        return 0.0;
    }
    (exponent >= 0 ? d : n) <<= static_cast<unsigned>(exponent >= 0 ? exponent : -exponent);
    if (n < d) {
        n <<= 1;
        --exponent;
    }
    // Now 1 <= n/d < 2 and the value is n/d * 2^exponent.
    const int bits = exponent >= -1022 ? 53 : 53 - (-1022 - exponent);
    if (bits < 0) {
        return 0.0;
    }
    std::uint64_t quotient = 0;
    for (int i = 0; i < bits; ++i) {
        quotient <<= 1;
        if (n >= d) {
            n -= d;
            quotient |= 1;
        }
        n <<= 1;
    }
    // n / d is now the rest in units of half of the last place (of bits == 0: the value itself is
    // that).
    if (bits > 0 ? n > d || (n == d && quotient % 2 != 0) : n > d) {
        ++quotient;
    }
    // The last bit of the quotient counts 2^(exponent - bits + 1).
    const int scale = exponent - bits + 1;
    double value = static_cast<double>(quotient);
    const int half = scale / 2;
    value = value * power_of_two(half) * power_of_two(scale - half);
    if (value == std::numeric_limits<double>::infinity()) {
        return std::nullopt;
    }
    return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
    const std::optional<Written> w = read_written(text);
    if (!w) {
        return std::nullopt;
    }
    const double sign = w->negative ? -1 : 1;
    if (w->digits.empty()) {
        return sign * 0.0;
    }
    if (w->digits.size() <= 15 && w->exponent >= -22 && w->exponent <= 22) {
        // Both numbers are exact, so that one operation rounds once (W. Clinger, PLDI 1990).
        double value = 0;
        for (const char c : w->digits) {
            value = value * 10 + (c - '0');
        }
        double power = 1;
        for (int i = 0; i < (w->exponent < 0 ? -w->exponent : w->exponent); ++i) {
            power *= 10;
        }
        return sign * (w->exponent < 0 ? value / power : value * power);
    }
    const int magnitude = static_cast<int>(w->digits.size()) + w->exponent;
    if (magnitude > 310) {
        return std::nullopt;
    }
    if (magnitude < -330) {
        return sign * 0.0;
    }
    Natural n;
    for (const char c : w->digits) {
        n *= 10;
        n += static_cast<std::uint64_t>(c - '0');
    }
    Natural d(1);
    if (w->exponent >= 0) {
        n.multiply_power_of_ten(static_cast<unsigned>(w->exponent));
    } else {
        d.multiply_power_of_ten(static_cast<unsigned>(-w->exponent));
    }
    const std::optional<double> value = nearest_quotient(std::move(n), std::move(d));
    return value ? std::optional<double>(sign * *value) : std::nullopt;
}

}  // namespace puppetri
