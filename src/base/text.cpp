// SPDX-License-Identifier: MIT
// UTF-8, columns and the nearest name.
#include "puppetri/base/text.h"

#include <algorithm>
#include <vector>

namespace puppetri {
namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
    return static_cast<unsigned char>(text[i]);
}

bool is_continuation(unsigned byte) { return (byte & 0xC0u) == 0x80; }

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_but_for_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

std::optional<std::size_t> find_invalid_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const unsigned first = byte_at(text, i);
        if (first < 0x80) {
            ++i;
            continue;
        }
        const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
        if (first < 0xC2 || first > 0xF4) {
            return i;
        }
        // The second byte has a narrower range after some first bytes: no overlong forms, no
        // surrogates, no more than U+10FFFF.
        const unsigned low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
        const unsigned high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
        for (std::size_t k = 1; k < length; ++k) {
            if (i + k >= text.size()) {
                return i;
            }
            const unsigned byte = byte_at(text, i + k);
            if (!is_continuation(byte) || (k == 1 && (byte < low || byte > high))) {
                return i;
            }
        }
        i += length;
    }
    return std::nullopt;
}

std::uint32_t count_code_points(std::string_view text) {
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        count += is_continuation(byte_at(text, i)) ? 0 : 1;
    }
    return count;
}

std::uint32_t column_of(std::string_view line, std::size_t byte_offset) {
    return 1 + count_code_points(line.substr(0, byte_offset));
}

std::uint32_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::uint32_t> before_last(b.size() + 1);
    std::vector<std::uint32_t> last(b.size() + 1);
    std::vector<std::uint32_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) {
        row[j] = static_cast<std::uint32_t>(j);
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before_last.swap(last);
        last.swap(row);
        row[0] = static_cast<std::uint32_t>(i);
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::uint32_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({replace, last[j] + 1, row[j - 1] + 1});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before_last[j - 2] + 1);
            }
        }
    }
    return row[b.size()];
}

std::string_view nearest_name(std::string_view unknown, std::span<const std::string> known) {
    constexpr std::size_t kLongestCompared = 256;
    std::string_view best;
    std::size_t best_halves = ~std::size_t{0};  // distance in half edits
    for (const std::string& name : known) {
        const std::size_t longer = std::max(name.size(), unknown.size());
        const std::size_t shorter = std::min(name.size(), unknown.size());
        const std::size_t allowed = std::max<std::size_t>(1, longer / 3);
        if (longer > kLongestCompared || longer - shorter > allowed) {
            continue;
        }
        const std::size_t edits = edit_distance(unknown, name);
        const std::size_t halves =
            equal_but_for_case(unknown, name) ? (edits != 0 ? 1 : 0) : 2 * edits;
        if (halves <= 2 * allowed && edits < longer && halves < best_halves) {
            best = name;
            best_halves = halves;
        }
    }
    return best;
}

std::string_view stem_of(std::string_view path) {
    const std::size_t slash = path.find_last_of("/\\");
    const std::string_view file = slash == std::string_view::npos ? path : path.substr(slash + 1);
    return file.substr(0, file.find('.'));
}

}  // namespace puppetri
