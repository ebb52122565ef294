// SPDX-License-Identifier: MIT
// From a checked, lowered draft to tables: which places need records, what each transition waits
// for, what is special about it. The aim is that an ordinary firing touches two short rows and the
// watchers of the places it changes.
#include <algorithm>
#include <map>

#include "check.h"
#include "lower.h"
#include "puppetri/base/hash.h"
#include "puppetri/net/net.h"
#include "puppetri/net/tables.h"

namespace puppetri::net {

namespace {

constexpr std::size_t kMaxFifos = 16;  // distinct constant durations with a queue of their own

template <class T>
Rows<T> make_rows(std::uint32_t count, std::vector<std::pair<std::uint32_t, T>> entries) {
    Rows<T> rows;
    rows.starts.assign(count + 1, 0);
    for (const auto& e : entries) {
        ++rows.starts[e.first + 1];
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        rows.starts[i + 1] += rows.starts[i];
    }
    rows.items.resize(entries.size());
    std::vector<std::uint32_t> next(rows.starts.begin(), rows.starts.end() - 1);
    for (auto& e : entries) {
        rows.items[next[e.first]++] = std::move(e.second);
    }
    return rows;
}

class Compiler {
 public:
    Compiler(Lowered lowered, Diagnostics& defects, NetTables& out)
        : lowered_(std::move(lowered)), net_(lowered_.net), defects_(defects), out_(out) {}

    void run() {
        name_everything();
        classify_places();
        layout_places();
        collect_clean();
        for (std::uint32_t t = 0; t < net_.transitions.size(); ++t) {
            layout_transition(t);
        }
        finish_rows();
        order_initial();
        keep_declarations();
        hash();
    }

 private:
    using Entry = std::pair<std::uint32_t, std::uint32_t>;

    ProgramIndex program(const Expr& e, const SourceSpan& where, const std::string& element) {
        Result<ProgramIndex, ExprError> p = out_.code.add(e);
        if (!p) {
            report(defects_, "expression-too-deep", where, element, p.error().message,
                   "split the expression");
            return {};
        }
        return *p;
    }

    void name_everything() {
        const auto add = [](Names& names, const auto& list) {
            names.reserve(static_cast<std::uint32_t>(list.size()));
            for (const auto& item : list) {
                names.add(item.path, item.caption, item.where);
            }
        };
        add(out_.places, net_.places);
        add(out_.transitions, net_.transitions);
        add(out_.data, net_.data);
        add(out_.events, net_.events);
        out_.places.sort(std::move(lowered_.place_aliases));
        out_.transitions.sort();
        out_.data.sort();
        out_.events.sort();
        out_.place_map = std::move(lowered_.place_map);
        out_.transition_map = std::move(lowered_.transition_map);
    }

    void classify_places() {
        const std::size_t count = net_.places.size();
        out_.place.assign(count + 1, PlaceRow{});
        const auto raise = [&](std::uint32_t p, PlaceKind kind) {
            out_.place[p].kind = std::max(out_.place[p].kind, kind);
        };
        std::vector<bool> zero(count);
        out_.paced =
            net_.schedule.empty() && std::none_of(net_.events.begin(), net_.events.end(),
                                                  [](const EventDraft& e) { return e.crossing; });
        for (std::uint32_t p = 0; p < count; ++p) {
            const PlaceDraft& place = net_.places[p];
            const DurationDraft d = effective_duration(place);
            zero[p] = d.kind == DurationKind::kConstant && d.a.literal_value() == 0;
            out_.paced = out_.paced &&
                         (zero[p] || d.kind == DurationKind::kOpen || d.kind == DurationKind::kAs);
            if (!zero[p]) {
                raise(p, PlaceKind::kTimed);
            }
            if (!place.attributes.empty() || place.action.valid() ||
                d.kind == DurationKind::kOpen ||
                ((place.keeps_order || place.by_arrival) && d.kind != DurationKind::kConstant)) {
                raise(p, PlaceKind::kRich);
            }
        }
        for (const MeasureDraft& m : net_.measures) {
            // Who leaves when is known of records alone, but for the usual order
            if (m.seen == Seen::kStays &&
                net_.places[m.place.value].discipline != Discipline::kOldest) {
                raise(m.place.value, PlaceKind::kRich);
            }
        }
        for (const TransitionDraft& t : net_.transitions) {
            out_.paced = out_.paced && !t.delay;
            for (const OutputDraft& o : t.outputs) {
                if (o.lasts) {
                    out_.paced = false;
                    raise(o.place.value, net_.places[o.place.value].keeps_order
                                             ? PlaceKind::kRich
                                             : PlaceKind::kTimed);
                }
            }
        }
        for (const TransitionDraft& t : net_.transitions) {
            for (const ArcDraft& arc : t.inputs) {
                const bool now = arc.kind == ArcKind::kTakeNow || arc.kind == ArcKind::kTakeAllNow;
                if (arc.time_left ||
                    (now && out_.place[arc.place.value].kind != PlaceKind::kCount)) {
                    raise(arc.place.value, PlaceKind::kRich);
                }
            }
        }
    }

