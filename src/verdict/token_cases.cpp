// SPDX-License-Identifier: MIT
#include "token_cases.h"

#include <algorithm>
#include <utility>

namespace puppetri::verdict {

using proof::LinearSum;
using proof::Predicate;

std::optional<std::vector<TokenCase>> token_cases(const Predicate& p) {
    constexpr std::size_t kMost = 256;
    std::vector<std::vector<TokenCase>> made(p.nodes.size());
    for (std::size_t i = 0; i < p.nodes.size(); ++i) {
        const Predicate::Node& n = p.nodes[i];
        std::vector<TokenCase>& to = made[i];
        switch (n.op) {
            case Predicate::Op::kFalse:
                break;
            case Predicate::Op::kTrue:
                to.emplace_back();
                break;
            case Predicate::Op::kAtLeast: {
                const LinearSum& sum = p.sums[n.index];
                if (sum.terms.size() != 1 || sum.terms[0].factor != 1) {
                    return std::nullopt;
                }
                to.push_back({{sum.terms[0].place, n.limit}});
                break;
            }
            case Predicate::Op::kOr:
                for (std::uint32_t k = n.first; k < n.first + n.count; ++k) {
                    const std::vector<TokenCase>& some = made[p.list[k]];
                    to.insert(to.end(), some.begin(), some.end());
                }
                break;
            case Predicate::Op::kAnd:
                to.emplace_back();
                for (std::uint32_t k = n.first; k < n.first + n.count; ++k) {
                    std::vector<TokenCase> both;
                    for (const TokenCase& a : to) {
                        for (const TokenCase& b : made[p.list[k]]) {
                            both.push_back(a);
                            both.back().insert(both.back().end(), b.begin(), b.end());
                        }
                        if (both.size() > kMost) {
                            return std::nullopt;
                        }
                    }
                    to = std::move(both);
                }
                break;
            default:
                return std::nullopt;
        }
        if (to.size() > kMost) {
            return std::nullopt;
        }
    }
    return made.empty() ? std::nullopt : std::optional(std::move(made.back()));
}

bool excludes(const proof::Invariant& invariant, const TokenCase& tokens) {
    if (invariant.trap || invariant.kind == proof::Invariant::kAtLeast) {
        return false;
    }
    std::int64_t sum = 0;
    for (const LinearSum::Term& term : invariant.sum.terms) {
        if (term.factor < 0) {
            return false;  // other places may make up for it
        }
        std::int64_t least = 0, more = 0;
        for (const LinearSum::Term& t : tokens) {
            least = t.place == term.place ? std::max(least, t.factor) : least;
        }
        if (__builtin_mul_overflow(term.factor, least, &more) ||
            __builtin_add_overflow(sum, more, &sum)) {
            return false;
        }
    }
    return sum > invariant.limit;
}

}  // namespace puppetri::verdict
