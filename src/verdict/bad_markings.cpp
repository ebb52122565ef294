// SPDX-License-Identifier: MIT
#include "bad_markings.h"

#include <algorithm>
#include <utility>

#include "puppetri/proof/predicate.h"

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

bool speaks_of_figures(const Formula& f) {
    return std::any_of(f.nodes.begin(), f.nodes.end(),
                       [](const Formula::Node& n) { return n.op == FormulaOp::kHost; });
}

// Of a firing everything is read just before it: where it can fire.
std::optional<std::vector<Predicate>> where_not_only_if(const net::Net& net, const net::Rule& rule,
                                                        const HostLowering* host) {
    Formula a = rule.operands[0];
    if (a.nodes.size() == 1 && a.nodes[0].op == FormulaOp::kFires) {
        a.nodes[0].op = FormulaOp::kFireable;
    } else if (!speaks_of_state(a)) {
        return std::nullopt;
    }
    if (!speaks_of_state(rule.operands[1])) {
        return std::nullopt;
    }
    auto p = proof::predicate_of(
        net,
        Formula::binary(FormulaOp::kAnd, lowered(a, host).may,
                        Formula::unary(FormulaOp::kNot, lowered(rule.operands[1], host).must)));
    return p ? std::optional(std::vector<Predicate>{std::move(*p)}) : std::nullopt;
}

}  // namespace

bool about_figures(const net::Rule& rule) {
    return std::any_of(rule.operands.begin(), rule.operands.end(), speaks_of_figures);
}

Lowered lowered(const Formula& f, const HostLowering* host) {
    if (!speaks_of_figures(f)) {
        return {f, f};
    }
    return host != nullptr ? host->lower(f)
                           : Lowered{Formula::constant(true), Formula::constant(false)};
}

std::optional<std::vector<Predicate>> bad_markings(const net::Net& net, const net::Rule& rule,
                                                   const HostLowering* host, bool exactly) {
    if (rule.kind == RuleKind::kOnlyIf) {
        return where_not_only_if(net, rule, host);
    }
    if (!std::all_of(rule.operands.begin(), rule.operands.end(), speaks_of_state)) {
        return std::nullopt;
    }
    std::vector<Predicate> cases;  // none of them may ever hold
    const auto add = [&](const Formula& f) {
        auto p = proof::predicate_of(net, f);
        if (p) {
            cases.push_back(std::move(*p));
        }
        return p.has_value();
    };
    const bool one = rule.kind == RuleKind::kExactlyOne;
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
            for (std::uint32_t p = 0; rule.operands.empty() && p < net.place_count(); ++p) {
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
            if (const auto sum = exactly ? std::nullopt : sum_of_places(rule.operands)) {
                cases.push_back(Predicate::at_least(*sum, 2));
                if (one) {
                    cases.push_back(Predicate::at_most(*sum, 0));
                }
                break;
            }
            if (rule.operands.size() > (exactly ? 64 : 24)) {
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
            if (one) {
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
    return cases;
}

}  // namespace puppetri::verdict
