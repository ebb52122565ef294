// SPDX-License-Identifier: MIT
// The generator draws first which features this net has, so that each is also met alone; then
// places, data, events, transitions. It never makes what `compile` refuses, nor what stops a run.
#include "support/random_net.h"

#include <algorithm>
#include <numeric>

namespace puppetri::test {
namespace {

using namespace net;

Expr must(Result<Expr, ExprError> e) { return std::move(e).value(); }
Expr units(std::int64_t n) { return Expr::time({n * kRandomNetUnit}); }

class Generator {
 public:
    Generator(RandomStream& stream, const Features& allowed) : stream_(stream), has_(allowed) {
        for (bool* feature : {&has_.timed, &has_.intervals, &has_.delays, &has_.inhibitors,
                              &has_.reads, &has_.priorities, &has_.cuts, &has_.data, &has_.records,
                              &has_.any, &has_.capacities, &has_.events, &has_.siblings, &has_.odds,
                              &has_.weights, &has_.servers, &has_.holdings, &has_.expressions}) {
            *feature = *feature && chance(50);
        }
    }

    NetDraft make() {
        net_.name = "random";
        make_data();
        make_events();
        const std::size_t places = 2 + stream_.below(4);
        for (std::size_t p = 0; p < places; ++p) {
            make_place(p);
        }
        const std::size_t transitions = 2 + stream_.below(4);
        for (std::size_t t = 0; t < transitions; ++t) {
            make_transition(t);
        }
        make_schedule();
        return std::move(net_);
    }

 private:
    bool chance(std::uint64_t percent) { return stream_.below(100) < percent; }
    std::uint32_t any_place() {
        return static_cast<std::uint32_t>(stream_.below(net_.places.size()));
    }

    void make_data() {
        if (!has_.data) {
            return;
        }
        DatumDraft d;
        d.path = "x";
        d.type = {ValueKind::kInt, 0};
        d.initial = static_cast<Value>(stream_.below(4));
        d.low = 0;
        d.high = 3;
        net_.data.push_back(d);
    }

    void make_events() {
        if (!has_.events) {
            return;
        }
        const std::size_t count = 1 + stream_.below(2);
        for (std::size_t e = 0; e < count; ++e) {
            EventDraft event;
            event.path = "e" + std::to_string(e);
            event.consumed = chance(40);
            net_.events.push_back(event);
        }
        if (chance(30)) {
            DatumDraft sensor;
            sensor.path = "seen";
            sensor.type = {ValueKind::kBool, 0};
            sensor.sensor = true;
            net_.events[0].sets = DatumIndex{static_cast<std::uint32_t>(net_.data.size())};
            net_.events[0].sets_to = chance(70);
            sensor.initial = chance(50) ? 1 : 0;
            net_.data.push_back(sensor);
        }
    }

    DurationDraft constant(std::int64_t n) {
        DurationDraft d;
        d.a = units(n);
        return d;
    }
    DurationDraft random_duration() {
        if (has_.intervals && chance(40)) {
            DurationDraft d;
            d.kind = DurationKind::kInterval;
            const auto low = static_cast<std::int64_t>(stream_.below(3));
            d.a = units(low);
            d.b = units(low + static_cast<std::int64_t>(1 + stream_.below(2)));
            return d;
        }
        return constant(static_cast<std::int64_t>(stream_.below(4)));
    }

