// SPDX-License-Identifier: MIT
// Event graphs (L. Schruben, "Simulation modeling with event graphs", Communications of the ACM 26
// (1983)): nodes are events that change the state, edges schedule others after a while, if a
// condition holds, or cancel them.
//   event_graph shop {
//     data waiting: 0 .. 1000 = 0
//     event run starts
//     event arrive { waiting := waiting + 1 }
//     run -> arrive
//     arrive -> arrive after 10 s
//     arrive -> start when free > 0
//   }
// The event list is the marking: an occurrence of E that is scheduled is a token in E_list, ready
// when its time has come; it carries the arguments of the event. An event is one firing of the
// transition E. Its edges with a condition are looked at right afterwards, before anything else
// happens, and so see the state that E has made.
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "kinds.h"
#include "line.h"
#include "make.h"

namespace puppetri::notation {
namespace {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::ExprKind;
using lang::Op;
using lang::Span;

constexpr std::string_view kEventForm =
    "event NAME(PARAMETER: TYPE) \"caption\" priority NUMBER raises EVENT starts ends { DATUM := "
    "VALUE }";
constexpr std::string_view kEdgeForm =
    "FROM -> TO(PARAMETER: VALUE) after TIME when CONDITION does MOVEMENT, or FROM -> TO cancels "
    "when CONDITION";

// Events of the instant fire between 1 and kMostPriority; what an event has begun comes first: it
// cancels, and then it schedules, edge after edge, and at last the graph ends with it.
constexpr int kMostPriority = 1000, kMostEdges = 10000;
constexpr int kEnds = kMostPriority + 1, kSchedules = kEnds + kMostEdges, kDraws = kSchedules + 1,
              kWishes = kDraws + kMostEdges, kCancels = kWishes + 1;

struct EventNode {
    lang::Name name;
    lang::Caption caption;
    Span span;
    std::vector<lang::Parameter> parameters;
    Expr priority;
    bool starts = false, ends = false;
    std::vector<lang::Path> raises;
    std::vector<lang::Binding> sets;
    const std::string& text() const { return name.text; }
    std::string list() const { return name.text + "_list"; }
};

struct Edge {
    std::size_t from = 0, to = 0;
    std::vector<lang::Argument> arguments;
    Expr after, when, does;
    bool cancels = false, all = false;
    lang::Caption caption;
    Span span;
    std::string name;  // FROM_to_TO
};

class EventGraph {
 public:
    EventGraph(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), out_(out), body_(out.net.body) {}

    void lower() {
        for (const lang::Property& p : block_.properties) {
            if (!has_arrow(p)) {
                declaration(p);
            }
        }
        for (const lang::Property& p : block_.properties) {
            if (has_arrow(p)) {
                edge(p);
            }
        }
        check();
        if (edges_.size() > kMostEdges) {
            teller_.error("too-many", block_.name.span,
                          "an event graph has at most " + std::to_string(kMostEdges) + " edges",
                          "make several graphs of it");
        }
        if (!has_errors(out_.diagnostics)) {
            build();
        }
    }

 private:
    // ---- reading ----
    void declaration(const lang::Property& p) {
        const std::string word = lang::to_text(p.name);
        Line line(p, teller_);
        if (word == "event") {
            event(p, line);
        } else if (word == "data") {
            data(line);
        } else {
            teller_.error("unknown-name", p.name.span,
                          "there is no line '" + word + "' in an event graph",
                          "there are: data, event, and FROM -> TO");
        }
    }

    void data(Line& line) {
        lang::Data made;
        if (read_data(line, made)) {
            body_.data.push_back(std::move(made));
        }
    }

