// SPDX-License-Identifier: MIT
// From XML to a chart. What is outside of the subset is told, with its remedy; nothing is skipped
// in silence but comments, logs and what other programs add under names of their own.
#include <algorithm>
#include <set>

#include "chart.h"
#include "make.h"
#include "puppetri/lang/decimal.h"

namespace puppetri::notation::chart {
namespace {

constexpr std::string_view kSpace = "http://www.w3.org/2005/07/scxml";
constexpr std::size_t kMaxStates = 2000, kMaxTransitions = 5000;

std::vector<std::string> words(std::string_view text) {
    std::vector<std::string> out;
    std::string word;
    for (const char c : text) {
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
            if (!word.empty()) {
                out.push_back(std::move(word));
            }
            word.clear();
        } else {
            word += c;
        }
    }
    if (!word.empty()) {
        out.push_back(std::move(word));
    }
    return out;
}

class Reader {
 public:
    Reader(const xml::Element& root, lang::Parsed& out) : root_(root), out_(out) {}

    Chart run() {
        if (root_.name != "scxml" || !own(root_)) {
            error("not-scxml", root_.span, "this is no SCXML document",
                  "begin with <scxml xmlns=\"http://www.w3.org/2005/07/scxml\" version=\"1.0\">");
            return std::move(chart_);
        }
        attributes(root_, {"initial", "name", "version", "datamodel", "binding", "exmode"});
        if (const xml::Attribute* a = root_.find("name")) {
            chart_.name = a->value;
        }
        if (const xml::Attribute* a = root_.find("datamodel");
            a != nullptr && a->value != "null" && a->value != "ecmascript") {
            outside(a->span, "the data model " + a->value,
                    "use ecmascript, with whole numbers and truth values");
        }
        if (const xml::Attribute* a = root_.find("binding"); a != nullptr && a->value != "early") {
            outside(a->span, "late binding", "write binding=\"early\", or leave it out");
        }
        collect(root_, -1, 0);
        collect_data(root_);
        for (const auto& [element, state] : elements_) {
            fill(*element, state);
        }
        check();
        return std::move(chart_);
    }

 private:
    // -- telling
    void tell(Severity severity, std::string code, lang::Span where, std::string message,
              std::string remedy) {
        out_.diagnostics.push_back({severity, std::move(code), out_.file.where(where), "chart",
                                    std::move(message), std::move(remedy)});
    }
    void error(std::string code, lang::Span where, std::string message, std::string remedy) {
        tell(Severity::kError, std::move(code), where, std::move(message), std::move(remedy));
    }
    void outside(lang::Span where, const std::string& what, std::string remedy) {
        error("outside-subset", where, what + " is outside of the SCXML that is read here",
              std::move(remedy));
    }

    static bool own(const xml::Element& e) { return e.space.empty() || e.space == kSpace; }

    void attributes(const xml::Element& e, std::initializer_list<std::string_view> known) {
        for (const xml::Attribute& a : e.attributes) {
            // Names with a prefix belong to other programs.
            if (a.name.find(':') == a.name.npos && a.name != "xmlns" &&
                std::find(known.begin(), known.end(), a.name) == known.end()) {
                outside(a.span, "the attribute " + a.name + " of <" + e.name + ">",
                        "remove it, or say the same without it");
            }
        }
    }

    // Children of the chart that are no SCXML are skipped with a warning.
    bool foreign(const xml::Element& e) {
        if (own(e)) {
            return false;
        }
        tell(Severity::kWarning, "foreign-element", e.span,
             "<" + e.name + "> belongs to another program and is not read", "remove it");
        return true;
    }

