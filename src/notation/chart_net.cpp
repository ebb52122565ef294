// SPDX-License-Identifier: MIT
// From a chart to a net: the algorithm of the W3C Recommendation (appendix D, "Algorithm for SCXML
// Interpretation"), unrolled over the states and transitions of the one chart. A token walks
// through places `at N`: select a transition for each active atomic state, let inner ones go before
// outer ones, leave states from the inside, do what the transitions say, enter states from the
// outside, take the next internal event, and rest until one comes from outside. It walks in no
// time, and without choices. An active state has a token in the place of its name, and a datum `in
// NAME` for conditions; `take N` says by which atomic state transition N was selected.
#include <algorithm>
#include <map>
#include <set>

#include "chart_plan.h"

namespace puppetri::notation::chart {
namespace {

using lang::Arc;
using lang::ArcKind;
using lang::Expr;
using lang::Op;
using lang::Span;

class Maker {
    using Ids = std::vector<int>;

 public:
    Maker(const Chart& chart, lang::Net& net, Span top)
        : chart_(chart), body_(net.body), top_(top), where_(top), plan_(chart) {}

    // Gives the transitions that cannot be told exactly; the whole chart where it is too large.
    std::vector<Span> make() {
        if (plan_.too_large) {
            return {top_};
        }
        declare();
        begin();
        select();
        leave();
        act();
        enter();
        rest();
        return plan_.vague;
    }

    // Of states within one another that nothing enters the outermost alone.
    Ids never_entered() const {
        const std::vector<bool> entered = plan_.entered();
        Ids out;
        for (int s = 1; s < static_cast<int>(chart_.states.size()); ++s) {
            const int parent = at(s).parent;
            if (!entered[z(s)] && at(s).kind != Kind::kHistory &&
                (parent == 0 || entered[z(parent)])) {
                out.push_back(s);
            }
        }
        return out;
    }

 private:
    const State& at(int s) const { return chart_.at(s); }
    static std::size_t z(int i) { return static_cast<std::size_t>(i); }

    Expr datum(const std::string& name) { return make_reference(name, where_); }
    Expr number(std::int64_t n) { return make_number(Rational{n}, where_); }
    Expr inside(int s) { return datum(inside_name(at(s))); }

    // -- the net
    std::string label() {
        const std::string name = "at " + std::to_string(++labels_);
        lang::Place p = make_place(make_name(name, where_));
        body_.places.push_back(std::move(p));
        return name;
    }

    lang::Transition& step(const std::string& from, const std::string& to, const Truth& when) {
        lang::Transition t = make_transition(make_name("step " + std::to_string(++steps_), where_),
                                             {make_path(from, where_)}, {});
        if (!to.empty()) {
            give(t, to);
        }
        t.span = where_;
        if (when.known == Truth::kOpen) {
            t.guard = when.expr;
        } else if (when.known == Truth::kNo) {
            t.guard = make_bool(false, where_);
        }
        body_.transitions.push_back(std::move(t));
        return body_.transitions.back();
    }

    void give(lang::Transition& t, const std::string& place) {
        t.outputs.push_back(make_arc(ArcKind::kGive, make_path(place, where_)));
    }
    void set(lang::Transition& t, const std::string& name, Expr value) {
        t.assignments.push_back(make_assignment(make_path(name, where_), std::move(value)));
    }

    void add_datum(const std::string& name, Expr type, Expr initial, Span where,
                   bool is_public = false) {
        lang::Data d;
        d.name = make_name(name, where);
        d.type = std::move(type);
        d.initial = std::move(initial);
        d.is_public = is_public;
        d.span = where;
        body_.data.push_back(std::move(d));
    }
    Expr range(std::int64_t high) {
        Expr e = make_unary(Op::kNone, number(0));
        e.kind = lang::ExprKind::kRange;
        e.args.push_back({{}, number(high)});
        return e;
    }
    void add_flag(const std::string& name) {
        add_datum(name, datum("bool"), make_bool(false, where_), where_);
    }

    lang::Binding bind(const char* attribute, Expr value) {
        return {make_path(attribute, where_), std::move(value), where_};
    }