    void make_place(std::size_t number) {
        PlaceDraft p;
        p.path = "P" + std::to_string(number);
        const bool open = has_.events && has_.timed && chance(20);
        if (open) {
            DurationDraft d;
            d.kind = DurationKind::kOpen;
            p.duration = d;
            for (EventDraft& e : net_.events) {
                if (!e.makes_ready.valid() && !e.sets.valid()) {
                    e.makes_ready = PlaceIndex{static_cast<std::uint32_t>(number)};
                    break;
                }
            }
        } else if (has_.siblings && number > 0 && chance(35) && net_.places[number - 1].duration &&
                   net_.places[number - 1].duration->kind != DurationKind::kAs &&
                   net_.places[number - 1].duration->kind != DurationKind::kOpen) {
            DurationDraft d;
            d.kind = DurationKind::kAs;
            d.sibling = PlaceIndex{static_cast<std::uint32_t>(number - 1)};
            p.duration = d;
        } else if (has_.timed && chance(65)) {
            p.duration = random_duration();
        }
        if (has_.records && chance(60)) {
            p.attributes.push_back({"kind", {ValueKind::kInt, 0}});
            const Discipline choices[] = {Discipline::kOldest, Discipline::kNewest,
                                          Discipline::kLeast, Discipline::kMost};
            p.discipline = choices[stream_.below(4)];
            if (p.discipline == Discipline::kLeast || p.discipline == Discipline::kMost) {
                p.key = Expr::slot(slot(SlotKind::kAttribute, 0), {ValueKind::kInt, 0});
            }
        }
        if (has_.any && chance(40)) {
            p.discipline = Discipline::kAny;
        }
        if (has_.records && chance(25)) {
            p.keeps_order = true;
        }
        if (has_.records && p.discipline != Discipline::kAny && chance(30)) {
            p.by_arrival = true;
        }
        if (has_.expressions && p.duration && p.duration->kind == DurationKind::kConstant &&
            chance(50) && (has_.data || !p.attributes.empty())) {
            // n units, n from the token or the datum
            const Expr n = !p.attributes.empty() && chance(60)
                               ? Expr::slot(slot(SlotKind::kAttribute, 0), {ValueKind::kInt, 0})
                           : has_.data
                               ? Expr::slot(slot(SlotKind::kDatum, 0), {ValueKind::kInt, 0})
                               : Expr::slot(slot(SlotKind::kAttribute, 0), {ValueKind::kInt, 0});
            p.duration->kind = DurationKind::kExpression;
            p.duration->a = must(Expr::binary(ExprOp::kMultiply, n, units(1)));
        }
        const bool as = p.duration && p.duration->kind == DurationKind::kAs;
        const std::size_t groups = as ? 0 : stream_.below(3);
        std::uint32_t tokens = 0;
        for (std::size_t g = 0; g < groups; ++g) {
            InitialToken token;
            token.count = static_cast<std::uint32_t>(1 + stream_.below(2));
            token.ready = chance(40);
            if (!p.attributes.empty()) {
                token.attributes.push_back(static_cast<Value>(stream_.below(3)));
            }
            tokens += token.count;
            p.tokens.push_back(token);
        }
        if (has_.capacities && chance(40)) {
            p.capacity =
                std::max<std::uint32_t>(1, tokens + static_cast<std::uint32_t>(stream_.below(2)));
        }
        net_.places.push_back(std::move(p));
    }

    std::int64_t weight() { return has_.weights && chance(25) ? 2 : 1; }

    void add_pattern(TransitionDraft& t, ArcDraft& arc, bool may_bind) {
        if (net_.places[arc.place.value].attributes.empty() || !chance(60)) {
            return;
        }
        PatternDraft pattern;
        if (may_bind && chance(60)) {
            if (t.variables.empty() || chance(50)) {
                t.variables.push_back(
                    {"v" + std::to_string(t.variables.size()), {ValueKind::kInt, 0}});
                bound_.push_back(false);
            }
            for (std::uint32_t v = static_cast<std::uint32_t>(t.variables.size()); v-- > 0;) {
                if (t.variables[v].type.kind == ValueKind::kInt) {
                    pattern.binds = v;
                    bound_[v] = true;
                    break;
                }
            }
        }
        if (!pattern.binds) {
            pattern.equals = some_int(t, true);
        }
        arc.pattern.push_back(pattern);
    }

    // A small int over what is known so far.
    Expr some_int(const TransitionDraft& t, bool pattern) {
        std::vector<Expr> choices = {Expr::integer(static_cast<std::int64_t>(stream_.below(3)))};
        for (std::uint32_t v = 0; v < t.variables.size(); ++v) {
            if (bound_[v] && t.variables[v].type.kind == ValueKind::kInt) {
                choices.push_back(Expr::slot(slot(SlotKind::kVariable, v), {ValueKind::kInt, 0}));
            }
        }
        if (has_.data) {
            choices.push_back(Expr::slot(slot(SlotKind::kDatum, 0), {ValueKind::kInt, 0}));
            if (!pattern) {
                const SlotKind kind = chance(50) ? SlotKind::kCount : SlotKind::kReady;
                choices.push_back(Expr::slot(slot(kind, any_place()), {ValueKind::kInt, 0}));
            }
        }
        return choices[stream_.below(choices.size())];
    }

