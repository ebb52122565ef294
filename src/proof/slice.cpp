// SPDX-License-Identifier: MIT
// Slices and components of drafts: who depends on whom through arcs, data and events, and the draft
// of a part.
#include "puppetri/proof/slice.h"

#include <algorithm>

#include "disjoint_sets.h"
#include "puppetri/net/visit.h"

namespace puppetri::proof {

namespace {

using net::NetDraft;
using net::SlotKind;
using net::TransitionDraft;

constexpr std::uint32_t kNone = ~std::uint32_t{0};

// Nothing but beats: no duration, delay, holding, or schedule.
bool has_time(const NetDraft& draft) {
    return !draft.schedule.empty() ||
           std::any_of(draft.places.begin(), draft.places.end(),
                       [](const net::PlaceDraft& p) {
                           return p.duration.has_value() || p.action.valid();
                       }) ||
           std::any_of(draft.transitions.begin(), draft.transitions.end(),
                       [](const TransitionDraft& t) {
                           return t.delay.has_value() || t.holding.has_value();
                       });
}

// What an expression reads: visit(SlotKind, index) for data and places.
template <class Visit>
void each_read(const Expr& e, Visit visit) {
    for (const Expr::Node& n : e.nodes()) {
        if (n.op == ExprOp::kSlot) {
            const auto kind = static_cast<SlotKind>(n.slot.kind);
            if (kind == SlotKind::kDatum || kind == SlotKind::kCount || kind == SlotKind::kReady) {
                visit(kind == SlotKind::kDatum, n.slot.index);
            }
        }
    }
}

// The walks of net/visit.h change what they visit; these only look.
template <class Element, class Visit>
void each_read_of(const Element& element, Visit visit) {
    net::each_expr(const_cast<Element&>(element), [&](Expr& e) { each_read(e, visit); });
}

// Visits all that a transition touches: places (with its index), data, events.
template <class Place, class Datum, class Event>
void each_link(const TransitionDraft& t, Place place, Datum datum, Event event) {
    for (const net::ArcDraft& arc : t.inputs) {
        place(arc.place.value);
    }
    for (const net::OutputDraft& out : t.outputs) {
        place(out.place.value);
    }
    if (t.busy.valid()) {
        place(t.busy.value);
    }
    for (const net::AssignmentDraft& a : t.assignments) {
        datum(a.datum.value);
    }
    for (const auto* list : {&t.events, &t.raises}) {
        for (const net::EventIndex e : *list) {
            event(e.value);
        }
    }
    each_read_of(
        t, [&](bool is_datum, std::uint32_t index) { is_datum ? datum(index) : place(index); });
}

struct Kept {
    std::vector<std::uint8_t> place, transition, datum, event;
};

// The draft with what is kept, and new indices for all of it.
class Cut {
 public:
    Cut(const NetDraft& draft, const Kept& kept, const std::vector<net::Rule>& rules)
        : draft_(draft), rules_(rules) {
        number(kept.place, place_);
        number(kept.transition, transition_);
        number(kept.datum, datum_);
        number(kept.event, event_);
    }

