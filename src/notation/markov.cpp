// SPDX-License-Identifier: MIT
// Markov chains. In discrete time a state is a place that takes one step and the lines out of it
// are transitions drawn by odds; in continuous time it lasts an exponential time, whose rate is the
// sum of the rates out of it, and the way on is drawn by their shares: the same law as that of a
// race of exponential clocks, and a state's movement knows when it begins how long it lasts.
//   markov weather {
//     every 1 s
//     sunny starts does ana.wave
//     rain
//     sunny -> sunny 0.8
//     sunny -> rain else
//     rain -> sunny 1
//   }
#include <map>
#include <string>
#include <vector>

#include "kinds.h"
#include "line.h"
#include "literal.h"
#include "make.h"
#include "states.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::Op;

constexpr std::string_view kStateForm =
    "NAME \"caption\" does MOVEMENT starts [with PROBABILITY] final";
constexpr std::string_view kDiscreteForm = "FROM -> TO PROBABILITY, or FROM -> TO else";
constexpr std::string_view kContinuousForm = "FROM -> TO rate RATE, or FROM -> TO mean TIME";

class Markov {
 public:
    Markov(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), body_(out.net.body) {}

    void lower() {
        if (!has_plain_lines(block_, teller_)) {
            return;
        }
        each_line(block_, teller_, is_period, [this](Line& line) {
            if (const Expr* e = line.value("the time of a step")) {
                period_ = *e;
            }
            line.finish("every TIME");
            discrete_ = true;
        });
        const auto is_state = [](const lang::Property& p) {
            return !is_period(p) && !has_arrow(p);
        };
        each_line(block_, teller_, is_state, [this](Line& line) { state(line); });
        each_line(block_, teller_, has_arrow, [this](Line& line) { edge(line); });
        states_.check();
        for (std::size_t i = 0; i < states_.size(); ++i) {
            complete(i);
        }
        states_.make_ways();
        begin();
    }

 private:
    struct Edge {
        lang::Transition transition;
        Expr value;  // a probability, or a rate; kNone: else
        bool mean = false;
        lang::Span span;
    };
    struct Leaving {
        bool final = false;
        std::vector<Edge> edges;
    };
    struct Start {
        std::size_t state;
        Expr probability;
        lang::Span span;
    };

    static bool is_period(const lang::Property& p) {
        return p.name.steps.size() == 1 && p.name.steps[0].text == "every" && !has_arrow(p);
    }

    void state(Line& line) {
        lang::Place place = States::begin(line);
        Leaving made;
        std::vector<Start> starts;
        while (!line.done()) {
            if (line.clause("does", "a movement", place.does)) {
                continue;
            }
            if (line.word("starts")) {
                starts.push_back({states_.size(), {}, line.span()});
                line.clause("with", "a probability", starts.back().probability);
            } else if (line.word("final")) {
                made.final = true;
            } else {
                line.finish(kStateForm);
            }
        }
        if (!states_.add(std::move(place))) {
            return;
        }
        leaving_.push_back(std::move(made));
        for (Start& start : starts) {
            states_.enter(start.state);
            starts_.push_back(std::move(start));
        }
    }

    void edge(Line& line) {
        auto between = states_.edge(line);
        if (!between) {
            return;
        }
        Edge made{.span = line.span()};
        if (discrete_) {
            if (!line.word("else")) {
                const Expr* e = line.value("a probability");
                if (e == nullptr) {
                    return;
                }
                made.value = *e;
            }
        } else {
            made.mean = line.word("mean");
            if (!made.mean && !line.word("rate")) {
                teller_.error("no-rate", line.span(),
                              "this chain has no steps, so its lines need rates or mean times",
                              "write " + std::string(kContinuousForm) +
                                  "; or say how long a step is: every 1 s");
                return;
            }
            const Expr* e = line.value(made.mean ? "a mean time" : "a rate");
            if (e == nullptr) {
                return;
            }
            made.value = *e;
        }
        made.transition = std::move(between->transition);
        made.transition.caption = line.caption();
        line.finish(discrete_ ? kDiscreteForm : kContinuousForm);
        std::vector<Edge>& edges = leaving_[between->from].edges;
        for (const Edge& e : edges) {
            if (e.transition.name.text == made.transition.name.text) {
                teller_.error("name-twice", line.span(),
                              "there is already a line from " +
                                  states_.place(between->from).name.text + " to " +
                                  states_.place(between->to).name.text,
                              "add the two numbers up in one line");
                return;
            }
        }
        edges.push_back(std::move(made));
    }

    void complete(std::size_t number) {
        lang::Place& place = states_.place(number);
        Leaving& state = leaving_[number];
        const std::string name = place.name.text;
        if (state.edges.empty()) {
            if (!state.final) {
                teller_.error("sum-not-one", place.span,
                              "nothing says where the chain goes from " + name,
                              "add lines " + name +
                                  " -> ..., or write `final` if it stays there "
                                  "for ever");
            }
            states_.end(number);
            return;
        }
        if (state.final) {
            teller_.error("final-is-left", place.span, "a final state is never left",
                          "remove `final`, or the lines " + name + " -> ...");
        }
        if (discrete_) {
            step(name, place, state.edges);
        } else {
            last(place, state.edges);
        }
    }

