// SPDX-License-Identifier: MIT
// Everything that can be wrong with a draft after lowering, each with a code, its element and a
// remedy. Types come first: what passes here can be compiled and evaluated without another look.
#include "check.h"

#include <algorithm>
#include <optional>
#include <string>

#include "lower.h"
#include "puppetri/base/rational.h"

namespace puppetri::net {

namespace {

bool is_number(ValueType t) { return t.kind == ValueKind::kInt || t.kind == ValueKind::kReal; }
bool is_time(ValueType t) { return t.kind == ValueKind::kTime; }
bool is_bool(ValueType t) { return t.kind == ValueKind::kBool; }

// Orders two values of a type that has an order.
bool less(ValueType type, Value a, Value b) {
    return type.kind == ValueKind::kReal ? real_of_value(a) < real_of_value(b) : a < b;
}

class Check {
 public:
    Check(const NetDraft& net, Diagnostics& defects) : net_(net), defects_(defects) {}

    void run() {
        check_names();
        check_data();
        for (const PlaceDraft& p : net_.places) {
            check_place(p);
        }
        for (const TransitionDraft& t : net_.transitions) {
            check_transition(t);
        }
        check_siblings();
        check_events();
        check_formulas();
    }

 private:
    // What an expression may read, and where.
    struct Scope {
        const char* code = "type-mismatch";
        const SourceSpan* where = nullptr;
        std::string element;
        const std::vector<VariableDraft>* variables = nullptr;
        const std::vector<bool>* bound = nullptr;
        const std::vector<AttributeDraft>* attributes = nullptr;
        bool counts = true;
        bool data = true;
    };

    void fail(const Scope& s, const char* code, std::string message, std::string remedy) {
        report(defects_, code, *s.where, s.element, std::move(message), std::move(remedy));
    }

    // Are all slots there, of that type, and bound?
    bool check_slots(const Expr& e, const Scope& s) {
        bool fine = true;
        for (const Expr::Node& n : e.nodes()) {
            if (n.op == ExprOp::kToTime) {
                const Expr::Node& of = e.nodes()[n.a];
                if (of.op == ExprOp::kLiteral) {
                    const auto ticks = to_ticks(real_of_value(of.literal));
                    if (ticks && !ticks->exact) {
                        report(defects_, "rounded-to-tick", *s.where, s.element,
                               "a time is no whole number of ticks and has been rounded",
                               "nothing to do; a tick is 1/705600000 s", Severity::kNote);
                    }
                }
            }
            if (n.op == ExprOp::kSlot) {
                fine = check_slot(n, s) && fine;
            }
        }
        return fine;
    }

    bool check_slot(const Expr::Node& n, const Scope& s) {
        const auto missing = [&](const char* what) {
            fail(s, "unknown-index", std::string("reads ") + what, "read what is there");
            return false;
        };
        ValueType type{ValueKind::kInt, 0};
        switch (static_cast<SlotKind>(n.slot.kind)) {
            case SlotKind::kDatum:
                if (n.slot.index >= net_.data.size() || !s.data) {
                    return missing("a datum that it cannot see");
                }
                type = net_.data[n.slot.index].type;
                break;
            case SlotKind::kVariable:
                if (s.variables == nullptr || n.slot.index >= s.variables->size()) {
                    return missing("a variable that it cannot see");
                }
                if (s.bound != nullptr && !(*s.bound)[n.slot.index]) {
                    fail(s, "variable-unbound",
                         "reads " + (*s.variables)[n.slot.index].name + " before an arc binds it",
                         "bind it in a pattern of an earlier arc");
                    return false;
                }
                type = (*s.variables)[n.slot.index].type;
                break;
            case SlotKind::kCount:
            case SlotKind::kReady:
                if (n.slot.index >= net_.places.size() || !s.counts) {
                    return missing("a place that it cannot see");
                }
                break;
            case SlotKind::kAttribute:
                if (s.attributes == nullptr || n.slot.index >= s.attributes->size()) {
                    return missing("an attribute that its place does not have");
                }
                type = (*s.attributes)[n.slot.index].type;
                break;
            default:
                return missing("something unknown");
        }
        if (type != n.type) {
            fail(s, "type-mismatch",
                 std::string("takes a ") + name_of(type.kind) + " for a " + name_of(n.type.kind),
                 "use it as what it is");
            return false;
        }
        return true;
    }