    std::string take_name(int t) const { return "take " + std::to_string(t); }
    std::int64_t refused() const { return static_cast<std::int64_t>(plan_.atoms.size()) + 1; }
    Truth selected(int t) {
        Expr e = make_binary(Op::kGreater, datum(take_name(t)), number(0));
        if (plan_.counted(t)) {
            e = make_binary(Op::kAnd, std::move(e),
                            make_binary(Op::kLess, datum(take_name(t)), number(refused())));
        }
        return open(std::move(e));
    }

    void declare() {
        where_ = top_;
        for (int s = 1; s < static_cast<int>(chart_.states.size()); ++s) {
            const State& state = at(s);
            where_ = state.span;
            if (state.kind == Kind::kHistory) {
                add_flag(plan_.known_name(s));
                for (const int x : plan_.stored(state)) {
                    add_flag(plan_.was_name(s, x));
                }
                continue;
            }
            lang::Place p = make_place(make_name(state.name, where_));
            p.is_public = true;
            body_.places.push_back(std::move(p));
            add_flag(inside_name(state));
        }
        for (const Datum& d : chart_.data) {
            where_ = d.span;
            add_datum(d.name, datum(d.is_bool ? "bool" : "int"), d.initial, d.span, true);
        }
        where_ = top_;
        const auto events = static_cast<std::int64_t>(chart_.events.size());
        add_datum(kEvent, range(events), number(0), top_);
        if (chart_.reads_event) {
            add_datum(kLastEvent, range(events), number(0), top_);
        }
        add_flag("something");
        add_flag("over");
        for (int t = 0; t < static_cast<int>(plan_.moves.size()); ++t) {
            where_ = t == 0 ? top_ : plan_.moves[z(t)].written->span;
            add_datum(take_name(t), range(refused()), number(0), where_);
        }
        where_ = top_;
        queue(kRaised, false, events);
        queue(kSent, true, events);
        for (const Heard& e : chart_.heard) {
            lang::Event event;
            event.name = make_name(e.name, e.span);
            event.caption = {e.event, e.span};
            event.is_public = true;
            event.span = e.span;
            body_.events.push_back(std::move(event));
        }
    }

    static constexpr const char* kRaised = "raised events";
    static constexpr const char* kSent = "sent events";
    static constexpr const char* kNumber = "its number";

    void queue(const char* name, bool waits, std::int64_t events) {
        lang::Place p = make_place(make_name(name, top_));
        p.of_type = make_path(std::string(name) + " as tokens", top_);
        const auto attribute = [&](const char* what, Expr type) {
            lang::Parameter a;
            a.name = make_name(what, top_);
            a.type = std::move(type);
            a.span = top_;
            p.attributes.push_back(std::move(a));
        };
        attribute("event", range(events));
        if (waits) {
            attribute("id", range(static_cast<std::int64_t>(ids().size())));
            attribute("wait", datum("time"));
            p.takes = make_duration(datum("wait"));
        }
        body_.places.push_back(std::move(p));
    }

    // Ids of sends, numbered from 1.
    const std::vector<std::string>& ids() {
        if (!ids_known_) {
            ids_known_ = true;
            const auto look = [&](auto& self, const Steps& steps) -> void {
                for (const Step& s : steps) {
                    if (s.what == Step::What::kSend && !s.name.empty() &&
                        std::find(ids_.begin(), ids_.end(), s.name) == ids_.end()) {
                        ids_.push_back(s.name);
                    }
                    for (const Step::Branch& b : s.branches) {
                        self(self, b.steps);
                    }
                }
            };
            for (const State& s : chart_.states) {
                look(look, s.on_entry);
                look(look, s.on_exit);
                look(look, s.initial_steps);
            }
            for (const Transition& t : chart_.transitions) {
                look(look, t.steps);
            }
        }
        return ids_;
    }
    std::int64_t id_number(const std::string& id) {
        const auto found = std::find(ids().begin(), ids().end(), id);
        return found == ids().end() ? 0 : found - ids().begin() + 1;
    }
    std::int64_t event_number(const std::string& event) const {
        const auto found = std::find(chart_.events.begin(), chart_.events.end(), event);
        return found == chart_.events.end() ? 0 : found - chart_.events.begin() + 1;
    }

    void raise(lang::Transition& t, std::int64_t event) {
        lang::Arc arc = make_arc(ArcKind::kGive, make_path(kRaised, where_));
        arc.pattern.push_back(bind("event", number(event)));
        t.outputs.push_back(std::move(arc));
    }

