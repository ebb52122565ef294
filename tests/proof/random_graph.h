// SPDX-License-Identifier: MIT
// Small random graphs and formulas, and what formulas mean on them, straight from the definitions:
// the oracle of CTL, LTL and automata.
#pragma once
#include <doctest/doctest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "puppetri/net/formula.h"
#include "puppetri/proof/graph.h"
#include "puppetri/proof/temporal.h"

namespace puppetri::proof {

class TestRandom {
 public:
    explicit TestRandom(std::uint64_t seed) : state_(seed * 2654435761u + 12345) {}
    std::uint32_t below(std::uint32_t n) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>((state_ >> 33) % n);
    }

 private:
    std::uint64_t state_;
};

inline constexpr std::uint32_t kTestAtoms = 3;

// Atom i of a formula of the tests is "place i is marked".
inline net::Formula test_atom(std::uint32_t i) { return net::Formula::marked({i}); }

// A formula without temporal operators where atoms hold for certain (must) or perhaps (may):
// whether it must hold, whether it may.
inline std::pair<bool, bool> must_and_may(const net::Formula& f, std::uint64_t must,
                                          std::uint64_t may) {
    using net::FormulaOp;
    using Both = std::pair<bool, bool>;
    const auto no = [](Both x) { return Both{!x.second, !x.first}; };
    const auto both = [](Both x, Both y) { return Both{x.first && y.first, x.second && y.second}; };
    std::vector<Both> v;
    for (const net::Formula::Node& n : f.nodes) {
        const Both a = n.a < v.size() ? v[n.a] : Both{}, b = n.b < v.size() ? v[n.b] : Both{};
        switch (n.op) {
            case FormulaOp::kConstant:
                v.emplace_back(n.count != 0, n.count != 0);
                break;
            case FormulaOp::kMarked:
                v.emplace_back(((must >> n.index) & 1) != 0, ((may >> n.index) & 1) != 0);
                break;
            case FormulaOp::kNot:
                v.push_back(no(a));
                break;
            case FormulaOp::kAnd:
                v.push_back(both(a, b));
                break;
            case FormulaOp::kOr:
                v.push_back(no(both(no(a), no(b))));
                break;
            case FormulaOp::kImplies:
                v.push_back(no(both(a, no(b))));
                break;
            case FormulaOp::kIff:
                v.push_back(both(no(both(a, no(b))), no(both(b, no(a)))));
                break;
            default:
                FAIL("an operator that the test does not make");
        }
    }
    return v.back();
}

inline std::vector<std::uint32_t> own_atoms(const Temporal& t) {
    std::vector<std::uint32_t> list(t.atoms.size());
    for (std::uint32_t i = 0; i < list.size(); ++i) {
        list[i] = i;
    }
    return list;
}

// The graph with the atoms of a formula (its largest state formulas) for the test's own.
inline Graph with_atoms_of(const Temporal& t, Graph g) {
    for (std::uint32_t s = 0; s < g.size(); ++s) {
        std::uint64_t may = 0, must = 0;
        for (std::size_t i = 0; i < t.atoms.size(); ++i) {
            const auto [is_must, is_may] =
                must_and_may(t.atoms[i], g.atoms.must[s], g.atoms.may[s]);
            may |= std::uint64_t{is_may} << i;
            must |= std::uint64_t{is_must} << i;
        }
        g.atoms.may[s] = may;
        g.atoms.must[s] = must;
    }
    g.atoms.atoms = static_cast<std::uint32_t>(t.atoms.size());
    return g;
}

// Up to `size` states with few edges, some dead, some of which may stop.
inline Graph random_graph(TestRandom& random, std::uint32_t size) {
    Graph g;
    g.exact = true;
    g.atoms.atoms = kTestAtoms;
    const std::uint32_t sparse = 1 + random.below(3);
    for (std::uint32_t s = 0; s < size; ++s) {
        const std::uint32_t degree = random.below(4) == 0 ? 0 : random.below(sparse + 1);
        for (std::uint32_t e = 0; e < degree; ++e) {
            g.edges.items.push_back({e, random.below(size)});
        }
        g.edges.starts.push_back(static_cast<std::uint32_t>(g.edges.items.size()));
        g.flags.push_back(random.below(8) == 0 ? Graph::kOptional : 0);
        const std::uint64_t bits = random.below(1u << kTestAtoms);
        g.atoms.may.push_back(bits);
        g.atoms.must.push_back(bits);
    }
    return g;
}