    DraftSlice run() {
        NetDraft& to = out_.draft;
        to.name = draft_.name;
        to.enums = draft_.enums;
        to.host_atoms = draft_.host_atoms;
        pick(draft_.places, place_, to.places, out_.places);
        pick(draft_.transitions, transition_, to.transitions, out_.transitions);
        std::vector<std::uint32_t> ignored;
        pick(draft_.data, datum_, to.data, ignored);
        pick(draft_.events, event_, to.events, ignored);
        for (const net::ScheduledEvent& s : draft_.schedule) {
            if (event_[s.event.value] != kNone) {
                to.schedule.push_back(s);
                to.schedule.back().event.value = event_[s.event.value];
            }
        }
        for (const net::NamedState& s : draft_.states) {
            if (whole(s.condition)) {
                to.states.push_back(s);
            }
        }
        for (std::uint32_t i = 0; i < rules_.size(); ++i) {
            const net::Rule& r = rules_[i];
            if (std::all_of(r.operands.begin(), r.operands.end(),
                            [&](const net::Formula& f) { return whole(f); }) &&
                std::all_of(
                    r.transitions.begin(), r.transitions.end(),
                    [&](net::TransitionIndex t) { return transition_[t.value] != kNone; })) {
                to.rules.push_back(r);
                out_.rules.push_back(i);
            }
        }
        for (const net::TimeQuestion& q : draft_.questions) {
            if (whole(q.about)) {
                to.questions.push_back(q);
            }
        }
        for (const net::FinalMarkingDraft& f : draft_.finals) {
            if (whole(f.condition)) {
                to.finals.push_back(f);
            } else {
                out_.finals_left_out = true;
            }
        }
        for (TransitionDraft& t : to.transitions) {
            rename(t);
        }
        for (net::EventDraft& e : to.events) {
            if (e.sets.valid()) {
                e.sets.value = datum_[e.sets.value];
            }
            if (e.makes_ready.valid() && place_[e.makes_ready.value] == kNone) {
                e.makes_ready = {};
            }
        }
        net::each_place_mention(to, [&](std::uint32_t& p) { p = place_[p]; });
        net::each_transition_mention(to, [&](std::uint32_t& t) { t = transition_[t]; });
        net::each_formula(to, [&](net::Formula& f) {
            for (net::Formula::Node& n : f.nodes) {
                if (n.op == net::FormulaOp::kEvent) {
                    n.index = event_[n.index];
                }
            }
        });
        net::each_expr(to, [&](Expr& e) {
            e.rename_slots([&](Slot s) {
                if (s.kind == static_cast<std::uint32_t>(SlotKind::kDatum)) {
                    s.index = datum_[s.index];
                }
                return s;
            });
        });
        return std::move(out_);
    }

 private:
    static void number(const std::vector<std::uint8_t>& kept, std::vector<std::uint32_t>& to) {
        std::uint32_t next = 0;
        for (const std::uint8_t k : kept) {
            to.push_back(k != 0 ? next++ : kNone);
        }
    }
    template <class T>
    static void pick(const std::vector<T>& from, const std::vector<std::uint32_t>& now,
                     std::vector<T>& to, std::vector<std::uint32_t>& whole) {
        for (std::uint32_t i = 0; i < from.size(); ++i) {
            if (now[i] != kNone) {
                to.push_back(from[i]);
                whole.push_back(i);
            }
        }
    }

    void rename(TransitionDraft& t) const {
        for (auto* list : {&t.events, &t.raises}) {
            std::erase_if(*list, [&](net::EventIndex e) { return event_[e.value] == kNone; });
            for (net::EventIndex& e : *list) {
                e.value = event_[e.value];
            }
        }
        for (net::AssignmentDraft& a : t.assignments) {
            a.datum.value = datum_[a.datum.value];
        }
    }

    // The formula speaks only of what is kept.
    bool whole(const net::Formula& f) const {
        bool all = true;
        for (const net::Formula::Node& n : f.nodes) {
            if (net::speaks_of_place(n.op)) {
                all = all && place_[n.index] != kNone;
            } else if (net::speaks_of_transition(n.op)) {
                all = all && transition_[n.index] != kNone;
            } else if (n.op == net::FormulaOp::kEvent) {
                all = all && event_[n.index] != kNone;
            } else if (n.op == net::FormulaOp::kHost) {
                all = false;  // only the stage knows what it depends on
            }
        }
        for (const Expr& e : f.expressions) {
            each_read(e, [&](bool is_datum, std::uint32_t i) {
                all = all && (is_datum ? datum_[i] : place_[i]) != kNone;
            });
        }
        return all;
    }

