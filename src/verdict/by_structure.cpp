// SPDX-License-Identifier: MIT
#include "by_structure.h"

#include <algorithm>
#include <utility>

#include "puppetri/net/tables.h"
#include "puppetri/proof/coverability.h"
#include "puppetri/proof/state_equation.h"
#include "puppetri/proof/structural_liveness.h"

namespace puppetri::verdict {
namespace {

using net::Formula;
using net::FormulaOp;
using net::RuleKind;
using proof::LinearSum;
using proof::Predicate;

// "The place has a token", of different places.
std::optional<LinearSum> sum_of_places(const std::vector<Formula>& operands) {
    LinearSum sum;
    for (const Formula& f : operands) {
        // A disjunction of places counts once for each, which is more, never less.
        for (const Formula::Node& n : f.nodes) {
            if (n.op == FormulaOp::kOr) {
                continue;
            }
            if (n.op != FormulaOp::kMarked || n.count != 1) {
                return std::nullopt;
            }
            sum.terms.push_back({n.index, 1});
        }
    }
    std::sort(sum.terms.begin(), sum.terms.end(),
              [](const auto& a, const auto& b) { return a.place < b.place; });
    for (std::size_t i = 1; i < sum.terms.size(); ++i) {
        if (sum.terms[i].place == sum.terms[i - 1].place) {
            return std::nullopt;
        }
    }
    return sum;
}

bool speaks_of_state(const Formula& f) {
    return std::none_of(f.nodes.begin(), f.nodes.end(), [](const Formula::Node& n) {
        return n.op == FormulaOp::kFires || n.op == FormulaOp::kEvent ||
               n.op >= FormulaOp::kAllNext;
    });
}

Lowered lowered(const Formula& f, const HostLowering* host) {
    const bool figures = std::any_of(f.nodes.begin(), f.nodes.end(), [](const Formula::Node& n) {
        return n.op == FormulaOp::kHost;
    });
    if (!figures) {
        return {f, f};
    }
    return host != nullptr ? host->lower(f)
                           : Lowered{Formula::constant(true), Formula::constant(false)};
}

}  // namespace

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
                grows = "without time, place " +
                        std::string(net_.place(net::PlaceIndex{answer.place}).path) +
                        " grows without end";
            }
            return std::nullopt;
        }
        case RuleKind::kLive:
        case RuleKind::kDeadlockFree:
            return by_theorem(budget);
        case RuleKind::kNobodyFreezes:
            // Who has no movements cannot move: the theorem speaks of transitions.
            if (std::any_of(
                    asked.rule.operands.begin(), asked.rule.operands.end(),
                    [](const Formula& f) { return f.nodes.back().op == FormulaOp::kConstant; })) {
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

std::optional<StructuralProof> Structure::by_invariants(const net::Rule& rule,
                                                        const HostLowering* host,
                                                        const proof::Budget& budget) {
    if (!std::all_of(rule.operands.begin(), rule.operands.end(), speaks_of_state)) {
        return std::nullopt;
    }
    std::vector<Predicate> cases;  // none of them may ever hold
    const auto add = [&](const Formula& f) {
        auto p = proof::predicate_of(net_, f);
        if (p) {
            cases.push_back(std::move(*p));
        }
        return p.has_value();
    };
    const bool exactly = rule.kind == RuleKind::kExactlyOne;
    switch (rule.kind) {
        case RuleKind::kNever:
            if (!add(lowered(rule.operands[0], host).may)) {
                return std::nullopt;
            }
            break;
        case RuleKind::kAlways:
            if (!add(Formula::unary(FormulaOp::kNot, lowered(rule.operands[0], host).must))) {
                return std::nullopt;
            }
            break;
        case RuleKind::kBounded: {
            const auto more = [&](std::uint32_t place) {
                LinearSum sum;
                sum.terms.push_back({place, 1});
                cases.push_back(Predicate::at_least(std::move(sum), rule.count + 1));
            };
            for (std::uint32_t p = 0; rule.operands.empty() && p < net_.place_count(); ++p) {
                more(p);
            }
            for (const Formula& f : rule.operands) {
                for (const Formula::Node& n : f.nodes) {
                    if (n.op == FormulaOp::kMarked) {
                        more(n.index);
                    }
                }
            }
            break;
        }
        default:
            if (const auto sum = sum_of_places(rule.operands)) {
                cases.push_back(Predicate::at_least(*sum, 2));
                if (exactly) {
                    cases.push_back(Predicate::at_most(*sum, 0));
                }
                break;
            }
            if (rule.operands.size() > 24) {
                return std::nullopt;
            }
            std::vector<Lowered> parts;
            for (const Formula& f : rule.operands) {
                parts.push_back(lowered(f, host));
            }
            for (std::size_t i = 0; i < parts.size(); ++i) {
                for (std::size_t k = i + 1; k < parts.size(); ++k) {
                    if (!add(Formula::binary(FormulaOp::kAnd, parts[i].may, parts[k].may))) {
                        return std::nullopt;
                    }
                }
            }
            if (exactly) {
                Formula none = Formula::constant(true);
                for (const Lowered& part : parts) {
                    none = Formula::binary(FormulaOp::kAnd, std::move(none),
                                           Formula::unary(FormulaOp::kNot, part.must));
                }
                if (!add(none)) {
                    return std::nullopt;
                }
            }
            break;
    }
    StructuralProof out{.method = "invariants"};
    for (const Predicate& bad : cases) {
        const auto used = proof::prove_by_invariants(plain_.net, bad, budget, emptied_);
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
