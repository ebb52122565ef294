// SPDX-License-Identifier: MIT
// Composition as rewriting of the draft: fused places become one, what meets becomes one transition
// (meet.cpp), `for d` becomes begin -> busy -> end, and a refined place gets its module's start and
// finish into its arcs. Afterwards nothing of these is left, so that simulator and prover never
// hear of them.
#include "lower.h"

#include <algorithm>

#include "check.h"
#include "classes.h"
#include "puppetri/net/net.h"
#include "puppetri/net/visit.h"

namespace puppetri::net {

void report(Diagnostics& list, const char* code, const SourceSpan& where, std::string element,
            std::string message, std::string remedy, Severity severity) {
    list.push_back(
        {severity, code, where, std::move(element), std::move(message), std::move(remedy)});
}

DurationDraft effective_duration(const PlaceDraft& p) {
    if (p.duration) {
        return *p.duration;
    }
    DurationDraft d;
    d.kind = p.action.valid() ? DurationKind::kAuto : DurationKind::kConstant;
    return d;
}
namespace {

bool same_duration(const DurationDraft& x, const DurationDraft& y) {
    return x.kind == y.kind && x.a == y.a && x.b == y.b && x.sibling == y.sibling &&
           (x.kind != DurationKind::kDistribution ||
            (x.distribution == y.distribution && x.parameters == y.parameters));
}

bool same_attributes(const PlaceDraft& x, const PlaceDraft& y) {
    return std::equal(x.attributes.begin(), x.attributes.end(), y.attributes.begin(),
                      y.attributes.end(), [](const AttributeDraft& a, const AttributeDraft& b) {
                          return a.name == b.name && a.type == b.type;
                      });
}

class Lowering {
 public:
    Lowering(const NetDraft& draft, Diagnostics& defects) : defects_(defects) { out_.net = draft; }

    Lowered run() {
        if (!indices_are_valid()) {
            return std::move(out_);
        }
        fuse();
        meet();
        hold();
        refine();
        return std::move(out_);
    }

 private:
    NetDraft& net() { return out_.net; }

    bool indices_are_valid() {
        const std::size_t before = defects_.size();
        const auto bad = [&](const char* what) {
            report(defects_, "unknown-index", {}, "net " + net().name,
                   std::string("a ") + what + " is mentioned that the draft does not have",
                   "declare it before it is used");
        };
        const auto places = static_cast<std::uint32_t>(net().places.size());
        const auto transitions = static_cast<std::uint32_t>(net().transitions.size());
        each_place_mention(net(), [&](std::uint32_t p) {
            if (p >= places) {
                bad("place");
            }
        });
        each_transition_mention(net(), [&](std::uint32_t t) {
            if (t >= transitions) {
                bad("transition");
            }
        });
        for (const auto& list : net().fusions) {
            for (const PlaceIndex p : list) {
                if (p.value >= places) {
                    bad("place");
                }
            }
        }
        for (const auto& list : net().rendezvous) {
            for (const TransitionIndex t : list) {
                if (t.value >= transitions) {
                    bad("transition");
                }
            }
        }
        for (const ChannelDraft& channel : net().channels) {
            for (const auto* ends : {&channel.sends, &channel.receives}) {
                for (const ChannelEnd& end : *ends) {
                    if (end.transition.value >= transitions) {
                        bad("transition");
                    }
                }
            }
        }
        return defects_.size() == before;
    }

    void fuse() {
        const auto root = classes(net().fusions, net().places.size());
        // Siblings are compared by what they become.
        for (PlaceDraft& p : net().places) {
            if (p.duration && p.duration->sibling.valid()) {
                p.duration->sibling.value = root[p.duration->sibling.value];
            }
        }
        for (std::uint32_t i = 0; i < root.size(); ++i) {
            if (root[i] != i) {
                join(net().places[root[i]], net().places[i]);
            }
        }
        std::vector<std::pair<std::string, std::uint32_t>> aliases;
        for (std::uint32_t i = 0; i < root.size(); ++i) {
            if (root[i] != i) {
                aliases.emplace_back(net().places[i].path, i);
            }
        }
        out_.place_map = compact(net().places, root);
        for (auto& [path, index] : aliases) {
            out_.place_aliases.emplace_back(std::move(path), out_.place_map[index]);
        }
        each_place_mention(net(), [&](std::uint32_t& p) {
            // Siblings point to representatives already, which the map sends to the same place.
            p = out_.place_map[p];
        });
        net().fusions.clear();
    }