    DurationTable duration(const DurationDraft& d, const SourceSpan& where,
                           const std::string& element) {
        DurationTable table;
        table.kind = d.kind;
        switch (d.kind) {
            case DurationKind::kConstant:
                table.ticks = d.a.literal_value();
                break;
            case DurationKind::kInterval:
                table.b = program(d.b, where, element);
                [[fallthrough]];
            case DurationKind::kExpression:
                table.a = program(d.a, where, element);
                break;
            case DurationKind::kDistribution: {
                table.distribution = d.distribution;
                bool constant = true;
                for (const Expr& e : d.parameters) {
                    table.parameters.push_back({program(e, where, element), e.type().kind});
                    constant = constant && e.is_literal();
                }
                for (const Expr& e : d.parameters) {
                    if (constant) {
                        const Value v = e.literal_value();
                        table.constants.push_back(
                            e.type().kind == ValueKind::kReal   ? real_of_value(v)
                            : e.type().kind == ValueKind::kTime ? SimTime{v}.seconds()
                                                                : static_cast<double>(v));
                    }
                }
                break;
            }
            case DurationKind::kAs:
                table.sibling = d.sibling.value;
                break;
            case DurationKind::kAuto:
            case DurationKind::kOpen:
                break;
        }
        return table;
    }

    void layout_places() {
        const auto count = static_cast<std::uint32_t>(net_.places.size());
        std::map<std::int64_t, std::uint32_t> constants;  // ticks -> duration
        for (std::uint32_t p = 0; p < count; ++p) {
            const PlaceDraft& place = net_.places[p];
            if (out_.place[p].kind == PlaceKind::kRich) {
                layout_rich(p, place);
            }
            const DurationDraft d = effective_duration(place);
            if (d.kind == DurationKind::kConstant) {
                const std::int64_t ticks = d.a.literal_value();
                if (ticks == 0) {
                    continue;
                }
                const auto known = constants.find(ticks);
                if (known != constants.end()) {
                    out_.place[p].duration = known->second;
                    continue;
                }
                constants[ticks] = static_cast<std::uint32_t>(out_.durations.size());
            }
            DurationTable table = duration(d, place.where, "place " + place.path);
            if (d.kind == DurationKind::kInterval || d.kind == DurationKind::kDistribution) {
                table.stream = out_.duration_streams++;
                out_.stream_place.push_back(p);
            }
            if (d.kind == DurationKind::kConstant && out_.fifo_ticks.size() < kMaxFifos) {
                table.fifo = static_cast<std::uint32_t>(out_.fifo_ticks.size());
                out_.fifo_ticks.push_back(table.ticks);
            }
            out_.place[p].duration = static_cast<std::uint32_t>(out_.durations.size());
            out_.durations.push_back(std::move(table));
        }
    }

    void layout_rich(std::uint32_t p, const PlaceDraft& place) {
        if (out_.place_rich.empty()) {
            out_.place_rich.assign(net_.places.size(), kNoIndex);
        }
        RichPlaceTable r;
        r.place = p;
        r.attributes = static_cast<std::uint32_t>(place.attributes.size());
        r.discipline = place.discipline;
        r.by_arrival = place.by_arrival;
        r.keeps_order = place.keeps_order;
        r.action = place.action;
        if (place.discipline == Discipline::kLeast || place.discipline == Discipline::kMost) {
            r.key = program(place.key, place.where, "place " + place.path);
            r.key_is_real = place.key.type().kind == ValueKind::kReal;
        }
        if (place.discipline == Discipline::kAny) {
            r.token_stream = out_.token_streams++;
            out_.token_stream_place.push_back(p);
        }
        out_.place_rich[p] = static_cast<std::uint32_t>(out_.rich.size());
        out_.rich.push_back(r);
    }

