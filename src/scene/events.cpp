// SPDX-License-Identifier: MIT
#include "puppetri/scene/events.h"

#include "puppetri/base/text.h"
#include "puppetri/lang/decimal.h"
#include "puppetri/lang/signature.h"
#include "puppetri/lang/units.h"

namespace puppetri::scene {
namespace {

// A word of a line and its column, from 1.
struct WordAt {
    std::string_view text;
    std::uint32_t column = 1;
};

std::vector<WordAt> words_of(std::string_view line) {
    std::vector<WordAt> words;
    std::size_t i = 0;
    while (i < line.size() && line[i] != '#') {
        if (line[i] == ' ' || line[i] == '\t' || line[i] == '\r') {
            ++i;
            continue;
        }
        const std::size_t begin = i;
        while (i < line.size() && line[i] != ' ' && line[i] != '\t' && line[i] != '\r' &&
               line[i] != '#') {
            ++i;
        }
        words.push_back({line.substr(begin, i - begin), column_of(line, begin)});
    }
    return words;
}

struct Line {
    std::optional<LiveEvent> event;
    std::optional<std::uint64_t> seed;
};

class LineParser {
 public:
    LineParser(std::string_view filename, std::uint32_t number, std::span<const std::string> names)
        : filename_(filename), number_(number), names_(names) {}

    Checked<Line> parse(std::string_view line) {
        const std::vector<WordAt> words = words_of(line);
        if (words.empty()) {
            return Line{};
        }
        if (words[0].text == "seed" && words.size() == 2) {
            const auto seed = lang::parse_decimal(words[1].text);
            if (!seed || !seed->whole()) {
                return fail(words[1], "bad-event-line", "a seed is a whole number",
                            "write `seed 7`");
            }
            return Line{.seed = static_cast<std::uint64_t>(seed->numerator)};
        }
        if (words[0].text == "now" && words.size() == 2) {
            PUP_TRY(const net::EventIndex event, named(words[1]));
            return Line{.event = LiveEvent{std::nullopt, event}};
        }
        if (words.size() != 3) {
            return fail(words[0], "bad-event-line", "this is no event",
                        "write a time and a name: `2.5 s go`, or `now go`");
        }
        const auto number = lang::parse_decimal(words[0].text);
        if (!number) {
            return fail(words[0], "bad-event-line", "this is no number", "write one such as 2.5");
        }
        LiveEvent event;
        if (words[1].text == "ticks") {
            if (!number->whole()) {
                return fail(words[0], "bad-event-line", "ticks are whole",
                            "write `1764000000 ticks go`");
            }
            event.at = SimTime{number->numerator};
        } else {
            const auto q = lang::to_quantity(*number, words[1].text);
            if (!q || q->dimension != lang::dimension::kTime || q->pi_power != 0) {
                return fail(words[1], "wrong-unit", "this is no unit of time",
                            "use s, ms, min or ticks");
            }
            const auto t = to_ticks(q->number);
            if (!t) {
                return fail(words[0], "number-too-large", "this time does not fit",
                            "choose an earlier one");
            }
            event.at = t->time;
        }
        PUP_TRY(event.event, named(words[2]));
        return Line{.event = event};
    }

 private:
    SourceSpan where(const WordAt& word) const {
        return {filename_, number_, word.column, count_code_points(word.text)};
    }

    Unexpected<Diagnostics> fail(const WordAt& word, std::string code, std::string message,
                                 std::string remedy) const {
        Diagnostics list;
        list.push_back({.code = std::move(code),
                        .where = where(word),
                        .element = "event",
                        .message = std::move(message),
                        .remedy = std::move(remedy)});
        return Unexpected(std::move(list));
    }

    Checked<net::EventIndex> named(const WordAt& word) const {
        std::vector<std::string> known;
        for (std::size_t i = 0; i < names_.size(); ++i) {
            if (names_[i] == word.text) {
                return net::EventIndex{static_cast<std::uint32_t>(i)};
            }
            if (!names_[i].empty()) {
                known.push_back(names_[i]);
            }
        }
        Diagnostics list;
        list.push_back(lang::unknown_name(where(word), "event", word.text, known, "event"));
        return Unexpected(std::move(list));
    }

    std::string filename_;
    std::uint32_t number_;
    std::span<const std::string> names_;
};

}  // namespace

EventList parse_event_list(std::string_view text, const std::string& filename,
                           std::span<const std::string> names) {
    EventList list;
    std::uint32_t number = 0;
    std::size_t at = 0;
    while (at < text.size()) {
        std::size_t end = text.find('\n', at);
        end = end == std::string_view::npos ? text.size() : end;
        const std::string_view line = text.substr(at, end - at);
        at = end + 1;
        ++number;
        auto parsed = LineParser(filename, number, names).parse(line);
        if (!parsed) {
            for (Diagnostic& d : parsed.error()) {
                list.diagnostics.push_back(std::move(d));
            }
            continue;
        }
        if (parsed->seed) {
            list.seed = parsed->seed;
        } else if (parsed->event && parsed->event->at) {
            list.events.push_back({*parsed->event->at, parsed->event->event});
        } else if (parsed->event) {
            list.diagnostics.push_back({.code = "bad-event-line",
                                        .where = {filename, number, 1, 3},
                                        .element = "event",
                                        .message = "`now` means nothing in a file",
                                        .remedy = "write the time: `2.5 s go`"});
        }
    }
    return list;
}

std::vector<std::string> event_names(const net::Net& net) {
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < net.event_count(); ++i) {
        names.emplace_back(net.event({i}).path);
    }
    for (const net::ScheduledEvent& s : net.declarations().schedule) {
        if (!net.declarations().events[s.event.value].outside) {
            names[s.event.value].clear();
        }
    }
    return names;
}

Checked<std::optional<LiveEvent>> parse_live_event(std::string_view line,
                                                   std::span<const std::string> names) {
    PUP_TRY(Line parsed, LineParser("-", 1, names).parse(line));
    return parsed.event;
}

std::string write_event_list(const std::vector<run::OutsideEvent>& events,
                             std::optional<std::uint64_t> seed,
                             std::span<const std::string> names) {
    std::string text = "# A session of puppetri run: replay it with --events.\n";
    if (seed) {
        text += "seed " + std::to_string(*seed) + "\n";
    }
    for (const run::OutsideEvent& e : events) {
        text += std::to_string(e.at.ticks) + " ticks " + names[e.event.value] + "\n";
    }
    return text;
}

}  // namespace puppetri::scene
