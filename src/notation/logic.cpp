// SPDX-License-Identifier: MIT
// Digital circuits whose gates have delays. A signal is a yes or no that any net can read. An
// instant has three parts, which priorities keep apart: all outputs whose delay has run out change;
// gates without delay follow, in the order in which they feed each other; then each gate with a
// delay compares its output with its inputs and starts, or gives up, a change. So no gate ever sees
// half of an instant, and the order in which gates are looked at changes nothing.
//   A gate with inertial delay is one token that goes round low, rising, high, falling; what does
// not last as long as the delay never arrives. With transport delay each change travels.
//   logic half_adder {
//     input a toggles on button
//     input b starts yes
//     sum = xor(a, b) delay 10 ms
//     carry = a and b delay 8 ms
//   }
#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "ending.h"
#include "kinds.h"
#include "line.h"
#include "make.h"

namespace puppetri::notation {
namespace {

using lang::Expr;
using lang::ExprKind;
using lang::Op;

// Changes of outputs come before all that scenes write, gates without delay next; comparing comes
// last. Gates of one part have priorities of their own, sixty-four different ones, since their
// order changes nothing: provers need not try all orders.
constexpr std::int64_t kChanges = 2'000'000;
constexpr std::int64_t kFollows = 1'000'000;  // minus the depth
constexpr std::int64_t kCompares = -1'000'000;
constexpr std::int64_t kOrders = 64;

constexpr std::string_view kGateForm =
    "NAME = FORMULA delay TIME, or rise TIME fall TIME; then transport, starts yes, raises EVENT, "
    "drops EVENT";
constexpr std::string_view kInputForm =
    "input NAME starts yes toggles on EVENT, or toggles at [1, 2] s, or rises on EVENT falls on "
    "EVENT";
constexpr std::string_view kEndForm = "ends when SIGNAL";
constexpr std::string_view kClockForm = "clock NAME period TIME high TIME starts yes";

class Logic {
 public:
    Logic(const lang::Block& block, const lang::File& file, Lowered& out)
        : block_(block), teller_(block, file, out), body_(out.net.body) {}

    void lower() {
        if (!has_plain_lines(block_, teller_)) {
            return;
        }
        for (const lang::Property& p : block_.properties) {
            Line line(p, teller_);
            const std::string& word = line.name().steps[0].text;
            if (is_gate(p)) {
                gate(line);
            } else if (is_ending(p)) {
                ending(line);
            } else if (word == "input") {
                input(line);
            } else if (word == "clock") {
                clock(line);
            } else {
                teller_.error("syntax", line.span(), "this is no gate, input, clock or end",
                              "write " + std::string(kGateForm));
            }
        }
        for (Gate& g : gates_) {
            g.formula = plain(g.formula);
        }
        order_gates();
        ending_.when = plain(ending_.when);
        for (std::size_t i = 0; i < gates_.size(); ++i) {
            make(gates_[i], static_cast<std::int64_t>(i) % kOrders);
        }
        check_ending();
        // When gates without delay have followed, before anything else sees the instant.
        std::int64_t deepest = 0;
        for (const Gate& g : gates_) {
            deepest = std::max(deepest, g.depth);
        }
        make_ways("logic", ending_, kFollows - deepest - 1, teller_, body_);
    }

 private:
    struct Gate {
        lang::Name name;
        lang::Caption caption;
        Expr formula;
        Expr rise, fall;  // kNone: no delay
        bool transport = false;
        bool starts = false;
        lang::Path raises_up, raises_down;
        lang::Span span;
        std::int64_t depth = 0;  // of gates without delay
        bool instant() const { return !rise; }
    };

    static bool is_gate(const lang::Property& p) {
        return !p.values.empty() && p.values[0].kind == ExprKind::kSymbol &&
               p.values[0].text == "=";
    }

    void ending(Line& line) {
        if (!begin_ending(line, "when", kEndForm, teller_, ending_)) {
            return;
        }
        if (const Expr* e = line.value("a formula of signals")) {
            ending_.when = *e;
        }
        line.finish(kEndForm);
    }

