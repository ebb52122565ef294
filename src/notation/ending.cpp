// SPDX-License-Identifier: MIT
#include "ending.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "literal.h"
#include "make.h"

namespace puppetri::notation {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::ExprKind;
using lang::Span;

namespace {

// Before all else of the instant in which it begins; and, where time alone brings something, after
// all else, in the order of the lines: so events come when everything has settled.
constexpr std::int64_t kStarts = 5'000'000, kTimes = -2'000'000;

// What a datum is at the beginning; nothing where only its type could tell.
Expr initial_of(const lang::Data& d) {
    if (d.initial) {
        return d.initial;
    }
    const std::string_view type = word_of(d.type);
    if (d.type.kind == ExprKind::kRange) {
        return d.type.args[0].value;
    }
    if (type == "bool") {
        return make_bool(false, d.span);
    }
    if (type == "int" || type == "real" || type == "time") {
        return make_number(Rational{0}, d.span, type == "time" ? "s" : "");
    }
    return {};
}

class Ways {
 public:
    Ways(std::string kind, const Ending& ending, lang::Body& body)
        : kind_(std::move(kind)), ending_(ending), body_(body) {}

    void make(std::int64_t priority, Teller& teller) {
        starts_ = transition("_starts", kStarts);
        ends_ = transition("_ends", priority);
        starts_.inputs = {arc(ArcKind::kTake, kind_ + "_begin")};
        starts_.outputs = {arc(ArcKind::kGive, kind_ + "_running")};
        ends_.inputs = {arc(ArcKind::kTake, kind_ + "_running")};
        ends_.outputs = {arc(ArcKind::kGive, kind_ + "_done")};
        from_within();
        times();
        for (const std::string& place : {ending_.counts, ending_.given}) {
            if (!place.empty()) {
                add_place(place);
            }
        }
        for (lang::Place& p : body_.places) {
            give(p);
            if (p.name.text == ending_.given) {
                ends_.inputs.push_back(arc(ArcKind::kTake, p.name.text));
            } else {
                ends_.inputs.push_back(
                    make_arc(ArcKind::kTakeAllNow, make_path({p.name}, ending_.span)));
            }
        }
        for (const InnerPlace& inner : ending_.within) {
            if (inner.begins) {
                starts_.outputs.push_back(make_arc(ArcKind::kGive, inner.place));
            }
            ends_.inputs.push_back(make_arc(ArcKind::kTakeAllNow, inner.place));
        }
        for (const lang::Data& d : body_.data) {
            Expr value = initial_of(d);
            if (!value) {
                teller.error("no-value", d.span,
                             "nothing says what " + d.name.text + " is when this begins again",
                             "give it a value: data " + d.name.text + ": " + lang::to_text(d.type) +
                                 " = ...");
                continue;
            }
            starts_.assignments.push_back(
                make_assignment(make_path({d.name}, ending_.span), std::move(value)));
        }
        ends_.guard = ending_.when;
        if (ending_.count) {
            ends_.guard = make_both(
                make_binary(lang::Op::kGreaterEqual,
                            make_count(make_path(ending_.counts, ending_.span)), ending_.count),
                std::move(ends_.guard));
        }
        for (const char* name : {"_begin", "_running", "_done"}) {
            add_place(kind_ + name);
            lang::Place& p = body_.places.back();
            if (p.name.text == kind_ + "_begin") {
                p.role = lang::Role::kStart;
                give_token(p);
            } else if (p.name.text == kind_ + "_done") {
                p.role = lang::Role::kFinish;
            }
        }
        body_.transitions.push_back(std::move(starts_));
        body_.transitions.push_back(std::move(ends_));
    }

 private:
    lang::Transition transition(const char* name, std::int64_t priority) const {
        lang::Transition t = make_transition(make_name(kind_ + name, ending_.span), {}, {});
        t.span = ending_.span;
        t.is_public = true;
        t.priority = make_number(Rational{priority}, ending_.span);
        return t;
    }

    Arc arc(ArcKind kind, const std::string& place) const {
        return make_arc(kind, make_path(place, ending_.span));
    }

    void add_place(const std::string& name) {
        lang::Place place = make_place(make_name(name, ending_.span));
        place.is_public = true;
        body_.places.push_back(std::move(place));
    }

