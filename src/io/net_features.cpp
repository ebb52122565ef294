// SPDX-License-Identifier: MIT
#include "net_features.h"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "puppetri/io/tina.h"

namespace puppetri::io {
namespace {

using net::ArcKind;
using net::DurationKind;

bool asks_for_readiness(ArcKind kind) {
    return kind == ArcKind::kTakeNow || kind == ArcKind::kTakeAllNow || kind == ArcKind::kReadNow ||
           kind == ArcKind::kUnlessReady;
}

NetFeature feature_of(const net::DurationDraft& delay) {
    double mean = 0;
    SimTime low;
    if (is_exponential(delay, mean)) {
        return NetFeature::kExponential;
    }
    if (is_at_least(delay, low)) {
        return NetFeature::kAtLeast;
    }
    const bool constant =
        (delay.kind == DurationKind::kConstant && delay.a.is_literal()) ||
        (delay.kind == DurationKind::kInterval && delay.a.is_literal() && delay.b.is_literal());
    return constant ? NetFeature::kIntervals : NetFeature::kOtherDelays;
}

class Collector {
 public:
    explicit Collector(const net::NetDraft& draft) : draft_(draft) {}

    std::vector<FeatureUse> run() {
        for (const net::PlaceDraft& p : draft_.places) {
            place(p);
        }
        bool several_priorities = false;
        std::int64_t priority = 0;
        bool seen = false;
        for (const net::TransitionDraft& t : draft_.transitions) {
            if (!t.delay) {
                several_priorities = several_priorities || (seen && t.priority != priority);
                priority = t.priority;
                seen = true;
            }
        }
        for (const net::TransitionDraft& t : draft_.transitions) {
            transition(t, several_priorities);
        }
        for (const net::DatumDraft& d : draft_.data) {
            use(NetFeature::kData, "datum " + d.path, d.where);
        }
        for (const net::EventDraft& e : draft_.events) {
            use(NetFeature::kEvents, "event " + e.path, e.where);
        }
        if (!draft_.fusions.empty() || !draft_.rendezvous.empty() || !draft_.channels.empty() ||
            !draft_.refinements.empty()) {
            use(NetFeature::kComposition, "net " + draft_.name, {});
        }
        for (const net::Rule& r : draft_.rules) {
            use(NetFeature::kStatements, "rule " + r.path, r.where);
        }
        for (const net::TimeQuestion& q : draft_.questions) {
            use(NetFeature::kStatements, "question " + q.path, q.where);
        }
        for (const net::MeasureDraft& m : draft_.measures) {
            use(NetFeature::kStatements, "measure " + m.path, m.where);
        }
        for (const net::NamedState& s : draft_.states) {
            use(NetFeature::kStatements, "state " + s.path, s.where);
        }
        for (const net::FinalMarkingDraft& f : draft_.finals) {
            use(NetFeature::kStatements, "end", f.where);
        }
        return std::move(uses_);
    }

 private:
    void use(NetFeature feature, std::string element, const SourceSpan& where) {
        uses_.push_back({feature, std::move(element), where});
    }

    void place(const net::PlaceDraft& p) {
        const std::string element = "place " + p.path;
        if (p.action.valid()) {
            use(NetFeature::kMovements, element, p.where);
        } else if (!is_untimed(p)) {
            const NetFeature time = p.duration ? feature_of(*p.duration) : NetFeature::kOtherDelays;
            use(time == NetFeature::kExponential || time == NetFeature::kIntervals
                    ? NetFeature::kPlaceTimes
                    : NetFeature::kOtherPlaceTimes,
                element, p.where);
        }
        if (!p.attributes.empty()) {
            use(NetFeature::kAttributes, element, p.where);
        }
        if (p.capacity) {
            use(NetFeature::kCapacities, element, p.where);
        }
    }

    void transition(const net::TransitionDraft& t, bool several_priorities) {
        const std::string element = "transition " + t.path;
        bool inhibitors = false, reads = false, resets = false, unready = false, attributes = false;
        for (const net::ArcDraft& a : t.inputs) {
            const ArcKind kind = plain_kind(a.kind);
            inhibitors = inhibitors || kind == ArcKind::kUnless;
            reads = reads || kind == ArcKind::kRead;
            resets = resets || kind == ArcKind::kTakeAll;
            attributes = attributes || !a.pattern.empty() || a.time_left.has_value();
            unready =
                unready || (asks_for_readiness(a.kind) && a.place.value < draft_.places.size() &&
                            !is_untimed(draft_.places[a.place.value]));
        }
        bool own_times = false;
        for (const net::OutputDraft& o : t.outputs) {
            attributes = attributes || !o.attributes.empty();
            own_times = own_times || o.lasts.has_value();
        }
        const auto use_if = [&](bool used, NetFeature feature) {
            if (used) {
                use(feature, element, t.where);
            }
        };
        use_if(inhibitors, NetFeature::kInhibitors);
        use_if(reads, NetFeature::kReads);
        use_if(resets, NetFeature::kResets);
        use_if(unready, NetFeature::kUnready);
        use_if(attributes, NetFeature::kAttributes);
        use_if(own_times, NetFeature::kOtherPlaceTimes);
        use_if(t.guard.has_value(), NetFeature::kGuards);
        use_if(!t.assignments.empty(), NetFeature::kData);
        use_if(!t.events.empty() || !t.raises.empty(), NetFeature::kEvents);
        use_if(t.holding.has_value(), NetFeature::kComposition);
        use_if(several_priorities && !t.delay, NetFeature::kPriorities);
        if (t.odds) {
            use(!t.delay && t.odds->is_literal() ? NetFeature::kOdds : NetFeature::kOtherOdds,
                element, t.where);
        }
        if (t.delay) {
            const NetFeature delay = feature_of(t.delay->duration);
            use(delay, element, t.where);
            if (t.delay->servers == net::DelayDraft::kInfiniteServers) {
                use(delay == NetFeature::kExponential ? NetFeature::kInfiniteServers
                                                      : NetFeature::kOtherServers,
                    element, t.where);
            } else if (t.delay->servers != 1) {
                use(NetFeature::kOtherServers, element, t.where);
            }
            use_if(t.delay->memory != net::DelayMemory::kEnabling, NetFeature::kOtherServers);
        } else {
            use_if(t.inputs.empty() && t.events.empty(), NetFeature::kSources);
        }
    }