    // One of its signals may end it; other names are parameters, or wrong.
    void check_ending() {
        std::vector<std::string> names;
        collect(ending_.when, names);
        for (const std::string& name : names) {
            const bool parameter =
                std::any_of(block_.parameters.begin(), block_.parameters.end(),
                            [&](const lang::Parameter& p) { return p.name.text == name; });
            if (!parameter && signals_.count(name) == 0) {
                teller_.error("unknown-name", ending_.when.span, "there is no signal " + name,
                              "write " + std::string(kEndForm) + " with one of this circuit");
            }
        }
    }

    static bool is_zero(const Expr& e) {
        return e.kind == ExprKind::kNumber && e.number == Rational{0};
    }

    bool signal(const lang::Name& name, lang::Span span) {
        if (!signals_.insert(name.text).second) {
            teller_.error("name-twice", span, "there is already a signal " + name.text,
                          "choose another name");
            return false;
        }
        return true;
    }

    void datum(const lang::Name& name, lang::Caption caption, bool starts, lang::Span span) {
        lang::Data d;
        d.name = name;
        d.caption = std::move(caption);
        d.is_public = true;
        d.type = make_reference("bool", span);
        d.initial = make_bool(starts, span);
        d.span = span;
        body_.data.push_back(std::move(d));
    }

    bool yes_or_no(Line& line) {
        const Expr* e = line.value("yes or no");
        if (e != nullptr && e->kind != ExprKind::kBool) {
            teller_.error("syntax", e->span, "a signal starts with yes or no", "write starts yes");
        }
        return e != nullptr && e->kind == ExprKind::kBool && e->number == Rational{1};
    }

    void gate(Line& line) {
        Gate made{.name = line.name().steps[0],
                  .caption = {},
                  .formula = {},
                  .rise = {},
                  .fall = {},
                  .raises_up = {},
                  .raises_down = {},
                  .span = line.span()};
        line.symbol("=");
        const Expr* formula = line.value("a formula of signals");
        if (formula == nullptr) {
            return;
        }
        made.formula = *formula;
        made.caption = line.caption();
        while (!line.done()) {
            if (line.word("delay")) {
                if (const Expr* e = line.value("a time")) {
                    made.rise = made.fall = *e;
                }
            } else if (line.clause("rise", "a time", made.rise) ||
                       line.clause("fall", "a time", made.fall)) {
                continue;
            } else if (line.word("transport")) {
                made.transport = true;
            } else if (line.word("starts")) {
                made.starts = yes_or_no(line);
            } else if (line.word("raises")) {
                if (const lang::Path* event = line.path("the name of an event")) {
                    made.raises_up = *event;
                }
            } else if (line.word("drops")) {
                if (const lang::Path* event = line.path("the name of an event")) {
                    made.raises_down = *event;
                }
            } else {
                line.finish(kGateForm);
            }
        }
        if (static_cast<bool>(made.rise) != static_cast<bool>(made.fall)) {
            teller_.error("one-delay", made.span, "a gate has both delays or neither",
                          "write rise TIME fall TIME, or delay TIME for both");
            return;
        }
        if (made.rise && is_zero(made.rise) && is_zero(made.fall)) {
            made.rise = made.fall = {};
        } else if (made.rise && (is_zero(made.rise) || is_zero(made.fall))) {
            teller_.error("one-delay", made.span, "one of the delays is 0 and the other is not",
                          "make both 0, or neither");
            return;
        }
        if (made.transport && made.rise && lang::to_text(made.rise) != lang::to_text(made.fall)) {
            teller_.error("one-delay", made.span,
                          "changes that travel cannot overtake each other: both take one time",
                          "write delay TIME transport");
            return;
        }
        if (signal(made.name, made.span)) {
            gates_.push_back(std::move(made));
        }
    }

    // `NAME_toggles: -> on EVENT set NAME := not NAME`
    void setter(const lang::Name& name, const std::string& verb, std::vector<lang::Path> events,
                Expr value, lang::Span span) {
        lang::Transition t = make_transition(make_name(name.text + "_" + verb, span), {}, {});
        t.span = span;
        t.is_public = true;
        t.events = std::move(events);
        t.assignments.push_back(make_assignment(make_path(name.text, span), std::move(value)));
        body_.transitions.push_back(std::move(t));
    }