    const NetDraft& draft_;
    const std::vector<net::Rule>& rules_;
    DraftSlice out_;
    std::vector<std::uint32_t> place_, transition_, datum_, event_;
};

Kept nothing(const NetDraft& draft) {
    return {std::vector<std::uint8_t>(draft.places.size(), 0),
            std::vector<std::uint8_t>(draft.transitions.size(), 0),
            std::vector<std::uint8_t>(draft.data.size(), 0),
            std::vector<std::uint8_t>(draft.events.size(), 0)};
}

class Closure {
 public:
    explicit Closure(const NetDraft& draft)
        : draft_(draft),
          kept_(nothing(draft)),
          of_place_(draft.places.size()),
          of_datum_(draft.data.size()),
          of_event_(draft.events.size()) {
        for (std::uint32_t t = 0; t < draft.transitions.size(); ++t) {
            const auto note = [t](std::vector<std::vector<std::uint32_t>>& lists) {
                return [&lists, t](std::uint32_t i) {
                    if (lists[i].empty() || lists[i].back() != t) {
                        lists[i].push_back(t);
                    }
                };
            };
            each_link(draft.transitions[t], note(of_place_), note(of_datum_), note(of_event_));
        }
        timeless_ = !has_time(draft);
    }

    void add(const SliceRoots& roots) {
        for (const std::uint32_t p : roots.places) {
            place(p);
        }
        for (const std::uint32_t t : roots.transitions) {
            transition(t);
        }
        for (const std::uint32_t d : roots.data) {
            datum(d);
        }
        for (const std::uint32_t e : roots.events) {
            event(e);
        }
    }

    Kept close() {
        while (!open_.empty()) {
            const Item item = open_.back();
            open_.pop_back();
            switch (item.kind) {
                case Item::kPlace:
                    follow_place(item.index);
                    break;
                case Item::kTransition:
                    follow_transition(item.index);
                    break;
                case Item::kDatum:
                    follow_datum(item.index);
                    break;
                case Item::kEvent:
                    follow_event(item.index);
                    break;
            }
        }
        return std::move(kept_);
    }

 private:
    struct Item {
        enum Kind : std::uint8_t { kPlace, kTransition, kDatum, kEvent };
        Kind kind = kPlace;
        std::uint32_t index = 0;
    };
    void keep(std::vector<std::uint8_t>& list, Item::Kind kind, std::uint32_t i) {
        if (list[i] == 0) {
            list[i] = 1;
            open_.push_back({kind, i});
        }
    }
    void place(std::uint32_t p) { keep(kept_.place, Item::kPlace, p); }
    void transition(std::uint32_t t) { keep(kept_.transition, Item::kTransition, t); }
    void datum(std::uint32_t d) { keep(kept_.datum, Item::kDatum, d); }
    void event(std::uint32_t e) { keep(kept_.event, Item::kEvent, e); }

    void follow_place(std::uint32_t p) {
        const net::PlaceDraft& draft = draft_.places[p];
        if (draft.duration && draft.duration->sibling.valid()) {
            place(draft.duration->sibling.value);
        }
        each_read_of(draft,
                     [&](bool is_datum, std::uint32_t i) { is_datum ? datum(i) : place(i); });
        for (const std::uint32_t t : of_place_[p]) {
            const TransitionDraft& u = draft_.transitions[t];
            const bool changes =
                std::any_of(u.inputs.begin(), u.inputs.end(),
                            [&](const net::ArcDraft& a) {
                                return a.place.value == p && a.kind != net::ArcKind::kRead &&
                                       a.kind != net::ArcKind::kReadNow &&
                                       a.kind != net::ArcKind::kUnless &&
                                       a.kind != net::ArcKind::kUnlessReady;
                            }) ||
                std::any_of(u.outputs.begin(), u.outputs.end(),
                            [&](const net::OutputDraft& o) { return o.place.value == p; }) ||
                u.busy.value == p;
            if (changes) {
                transition(t);
            }
        }
        for (std::uint32_t e = 0; e < draft_.events.size(); ++e) {
            if (draft_.events[e].makes_ready.value == p) {
                event(e);
            }
        }
    }