    void event(const lang::Property& p, Line& line) {
        const Expr* head = line.value("the name of an event");
        if (head == nullptr) {
            return;
        }
        if ((head->kind != ExprKind::kPath && head->kind != ExprKind::kCall) ||
            head->path.steps.size() != 1) {
            teller_.error("syntax", head->span, "the name of an event is wanted here",
                          "write event arrive, or event arrive(who: int)");
            return;
        }
        EventNode made;
        made.name = head->path.steps[0];
        made.span = p.span;
        for (const lang::Argument& a : head->args) {
            if (a.name.text.empty()) {
                teller_.error("syntax", a.value.span, "a parameter has a name and a type",
                              "write event arrive(who: int)");
                continue;
            }
            made.parameters.push_back({.name = a.name, .type = a.value, .span = a.name.span});
        }
        made.caption = line.caption();
        while (!line.done()) {
            if (line.clause("priority", "a whole number", made.priority)) {
                continue;
            }
            if (line.word("starts")) {
                made.starts = true;
            } else if (line.word("ends")) {
                made.ends = true;
                ends_ = true;
            } else if (line.word("raises")) {
                if (const lang::Path* e = line.path("the name of an event")) {
                    made.raises.push_back(*e);
                }
            } else {
                line.finish(kEventForm);
            }
        }
        for (const lang::Property& child : p.children) {
            if (child.values.size() == 2 && child.values[0].kind == ExprKind::kSymbol &&
                child.values[0].text == ":=") {
                made.sets.push_back(make_assignment(child.name, child.values[1]));
            } else {
                teller_.error("syntax", child.span, "a change of the state is wanted here",
                              "write waiting := waiting + 1");
            }
        }
        if (made.starts && !made.parameters.empty()) {
            teller_.error("start-state", made.span, "nobody says with which arguments it starts",
                          "let another event start, and schedule this one");
        }
        if (numbers_.count(made.text()) != 0) {
            teller_.error("name-twice", p.span, "there is already an event " + made.text(),
                          "choose another name");
            return;
        }
        numbers_[made.text()] = events_.size();
        events_.push_back(std::move(made));
    }

    EventNode* find(const lang::Path& path) {
        const auto found =
            path.steps.size() == 1 ? numbers_.find(path.steps[0].text) : numbers_.end();
        if (found == numbers_.end()) {
            teller_.error("unknown-name", path.span,
                          "there is no event " + lang::to_text(path) + " in this graph",
                          "give it a line of its own: event " + lang::to_text(path));
            return nullptr;
        }
        return &events_[found->second];
    }

    void edge(const lang::Property& p) {
        Line line(p, teller_);
        line.symbol("->");
        const Expr* target = line.value("the name of an event");
        if (target == nullptr) {
            return;
        }
        if (target->kind != ExprKind::kPath && target->kind != ExprKind::kCall) {
            teller_.error("syntax", target->span, "the name of an event is wanted here",
                          "write " + std::string(kEdgeForm));
            return;
        }
        EventNode* from = find(p.name);
        EventNode* to = find(target->path);
        Edge made;
        made.span = p.span;
        made.arguments = target->args;
        made.caption = line.caption();
        while (!line.done()) {
            if (line.clause("after", "a time", made.after) ||
                line.clause("when", "a condition", made.when) ||
                line.clause("does", "a movement", made.does)) {
                continue;
            }
            if (line.word("cancels")) {
                made.cancels = true;
                made.all = line.word("all");
            } else {
                line.finish(kEdgeForm);
            }
        }
        if (from == nullptr || to == nullptr) {
            return;
        }
        made.from = static_cast<std::size_t>(from - events_.data());
        made.to = static_cast<std::size_t>(to - events_.data());
        const std::string base = from->text() + (made.cancels ? "_cancels_" : "_to_") + to->text();
        const int same = ++names_[base];
        made.name = same == 1 ? base : base + "_" + std::to_string(same);
        if (made.cancels && made.after) {
            teller_.error("syntax", made.after.span, "what is cancelled is cancelled at once",
                          "remove after, or schedule an event that cancels it");
        }
        if (made.cancels && made.does) {
            teller_.error("syntax", made.does.span, "what is cancelled does nothing",
                          "remove does");
        }
        arguments(made);
        edges_.push_back(std::move(made));
    }