    void join(PlaceDraft& keep, PlaceDraft& gone) {
        const auto disagree = [&](const char* what) {
            report(defects_, "fused-disagree", gone.where, "place " + gone.path,
                   "fused with " + keep.path + ", but they disagree on " + what,
                   std::string("give both the same ") + what);
        };
        if (!same_duration(effective_duration(keep), effective_duration(gone))) {
            disagree("duration");
        }
        if (keep.discipline != gone.discipline || keep.by_arrival != gone.by_arrival ||
            keep.key != gone.key || keep.keeps_order != gone.keeps_order) {
            disagree("discipline");
        }
        if (!same_attributes(keep, gone)) {
            disagree("attributes");
        }
        if (keep.action.valid() && gone.action.valid() && keep.action != gone.action) {
            disagree("movement");
        }
        if (keep.capacity && gone.capacity && *keep.capacity != *gone.capacity) {
            disagree("capacity");
        }
        if (!keep.capacity) {
            keep.capacity = gone.capacity;
        }
        if (!keep.action.valid()) {
            keep.action = gone.action;
        }
        keep.tokens.insert(keep.tokens.end(), gone.tokens.begin(), gone.tokens.end());
        if (keep.caption.empty()) {
            keep.caption = gone.caption;
        }
    }

    void meet() {
        const Met met = meet_transitions(net(), defects_);
        for (const auto& products : met.products) {
            out_.transition_map.push_back(products.empty() ? TransitionIndex{}.value
                                                           : products.front());
        }
    }

    // t for d  =>  t.begin -> t.busy (d) -> t.end. Tests, guard, delay, event at the begin;
    // outputs, assignments and raised events at the end. Variables travel as attributes of t.busy.
    void hold() {
        const std::size_t count = net().transitions.size();
        for (std::size_t i = 0; i < count; ++i) {
            if (!net().transitions[i].holding) {
                continue;
            }
            TransitionDraft& begin = net().transitions[i];
            TransitionDraft end;
            end.path = begin.path + ".end";
            end.caption = begin.caption;
            end.where = begin.where;
            end.priority = begin.priority;
            end.variables = begin.variables;
            end.outputs = std::move(begin.outputs);
            end.assignments = std::move(begin.assignments);
            end.raises = std::move(begin.raises);
            begin.outputs.clear();
            begin.assignments.clear();
            begin.raises.clear();
            PlaceDraft busy;
            busy.path = begin.path + ".busy";
            busy.caption = begin.caption;
            busy.where = begin.where;
            busy.busy = true;
            busy.duration = std::move(begin.holding);
            begin.holding.reset();
            begin.path += ".begin";
            const bool declared = begin.busy.valid() && begin.end.valid();
            const PlaceIndex place =
                declared ? begin.busy : PlaceIndex{static_cast<std::uint32_t>(net().places.size())};
            const TransitionIndex last = begin.end;
            begin.busy = {};
            begin.end = {};
            OutputDraft into;
            into.place = place;
            into.where = begin.where;
            ArcDraft out_of;
            out_of.place = place;
            out_of.where = begin.where;
            for (std::uint32_t v = 0; v < begin.variables.size(); ++v) {
                busy.attributes.push_back({begin.variables[v].name, begin.variables[v].type});
                into.attributes.push_back(
                    Expr::slot(slot(SlotKind::kVariable, v), begin.variables[v].type));
                PatternDraft bind;
                bind.attribute = v;
                bind.binds = v;
                out_of.pattern.push_back(bind);
            }
            each_expr(*busy.duration, [](Expr& e) {
                e.rename_slots([](Slot s) {
                    if (s.kind == static_cast<std::uint32_t>(SlotKind::kVariable)) {
                        s.kind = static_cast<std::uint32_t>(SlotKind::kAttribute);
                    }
                    return s;
                });
            });
            begin.outputs.push_back(std::move(into));
            end.inputs.push_back(std::move(out_of));
            if (declared) {
                net().places[place.value] = std::move(busy);
                net().transitions[last.value] = std::move(end);
                continue;
            }
            net().places.push_back(std::move(busy));
            net().transitions.push_back(std::move(end));
        }
    }

    void refine() {
        // Outer modules first: what they add to a place that is itself refined is refined in turn.
        const std::size_t count = net().refinements.size();
        if (count == 0) {
            return;
        }
        constexpr std::uint32_t kNone = ~std::uint32_t{0};
        std::vector<std::uint32_t> depth_of(net().places.size(), 0),
            last(net().places.size(), kNone);
        for (std::uint32_t k = 0; k < count; ++k) {
            for (const PlaceIndex inside : net().refinements[k].inside) {
                if (last[inside.value] != k) {  // once per module
                    last[inside.value] = k;
                    ++depth_of[inside.value];
                }
            }
        }
        std::vector<std::pair<std::uint32_t, std::uint32_t>> order;  // depth, number
        for (std::uint32_t k = 0; k < count; ++k) {
            order.emplace_back(depth_of[net().refinements[k].place.value], k);
        }
        std::sort(order.begin(), order.end());
        touching_.assign(net().places.size(), {});
        for (std::uint32_t t = 0; t < net().transitions.size(); ++t) {
            for (const ArcDraft& arc : net().transitions[t].inputs) {
                touching_[arc.place.value].push_back(t);
            }
            for (const OutputDraft& out : net().transitions[t].outputs) {
                touching_[out.place.value].push_back(t);
            }
        }
        std::vector<std::uint32_t> ready_of(net().places.size(), kNone);
        for (const auto& [depth, k] : order) {
            const RefinementDraft& r = net().refinements[k];
            if (refine(r, k)) {
                ready_of[r.place.value] = r.finish.front().value;
            }
        }
        // The ready tokens of the shadow are those of its finish, which may itself be refined.
        const auto ready = [&](std::uint32_t place) {
            for (std::size_t k = 0; k < count && ready_of[place] != kNone; ++k) {
                place = ready_of[place];
            }
            return place;
        };
        each_expr(net(), [&](Expr& e) {
            e.rename_slots([&](Slot s) {
                if (s.kind == static_cast<std::uint32_t>(SlotKind::kReady)) {
                    s.index = ready(s.index);
                }
                return s;
            });
        });
        each_formula(net(), [&](Formula& f) {
            for (Formula::Node& n : f.nodes) {
                if (n.op == FormulaOp::kReady) {
                    n.index = ready(n.index);
                }
            }
        });
        out_.refinements = std::move(net().refinements);
        net().refinements.clear();
    }

