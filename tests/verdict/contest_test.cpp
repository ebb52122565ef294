// SPDX-License-Identifier: MIT
// The portfolio against naive exploration of random nets with weights, reads and inhibitors. (The
// contest's own nets and answers: tests/io/contest_test.cpp.)
#include "puppetri/verdict/contest.h"

#include <algorithm>
#include <map>

#include "net/maker.h"
#include "proof/random_graph.h"
#include "puppetri/proof/graph_algorithms.h"
#include "puppetri/proof/ltl.h"

namespace puppetri::verdict {

using net::Formula;
using net::FormulaOp;
using net::Maker;
using proof::Graph;
using proof::TestRandom;

namespace {

constexpr std::uint32_t kPlaces = 4;

struct TestArcs {
    std::uint32_t takes[kPlaces] = {}, gives[kPlaces] = {}, reads[kPlaces] = {};
    std::uint32_t unless[kPlaces] = {};  // 0: none
};
struct TestNet {
    std::vector<std::uint32_t> initial;
    std::vector<TestArcs> transitions;
};

// No transition makes tokens out of nothing: the net is bounded.
TestNet random_net(TestRandom& random) {
    TestNet n;
    for (std::uint32_t p = 0; p < kPlaces; ++p) {
        n.initial.push_back(random.below(3));
    }
    const std::uint32_t transitions = 1 + random.below(5);
    for (std::uint32_t t = 0; t < transitions; ++t) {
        TestArcs arcs;
        std::uint32_t in = 1 + random.below(2);
        for (std::uint32_t i = 0; i < in; ++i) {
            ++arcs.takes[random.below(kPlaces)];
        }
        for (std::uint32_t i = random.below(5) == 0 ? 1 : 0; i < in; ++i) {
            ++arcs.gives[random.below(kPlaces)];
        }
        if (random.below(4) == 0) {
            arcs.reads[random.below(kPlaces)] = 1 + random.below(2);
        }
        if (random.below(4) == 0) {
            arcs.unless[random.below(kPlaces)] = 1 + random.below(2);
        }
        n.transitions.push_back(arcs);
    }
    return n;
}

net::Net compiled(const TestNet& n) {
    Maker make;
    for (std::uint32_t p = 0; p < kPlaces; ++p) {
        make.place("P" + std::to_string(p), n.initial[p]);
    }
    for (std::size_t t = 0; t < n.transitions.size(); ++t) {
        const TestArcs& arcs = n.transitions[t];
        std::vector<std::string> in, out;
        for (std::uint32_t p = 0; p < kPlaces; ++p) {
            const std::string place = "*P" + std::to_string(p);
            if (arcs.takes[p] > 0) {
                in.push_back(std::to_string(arcs.takes[p]) + place);
            }
            if (arcs.reads[p] > 0) {
                in.push_back("with " + std::to_string(arcs.reads[p]) + place);
            }
            if (arcs.unless[p] > 0) {
                in.push_back("unless " + std::to_string(arcs.unless[p]) + place);
            }
            if (arcs.gives[p] > 0) {
                out.push_back(std::to_string(arcs.gives[p]) + place);
            }
        }
        make.t("t" + std::to_string(t), in, out);
    }
    return net::compile(make.draft).value();
}

struct Explored {
    Graph graph;  // atom p: place p is marked; edges are labelled with transitions
    std::vector<std::vector<std::uint32_t>> markings;
};

Explored explored(const TestNet& n) {
    Explored e;
    std::map<std::vector<std::uint32_t>, std::uint32_t> number;
    const auto meet = [&](const std::vector<std::uint32_t>& m) {
        const auto [it, added] = number.emplace(m, static_cast<std::uint32_t>(e.markings.size()));
        if (added) {
            e.markings.push_back(m);
        }
        return it->second;
    };
    meet(n.initial);
    e.graph.exact = true;
    e.graph.atoms.atoms = kPlaces;
    for (std::size_t i = 0; i < e.markings.size(); ++i) {
        const std::vector<std::uint32_t> m = e.markings[i];
        std::uint64_t bits = 0;
        for (std::uint32_t p = 0; p < kPlaces; ++p) {
            bits |= std::uint64_t{m[p] > 0} << p;
        }
        e.graph.atoms.may.push_back(bits);
        e.graph.flags.push_back(0);
        for (std::uint32_t t = 0; t < n.transitions.size(); ++t) {
            const TestArcs& arcs = n.transitions[t];
            bool enabled = true;
            std::vector<std::uint32_t> after = m;
            for (std::uint32_t p = 0; p < kPlaces; ++p) {
                enabled = enabled && m[p] >= arcs.takes[p] && m[p] >= arcs.reads[p] &&
                          (arcs.unless[p] == 0 || m[p] < arcs.unless[p]);
                after[p] += arcs.gives[p] - arcs.takes[p];
            }
            if (enabled) {
                e.graph.edges.items.push_back({t, meet(after)});
            }
        }
        e.graph.edges.starts.push_back(static_cast<std::uint32_t>(e.graph.edges.items.size()));
    }
    e.graph.atoms.must = e.graph.atoms.may;
    return e;
}

std::string word(bool b) { return b ? "TRUE" : "FALSE"; }

proof::Budget budget() {
    proof::Budget b;
    b.seconds = 30;
    return b;
}

ContestQuery query(QueryKind kind, Formula f) {
    ContestQuery q;
    q.id = "q";
    q.kind = kind;
    q.formula = std::move(f);
    return q;
}

}  // namespace

TEST_CASE("examinations agree with naive exploration [oracle]") {
    TestRandom random(31);
    std::map<std::string, int> said;
    for (int i = 0; i < 400; ++i) {
        const TestNet test = random_net(random);
        const net::Net net = compiled(test);
        const Explored e = explored(test);
        const auto transitions = static_cast<std::uint32_t>(test.transitions.size());
        const std::uint32_t states = e.graph.size();
        bool dead = false, one_safe = true, quasi_live = true, live = true, stable = false;
        std::uint64_t most = 0, most_in_place = 0;
        for (std::uint32_t s = 0; s < states; ++s) {
            dead = dead || e.graph.dead(s);
            std::uint64_t sum = 0;
            for (const std::uint32_t count : e.markings[s]) {
                one_safe = one_safe && count <= 1;
                sum += count;
                most_in_place = std::max<std::uint64_t>(most_in_place, count);
            }
            most = std::max(most, sum);
            proof::StateBits from(states);
            from.add(s);
            std::vector<bool> fires(transitions, false);
            proof::reached_from(e.graph, from).for_each([&](std::uint32_t r) {
                for (const proof::Edge& edge : e.graph.edges.row(r)) {
                    fires[edge.label] = true;
                }
            });
            const bool all = std::find(fires.begin(), fires.end(), false) == fires.end();
            live = live && all;
            quasi_live = quasi_live && (s != 0 || all);
        }
        for (std::uint32_t p = 0; p < kPlaces; ++p) {
            bool same = true;
            for (const auto& m : e.markings) {
                same = same && m[p] == test.initial[p];
            }
            stable = stable || same;
        }
        const auto ask = [&](Examination x) {
            return answer_examination(net, x, budget())[0].value;
        };
        const auto check = [&](Examination x, bool expected) {
            INFO(name_of(x));
            CHECK(ask(x) == word(expected));
            ++said[name_of(x) + word(expected)];
        };
        check(Examination::kReachabilityDeadlock, dead);
        check(Examination::kOneSafe, one_safe);
        check(Examination::kQuasiLiveness, quasi_live);
        check(Examination::kLiveness, live);
        check(Examination::kStableMarking, stable);
        const auto counts = answer_examination(net, Examination::kStateSpace, budget());
        REQUIRE(counts.size() == 4);
        CHECK(counts[0].value == std::to_string(states));
        CHECK(counts[1].value == std::to_string(e.graph.edges.items.size()));
        CHECK(counts[2].value == std::to_string(most));
        CHECK(counts[3].value == std::to_string(most_in_place));
    }
    CHECK(said.size() == 10);  // every examination had both answers
}

TEST_CASE("answers to queries of all kinds agree with naive exploration [oracle]") {
    TestRandom random(32);
    std::uint32_t yes = 0, no = 0;
    for (int i = 0; i < 300; ++i) {
        const TestNet test = random_net(random);
        const net::Net net = compiled(test);
        const Explored e = explored(test);
        std::vector<ContestQuery> queries;
        std::vector<std::string> expected;
        for (int k = 0; k < 3; ++k) {
            Formula f = proof::random_formula(random, 1 + static_cast<int>(random.below(3)), true);
            expected.push_back(word(proof::value_on_graph(f, e.graph)[0]));
            queries.push_back(query(QueryKind::kCtl, std::move(f)));

            f = proof::random_formula(random, 1 + static_cast<int>(random.below(3)), false);
            const proof::Temporal t = proof::taken_apart(f);
            const Graph g = proof::with_atoms_of(t, e.graph);
            expected.push_back(
                word(proof::check_ltl(g, t, proof::own_atoms(t), {}).holds == proof::Truth::kTrue));
            queries.push_back(query(QueryKind::kLtl, f));
            // Some path satisfies f, if not all satisfy its negation.
            const proof::Temporal not_t =
                proof::taken_apart(Formula::unary(FormulaOp::kNot, std::move(f)));
            const Graph h = proof::with_atoms_of(not_t, e.graph);
            expected.push_back(word(proof::check_ltl(h, not_t, proof::own_atoms(not_t), {}).holds ==
                                    proof::Truth::kFalse));
            queries.push_back(query(QueryKind::kLtl, queries.back().formula));
            queries.back().exists = true;

            f = Formula::binary(FormulaOp::kAnd, Formula::marked({random.below(kPlaces)}),
                                Formula::fireable({random.below(
                                    static_cast<std::uint32_t>(test.transitions.size()))}));
            const std::uint32_t place = f.nodes[0].index, fires = f.nodes[1].index;
            bool found = false;
            for (std::uint32_t s = 0; s < e.graph.size(); ++s) {
                for (const proof::Edge& edge : e.graph.edges.row(s)) {
                    found = found || (edge.label == fires && e.markings[s][place] > 0);
                }
            }
            expected.push_back(word(found));
            queries.push_back(
                query(QueryKind::kReachability, Formula::unary(FormulaOp::kSomeFinally, f)));
            expected.push_back(word(!found));
            queries.push_back(query(QueryKind::kReachability,
                                    Formula::unary(FormulaOp::kAllGlobally,
                                                   Formula::unary(FormulaOp::kNot, std::move(f)))));
        }
        for (const bool both : {false, true}) {
            ContestQuery q;
            q.kind = QueryKind::kUpperBound;
            const std::uint32_t a = random.below(kPlaces), b = both ? random.below(kPlaces) : a;
            const auto count = [](std::uint32_t p) {
                return Expr::slot(net::slot(net::SlotKind::kCount, p), {ValueKind::kInt});
            };
            q.bound = both ? net::expr(ExprOp::kAdd, count(a), count(b)) : count(a);
            std::uint32_t most = 0;
            for (const auto& m : e.markings) {
                most = std::max(most, both ? m[a] + m[b] : m[a]);
            }
            expected.push_back(std::to_string(most));
            queries.push_back(std::move(q));
        }
        const auto answers = answer_queries(net, queries, budget());
        for (std::size_t k = 0; k < queries.size(); ++k) {
            CAPTURE(k);
            CHECK(answers[k].value == expected[k]);
            yes += answers[k].value == "TRUE" ? 1 : 0;
            no += answers[k].value == "FALSE" ? 1 : 0;
        }
    }
    CHECK(yes > 1000);
    CHECK(no > 1000);
}

TEST_CASE("without time nothing is answered that takes time, and nothing is wrong [unit]") {
    TestRandom random(33);
    for (int i = 0; i < 100; ++i) {
        const TestNet test = random_net(random);
        const net::Net net = compiled(test);
        const Explored e = explored(test);
        proof::Budget none;
        none.seconds = 0;
        const Formula f = proof::random_formula(random, 3, true);
        const ContestQuery q = query(QueryKind::kCtl, f);
        const auto answers = answer_queries(net, {&q, 1}, none);
        if (!answers[0].value.empty()) {
            CHECK(answers[0].value == word(proof::value_on_graph(f, e.graph)[0]));
        } else {
            CHECK_FALSE(answers[0].reason.empty());
            CHECK(contest_line(answers[0]) == "CANNOT_COMPUTE");
        }
    }
}

TEST_CASE("an unbounded net ends with what is known [unit]") {
    Maker make;
    make.place("P", 1);
    make.t("grow", {"P"}, {"2*P"});
    make.t("stop", {"P"}, {"Q"});
    const net::Net net = net::compile(make.draft).value();
    proof::Budget small;
    small.seconds = 1;
    small.bytes = std::uint64_t{64} << 20;
    CHECK(answer_examination(net, Examination::kReachabilityDeadlock, small)[0].value == "TRUE");
    CHECK(answer_examination(net, Examination::kOneSafe, small)[0].value == "FALSE");
    CHECK(answer_examination(net, Examination::kQuasiLiveness, small)[0].value == "TRUE");
    CHECK(answer_examination(net, Examination::kLiveness, small)[0].value == "FALSE");
    CHECK(answer_examination(net, Examination::kStateSpace, small)[0].value.empty());
}

TEST_CASE("a net that is more than places and arcs is not answered for [unit]") {
    Maker make;
    make.place("P", 1, net::lasts(1));
    make.t("t", {"P"}, {"P"});
    const net::Net net = net::compile(make.draft).value();
    const auto answers = answer_examination(net, Examination::kLiveness, budget());
    CHECK(answers[0].value.empty());
    CHECK_FALSE(answers[0].reason.empty());
}

TEST_CASE("a transition that higher priorities always block is not quasi-live [unit]") {
    Maker make;
    make.place("P", 1);
    make.t("high", {"P"}, {"Q"}).priority = 2;
    make.t("low", {"P"}, {"R"});
    make.t("back", {"Q"}, {"P"});
    const auto quasi_live = [&] {
        const net::Net net = net::compile(make.draft).value();
        return answer_examination(net, Examination::kQuasiLiveness, budget())[0].value;
    };
    CHECK(quasi_live() == "FALSE");
    make.draft.transitions[0].priority = 1;
    CHECK(quasi_live() == "TRUE");
}

TEST_CASE("lines have the contest's form [unit]") {
    CHECK(contest_line({"Net-PT-CTL-00", "TRUE", "EXPLICIT", ""}) ==
          "FORMULA Net-PT-CTL-00 TRUE TECHNIQUES EXPLICIT");
    CHECK(contest_line({"STATES", "42", "DECISION_DIAGRAMS", ""}) ==
          "STATE_SPACE STATES 42 TECHNIQUES DECISION_DIAGRAMS");
    CHECK(contest_line({"Liveness", "", "", "the budget ended"}) == "CANNOT_COMPUTE");
}

}  // namespace puppetri::verdict