    std::vector<lang::Path> events(Line& line) {
        std::vector<lang::Path> out;
        do {
            if (const lang::Path* event = line.path("the name of an event")) {
                out.push_back(*event);
            }
        } while (line.word("or"));
        return out;
    }

    void input(Line& line) {
        const lang::Path* path = line.path("the name of an input");
        if (path == nullptr) {
            return;
        }
        const lang::Name name = path->steps[0];
        const lang::Span span = line.span();
        lang::Caption caption = line.caption();
        bool starts = false;
        while (!line.done()) {
            if (line.word("starts")) {
                starts = yes_or_no(line);
            } else if (line.word("toggles")) {
                Expr other = make_unary(Op::kNot, make_reference(name.text, span));
                if (line.word("at")) {
                    const Expr* times = line.value("times");
                    if (times == nullptr) {
                        return;
                    }
                    schedule(name, *times, span);
                    setter(name, "toggles", {make_path(name.text + "_times", span)},
                           std::move(other), span);
                } else if (line.word("on")) {
                    setter(name, "toggles", events(line), std::move(other), span);
                } else {
                    line.finish(kInputForm);
                    return;
                }
            } else if (line.word("rises") && line.word("on")) {
                setter(name, "rises", events(line), make_bool(true, span), span);
            } else if (line.word("falls") && line.word("on")) {
                setter(name, "falls", events(line), make_bool(false, span), span);
            } else {
                line.finish(kInputForm);
            }
        }
        if (signal(name, span)) {
            datum(name, std::move(caption), starts, span);
        }
    }

    void schedule(const lang::Name& name, const Expr& times, lang::Span span) {
        lang::Event event;
        event.name = make_name(name.text + "_times", span);
        event.span = span;
        if (times.kind == ExprKind::kList || times.kind == ExprKind::kTuple) {
            for (const lang::Argument& a : times.args) {
                Expr t = a.value;
                if (t.kind == ExprKind::kNumber && t.unit.empty()) {
                    t.unit = times.unit;
                    t.unit_span = times.unit_span;
                }
                event.at.push_back(std::move(t));
            }
        } else {
            event.at.push_back(times);
        }
        body_.events.push_back(std::move(event));
    }

    void clock(Line& line) {
        const lang::Path* path = line.path("the name of a clock");
        if (path == nullptr) {
            return;
        }
        const lang::Name name = path->steps[0];
        const lang::Span span = line.span();
        lang::Caption caption = line.caption();
        Expr period, high;
        bool starts = false;
        while (!line.done()) {
            if (line.clause("period", "a time", period) || line.clause("high", "a time", high)) {
                continue;
            }
            if (line.word("starts")) {
                starts = yes_or_no(line);
            } else {
                line.finish(kClockForm);
            }
        }
        if (!period) {
            teller_.error("no-period", span, "nothing says how long a period of the clock is",
                          "write " + std::string(kClockForm));
            return;
        }
        if (!signal(name, span)) {
            return;
        }
        if (!high) {
            high = make_binary(Op::kDivide, period, make_number(Rational{2}, span));
        }
        datum(name, std::move(caption), starts, span);
        place(name, "high", &high, starts, span);
        const Expr low = make_binary(Op::kSubtract, period, high);
        place(name, "low", &low, !starts, span);
        change(name, "rises", "low", "high", true, kChanges, span);
        change(name, "falls", "high", "low", false, kChanges, span);
    }

    static std::string part(const lang::Name& name, std::string_view what) {
        return name.text + "_" + std::string(what);
    }

    void place(const lang::Name& name, std::string_view what, const Expr* takes, bool token,
               lang::Span span) {
        lang::Place p = make_place(make_name(part(name, what), span));
        p.is_public = true;
        if (takes != nullptr) {
            p.takes = make_duration(*takes);
        }
        if (token) {
            give_token(p);
        }
        body_.places.push_back(std::move(p));
    }