    // By name or in order; every parameter of a scheduled event once. Which occurrence is
    // cancelled may be told by some of them.
    void arguments(Edge& e) {
        const EventNode& to = events_[e.to];
        std::vector<bool> given(to.parameters.size());
        std::size_t next = 0;
        for (lang::Argument& a : e.arguments) {
            std::size_t i = 0;
            if (a.name.text.empty()) {
                i = next++;
            } else {
                while (i < to.parameters.size() && to.parameters[i].name.text != a.name.text) {
                    ++i;
                }
            }
            if (i >= to.parameters.size() || given[i]) {
                teller_.error("wrong-arguments", a.value.span,
                              i >= to.parameters.size()
                                  ? to.text() + " has no such parameter"
                                  : to.parameters[i].name.text + " is given twice",
                              "give the parameters of its line: event " + to.text() + "(...)");
                return;
            }
            given[i] = true;
            a.name = to.parameters[i].name;
        }
        for (std::size_t i = 0; i < given.size() && !e.cancels; ++i) {
            if (!given[i]) {
                teller_.error(
                    "wrong-arguments", e.span,
                    to.text() + " is not told its " + to.parameters[i].name.text,
                    "write -> " + to.text() + "(" + to.parameters[i].name.text + ": ...)");
            }
        }
    }

    void check() {
        if (std::none_of(events_.begin(), events_.end(),
                         [](const EventNode& e) { return e.starts; })) {
            teller_.error("start-state", block_.name.span, "nothing happens at the beginning",
                          "write `starts` behind the event that comes first: event run starts");
        }
        // Reached: from an event that starts along edges that schedule.
        std::vector<bool> there(events_.size());
        for (std::size_t i = 0; i < events_.size(); ++i) {
            there[i] = events_[i].starts;
        }
        for (bool more = true; more;) {
            more = false;
            for (const Edge& e : edges_) {
                if (!e.cancels && there[e.from] && !there[e.to]) {
                    there[e.to] = more = true;
                }
            }
        }
        for (std::size_t i = 0; i < events_.size(); ++i) {
            if (!there[i]) {
                teller_.warn("never-entered", events_[i].span,
                             "the event " + events_[i].text() + " never comes",
                             "add an edge: ... -> " + events_[i].text() + ", or remove it");
            }
        }
        for (std::size_t i = 0; i < edges_.size(); ++i) {
            if (edges_[i].does && only_edge(edges_[i].to) == nullptr) {
                teller_.error("not-together", edges_[i].does.span,
                              "several edges schedule " + events_[edges_[i].to].text() +
                                  ", and one of them does a movement",
                              "let the movement end in an event of its own, which schedules " +
                                  events_[edges_[i].to].text());
            }
        }
        for (const EventNode& e : events_) {
            for (const lang::Parameter& p : e.parameters) {
                const bool taken =
                    std::any_of(
                        block_.parameters.begin(), block_.parameters.end(),
                        [&](const lang::Parameter& b) { return b.name.text == p.name.text; }) ||
                    std::any_of(body_.data.begin(), body_.data.end(),
                                [&](const lang::Data& d) { return d.name.text == p.name.text; });
                if (taken) {
                    teller_.error("name-twice", p.name.span,
                                  "the event " + e.text() + " has a parameter " + p.name.text +
                                      ", and something else is called so",
                                  "call one of them otherwise");
                }
            }
            if (e.priority.kind == ExprKind::kNumber &&
                (e.priority.number.denominator != 1 || e.priority.number.numerator < 1 ||
                 e.priority.number.numerator > kMostPriority)) {
                teller_.error("out-of-range", e.priority.span,
                              "priorities of events are whole numbers from 1 to " +
                                  std::to_string(kMostPriority),
                              "write priority 2");
            }
        }
    }

