// SPDX-License-Identifier: MIT
// Finite automata whose states last (Hopcroft, Ullman; timed states as in Fishwick and Porr's
// SimPack). A state is a place, being in it its one token; a line `a -> b` is a transition.
//   automaton light {
//     green  takes 20 s starts
//     yellow takes 3 s
//     red    takes 17 s does ana.wave
//     green -> yellow
//     yellow -> red
//     red -> green on button or timer when cars = 0
//   }
#include <map>
#include <string>

#include "kinds.h"
#include "line.h"
#include "make.h"

namespace puppetri::notation {
namespace {

constexpr std::string_view kStateForm =
    "NAME \"caption\" takes TIME does MOVEMENT runs NET starts final";
constexpr std::string_view kEdgeForm = "FROM -> TO on EVENT when CONDITION odds NUMBER";

class Automaton {
 public:
    Automaton(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), body_(out.net.body) {}

    void lower() {
        for (const lang::Property& p : block_.properties) {
            Line line(p, teller_);
            if (!has_arrow(p)) {
                state(line);
            }
        }
        for (const lang::Property& p : block_.properties) {
            Line line(p, teller_);
            if (has_arrow(p)) {
                edge(line);
            }
        }
        check();
    }

 private:
    struct State {
        std::size_t place = 0;
        bool entered = false;
    };

    void state(Line& line) {
        lang::Place place = make_place(line.name().steps[0]);
        place.span = line.span();
        place.caption = line.caption();
        place.is_public = true;
        State made{.place = body_.places.size()};
        while (!line.done()) {
            if (line.word("takes")) {
                if (const lang::Expr* e = line.value("a time")) {
                    place.takes = make_duration(*e);
                }
            } else if (line.word("does")) {
                if (const lang::Expr* e = line.value("a movement")) {
                    place.does = *e;
                }
            } else if (line.word("runs")) {
                if (const lang::Expr* e = line.value("a net")) {
                    place.runs = *e;
                }
            } else if (line.word("starts")) {
                give_token(place);
                made.entered = true;
                ++starts_;
            } else if (line.word("final")) {
                lang::End end;
                end.formulas.push_back(make_reference(place.name.text, line.span()));
                end.span = line.span();
                body_.ends.push_back(std::move(end));
            } else {
                line.finish(kStateForm);
            }
        }
        const std::string name = place.name.text;
        if (!states_.emplace(name, made).second) {
            teller_.error("name-twice", line.span(), "there is already a state " + name,
                          "choose another name");
            return;
        }
        body_.places.push_back(std::move(place));
    }

    State* find(const lang::Path& path) {
        const auto found =
            path.steps.size() == 1 ? states_.find(path.steps[0].text) : states_.end();
        if (found == states_.end()) {
            teller_.error("unknown-name", path.span,
                          "there is no state " + lang::to_text(path) + " in this automaton",
                          "give it a line of its own: " + lang::to_text(path) + " takes 1 s");
            return nullptr;
        }
        return &found->second;
    }

    void edge(Line& line) {
        line.symbol("->");
        const lang::Path* to = line.path("the name of a state");
        if (to == nullptr) {
            return;
        }
        const State* before = find(line.name());
        State* after = find(*to);
        if (before == nullptr || after == nullptr) {
            return;
        }
        after->entered = true;
        const std::string base = line.name().steps[0].text + "_to_" + to->steps[0].text;
        const int same = ++names_[base];
        lang::Transition t = make_transition(
            make_name(same == 1 ? base : base + "_" + std::to_string(same), line.span()),
            {line.name()}, {*to});
        t.span = line.span();
        t.is_public = true;
        t.caption = line.caption();
        while (!line.done()) {
            if (line.word("on")) {
                do {
                    if (const lang::Path* event = line.path("the name of an event")) {
                        t.events.push_back(*event);
                    }
                } while (line.word("or"));
            } else if (line.word("when")) {
                if (const lang::Expr* e = line.value("a condition")) {
                    t.guard = *e;
                }
            } else if (line.word("odds")) {
                if (const lang::Expr* e = line.value("a number above 0")) {
                    t.odds = *e;
                }
            } else {
                line.finish(kEdgeForm);
            }
        }
        body_.transitions.push_back(std::move(t));
    }

    void check() {
        if (starts_ != 1) {
            teller_.error("start-state", block_.name.span,
                          starts_ == 0 ? "no state is the first one"
                                       : "an automaton is in one state at a time",
                          "write `starts` behind exactly one state");
        }
        for (const auto& [name, state] : states_) {
            const lang::Place& place = body_.places[state.place];
            if (!state.entered) {
                teller_.warn("never-entered", place.span, "the state " + name + " is never entered",
                             "add a line: ... -> " + name + ", or remove it");
            }
        }
    }

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    std::map<std::string, State> states_;
    std::map<std::string, int> names_;
    int starts_ = 0;
};

}  // namespace

void lower_automaton(const lang::Block& block, const lang::File& file, Lowered& out) {
    Automaton(block, file, out).lower();
}

}  // namespace puppetri::notation