    std::uint32_t rich_of(std::uint32_t p) const {
        return out_.place_rich.empty() ? kNoIndex : out_.place_rich[p];
    }

    void collect_clean() {
        clean_.resize(net_.transitions.size());
        for (const Lowered::Clean& c : lowered_.clean) {
            clean_[c.transition].push_back(c.refinement);
        }
    }

    // How long the chain `as Q as R ...` from a place is: siblings come first.
    std::uint32_t as_depth(std::uint32_t p) const {
        std::uint32_t depth = 0;
        while (out_.place[p].duration != kNoIndex) {
            const DurationTable& d = out_.durations[out_.place[p].duration];
            if (d.kind != DurationKind::kAs || depth > net_.places.size()) {
                break;
            }
            p = d.sibling;
            ++depth;
        }
        return depth;
    }

    // What one transition wants of one place.
    struct Demand {
        std::int64_t take = 0, now = 0, read = 0, read_now = 0, unless = 0, unless_ready = 0;
        std::int64_t give = 0;
        bool now_all = false;
    };

    void layout_transition(std::uint32_t t) {
        const TransitionDraft& draft = net_.transitions[t];
        const std::string element = "transition " + draft.path;
        Special special;
        special.transition = t;
        special.variables = static_cast<std::uint32_t>(draft.variables.size());
        std::uint8_t flags = 0;
        std::map<std::uint32_t, Demand> demands;
        std::map<std::uint32_t, std::uint32_t> takes, gives;
        for (const ArcDraft& arc : draft.inputs) {
            layout_arc(arc, element, special, demands, takes);
        }
        std::stable_partition(special.arcs.begin(), special.arcs.end(), [](const ArcTable& a) {
            return a.kind != ArcKind::kTakeAll && a.kind != ArcKind::kTakeAllNow;
        });
        layout_outputs(draft, element, special, demands, gives);
        TransitionRow row;
        row.takes = static_cast<std::uint32_t>(out_.arcs.size());
        for (const auto& [p, w] : takes) {
            out_.arcs.push_back({p, w});
        }
        row.gives = static_cast<std::uint32_t>(out_.arcs.size());
        for (const auto& [p, w] : gives) {
            out_.arcs.push_back({p, w});
        }
        const bool conditional = watch(t, demands);
        if (!conditional) {
            out_.unconditional.push_back(t);
        }

        std::vector<const Expr*> reads;  // what decides whether it is marked
        if (draft.guard) {
            special.guard = program(*draft.guard, draft.where, element);
            reads.push_back(&*draft.guard);
        }
        for (const ArcDraft& arc : draft.inputs) {
            for (const PatternDraft& pattern : arc.pattern) {
                if (!pattern.binds) {
                    reads.push_back(&pattern.equals);
                }
            }
            if (!arc.pattern.empty() || arc.time_left) {
                special.searches = true;
            }
        }
        if (draft.odds) {
            const ValueType type = draft.odds->type();
            if (draft.odds->is_literal()) {
                const Value v = draft.odds->literal_value();
                special.constant_odds =
                    type.kind == ValueKind::kReal ? real_of_value(v) : static_cast<double>(v);
            } else {
                special.odds = program(*draft.odds, draft.where, element);
                special.odds_is_int = type.kind == ValueKind::kInt;
                reads.push_back(&*draft.odds);
            }
            if (special.odds.valid() || special.constant_odds != 1) {
                flags |= kHasOdds;
            }
        }
        special.depends = special.searches || draft.guard || special.odds.valid();
        if (draft.delay) {
            DelayTable delay;
            delay.transition = t;
            delay.duration = duration(draft.delay->duration, draft.where, element);
            delay.memory = draft.delay->memory;
            delay.servers = draft.delay->servers;
            special.delay = static_cast<std::uint32_t>(out_.delays.size());
            if (delay.servers > 1) {
                layout_degree(demands, special);
                special.depends = true;
            }
            out_.delays.push_back(std::move(delay));
        }
        for (const EventIndex e : draft.events) {
            special.events.push_back(e.value);
            listeners_.push_back({e.value, t});
        }
        special.next_event = draft.next_event;
        for (const EventIndex e : draft.raises) {
            special.raises.push_back(e.value);
        }
        for (const AssignmentDraft& a : draft.assignments) {
            special.assignments.emplace_back(a.datum.value, program(a.value, draft.where, element));
        }
        special.must_be_clean = clean_[t];
        if (special.depends) {
            note_dependents(t, draft, reads, special);
        }

        if (special.searches || draft.guard || draft.delay || !draft.events.empty()) {
            flags |= kGated;
        }
        const bool arcs_act =
            std::any_of(special.arcs.begin(), special.arcs.end(),
                        [](const ArcTable& a) { return a.kind <= ArcKind::kTakeAllNow; });
        if (arcs_act || !special.outputs.empty() || draft.delay || !draft.events.empty() ||
            !draft.raises.empty() || !draft.assignments.empty() || !special.must_be_clean.empty()) {
            flags |= kFiresSpecially;
        }
        if (draft.delay && draft.delay->servers == 1 && !special.depends &&
            special.events.empty() && draft.delay->memory == DelayMemory::kEnabling &&
            special.arcs.empty() && special.outputs.empty() && special.raises.empty() &&
            special.assignments.empty() && special.must_be_clean.empty()) {
            flags |= kOnlyDelayed;
        }
        row.flags = flags;
        if (flags != 0) {
            row.special = static_cast<std::uint32_t>(out_.specials.size());
            out_.specials.push_back(std::move(special));
        }
        out_.transition.push_back(row);
        priorities_.push_back(draft.priority);
    }

