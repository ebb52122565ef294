// SPDX-License-Identifier: MIT
// Text: UTF-8 that is checked once at the door, columns as people count them, the nearest known
// name, and numbers printed and read the same way on every system and in every locale.
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace puppetri {

// The byte offset of the first byte that does not belong to well-formed UTF-8 (overlong forms,
// surrogates and values above U+10FFFF are not well formed), or nullopt. Source  The Unicode
// Standard 15, table 3-7.
std::optional<std::size_t> find_invalid_utf8(std::string_view text);

// The number of code points; of ill-formed text, the number of bytes that are not continuation
// bytes.
std::uint32_t count_code_points(std::string_view text);

// The column (from 1, in code points) of a byte offset within one line.
std::uint32_t column_of(std::string_view line, std::size_t byte_offset);

// How many insertions, deletions, replacements and swaps of neighbours make a out of b, no place
// edited twice. Counts bytes. Cost O(|a| |b|). Source  optimal string alignment; F. Damerau, CACM 7
// (1964).
std::uint32_t edit_distance(std::string_view a, std::string_view b);

// The known name nearest to an unknown one, or "" when none is near enough to be meant: at most a
// third of the longer one's bytes, at least one edit. Of equally near names the first. A difference
// of case alone counts as half an edit.
std::string_view nearest_name(std::string_view unknown, std::span<const std::string> known);

// The shortest decimal that reads back as the same double, in the style of JavaScript's String(x):
// "0.1", "-12", "1e+21", "1.5e-7", "NaN", "Infinity". -0 is "0". Source  R. Steele, J. White, "How
// to print floating-point numbers accurately", PLDI 1990, with exact integers.
std::string number_to_text(double x);

// x rounded to this many decimals (0 to 20), ties to even on the exact value: "1.50", "-0.25";
// never "-0.00". For a NaN or infinity as number_to_text.
std::string number_to_text_fixed(double x, unsigned decimals);

// numerator / 10^decimals without rounding: 1234, 3 -> "1.234". For times that are exact in
// decimals.
std::string decimal_to_text(std::int64_t numerator, unsigned decimals);

// Reads a whole text as one number: optional sign, digits with an optional point, optional
// exponent. The nearest double, ties to even. nullopt for anything else, also for surrounding
// space, "nan", "inf" and what overflows.
std::optional<double> parse_number(std::string_view text);

// The name of a file without its folders and from its first dot on: "a/b/dinner.tuples" ->
// "dinner".
std::string_view stem_of(std::string_view path);

}  // namespace puppetri
