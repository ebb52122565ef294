// SPDX-License-Identifier: MIT
// States with names and lines between them, as automata and Markov chains have both: each state is
// a public place, each line `a -> b` a transition `a_to_b`.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "line.h"
#include "puppetri/lang/syntax.h"

namespace puppetri::notation {

// Which of `next.size()` things can be reached from where it begins, by steps to those of `next`.
std::vector<bool> reachable(const std::vector<std::vector<std::size_t>>& next,
                            std::vector<std::size_t> begins);

class States {
 public:
    // `whole`: what they are states of, "this automaton"; `form`: what stands behind a name in the
    // line that a remedy asks for, " takes 1 s".
    States(Teller& teller, lang::Body& body, std::string whole, std::string form)
        : teller_(teller), body_(body), whole_(std::move(whole)), form_(std::move(form)) {}

    // The place of a line `NAME "caption" ...`, of which the name and the caption have been taken.
    static lang::Place begin(Line& line);
    // Puts it into the net. Fails, and tells it, where the name is taken.
    bool add(lang::Place place);

    // A line `FROM -> TO "caption" ...`, read up to its caption; nothing where it names no states,
    // which has been told.
    struct Edge {
        std::size_t from = 0, to = 0;  // states, in the order in which they were added
        lang::Transition transition;   // called FROM_to_TO
    };
    std::optional<Edge> edge(Line& line);

    std::size_t size() const { return places_.size(); }
    lang::Place& place(std::size_t state) { return body_.places[places_[state]]; }
    // It may begin in this state.
    void enter(std::size_t state) { begins_.push_back(state); }
    // Whoever rests in this state for ever is at an end.
    void end(std::size_t state);
    // Where a place runs the whole: the way in, unless it has one, is the one state in which it
    // begins; the way out the one in which it ends.
    void make_ways();
    // Warns of states that no way leads to from where it may begin.
    void check();

 private:
    std::optional<std::size_t> find(const lang::Path& path);

    Teller& teller_;
    lang::Body& body_;
    const std::string whole_, form_;
    std::map<std::string, std::size_t> numbers_;
    std::vector<std::size_t> places_;  // in the body
    std::vector<std::size_t> begins_, ends_;
    std::vector<std::vector<std::size_t>> next_;  // by state
};

}  // namespace puppetri::notation
