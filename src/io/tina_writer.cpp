// SPDX-License-Identifier: MIT
// TINA's .net out: places with their markings, then transitions, then priorities.
#include <algorithm>
#include <map>
#include <numeric>
#include <vector>

#include "net_features.h"
#include "net_writers.h"
#include "puppetri/io/tina.h"

namespace puppetri::io {
namespace {

// A name as it stands if it has only letters, digits, _ and ', else in braces.
std::string name(const std::string& text) {
    const bool plain = !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
               c == '_' || c == '\'';
    });
    // A keyword is one at the beginning of a line only, but nobody wants to think about that.
    if (plain && text != "tr" && text != "pl" && text != "lb" && text != "pr" && text != "nt" &&
        text != "net") {
        return text;
    }
    std::string out = "{";
    for (const char c : text) {
        if (c == '{' || c == '}' || c == '\\') {
            out += '\\';
        }
        out += c;
    }
    return out + "}";
}

// The ends of an interval in ticks, open ones as the closed time beside them.
struct Ends {
    std::int64_t low = 0, high = 0;
    bool open_low = false, open_high = false, infinite = false;
};

class Writer {
 public:
    explicit Writer(const NetFile& file) : draft_(file.draft) {}

    std::string run(Diagnostics& notes) {
        timed_ = std::any_of(draft_.transitions.begin(), draft_.transitions.end(),
                             [](const auto& t) { return t.delay.has_value(); });
        choose_unit();
        if (unit_ != kTicksPerSecond) {
            const bool ms = unit_ % kTicksPerMillisecond == 0;
            const std::string unit =
                std::to_string(ms ? unit_ / kTicksPerMillisecond : unit_) + (ms ? " ms" : " ticks");
            out_ += "# unit " + unit + "\n";
            notes.push_back({Severity::kNote,
                             "time-unit",
                             {},
                             "net " + draft_.name,
                             "times are whole numbers of " + unit,
                             "a tick is 1/705600000 s; other tools do not know the unit"});
        }
        if (!draft_.name.empty()) {
            out_ += "net " + name(draft_.name) + "\n";
        }
        for (const net::PlaceDraft& p : draft_.places) {
            out_ += "pl " + name(p.path) + label(p.caption) + " (" +
                    std::to_string(initial_tokens(p)) + ")\n";
        }
        for (const net::TransitionDraft& t : draft_.transitions) {
            transition(t);
        }
        priorities();
        return std::move(out_);
    }

 private:
    static std::string label(const std::string& caption) {
        return caption.empty() ? "" : " : " + name(caption);
    }

    // An end beside a whole number of milliseconds (or of the unit that the file had) is an open
    // one.
    Ends ends_of(const net::DelayDraft& delay) const {
        const net::DurationDraft& d = delay.duration;
        Ends out;
        SimTime low;
        if (is_at_least(d, low)) {
            out.low = low.ticks;
            out.infinite = true;
        } else if (d.kind == net::DurationKind::kInterval) {
            out.low = d.a.literal_value();
            out.high = d.b.literal_value();
        } else {
            out.low = out.high = d.kind == net::DurationKind::kConstant ? d.a.literal_value() : 0;
            return out;
        }
        const std::int64_t whole = said_ > 1 ? said_ : kTicksPerMillisecond;
        if (out.low % whole == 1) {
            --out.low;
            out.open_low = true;
        }
        if (!out.infinite && out.high % whole == whole - 1) {
            ++out.high;
            out.open_high = true;
        }
        return out;
    }

    static bool has_interval(const net::TransitionDraft& t) {
        SimTime low;
        return t.delay && (t.delay->duration.kind == net::DurationKind::kConstant ||
                           t.delay->duration.kind == net::DurationKind::kInterval ||
                           is_at_least(t.delay->duration, low));
    }

    // The unit that [a,w[ was read with, if it fits; else the largest that all times are multiples
    // of, at most a second.
    void choose_unit() {
        for (const net::TransitionDraft& t : draft_.transitions) {
            SimTime low;
            if (t.delay && is_at_least(t.delay->duration, low) &&
                t.delay->duration.parameters[1].type().kind == ValueKind::kTime) {
                said_ = t.delay->duration.parameters[1].literal_value();
            }
        }
        std::int64_t common = kTicksPerSecond;
        for (const net::TransitionDraft& t : draft_.transitions) {
            if (has_interval(t)) {
                const Ends ends = ends_of(*t.delay);
                common = std::gcd(std::gcd(common, ends.low), ends.high);
            }
        }
        unit_ = said_ > 0 && common % said_ == 0 ? said_ : common;
        if (unit_ > kTicksPerMillisecond && unit_ % kTicksPerMillisecond != 0) {
            unit_ = std::gcd(unit_, kTicksPerMillisecond);
        }
    }

    std::string interval(const net::TransitionDraft& t) const {
        if (!timed_ || (t.delay && !has_interval(t))) {
            return "";
        }
        const Ends ends = t.delay ? ends_of(*t.delay) : Ends{};
        std::string out = ends.open_low ? " ]" : " [";
        out += std::to_string(ends.low / unit_) + ",";
        return out + (ends.infinite
                          ? "w["
                          : std::to_string(ends.high / unit_) + (ends.open_high ? "[" : "]"));
    }

    void transition(const net::TransitionDraft& t) {
        out_ += "tr " + name(t.path) + label(t.caption) + interval(t);
        for (const net::ArcDraft& a : t.inputs) {
            const std::string place = " " + name(draft_.places[a.place.value].path);
            const std::string weight = std::to_string(a.weight);
            switch (plain_kind(a.kind)) {
                case net::ArcKind::kRead:
                    out_ += place + "?" + weight;
                    break;
                case net::ArcKind::kUnless:
                    out_ += place + "?-" + weight;
                    break;
                case net::ArcKind::kTake:
                    out_ += place + (a.weight == 1 ? "" : "*" + weight);
                    break;
                default:
                    break;
            }
        }
        out_ += " ->";
        for (const net::OutputDraft& o : t.outputs) {
            out_ += " " + name(draft_.places[o.place.value].path) +
                    (o.weight == 1 ? "" : "*" + std::to_string(o.weight));
        }
        out_ += "\n";
    }

    // Each level before all lower ones: nobody has to know whether priority is transitive.
    void priorities() {
        std::map<std::int64_t, std::string> levels;
        for (const net::TransitionDraft& t : draft_.transitions) {
            levels[t.priority] += " " + name(t.path);
        }
        for (const auto& [high, above] : levels) {
            for (const auto& [low, below] : levels) {
                if (low < high) {
                    out_ += "pr" + above + " >" + below + "\n";
                }
            }
        }
    }

    const net::NetDraft& draft_;
    std::int64_t unit_ = kTicksPerSecond;
    std::int64_t said_ = 0;  // the unit that [a,w[ was read with
    bool timed_ = false;
    std::string out_;
};

}  // namespace

std::string tina_text(const NetFile& file, Diagnostics& notes) { return Writer(file).run(notes); }

}  // namespace puppetri::io
