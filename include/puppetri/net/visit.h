// SPDX-License-Identifier: MIT
// Walks over a draft: every expression, every mention of a place or a transition. One list of
// members, so that no rewriting forgets one.
#pragma once
#include "puppetri/net/draft.h"

namespace puppetri::net {

template <class F>
void each_expr(DurationDraft& d, F&& f) {
    f(d.a);
    f(d.b);
    for (Expr& p : d.parameters) {
        f(p);
    }
}

template <class F>
void each_expr(Formula& formula, F&& f) {
    for (Expr& e : formula.expressions) {
        f(e);
    }
}

template <class F>
void each_expr(PlaceDraft& p, F&& f) {
    f(p.key);
    if (p.duration) {
        each_expr(*p.duration, f);
    }
}

template <class F>
void each_expr(TransitionDraft& t, F&& f) {
    for (ArcDraft& arc : t.inputs) {
        for (PatternDraft& pattern : arc.pattern) {
            f(pattern.equals);
        }
    }
    for (OutputDraft& out : t.outputs) {
        for (Expr& e : out.attributes) {
            f(e);
        }
        if (out.lasts) {
            f(*out.lasts);
        }
    }
    if (t.guard) {
        f(*t.guard);
    }
    if (t.odds) {
        f(*t.odds);
    }
    if (t.delay) {
        each_expr(t.delay->duration, f);
    }
    if (t.holding) {
        each_expr(*t.holding, f);
    }
    for (AssignmentDraft& a : t.assignments) {
        f(a.value);
    }
}

template <class F>
void each_expr(ChannelDraft& c, F&& f) {
    for (std::vector<ChannelEnd>* ends : {&c.sends, &c.receives}) {
        for (ChannelEnd& end : *ends) {
            if (end.message) {
                f(*end.message);
            }
        }
    }
}

template <class F>
void each_formula(NetDraft& net, F&& f) {
    for (NamedState& s : net.states) {
        f(s.condition);
    }
    for (Rule& r : net.rules) {
        for (Formula& operand : r.operands) {
            f(operand);
        }
    }
    for (TimeQuestion& q : net.questions) {
        f(q.about);
    }
    for (FinalMarkingDraft& m : net.finals) {
        f(m.condition);
    }
}

template <class F>
void each_expr(NetDraft& net, F&& f) {
    for (PlaceDraft& p : net.places) {
        each_expr(p, f);
    }
    for (TransitionDraft& t : net.transitions) {
        each_expr(t, f);
    }
    for (ChannelDraft& c : net.channels) {
        each_expr(c, f);
    }
    each_formula(net, [&](Formula& formula) { each_expr(formula, f); });
    for (MeasureDraft& m : net.measures) {
        f(m.value);
        for (std::vector<Moment>* list : {&m.from, &m.to}) {
            for (Moment& moment : *list) {
                f(moment.value);
            }
        }
    }
}

inline bool speaks_of_place(FormulaOp op) {
    return op == FormulaOp::kMarked || op == FormulaOp::kReady;
}
inline bool speaks_of_transition(FormulaOp op) {
    return op == FormulaOp::kFires || op == FormulaOp::kFireable;
}
inline bool speaks_of_place(Slot s) {
    return s.kind == static_cast<std::uint32_t>(SlotKind::kCount) ||
           s.kind == static_cast<std::uint32_t>(SlotKind::kReady);
}

// Every mention of a place except the lists of fusions: f(std::uint32_t&).
template <class F>
void each_place_mention(NetDraft& net, F&& f) {
    for (PlaceDraft& p : net.places) {
        if (p.duration && p.duration->sibling.valid()) {
            f(p.duration->sibling.value);
        }
    }
    for (TransitionDraft& t : net.transitions) {
        for (ArcDraft& arc : t.inputs) {
            f(arc.place.value);
        }
        for (OutputDraft& out : t.outputs) {
            f(out.place.value);
        }
        if (t.busy.valid()) {
            f(t.busy.value);
        }
    }
    for (EventDraft& e : net.events) {
        if (e.makes_ready.valid()) {
            f(e.makes_ready.value);
        }
    }
    for (RefinementDraft& r : net.refinements) {
        f(r.place.value);
        for (std::vector<PlaceIndex>* list : {&r.start, &r.finish, &r.inside}) {
            for (PlaceIndex& p : *list) {
                f(p.value);
            }
        }
    }
    for (MeasureDraft& m : net.measures) {
        if (m.seen == Seen::kStays) {
            f(m.place.value);
        }
    }
    each_formula(net, [&](Formula& formula) {
        for (Formula::Node& n : formula.nodes) {
            if (speaks_of_place(n.op)) {
                f(n.index);
            }
        }
    });
    each_expr(net, [&](Expr& e) {
        e.rename_slots([&](Slot s) {
            if (speaks_of_place(s)) {
                f(s.index);
            }
            return s;
        });
    });
}

// Every mention of a transition except the lists of rendezvous and the ends of channels.
template <class F>
void each_transition_mention(NetDraft& net, F&& f) {
    for (TransitionDraft& t : net.transitions) {
        if (t.end.valid()) {
            f(t.end.value);
        }
    }
    for (Rule& r : net.rules) {
        for (TransitionIndex& t : r.transitions) {
            f(t.value);
        }
    }
    for (MeasureDraft& m : net.measures) {
        for (std::vector<Moment>* list : {&m.from, &m.to}) {
            for (Moment& moment : *list) {
                f(moment.transition.value);
            }
        }
    }
    each_formula(net, [&](Formula& formula) {
        for (Formula::Node& n : formula.nodes) {
            if (speaks_of_transition(n.op)) {
                f(n.index);
            }
        }
    });
}

}  // namespace puppetri::net