inline net::Formula random_formula(TestRandom& random, int depth, bool branching) {
    using net::FormulaOp;
    if (depth == 0) {
        return random.below(12) == 0 ? net::Formula::constant(random.below(2) == 0)
                                     : test_atom(random.below(kTestAtoms));
    }
    static const FormulaOp kUnaryBranching[] = {FormulaOp::kAllNext,      FormulaOp::kAllGlobally,
                                                FormulaOp::kAllFinally,   FormulaOp::kSomeNext,
                                                FormulaOp::kSomeGlobally, FormulaOp::kSomeFinally};
    static const FormulaOp kUnaryLinear[] = {FormulaOp::kNext, FormulaOp::kGlobally,
                                             FormulaOp::kFinally};
    static const FormulaOp kBinary[] = {FormulaOp::kAnd, FormulaOp::kOr, FormulaOp::kImplies,
                                        FormulaOp::kIff};
    const std::uint32_t choice = random.below(10);
    if (choice == 0) {
        return net::Formula::unary(FormulaOp::kNot, random_formula(random, depth - 1, branching));
    }
    if (choice <= 5) {
        const FormulaOp op =
            branching ? kUnaryBranching[random.below(6)] : kUnaryLinear[random.below(3)];
        return net::Formula::unary(op, random_formula(random, depth - 1, branching));
    }
    FormulaOp op = kBinary[random.below(4)];
    if (choice >= 8) {
        op = !branching             ? FormulaOp::kUntil
             : random.below(2) == 0 ? FormulaOp::kAllUntil
                                    : FormulaOp::kSomeUntil;
    }
    net::Formula a = random_formula(random, depth - 1, branching);
    return net::Formula::binary(
        op, std::move(a),
        random_formula(random, static_cast<int>(random.below(static_cast<std::uint32_t>(depth))),
                       branching));
}

// A linear formula at every position of a word that ends by going round from its last position to
// `back`: least and greatest fixpoints, round by round.
inline std::vector<bool> value_on_word(const net::Formula& f,
                                       const std::vector<std::uint64_t>& word, std::size_t back) {
    using net::FormulaOp;
    const std::size_t n = word.size();
    const auto after = [&](std::size_t i) { return i + 1 < n ? i + 1 : back; };
    std::vector<std::vector<bool>> v;
    for (const net::Formula::Node& node : f.nodes) {
        std::vector<bool> mine(n, node.op == FormulaOp::kGlobally);
        const std::size_t rounds = 2 * n + 2;
        for (std::size_t round = 0; round < rounds; ++round) {
            for (std::size_t i = n; i-- > 0;) {
                const bool a = node.a < v.size() && v[node.a][i];
                const bool b = node.b < v.size() && v[node.b][i];
                switch (node.op) {
                    case FormulaOp::kConstant:
                        mine[i] = node.count != 0;
                        break;
                    case FormulaOp::kMarked:
                        mine[i] = ((word[i] >> node.index) & 1) != 0;
                        break;
                    case FormulaOp::kNot:
                        mine[i] = !a;
                        break;
                    case FormulaOp::kAnd:
                        mine[i] = a && b;
                        break;
                    case FormulaOp::kOr:
                        mine[i] = a || b;
                        break;
                    case FormulaOp::kImplies:
                        mine[i] = !a || b;
                        break;
                    case FormulaOp::kIff:
                        mine[i] = a == b;
                        break;
                    case FormulaOp::kNext:
                        mine[i] = v[node.a][after(i)];
                        break;
                    case FormulaOp::kFinally:
                        mine[i] = a || mine[after(i)];
                        break;
                    case FormulaOp::kGlobally:
                        mine[i] = a && mine[after(i)];
                        break;
                    case FormulaOp::kUntil:
                        mine[i] = b || (a && mine[after(i)]);
                        break;
                    default:
                        FAIL("an operator that the test does not make");
                }
            }
        }
        v.push_back(mine);
    }
    return v.back();
}

