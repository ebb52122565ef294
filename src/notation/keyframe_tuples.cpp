// SPDX-License-Identifier: MIT
#include "puppetri/notation/keyframe_tuples.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "puppetri/base/text.h"

namespace puppetri::notation {

Checked<std::vector<KeyframeTuple>> read_tuples(std::string_view text, const std::string& path) {
    Diagnostics defects;
    const auto bad = [&](std::uint32_t line, std::uint32_t column, std::string element,
                         std::string message, std::string remedy) {
        defects.push_back({Severity::kError,
                           "bad-tuple",
                           {path, line, column, 1},
                           std::move(element),
                           std::move(message),
                           std::move(remedy)});
    };
    std::vector<KeyframeTuple> tuples;
    std::map<std::pair<std::string, std::int64_t>, std::uint32_t> seen;
    std::uint32_t line = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string_view row = text.substr(at, end - at);
        at = end + 1;
        ++line;
        row = row.substr(0, row.find('#'));
        std::vector<std::pair<std::string_view, std::uint32_t>> words;
        for (std::size_t i = 0; i < row.size();) {
            const auto blank = [&](char c) { return c == ' ' || c == '\t' || c == '\r'; };
            if (blank(row[i])) {
                ++i;
                continue;
            }
            const std::size_t begin = i;
            while (i < row.size() && !blank(row[i])) {
                ++i;
            }
            words.emplace_back(row.substr(begin, i - begin), column_of(row, begin));
        }
        if (words.empty()) {
            continue;
        }
        const std::optional<double> frame = parse_number(words[0].first);
        if (words.size() != 3 || !frame || !(*frame >= 0 && *frame <= 1e12) ||
            *frame != std::floor(*frame)) {
            bad(line, words[0].second, "",
                "a line is: FRAME OBJECT EVENT, the frame a whole number from 0",
                "write it like: 24 man1 EATING1");
            continue;
        }
        KeyframeTuple tuple{static_cast<std::int64_t>(*frame), std::string(words[1].first),
                            std::string(words[2].first), line};
        if (!seen.try_emplace({tuple.object, tuple.frame}, line).second) {
            bad(line, words[1].second, "object " + tuple.object,
                "it reaches two keyframes at one frame", "leave one of them out");
        }
        tuples.push_back(std::move(tuple));
    }
    if (!defects.empty()) {
        return Unexpected(std::move(defects));
    }
    return tuples;
}

std::string make_tuples(std::span<const KeyframeTuple> tuples) {
    std::vector<KeyframeTuple> sorted(tuples.begin(), tuples.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.frame < b.frame; });
    std::string text;
    for (const KeyframeTuple& t : sorted) {
        text += std::to_string(t.frame) + " " + t.object + " " + t.event + "\n";
    }
    return text;
}

}  // namespace puppetri::notation