    // Executable content between two labels; gives where it ends.
    std::string content(const Steps& steps, std::string from) {
        for (const Step& s : steps) {
            where_ = s.span;
            const std::string to = label();
            if (s.what == Step::What::kIf) {
                Truth before;
                for (const Step::Branch& b : s.branches) {
                    where_ = s.span;
                    const Truth now = b.condition ? open(b.condition) : yes();
                    const std::string inner = label();
                    step(from, inner, both(opposite(before), now));
                    before = either(before, now);
                    const std::string end = content(b.steps, inner);
                    where_ = s.span;
                    step(end, to, yes());
                }
                if (before.known != Truth::kYes) {
                    step(from, to, opposite(before));
                }
                from = to;
                continue;
            }
            lang::Transition& t = step(from, to, yes());
            switch (s.what) {
                case Step::What::kAssign:
                    set(t, s.name, s.value);
                    break;
                case Step::What::kRaise:
                    raise(t, event_number(s.event));
                    break;
                case Step::What::kSend: {
                    lang::Arc arc = make_arc(ArcKind::kGive, make_path(kSent, where_));
                    arc.pattern.push_back(bind("event", number(event_number(s.event))));
                    arc.pattern.push_back(bind("id", number(id_number(s.name))));
                    arc.pattern.push_back(bind("wait", s.value));
                    t.outputs.push_back(std::move(arc));
                    break;
                }
                default:
                    if (const std::int64_t id = id_number(s.name); id != 0) {
                        lang::Arc arc = make_arc(ArcKind::kTakeAllNow, make_path(kSent, where_));
                        arc.pattern.push_back(bind("id", number(id)));
                        t.inputs.push_back(std::move(arc));
                    }
            }
            from = to;
        }
        return from;
    }

    // -- the walk
    void begin() {
        where_ = top_;
        lang::Place start = make_place(make_name(chart_.begin, top_));
        start.is_public = true;
        start.role = lang::Role::kStart;
        give_token(start);
        body_.places.push_back(std::move(start));
        lang::Place done = make_place(make_name(chart_.done, top_));
        done.is_public = true;
        done.role = lang::Role::kFinish;
        body_.places.push_back(std::move(done));
        select_ = label();
        stable_ = label();
        internal_ = label();
        leave_ = label();
        act_ = label();
        enter_ = label();
        idle_ = "at rest";
        lang::Place idle = make_place(make_name(idle_, top_));
        body_.places.push_back(std::move(idle));
        lang::Transition& t = step(chart_.begin, enter_, yes());
        set(t, take_name(0), number(1));
        // As new, should it be begun again.
        set(t, "over", make_bool(false, top_));
        set(t, kEvent, number(0));
        for (const Datum& d : chart_.data) {
            set(t, d.name, d.initial);
        }
        for (int h = 1; h < static_cast<int>(chart_.states.size()); ++h) {
            if (at(h).kind == Kind::kHistory) {
                set(t, plan_.known_name(h), make_bool(false, top_));
            }
        }
        // Before anything else, transitions without an event.
        const bool eventless = std::any_of(chart_.transitions.begin(), chart_.transitions.end(),
                                           [](const Transition& x) { return x.events.empty(); });
        set(step(stable_, eventless ? select_ : internal_, yes()), kEvent, number(0));
    }

    bool matches(const std::string& descriptor, const std::string& event) const {
        std::string d = descriptor;
        if (d == "*") {
            return true;
        }
        while (!d.empty() && (d.back() == '*' || d.back() == '.')) {
            d.pop_back();
        }
        return event == d || (event.size() > d.size() && event.compare(0, d.size(), d) == 0 &&
                              event[d.size()] == '.');
    }

    // The event that is looked at is one of the transition's.
    Truth named(const Transition& t) {
        if (t.events.empty()) {
            return open(make_binary(Op::kEqual, datum(kEvent), number(0)));
        }
        Truth out;
        bool all = true;
        for (std::size_t e = 0; e < chart_.events.size(); ++e) {
            const bool is = std::any_of(t.events.begin(), t.events.end(), [&](const auto& d) {
                return matches(d, chart_.events[e]);
            });
            all = all && is;
            if (is) {
                out = either(out, open(make_binary(Op::kEqual, datum(kEvent),
                                                   number(static_cast<std::int64_t>(e) + 1))));
            }
        }
        return all && !chart_.events.empty()
                   ? open(make_binary(Op::kGreater, datum(kEvent), number(0)))
                   : out;
    }