    lang::Transition& move(const lang::Name& name, std::string_view verb, std::string_view from,
                           std::string_view to, std::int64_t priority, lang::Span span) {
        lang::Transition t = make_transition(make_name(part(name, verb), span), {}, {});
        if (!from.empty()) {
            t.inputs.push_back(make_arc(lang::ArcKind::kTake, make_path(part(name, from), span)));
        }
        if (!to.empty()) {
            t.outputs.push_back(make_arc(lang::ArcKind::kGive, make_path(part(name, to), span)));
        }
        t.span = span;
        t.is_public = true;
        t.priority = make_number(Rational{priority}, span);
        body_.transitions.push_back(std::move(t));
        return body_.transitions.back();
    }

    // The signal changes as a token goes on.
    lang::Transition& change(const lang::Name& name, std::string_view verb, std::string_view from,
                             std::string_view to, bool value, std::int64_t priority,
                             lang::Span span) {
        lang::Transition& t = move(name, verb, from, to, priority, span);
        t.assignments.push_back(
            make_assignment(make_path(name.text, span), make_bool(value, span)));
        return t;
    }

    static Expr negation(const Expr& e) { return make_unary(Op::kNot, e); }

    void make(const Gate& g, std::int64_t turn) {
        datum(g.name, g.caption, g.starts, g.span);
        const auto raise = [](lang::Transition& t, const lang::Path& event) {
            if (!event.empty()) {
                t.raises.push_back(event);
            }
        };
        if (g.instant()) {
            const std::int64_t priority = kFollows - g.depth;
            place(g.name, "low", nullptr, !g.starts, g.span);
            place(g.name, "high", nullptr, g.starts, g.span);
            lang::Transition& up = change(g.name, "rises", "low", "high", true, priority, g.span);
            up.guard = g.formula;
            raise(up, g.raises_up);
            lang::Transition& down =
                change(g.name, "falls", "high", "low", false, priority, g.span);
            down.guard = negation(g.formula);
            raise(down, g.raises_down);
            return;
        }
        const std::int64_t changes = kChanges + turn, compares = kCompares - turn;
        if (g.transport) {
            // What has been sent last, and what is on its way.
            place(g.name, "sent_low", nullptr, !g.starts, g.span);
            place(g.name, "sent_high", nullptr, g.starts, g.span);
            place(g.name, "rising", &g.rise, false, g.span);
            place(g.name, "falling", &g.fall, false, g.span);
            for (const bool up : {true, false}) {
                lang::Transition& t =
                    move(g.name, up ? "sends_up" : "sends_down", up ? "sent_low" : "sent_high",
                         up ? "sent_high" : "sent_low", compares, g.span);
                t.guard = up ? g.formula : negation(g.formula);
                t.outputs.push_back(
                    make_arc(lang::ArcKind::kGive,
                             make_path(part(g.name, up ? "rising" : "falling"), g.span)));
                // Changes of one instant arrive in turn.
                lang::Transition& arrives =
                    change(g.name, up ? "rises" : "falls", up ? "rising" : "falling", "", up,
                           changes, g.span);
                Expr now = make_reference(g.name.text, g.span);
                arrives.guard = up ? negation(now) : now;
                raise(arrives, up ? g.raises_up : g.raises_down);
            }
            return;
        }
        place(g.name, "low", nullptr, !g.starts, g.span);
        place(g.name, "rising", &g.rise, false, g.span);
        place(g.name, "high", nullptr, g.starts, g.span);
        place(g.name, "falling", &g.fall, false, g.span);
        raise(change(g.name, "rises", "rising", "high", true, changes, g.span), g.raises_up);
        raise(change(g.name, "falls", "falling", "low", false, changes, g.span), g.raises_down);
        move(g.name, "starts_up", "low", "rising", compares, g.span).guard = g.formula;
        move(g.name, "starts_down", "high", "falling", compares, g.span).guard =
            negation(g.formula);
        lang::Transition& stays_low = move(g.name, "stays_low", "rising", "low", compares, g.span);
        stays_low.guard = negation(g.formula);
        stays_low.inputs[0].kind = lang::ArcKind::kTakeNow;
        lang::Transition& stays_high =
            move(g.name, "stays_high", "falling", "high", compares, g.span);
        stays_high.guard = g.formula;
        stays_high.inputs[0].kind = lang::ArcKind::kTakeNow;
    }