    const net::NetDraft& draft_;
    std::vector<FeatureUse> uses_;
};

}  // namespace

const char* name_of(NetFeature feature) {
    switch (feature) {
        case NetFeature::kInhibitors:
            return "inhibitor arcs";
        case NetFeature::kReads:
            return "read arcs";
        case NetFeature::kResets:
            return "arcs that empty a place";
        case NetFeature::kUnready:
            return "arcs on tokens that are not ready";
        case NetFeature::kPriorities:
            return "priorities";
        case NetFeature::kOdds:
            return "odds";
        case NetFeature::kOtherOdds:
            return "odds of delayed transitions, or computed ones";
        case NetFeature::kExponential:
            return "exponential delays";
        case NetFeature::kIntervals:
            return "constant delays and intervals";
        case NetFeature::kAtLeast:
            return "delays without an upper end";
        case NetFeature::kOtherDelays:
            return "delays with other laws";
        case NetFeature::kInfiniteServers:
            return "infinitely many servers";
        case NetFeature::kOtherServers:
            return "several servers, or memories of delays";
        case NetFeature::kCapacities:
            return "capacities";
        case NetFeature::kPlaceTimes:
            return "places where tokens wait";
        case NetFeature::kOtherPlaceTimes:
            return "places where tokens wait by other laws";
        case NetFeature::kAttributes:
            return "tokens with attributes";
        case NetFeature::kMovements:
            return "movements";
        case NetFeature::kGuards:
            return "guards";
        case NetFeature::kData:
            return "data";
        case NetFeature::kEvents:
            return "events";
        case NetFeature::kSources:
            return "transitions that take nothing";
        case NetFeature::kComposition:
            return "nets put together of others";
        case NetFeature::kStatements:
            return "rules, states and ends";
    }
    return "";
}

std::vector<FeatureUse> features_of(const net::NetDraft& draft) { return Collector(draft).run(); }

bool can_say(NetFormat format, NetFeature feature) {
    const auto one_of = [&](std::initializer_list<NetFeature> list) {
        return std::find(list.begin(), list.end(), feature) != list.end();
    };
    using F = NetFeature;
    switch (format) {
        case NetFormat::kPnml:
            return one_of({F::kInhibitors, F::kReads, F::kResets, F::kSources});
        case NetFormat::kPipe:
            return one_of({F::kInhibitors, F::kReads, F::kPriorities, F::kOdds, F::kExponential,
                           F::kInfiniteServers, F::kCapacities, F::kSources});
        case NetFormat::kTina:
            return one_of({F::kInhibitors, F::kReads, F::kPriorities, F::kIntervals, F::kAtLeast,
                           F::kSources});
        case NetFormat::kLola:
            return one_of({F::kReads, F::kSources});
        case NetFormat::kGraphviz:
            return true;
        case NetFormat::kScene:
            return one_of({F::kInhibitors, F::kReads, F::kResets, F::kUnready, F::kPriorities,
                           F::kOdds, F::kExponential, F::kInfiniteServers, F::kOtherServers,
                           F::kCapacities, F::kIntervals, F::kPlaceTimes});
    }
    return false;
}

bool is_untimed(const net::PlaceDraft& place) {
    if (!place.duration) {
        return !place.action.valid();
    }
    return place.duration->kind == DurationKind::kConstant && place.duration->a.is_literal() &&
           place.duration->a.literal_value() == 0;
}

bool is_timeless(const net::NetDraft& draft) {
    return draft.schedule.empty() &&
           std::all_of(draft.places.begin(), draft.places.end(), is_untimed) &&
           std::none_of(draft.transitions.begin(), draft.transitions.end(),
                        [](const net::TransitionDraft& t) { return t.delay || t.holding; });
}

bool is_exponential(const net::DurationDraft& delay, double& mean) {
    if (delay.kind != DurationKind::kDistribution ||
        delay.distribution != DistributionKind::kExponential || delay.parameters.size() != 1 ||
        !delay.parameters[0].is_literal()) {
        return false;
    }
    const Expr& p = delay.parameters[0];
    const Value v = p.literal_value();
    mean = p.type().kind == ValueKind::kReal   ? real_of_value(v)
           : p.type().kind == ValueKind::kTime ? SimTime{v}.seconds()
                                               : static_cast<double>(v);
    return mean > 0;
}

std::int64_t initial_tokens(const net::PlaceDraft& place) {
    std::int64_t sum = 0;
    for (const net::InitialToken& t : place.tokens) {
        sum += t.count;
    }
    return sum;
}

net::ArcKind plain_kind(net::ArcKind kind) {
    switch (kind) {
        case ArcKind::kTakeNow:
            return ArcKind::kTake;
        case ArcKind::kTakeAllNow:
            return ArcKind::kTakeAll;
        case ArcKind::kReadNow:
            return ArcKind::kRead;
        case ArcKind::kUnlessReady:
            return ArcKind::kUnless;
        default:
            return kind;
    }
}

}  // namespace puppetri::io
