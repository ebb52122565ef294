// SPDX-License-Identifier: MIT
#include "paragraph.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "puppetri/base/text.h"

namespace puppetri::cli {

std::size_t columns() {
    constexpr std::size_t kUsual = 100, kFew = 40;
    winsize size{};
    if (isatty(STDOUT_FILENO) == 0 || ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 ||
        size.ws_col == 0) {
        return kUsual;
    }
    return std::max<std::size_t>(kFew, size.ws_col);
}

void print_paragraph(const std::string& text, std::size_t indent) {
    const std::size_t room = columns() > indent + 20 ? columns() - indent : 20;
    std::string line;
    const auto flush = [&] {
        std::printf("%*s%s\n", static_cast<int>(indent), "", line.c_str());
        line.clear();
    };
    for (std::size_t at = 0; at <= text.size();) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const std::string word = text.substr(at, end - at);
        if (!line.empty() && count_code_points(line) + 1 + count_code_points(word) > room) {
            flush();
        }
        line += (line.empty() ? "" : " ") + word;
        at = end + 1;
    }
    flush();
}

std::string short_sum(const std::string& text, std::size_t width) {
    const std::size_t end = text.find_last_of("=<>");
    if (count_code_points(text) <= width || end == std::string::npos || end < 2) {
        return text;
    }
    const std::size_t close = text[end - 1] == '<' || text[end - 1] == '>' ? end - 2 : end - 1;
    std::vector<std::string> terms;
    for (std::size_t at = 0; at < close;) {
        const std::size_t plus = std::min(text.find(" + ", at), close);
        terms.push_back(text.substr(at, plus - at));
        at = plus + 3;
    }
    if (terms.size() < 4) {
        return text;
    }
    const std::string tail = " + ... + " + terms.back() + text.substr(close) + " (" +
                             std::to_string(terms.size()) + " places)";
    std::string head = terms[0];
    for (std::size_t i = 1;
         i + 2 < terms.size() &&
         count_code_points(head) + 3 + count_code_points(terms[i]) + count_code_points(tail) <=
             width;
         ++i) {
        head += " + " + terms[i];
    }
    return head + tail;
}

std::vector<std::string> said_once(const std::vector<std::string>& texts) {
    constexpr const char* kPlace = "place ";
    struct Group {
        std::string what;  // of places: ": ..."
        std::vector<std::string> places;
    };
    std::vector<Group> groups;
    for (const std::string& text : texts) {
        const std::size_t colon = text.find(": ");
        const bool of_place = text.starts_with(kPlace) && colon != std::string::npos;
        const std::string what = of_place ? text.substr(colon) : text;
        auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) {
            return g.what == what && g.places.empty() != of_place;
        });
        if (group == groups.end()) {
            groups.push_back({what, {}});
            group = groups.end() - 1;
        }
        if (of_place) {
            const std::string place = text.substr(6, colon - 6);
            if (std::find(group->places.begin(), group->places.end(), place) ==
                group->places.end()) {
                group->places.push_back(place);
            }
        }
    }
    std::vector<std::string> out;
    constexpr std::size_t kFew = 6, kShown = 3;
    for (const Group& g : groups) {
        std::string line;
        const std::size_t shown = g.places.size() <= kFew ? g.places.size() : kShown;
        for (std::size_t i = 0; i < shown; ++i) {
            line += (i == 0 ? "" : ", ") + g.places[i];
        }
        if (shown < g.places.size()) {
            line += " and " + std::to_string(g.places.size() - shown) + " more";
        }
        out.push_back(line + g.what);
    }
    return out;
}

}  // namespace puppetri::cli
