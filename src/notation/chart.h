// SPDX-License-Identifier: MIT
// A statechart as SCXML says it (W3C Recommendation "State Chart XML", 2015), in the subset of
// docs/notations/scxml.md: what a file says, with names looked up and expressions translated.
// chart_reader.cpp makes it, chart_net.cpp makes a net of it.
#pragma once
#include <string>
#include <vector>

#include "puppetri/lang/parse.h"
#include "xml.h"

namespace puppetri::notation::chart {

enum class Kind : std::uint8_t { kState, kParallel, kFinal, kHistory };

// Executable content, in order.
struct Step {
    enum class What : std::uint8_t { kAssign, kRaise, kSend, kCancel, kIf } what;
    std::string name;   // the datum, the event, the id of the send
    std::string event;  // kSend
    lang::Expr value;   // kAssign: the value; kSend: the delay, a time
    struct Branch {
        lang::Expr condition;  // kNone: else
        std::vector<Step> steps;
    };
    std::vector<Branch> branches;  // kIf
    lang::Span span;
};
using Steps = std::vector<Step>;

struct State {
    std::string id;    // empty: none was given
    std::string name;  // of its place
    Kind kind = Kind::kState;
    bool deep = false;  // history
    int parent = -1;
    std::vector<int> children;  // states, parallels and finals, in document order
    std::vector<int> histories;
    std::vector<int> initial;  // where a compound state begins; the default of a history
    Steps initial_steps;       // with it
    Steps on_entry, on_exit;
    std::vector<int> transitions;
    lang::Span span;

    bool compound() const { return kind == Kind::kState && !children.empty(); }
    bool atomic() const {
        return kind == Kind::kFinal || (kind == Kind::kState && children.empty());
    }
};

struct Transition {
    int source = 0;
    std::vector<std::string> events;  // as written: "door.*"; empty: eventless
    lang::Expr condition;
    std::vector<int> targets;
    bool internal = false;
    Steps steps;
    lang::Span span;
};

struct Datum {
    std::string id;
    std::string name;  // of the net's datum
    bool is_bool = false;
    lang::Expr initial;
    lang::Span span;
};

// An event that the outside makes occur.
struct Heard {
    std::string event, name;  // as the chart calls it; of the net's event
    lang::Span span;
};

struct Chart {
    std::string name;
    std::string begin = "begin", done = "done";  // its way in and out
    std::vector<Heard> heard;
    std::vector<State> states;  // in document order; the first is the <scxml> element
    std::vector<Transition> transitions;
    std::vector<Datum> data;
    std::vector<std::string> events;  // all names, numbered from 1
    bool reads_event = false;         // some expression reads _event.name

    std::int64_t number_of(const std::string& event) {
        for (std::size_t i = 0; i < events.size(); ++i) {
            if (events[i] == event) {
                return static_cast<std::int64_t>(i) + 1;
            }
        }
        events.push_back(event);
        return static_cast<std::int64_t>(events.size());
    }

    bool descends(int state, int from) const {  // properly
        for (int s = states[static_cast<std::size_t>(state)].parent; s >= 0;
             s = states[static_cast<std::size_t>(s)].parent) {
            if (s == from) {
                return true;
            }
        }
        return false;
    }
    const State& at(int s) const { return states[static_cast<std::size_t>(s)]; }
};

// Data of the net: whether a state is active, the number of the event that is looked at, and of the
// last one.
std::string inside_name(const State& s);
inline constexpr const char* kEvent = "event now";
inline constexpr const char* kLastEvent = "event last";

// Adds diagnostics to `out`; with errors among them the chart is not whole.
Chart read(const xml::Element& root, lang::Parsed& out);

// An expression of the data model: whole numbers, truth values, their operators, In('state'),
// _event.name == 'event'.
struct Translated {
    lang::Expr expr;
    bool is_bool = false;
    std::string problem;  // not empty: outside the subset, and why
};
Translated translate(Chart& chart, std::string_view text, lang::Span where);
// As a condition: numbers are true unless 0.
lang::Expr as_condition(Translated t);

// The net of the chart, called `name`. `vague`: transitions to a history from inside of its state,
// which would leave more or less depending on what the history holds; the span of the whole where
// the chart is too large. With one of these it is no net. `never`: states that no run enters.
lang::Net make_net(const Chart& chart, const std::string& name, lang::Span where,
                   std::vector<lang::Span>& vague, std::vector<int>& never);

}  // namespace puppetri::notation::chart
