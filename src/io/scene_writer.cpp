// SPDX-License-Identifier: MIT
// A plain net as a scene: places and transitions of a file with nobody on stage, to be run, proved
// and edited like any other.
#include <algorithm>
#include <string>

#include "net_features.h"
#include "net_writers.h"
#include "puppetri/base/text.h"
#include "puppetri/lang/format.h"

namespace puppetri::io {
namespace {

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

// A name of the language, quoted where it has other signs than letters, digits and _.
std::string name(const std::string& text) {
    bool plain = !text.empty() && !(text[0] >= '0' && text[0] <= '9') && text != "and" &&
                 text != "or" && text != "not" && text != "implies" && text != "mod" &&
                 text != "div";
    for (const char c : text) {
        plain = plain && ((c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                          (c >= '0' && c <= '9') || c == '_');
    }
    if (plain) {
        return text;
    }
    std::string out = "'";
    for (const char c : text) {
        out += c == '\'' || is_control(c) ? '_' : c;
    }
    return out + "'";
}

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        switch (c) {
            case '"':
            case '\\':
                out += '\\';
                out += c;
                break;
            case '\n':
                out += "\\n";
                break;
            case '\t':
                out += "\\t";
                break;
            default:
                out += is_control(c) ? ' ' : c;
        }
    }
    return out + "\"";
}

// The language keeps numbers as exact fractions: at most 18 digits.
std::string number(double x) {
    std::string text = number_to_text(x);
    const auto digits =
        std::count_if(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (digits > 18 || text.find('e') != std::string::npos) {
        text = number_to_text_fixed(x, x < 10 ? 17 : x < 1e6 ? 12 : 6);
    }
    return text;
}

// In the unit that shows most digits.
std::string time_text(double s) {
    return s >= 1      ? number(s) + " s"
           : s >= 1e-3 ? number(s * 1e3) + " ms"
                       : number(s * 1e6) + " us";
}

std::string seconds(std::int64_t ticks) {
    return ticks % kTicksPerMillisecond == 0
               ? decimal_to_text(ticks / kTicksPerMillisecond, 3) + " s"
               : time_text(SimTime{ticks}.seconds());
}

std::string time_of(const Expr& e) {
    if (e.type().kind == ValueKind::kTime) {
        return seconds(e.literal_value());
    }
    const Value v = e.literal_value();
    return number(e.type().kind == ValueKind::kReal ? real_of_value(v) : static_cast<double>(v));
}

// What stands after `takes` and `after`; empty: it has no words here and was dropped,
// which has been told.
std::string duration(const net::DurationDraft& d) {
    double mean = 0;
    if (is_exponential(d, mean)) {
        return "exponential(" + time_text(mean) + ")";
    }
    if (d.kind == net::DurationKind::kConstant && d.a.is_literal()) {
        return seconds(d.a.literal_value());
    }
    if (d.kind == net::DurationKind::kInterval && d.a.is_literal() && d.b.is_literal()) {
        return time_of(d.a) + " .. " + time_of(d.b);
    }
    return "";
}

std::string weighted(std::int64_t weight, const std::string& place) {
    return weight == 1 ? place : std::to_string(weight) + "*" + place;
}

void join(std::string& list, const char* separator, const std::string& more) {
    list += (list.empty() ? "" : separator) + more;
}

}  // namespace

std::string scene_text(const NetFile& file, Diagnostics&) {
    const net::NetDraft& draft = file.draft;
    std::string out = "language 1\nscene " + quoted(draft.name.empty() ? "a net" : draft.name) +
                      "\nuntil " + (is_timeless(draft) ? "1000 firings" : "60 s") + "\n\n";
    for (const net::PlaceDraft& p : draft.places) {
        out += "place " + name(p.path);
        if (!p.caption.empty() && p.caption != p.path) {
            out += " " + quoted(p.caption);
        }
        if (p.duration && !is_untimed(p)) {
            const std::string takes = duration(*p.duration);
            out += takes.empty() ? "" : " takes " + takes;
        }
        if (const std::int64_t tokens = initial_tokens(p); tokens > 0) {
            out += " tokens " + std::to_string(tokens);
        }
        if (p.capacity) {
            out += " holds at most " + std::to_string(*p.capacity);
        }
        out += "\n";
    }
    out += "\n";
    for (const net::TransitionDraft& t : draft.transitions) {
        std::string takes, gives, with, whiles, unless;
        for (const net::ArcDraft& a : t.inputs) {
            const std::string place = name(draft.places[a.place.value].path);
            switch (a.kind) {
                case net::ArcKind::kTake:
                    join(takes, " + ", weighted(a.weight, place));
                    break;
                case net::ArcKind::kTakeNow:
                    join(takes, " + ", "now " + weighted(a.weight, place));
                    break;
                case net::ArcKind::kTakeAll:
                    join(takes, " + ", "all " + place);
                    break;
                case net::ArcKind::kTakeAllNow:
                    join(takes, " + ", "all now " + place);
                    break;
                case net::ArcKind::kRead:
                    join(with, " and ", weighted(a.weight, place));
                    break;
                case net::ArcKind::kReadNow:
                    join(whiles, " and ", weighted(a.weight, place));
                    break;
                case net::ArcKind::kUnless:
                    join(unless, " or ", weighted(a.weight, place));
                    break;
                case net::ArcKind::kUnlessReady:
                    join(unless, " or ", "ready " + weighted(a.weight, place));
                    break;
            }
        }
        for (const net::OutputDraft& o : t.outputs) {
            join(gives, " + ", weighted(o.weight, name(draft.places[o.place.value].path)));
        }
        out += name(t.path);
        if (!t.caption.empty() && t.caption != t.path) {
            out += " " + quoted(t.caption);
        }
        out += ": " + takes + " -> " + gives;
        out += with.empty() ? "" : " with " + with;
        out += whiles.empty() ? "" : " while " + whiles;
        out += unless.empty() ? "" : " unless " + unless;
        if (t.priority != 1) {
            out += " priority " + std::to_string(t.priority);
        }
        if (t.odds && t.odds->is_literal()) {
            out += " odds " + time_of(*t.odds);
        }
        if (t.delay) {
            const std::string after = duration(t.delay->duration);
            if (!after.empty()) {
                out += " after " + after;
                out += t.delay->memory == net::DelayMemory::kAge        ? " memory age"
                       : t.delay->memory == net::DelayMemory::kResample ? " memory resample"
                                                                        : "";
                if (t.delay->servers != 1) {
                    out += " servers " + (t.delay->servers == net::DelayDraft::kInfiniteServers
                                              ? std::string("infinite")
                                              : std::to_string(t.delay->servers));
                }
            }
        }
        out += "\n";
    }
    const Checked<std::string> laid_out = lang::format(out, "net.pup");
    return laid_out ? *laid_out : out;
}

}  // namespace puppetri::io