    // -- states, in document order
    void collect(const xml::Element& e, int parent, int depth) {
        const int number = static_cast<int>(chart_.states.size());
        if (chart_.states.size() >= kMaxStates) {
            if (!too_many_) {
                error("too-large", e.span,
                      "this chart has more than " + std::to_string(kMaxStates) + " states",
                      "divide it");
            }
            too_many_ = true;
            return;
        }
        State s;
        s.parent = parent;
        s.span = e.span;
        s.kind = e.name == "parallel"  ? Kind::kParallel
                 : e.name == "final"   ? Kind::kFinal
                 : e.name == "history" ? Kind::kHistory
                                       : Kind::kState;
        if (const xml::Attribute* id = e.find("id"); id != nullptr && number != 0) {
            s.id = id->value;
            if (s.id.empty() || !names_.insert(s.id).second) {
                error(s.id.empty() ? "missing-name" : "name-twice", id->span,
                      s.id.empty() ? "this id is empty" : "there is already a state " + s.id,
                      "choose another id");
            }
        }
        chart_.states.push_back(std::move(s));
        elements_.emplace_back(&e, number);
        for (const xml::Element& child : e.children) {
            if (!own(child) || (child.name != "state" && child.name != "parallel" &&
                                child.name != "final" && child.name != "history")) {
                continue;
            }
            const std::string& kind = e.name;
            const bool fits = kind == "scxml"      ? child.name != "history"
                              : kind == "state"    ? true
                              : kind == "parallel" ? child.name != "final"
                                                   : false;
            if (!fits) {
                error("bad-scxml", child.span,
                      "<" + child.name + "> cannot stand in <" + kind + ">",
                      "move it into a <state>");
                continue;
            }
            const int next = static_cast<int>(chart_.states.size());
            collect(child, number, depth + 1);
            if (next < static_cast<int>(chart_.states.size())) {
                State& self = chart_.states[static_cast<std::size_t>(number)];
                (child.name == "history" ? self.histories : self.children).push_back(next);
            }
        }
    }

    void name_all() {
        // States without an id are called after their kind and number.
        for (std::size_t i = 1; i < chart_.states.size(); ++i) {
            State& s = chart_.states[i];
            s.name = s.id;
            if (s.id.empty()) {
                s.name = unused(s.kind == Kind::kFinal      ? "final_" + std::to_string(i)
                                : s.kind == Kind::kParallel ? "parallel_" + std::to_string(i)
                                : s.kind == Kind::kHistory  ? "history_" + std::to_string(i)
                                                            : "state_" + std::to_string(i));
            }
        }
        chart_.states[0].name = "chart";
    }

    std::string unused(std::string name) {
        while (!names_.insert(name).second) {
            name += "_";
        }
        return name;
    }

    // -- data
    void collect_data(const xml::Element& root) {
        name_all();
        chart_.begin = unused("begin");
        chart_.done = unused("done");
        for (const auto& [element, state] : elements_) {
            for (const xml::Element& child : element->children) {
                if (own(child) && child.name == "datamodel") {
                    for (const xml::Element& d : child.children) {
                        datum(d);
                    }
                }
            }
        }
        (void)root;
    }

    void datum(const xml::Element& e) {
        if (foreign(e)) {
            return;
        }
        attributes(e, {"id", "expr", "src"});
        const xml::Attribute* id = e.find("id");
        const xml::Attribute* expr = e.find("expr");
        if (e.name != "data" || id == nullptr || id->value.empty()) {
            return error("bad-scxml", e.span, "a datum with an id is wanted here",
                         "write <data id=\"NAME\" expr=\"0\"/>");
        }
        if (e.find("src") != nullptr || expr == nullptr) {
            return outside(e.span, "a datum without `expr`",
                           "give it a whole number or a truth value: expr=\"0\"");
        }
        Translated t = translate(chart_, expr->value, expr->span);
        if (!t.problem.empty()) {
            return outside(expr->span, "this value (" + t.problem + ")",
                           "write a whole number, true or false");
        }
        for (const Datum& d : chart_.data) {
            if (d.id == id->value) {
                return error("name-twice", id->span, "there is already a datum " + d.id,
                             "choose another id");
            }
        }
        Datum d;
        d.id = id->value;
        d.name = names_.count(d.id) != 0 ? unused(d.id + "_data") : unused(d.id);
        d.is_bool = t.is_bool;
        d.initial = std::move(t.expr);
        d.span = e.span;
        chart_.data.push_back(std::move(d));
    }