    void want(const Expr& e, const Scope& s, bool fits, const char* what) {
        if (check_slots(e, s) && !fits) {
            fail(s, "type-mismatch",
                 std::string("a ") + name_of(e.type().kind) + " stands where " + what + " belongs",
                 std::string("give ") + what);
        }
    }

    template <class List>
    void unique(const List& list, const char* what) {
        std::vector<const std::string*> paths;
        std::vector<std::uint32_t> order;
        for (std::uint32_t i = 0; i < list.size(); ++i) {
            paths.push_back(&list[i].path);
            order.push_back(i);
        }
        std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            const int c = paths[a]->compare(*paths[b]);
            return c != 0 ? c < 0 : a < b;
        });
        for (std::size_t i = 0; i + 1 < order.size(); ++i) {
            if (*paths[order[i]] == *paths[order[i + 1]]) {
                report(defects_, "duplicate-name", list[order[i + 1]].where,
                       std::string(what) + " " + *paths[order[i]], "the name is taken",
                       "give one of them another name");
            }
        }
        if (list.size() >= (1u << 28)) {
            report(defects_, "net-too-large", {}, "net " + net_.name,
                   std::string("too many elements of one kind: ") + what, "split the model");
        }
    }

    void check_names() {
        unique(net_.places, "place");
        unique(net_.transitions, "transition");
        unique(net_.data, "datum");
        unique(net_.events, "event");
    }

    bool enum_has(ValueType type, Value v) const {
        return type.kind != ValueKind::kEnum ||
               (type.enumeration < net_.enums.size() && v >= 0 &&
                v < static_cast<Value>(net_.enums[type.enumeration].values.size()));
    }

    void check_data() {
        for (const DatumDraft& d : net_.data) {
            const std::string element = "datum " + d.path;
            if (d.low && d.high && less(d.type, *d.high, *d.low)) {
                report(defects_, "range-empty", d.where, element, "no value lies in its range",
                       "write the smaller bound first");
            } else if ((d.low && less(d.type, d.initial, *d.low)) ||
                       (d.high && less(d.type, *d.high, d.initial)) ||
                       !enum_has(d.type, d.initial) ||
                       (is_bool(d.type) && d.initial != 0 && d.initial != 1)) {
                report(defects_, "initial-out-of-range", d.where, element,
                       "starts outside its range", "start it within its range");
            }
            if (d.sensor && !is_bool(d.type)) {
                report(defects_, "type-mismatch", d.where, element, "a sensor is a bool",
                       "declare it as a bool");
            }
        }
    }

    void check_duration(const DurationDraft& d, Scope s, bool of_place) {
        const SourceSpan own = d.where;
        if (own.line != 0) {
            s.where = &own;
        }
        switch (d.kind) {
            case DurationKind::kConstant:
                want(d.a, s, is_time(d.a.type()) && d.a.is_literal(), "a constant time");
                if (is_time(d.a.type()) && d.a.is_literal() && d.a.literal_value() < 0) {
                    fail(s, "negative-duration", "a negative time", "give 0 or more");
                }
                break;
            case DurationKind::kExpression:
                want(d.a, s, is_time(d.a.type()), "a time");
                break;
            case DurationKind::kInterval:
                want(d.a, s, is_time(d.a.type()), "a time");
                want(d.b, s, is_time(d.b.type()), "a time");
                if (d.a.is_literal() && d.a.literal_value() < 0) {
                    fail(s, "negative-duration", "a negative time", "give 0 or more");
                }
                if (d.a.is_literal() && d.b.is_literal() &&
                    d.b.literal_value() < d.a.literal_value()) {
                    fail(s, "empty-interval", "the interval ends before it begins",
                         "write the smaller bound first");
                }
                break;
            case DurationKind::kDistribution: {
                bool constant = true;
                std::vector<double> values;
                for (const Expr& p : d.parameters) {
                    want(p, s, is_time(p.type()) || is_number(p.type()), "a time or a number");
                    constant = constant && p.is_literal();
                    if (p.is_literal()) {
                        const Value v = p.literal_value();
                        values.push_back(p.type().kind == ValueKind::kReal ? real_of_value(v)
                                         : is_time(p.type())               ? SimTime{v}.seconds()
                                                             : static_cast<double>(v));
                    }
                }
                if (constant) {
                    const Status fits = puppetri::check(d.distribution, values);
                    if (!fits) {
                        for (const Diagnostic& found : fits.error()) {
                            fail(s, "wrong-distribution", found.message, found.remedy);
                        }
                    }
                }
                break;
            }
            case DurationKind::kAuto:
            case DurationKind::kAs:
            case DurationKind::kOpen:
                if (!of_place) {
                    fail(s, "type-mismatch", "a delay cannot be auto, as or open",
                         "give a time, an interval or a distribution");
                }
                break;
        }
    }