    ArcDraft arc(ArcKind kind, std::uint32_t place, std::int64_t w) {
        ArcDraft a;
        a.kind = kind;
        a.place = PlaceIndex{place};
        a.weight = w;
        return a;
    }

    void make_inputs(TransitionDraft& t) {
        std::vector<bool> taken(net_.places.size(), false);
        const std::size_t count = 1 + stream_.below(2);
        for (std::size_t i = 0; i < count; ++i) {
            const std::uint32_t p = any_place();
            ArcKind kind = ArcKind::kTake;
            if (has_.cuts && chance(35) && !taken[p]) {
                const ArcKind kinds[] = {ArcKind::kTakeNow, ArcKind::kTakeAll,
                                         ArcKind::kTakeAllNow};
                kind = kinds[stream_.below(3)];
            }
            if (i == 0 && (kind == ArcKind::kTakeAll || kind == ArcKind::kTakeAllNow)) {
                kind = ArcKind::kTakeNow;  // at least one arc that needs a token
            }
            if (taken[p] && (kind != ArcKind::kTake || taken_specially_[p])) {
                continue;
            }
            taken[p] = true;
            taken_specially_[p] = kind != ArcKind::kTake;
            const bool all = kind == ArcKind::kTakeAll || kind == ArcKind::kTakeAllNow;
            ArcDraft a = arc(kind, p, all ? 1 : weight());
            add_pattern(t, a, !all && a.weight == 1);
            const bool open =
                net_.places[p].duration && net_.places[p].duration->kind == DurationKind::kOpen;
            if (kind == ArcKind::kTakeNow && chance(50) && !open) {
                a.time_left = static_cast<std::uint32_t>(t.variables.size());
                t.variables.push_back({"left", {ValueKind::kTime, 0}});
                bound_.push_back(true);
            }
            t.inputs.push_back(std::move(a));
        }
        while (has_.reads && chance(40)) {
            ArcDraft a =
                arc(chance(50) ? ArcKind::kRead : ArcKind::kReadNow, any_place(), weight());
            add_pattern(t, a, a.weight == 1);
            t.inputs.push_back(std::move(a));
        }
        while (has_.inhibitors && chance(40)) {
            ArcDraft a =
                arc(chance(60) ? ArcKind::kUnless : ArcKind::kUnlessReady, any_place(), weight());
            add_pattern(t, a, false);
            t.inputs.push_back(std::move(a));
        }
    }

    void make_outputs(TransitionDraft& t) {
        const std::size_t count = stream_.below(3);
        for (std::size_t i = 0; i < count; ++i) {
            OutputDraft out;
            const std::uint32_t p = any_place();
            out.place = PlaceIndex{p};
            out.weight = weight();
            const auto& duration = net_.places[p].duration;
            if (duration && duration->kind == DurationKind::kAs) {
                // exactly one token here and one in its sibling
                const auto goes_to = [&t](std::uint32_t place) {
                    return std::any_of(
                        t.outputs.begin(), t.outputs.end(),
                        [place](const OutputDraft& o) { return o.place.value == place; });
                };
                if (goes_to(p) || goes_to(duration->sibling.value)) {
                    continue;
                }
                out.weight = 1;
                OutputDraft sibling;
                sibling.place = duration->sibling;
                fill_attributes(t, sibling);
                t.outputs.push_back(std::move(sibling));
            } else if (std::any_of(t.outputs.begin(), t.outputs.end(), [&](const OutputDraft& o) {
                           const auto& other = net_.places[o.place.value].duration;
                           return other && other->kind == DurationKind::kAs &&
                                  other->sibling.value == p;
                       })) {
                continue;
            } else if (has_.cuts && chance(40)) {
                for (std::uint32_t v = 0; v < t.variables.size(); ++v) {
                    if (t.variables[v].type.kind == ValueKind::kTime) {
                        out.lasts = Expr::slot(slot(SlotKind::kVariable, v), {ValueKind::kTime, 0});
                    }
                }
            }
            fill_attributes(t, out);
            t.outputs.push_back(std::move(out));
        }
    }