    // ---- building ----
    static Arc arc(ArcKind kind, const std::string& place, Span span) {
        Arc a = make_arc(kind, make_path(place, span));
        a.span = span;
        return a;
    }

    lang::Place& place(const std::string& name, Span span,
                       const std::vector<lang::Parameter>& attributes, const std::string& type) {
        lang::Place made = make_place(make_name(name, span));
        made.span = span;
        made.is_public = true;
        if (!attributes.empty()) {
            made.of_type = make_path(type, span);
        }
        body_.places.push_back(std::move(made));
        return body_.places.back();
    }

    lang::Transition& transition(const std::string& name, Span span, const Expr& priority) {
        lang::Transition made = make_transition(make_name(name, span), {}, {});
        made.span = span;
        made.is_public = true;
        made.priority = priority;
        body_.transitions.push_back(std::move(made));
        return body_.transitions.back();
    }

    static std::vector<lang::Binding> bound(const std::vector<lang::Parameter>& parameters,
                                            Span span) {
        std::vector<lang::Binding> out;
        for (const lang::Parameter& p : parameters) {
            out.push_back(
                make_assignment(make_path(p.name.text, span), make_reference(p.name.text, span)));
        }
        return out;
    }

    static std::vector<lang::Binding> given(const Edge& e) {
        std::vector<lang::Binding> out;
        for (const lang::Argument& a : e.arguments) {
            out.push_back(make_assignment(make_path(a.name.text, a.value.span), a.value));
        }
        return out;
    }

    // Distributions and intervals are drawn by the place; anything else is computed when the event
    // is scheduled.
    static bool is_drawn(const Expr& after) {
        static const std::vector<std::string> laws = {"uniform",    "normal",   "exponential",
                                                      "triangular", "erlang",   "gamma",
                                                      "empirical",  "discrete", "constant"};
        return after.kind == ExprKind::kRange ||
               (after.kind == ExprKind::kCall &&
                std::find(laws.begin(), laws.end(), lang::to_text(after.path)) != laws.end());
    }

    // The one edge that schedules the event; null if there are several, or it starts.
    const Edge* only_edge(std::size_t event) const {
        const Edge* only = nullptr;
        for (const Edge& e : edges_) {
            if (e.to == event && !e.cancels) {
                if (only != nullptr) {
                    return nullptr;
                }
                only = &e;
            }
        }
        return events_[event].starts ? nullptr : only;
    }

    // With one law for all, the list itself draws it.
    const Expr* law_of(std::size_t event) const {
        if (const Edge* e = only_edge(event); e != nullptr && (e->does || is_number(e->after))) {
            return e->after ? &e->after : nullptr;
        }
        const Expr* law = nullptr;
        for (const Edge& e : edges_) {
            if (e.to != event || e.cancels) {
                continue;
            }
            if (!is_drawn(e.after) ||
                (law != nullptr && lang::to_text(*law) != lang::to_text(e.after))) {
                return nullptr;
            }
            law = &e.after;
        }
        return events_[event].starts ? nullptr : law;
    }

    // On the state that an event has made, or on its arguments: anything but numbers and parameters
    // of the graph.
    bool depends(const Expr& e, const EventNode& from) const {
        if (e.kind == ExprKind::kPath && e.path.steps.size() == 1) {
            const std::string& name = e.path.steps[0].text;
            return std::none_of(block_.parameters.begin(), block_.parameters.end(),
                                [&](const lang::Parameter& p) { return p.name.text == name; }) ||
                   std::any_of(from.parameters.begin(), from.parameters.end(),
                               [&](const lang::Parameter& p) { return p.name.text == name; });
        }
        return (e.kind != ExprKind::kNone && e.args.empty() && !is_number(e)) ||
               std::any_of(e.args.begin(), e.args.end(),
                           [&](const lang::Argument& a) { return depends(a.value, from); });
    }

    static bool is_number(const Expr& e) { return e.kind == ExprKind::kNumber; }

