// SPDX-License-Identifier: MIT
#include "puppetri/io/firing_log.h"

#include <optional>

#include "defects.h"
#include "puppetri/base/rational.h"
#include "puppetri/base/text.h"

namespace puppetri::io {
namespace {

struct Field {
    std::string text;
    std::uint32_t column = 1;
};

// The fields of one line of CSV; quotes may hold separators, and "" is a quote.
std::vector<Field> csv_fields(std::string_view row, char separator) {
    std::vector<Field> fields(1);
    bool quoted = false;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const char c = row[i];
        if (quoted) {
            if (c == '"' && i + 1 < row.size() && row[i + 1] == '"') {
                fields.back().text += row[++i];
            } else if (c == '"') {
                quoted = false;
            } else {
                fields.back().text += c;
            }
        } else if (c == '"') {
            quoted = true;
        } else if (c == separator) {
            fields.push_back({"", column_of(row, i + 1)});
        } else if (c != '\r') {
            fields.back().text += c;
        }
    }
    for (Field& f : fields) {
        const std::size_t begin = f.text.find_first_not_of(" \t");
        const std::size_t end = f.text.find_last_not_of(" \t");
        f.text = begin == std::string::npos ? "" : f.text.substr(begin, end - begin + 1);
    }
    return fields;
}

std::vector<Field> words(std::string_view row) {
    std::vector<Field> out;
    bool inside = false;
    for (std::size_t i = 0; i < row.size(); ++i) {
        const bool blank = row[i] == ' ' || row[i] == '\t' || row[i] == '\r';
        if (blank) {
            inside = false;
            continue;
        }
        if (!inside) {
            out.push_back({"", column_of(row, i)});
            inside = true;
        }
        out.back().text += row[i];
    }
    return out;
}

enum class Unit { kSeconds, kTicks, kFrames };

struct Columns {
    std::optional<std::size_t> time, event, object;
    Unit unit = Unit::kSeconds;
};

std::string lower(std::string text) {
    for (char& c : text) {
        c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return text;
}

// The columns by their names; ticks are exact, and preferred.
Columns named_columns(const std::vector<Field>& head) {
    Columns c;
    const auto is_one_of = [](const std::string& name, std::initializer_list<const char*> list) {
        for (const char* known : list) {
            if (name == known) {
                return true;
            }
        }
        return false;
    };
    for (std::size_t i = 0; i < head.size(); ++i) {
        const std::string name = lower(head[i].text);
        if (is_one_of(name, {"tick", "ticks"})) {
            c.time = i;
            c.unit = Unit::kTicks;
        } else if (is_one_of(name, {"frame"}) && c.unit != Unit::kTicks) {
            c.time = i;
            c.unit = Unit::kFrames;
        } else if (is_one_of(name, {"seconds", "time", "timestamp", "t"}) && !c.time) {
            c.time = i;
        } else if (is_one_of(name, {"event", "transition", "activity", "action", "name"}) &&
                   !c.event) {
            c.event = i;
        } else if (is_one_of(name, {"object", "actor", "case", "customer", "id"}) && !c.object) {
            c.object = i;
        }
    }
    return c;
}

std::optional<SimTime> time_of(const std::string& text, Unit unit, const LogFormat& format) {
    if (unit == Unit::kTicks) {
        std::int64_t ticks = 0;
        if (text.empty() || text.size() > 18 ||
            text.find_first_not_of("0123456789") != std::string::npos) {
            return std::nullopt;
        }
        for (const char c : text) {
            ticks = 10 * ticks + (c - '0');
        }
        return SimTime{ticks};
    }
    const std::optional<double> number = parse_number(text);
    const double seconds = !number                 ? -1
                           : unit == Unit::kFrames ? *number / format.frames_per_s
                                                   : *number;
    constexpr double kMost_s = 1e10;
    if (!(seconds >= 0 && seconds <= kMost_s)) {
        return std::nullopt;
    }
    return nearest_tick(seconds);
}

}  // namespace

Checked<std::vector<LogLine>> read_firing_log(std::string_view text, const std::string& path,
                                              const LogFormat& format) {
    Defects defects;
    std::vector<LogLine> lines;
    if (text.starts_with("\xEF\xBB\xBF")) {
        text.remove_prefix(3);
    }
    std::optional<Columns> columns;
    char separator = '\0';  // of words
    std::uint32_t number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string_view row = text.substr(at, end - at);
        at = end + 1;
        ++number;
        if (row.find_first_not_of(" \t\r") == std::string_view::npos || row.starts_with('#')) {
            continue;
        }
        if (!columns && row.find_first_of(",;") != std::string_view::npos) {
            separator = row.find(';') != std::string_view::npos ? ';' : ',';
        }
        const std::vector<Field> fields =
            separator == '\0' ? words(row.substr(0, row.find('#'))) : csv_fields(row, separator);
        if (!columns) {
            columns = named_columns(fields);
            if (columns->time && columns->event) {
                continue;  // the head line
            }
            columns = separator == '\0' ? Columns{.time = 0, .event = 2, .object = 1}
                                        : Columns{.time = 0, .event = 1, .object = {}};
            if (separator != '\0' && fields.size() > 2) {
                columns->object = 2;
            }
            if (separator == '\0' && format.tuples_in_frames) {
                columns->unit = Unit::kFrames;
            }
        }
        const std::size_t needed = std::max(*columns->time, *columns->event);
        if (fields.size() <= needed) {
            defects.error("bad-log", {path, number, 1, 1}, "",
                          "a line has " + std::to_string(fields.size()) + " columns, and " +
                              std::to_string(needed + 1) + " are needed",
                          "write time, event[, object], or: TIME OBJECT EVENT");
            continue;
        }
        const Field& when = fields[*columns->time];
        const std::optional<SimTime> time = time_of(when.text, columns->unit, format);
        if (!time) {
            defects.error("bad-log", {path, number, when.column, 1}, "",
                          "'" + when.text + "' is no time",
                          columns->unit == Unit::kTicks ? "write whole ticks from 0"
                                                        : "write a number from 0");
            continue;
        }
        LogLine line{*time, fields[*columns->event].text, "", number};
        if (columns->object && *columns->object < fields.size()) {
            line.object = fields[*columns->object].text;
        }
        lines.push_back(std::move(line));
    }
    if (lines.empty() && !defects.any()) {
        defects.error("bad-log", {path, 1, 1, 1}, "", "the log has no line",
                      "write time, event[, object], or: TIME OBJECT EVENT");
    }
    if (defects.any()) {
        return Unexpected(defects.take());
    }
    return lines;
}

}  // namespace puppetri::io
