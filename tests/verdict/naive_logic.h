// SPDX-License-Identifier: MIT
// Formulas of linear and of branching time by their definitions: on words that go round, and on
// explicit graphs of markings, each with what has fired just before. Slow, obvious, and with
// nothing in common with the prover.
#pragma once
#include <cstdint>
#include <functional>
#include <vector>

#include "puppetri/base/random.h"
#include "puppetri/net/formula.h"
#include "support/random_plain_net.h"

namespace puppetri::verdict::naive {

using net::Formula;
using net::FormulaOp;

inline constexpr std::uint32_t kNothing = ~std::uint32_t{0};

struct Moment {
    std::vector<std::uint32_t> tokens;
    std::uint32_t fired = kNothing;
};

inline bool atom(const Formula::Node& n, const Moment& m) {
    switch (n.op) {
        case FormulaOp::kConstant:
            return n.count != 0;
        case FormulaOp::kMarked:
            return m.tokens[n.index] >= n.count;
        default:
            return m.fired == n.index;  // kFires
    }
}

// Positions or states with their successors; `all`, `some`: over successors.
struct Structure {
    std::vector<Moment> moments;
    std::vector<std::vector<std::uint32_t>> next;
};

// Per node of the formula, per position.
inline std::vector<std::vector<bool>> values(const Formula& f, const Structure& s) {
    const std::size_t size = s.moments.size();
    std::vector<std::vector<bool>> v;
    const auto fixpoint =
        [&](bool from, const std::function<bool(const std::vector<bool>&, std::size_t)>& step) {
            std::vector<bool> x(size, from);
            for (bool changed = true; changed;) {
                changed = false;
                for (std::size_t i = 0; i < size; ++i) {
                    const bool now = step(x, i);
                    changed = changed || now != x[i];
                    x[i] = now;
                }
            }
            return x;
        };
    const auto some = [&](const std::vector<bool>& x, std::size_t i) {
        for (const std::uint32_t to : s.next[i]) {
            if (x[to]) {
                return true;
            }
        }
        return false;
    };
    const auto all = [&](const std::vector<bool>& x, std::size_t i) {
        for (const std::uint32_t to : s.next[i]) {
            if (!x[to]) {
                return false;
            }
        }
        return true;
    };
    for (const Formula::Node& n : f.nodes) {
        std::vector<bool> x(size);
        const auto each = [&](auto&& value) {
            for (std::size_t i = 0; i < size; ++i) {
                x[i] = value(i);
            }
        };
        switch (n.op) {
            case FormulaOp::kNot:
                each([&](std::size_t i) { return !v[n.a][i]; });
                break;
            case FormulaOp::kAnd:
                each([&](std::size_t i) { return v[n.a][i] && v[n.b][i]; });
                break;
            case FormulaOp::kOr:
                each([&](std::size_t i) { return v[n.a][i] || v[n.b][i]; });
                break;
            case FormulaOp::kImplies:
                each([&](std::size_t i) { return !v[n.a][i] || v[n.b][i]; });
                break;
            case FormulaOp::kNext:
            case FormulaOp::kAllNext:
                each([&](std::size_t i) { return all(v[n.a], i); });
                break;
            case FormulaOp::kSomeNext:
                each([&](std::size_t i) { return some(v[n.a], i); });
                break;
            case FormulaOp::kGlobally:
            case FormulaOp::kAllGlobally:
                x = fixpoint(true,
                             [&](const auto& y, std::size_t i) { return v[n.a][i] && all(y, i); });
                break;
            case FormulaOp::kSomeGlobally:  // a path that ends here is one, too
                x = fixpoint(true, [&](const auto& y, std::size_t i) {
                    return v[n.a][i] && (s.next[i].empty() || some(y, i));
                });
                break;
            case FormulaOp::kFinally:
            case FormulaOp::kAllFinally:
                x = fixpoint(false, [&](const auto& y, std::size_t i) {
                    return v[n.a][i] || (!s.next[i].empty() && all(y, i));
                });
                break;
            case FormulaOp::kSomeFinally:
                x = fixpoint(false,
                             [&](const auto& y, std::size_t i) { return v[n.a][i] || some(y, i); });
                break;
            case FormulaOp::kUntil:
            case FormulaOp::kAllUntil:
                x = fixpoint(false, [&](const auto& y, std::size_t i) {
                    return v[n.b][i] || (v[n.a][i] && !s.next[i].empty() && all(y, i));
                });
                break;
            case FormulaOp::kSomeUntil:
                x = fixpoint(false, [&](const auto& y, std::size_t i) {
                    return v[n.b][i] || (v[n.a][i] && some(y, i));
                });
                break;
            default:
                each([&](std::size_t i) { return atom(n, s.moments[i]); });
                break;
        }
        v.push_back(std::move(x));
    }
    return v;
}
inline bool holds(const Formula& f, const Structure& s, std::uint32_t at) {
    return values(f, s).back()[at];
}

// A word that goes from its last letter to letter `back`.
inline Structure word(std::vector<Moment> letters, std::size_t back) {
    Structure s;
    for (std::uint32_t i = 0; i < letters.size(); ++i) {
        s.next.push_back({i + 1 < letters.size() ? i + 1 : static_cast<std::uint32_t>(back)});
    }
    s.moments = std::move(letters);
    return s;
}

// A net without time: each marking with the firing that led there; where it is dead it stands for
// ever, and nothing has just fired.
inline Structure structure(const test::NaiveGraph& g) {
    Structure s;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> known;
    std::vector<std::uint32_t> marking;
    const auto node = [&](std::uint32_t m, std::uint32_t fired) {
        const auto [at, fresh] =
            known.try_emplace({m, fired}, static_cast<std::uint32_t>(s.moments.size()));
        if (fresh) {
            s.moments.push_back({g.markings[m], fired});
            marking.push_back(m);
        }
        return at->second;
    };
    node(0, kNothing);
    for (std::uint32_t i = 0; i < s.moments.size(); ++i) {
        s.next.emplace_back();
        std::vector<std::uint32_t> next;
        for (const auto& [t, to] : g.edges[marking[i]]) {
            next.push_back(node(to, t));
        }
        if (next.empty()) {
            next.push_back(node(marking[i], kNothing));
        }
        s.next[i] = std::move(next);
    }
    return s;
}

inline Formula random_formula(RandomStream& stream, std::uint32_t places, std::uint32_t transitions,
                              bool linear, bool with_next, int depth) {
    const auto sub = [&] {
        return random_formula(stream, places, transitions, linear, with_next, depth - 1);
    };
    const auto pick = [&](std::uint64_t n) { return static_cast<std::uint32_t>(stream.below(n)); };
    if (depth == 0 || pick(5) == 0) {
        Formula f = pick(3) != 0 ? Formula::fires(net::TransitionIndex{pick(transitions)})
                                 : Formula::marked(net::PlaceIndex{pick(places)}, 1 + pick(4) / 3);
        return pick(3) == 0 ? Formula::unary(FormulaOp::kNot, std::move(f)) : f;
    }
    switch (pick(with_next ? 8 : 7)) {
        case 0:
            return Formula::unary(FormulaOp::kNot, sub());
        case 1: {
            Formula a = sub();
            return Formula::binary(FormulaOp::kAnd, std::move(a), sub());
        }
        case 2: {
            Formula a = sub();
            return Formula::binary(FormulaOp::kImplies, std::move(a), sub());
        }
        case 3:
            return Formula::unary(linear         ? FormulaOp::kGlobally
                                  : pick(2) == 0 ? FormulaOp::kAllGlobally
                                                 : FormulaOp::kSomeGlobally,
                                  sub());
        case 4:
        case 5:
            return Formula::unary(linear         ? FormulaOp::kFinally
                                  : pick(2) == 0 ? FormulaOp::kAllFinally
                                                 : FormulaOp::kSomeFinally,
                                  sub());
        case 6: {
            Formula a = sub();
            return Formula::binary(linear         ? FormulaOp::kUntil
                                   : pick(2) == 0 ? FormulaOp::kAllUntil
                                                  : FormulaOp::kSomeUntil,
                                   std::move(a), sub());
        }
        default:
            return Formula::unary(linear         ? FormulaOp::kNext
                                  : pick(2) == 0 ? FormulaOp::kAllNext
                                                 : FormulaOp::kSomeNext,
                                  sub());
    }
}

}  // namespace puppetri::verdict::naive