    // selectTransitions and removeConflictingTransitions
    void select() {
        std::string here = select_;
        for (std::size_t a = 0; a < plan_.atoms.size(); ++a) {
            if (plan_.candidates[a].empty()) {
                continue;
            }
            where_ = at(plan_.atoms[a]).span;
            const std::string next = label();
            Truth before;
            for (const int t : plan_.candidates[a]) {
                const Move& m = plan_.moves[z(t)];
                where_ = m.written->span;
                Truth now = named(*m.written);
                if (m.written->condition) {
                    now = both(now, open(m.written->condition));
                }
                if (now.known == Truth::kNo) {
                    continue;
                }
                const Truth here_now =
                    both(open(inside(plan_.atoms[a])), both(now, opposite(before)));
                before = either(before, now);
                pick(t, a, here, next, here_now);
            }
            where_ = at(plan_.atoms[a]).span;
            step(here, next, opposite(both(open(inside(plan_.atoms[a])), before)));
            here = next;
        }
        where_ = top_;
        lang::Transition& some = step(here, leave_, open(datum("something")));
        set(some, "something", make_bool(false, top_));
        // Nothing to do: for no event, or for this one.
        const Truth nothing = opposite(open(datum("something")));
        const Truth eventless = open(make_binary(Op::kEqual, datum(kEvent), number(0)));
        step(here, internal_, both(nothing, eventless));
        step(here, chart_.reads_event ? stable_ : internal_, both(nothing, opposite(eventless)));
    }

    // Atomic state `a` asks for transition t.
    void pick(int t, std::size_t a, const std::string& here, const std::string& next,
              const Truth& now) {
        const Move& m = plan_.moves[z(t)];
        const auto position = static_cast<std::int64_t>(a) + 1;
        if (!plan_.counted(t)) {
            lang::Transition& take = step(here, next, now);
            set(take, take_name(t), number(position));
            set(take, "something", make_bool(true, where_));
            return;
        }
        const Truth asked = open(make_binary(Op::kGreater, datum(take_name(t)), number(0)));
        step(here, next, both(now, asked));  // by another atomic state already
        const Truth fresh = both(now, opposite(asked));
        Truth preempted;
        Ids gives_way;
        for (const int u : m.conflicts) {
            if (chart_.descends(m.source, plan_.moves[z(u)].source)) {
                gives_way.push_back(u);
            } else {
                preempted = either(preempted, selected(u));
            }
        }
        if (preempted.known != Truth::kNo) {
            set(step(here, next, both(fresh, preempted)), take_name(t), number(refused()));
        }
        lang::Transition& take = step(here, next, both(fresh, opposite(preempted)));
        set(take, take_name(t), number(position));
        set(take, "something", make_bool(true, where_));
        for (const int u : gives_way) {
            Expr value = make_unary(Op::kNone, selected(u).expr);
            value.kind = lang::ExprKind::kConditional;
            value.args.push_back({{}, number(refused())});
            value.args.push_back({{}, datum(take_name(u))});
            set(take, take_name(u), std::move(value));
        }
    }

    // Some selected transition leaves this state.
    Truth left(int s) {
        Truth out;
        for (int t = 1; t < static_cast<int>(plan_.moves.size()); ++t) {
            if (plan_.moves[z(t)].domain >= 0 && chart_.descends(s, plan_.moves[z(t)].domain)) {
                out = either(out, selected(t));
            }
        }
        return both(out, open(inside(s)));
    }

