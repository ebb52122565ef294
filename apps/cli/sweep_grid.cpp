// SPDX-License-Identifier: MIT
#include "sweep_grid.h"

#include <cstdint>
#include <optional>

#include "puppetri/base/rational.h"

namespace puppetri::cli {
namespace {

constexpr std::size_t kMostValues = 10'000;

std::string trimmed(const std::string& text) {
    const std::size_t begin = text.find_first_not_of(" \t");
    const std::size_t end = text.find_last_not_of(" \t");
    return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

// At commas outside of brackets.
std::vector<std::string> split_list(const std::string& text) {
    std::vector<std::string> parts(1);
    int depth = 0;
    for (const char c : text) {
        depth += c == '(' || c == '[' ? 1 : c == ')' || c == ']' ? -1 : 0;
        if (c == ',' && depth == 0) {
            parts.emplace_back();
        } else {
            parts.back() += c;
        }
    }
    for (std::string& part : parts) {
        part = trimmed(part);
    }
    return parts;
}

// "-0.25 s": a decimal number in units of its last digit, and what follows.
struct Decimal {
    std::int64_t digits = 0;
    int places = 0;  // behind the point
    std::string unit;
};

std::optional<Decimal> decimal(const std::string& text) {
    constexpr std::int64_t kMost = 900'000'000'000'000;
    Decimal d;
    std::size_t i = 0;
    const bool negative = i < text.size() && text[i] == '-';
    i += negative;
    bool point = false, any = false;
    for (; i < text.size(); ++i) {
        if (text[i] == '.' && !point && !(i + 1 < text.size() && text[i + 1] == '.')) {
            point = true;
        } else if (text[i] >= '0' && text[i] <= '9' && d.digits < kMost) {
            d.digits = 10 * d.digits + (text[i] - '0');
            d.places += point;
            any = true;
        } else {
            break;
        }
    }
    d.digits = negative ? -d.digits : d.digits;
    d.unit = trimmed(text.substr(i));
    if (!any || d.places > 9 || d.unit.find_first_of("0123456789(.") != std::string::npos) {
        return std::nullopt;
    }
    return d;
}

void widen(Decimal& d, int places) {
    for (; d.places < places; ++d.places) {
        d.digits *= 10;
    }
}

std::string written(std::int64_t digits, int places, const std::string& unit) {
    const bool negative = digits < 0;
    std::string text = std::to_string(negative ? -digits : digits);
    if (places > 0) {
        const auto width = static_cast<std::size_t>(places);
        text.insert(0, text.size() <= width ? width + 1 - text.size() : 0, '0');
        text.insert(text.size() - width, ".");
        text.erase(text.find_last_not_of('0') + 1);
        if (text.back() == '.') {
            text.pop_back();
        }
    }
    return (negative ? "-" : "") + text + (unit.empty() ? "" : " " + unit);
}

Result<std::vector<std::string>, std::string> parse_range(const std::string& text) {
    const std::size_t dots = text.find("..");
    const std::size_t by = text.find(" by ", dots);
    auto low = decimal(trimmed(text.substr(0, dots)));
    auto high =
        decimal(trimmed(text.substr(dots + 2, by == std::string::npos ? by : by - dots - 2)));
    std::optional<Decimal> step =
        by == std::string::npos ? Decimal{1, 0, ""} : decimal(trimmed(text.substr(by + 4)));
    if (!low || !high || !step) {
        return Unexpected("'" + text +
                          "' is no range of numbers: write 2..6, or 5 s .. 20 s by 5 s");
    }
    if (by == std::string::npos && (!high->unit.empty() || high->places + low->places > 0)) {
        return Unexpected("'" + text + "' needs a step: write " + text + " by STEP");
    }
    const std::string unit = high->unit;
    if ((!low->unit.empty() && low->unit != unit) || (!step->unit.empty() && step->unit != unit)) {
        return Unexpected("'" + text + "' has several units: write all numbers in one");
    }
    const int places = std::max(step->places, std::max(low->places, high->places));
    widen(*low, places);
    widen(*high, places);
    widen(*step, places);
    if (step->digits <= 0 || high->digits < low->digits) {
        return Unexpected("'" + text +
                          "' is empty: the step has to be above 0, and the end not "
                          "below the beginning");
    }
    if ((high->digits - low->digits) / step->digits >= static_cast<std::int64_t>(kMostValues)) {
        return Unexpected("'" + text + "' has more than 10000 values");
    }
    std::vector<std::string> values;
    for (std::int64_t x = low->digits; x <= high->digits; x += step->digits) {
        values.push_back(written(x, places, unit));
    }
    return values;
}

}  // namespace

Result<Varied, std::string> parse_varied(const std::string& text) {
    const std::size_t equals = text.find('=');
    Varied v;
    v.path = trimmed(text.substr(0, equals));
    if (equals == std::string::npos || v.path.empty()) {
        return Unexpected("'" + text +
                          "' names no parameter: write PARAMETER=VALUES, as a.out=2..6");
    }
    const std::string values = trimmed(text.substr(equals + 1));
    const std::vector<std::string> parts = split_list(values);
    // 1 .. 3 s inside of brackets is an interval of the language
    const bool range = parts.size() == 1 && values.find("..") != std::string::npos &&
                       values.find_first_of("([") == std::string::npos;
    if (range) {
        PUP_TRY(v.values, parse_range(values));
    } else {
        v.values = parts;
    }
    for (const std::string& value : v.values) {
        if (value.empty()) {
            return Unexpected("'" + text + "' has an empty value");
        }
    }
    return v;
}

std::vector<std::vector<scene::Setting>> grid(const std::vector<Varied>& varied) {
    std::vector<std::vector<scene::Setting>> points(1);
    for (const Varied& v : varied) {
        std::vector<std::vector<scene::Setting>> more;
        for (const std::vector<scene::Setting>& point : points) {
            for (const std::string& value : v.values) {
                more.push_back(point);
                more.back().push_back({v.path, value});
            }
        }
        points = std::move(more);
    }
    return points;
}

}  // namespace puppetri::cli
