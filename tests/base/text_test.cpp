// SPDX-License-Identifier: MIT
// UTF-8, columns, nearest names, and numbers as text.
#include "puppetri/base/text.h"

#include <doctest/doctest.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include "puppetri/base/bit_cast.h"
#include "puppetri/base/random.h"

using namespace puppetri;
using namespace std::string_literals;

TEST_CASE("well-formed UTF-8 of every length is accepted, at the borders of its ranges [unit]") {
    for (const std::string& text : {""s, "plain"s, "\xC2\x80"s, "\xDF\xBF"s, "\xE0\xA0\x80"s,
                                    "\xED\x9F\xBF"s, "\xEE\x80\x80"s, "\xEF\xBF\xBF"s,
                                    "\xF0\x90\x80\x80"s, "\xF4\x8F\xBF\xBF"s, "zero \0 byte"s}) {
        CHECK(!find_invalid_utf8(text));
    }
}

TEST_CASE("ill-formed UTF-8 is found where its sequence begins [hostile]") {
    for (const std::string& bad :
         {"\x80"s, "\xBF"s, "\xC0\x80"s, "\xC1\xBF"s, "\xC2"s, "\xC2 "s, "\xE0\x9F\xBF"s,
          "\xED\xA0\x80"s, "\xE2\x82"s, "\xF0\x8F\xBF\xBF"s, "\xF4\x90\x80\x80"s,
          "\xF5\x80\x80\x80"s, "\xFF"s, "\xF0\x90\x80"s}) {
        CHECK(find_invalid_utf8("ab" + bad) == 2);
        CHECK(find_invalid_utf8(bad + "ab") == 0);
    }
}

TEST_CASE("columns count code points from 1 [unit]") {
    const std::string line = "h\xC3\xA4nd \xE2\x9C\x8B x";
    CHECK(column_of(line, 0) == 1);
    CHECK(column_of(line, 3) == 3);
    CHECK(column_of(line, line.size() - 1) == 8);
    CHECK(column_of(line, 1000) == 9);
}

TEST_CASE("edit distance counts a swap of neighbours as one [unit]") {
    CHECK(edit_distance("", "") == 0);
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("throw", "thorw") == 1);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("ca", "abc") == 3);  // optimal string alignment: no place edited twice
}

TEST_CASE("edit distance is a symmetric count that agrees with plain recursion [oracle]") {
    const auto slow = [](const auto& self, std::string_view a,
                         std::string_view b) -> std::uint32_t {
        if (a.empty() || b.empty()) {
            return static_cast<std::uint32_t>(a.size() + b.size());
        }
        std::uint32_t best = self(self, a.substr(1), b.substr(1)) + (a[0] == b[0] ? 0 : 1);
        best = std::min(best, self(self, a.substr(1), b) + 1);
        best = std::min(best, self(self, a, b.substr(1)) + 1);
        if (a.size() > 1 && b.size() > 1 && a[0] == b[1] && a[1] == b[0]) {
            best = std::min(best, self(self, a.substr(2), b.substr(2)) + 1);
        }
        return best;
    };
    RandomStream stream{.key = 4, .count = 0};
    for (int i = 0; i < 300; ++i) {
        std::string a(stream.below(6), 'a');
        std::string b(stream.below(6), 'a');
        for (char& c : a) {
            c = static_cast<char>('a' + stream.below(3));
        }
        for (char& c : b) {
            c = static_cast<char>('a' + stream.below(3));
        }
        CHECK(edit_distance(a, b) == slow(slow, a, b));
        CHECK(edit_distance(a, b) == edit_distance(b, a));
    }
}

TEST_CASE("the nearest name is the one that was meant, or none [unit]") {
    const std::vector<std::string> known = {"throwing", "to_throw", "can_grasp", "P1", "p10"};
    CHECK(nearest_name("throwin", known) == "throwing");
    CHECK(nearest_name("to_thorw", known) == "to_throw");
    CHECK(nearest_name("Can_Grasp", known) == "can_grasp");
    CHECK(nearest_name("p1", known) == "P1");
    CHECK(nearest_name("elephant", known) == "");
    CHECK(nearest_name("", known) == "");
}

TEST_CASE("numbers print as in JavaScript [unit]") {
    CHECK(number_to_text(0) == "0");
    CHECK(number_to_text(-0.0) == "0");
    CHECK(number_to_text(0.1) == "0.1");
    CHECK(number_to_text(-12) == "-12");
    CHECK(number_to_text(100) == "100");
    CHECK(number_to_text(1e21) == "1e+21");
    CHECK(number_to_text(123456789012345680000.0) == "123456789012345680000");
    CHECK(number_to_text(1.5e-7) == "1.5e-7");
    CHECK(number_to_text(0.000001) == "0.000001");
    CHECK(number_to_text(1.0 / 3) == "0.3333333333333333");
    CHECK(number_to_text(5e-324) == "5e-324");
    CHECK(number_to_text(1.7976931348623157e308) == "1.7976931348623157e+308");
    CHECK(number_to_text(9007199254740993.0) == "9007199254740992");
    CHECK(number_to_text(std::nan("")) == "NaN");
    CHECK(number_to_text(-std::numeric_limits<double>::infinity()) == "-Infinity");
}