    // exitStates
    void leave() {
        where_ = top_;
        std::string here = leave_;
        if (std::any_of(chart_.states.begin(), chart_.states.end(),
                        [](const State& s) { return s.kind == Kind::kHistory; })) {
            const std::string next = label();
            std::vector<std::pair<std::string, Expr>> values;
            for (int h = 1; h < static_cast<int>(chart_.states.size()); ++h) {
                if (at(h).kind != Kind::kHistory) {
                    continue;
                }
                where_ = at(h).span;
                const Truth when = left(at(h).parent);
                if (when.known == Truth::kNo) {
                    continue;
                }
                values.emplace_back(plan_.known_name(h),
                                    make_binary(Op::kOr, datum(plan_.known_name(h)), when.expr));
                for (const int s : plan_.stored(at(h))) {
                    Expr value = make_unary(Op::kNone, when.expr);
                    value.kind = lang::ExprKind::kConditional;
                    value.args.push_back({{}, inside(s)});
                    value.args.push_back({{}, datum(plan_.was_name(h, s))});
                    values.emplace_back(plan_.was_name(h, s), std::move(value));
                }
            }
            where_ = top_;
            lang::Transition& record = step(here, next, yes());
            for (auto& [name, value] : values) {
                set(record, name, std::move(value));
            }
            here = next;
        }
        here = leave_states(here, [&](int s) { return left(s); });
        where_ = top_;
        step(here, act_, yes());
    }

    // From the inside, those for which `when` holds.
    template <class When>
    std::string leave_states(std::string here, const When& when) {
        for (int s = static_cast<int>(chart_.states.size()) - 1; s > 0; --s) {
            where_ = at(s).span;
            if (at(s).kind == Kind::kHistory) {
                continue;
            }
            const Truth now = when(s);
            if (now.known == Truth::kNo) {
                continue;
            }
            const std::string next = label();
            step(here, next, opposite(now));
            std::string end = here;
            Truth last = now;
            if (!at(s).on_exit.empty()) {
                end = label();
                step(here, end, now);
                end = content(at(s).on_exit, end);
                last = yes();
            }
            where_ = at(s).span;
            lang::Transition& gone = step(end, next, last);
            gone.inputs.push_back(make_arc(ArcKind::kTakeAllNow, make_path(at(s).name, where_)));
            set(gone, inside_name(at(s)), make_bool(false, where_));
            here = next;
        }
        return here;
    }

    // executeTransitionContent: in the order in which they were selected.
    void act() {
        std::string here = act_;
        for (std::size_t a = 0; a < plan_.atoms.size(); ++a) {
            for (const int t : plan_.candidates[a]) {
                const Move& m = plan_.moves[z(t)];
                if (m.steps->empty()) {
                    continue;
                }
                where_ = m.written->span;
                const Truth now = open(make_binary(Op::kEqual, datum(take_name(t)),
                                                   number(static_cast<std::int64_t>(a) + 1)));
                const std::string next = label(), first = label();
                step(here, next, opposite(now));
                step(here, first, now);
                const std::string end = content(*m.steps, first);
                where_ = m.written->span;
                step(end, next, yes());
                here = next;
            }
        }
        where_ = top_;
        step(here, enter_, yes());
    }

    template <class Part>
    Truth entered(const Part& part) {
        Truth out;
        for (int t = 0; t < static_cast<int>(plan_.moves.size()); ++t) {
            if (plan_.moves[z(t)].domain >= 0) {
                out = either(out, both(plan_.diagrams.truth(part(plan_.moves[z(t)].entry), where_),
                                       selected(t)));
            }
        }
        return out;
    }

    // enterStates
    void enter() {
        std::string here = enter_;
        for (int s = 1; s < static_cast<int>(chart_.states.size()); ++s) {
            const State& state = at(s);
            where_ = state.span;
            if (state.kind == Kind::kHistory) {
                continue;
            }
            const Truth now = entered([&](const Entry& e) { return e.states[z(s)]; });
            if (now.known == Truth::kNo) {
                continue;
            }
            const std::string next = label();
            std::string end = label();
            step(here, next, opposite(now));
            lang::Transition& in = step(here, end, now);
            give(in, state.name);
            set(in, inside_name(state), make_bool(true, where_));
            end = content(state.on_entry, end);
            if (!state.initial_steps.empty()) {
                end = maybe(end, entered([&](const Entry& e) { return e.defaults[z(s)]; }),
                            state.initial_steps);
            }
            for (const int h : state.histories) {
                if (!at(h).initial_steps.empty()) {
                    end = maybe(end, entered([&](const Entry& e) { return e.histories[z(h)]; }),
                                at(h).initial_steps);
                }
            }
            where_ = state.span;
            if (state.kind == Kind::kFinal) {
                end = arrive(state, end);
            }
            step(end, next, yes());
            here = next;
        }
        where_ = top_;
        const auto clear = [&](lang::Transition& t) {
            for (int m = 0; m < static_cast<int>(plan_.moves.size()); ++m) {
                set(t, take_name(m), number(0));
            }
        };
        clear(step(here, stable_, opposite(open(datum("over")))));
        const std::string leaving = label();
        clear(step(here, leaving, open(datum("over"))));
        const std::string end = leave_states(leaving, [&](int s) { return open(inside(s)); });
        where_ = top_;
        lang::Transition& last = step(end, chart_.done, yes());
        for (const char* queue : {kRaised, kSent}) {
            last.inputs.push_back(make_arc(ArcKind::kTakeAllNow, make_path(queue, top_)));
        }
    }