    void check_place(const PlaceDraft& p) {
        Scope s;
        s.where = &p.where;
        s.element = "place " + p.path;
        s.attributes = &p.attributes;
        const DurationDraft d = effective_duration(p);
        check_duration(d, s, true);
        if (d.kind == DurationKind::kAuto && !p.action.valid()) {
            fail(s, "auto-without-movement", "`auto` asks a movement, and there is none",
                 "say what it does, or how long it takes");
        }
        if (p.discipline == Discipline::kLeast || p.discipline == Discipline::kMost) {
            Scope key = s;
            key.counts = false;
            key.data = false;
            if (is_bool(p.key.type())) {
                fail(s, "key-missing", "least and most need something to compare",
                     "name an attribute or an expression over attributes");
            } else {
                want(p.key, key,
                     is_number(p.key.type()) || is_time(p.key.type()) ||
                         p.key.type().kind == ValueKind::kEnum,
                     "a number or a time");
            }
        }
        std::uint64_t initial = 0;
        for (const InitialToken& token : p.tokens) {
            initial += token.count;
            bool fits = token.attributes.size() == p.attributes.size();
            for (std::size_t i = 0; fits && i < p.attributes.size(); ++i) {
                fits = enum_has(p.attributes[i].type, token.attributes[i]);
            }
            if (!fits) {
                fail(s, "type-mismatch", "an initial token does not have the place's attributes",
                     "give each attribute a value of its type");
            }
        }
        if (initial > 0x7FFF'FFFF) {
            fail(s, "net-too-large", "too many tokens", "use fewer");
        }
        if (p.capacity && initial > *p.capacity) {
            fail(s, "capacity-exceeded", "starts with more tokens than it holds at most",
                 "raise the bound");
        }
    }

    void check_pattern(const TransitionDraft& t, const ArcDraft& arc, Scope& s,
                       std::vector<bool>& bound) {
        const PlaceDraft& place = net_.places[arc.place.value];
        const bool binds_allowed = arc.kind == ArcKind::kTake || arc.kind == ArcKind::kTakeNow ||
                                   arc.kind == ArcKind::kRead || arc.kind == ArcKind::kReadNow;
        // An arc's own variables are bound from left to right.
        for (const PatternDraft& pattern : arc.pattern) {
            if (pattern.attribute >= place.attributes.size()) {
                fail(s, "unknown-index", "asks for an attribute that " + place.path + " has not",
                     "ask for one of its attributes");
                continue;
            }
            const ValueType type = place.attributes[pattern.attribute].type;
            if (pattern.binds) {
                if (*pattern.binds >= t.variables.size()) {
                    fail(s, "unknown-index", "binds an unknown variable", "declare it");
                } else if (t.variables[*pattern.binds].type != type) {
                    fail(
                        s, "type-mismatch",
                        t.variables[*pattern.binds].name + " is of another type than the attribute",
                        "use another variable");
                } else if (!binds_allowed && !bound[*pattern.binds]) {
                    fail(s, "pattern-on-attribute",
                         "`all` and `unless` take no single token that could be bound",
                         "compare with a value or with a variable bound before");
                } else {
                    bound[*pattern.binds] = true;
                }
            } else {
                want(pattern.equals, s, pattern.equals.type() == type,
                     "a value of the attribute's type");
            }
        }
        if (arc.time_left) {
            if (*arc.time_left >= t.variables.size() ||
                !is_time(t.variables[*arc.time_left].type)) {
                fail(s, "type-mismatch", "the time left is a time",
                     "bind it to a variable of time");
            } else if (arc.kind != ArcKind::kTakeNow && arc.kind != ArcKind::kReadNow) {
                fail(s, "pattern-on-attribute", "only `now` and `while` see the time left",
                     "write `now` before the place");
            } else {
                bound[*arc.time_left] = true;
            }
        }
    }