    // False: it is wrong, and left as it is.
    bool refine(const RefinementDraft& r, std::uint32_t number) {
        PlaceDraft& place = net().places[r.place.value];
        if (place.duration && place.duration->kind != DurationKind::kOpen) {
            report(defects_, "refined-not-open", place.where, "place " + place.path,
                   "runs a module, so its duration is the module's",
                   "leave out `takes`, or do not run a module here");
        }
        if (place.action.valid()) {
            report(defects_, "refined-not-open", place.where, "place " + place.path,
                   "both runs a module and does a movement", "choose one of them");
        }
        if (r.start.empty() || r.finish.empty()) {
            report(defects_, "refined-not-open", r.where, "place " + place.path,
                   "its module has no way in or no way out", "name a start and a finish place");
            return false;
        }
        // The shadow itself is always there; whether it is ready is asked of the finish.
        place.duration = DurationDraft{};
        if (!place.capacity) {
            place.capacity = 1;  // one activity at a time: two in one module would mix
        }
        for (const InitialToken& token : place.tokens) {
            for (const PlaceIndex s : r.start) {
                InitialToken begin;
                begin.count = token.count;
                net().places[s.value].tokens.push_back(begin);
            }
        }
        // Only those that have arcs at the place; what they get are arcs at places inside.
        std::vector<std::uint32_t> at_place = touching_[r.place.value];
        std::sort(at_place.begin(), at_place.end());
        at_place.erase(std::unique(at_place.begin(), at_place.end()), at_place.end());
        for (const std::uint32_t t : at_place) {
            TransitionDraft& transition = net().transitions[t];
            std::vector<ArcDraft> more;
            bool leaves = false;
            for (const ArcDraft& arc : transition.inputs) {
                if (arc.place != r.place) {
                    continue;
                }
                if (arc.kind == ArcKind::kTake || arc.kind == ArcKind::kRead ||
                    arc.kind == ArcKind::kTakeAll) {
                    for (const PlaceIndex f : r.finish) {
                        ArcDraft finish = arc;
                        finish.place = f;
                        finish.pattern.clear();
                        more.push_back(std::move(finish));
                    }
                    leaves = leaves || arc.kind != ArcKind::kRead;
                } else if (arc.kind == ArcKind::kTakeNow || arc.kind == ArcKind::kTakeAllNow) {
                    for (const PlaceIndex inside : r.inside) {
                        ArcDraft clear = arc;
                        clear.kind = ArcKind::kTakeAllNow;
                        clear.weight = 1;
                        clear.place = inside;
                        clear.pattern.clear();
                        clear.time_left.reset();
                        more.push_back(std::move(clear));
                    }
                }
            }
            for (ArcDraft& arc : transition.inputs) {
                if (arc.place == r.place && arc.kind == ArcKind::kUnlessReady) {
                    arc.place = r.finish.front();
                    touching_[arc.place.value].push_back(t);
                }
            }
            for (const ArcDraft& arc : more) {
                touching_[arc.place.value].push_back(t);
            }
            transition.inputs.insert(transition.inputs.end(), more.begin(), more.end());
            std::vector<OutputDraft> starts;
            for (const OutputDraft& out : transition.outputs) {
                if (out.place == r.place) {
                    for (const PlaceIndex s : r.start) {
                        OutputDraft start;
                        start.place = s;
                        start.weight = out.weight;
                        start.where = out.where;
                        starts.push_back(std::move(start));
                    }
                }
            }
            for (const OutputDraft& start : starts) {
                touching_[start.place.value].push_back(t);
            }
            transition.outputs.insert(transition.outputs.end(), starts.begin(), starts.end());
            if (leaves) {
                out_.clean.push_back({t, number});
            }
        }
        return true;
    }

    std::vector<std::vector<std::uint32_t>> touching_;  // per place: transitions with arcs at it
    Lowered out_;
    Diagnostics& defects_;
};

}  // namespace

Lowered lower_draft(const NetDraft& draft, Diagnostics& defects) {
    return Lowering(draft, defects).run();
}

Checked<NetDraft> lower(const NetDraft& draft) {
    Diagnostics defects;
    Lowered lowered = lower_draft(draft, defects);
    if (has_errors(defects)) {
        return Unexpected(std::move(defects));
    }
    return std::move(lowered.net);
}

}  // namespace puppetri::net