    std::string maybe(const std::string& from, const Truth& when, const Steps& steps) {
        if (when.known == Truth::kNo) {
            return from;
        }
        const std::string next = label(), first = label();
        step(from, first, when);
        if (when.known != Truth::kYes) {
            step(from, next, opposite(when));
        }
        const std::string end = content(steps, first);
        step(end, next, yes());
        return next;
    }

    Truth finished(int s) {
        Truth out;
        if (at(s).kind == Kind::kParallel) {
            out = yes();
            for (const int c : at(s).children) {
                out = both(out, finished(c));
            }
        } else {
            for (const int c : at(s).children) {
                if (at(c).kind == Kind::kFinal) {
                    out = either(out, open(inside(c)));
                }
            }
        }
        return out;
    }

    // A final state has been entered.
    std::string arrive(const State& state, const std::string& from) {
        const std::string next = label();
        if (state.parent == 0) {
            set(step(from, next, yes()), "over", make_bool(true, where_));
            return next;
        }
        raise(step(from, next, yes()), event_number("done.state." + at(state.parent).name));
        const int above = at(state.parent).parent;
        if (at(above).kind != Kind::kParallel) {
            return next;
        }
        const std::string after = label();
        const Truth all = finished(above);
        raise(step(next, after, all), event_number("done.state." + at(above).name));
        step(next, after, opposite(all));
        return after;
    }

    // Internal events, then those from outside.
    void rest() {
        where_ = top_;
        const auto look = [&](lang::Transition& t, Expr event) {
            set(t, kEvent, event);
            if (chart_.reads_event) {
                set(t, kLastEvent, std::move(event));
            }
        };
        for (const char* queue : {kRaised, kSent}) {
            lang::Arc arc = make_arc(ArcKind::kTake, make_path(queue, top_));
            arc.pattern.push_back(bind("event", datum(kNumber)));
            lang::Transition& next =
                step(queue == std::string(kRaised) ? internal_ : idle_, select_, yes());
            next.inputs.push_back(std::move(arc));
            look(next, datum(kNumber));
        }
        lang::Transition& wait = step(internal_, idle_, yes());
        wait.tests.push_back(make_arc(ArcKind::kUnless, make_path(kRaised, top_)));
        set(wait, kEvent, number(0));
        for (const Heard& e : chart_.heard) {
            where_ = e.span;
            lang::Transition& hears = step(idle_, select_, yes());
            hears.name = make_name("hears " + e.event, e.span);
            hears.caption = {e.event, e.span};
            hears.events.push_back(make_path(e.name, e.span));
            hears.next_event = true;
            look(hears, number(event_number(e.event)));
        }
    }

    const Chart& chart_;
    lang::Body& body_;
    Span top_, where_;
    Plan plan_;
    std::vector<std::string> ids_;
    bool ids_known_ = false;
    int labels_ = 0, steps_ = 0;
    std::string select_, stable_, internal_, leave_, act_, enter_, idle_;
};

}  // namespace

lang::Net make_net(const Chart& chart, const std::string& name, Span where,
                   std::vector<Span>& vague, std::vector<int>& never) {
    lang::Net net;
    net.name = make_name(name, where);
    net.caption = {chart.name, where};
    net.span = where;
    Maker maker(chart, net, where);
    vague = maker.make();
    never = maker.never_entered();
    return net;
}

}  // namespace puppetri::notation::chart