    void follow_transition(std::uint32_t t) {
        const TransitionDraft& draft = draft_.transitions[t];
        const auto rivals = [&](const std::vector<std::uint32_t>& others) {
            for (const std::uint32_t u : others) {
                if (draft_.transitions[u].priority > draft.priority) {
                    transition(u);
                }
            }
        };
        each_link(
            draft,
            [&](std::uint32_t p) {
                place(p);
                rivals(of_place_[p]);
            },
            [&](std::uint32_t d) {
                datum(d);
                rivals(of_datum_[d]);
            },
            [&](std::uint32_t e) {
                event(e);
                rivals(of_event_[e]);
            });
        if (timeless_) {
            for (std::uint32_t u = 0; u < draft_.transitions.size(); ++u) {
                if (draft_.transitions[u].priority > draft.priority) {
                    transition(u);
                }
            }
        }
        if (draft.end.valid()) {
            transition(draft.end.value);
        }
    }

    void follow_datum(std::uint32_t d) {
        for (const std::uint32_t t : of_datum_[d]) {
            const auto& list = draft_.transitions[t].assignments;
            if (std::any_of(list.begin(), list.end(),
                            [&](const net::AssignmentDraft& a) { return a.datum.value == d; })) {
                transition(t);
            }
        }
        for (std::uint32_t e = 0; e < draft_.events.size(); ++e) {
            if (draft_.events[e].sets.value == d) {
                event(e);
            }
        }
    }

    void follow_event(std::uint32_t e) {
        const net::EventDraft& draft = draft_.events[e];
        if (draft.sets.valid()) {
            datum(draft.sets.value);
        }
        if (draft.makes_ready.valid()) {
            place(draft.makes_ready.value);
        }
        for (const std::uint32_t t : of_event_[e]) {
            const TransitionDraft& u = draft_.transitions[t];
            const bool raises = std::any_of(u.raises.begin(), u.raises.end(),
                                            [&](net::EventIndex x) { return x.value == e; });
            if (raises || draft.consumed) {  // who uses it up takes it from the others
                transition(t);
            }
        }
    }

