// SPDX-License-Identifier: MIT
// Automata against the meaning of formulas on words; LTL on graphs against all short lassos.
#include "puppetri/proof/ltl.h"

#include "proof/random_graph.h"

namespace puppetri::proof {

using net::Formula;
using net::FormulaOp;

namespace {

Formula unary(FormulaOp op, Formula a) { return Formula::unary(op, std::move(a)); }
Formula binary(FormulaOp op, Formula a, Formula b) {
    return Formula::binary(op, std::move(a), std::move(b));
}

// Letters as the automaton counts its atoms.
std::uint64_t letter_of(const Temporal& t, std::uint64_t bits) {
    std::uint64_t letter = 0;
    for (std::size_t i = 0; i < t.atoms.size(); ++i) {
        letter |= std::uint64_t{must_and_may(t.atoms[i], bits, bits).first} << i;
    }
    return letter;
}

LtlAnswer ask(const Graph& g, const Temporal& t) {
    return check_ltl(with_atoms_of(t, g), t, own_atoms(t), {});
}

bool accepts_word(const Buechi& b, const Temporal& t, const std::vector<std::uint64_t>& word,
                  std::size_t back) {
    std::vector<std::uint64_t> letters;
    for (const std::uint64_t bits : word) {
        letters.push_back(letter_of(t, bits));
    }
    const std::span<const std::uint64_t> all(letters);
    return accepts(b, all.subspan(0, back), all.subspan(back));
}

// Whether a run of the graph violates the formula: every path of at most `depth` edges that ends or
// comes back to one of its states.
bool violated_by_a_short_run(const Formula& f, const Graph& g, std::vector<std::uint32_t>& path,
                             std::size_t depth) {
    const auto violates = [&](std::size_t back) {
        std::vector<std::uint64_t> word;
        for (const std::uint32_t s : path) {
            word.push_back(g.atoms.must[s]);
        }
        return !value_on_word(f, word, back)[0];
    };
    const std::uint32_t s = path.back();
    if (may_end(g, s) && violates(path.size() - 1)) {
        return true;
    }
    for (const Edge& e : g.edges.row(s)) {
        for (std::size_t back = 0; back < path.size(); ++back) {
            if (path[back] == e.target && violates(back)) {
                return true;
            }
        }
        if (path.size() <= depth) {
            path.push_back(e.target);
            if (violated_by_a_short_run(f, g, path, depth)) {
                return true;
            }
            path.pop_back();
        }
    }
    return false;
}

// The lasso is a path of the graph and violates the formula.
void check_counterexample(const Formula& f, const Graph& g, const Lasso& lasso) {
    std::vector<std::uint32_t> states = states_along(g, g.initial, lasso.stem);
    std::uint32_t s = g.initial;
    Path whole = lasso.stem;
    whole.insert(whole.end(), lasso.loop.begin(), lasso.loop.end());
    for (const std::uint32_t edge : whole) {
        REQUIRE(edge >= g.edges.starts[s]);
        REQUIRE(edge < g.edges.starts[s + 1]);
        s = g.edges.items[edge].target;
    }
    std::size_t back = states.size() - 1;
    if (lasso.loop.empty()) {
        REQUIRE(may_end(g, s));
    } else {
        REQUIRE(s == states.back());
        const auto round = states_along(g, s, lasso.loop);
        states.insert(states.end(), round.begin() + 1, round.end() - 1);
    }
    std::vector<std::uint64_t> word;
    for (const std::uint32_t state : states) {
        word.push_back(g.atoms.must[state]);
    }
    CHECK_FALSE(value_on_word(f, word, back)[0]);
}

}  // namespace

TEST_CASE("an automaton accepts the words that satisfy its formula, and no others [oracle]") {
    TestRandom random(11);
    std::uint32_t accepted = 0, total = 0;
    for (int i = 0; i < 5000; ++i) {
        const Formula f = random_formula(random, 1 + static_cast<int>(random.below(4)), false);
        const Temporal t = taken_apart(f);
        REQUIRE(t.logic != Temporal::Logic::kNeither);
        const auto yes = automaton_of(t, false, 200), no = automaton_of(t, true, 200);
        if (!yes.has_value() || !no.has_value()) {
            continue;
        }
        for (int k = 0; k < 12; ++k) {
            std::vector<std::uint64_t> word(1 + random.below(7));
            for (std::uint64_t& bits : word) {
                bits = random.below(1u << kTestAtoms);
            }
            const std::size_t back = random.below(static_cast<std::uint32_t>(word.size()));
            const bool expected = value_on_word(f, word, back)[0];
            REQUIRE(accepts_word(*yes, t, word, back) == expected);
            REQUIRE(accepts_word(*no, t, word, back) != expected);
            accepted += expected ? 1 : 0;
            ++total;
        }
    }
    CHECK(total > 40000);
    CHECK(accepted > total / 4);
    CHECK(accepted < total - total / 4);
}

TEST_CASE("automata of common formulas are as small as they can be [unit]") {
    const auto size = [](const Formula& f) { return automaton_of(taken_apart(f), false)->size(); };
    const Formula a = test_atom(0), b = test_atom(1);
    CHECK(size(unary(FormulaOp::kGlobally, a)) == 1);
    CHECK(size(unary(FormulaOp::kGlobally, unary(FormulaOp::kFinally, a))) == 1);
    CHECK(size(unary(FormulaOp::kFinally, a)) == 2);
    CHECK(size(binary(FormulaOp::kUntil, a, b)) == 2);
    CHECK(size(unary(FormulaOp::kFinally, unary(FormulaOp::kGlobally, a))) == 2);
    // G(a -> F b): with nothing owed, and with b owed
    CHECK(size(unary(FormulaOp::kGlobally,
                     binary(FormulaOp::kImplies, a, unary(FormulaOp::kFinally, b)))) <= 2);
    // n strong fairness assumptions in one state: acceptance on edges
    Formula fair = Formula::constant(true);
    for (std::uint32_t i = 0; i < 5; ++i) {
        fair = binary(FormulaOp::kAnd, std::move(fair),
                      unary(FormulaOp::kGlobally, unary(FormulaOp::kFinally, test_atom(i))));
    }
    CHECK(size(fair) == 1);
    CHECK(size(Formula::constant(false)) == 0);
    CHECK(size(Formula::constant(true)) == 1);
}

TEST_CASE("LTL on graphs agrees with all short runs, and its counterexamples are real [oracle]") {
    TestRandom random(12);
    std::uint32_t held = 0, failed = 0;
    for (int i = 0; i < 4000; ++i) {
        const Graph g = random_graph(random, 1 + random.below(5));
        const Formula f = random_formula(random, 1 + static_cast<int>(random.below(4)), false);
        const Temporal t = taken_apart(f);
        const LtlAnswer answer = ask(g, t);
        if (answer.holds == Truth::kFalse) {
            REQUIRE(answer.counterexample.has_value());
            check_counterexample(f, g, *answer.counterexample);
            ++failed;
        } else if (answer.holds == Truth::kTrue) {
            std::vector<std::uint32_t> path = {g.initial};
            REQUIRE_FALSE(violated_by_a_short_run(f, g, path, 5));
            ++held;
        }
    }
    CHECK(held > 1000);
    CHECK(failed > 1000);
}

TEST_CASE("what an over-approximation proves of an LTL formula is true of the graph [law]") {
    TestRandom random(13);
    std::uint32_t proved = 0;
    for (int i = 0; i < 4000; ++i) {
        const Graph g = random_graph(random, 2 + random.below(7));
        const Graph m = merged(g, random, 1 + random.below(g.size()));
        const Formula f = random_formula(random, 1 + static_cast<int>(random.below(3)), false);
        const Temporal t = taken_apart(f);
        const Truth answer = ask(m, t).holds;
        REQUIRE(answer != Truth::kFalse);
        if (answer == Truth::kTrue) {
            REQUIRE(ask(g, t).holds == Truth::kTrue);
            ++proved;
        }
    }
    CHECK(proved > 300);
}

TEST_CASE("where a graph was cut, and atoms in doubt, LTL says only what is certain [law]") {
    TestRandom random(14);
    std::uint32_t proved = 0, refuted = 0;
    for (int i = 0; i < 6000; ++i) {
        const Graph g = random_graph(random, 2 + random.below(7));
        Graph doubtful = g;
        doubtful.edges = {};
        for (std::uint32_t s = 0; s < g.size(); ++s) {
            if (random.below(5) == 0) {
                doubtful.flags[s] = Graph::kCut;
            } else {
                for (const Edge& e : g.edges.row(s)) {
                    doubtful.edges.items.push_back(e);
                }
            }
            doubtful.edges.starts.push_back(
                static_cast<std::uint32_t>(doubtful.edges.items.size()));
            const std::uint64_t doubt = random.below(4) == 0 ? random.below(8) : 0;
            doubtful.atoms.may[s] |= doubt;
            doubtful.atoms.must[s] &= ~doubt;
        }
        const Formula f = random_formula(random, 1 + static_cast<int>(random.below(3)), false);
        const Temporal t = taken_apart(f);
        const Truth answer = ask(doubtful, t).holds;
        if (answer != Truth::kUnknown) {
            REQUIRE(ask(g, t).holds == answer);
            (answer == Truth::kTrue ? proved : refuted) += 1;
        }
    }
    CHECK(proved > 300);
    CHECK(refuted > 300);
}

TEST_CASE("an ended run stands in its last state, a pause on the way is no run [unit]") {
    // 0 -> 1, atom 0 in state 0 only; in state 0 the run may also end.
    Graph g;
    g.exact = true;
    g.edges.items = {{0, 1}};
    g.edges.starts = {0, 1, 1};
    g.flags = {0, 0};
    g.atoms = {1, {1, 0}, {1, 0}};
    const auto holds = [&](const Formula& f) {
        const Temporal t = taken_apart(f);
        return ask(g, t).holds == Truth::kTrue;
    };
    const Formula a = test_atom(0), not_a = unary(FormulaOp::kNot, a);
    CHECK(holds(unary(FormulaOp::kNext, not_a)));
    CHECK(holds(unary(FormulaOp::kNext, unary(FormulaOp::kNext, not_a))));
    g.flags[0] = Graph::kOptional;
    CHECK_FALSE(holds(unary(FormulaOp::kNext, not_a)));
    // Either always, or not even in the next state.
    CHECK(holds(
        binary(FormulaOp::kOr, unary(FormulaOp::kGlobally, a), unary(FormulaOp::kNext, not_a))));
}

}  // namespace puppetri::proof