    void build() {
        for (std::size_t i = 0; i < events_.size(); ++i) {
            EventNode& e = events_[i];
            if (!e.parameters.empty()) {
                lang::TokenType type;
                type.name = make_name(e.text() + "_occurrence", e.span);
                type.attributes = e.parameters;
                type.span = e.span;
                body_.token_types.push_back(std::move(type));
            }
            lang::Place& list = place(e.list(), e.span, e.parameters, e.text() + "_occurrence");
            if (const Expr* law = law_of(i)) {
                list.takes = make_duration(*law);
            }
            if (const Edge* only = only_edge(i); only != nullptr && only->does) {
                list.does = only->does;
            }
            if (e.starts && !ends_) {
                give_token(list);
            }
            lang::Transition& t = transition(e.text(), e.span, e.priority);
            t.raises = e.raises;
            t.caption = e.caption;
            t.inputs = {arc(ArcKind::kTake, e.list(), e.span)};
            t.inputs[0].pattern = bound(e.parameters, e.span);
            t.assignments = e.sets;
        }
        for (const Edge& e : edges_) {
            e.cancels ? cancel(e) : schedule(e);
        }
        if (ends_) {
            ways();
        }
    }

    // The way in schedules what starts; the way out calls off all that is scheduled.
    void ways() {
        const Span span = block_.name.span;
        std::vector<std::string> all;
        for (const lang::Place& p : body_.places) {
            all.push_back(p.name.text);
        }
        lang::Place& begin = place("graph_begin", span, {}, "");
        begin.role = lang::Role::kStart;
        give_token(begin);
        place("graph_ending", span, {}, "");
        place("graph_done", span, {}, "").role = lang::Role::kFinish;
        for (std::size_t i = 0; i < events_.size(); ++i) {
            if (events_[i].ends) {
                of_event(i).outputs.push_back(arc(ArcKind::kGive, "graph_ending", events_[i].span));
            }
        }
        lang::Transition& starts =
            transition("graph_starts", span, make_number(Rational{kDraws}, span));
        starts.inputs = {arc(ArcKind::kTake, "graph_begin", span)};
        for (const EventNode& e : events_) {
            if (e.starts) {
                starts.outputs.push_back(arc(ArcKind::kGive, e.list(), e.span));
            }
        }
        lang::Transition& ends = transition("graph_ends", span, make_number(Rational{kEnds}, span));
        ends.inputs = {arc(ArcKind::kTake, "graph_ending", span)};
        for (const std::string& p : all) {
            ends.inputs.push_back(arc(ArcKind::kTakeAllNow, p, span));
        }
        ends.outputs = {arc(ArcKind::kGive, "graph_done", span)};
    }

    bool cancels_any(std::size_t event) const {
        return std::any_of(edges_.begin(), edges_.end(),
                           [&](const Edge& e) { return e.cancels && e.from == event; });
    }

    lang::Transition& of_event(std::size_t i) {
        for (lang::Transition& t : body_.transitions) {
            if (t.name.text == events_[i].text()) {
                return t;
            }
        }
        return body_.transitions.front();
    }

    // Right after the event: a token in NAME_test, which is taken at once, whether the condition
    // holds or not.
    lang::Transition& tested(const Edge& e) {
        const EventNode& from = events_[e.from];
        const std::string test = e.name + "_test";
        place(test, e.span, from.parameters, from.text() + "_occurrence");
        Arc asks = arc(ArcKind::kGive, test, e.span);
        asks.pattern = bound(from.parameters, e.span);
        of_event(e.from).outputs.push_back(asks);
        asks.kind = ArcKind::kTake;
        const auto place_of_edge = static_cast<int>(&e - edges_.data());
        const Expr priority =
            make_number(Rational{(e.cancels ? kWishes : kSchedules) - place_of_edge}, e.span);
        if (e.when) {
            lang::Transition& no = transition(e.name + "_not", e.span, priority);
            no.inputs = {asks};
            no.guard = make_unary(Op::kNot, e.when);
        }
        lang::Transition& yes = transition(e.name, e.span, priority);
        yes.caption = e.caption;
        yes.inputs = {asks};
        yes.guard = e.when;
        return yes;
    }