    const NetDraft& draft_;
    Kept kept_;
    std::vector<std::vector<std::uint32_t>> of_place_, of_datum_, of_event_;  // transitions
    std::vector<Item> open_;
    bool timeless_ = false;
};

}  // namespace

SliceRoots roots_of(const net::Rule& rule) {
    SliceRoots roots;
    for (const net::TransitionIndex t : rule.transitions) {
        roots.transitions.push_back(t.value);
    }
    for (const net::Formula& f : rule.operands) {
        for (const net::Formula::Node& n : f.nodes) {
            if (net::speaks_of_place(n.op)) {
                roots.places.push_back(n.index);
            } else if (net::speaks_of_transition(n.op)) {
                roots.transitions.push_back(n.index);
            } else if (n.op == net::FormulaOp::kEvent) {
                roots.events.push_back(n.index);
            }
        }
        for (const Expr& e : f.expressions) {
            each_read(e, [&](bool is_datum, std::uint32_t i) {
                (is_datum ? roots.data : roots.places).push_back(i);
            });
        }
    }
    return roots;
}

DraftSlice slice(const net::NetDraft& draft, const SliceRoots& roots) {
    Closure closure(draft);
    closure.add(roots);
    return Cut(draft, closure.close(), draft.rules).run();
}

Components components(const net::NetDraft& draft) {
    const auto places = static_cast<std::uint32_t>(draft.places.size());
    const auto transitions = static_cast<std::uint32_t>(draft.transitions.size());
    const auto data = static_cast<std::uint32_t>(draft.data.size());
    const auto events = static_cast<std::uint32_t>(draft.events.size());
    const std::uint32_t t0 = places, d0 = t0 + transitions, e0 = d0 + data;
    DisjointSets sets(e0 + events);
    for (std::uint32_t p = 0; p < places; ++p) {
        const net::PlaceDraft& place = draft.places[p];
        if (place.duration && place.duration->sibling.valid()) {
            sets.join(p, place.duration->sibling.value);
        }
        each_read_of(place,
                     [&](bool is_datum, std::uint32_t i) { sets.join(p, is_datum ? d0 + i : i); });
    }
    for (std::uint32_t t = 0; t < transitions; ++t) {
        const auto join = [&](std::uint32_t base) {
            return [&sets, base, t, t0](std::uint32_t i) { sets.join(base + i, t0 + t); };
        };
        each_link(draft.transitions[t], join(0), join(d0), join(e0));
        if (draft.transitions[t].end.valid()) {
            sets.join(t0 + t, t0 + draft.transitions[t].end.value);
        }
    }
    for (std::uint32_t e = 0; e < events; ++e) {
        if (draft.events[e].sets.valid()) {
            sets.join(e0 + e, d0 + draft.events[e].sets.value);
        }
        if (draft.events[e].makes_ready.valid()) {
            sets.join(e0 + e, draft.events[e].makes_ready.value);
        }
    }
    for (const net::RefinementDraft& r : draft.refinements) {
        for (const auto* list : {&r.start, &r.finish, &r.inside}) {
            for (const net::PlaceIndex p : *list) {
                sets.join(r.place.value, p.value);
            }
        }
    }
    for (const auto& fused : draft.fusions) {
        for (const net::PlaceIndex p : fused) {
            sets.join(fused.front().value, p.value);
        }
    }
    for (const auto& met : draft.rendezvous) {
        for (const net::TransitionIndex t : met) {
            sets.join(t0 + met.front().value, t0 + t.value);
        }
    }
    for (const net::ChannelDraft& channel : draft.channels) {
        if (channel.sends.empty()) {
            continue;
        }
        for (const auto* ends : {&channel.sends, &channel.receives}) {
            for (const net::ChannelEnd& end : *ends) {
                sets.join(t0 + channel.sends.front().transition.value, t0 + end.transition.value);
            }
        }
    }
    const bool many_priorities = std::any_of(
        draft.transitions.begin(), draft.transitions.end(),
        [&](const auto& t) { return t.priority != draft.transitions.front().priority; });
    if (many_priorities && !has_time(draft)) {
        for (std::uint32_t t = 1; t < transitions; ++t) {
            sets.join(t0, t0 + t);
        }
    }
    Components out;
    const std::vector<std::uint32_t> number = sets.numbered(out.count);
    out.of_place.assign(number.begin(), number.begin() + t0);
    out.of_transition.assign(number.begin() + t0, number.begin() + d0);
    out.of_datum.assign(number.begin() + d0, number.begin() + e0);
    out.of_event.assign(number.begin() + e0, number.end());
    return out;
}

DraftSlice component(const net::NetDraft& draft, const Components& parts, std::uint32_t which,
                     const std::vector<net::Rule>& rules) {
    Kept kept = nothing(draft);
    const auto mark = [&](const std::vector<std::uint32_t>& of, std::vector<std::uint8_t>& list) {
        for (std::size_t i = 0; i < of.size(); ++i) {
            list[i] = of[i] == which ? 1 : 0;
        }
    };
    mark(parts.of_place, kept.place);
    mark(parts.of_transition, kept.transition);
    mark(parts.of_datum, kept.datum);
    mark(parts.of_event, kept.event);
    return Cut(draft, kept, rules).run();
}

DraftSlice component(const net::NetDraft& draft, const Components& parts, std::uint32_t which) {
    return component(draft, parts, which, draft.rules);
}

}  // namespace puppetri::proof