    void check_transition(const TransitionDraft& t) {
        std::vector<bool> bound(t.variables.size(), false);
        Scope s;
        s.where = &t.where;
        s.element = "transition " + t.path;
        s.variables = &t.variables;
        s.bound = &bound;
        const auto weight = [&](std::int64_t w, const SourceSpan& where, PlaceIndex p) {
            if (w < 1 || w > 0x3FFF'FFFF) {
                report(
                    defects_, w < 1 ? "weight-not-positive" : "net-too-large",
                    where.line != 0 ? where : t.where, s.element,
                    "the arc to " + net_.places[p.value].path + " has weight " + std::to_string(w),
                    "give a whole number above 0, or leave the arc out");
            }
        };
        for (const ArcDraft& arc : t.inputs) {
            weight(arc.weight, arc.where, arc.place);
            Scope at = s;
            at.where = arc.where.line != 0 ? &arc.where : &t.where;
            check_pattern(t, arc, at, bound);
        }
        if (t.inputs.empty() && !t.delay && t.events.empty() && !sources_allowed()) {
            fail(s, "source-without-delay",
                 "fires for ever in one instant: it needs no token, no delay, no event",
                 "give it an input, a delay or an event");
        }
        if (t.guard) {
            want(*t.guard, s, is_bool(t.guard->type()), "a bool");
        }
        if (t.odds) {
            want(*t.odds, s, is_number(t.odds->type()), "a number");
            if (t.odds->is_literal() && is_number(t.odds->type())) {
                const Value v = t.odds->literal_value();
                const double x = t.odds->type().kind == ValueKind::kReal ? real_of_value(v)
                                                                         : static_cast<double>(v);
                if (!(x > 0)) {
                    fail(s, "odds-not-positive", "odds are above 0",
                         "give odds above 0, or a guard that is false");
                }
            }
        }
        if (t.delay) {
            check_duration(t.delay->duration, s, false);
            if (t.delay->servers == 0) {
                fail(s, "weight-not-positive", "a delay has at least one server",
                     "give 1 or more, or `infinite`");
            }
        }
        for (const OutputDraft& out : t.outputs) {
            weight(out.weight, out.where, out.place);
            const PlaceDraft& place = net_.places[out.place.value];
            Scope at = s;
            at.where = out.where.line != 0 ? &out.where : &t.where;
            if (out.attributes.size() != place.attributes.size()) {
                fail(at, "type-mismatch",
                     "a token of " + place.path + " needs each of its attributes",
                     "give " + std::to_string(place.attributes.size()) + " values");
            } else {
                for (std::size_t i = 0; i < out.attributes.size(); ++i) {
                    want(out.attributes[i], at,
                         out.attributes[i].type() == place.attributes[i].type,
                         "a value of the attribute's type");
                }
            }
            if (out.lasts) {
                want(*out.lasts, at, is_time(out.lasts->type()), "a time");
            }
        }
        std::vector<std::uint32_t> written;
        for (const AssignmentDraft& a : t.assignments) {
            Scope at = s;
            at.where = a.where.line != 0 ? &a.where : &t.where;
            if (a.datum.value >= net_.data.size()) {
                fail(at, "unknown-index", "sets an unknown datum", "declare it");
                continue;
            }
            const DatumDraft& d = net_.data[a.datum.value];
            if (d.sensor) {
                fail(at, "sensor-assigned", d.path + " is a sensor: only crossings change it",
                     "use another datum");
            }
            if (std::count(written.begin(), written.end(), a.datum.value) != 0) {
                fail(at, "two-writers", d.path + " is set twice in one firing", "set it once");
            }
            written.push_back(a.datum.value);
            want(a.value, at, a.value.type() == d.type, "a value of the datum's type");
        }
        for (const std::vector<EventIndex>* list : {&t.events, &t.raises}) {
            for (const EventIndex e : *list) {
                if (e.value >= net_.events.size()) {
                    fail(s, "unknown-index", "names an unknown event", "declare it");
                }
            }
        }
    }

