// SPDX-License-Identifier: MIT
// CTL against the definitions of its operators, on random graphs with dead and optional states.
#include "puppetri/proof/ctl.h"

#include "proof/random_graph.h"

namespace puppetri::proof {

using net::Formula;
using net::FormulaOp;

namespace {

// Needs  every path of the lasso's edges to be one of the graph.
void check_is_path(const Graph& g, const Lasso& lasso) {
    std::uint32_t s = g.initial;
    const auto follow = [&](const Path& path) {
        for (const std::uint32_t edge : path) {
            REQUIRE(edge >= g.edges.starts[s]);
            REQUIRE(edge < g.edges.starts[s + 1]);
            s = g.edges.items[edge].target;
        }
    };
    follow(lasso.stem);
    const std::uint32_t entry = s;
    follow(lasso.loop);
    CHECK(s == entry);
}

}  // namespace

TEST_CASE("CTL labels are those of the definitions, whatever the nesting [oracle]") {
    TestRandom random(1);
    const Budget budget;
    std::uint32_t held = 0, total = 0;
    for (int i = 0; i < 3000; ++i) {
        const Graph g = random_graph(random, 1 + random.below(9));
        for (int k = 0; k < 3; ++k) {
            const Formula f = random_formula(random, 1 + static_cast<int>(random.below(4)), true);
            const std::vector<bool> expected = value_on_graph(f, g);
            const Temporal t = taken_apart(f);
            REQUIRE(t.logic != Temporal::Logic::kNeither);
            const Graph asked = with_atoms_of(t, g);
            CtlChecker checker(asked);
            const auto labels = checker.label(t, own_atoms(t), budget);
            REQUIRE(labels.has_value());
            for (std::uint32_t s = 0; s < g.size(); ++s) {
                REQUIRE(labels->must[s] == expected[s]);
                REQUIRE(labels->may[s] == expected[s]);
                held += expected[s] ? 1 : 0;
                ++total;
            }
            const auto lasso = checker.evidence(t, own_atoms(t), budget);
            if (lasso.has_value()) {
                check_is_path(g, *lasso);
            }
        }
    }
    CHECK(held > total / 4);
    CHECK(held < total - total / 4);
}

TEST_CASE("what an over-approximation says of a CTL formula is true of the graph [law]") {
    TestRandom random(2);
    const Budget budget;
    std::uint32_t proved = 0, refuted = 0;
    for (int i = 0; i < 4000; ++i) {
        const Graph g = random_graph(random, 2 + random.below(8));
        const Graph m = merged(g, random, 1 + random.below(g.size()));
        const Formula f = random_formula(random, 1 + static_cast<int>(random.below(3)), true);
        const Temporal t = taken_apart(f);
        const Graph asked = with_atoms_of(t, m);
        const Truth answer = CtlChecker(asked).holds(t, own_atoms(t), budget);
        const bool expected = value_on_graph(f, g)[g.initial];
        if (answer != Truth::kUnknown) {
            REQUIRE(expected == (answer == Truth::kTrue));
            (expected ? proved : refuted) += 1;
        }
    }
    CHECK(proved > 200);
    CHECK(refuted > 200);
}

TEST_CASE("what a graph that was cut says of a CTL formula is true of the whole [law]") {
    TestRandom random(3);
    const Budget budget;
    std::uint32_t proved = 0, refuted = 0;
    for (int i = 0; i < 4000; ++i) {
        const Graph g = random_graph(random, 2 + random.below(8));
        Graph cut = g;  // some states lose all their edges, and it is not known what they do
        cut.edges = {};
        for (std::uint32_t s = 0; s < g.size(); ++s) {
            if (random.below(4) == 0) {
                cut.flags[s] = Graph::kCut;
            } else {
                for (const Edge& e : g.edges.row(s)) {
                    cut.edges.items.push_back(e);
                }
            }
            cut.edges.starts.push_back(static_cast<std::uint32_t>(cut.edges.items.size()));
        }
        const Formula f = random_formula(random, 1 + static_cast<int>(random.below(3)), true);
        const Temporal t = taken_apart(f);
        const Graph asked = with_atoms_of(t, cut);
        const Truth answer = CtlChecker(asked).holds(t, own_atoms(t), budget);
        const bool expected = value_on_graph(f, g)[g.initial];
        if (answer != Truth::kUnknown) {
            REQUIRE(expected == (answer == Truth::kTrue));
            (expected ? proved : refuted) += 1;
        }
    }
    CHECK(proved > 200);
    CHECK(refuted > 200);
}

TEST_CASE("evidence of E-formulas and of failing A-formulas shows what it says [unit]") {
    TestRandom random(4);
    const Budget budget;
    std::uint32_t shown = 0;
    for (int i = 0; i < 2000; ++i) {
        const Graph g = random_graph(random, 2 + random.below(8));
        const auto ask = [&](const Formula& f) {
            const Temporal t = taken_apart(f);
            const Graph asked = with_atoms_of(t, g);
            return CtlChecker(asked).evidence(t, own_atoms(t), budget);
        };
        const Formula reach = Formula::unary(FormulaOp::kSomeFinally, test_atom(0));
        if (value_on_graph(reach, g)[g.initial]) {
            const auto lasso = ask(reach);
            REQUIRE(lasso.has_value());
            CHECK(g.atoms.must_hold(states_along(g, g.initial, lasso->stem).back(), 0));
            ++shown;
        }
        const Formula inevitable = Formula::unary(FormulaOp::kAllFinally, test_atom(0));
        if (!value_on_graph(inevitable, g)[g.initial]) {
            const auto lasso = ask(inevitable);
            REQUIRE(lasso.has_value());
            Path whole = lasso->stem;
            whole.insert(whole.end(), lasso->loop.begin(), lasso->loop.end());
            const auto states = states_along(g, g.initial, whole);
            for (const std::uint32_t s : states) {
                CHECK_FALSE(g.atoms.must_hold(s, 0));
            }
            CHECK((!lasso->loop.empty() || may_end(g, states.back())));
            ++shown;
        }
    }
    CHECK(shown > 1000);
}

TEST_CASE("in a dead state EX is false, AX true, EG and AF are the formula itself [unit]") {
    Graph g;
    g.exact = true;
    g.atoms = {1, {1}, {1}};
    g.edges.starts.push_back(0);
    g.flags = {0};
    CtlChecker checker(g);
    const auto holds = [&](FormulaOp op, Formula a) {
        const Temporal t = taken_apart(Formula::unary(op, std::move(a)));
        const std::vector<std::uint32_t> atoms(t.atoms.size(), 0);
        return checker.holds(t, atoms, {}) == Truth::kTrue;
    };
    const Formula yes = test_atom(0), no = Formula::unary(FormulaOp::kNot, test_atom(0));
    CHECK_FALSE(holds(FormulaOp::kSomeNext, yes));
    CHECK_FALSE(holds(FormulaOp::kSomeNext, Formula::constant(true)));
    CHECK(holds(FormulaOp::kAllNext, no));
    CHECK(holds(FormulaOp::kSomeGlobally, yes));
    CHECK_FALSE(holds(FormulaOp::kSomeGlobally, no));
    CHECK(holds(FormulaOp::kAllFinally, yes));
    CHECK_FALSE(holds(FormulaOp::kAllFinally, no));
}

TEST_CASE("a chain of a million states needs no stack [law]") {
    Graph g;
    g.exact = true;
    g.atoms.atoms = 1;
    const std::uint32_t size = 1000000;
    for (std::uint32_t s = 0; s < size; ++s) {
        if (s + 1 < size) {
            g.edges.items.push_back({0, s + 1});
        }
        g.edges.starts.push_back(static_cast<std::uint32_t>(g.edges.items.size()));
        g.atoms.may.push_back(s + 1 == size ? 1 : 0);
    }
    g.atoms.must = g.atoms.may;
    g.flags.assign(size, 0);
    CtlChecker checker(g);
    const Temporal t = taken_apart(Formula::unary(FormulaOp::kAllFinally, test_atom(0)));
    CHECK(checker.holds(t, own_atoms(t), {}) == Truth::kTrue);
    const Temporal u = taken_apart(Formula::unary(FormulaOp::kSomeFinally, test_atom(0)));
    CHECK(checker.evidence(u, own_atoms(u), {})->stem.size() == size - 1);
    CHECK(strong_components(g).count == size);
}

TEST_CASE("a spent budget gives no answer [unit]") {
    TestRandom random(5);
    const Graph g = random_graph(random, 5);
    CtlChecker checker(g);
    Budget budget;
    budget.seconds = 0;
    const Temporal t = taken_apart(Formula::unary(FormulaOp::kAllFinally, test_atom(0)));
    CHECK(checker.holds(t, own_atoms(t), budget) == Truth::kUnknown);
}

}  // namespace puppetri::proof