    // -- what stands in a state
    void fill(const xml::Element& e, int number) {
        State& s = chart_.states[static_cast<std::size_t>(number)];
        const bool root = number == 0;
        if (!root) {
            if (s.kind == Kind::kHistory) {
                attributes(e, {"id", "type"});
            } else if (s.kind == Kind::kState) {
                attributes(e, {"id", "initial"});
            } else {
                attributes(e, {"id"});
            }
        }
        if (const xml::Attribute* type = e.find("type"); s.kind == Kind::kHistory && type) {
            s.deep = type->value == "deep";
            if (!s.deep && type->value != "shallow") {
                error("bad-scxml", type->span, "a history is shallow or deep",
                      "write type=\"shallow\" or type=\"deep\"");
            }
        }
        if (const xml::Attribute* initial = e.find("initial"); initial != nullptr) {
            s.initial = targets(*initial);
            begins_.push_back({number, initial->span});
        }
        for (const xml::Element& child : e.children) {
            if (foreign(child)) {
                continue;
            }
            const std::string& name = child.name;
            if (name == "state" || name == "parallel" || name == "final" || name == "history" ||
                name == "datamodel") {
                continue;
            }
            if (name == "transition" && s.kind == Kind::kHistory) {
                beginning(child, number, true);
            } else if (name == "transition" && s.kind != Kind::kFinal && !root) {
                transition(child, number);
            } else if (name == "initial" && s.kind == Kind::kState && !root) {
                const xml::Element* only = nullptr;
                for (const xml::Element& inner : child.children) {
                    if (own(inner) && inner.name == "transition" && only == nullptr) {
                        only = &inner;
                    } else {
                        error("bad-scxml", inner.span, "an <initial> has one <transition>",
                              "remove this");
                    }
                }
                if (only != nullptr) {
                    beginning(*only, number, false);
                } else {
                    error("bad-scxml", child.span, "an <initial> has one <transition>",
                          "write <transition target=\"STATE\"/> in it");
                }
            } else if ((name == "onentry" || name == "onexit") && !root &&
                       s.kind != Kind::kHistory) {
                attributes(child, {});
                Steps steps = content(child, 0);
                Steps& to = name == "onentry" ? s.on_entry : s.on_exit;
                to.insert(to.end(), std::make_move_iterator(steps.begin()),
                          std::make_move_iterator(steps.end()));
            } else {
                outside(child.span, "<" + name + "> in <" + e.name + ">",
                        name == "invoke"
                            ? "make the other chart a net of its own, and let both raise events"
                        : name == "script" ? "use <assign>"
                                           : "remove it, or say the same without it");
            }
        }
    }

    std::vector<int> targets(const xml::Attribute& a) {
        std::vector<int> out;
        for (const std::string& id : words(a.value)) {
            int found = -1;
            for (std::size_t i = 1; i < chart_.states.size(); ++i) {
                found = chart_.states[i].id == id ? static_cast<int>(i) : found;
            }
            if (found < 0) {
                error("unknown-name", a.span, "there is no state " + id,
                      "correct the name, or give a state this id");
            } else {
                out.push_back(found);
            }
        }
        return out;
    }

    // The transition of <initial> or <history>.
    void beginning(const xml::Element& e, int number, bool history) {
        attributes(e, {"target"});
        State& s = chart_.states[static_cast<std::size_t>(number)];
        if (!s.initial.empty()) {
            error("bad-scxml", e.span, "where this begins is said twice", "keep one of them");
        }
        if (const xml::Attribute* target = e.find("target")) {
            s.initial = targets(*target);
            begins_.push_back({number, target->span});
        }
        if (s.initial.empty()) {
            error("bad-scxml", e.span,
                  history ? "a history needs a default" : "an initial transition needs a target",
                  "write target=\"STATE\"");
        }
        s.initial_steps = content(e, 0);
    }