    // A formula with the calls of gates written out.
    Expr plain(const Expr& e) {
        Expr out = e;
        for (lang::Argument& a : out.args) {
            a.value = plain(a.value);
        }
        if (e.kind != ExprKind::kCall || e.path.steps.size() != 1) {
            return out;
        }
        const std::string& name = e.path.steps[0].text;
        const bool inverted = name == "nand" || name == "nor" || name == "xnor";
        if (!inverted && name != "xor" && name != "buf") {
            return out;
        }
        const std::size_t least = name == "buf" ? 1 : 2;
        if (out.args.size() < least || (name == "buf" && out.args.size() > 1)) {
            teller_.error("wrong-count", e.span,
                          name + " has " + (name == "buf" ? "one input" : "two inputs or more"),
                          "write " + name + (name == "buf" ? "(a)" : "(a, b)"));
            return make_bool(false, e.span);
        }
        Expr value = std::move(out.args[0].value);
        const Op op = name == "nand" ? Op::kAnd : name == "nor" ? Op::kOr : Op::kNotEqual;
        for (std::size_t i = 1; i < out.args.size(); ++i) {
            value = make_binary(op, std::move(value), std::move(out.args[i].value));
        }
        value.span = e.span;
        return inverted ? negation(value) : value;
    }

    static void collect(const Expr& e, std::vector<std::string>& out) {
        if (e.kind == ExprKind::kPath && e.path.steps.size() == 1) {
            out.push_back(e.path.steps[0].text);
        }
        for (const lang::Argument& a : e.args) {
            collect(a.value, out);
        }
    }

    // Gates without delay get a depth above all that they read; a ring of them has no value.
    void order_gates() {
        std::map<std::string, std::size_t> number;
        for (std::size_t i = 0; i < gates_.size(); ++i) {
            number[gates_[i].name.text] = i;
        }
        std::vector<std::vector<std::size_t>> reads(gates_.size());
        for (std::size_t i = 0; i < gates_.size(); ++i) {
            std::vector<std::string> names;
            collect(gates_[i].formula, names);
            for (const std::string& name : names) {
                const auto g = number.find(name);
                if (gates_[i].instant() && g != number.end() && gates_[g->second].instant()) {
                    reads[i].push_back(g->second);
                }
            }
        }
        enum : std::uint8_t { kNew, kOpen, kDone };
        std::vector<std::uint8_t> state(gates_.size(), kNew);
        struct Visit {
            std::size_t gate, next;
        };
        for (std::size_t root = 0; root < gates_.size(); ++root) {
            std::vector<Visit> path;
            if (state[root] == kNew) {
                path.push_back({root, 0});
                state[root] = kOpen;
            }
            while (!path.empty()) {
                Visit& v = path.back();
                if (v.next == reads[v.gate].size()) {
                    state[v.gate] = kDone;
                    const std::int64_t depth = gates_[v.gate].depth;
                    path.pop_back();
                    if (!path.empty()) {
                        Gate& above = gates_[path.back().gate];
                        above.depth = std::max(above.depth, depth + 1);
                    }
                    continue;
                }
                const std::size_t to = reads[v.gate][v.next++];
                if (state[to] == kDone) {
                    gates_[v.gate].depth = std::max(gates_[v.gate].depth, gates_[to].depth + 1);
                } else if (state[to] == kOpen) {
                    tell_ring(path, to);
                } else {
                    state[to] = kOpen;
                    path.push_back({to, 0});
                }
            }
        }
    }

    template <class Path>
    void tell_ring(const Path& path, std::size_t first) {
        std::string ring;
        bool inside = false;
        for (const auto& v : path) {
            inside = inside || v.gate == first;
            ring += inside ? gates_[v.gate].name.text + ", " : "";
        }
        teller_.error(
            "zero-delay-loop", gates_[first].span,
            "gates without delay feed each other in a ring: " + ring + gates_[first].name.text,
            "give one of them a delay: delay 1 ms");
    }

    const lang::Block& block_;
    Teller teller_;
    lang::Body& body_;
    std::vector<Gate> gates_;
    Ending ending_;
    std::set<std::string> signals_;
};

}  // namespace

void lower_logic(const lang::Block& block, const lang::File& file, Lowered& out) {
    Logic(block, file, out).lower();
}

}  // namespace puppetri::notation