    // The lines out of a state of a chain in steps.
    void step(const std::string& name, lang::Place& place, std::vector<Edge>& edges) {
        place.takes = make_duration(period_);
        Rational sum{0};
        bool known = true;
        Edge* rest = nullptr;
        for (Edge& e : edges) {
            if (!e.value) {
                if (rest != nullptr) {
                    teller_.error("else-twice", e.span, "only one line of a state gets the rest",
                                  "give the other one its probability");
                }
                rest = &e;
                continue;
            }
            const auto p = literal_number(e.value);
            if (p && (compare(*p, Rational{0}) <= 0 || compare(*p, Rational{1}) > 0)) {
                teller_.error("out-of-range", e.value.span,
                              "a probability is above 0 and at most 1",
                              "remove the line if this never happens");
                return;
            }
            const auto more = p ? add(sum, *p) : std::nullopt;
            known = known && more;
            sum = more.value_or(sum);
        }
        if (rest != nullptr) {
            Expr share = make_number(Rational{1}, rest->span);
            if (known) {
                const auto left = subtract(Rational{1}, sum);
                if (!left || compare(*left, Rational{0}) <= 0) {
                    teller_.error("sum-not-one", rest->span,
                                  "the other lines of " + name + " leave nothing for this one",
                                  "remove it, or make the others smaller");
                    return;
                }
                share = make_number(*left, rest->span);
            } else {
                for (const Edge& e : edges) {
                    if (&e != rest) {
                        share = make_binary(Op::kSubtract, std::move(share), e.value);
                    }
                }
            }
            rest->value = std::move(share);
        } else if (!known) {
            teller_.error("sum-not-one", place.span,
                          "whether the lines out of " + name +
                              " sum to one cannot be seen here: some are no plain numbers",
                          "give one of them the rest: " + name + " -> STATE else");
            return;
        } else if (sum != Rational{1}) {
            teller_.error(
                "sum-not-one", place.span,
                "the probabilities of the lines out of " + name + " sum to " +
                    lang::to_text(make_number(sum, place.span)) + ", not to 1",
                "change them, or give one of them the rest: " + name + " -> " + name + " else");
            return;
        }
        for (Edge& e : edges) {
            e.transition.odds = std::move(e.value);
            body_.transitions.push_back(std::move(e.transition));
        }
    }

    static Expr rate_of(const Edge& e) {
        return e.mean ? make_binary(Op::kDivide, make_number(Rational{1}, e.span), e.value)
                      : e.value;
    }

    // The lines out of a state of a chain in continuous time.
    void last(lang::Place& place, std::vector<Edge>& edges) {
        Expr all = rate_of(edges[0]);
        for (std::size_t i = 1; i < edges.size(); ++i) {
            all = make_binary(Op::kAdd, std::move(all), rate_of(edges[i]));
        }
        const lang::Span span = edges[0].value.span;
        Expr mean = edges.size() == 1 && edges[0].mean
                        ? edges[0].value
                        : make_binary(Op::kDivide, make_number(Rational{1}, span), all);
        place.takes.kind = lang::DurationKind::kValue;
        place.takes.span = span;
        place.takes.value = make_call(make_path("exponential", span), {std::move(mean)}, span);
        for (Edge& e : edges) {
            if (edges.size() > 1) {
                e.transition.odds = make_binary(Op::kDivide, rate_of(e), all);
            }
            body_.transitions.push_back(std::move(e.transition));
        }
    }

    // Where it starts: one state, or one drawn in the first instant.
    void begin() {
        if (starts_.size() == 1 && !starts_[0].probability) {
            give_token(states_.place(starts_[0].state));
            return;
        }
        Rational sum{0};
        bool good = !starts_.empty();
        for (const Start& s : starts_) {
            const auto p = s.probability ? literal_number(s.probability) : std::nullopt;
            const auto more = p && compare(*p, Rational{0}) > 0 ? add(sum, *p) : std::nullopt;
            good = good && more;
            sum = more.value_or(sum);
        }
        if (!good || sum != Rational{1}) {
            teller_.error(starts_.empty() ? "start-state" : "sum-not-one",
                          starts_.empty() ? block_.name.span : starts_.back().span,
                          starts_.empty() ? "no state is the first one"
                                          : "the probabilities of the first state do not sum to 1",
                          "write `starts` behind one state, or `starts with 0.3` behind several, "
                          "with numbers that sum to 1");
            return;
        }
        lang::Place start = make_place(make_name("begins", block_.name.span));
        start.role = lang::Role::kStart;
        give_token(start);
        start.is_public = true;
        body_.places.push_back(std::move(start));
        for (Start& s : starts_) {
            const std::string name = states_.place(s.state).name.text;
            lang::Transition t =
                make_transition(make_name("begins_in_" + name, s.span),
                                {make_path("begins", s.span)}, {make_path(name, s.span)});
            t.is_public = true;
            t.odds = std::move(s.probability);
            body_.transitions.push_back(std::move(t));
        }
    }

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    bool discrete_ = false;
    Expr period_;
    States states_{teller_, body_, "this chain", ""};
    std::vector<Leaving> leaving_;  // by state
    std::vector<Start> starts_;
};

}  // namespace

void lower_markov(const lang::Block& block, const lang::File& file, Lowered& out) {
    Markov(block, file, out).lower();
}

}  // namespace puppetri::notation