// A branching formula in every state: fixpoints as they are defined, round by round.
inline std::vector<bool> value_on_graph(const net::Formula& f, const Graph& g) {
    using net::FormulaOp;
    const std::uint32_t n = g.size();
    std::vector<std::vector<bool>> v;
    for (const net::Formula::Node& node : f.nodes) {
        const bool greatest =
            node.op == FormulaOp::kAllGlobally || node.op == FormulaOp::kSomeGlobally;
        std::vector<bool> mine(n, greatest);
        for (std::uint32_t round = 0; round < n + 2; ++round) {
            for (std::uint32_t s = 0; s < n; ++s) {
                const bool a = node.a < v.size() && v[node.a][s];
                const bool b = node.b < v.size() && v[node.b][s];
                const auto next = [&](bool all, const std::vector<bool>& where) {
                    for (const Edge& e : g.edges.row(s)) {
                        if (where[e.target] != all) {
                            return !all;
                        }
                    }
                    return all;
                };
                const bool ends = g.dead(s) || (g.flags[s] & Graph::kOptional) != 0;
                switch (node.op) {
                    case FormulaOp::kConstant:
                        mine[s] = node.count != 0;
                        break;
                    case FormulaOp::kMarked:
                        mine[s] = g.atoms.must_hold(s, node.index);
                        break;
                    case FormulaOp::kNot:
                        mine[s] = !a;
                        break;
                    case FormulaOp::kAnd:
                        mine[s] = a && b;
                        break;
                    case FormulaOp::kOr:
                        mine[s] = a || b;
                        break;
                    case FormulaOp::kImplies:
                        mine[s] = !a || b;
                        break;
                    case FormulaOp::kIff:
                        mine[s] = a == b;
                        break;
                    case FormulaOp::kAllNext:
                        mine[s] = next(true, v[node.a]);
                        break;
                    case FormulaOp::kSomeNext:
                        mine[s] = next(false, v[node.a]);
                        break;
                    case FormulaOp::kAllGlobally:
                        mine[s] = a && next(true, mine);
                        break;
                    case FormulaOp::kSomeGlobally:
                        mine[s] = a && (ends || next(false, mine));
                        break;
                    case FormulaOp::kAllFinally:
                        mine[s] = a || (!ends && next(true, mine));
                        break;
                    case FormulaOp::kSomeFinally:
                        mine[s] = a || next(false, mine);
                        break;
                    case FormulaOp::kAllUntil:
                        mine[s] = b || (a && !ends && next(true, mine));
                        break;
                    case FormulaOp::kSomeUntil:
                        mine[s] = b || (a && next(false, mine));
                        break;
                    default:
                        FAIL("an operator that the test does not make");
                }
            }
        }
        v.push_back(mine);
    }
    return v.back();
}

// Several states of a graph become one: an over-approximation. Atoms hold for certain where they
// hold in all of them; a path may end where it may in one.
inline Graph merged(const Graph& g, TestRandom& random, std::uint32_t size) {
    std::vector<std::uint32_t> into;
    for (std::uint32_t s = 0; s < g.size(); ++s) {
        into.push_back(random.below(size));
    }
    Graph m;
    m.exact = false;
    m.initial = into[g.initial];
    m.atoms.atoms = g.atoms.atoms;
    for (std::uint32_t group = 0; group < size; ++group) {
        std::uint64_t may = 0, must = ~std::uint64_t{0};
        std::uint8_t flags = 0;
        for (std::uint32_t s = 0; s < g.size(); ++s) {
            if (into[s] != group) {
                continue;
            }
            may |= g.atoms.may[s];
            must &= g.atoms.must[s];
            if (g.dead(s) || (g.flags[s] & Graph::kOptional) != 0) {
                flags = Graph::kOptional;
            }
            for (const Edge& e : g.edges.row(s)) {
                m.edges.items.push_back({e.label, into[e.target]});
            }
        }
        m.edges.starts.push_back(static_cast<std::uint32_t>(m.edges.items.size()));
        m.atoms.may.push_back(may);
        m.atoms.must.push_back(must & may);
        m.flags.push_back(flags);
    }
    return m;
}

}  // namespace puppetri::proof