    void fill_attributes(const TransitionDraft& t, OutputDraft& out) {
        for (std::size_t i = 0; i < net_.places[out.place.value].attributes.size(); ++i) {
            out.attributes.push_back(some_int(t, false));
        }
    }

    void make_transition(std::size_t number) {
        TransitionDraft t;
        t.path = "t" + std::to_string(number);
        bound_.clear();
        taken_specially_.assign(net_.places.size(), false);
        make_inputs(t);
        make_outputs(t);
        const bool sensor = !net_.data.empty() && net_.data.back().sensor;
        if (sensor && chance(40)) {
            t.guard =
                Expr::slot(slot(SlotKind::kDatum, static_cast<std::uint32_t>(net_.data.size()) - 1),
                           {ValueKind::kBool, 0});
        } else if (has_.data && chance(40)) {
            const ExprOp ops[] = {ExprOp::kLess, ExprOp::kEqual, ExprOp::kNotEqual,
                                  ExprOp::kGreater};
            t.guard =
                must(Expr::binary(ops[stream_.below(4)], some_int(t, false), some_int(t, false)));
        }
        if (has_.data && chance(40)) {
            AssignmentDraft a;
            a.datum = DatumIndex{0};
            a.value = must(Expr::binary(
                ExprOp::kModulo,
                must(Expr::binary(ExprOp::kAdd, some_int(t, false), some_int(t, false))),
                Expr::integer(4)));
            t.assignments.push_back(a);
        }
        if (has_.priorities) {
            t.priority = static_cast<std::int64_t>(stream_.below(3));
        }
        if (has_.odds && chance(50)) {
            t.odds = Expr::real(0.5 + static_cast<double>(stream_.below(4)));
        }
        if (has_.delays && chance(40)) {
            DelayDraft delay;
            delay.duration = random_duration();
            const DelayMemory memories[] = {DelayMemory::kEnabling, DelayMemory::kEnabling,
                                            DelayMemory::kAge, DelayMemory::kResample};
            delay.memory = memories[stream_.below(4)];
            const bool plain =
                std::all_of(t.inputs.begin(), t.inputs.end(), [&](const ArcDraft& a) {
                    return a.pattern.empty() &&
                           (a.kind != ArcKind::kTakeAll && a.kind != ArcKind::kTakeAllNow);
                });
            if (has_.servers && plain && delay.memory != DelayMemory::kAge && chance(60)) {
                delay.servers = chance(50) ? 2 : DelayDraft::kInfiniteServers;
            }
            t.delay = delay;
        }
        const bool lasts = std::any_of(t.outputs.begin(), t.outputs.end(),
                                       [](const OutputDraft& o) { return o.lasts.has_value(); });
        if (has_.holdings && has_.timed && !lasts && chance(30)) {
            t.holding = random_duration();
        }
        if (has_.events && chance(40)) {
            t.events.push_back(
                EventIndex{static_cast<std::uint32_t>(stream_.below(net_.events.size()))});
        }
        if (has_.events && chance(25)) {
            t.raises.push_back(
                EventIndex{static_cast<std::uint32_t>(stream_.below(net_.events.size()))});
        }
        net_.transitions.push_back(std::move(t));
    }

    void make_schedule() {
        if (!has_.events) {
            return;
        }
        const std::size_t count = 1 + stream_.below(3);
        for (std::size_t i = 0; i < count; ++i) {
            ScheduledEvent s;
            s.at = {static_cast<std::int64_t>(stream_.below(6)) * kRandomNetUnit};
            s.event = EventIndex{static_cast<std::uint32_t>(stream_.below(net_.events.size()))};
            if (chance(20)) {
                s.every = SimTime{static_cast<std::int64_t>(1 + stream_.below(3)) * kRandomNetUnit};
            }
            net_.schedule.push_back(s);
        }
    }