    void layout_arc(const ArcDraft& arc, const std::string& element, Special& special,
                    std::map<std::uint32_t, Demand>& demands,
                    std::map<std::uint32_t, std::uint32_t>& takes) {
        const std::uint32_t p = arc.place.value;
        const std::uint32_t rich = rich_of(p);
        const auto weight = static_cast<std::uint32_t>(arc.weight);
        Demand& demand = demands[p];
        const bool patterned = !arc.pattern.empty();
        switch (arc.kind) {
            case ArcKind::kTake:
                demand.take += weight;
                break;
            case ArcKind::kTakeNow:
                demand.now += weight;
                break;
            case ArcKind::kTakeAll:
                break;
            case ArcKind::kTakeAllNow:
                demand.now_all = demand.now_all || !patterned;
                break;
            case ArcKind::kRead:
                demand.read += weight;
                break;
            case ArcKind::kReadNow:
                demand.read_now += weight;
                break;
            // A pattern makes its own count: the number of all tokens says nothing.
            case ArcKind::kUnless:
                demand.unless += patterned ? 0 : weight;
                break;
            case ArcKind::kUnlessReady:
                demand.unless_ready += patterned ? 0 : weight;
                break;
        }
        if (rich == kNoIndex && (arc.kind == ArcKind::kTake || arc.kind == ArcKind::kTakeNow)) {
            takes[p] += weight;
            return;
        }
        const bool plain_test = !patterned && !arc.time_left && arc.kind >= ArcKind::kRead;
        if (plain_test) {
            return;  // the watchers say all
        }
        ArcTable table;
        table.kind = arc.kind;
        table.place = p;
        table.rich = rich;
        table.weight = weight;
        if (arc.time_left) {
            table.time_left = *arc.time_left;
        }
        for (const PatternDraft& pattern : arc.pattern) {
            PatternTable pt;
            pt.attribute = pattern.attribute;
            if (pattern.binds) {
                pt.binds = *pattern.binds;
            } else {
                pt.equals = program(pattern.equals, arc.where, element);
            }
            table.pattern.push_back(pt);
        }
        special.arcs.push_back(std::move(table));
    }