    void transition(const xml::Element& e, int source) {
        attributes(e, {"event", "cond", "target", "type"});
        if (chart_.transitions.size() >= kMaxTransitions) {
            if (!too_many_) {
                error("too-large", e.span, "this chart has too many transitions", "divide it");
            }
            too_many_ = true;
            return;
        }
        Transition t;
        t.source = source;
        t.span = e.span;
        if (const xml::Attribute* a = e.find("event")) {
            t.events = words(a->value);
        }
        if (const xml::Attribute* a = e.find("cond")) {
            t.condition = condition(*a);
        }
        if (const xml::Attribute* a = e.find("target")) {
            t.targets = targets(*a);
            apart(t.targets, a->span);
        }
        if (const xml::Attribute* a = e.find("type")) {
            t.internal = a->value == "internal";
            if (!t.internal && a->value != "external") {
                error("bad-scxml", a->span, "a transition is internal or external",
                      "write type=\"internal\" or type=\"external\"");
            }
        }
        t.steps = content(e, 0);
        if (t.events.empty() && !t.condition && t.targets.empty()) {
            error("zero-time-loop", e.span,
                  "this transition is possible again and again, in no time at all",
                  "give it an event, a condition or a target");
        }
        State& s = chart_.states[static_cast<std::size_t>(source)];
        s.transitions.push_back(static_cast<int>(chart_.transitions.size()));
        chart_.transitions.push_back(std::move(t));
    }

    lang::Expr condition(const xml::Attribute& a) {
        Translated t = translate(chart_, a.value, a.span);
        if (!t.problem.empty()) {
            outside(a.span, "this condition (" + t.problem + ")",
                    "write it with whole numbers, truth values and In('STATE')");
        }
        return as_condition(std::move(t));
    }

    // -- executable content
    Steps content(const xml::Element& e, int depth) {
        Steps out;
        if (depth > 20) {
            error("bad-scxml", e.span, "<if> nests too deep", "nest less");
            return out;
        }
        for (const xml::Element& child : e.children) {
            if (!own(child)) {
                outside(child.span, "the action <" + child.name + "> of another program",
                        "remove it, or raise an event instead");
                continue;
            }
            step(child, depth, out);
        }
        return out;
    }

    void step(const xml::Element& e, int depth, Steps& out) {
        Step s{};
        s.span = e.span;
        if (e.name == "log") {
            return;
        }
        if (e.name == "raise") {
            attributes(e, {"event"});
            s.what = Step::What::kRaise;
            s.event = event(e);
        } else if (e.name == "assign") {
            attributes(e, {"location", "expr"});
            s.what = Step::What::kAssign;
            const xml::Attribute* location = e.find("location");
            const xml::Attribute* expr = e.find("expr");
            const Datum* datum = nullptr;
            for (const Datum& d : chart_.data) {
                datum = location != nullptr && d.id == location->value ? &d : datum;
            }
            if (datum == nullptr || expr == nullptr) {
                return error("unknown-name", location != nullptr ? location->span : e.span,
                             datum == nullptr ? "there is no such datum" : "`expr` is missing",
                             "write <assign location=\"NAME\" expr=\"VALUE\"/>, and <data "
                             "id=\"NAME\" expr=\"0\"/> in the data model");
            }
            Translated t = translate(chart_, expr->value, expr->span);
            if (!t.problem.empty() || t.is_bool != datum->is_bool) {
                return outside(expr->span,
                               "this value (" +
                                   (t.problem.empty()
                                        ? std::string(datum->is_bool ? "a truth value is wanted"
                                                                     : "a whole number is wanted")
                                        : t.problem) +
                                   ")",
                               "write it with whole numbers, truth values and In('STATE')");
            }
            s.name = datum->name;
            s.value = std::move(t.expr);
        } else if (e.name == "send") {
            if (!send(e, s)) {
                return;
            }
        } else if (e.name == "cancel") {
            attributes(e, {"sendid"});
            s.what = Step::What::kCancel;
            if (const xml::Attribute* id = e.find("sendid")) {
                s.name = id->value;
            }
        } else if (e.name == "if") {
            attributes(e, {"cond"});
            s.what = Step::What::kIf;
            branches(e, depth, s);
        } else {
            return outside(e.span, "<" + e.name + ">",
                           e.name == "script" ? "use <assign>" : "say the same without it");
        }
        out.push_back(std::move(s));
    }