    // `as P`: every firing that makes a token here makes one in P, and nobody waits for itself.
    void check_siblings() {
        const std::size_t count = net_.places.size();
        std::vector<std::uint32_t> sibling(count, PlaceIndex::kNone);
        for (std::size_t i = 0; i < count; ++i) {
            const PlaceDraft& p = net_.places[i];
            if (!p.duration || p.duration->kind != DurationKind::kAs) {
                continue;
            }
            sibling[i] = p.duration->sibling.value;
            if (sibling[i] >= count) {
                report(defects_, "unknown-index", p.where, "place " + p.path,
                       "lasts as an unknown place", "name a place");
                sibling[i] = PlaceIndex::kNone;
                continue;
            }
            if (effective_duration(net_.places[sibling[i]]).kind == DurationKind::kOpen) {
                report(defects_, "as-without-sibling", p.where, "place " + p.path,
                       "lasts as " + net_.places[sibling[i]].path + ", which is open",
                       "make it open too, or give it a duration");
            }
            const bool unready_start =
                std::any_of(p.tokens.begin(), p.tokens.end(),
                            [](const InitialToken& token) { return !token.ready; });
            if (unready_start && net_.places[sibling[i]].tokens.empty()) {
                report(defects_, "as-without-sibling", p.where, "place " + p.path,
                       "starts with a token, but " + net_.places[sibling[i]].path +
                           ", whose duration it takes, does not",
                       "write `tokens 1 ready`");
            }
        }
        for (std::size_t i = 0; i < count; ++i) {
            std::uint32_t at = sibling[i];
            for (std::size_t steps = 0; at != PlaceIndex::kNone && steps <= count; ++steps) {
                if (at == i) {
                    report(defects_, "as-without-sibling", net_.places[i].where,
                           "place " + net_.places[i].path, "lasts as long as itself",
                           "give one of the places a duration of its own");
                    break;
                }
                at = sibling[at];
            }
        }
        for (const TransitionDraft& t : net_.transitions) {
            for (const OutputDraft& out : t.outputs) {
                const std::uint32_t wanted = sibling[out.place.value];
                const bool there =
                    std::any_of(t.outputs.begin(), t.outputs.end(),
                                [&](const OutputDraft& o) { return o.place.value == wanted; });
                if (wanted != PlaceIndex::kNone && !out.lasts && !there) {
                    report(defects_, "as-without-sibling",
                           out.where.line != 0 ? out.where : t.where, "transition " + t.path,
                           "gives a token to " + net_.places[out.place.value].path +
                               ", which lasts as " + net_.places[wanted].path + ", but none there",
                           "give one to " + net_.places[wanted].path + " too");
                }
            }
        }
    }

    void check_events() {
        for (const EventDraft& e : net_.events) {
            const std::string element = "event " + e.path;
            if (e.sets.valid() &&
                (e.sets.value >= net_.data.size() || !net_.data[e.sets.value].sensor)) {
                report(defects_, "type-mismatch", e.where, element, "sets what is no sensor",
                       "declare the datum as a sensor");
            }
            if (e.makes_ready.valid()) {
                const PlaceDraft& p = net_.places[e.makes_ready.value];
                if (!p.duration || p.duration->kind != DurationKind::kOpen) {
                    report(defects_, "type-mismatch", e.where, element,
                           "makes tokens of " + p.path + " ready, which is not open",
                           "write `takes open` at the place");
                }
            }
        }
        for (const ScheduledEvent& s : net_.schedule) {
            if (s.event.value >= net_.events.size()) {
                report(defects_, "unknown-index", s.where, "net " + net_.name,
                       "schedules an unknown event", "declare it");
            } else if (s.at.ticks < 0 || (s.every && s.every->ticks <= 0)) {
                report(defects_, "negative-duration", s.where,
                       "event " + net_.events[s.event.value].path,
                       "is scheduled before the start, or again and again in no time",
                       "give a time of 0 or more, and a period above 0");
            }
        }
    }

    void check_formula(const Formula& f, const SourceSpan& where, const std::string& element) {
        Scope s;
        s.where = &where;
        s.element = element;
        for (const Expr& e : f.expressions) {
            want(e, s, is_bool(e.type()), "a bool");
        }
        for (const Formula::Node& n : f.nodes) {
            const bool unknown = (n.op == FormulaOp::kEvent && n.index >= net_.events.size()) ||
                                 (n.op == FormulaOp::kExpr && n.index >= f.expressions.size()) ||
                                 (n.op == FormulaOp::kHost && n.index >= net_.host_atoms.size());
            if (unknown) {
                fail(s, "unknown-index", "mentions something unknown", "declare it");
            }
        }
    }