    void layout_outputs(const TransitionDraft& draft, const std::string& element, Special& special,
                        std::map<std::uint32_t, Demand>& demands,
                        std::map<std::uint32_t, std::uint32_t>& gives) {
        bool siblings = false;  // then all timed outputs go one after another
        for (const OutputDraft& out : draft.outputs) {
            siblings = siblings || (!out.lasts && as_depth(out.place.value) > 0);
        }
        for (const OutputDraft& out : draft.outputs) {
            const std::uint32_t p = out.place.value;
            const auto weight = static_cast<std::uint32_t>(out.weight);
            demands[p].give += weight;
            const bool timed = out_.place[p].kind != PlaceKind::kCount;
            if (rich_of(p) == kNoIndex && !out.lasts && !siblings) {
                gives[p] += weight;
                continue;
            }
            if (!timed && !siblings) {
                gives[p] += weight;
                continue;
            }
            OutputTable table;
            table.place = p;
            table.rich = rich_of(p);
            table.weight = weight;
            for (const Expr& e : out.attributes) {
                table.attributes.push_back(program(e, out.where, element));
            }
            if (out.lasts) {
                table.lasts = program(*out.lasts, out.where, element);
            }
            special.outputs.push_back(std::move(table));
        }
        std::stable_sort(special.outputs.begin(), special.outputs.end(),
                         [this](const OutputTable& a, const OutputTable& b) {
                             return (a.lasts.valid() ? 0 : as_depth(a.place)) <
                                    (b.lasts.valid() ? 0 : as_depth(b.place));
                         });
    }