TEST_CASE(
    "printed numbers read back as themselves, with the digits of the shortest form [oracle]") {
    RandomStream stream{.key = 6, .count = 0};
    for (int i = 0; i < 20000; ++i) {
        std::uint64_t bits = stream.bits();
        if (i % 4 == 1) {
            bits &= ~std::uint64_t{0} << 52;  // powers of two: the gap below is smaller
        } else if (i % 4 == 2) {
            bits >>= 12;  // subnormals
        }
        double x = puppetri::bit_cast<double>(bits);
        if (i % 4 == 3) {
            x = static_cast<double>(stream.between(-1000000, 1000000)) / 1000;
        }
        if (!std::isfinite(x) || x == 0) {
            continue;
        }
        const std::string text = number_to_text(x);
        CAPTURE(text);
        CHECK(std::strtod(text.c_str(), nullptr) == x);
        CHECK(parse_number(text) == x);
        char shortest[40] = {};
        std::to_chars(shortest, shortest + sizeof shortest, x, std::chars_format::scientific);
        const auto digits_of = [](const std::string& s) {
            std::string only;
            for (const char c : s.substr(0, s.find('e'))) {
                only += c >= '0' && c <= '9' ? std::string(1, c) : "";
            }
            only.erase(0, only.find_first_not_of('0'));
            return only.substr(0, only.find_last_not_of('0') + 1);
        };
        CHECK(digits_of(text) == digits_of(shortest));
    }
}

TEST_CASE("fixed decimals round the exact value, ties to even [oracle]") {
    CHECK(number_to_text_fixed(1.5, 2) == "1.50");
    CHECK(number_to_text_fixed(-0.25, 1) == "-0.2");
    CHECK(number_to_text_fixed(0.375, 2) == "0.38");
    CHECK(number_to_text_fixed(2.5, 0) == "2");
    CHECK(number_to_text_fixed(3.5, 0) == "4");
    CHECK(number_to_text_fixed(-0.001, 2) == "0.00");
    CHECK(number_to_text_fixed(0.005, 2) == "0.01");  // the double lies above 0.005
    CHECK(number_to_text_fixed(1e-300, 3) == "0.000");
    CHECK(number_to_text_fixed(1e22, 1) == "10000000000000000000000.0");
    RandomStream stream{.key = 8, .count = 0};
    for (int i = 0; i < 2000; ++i) {
        const double x =
            (stream.uniform() - 0.5) * std::pow(10.0, static_cast<double>(stream.below(18)));
        const int decimals = static_cast<int>(stream.below(10));
        char wanted[80];
        std::snprintf(wanted, sizeof wanted, "%.*f", decimals, x);
        const std::string w = wanted;
        const bool minus_zero = w[0] == '-' && w.find_first_not_of("-0.") == std::string::npos;
        CHECK(number_to_text_fixed(x, static_cast<unsigned>(decimals)) ==
              (minus_zero ? w.substr(1) : w));
    }
}

TEST_CASE("whole numbers print with a shifted point, exactly [unit]") {
    CHECK(decimal_to_text(1234, 3) == "1.234");
    CHECK(decimal_to_text(-5, 3) == "-0.005");
    CHECK(decimal_to_text(0, 2) == "0.00");
    CHECK(decimal_to_text(7, 0) == "7");
    CHECK(decimal_to_text(INT64_MIN, 1) == "-922337203685477580.8");
}

TEST_CASE("numbers are read to the nearest double, as the C library does [oracle]") {
    RandomStream stream{.key = 10, .count = 0};
    for (int i = 0; i < 20000; ++i) {
        std::string text = stream.below(2) == 0 ? "-" : "";
        const int digits = static_cast<int>(1 + stream.below(25));
        const int point = static_cast<int>(stream.below(30));
        for (int k = 0; k < digits; ++k) {
            text += k == point ? "." : "";
            text += static_cast<char>('0' + stream.below(10));
        }
        text += "e" + std::to_string(stream.between(-345, 300));
        CAPTURE(text);
        const double wanted = std::strtod(text.c_str(), nullptr);
        if (std::isfinite(wanted)) {
            CHECK(parse_number(text) == wanted);
        } else {
            CHECK(!parse_number(text));
        }
    }
}

TEST_CASE("ties between two doubles go to the even one, also when a far digit breaks them [unit]") {
    CHECK(parse_number("9007199254740993") == 9007199254740992.0);
    CHECK(parse_number("9007199254740995") == 9007199254740996.0);
    const std::string zeros(1000, '0');
    CHECK(parse_number("9007199254740993." + zeros) == 9007199254740992.0);
    CHECK(parse_number("9007199254740993." + zeros + "1") == 9007199254740994.0);
    CHECK(parse_number("2.4703282292062327e-324") == 0);       // just below half the smallest
    CHECK(parse_number("2.4703282292062328e-324") == 5e-324);  // just above
    CHECK(parse_number("1e-400") == 0);
    CHECK(parse_number("0." + zeros + "1") == 0);
    CHECK(parse_number("1" + std::string(308, '0')) == 1e308);
    CHECK(parse_number("1.7976931348623158079e308") == 1.7976931348623157e308);
    CHECK(!parse_number("1.7976931348623159e308"));
}

TEST_CASE("what is no number is refused whole [hostile]") {
    for (const char* text : {"", "-", "+", ".", "e5", "1e", "1e+", "1.2.3", " 1", "1 ", "1,5",
                             "nan", "inf", "0x10", "1f", "--1", "1e5.5", "\xD9\xA1"}) {
        CAPTURE(text);
        CHECK(!parse_number(text));
    }
    for (const char* text : {"1", "+1", "1.", "1e0", "01", "0.1E1"}) {
        CHECK(parse_number(text) == 1);
    }
    CHECK(std::signbit(parse_number("-0").value()));
}