    void schedule(const Edge& e) {
        const EventNode& to = events_[e.to];
        const bool by_list = law_of(e.to) != nullptr;
        const bool drawn = !by_list && is_drawn(e.after);
        const bool reads_state =
            !e.arguments.empty() || (!by_list && !drawn && depends(e.after, events_[e.from]));
        Arc gives = arc(ArcKind::kGive, drawn ? e.name + "_draw" : to.list(), e.span);
        gives.pattern = given(e);
        if (e.after && !by_list && !drawn) {
            gives.pattern.push_back(make_assignment(make_path("left", e.span), e.after));
        }
        if (e.when || reads_state || cancels_any(e.from)) {
            tested(e).outputs.push_back(gives);
        } else {
            of_event(e.from).outputs.push_back(gives);
        }
        if (drawn) {
            // Asks the law how long, and gives the list that.
            lang::Place& draw =
                place(e.name + "_draw", e.span, to.parameters, to.text() + "_occurrence");
            draw.takes = make_duration(e.after);
            lang::Transition& t =
                transition(e.name + "_drawn", e.span, make_number(Rational{kDraws}, e.span));
            Arc asks = arc(ArcKind::kTakeNow, e.name + "_draw", e.span);
            asks.pattern = bound(to.parameters, e.span);
            asks.pattern.push_back(
                make_assignment(make_path("left", e.span), make_reference("how long", e.span)));
            t.inputs = {asks};
            Arc list = arc(ArcKind::kGive, to.list(), e.span);
            list.pattern = asks.pattern;
            t.outputs = {list};
        }
    }

    // The next of the scheduled occurrences, or all of them; of none, nothing.
    void cancel(const Edge& e) {
        const EventNode& to = events_[e.to];
        const std::string wish = e.name + "_wish";
        std::vector<lang::Parameter> told;
        for (const lang::Argument& a : e.arguments) {
            for (const lang::Parameter& p : to.parameters) {
                if (p.name.text == a.name.text) {
                    told.push_back(p);
                }
            }
        }
        if (!told.empty()) {
            lang::TokenType type;
            type.name = make_name(wish + "_type", e.span);
            type.attributes = told;
            type.span = e.span;
            body_.token_types.push_back(std::move(type));
        }
        place(wish, e.span, told, wish + "_type");
        Arc gives = arc(ArcKind::kGive, wish, e.span);
        gives.pattern = given(e);
        tested(e).outputs.push_back(gives);
        const Expr priority = make_number(Rational{kCancels}, e.span);
        Arc asks = arc(ArcKind::kTake, wish, e.span);
        asks.pattern = bound(told, e.span);
        Arc goes = arc(ArcKind::kTakeNow, to.list(), e.span);
        goes.pattern = bound(told, e.span);
        Arc none = goes;
        none.kind = ArcKind::kUnless;
        {
            lang::Transition& found = transition(e.name + "_done", e.span, priority);
            found.inputs = {asks, goes};
            if (e.all) {
                Arc again = asks;
                again.kind = ArcKind::kGive;
                found.outputs = {again};
            }
        }
        lang::Transition& nothing = transition(e.name + "_nothing", e.span, priority);
        nothing.inputs = {asks};
        nothing.tests = {none};
    }

    const lang::Block& block_;
    Teller teller_;
    Lowered& out_;
    lang::Body& body_;
    std::vector<EventNode> events_;
    std::vector<Edge> edges_;
    std::map<std::string, std::size_t> numbers_;
    std::map<std::string, int> names_;
    bool ends_ = false;  // some event ends it
};

}  // namespace

void lower_event_graph(const lang::Block& block, const lang::File& file, Lowered& out) {
    EventGraph(block, file, out).lower();
}

}  // namespace puppetri::notation