    void check_measure(const MeasureDraft& m) {
        Scope s;
        s.where = &m.where;
        s.element = "measure " + m.path;
        const auto want_value = [&](const Expr& e, const Scope& scope) {
            const bool share = m.statistic == Statistic::kShare ||
                               m.statistic == Statistic::kCount || m.statistic == Statistic::kRate;
            const ValueKind kind = e.type().kind;
            want(e, scope,
                 share ? kind == ValueKind::kBool
                       : kind == ValueKind::kInt || kind == ValueKind::kReal ||
                             kind == ValueKind::kTime,
                 share ? "a bool" : "a number or a time");
        };
        const bool counts = m.statistic == Statistic::kCount || m.statistic == Statistic::kRate;
        if (m.seen == Seen::kState) {
            want_value(m.value, s);
        }
        const bool of_times = m.seen == Seen::kStays || m.seen == Seen::kPassages;
        const bool always = m.seen == Seen::kState || m.seen == Seen::kCourse;
        if (always && (counts || m.statistic == Statistic::kPercentile ||
                       (m.seen == Seen::kCourse && m.statistic == Statistic::kShare))) {
            fail(s, "type-mismatch", "counts what is there all the time",
                 "name what is to be seen");
        }
        if (of_times && m.statistic == Statistic::kShare && !m.above) {
            fail(s, "type-mismatch", "a share of times needs a time that they are above",
                 "write `above 5 min`");
        }
        if (!(m.percent > 0 && m.percent <= 100)) {
            fail(s, "type-mismatch", "a percentage is above 0 and at most 100", "write 90");
        }
        for (const std::vector<Moment>* list : {&m.from, &m.to}) {
            for (const Moment& moment : *list) {
                Scope at = s;
                at.variables = &net_.transitions[moment.transition.value].variables;
                if (m.seen == Seen::kFirings && (moment.keyed || !counts)) {
                    want_value(moment.value, at);
                } else if (m.seen == Seen::kPassages && moment.keyed) {
                    want(moment.value, at, true, "a value");
                }
            }
        }
    }

    void check_formulas() {
        for (const NamedState& n : net_.states) {
            check_formula(n.condition, n.where, "state " + n.path);
        }
        for (const Rule& r : net_.rules) {
            for (const Formula& f : r.operands) {
                check_formula(f, r.where, "rule " + r.path);
            }
        }
        for (const TimeQuestion& q : net_.questions) {
            check_formula(q.about, q.where, "question " + q.path);
        }
        for (const MeasureDraft& m : net_.measures) {
            check_measure(m);
        }
        for (const FinalMarkingDraft& f : net_.finals) {
            check_formula(f.condition, f.where, "end");
            for (const Formula::Node& n : f.condition.nodes) {
                if (n.op != FormulaOp::kConstant && n.op != FormulaOp::kMarked &&
                    n.op != FormulaOp::kReady && n.op != FormulaOp::kExpr &&
                    n.op != FormulaOp::kNot && n.op != FormulaOp::kAnd && n.op != FormulaOp::kOr &&
                    n.op != FormulaOp::kImplies && n.op != FormulaOp::kIff) {
                    report(defects_, "type-mismatch", f.where, "end",
                           "a final marking speaks of tokens and data only",
                           "leave events, firings and figures out");
                    break;
                }
            }
        }
    }

    // Whether the net has no time (docs/semantics.md, "paced") and its draft allows sources there.
    bool sources_allowed() {
        if (!net_.sources_on_beats || sources_allowed_) {
            return net_.sources_on_beats && *sources_allowed_;
        }
        bool timeless = net_.schedule.empty();
        for (const PlaceDraft& p : net_.places) {
            const DurationDraft d = effective_duration(p);
            timeless = timeless && (d.kind == DurationKind::kOpen || d.kind == DurationKind::kAs ||
                                    (d.kind == DurationKind::kConstant && d.a.is_literal() &&
                                     d.a.literal_value() == 0));
        }
        for (const TransitionDraft& t : net_.transitions) {
            timeless = timeless && !t.delay;
            for (const OutputDraft& o : t.outputs) {
                timeless = timeless && !o.lasts;
            }
        }
        sources_allowed_ = timeless;
        return timeless;
    }

    const NetDraft& net_;
    Diagnostics& defects_;
    std::optional<bool> sources_allowed_;
};

}  // namespace

void check_lowered(const NetDraft& net, Diagnostics& defects) { Check(net, defects).run(); }

}  // namespace puppetri::net