    RandomStream& stream_;
    Features has_;
    NetDraft net_;
    std::vector<bool> bound_;            // the variables of the transition that is being made
    std::vector<bool> taken_specially_;  // its places taken by now or all
};

// perm[old] = new
std::vector<std::uint32_t> permutation(std::size_t n, RandomStream& stream) {
    std::vector<std::uint32_t> perm(n);
    std::iota(perm.begin(), perm.end(), 0u);
    for (std::size_t i = n; i > 1; --i) {
        std::swap(perm[i - 1], perm[stream.below(i)]);
    }
    return perm;
}

template <class T>
std::vector<T> permuted(const std::vector<T>& items, const std::vector<std::uint32_t>& perm) {
    std::vector<T> out(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        out[perm[i]] = items[i];
    }
    return out;
}

std::string show_expr(const Expr& e, std::uint32_t at) {
    const Expr::Node& n = e.nodes()[at];
    switch (n.op) {
        case ExprOp::kLiteral:
            return std::to_string(n.literal);
        case ExprOp::kSlot: {
            const char* names[] = {"datum", "v", "#P", "#ready P", "attr"};
            return names[n.slot.kind] + std::to_string(n.slot.index);
        }
        default:
            return "op" + std::to_string(static_cast<int>(n.op)) + "(" + show_expr(e, n.a) + "," +
                   show_expr(e, n.b) + ")";
    }
}
std::string show_expr(const Expr& e) {
    return show_expr(e, static_cast<std::uint32_t>(e.nodes().size()) - 1);
}

std::string show_duration(const DurationDraft& d) {
    const auto unit = [](const Expr& e) {
        return e.is_literal() ? std::to_string(e.literal_value() / kRandomNetUnit)
                              : std::string("(expr)");
    };
    switch (d.kind) {
        case DurationKind::kExpression:
            return show_expr(d.a);
        case DurationKind::kConstant:
            return unit(d.a);
        case DurationKind::kInterval:
            return unit(d.a) + ".." + unit(d.b);
        case DurationKind::kAs:
            return "as #" + std::to_string(d.sibling.value);
        case DurationKind::kOpen:
            return "open";
        default:
            return "?";
    }
}

}  // namespace

net::NetDraft random_net(RandomStream& stream, const Features& features) {
    return Generator(stream, features).make();
}

net::NetDraft reordered(const net::NetDraft& draft, RandomStream& stream) {
    const std::vector<std::uint32_t> places = permutation(draft.places.size(), stream);
    const std::vector<std::uint32_t> transitions = permutation(draft.transitions.size(), stream);
    const std::vector<std::uint32_t> data = permutation(draft.data.size(), stream);
    const std::vector<std::uint32_t> events = permutation(draft.events.size(), stream);
    NetDraft out = draft;
    const auto place = [&](PlaceIndex& p) { p.value = p.valid() ? places[p.value] : p.value; };
    const auto expr = [&](Expr& e) {
        e.rename_slots([&](Slot s) {
            const auto kind = static_cast<SlotKind>(s.kind);
            if (kind == SlotKind::kCount || kind == SlotKind::kReady) {
                s.index = places[s.index];
            } else if (kind == SlotKind::kDatum) {
                s.index = data[s.index];
            }
            return s;
        });
    };
    const auto duration = [&](DurationDraft& d) {
        place(d.sibling);
        expr(d.a);
        expr(d.b);
        for (Expr& e : d.parameters) {
            expr(e);
        }
    };
    for (PlaceDraft& p : out.places) {
        if (p.duration) {
            duration(*p.duration);
        }
        expr(p.key);
    }
    for (EventDraft& e : out.events) {
        place(e.makes_ready);
        e.sets.value = e.sets.valid() ? data[e.sets.value] : e.sets.value;
    }
    for (ScheduledEvent& s : out.schedule) {
        s.event.value = events[s.event.value];
    }
    for (TransitionDraft& t : out.transitions) {
        for (ArcDraft& a : t.inputs) {
            place(a.place);
            for (PatternDraft& pattern : a.pattern) {
                expr(pattern.equals);
            }
        }
        for (OutputDraft& o : t.outputs) {
            place(o.place);
            for (Expr& e : o.attributes) {
                expr(e);
            }
            if (o.lasts) {
                expr(*o.lasts);
            }
        }
        for (AssignmentDraft& a : t.assignments) {
            a.datum.value = data[a.datum.value];
            expr(a.value);
        }
        for (std::optional<Expr>* e : {&t.guard, &t.odds}) {
            if (*e) {
                expr(**e);
            }
        }
        for (std::vector<EventIndex>* list : {&t.events, &t.raises}) {
            for (EventIndex& e : *list) {
                e.value = events[e.value];
            }
        }
        if (t.delay) {
            duration(t.delay->duration);
        }
    }
    out.places = permuted(out.places, places);
    out.transitions = permuted(out.transitions, transitions);
    out.data = permuted(out.data, data);
    out.events = permuted(out.events, events);
    return out;
}

std::string show(const net::NetDraft& draft) {
    std::string text;
    for (const PlaceDraft& p : draft.places) {
        text += "place " + p.path;
        text += p.duration ? " takes " + show_duration(*p.duration) : "";
        text += p.attributes.empty() ? "" : " (kind)";
        const char* disciplines[] = {"", " newest", " least", " most", " any"};
        text += disciplines[static_cast<int>(p.discipline)];
        text += p.by_arrival ? " by arrival" : "";
        text += p.keeps_order ? " keeps order" : "";
        text += p.capacity ? " holds " + std::to_string(*p.capacity) : "";
        for (const InitialToken& token : p.tokens) {
            text +=
                " tokens " + std::to_string(token.count) + (token.ready ? " ready" : "") +
                (token.attributes.empty() ? "" : "(" + std::to_string(token.attributes[0]) + ")");
        }
        text += "\n";
    }
    for (const DatumDraft& d : draft.data) {
        text += "datum " + d.path + " = " + std::to_string(d.initial) + "\n";
    }
    for (const EventDraft& e : draft.events) {
        text += "event " + e.path + (e.consumed ? " consumed" : "");
        text += e.sets.valid() ? " sets sensor to " + std::to_string(e.sets_to) : "";
        text +=
            e.makes_ready.valid() ? " makes ready " + draft.places[e.makes_ready.value].path : "";
        text += "\n";
    }
    for (const ScheduledEvent& s : draft.schedule) {
        text += "at " + std::to_string(s.at.ticks / kRandomNetUnit) + " " +
                draft.events[s.event.value].path +
                (s.every ? " every " + std::to_string(s.every->ticks / kRandomNetUnit) : "") + "\n";
    }
    for (const TransitionDraft& t : draft.transitions) {
        text += t.path + ":";
        const char* kinds[] = {"",      "now ",   "all ",    "all now ",
                               "with ", "while ", "unless ", "unless ready "};
        for (const ArcDraft& a : t.inputs) {
            text += std::string(" ") + kinds[static_cast<int>(a.kind)] + std::to_string(a.weight) +
                    "*" + draft.places[a.place.value].path;
            for (const PatternDraft& pattern : a.pattern) {
                text += pattern.binds ? "(v" + std::to_string(*pattern.binds) + ")"
                                      : "(=" + show_expr(pattern.equals) + ")";
            }
            text += a.time_left ? "(left v" + std::to_string(*a.time_left) + ")" : "";
        }
        text += " ->";
        for (const OutputDraft& o : t.outputs) {
            text += " " + std::to_string(o.weight) + "*" + draft.places[o.place.value].path;
            for (const Expr& e : o.attributes) {
                text += "(" + show_expr(e) + ")";
            }
            text += o.lasts ? " for " + show_expr(*o.lasts) : "";
        }
        text += " priority " + std::to_string(t.priority);
        text += t.guard ? " when " + show_expr(*t.guard) : "";
        for (const AssignmentDraft& a : t.assignments) {
            text += " set " + show_expr(a.value);
        }
        const char* memories[] = {"", " age", " resample"};
        text += t.delay ? " after " + show_duration(t.delay->duration) +
                              memories[static_cast<int>(t.delay->memory)]
                        : "";
        text +=
            t.delay && t.delay->servers != 1 ? " servers " + std::to_string(t.delay->servers) : "";
        text += t.holding ? " holding " + show_duration(*t.holding) : "";
        for (const EventIndex e : t.events) {
            text += " on " + draft.events[e.value].path;
        }
        for (const EventIndex e : t.raises) {
            text += " raises " + draft.events[e.value].path;
        }
        text += "\n";
    }
    return text;
}

}  // namespace puppetri::test
