// SPDX-License-Identifier: MIT
#include "by_structure.h"

#include <algorithm>
#include <utility>

#include "bad_markings.h"
#include "puppetri/net/tables.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/proof/state_equation.h"
#include "puppetri/proof/structural_liveness.h"
#include "token_cases.h"

namespace puppetri::verdict {

using net::Formula;
using net::RuleKind;
using proof::Predicate;

Structure::Structure(const net::Net& net) : net_(net), plain_(proof::plain(net)) {
    emptied_.resize(net.place_count(), 0);
    for (const net::Special& s : net.tables().specials) {
        for (const net::ArcTable& arc : s.arcs) {
            if (arc.kind == net::ArcKind::kTakeAll || arc.kind == net::ArcKind::kTakeAllNow) {
                emptied_[arc.place] = 1;
            }
        }
    }
    for (std::uint32_t p = 0; p < net.place_count(); ++p) {
        names_.emplace_back(net.place(net::PlaceIndex{p}).path);
    }
}

std::optional<StructuralProof> Structure::prove(const Asked& asked, const HostLowering* host,
                                                const proof::Budget& budget) {
    if (asked.question == Question::kOneOfEach) {
        const proof::IdentityAnswer answer =
            proof::conserves_identity(net_, asked.places, asked.attributes);
        if (!answer.conserved) {
            return std::nullopt;
        }
        return StructuralProof{.method = "identities are conserved",
                               .notes = {"every firing hands on each one that it takes"}};
    }
    if (asked.question == Question::kTimeGoesOn && instants_end()) {
        return StructuralProof{.method = "arcs", .notes = {"what takes no time cannot go round"}};
    }
    if (asked.question != Question::kRule || plain_.unsound) {
        return std::nullopt;
    }
    switch (asked.rule.kind) {
        case RuleKind::kNever:
        case RuleKind::kAlways:
        case RuleKind::kMutex:
        case RuleKind::kExactlyOne:
            return by_invariants(asked.rule, host, budget);
        case RuleKind::kBounded: {
            if (asked.rule.count != kNoCount) {
                return by_invariants(asked.rule, host, budget);
            }
            const proof::BoundednessAnswer answer = proof::boundedness(plain_.net, budget);
            if (answer.kind == proof::BoundednessAnswer::kBounded) {
                return StructuralProof{.method = answer.method};
            }
            if (answer.kind == proof::BoundednessAnswer::kUnbounded) {
                pump = answer;
                grows = "times left aside, tokens pile up in place " +
                        std::string(net_.place(net::PlaceIndex{answer.place}).path) +
                        " without end";
            }
            return std::nullopt;
        }
        case RuleKind::kLive:
        case RuleKind::kDeadlockFree:
            return by_theorem(budget);
        case RuleKind::kNobodyFreezes:
            // Who has no movements cannot move: the theorem speaks of transitions.
            if (std::any_of(asked.rule.operands.begin(), asked.rule.operands.end(),
                            [](const Formula& f) {
                                return f.nodes.back().op == net::FormulaOp::kConstant;
                            })) {
                return std::nullopt;
            }
            return by_theorem(budget);
        default:
            return std::nullopt;
    }
}

// An instant ends: who takes ready tokens from a place where tokens wait is not fired by tokens of
// the same instant, so that it fires there a bounded number of times; if the others cannot go
// round, they do not either. Nothing is said of nets with raised events, whose occurrences an
// instant may multiply.
bool Structure::instants_end() const {
    if (proof::instants_end(net_)) {
        return true;
    }
    const net::NetTables& tables = net_.tables();
    const std::uint32_t count = net_.transition_count();
    const auto waits = [&](std::uint32_t p) {
        const std::uint32_t number = tables.place[p].duration;
        if (number == net::kNoIndex) {
            return false;
        }
        const net::DurationTable& d = tables.durations[number];
        Value value = 0;
        switch (d.kind) {
            case net::DurationKind::kConstant:
                return d.ticks > 0;
            case net::DurationKind::kInterval:
                return tables.code.is_constant(d.a, value) && value > 0;
            case net::DurationKind::kAuto:  // movements last at least a millisecond
                return true;
            default:
                return false;
        }
    };
    // Arcs may give a token a time of its own, which may be none.
    std::vector<std::uint8_t> own_time(net_.place_count(), 0);
    for (const net::Special& s : tables.specials) {
        if (!s.raises.empty()) {
            return false;
        }
        for (const net::OutputTable& out : s.outputs) {
            if (out.lasts.valid()) {
                own_time[out.place] = 1;
            }
        }
    }
    std::vector<std::uint8_t> slow(count, 0);
    for (std::uint32_t t = 0; t < count; ++t) {
        for (const net::Weighted& w : tables.takes(t)) {
            slow[t] |= waits(w.place) && own_time[w.place] == 0 ? 1 : 0;
        }
        const std::uint32_t special = tables.transition[t].special;
        if (special == net::kNoIndex) {
            continue;
        }
        const net::Special& s = tables.specials[special];
        for (const net::ArcTable& arc : s.arcs) {
            slow[t] |=
                arc.kind == net::ArcKind::kTake && waits(arc.place) && own_time[arc.place] == 0 ? 1
                                                                                                : 0;
        }
        // An occurrence is offered to each once.
        slow[t] |= s.events.empty() ? 0 : 1;
    }
    // The others, by the places between them: no way round.
    std::vector<std::uint32_t> before(count, 0), queue;
    std::vector<std::vector<std::uint32_t>> takers(net_.place_count());
    for (std::uint32_t t = 0; t < count; ++t) {
        if (slow[t] == 0) {
            if (plain_.net.takes.row(t).empty()) {
                return false;
            }
            for (const net::Weighted& w : plain_.net.takes.row(t)) {
                takers[w.place].push_back(t);
            }
        }
    }
    for (std::uint32_t t = 0; t < count; ++t) {
        for (const net::Weighted& w : plain_.net.gives.row(t)) {
            for (const std::uint32_t next : takers[w.place]) {
                before[next] += slow[t] == 0 ? 1 : 0;
            }
        }
    }
    std::uint32_t left = 0;
    for (std::uint32_t t = 0; t < count; ++t) {
        if (slow[t] == 0) {
            ++left;
            if (before[t] == 0) {
                queue.push_back(t);
            }
        }
    }
    for (std::size_t i = 0; i < queue.size(); ++i) {
        --left;
        for (const net::Weighted& w : plain_.net.gives.row(queue[i])) {
            for (const std::uint32_t next : takers[w.place]) {
                if (--before[next] == 0) {
                    queue.push_back(next);
                }
            }
        }
    }
    return left == 0 && !plain_.unsound;
}

std::optional<StructuralProof> Structure::by_theorem(const proof::Budget& budget) {
    if (net_.transition_count() == 0) {
        return std::nullopt;
    }
    if (!live_) {
        const proof::TimedLiveness answer = proof::timed_liveness(net_, budget);
        live_ = answer.live || (answer.live_unless_stopped && !answer.needs_clean_ends &&
                                (!answer.needs_time_goes_on || instants_end()));
        theorem_ = answer.theorem;
    }
    if (!*live_) {
        return std::nullopt;
    }
    return StructuralProof{.method = "theorem", .notes = {theorem_}};
}

std::optional<std::vector<proof::Invariant>> Structure::exclude(const Predicate& bad,
                                                                const proof::Budget& budget) {
    const auto cases = token_cases(bad);
    std::vector<proof::Invariant> out;
    const auto use = [&](const proof::Invariant& i) {
        if (std::find(out.begin(), out.end(), i) == out.end()) {
            out.push_back(i);
        }
        if (std::find(known_.begin(), known_.end(), i) == known_.end()) {
            known_.push_back(i);
        }
    };
    if (!cases || cases->size() < 2) {
        auto used = proof::prove_by_invariants(plain_.net, bad, budget, emptied_);
        for (std::size_t k = 0; used && k < used->size(); ++k) {
            use((*used)[k]);
        }
        return used;
    }
    for (const TokenCase& one : *cases) {
        const auto known =
            std::find_if(known_.begin(), known_.end(),
                         [&](const proof::Invariant& i) { return excludes(i, one); });
        if (known != known_.end()) {
            use(proof::Invariant(*known));
            continue;
        }
        std::vector<Predicate> all;
        for (const proof::LinearSum::Term& t : one) {
            all.push_back(Predicate::at_least({{{t.place, 1}}}, t.factor));
        }
        const auto used =
            proof::prove_by_invariants(plain_.net, Predicate::all_of(all), budget, emptied_);
        if (!used) {
            return std::nullopt;
        }
        for (const proof::Invariant& i : *used) {
            use(i);
        }
    }
    return out;
}

std::optional<StructuralProof> Structure::by_invariants(const net::Rule& rule,
                                                        const HostLowering* host,
                                                        const proof::Budget& budget) {
    const auto cases = bad_markings(net_, rule, host, false);
    if (!cases) {
        return std::nullopt;
    }
    StructuralProof out{.method = "invariants"};
    for (const Predicate& bad : *cases) {
        const auto used = exclude(bad, budget);
        if (!used) {
            return std::nullopt;
        }
        for (const proof::Invariant& i : *used) {
            std::string words = proof::text(i, names_);
            if (out.notes.size() < 8 &&
                std::find(out.notes.begin(), out.notes.end(), words) == out.notes.end()) {
                out.notes.push_back(std::move(words));
            }
        }
    }
    return out;
}

}  // namespace puppetri::verdict