    std::string event(const xml::Element& e) {
        const xml::Attribute* a = e.find("event");
        if (a == nullptr || words(a->value).size() != 1 ||
            a->value.find('*') != std::string::npos) {
            error("bad-scxml", a != nullptr ? a->span : e.span, "the name of one event is wanted",
                  "write event=\"NAME\"");
            return "";
        }
        made_.insert(words(a->value)[0]);
        return words(a->value)[0];
    }

    bool send(const xml::Element& e, Step& s) {
        attributes(e, {"event", "target", "type", "id", "delay", "delayexpr"});
        for (const xml::Element& child : e.children) {
            outside(child.span, "<" + child.name + "> in <send>", "send an event without data");
        }
        s.what = Step::What::kSend;
        s.event = event(e);
        if (const xml::Attribute* a = e.find("type");
            a != nullptr && a->value != "scxml" &&
            a->value != "http://www.w3.org/TR/scxml/#SCXMLEventProcessor") {
            outside(a->span, "sending by " + a->value, "leave the type out");
        }
        if (const xml::Attribute* a = e.find("target"); a != nullptr && !a->value.empty()) {
            if (a->value == "#_internal") {
                s.what = Step::What::kRaise;
            } else {
                outside(a->span, "sending to " + a->value,
                        "leave the target out, and let another net hear the event");
            }
        }
        if (const xml::Attribute* a = e.find("id")) {
            s.name = a->value;
        }
        const xml::Attribute* delay = e.find("delay");
        std::string text = delay != nullptr ? delay->value : "0s";
        if (const xml::Attribute* a = e.find("delayexpr")) {
            delay = a;
            text = a->value;
            if (text.size() > 2 && (text.front() == '\'' || text.front() == '"') &&
                text.back() == text.front()) {
                text = text.substr(1, text.size() - 2);
            } else {
                outside(a->span, "a computed delay", "write delay=\"2s\"");
                return false;
            }
        }
        if (!time(text, e.span, s.value)) {
            error("bad-scxml", delay != nullptr ? delay->span : e.span, "this is no delay",
                  "write delay=\"2s\", \"1.5s\" or \"200ms\"");
            return false;
        }
        if (s.what == Step::What::kRaise && s.value.number != Rational{0}) {
            error("bad-scxml", e.span, "an event to #_internal cannot wait",
                  "leave the target out");
        }
        return true;
    }

    // 2s, .5s, 200ms
    static bool time(std::string_view text, lang::Span where, lang::Expr& out) {
        const std::size_t split = std::min(text.find_first_not_of("0123456789."), text.size());
        const std::string_view unit = text.substr(split);
        const auto number = lang::parse_decimal(text.substr(0, split));
        if (!number || (unit != "s" && unit != "ms")) {
            return false;
        }
        out = make_number(*number, where, std::string(unit));
        return true;
    }

    void branches(const xml::Element& e, int depth, Step& s) {
        const auto open = [&](const xml::Element& from, bool last) {
            s.branches.emplace_back();
            if (last) {
                return;
            }
            if (const xml::Attribute* cond = from.find("cond")) {
                s.branches.back().condition = condition(*cond);
            } else {
                error("bad-scxml", from.span, "`cond` is missing", "write cond=\"CONDITION\"");
            }
        };
        open(e, false);
        bool closed = false;
        for (const xml::Element& child : e.children) {
            if (own(child) && (child.name == "elseif" || child.name == "else")) {
                if (closed) {
                    error("bad-scxml", child.span, "this stands behind <else>", "move it before");
                }
                closed = child.name == "else";
                open(child, closed);
            } else if (!own(child)) {
                outside(child.span, "the action <" + child.name + "> of another program",
                        "remove it, or raise an event instead");
            } else if (depth > 20) {
                error("bad-scxml", child.span, "<if> nests too deep", "nest less");
            } else {
                step(child, depth + 1, s.branches.back().steps);
            }
        }
    }

    // -- what must be true of the whole
    int common(int a, int b) const {
        while (a != b) {
            (a > b ? a : b) = chart_.at(a > b ? a : b).parent;
        }
        return a;
    }