    // What begins with nothing of the net is heard while it goes on.
    void from_within() {
        for (lang::Transition& t : body_.transitions) {
            if (t.inputs.empty()) {
                t.tests.push_back(arc(ArcKind::kWith, kind_ + "_running"));
            }
        }
    }

    // Each token that a place begins with, as an arc; none of a count that is 0.
    void give(lang::Place& p) {
        for (const lang::InitialTokens& group : p.tokens) {
            if (const auto n = literal_number(group.count); n && n->numerator == 0) {
                continue;
            }
            Arc gives = make_arc(ArcKind::kGive, make_path({p.name}, group.span), group.count);
            gives.pattern = group.attributes;
            starts_.outputs.push_back(std::move(gives));
        }
        p.tokens.clear();
    }

    // Times of the run become times since it has begun: a token that waits for them.
    void times() {
        for (std::size_t i = 0; i < body_.events.size(); ++i) {
            const lang::Event& e = body_.events[i];
            if (e.at.empty() && !e.every) {
                kept_.push_back(e);
                continue;
            }
            const std::string& name = e.name.text;
            add_place(name);
            const auto begins = [&](const Expr& left) {
                starts_.outputs.push_back(waits(name, left));
            };
            for (const Expr& at : e.at) {
                begins(at);
            }
            if (e.every) {
                begins(e.from ? e.from : e.every);
            }
            for (lang::Transition& t : body_.transitions) {
                const bool hears = std::any_of(
                    t.events.begin(), t.events.end(),
                    [&](const lang::Path& path) { return lang::to_text(path) == name; });
                if (!hears) {
                    continue;
                }
                t.events.clear();
                t.inputs.push_back(arc(ArcKind::kTake, name));
                if (e.every) {
                    t.outputs.push_back(waits(name, e.every));
                }
                t.priority =
                    make_number(Rational{kTimes - static_cast<std::int64_t>(i)}, ending_.span);
            }
        }
        body_.events = std::move(kept_);
    }

    Arc waits(const std::string& place, const Expr& left) const {
        Arc a = arc(ArcKind::kGive, place);
        a.pattern.push_back(make_assignment(make_path("left", left.span), left));
        return a;
    }

    const std::string kind_;
    const Ending& ending_;
    lang::Body& body_;
    lang::Transition starts_, ends_;
    std::vector<lang::Event> kept_;
};

}  // namespace

bool is_ending(const lang::Property& p) {
    if (p.name.steps.size() != 1 || p.name.steps[0].text != "ends") {
        return false;
    }
    const std::string_view word = p.values.empty() ? "" : word_of(p.values[0]);
    return p.values.empty() || word == "after" || word == "when";
}

bool begin_ending(Line& line, std::string_view word, std::string_view form, Teller& teller,
                  Ending& to) {
    if (to) {
        teller.error("name-twice", line.span(), "it says twice when this ends",
                     "keep one of the lines");
        return false;
    }
    to.span = line.span();
    to.said = true;
    if (!line.word(word)) {
        teller.error("syntax", line.span(), "it does not say when this ends",
                     "write " + std::string(form));
        return false;
    }
    return true;
}

void read_count(Line& line, std::string_view units, std::string_view counts, Teller& teller,
                Ending& to) {
    const std::string form = "ends after 10 " + std::string(units);
    if (!begin_ending(line, "after", form, teller, to)) {
        return;
    }
    const Expr* count = line.value("a number of " + std::string(units));
    if (count == nullptr) {
        return;
    }
    if (!line.word(units) && !line.word(units.substr(0, units.size() - 1))) {
        teller.error("syntax", line.span(), "it does not say after how many " + std::string(units),
                     "write " + form);
        return;
    }
    line.finish(form);
    if (const auto n = literal_number(*count); n && (!n->whole() || n->numerator < 1)) {
        teller.error("out-of-range", count->span,
                     "the number of " + std::string(units) + " is a whole number from 1",
                     "write " + form);
        return;
    }
    to.counts = counts;
    to.count = *count;
}

void make_ways(const std::string& kind, const Ending& ending, std::int64_t priority, Teller& teller,
               lang::Body& body) {
    if (ending) {
        Ways(kind, ending, body).make(priority, teller);
    }
}

}  // namespace puppetri::notation