    // The conditions on counts. False: there are none.
    bool watch(std::uint32_t t, const std::map<std::uint32_t, Demand>& demands) {
        bool any = false;
        for (const auto& row : demands) {
            // By name, not by structured binding: clang 14 does not capture those.
            const std::uint32_t p = row.first;
            const Demand& d = row.second;
            const bool counted = out_.place[p].kind == PlaceKind::kCount;
            const auto need = [&](bool ready, std::int64_t threshold, bool inhibits) {
                const Watcher w{t | (inhibits ? Watcher::kInhibits : 0),
                                static_cast<std::uint32_t>(
                                    std::clamp<std::int64_t>(threshold, 0, 0xFFFF'FFFF))};
                (ready || counted ? ready_watchers_ : total_watchers_).push_back({p, w});
                any = true;
            };
            const std::int64_t take = counted ? d.take + d.now : d.take;
            if (take > 0) {
                need(true, take, false);
            }
            if (!counted && d.now > 0) {
                need(false, d.now + d.take, false);
            }
            if (d.read > 0) {
                need(true, d.read, false);
            }
            if (d.read_now > 0) {
                need(false, d.read_now, false);
            }
            if (d.unless > 0) {
                need(false, d.unless, true);
            }
            if (d.unless_ready > 0) {
                need(true, d.unless_ready, true);
            }
            const auto& capacity = net_.places[p].capacity;
            const std::int64_t gain = d.give - d.take - d.now;
            if (capacity && d.now_all) {
                if (d.give > std::int64_t{*capacity}) {
                    need(false, 0, true);  // too much even for the emptied place
                }
            } else if (capacity && gain > 0) {
                need(false, std::int64_t{*capacity} - gain + 1, true);
            }
        }
        return any;
    }

    // How often a multi-server transition is enabled: the least of tokens / weight over its inputs,
    // ready ones or, for `now`, all.
    static void layout_degree(const std::map<std::uint32_t, Demand>& demands, Special& special) {
        for (const auto& [p, d] : demands) {
            if (d.take > 0) {
                special.degree.push_back({p, static_cast<std::uint32_t>(d.take)});
            }
            if (d.now > 0) {
                special.degree_now.push_back({p, static_cast<std::uint32_t>(d.take + d.now)});
            }
        }
    }

    void note_dependents(std::uint32_t t, const TransitionDraft& draft,
                         const std::vector<const Expr*>& reads, const Special& special) {
        std::vector<std::uint32_t> places, data;
        for (const Expr* e : reads) {
            for (const Expr::Node& n : e->nodes()) {
                if (n.op != ExprOp::kSlot) {
                    continue;
                }
                const auto kind = static_cast<SlotKind>(n.slot.kind);
                if (kind == SlotKind::kDatum) {
                    data.push_back(n.slot.index);
                } else if (kind == SlotKind::kCount || kind == SlotKind::kReady) {
                    places.push_back(n.slot.index);
                }
            }
        }
        if (special.searches) {
            for (const ArcDraft& arc : draft.inputs) {
                places.push_back(arc.place.value);
            }
        }
        for (const auto* degree : {&special.degree, &special.degree_now}) {
            for (const Weighted& w : *degree) {
                places.push_back(w.place);
            }
        }
        const auto add = [t](std::vector<std::uint32_t>& from, std::vector<Entry>& to) {
            std::sort(from.begin(), from.end());
            from.erase(std::unique(from.begin(), from.end()), from.end());
            for (const std::uint32_t i : from) {
                to.push_back({i, t});
            }
        };
        add(places, place_dependents_);
        add(data, datum_dependents_);
    }

    void finish_rows() {
        const auto places = static_cast<std::uint32_t>(net_.places.size());
        const Rows<Watcher> ready = make_rows(places, std::move(ready_watchers_));
        const Rows<Watcher> total = make_rows(places, std::move(total_watchers_));
        out_.place_dependents = make_rows(places, std::move(place_dependents_));
        const auto with_gate = [&](Watcher w) {
            if ((out_.transition[w.transition()].flags & kGated) != 0) {
                w.word |= Watcher::kGated;
            }
            return w;
        };
        out_.watchers.reserve(ready.items.size() + total.items.size());
        for (std::uint32_t p = 0; p < places; ++p) {
            PlaceRow& row = out_.place[p];
            row.ready = static_cast<std::uint32_t>(out_.watchers.size());
            for (const Watcher& w : ready.row(p)) {
                out_.watchers.push_back(with_gate(w));
            }
            row.total = static_cast<std::uint32_t>(out_.watchers.size());
            for (const Watcher& w : total.row(p)) {
                out_.watchers.push_back(with_gate(w));
            }
            if (row.ready != row.total) {
                row.first = out_.watchers[row.ready];
            }
            row.has_dependents = !out_.place_dependents.row(p).empty();
        }
        out_.place[places].ready = static_cast<std::uint32_t>(out_.watchers.size());
        TransitionRow end;
        end.takes = end.gives = static_cast<std::uint32_t>(out_.arcs.size());
        out_.transition.push_back(end);
        out_.datum_dependents =
            make_rows(static_cast<std::uint32_t>(net_.data.size()), std::move(datum_dependents_));
        out_.event_listeners =
            make_rows(static_cast<std::uint32_t>(net_.events.size()), std::move(listeners_));
        out_.level_priority = priorities_;
        std::sort(out_.level_priority.begin(), out_.level_priority.end(),
                  [](std::int64_t a, std::int64_t b) { return a > b; });
        out_.level_priority.erase(
            std::unique(out_.level_priority.begin(), out_.level_priority.end()),
            out_.level_priority.end());
        if (out_.level_priority.size() > 0xFFFF) {
            report(defects_, "net-too-large", {}, "net " + net_.name,
                   "more than 65535 different priorities", "use fewer");
            return;
        }
        out_.level_has_odds.assign(out_.level_priority.size(), 0);
        for (std::uint32_t t = 0; t < priorities_.size(); ++t) {
            const std::int64_t priority = priorities_[t];
            const auto it =
                std::lower_bound(out_.level_priority.begin(), out_.level_priority.end(), priority,
                                 [](std::int64_t a, std::int64_t b) { return a > b; });
            out_.transition[t].level = static_cast<std::uint16_t>(it - out_.level_priority.begin());
            if ((out_.transition[t].flags & kHasOdds) != 0) {
                out_.level_has_odds[out_.transition[t].level] = 1;
            }
        }
    }

    void order_initial() {
        for (std::uint32_t p = 0; p < net_.places.size(); ++p) {
            for (InitialToken& token : net_.places[p].tokens) {
                if (token.count > 0) {
                    out_.initial.push_back(
                        {p, token.count, token.ready, std::move(token.attributes)});
                }
            }
        }
        std::stable_sort(out_.initial.begin(), out_.initial.end(),
                         [this](const NetTables::Initial& a, const NetTables::Initial& b) {
                             return as_depth(a.place) < as_depth(b.place);
                         });
    }

    ProgramIndex measure_program(const Expr& e, const MeasureDraft& m) {
        auto added = out_.measure_code.add(e);
        if (!added) {
            report(defects_, "expression-too-deep", m.where, "measure " + m.path,
                   added.error().message, "measure its parts");
            return {};
        }
        return *added;
    }

    void keep_declarations() {
        for (FinalMarkingDraft& f : net_.finals) {
            NetTables::FinalMarking m;
            m.condition = f.condition;
            for (const Expr& e : f.condition.expressions) {
                m.programs.push_back(program(e, f.where, "end"));
            }
            out_.finals.push_back(std::move(m));
        }
        for (const MeasureDraft& m : net_.measures) {
            NetTables::MeasurePrograms& programs = out_.measures.emplace_back();
            programs.value = measure_program(m.value, m);
            for (const Moment& moment : m.from) {
                programs.from.push_back(measure_program(moment.value, m));
            }
            for (const Moment& moment : m.to) {
                programs.to.push_back(measure_program(moment.value, m));
            }
        }
        std::vector<PlaceDraft>().swap(net_.places);
        std::vector<TransitionDraft>().swap(net_.transitions);
        out_.declarations = std::move(net_);
        out_.refinements = std::move(lowered_.refinements);
    }

    void hash() {
        Hash64 h;
        for (const Names* names : {&out_.places, &out_.transitions, &out_.data, &out_.events}) {
            for (std::uint32_t i = 0; i < names->size(); ++i) {
                h.add_text(names->path(i));
            }
        }
        for (const TransitionRow& t : out_.transition) {
            h.add_u64(t.takes).add_u64(t.gives).add_u64(t.flags);
        }
        for (const Weighted& w : out_.arcs) {
            h.add_u64(w.place).add_u64(w.weight);
        }
        for (const PlaceRow& p : out_.place) {
            h.add_u64(p.ready).add_u64(p.total).add_u64(p.duration);
        }
        for (const Watcher& w : out_.watchers) {
            h.add_u64(w.word).add_u64(w.threshold);
        }
        for (const std::int64_t p : priorities_) {
            h.add_i64(p);
        }
        for (const DurationTable& d : out_.durations) {
            h.add_u64(static_cast<std::uint64_t>(d.kind)).add_i64(d.ticks);
            h.add_u64(static_cast<std::uint64_t>(d.distribution));
            for (const double x : d.constants) {
                h.add_f64(x);
            }
        }
        for (const NetTables::Initial& i : out_.initial) {
            h.add_u64(i.place).add_u64(i.count).add_u64(i.ready ? 1 : 0);
            for (const Value v : i.attributes) {
                h.add_i64(v);
            }
        }
        for (const Special& s : out_.specials) {
            h.add_u64(s.transition).add_u64(s.arcs.size()).add_u64(s.outputs.size());
            h.add_u64(s.guard.value).add_u64(s.odds.value).add_f64(s.constant_odds);
            if (s.next_event) {
                h.add_text("next");
            }
        }
        for (const RichPlaceTable& r : out_.rich) {  // what has always been so changes no hash
            if (r.by_arrival) {
                h.add_u64(r.place).add_u64(static_cast<std::uint64_t>(r.discipline));
            }
        }
        h.add_u64(out_.code.hash());
        out_.hash = h.value();
    }

    Lowered lowered_;
    NetDraft& net_;
    Diagnostics& defects_;
    NetTables& out_;
    std::vector<std::pair<std::uint32_t, Watcher>> ready_watchers_, total_watchers_;
    std::vector<Entry> place_dependents_, datum_dependents_, listeners_;
    std::vector<std::int64_t> priorities_;
    std::vector<std::vector<std::uint32_t>> clean_;
};

}  // namespace

Checked<Net> compile(const NetDraft& draft) {
    Diagnostics defects;
    Lowered lowered = lower_draft(draft, defects);
    // All defects are told at once; only a draft that mentions what it does not have cannot be
    // looked at further.
    const bool well_formed = std::none_of(defects.begin(), defects.end(), [](const Diagnostic& d) {
        return d.code == "unknown-index";
    });
    if (well_formed) {
        check_lowered(lowered.net, defects);
    }
    if (has_errors(defects)) {
        return Unexpected(std::move(defects));
    }
    Net net;
    Compiler(std::move(lowered), defects, *net.tables_).run();
    if (has_errors(defects)) {
        return Unexpected(std::move(defects));
    }
    net.tables_->notes = std::move(defects);
    return net;
}

}  // namespace puppetri::net