    // Several states can only be active together in different regions of a parallel.
    void apart(const std::vector<int>& list, lang::Span where) {
        for (std::size_t i = 0; i < list.size(); ++i) {
            for (std::size_t k = 0; k < i; ++k) {
                const int meet = common(list[i], list[k]);
                if (meet == list[i] || meet == list[k] || chart_.at(meet).kind != Kind::kParallel) {
                    error("targets-exclude-each-other", where,
                          chart_.at(list[k]).name + " and " + chart_.at(list[i]).name +
                              " are never active together",
                          "name one state, or states of different regions of a <parallel>");
                    return;
                }
            }
        }
    }

    void check() {
        State& root = chart_.states[0];
        if (root.children.empty()) {
            error("bad-scxml", root.span, "this chart has no state", "add a <state>");
        }
        for (const auto& [number, where] : begins_) {
            const State& s = chart_.at(number);
            const int within = s.kind == Kind::kHistory ? s.parent : number;
            for (const int t : s.initial) {
                if (!chart_.descends(t, within)) {
                    error("bad-scxml", where,
                          chart_.at(t).name + " is no state inside " + chart_.at(within).name,
                          "name a state inside of it");
                } else if (s.kind == Kind::kHistory && !s.deep && chart_.at(t).parent != within) {
                    error("bad-scxml", where,
                          "a shallow history goes to a child of " + chart_.at(within).name,
                          "name a child, or write type=\"deep\"");
                }
            }
            apart(s.initial, where);
        }
        for (State& s : chart_.states) {
            if (s.kind == Kind::kState && s.initial.empty() && !s.children.empty()) {
                s.initial = {s.children.front()};
            }
            if (s.kind == Kind::kParallel && s.children.empty()) {
                error("bad-scxml", s.span, "a <parallel> without states in it is none",
                      "write <state>, or put states into it");
            }
            if (s.kind == Kind::kHistory && s.initial.empty()) {
                error("bad-scxml", s.span, "a history needs a default",
                      "write <transition target=\"STATE\"/> in it");
            }
            // A default that leads to the history itself would never arrive.
            for (const int t : s.initial) {
                if (chart_.at(t).kind == Kind::kHistory && s.kind == Kind::kHistory) {
                    error("bad-scxml", s.span, "the default of a history is a history",
                          "name a state");
                }
            }
        }
        for (const Transition& t : chart_.transitions) {
            for (const std::string& e : t.events) {
                if (e.rfind("error.", 0) == 0 || e == "error") {
                    tell(Severity::kWarning, "never-raised", t.span,
                         "nothing raises " + e +
                             ": what could fail is outside of the SCXML that "
                             "is read here",
                         "remove this transition");
                }
            }
        }
        // Numbers for all names.
        for (const std::string& e : made_) {
            chart_.number_of(e);
        }
        for (const Transition& t : chart_.transitions) {
            for (const std::string& e : t.events) {
                std::string name = e;
                while (!name.empty() && (name.back() == '*' || name.back() == '.')) {
                    name.pop_back();
                }
                if (!name.empty() && name.rfind("done.", 0) != 0 && name != "done" &&
                    name.rfind("error.", 0) != 0 && name != "error" && made_.count(name) == 0) {
                    chart_.number_of(name);
                    if (heard_.insert(name).second) {
                        chart_.heard.push_back(
                            {name, names_.count(name) != 0 ? unused(name + "_event") : unused(name),
                             t.span});
                    }
                }
            }
        }
        for (std::size_t i = 1; i < chart_.states.size(); ++i) {
            const State& s = chart_.states[i];
            if (s.kind != Kind::kHistory && s.kind != Kind::kFinal && !s.children.empty()) {
                chart_.number_of("done.state." + s.name);
            }
        }
    }

    const xml::Element& root_;
    lang::Parsed& out_;
    Chart chart_;
    std::vector<std::pair<const xml::Element*, int>> elements_;  // of the states
    std::vector<std::pair<int, lang::Span>> begins_;
    std::set<std::string> names_, made_, heard_;
    bool too_many_ = false;
};

}  // namespace

Chart read(const xml::Element& root, lang::Parsed& out) { return Reader(root, out).run(); }

}  // namespace puppetri::notation::chart
