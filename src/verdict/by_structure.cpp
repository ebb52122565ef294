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
    if (asked.question != Question::kRule || plain_.unsound) {
        return std::nullopt;
    }
    switch (asked.rule.kind) {
        case RuleKind::kNever:
        case RuleKind::kAlways:
        case RuleKind::kMutex:
        case RuleKind::kExactlyOne:
            return by_invariants(asked.rule, host, budget);
        case RuleKind::kBounded:
            if (asked.rule.count != net::Rule::kNoCount) {
                return by_invariants(asked.rule, host, budget);
            }
            if (proof::boundedness(plain_.net, budget).kind == proof::BoundednessAnswer::kBounded) {
                return StructuralProof{.method = "bounded without time"};
            }
            return std::nullopt;
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

std::optional<StructuralProof> Structure::by_theorem(const proof::Budget& budget) {
    if (net_.transition_count() == 0) {
        return std::nullopt;
    }
    if (!live_) {
        const proof::TimedLiveness answer = proof::timed_liveness(net_, budget);
        live_ = answer.live;
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
