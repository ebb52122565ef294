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
#include "states.h"

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
        const auto is_state = [](const lang::Property& p) { return !has_arrow(p); };
        each_line(block_, teller_, is_state, [this](Line& line) { state(line); });
        each_line(block_, teller_, has_arrow, [this](Line& line) { edge(line); });
        if (starts_ != 1) {
            teller_.error("start-state", block_.name.span,
                          starts_ == 0 ? "no state is the first one"
                                       : "an automaton is in one state at a time",
                          "write `starts` behind exactly one state");
        }
        states_.make_ways();
        states_.check();
    }

 private:
    void state(Line& line) {
        lang::Place place = States::begin(line);
        bool starts = false, final = false;
        while (!line.done()) {
            if (line.takes(place.takes) || line.clause("does", "a movement", place.does) ||
                line.clause("runs", "a net", place.runs)) {
                continue;
            }
            if (line.word("starts")) {
                give_token(place);
                starts = true;
                ++starts_;
            } else if (line.word("final")) {
                final = true;
            } else {
                line.finish(kStateForm);
            }
        }
        if (!states_.add(std::move(place))) {
            return;
        }
        if (starts) {
            states_.enter(states_.size() - 1);
        }
        if (final) {
            states_.end(states_.size() - 1);
        }
    }

    void edge(Line& line) {
        auto made = states_.edge(line);
        if (!made) {
            return;
        }
        lang::Transition& t = made->transition;
        if (const int same = ++names_[t.name.text]; same > 1) {
            t.name.text += "_" + std::to_string(same);
        }
        t.caption = line.caption();
        while (!line.done()) {
            if (line.word("on")) {
                do {
                    if (const lang::Path* event = line.path("the name of an event")) {
                        t.events.push_back(*event);
                    }
                } while (line.word("or"));
            } else if (!line.clause("when", "a condition", t.guard) &&
                       !line.clause("odds", "a number above 0", t.odds)) {
                line.finish(kEdgeForm);
            }
        }
        body_.transitions.push_back(std::move(t));
    }

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    States states_{teller_, body_, "this automaton", " takes 1 s"};
    std::map<std::string, int> names_;
    int starts_ = 0;
};

}  // namespace

void lower_automaton(const lang::Block& block, const lang::File& file, Lowered& out) {
    Automaton(block, file, out).lower();
}

}  // namespace puppetri::notation
