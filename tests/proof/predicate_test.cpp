// SPDX-License-Identifier: MIT
// Predicates against a direct evaluation of the formulas that they come from, on random markings.
#include "puppetri/proof/predicate.h"

#include <string>

#include "net/maker.h"
#include "puppetri/base/random.h"
#include "puppetri/net/draft.h"

namespace puppetri::proof {
namespace {

using net::Formula;
using net::FormulaOp;
using net::Maker;

constexpr std::uint32_t kPlaces = 4;

// Four places, four transitions with weights, a read and an inhibitor arc.
net::Net example() {
    Maker make;
    for (std::uint32_t p = 0; p < kPlaces; ++p) {
        make.p("P" + std::to_string(p));
    }
    make.t("t0", {"P0"}, {"P1"});
    make.t("t1", {"2*P1", "with P2"}, {"P3"});
    make.t("t2", {"P3", "unless 2*P0"}, {"P0"});
    make.t("t3", {"3*P2"}, {"P2"});
    return net::compile(make.draft).value();
}

PlainNet example_plain() {
    PlainNet n;
    const auto row = [](net::Rows<net::Weighted>& rows, std::vector<net::Weighted> items) {
        rows.items.insert(rows.items.end(), items.begin(), items.end());
        rows.starts.push_back(static_cast<std::uint32_t>(rows.items.size()));
    };
    row(n.takes, {{0, 1}}), row(n.takes, {{1, 2}}), row(n.takes, {{3, 1}}), row(n.takes, {{2, 3}});
    row(n.gives, {{1, 1}}), row(n.gives, {{3, 1}}), row(n.gives, {{0, 1}}), row(n.gives, {{2, 1}});
    row(n.reads, {}), row(n.reads, {{2, 1}}), row(n.reads, {}), row(n.reads, {});
    row(n.unless, {}), row(n.unless, {}), row(n.unless, {{0, 2}}), row(n.unless, {});
    n.initial.assign(kPlaces, 0);
    return n;
}

bool fireable(std::uint32_t t, const Marking& m) {
    switch (t) {
        case 0:
            return m[0] >= 1;
        case 1:
            return m[1] >= 2 && m[2] >= 1;
        case 2:
            return m[3] >= 1 && m[0] < 2;
        default:
            return m[2] >= 3;
    }
}

// The value of an expression of counts, straight from its nodes.
std::int64_t value(const Expr& e, const Marking& m) {
    std::vector<std::int64_t> v;
    for (const Expr::Node& n : e.nodes()) {
        const std::int64_t a = n.a < v.size() ? v[n.a] : 0, b = n.b < v.size() ? v[n.b] : 0;
        switch (n.op) {
            case ExprOp::kLiteral:
                v.push_back(n.literal);
                break;
            case ExprOp::kSlot:
                v.push_back(m[n.slot.index]);
                break;
            case ExprOp::kAdd:
                v.push_back(a + b);
                break;
            case ExprOp::kSubtract:
                v.push_back(a - b);
                break;
            case ExprOp::kMultiply:
                v.push_back(a * b);
                break;
            case ExprOp::kLess:
                v.push_back(a < b ? 1 : 0);
                break;
            case ExprOp::kLessEqual:
                v.push_back(a <= b ? 1 : 0);
                break;
            case ExprOp::kGreater:
                v.push_back(a > b ? 1 : 0);
                break;
            case ExprOp::kGreaterEqual:
                v.push_back(a >= b ? 1 : 0);
                break;
            case ExprOp::kEqual:
                v.push_back(a == b ? 1 : 0);
                break;
            case ExprOp::kNotEqual:
                v.push_back(a != b ? 1 : 0);
                break;
            case ExprOp::kNot:
                v.push_back(1 - a);
                break;
            case ExprOp::kAnd:
                v.push_back(a & b);
                break;
            default:
                FAIL("an operator that the test does not make");
        }
    }
    return v.back();
}

bool value(const Formula& f, const Marking& m) {
    std::vector<bool> v;
    for (const Formula::Node& n : f.nodes) {
        const bool a = n.a < v.size() && v[n.a], b = n.b < v.size() && v[n.b];
        switch (n.op) {
            case FormulaOp::kConstant:
                v.push_back(n.count != 0);
                break;
            case FormulaOp::kMarked:
                v.push_back(std::int64_t{m[n.index]} >= n.count);
                break;
            case FormulaOp::kFireable:
                v.push_back(fireable(n.index, m));
                break;
            case FormulaOp::kExpr:
                v.push_back(value(f.expressions[n.index], m) != 0);
                break;
            case FormulaOp::kNot:
                v.push_back(!a);
                break;
            case FormulaOp::kAnd:
                v.push_back(a && b);
                break;
            case FormulaOp::kOr:
                v.push_back(a || b);
                break;
            case FormulaOp::kImplies:
                v.push_back(!a || b);
                break;
            case FormulaOp::kIff:
                v.push_back(a == b);
                break;
            default:
                FAIL("an operator that the test does not make");
        }
    }
    return v.back();
}

class Random {
 public:
    explicit Random(std::uint64_t seed) : state_(seed) {}
    std::uint32_t below(std::uint32_t n) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return static_cast<std::uint32_t>((state_ >> 33) % n);
    }

 private:
    std::uint64_t state_;
};

Expr random_sum(Random& random, int depth) {
    const Expr place =
        Expr::slot(net::slot(net::SlotKind::kCount, random.below(kPlaces)), {ValueKind::kInt});
    if (depth == 0) {
        return random.below(3) == 0 ? Expr::integer(random.below(7)) : place;
    }
    if (random.below(4) == 0) {
        return net::expr(ExprOp::kMultiply, Expr::integer(std::int64_t{random.below(7)} - 3),
                         random_sum(random, depth - 1));
    }
    return net::expr(random.below(2) == 0 ? ExprOp::kAdd : ExprOp::kSubtract,
                     random_sum(random, depth - 1), random_sum(random, depth - 1));
}

Expr random_comparison(Random& random) {
    static const ExprOp kOps[] = {ExprOp::kLess,         ExprOp::kLessEqual, ExprOp::kGreater,
                                  ExprOp::kGreaterEqual, ExprOp::kEqual,     ExprOp::kNotEqual};
    Expr e = net::expr(kOps[random.below(6)], random_sum(random, 2), random_sum(random, 1));
    if (random.below(4) == 0) {
        e = Expr::unary(ExprOp::kNot, std::move(e)).value();
    }
    return random.below(4) == 0 ? net::expr(ExprOp::kAnd, std::move(e), random_comparison(random))
                                : e;
}

Formula random_formula(Random& random, int depth) {
    if (depth == 0) {
        switch (random.below(5)) {
            case 0:
                return Formula::marked({random.below(kPlaces)}, random.below(4));
            case 1:
                return Formula::expression(random_comparison(random));
            case 2:
                return random.below(4) == 0 ? Formula::constant(random.below(2) == 0)
                                            : Formula::fireable({0});
            default:
                return Formula::fireable({random.below(4)});
        }
    }
    static const FormulaOp kOps[] = {FormulaOp::kAnd, FormulaOp::kOr, FormulaOp::kImplies,
                                     FormulaOp::kIff};
    if (random.below(4) == 0) {
        return Formula::unary(FormulaOp::kNot, random_formula(random, depth - 1));
    }
    return Formula::binary(kOps[random.below(4)], random_formula(random, depth - 1),
                           random_formula(random, depth - 1));
}

Marking random_marking(Random& random) {
    Marking m(kPlaces);
    for (std::uint32_t& count : m) {
        count = random.below(5);
    }
    return m;
}

}  // namespace

TEST_CASE("a predicate holds where its formula does, compiled or not, negated or not [oracle]") {
    const net::Net net = example();
    const PlainNet plain = example_plain();
    const std::vector<std::uint32_t> upper(kPlaces, 4);  // random markings have at most 4
    Random random(20260722);
    std::uint32_t held = 0, constants = 0;
    for (int i = 0; i < 4000; ++i) {
        const Formula f = random_formula(random, static_cast<int>(random.below(5)));
        const auto p = predicate_of(net, f);
        REQUIRE(p.has_value());
        const CompiledPredicate compiled(plain, *p);
        const CompiledPredicate negated(plain, p->negated());
        const Predicate narrow = simplified(*p, plain, upper);
        const CompiledPredicate narrow_compiled(plain, narrow);
        constants += narrow.is_constant(true) || narrow.is_constant(false) ? 1 : 0;
        for (int k = 0; k < 20; ++k) {
            const Marking m = random_marking(random);
            const bool expected = value(f, m);
            held += expected ? 1 : 0;
            REQUIRE(p->holds(plain, m) == expected);
            REQUIRE(compiled.holds(m) == expected);
            REQUIRE(negated.holds(m) != expected);
            REQUIRE(narrow_compiled.holds(m) == expected);
        }
    }
    CHECK(held > 20000);  // both answers are common
    CHECK(held < 60000);
    CHECK(constants > 100);
}

TEST_CASE("inequalities have one form, and constants vanish [unit]") {
    const auto sum = [](std::vector<LinearSum::Term> terms) { return LinearSum{std::move(terms)}; };
    // -2a - 4b <= -5 is a + 2b >= 3
    const Predicate p = Predicate::at_most(sum({{0, -2}, {1, -4}}), -5);
    REQUIRE(p.nodes.size() == 1);
    CHECK(p.nodes[0].op == Predicate::Op::kAtLeast);
    CHECK(p.nodes[0].limit == 3);
    CHECK(p.sums[0] == sum({{0, 1}, {1, 2}}));
    CHECK(Predicate::at_least(sum({{0, 1}}), 0).is_constant(true));
    CHECK(Predicate::at_most(sum({{0, 1}}), -1).is_constant(false));
    CHECK(Predicate::at_least(sum({{0, 1}, {0, -1}}), 1).is_constant(false));
    const Predicate parts[] = {p, Predicate::constant(true)};
    CHECK(Predicate::all_of(parts).nodes.size() == 1);
    CHECK(Predicate::any_of(parts).is_constant(true));
    CHECK(Predicate::enabled({}).is_constant(false));
    CHECK(Predicate::any_of({}).is_constant(false));
    CHECK(Predicate::all_of({}).is_constant(true));
}

TEST_CASE("a state is dead when none of the transitions that count is enabled [unit]") {
    PlainNet plain = example_plain();
    CHECK(Predicate::no_successor(plain).holds(plain, Marking{0, 1, 2, 0}));
    CHECK_FALSE(Predicate::no_successor(plain).holds(plain, Marking{0, 2, 1, 0}));
    plain.optional = {0, 1, 0, 0};
    CHECK(Predicate::no_successor(plain).holds(plain, Marking{0, 2, 1, 0}));
}

TEST_CASE("what counts alone do not decide is no predicate [unit]") {
    Maker make;
    make.place("walk", 1, net::lasts(1));
    make.place("P", 1);
    make.t("late", {"walk"}, {"P"});
    make.t("plain", {"P"}, {"P"});
    const net::Net net = net::compile(make.draft).value();
    CHECK(predicate_of(net, Formula::marked(net.find_place("walk"))).has_value());
    CHECK_FALSE(predicate_of(net, Formula::ready(net.find_place("walk"))).has_value());
    CHECK(predicate_of(net, Formula::ready(net.find_place("P"))).has_value());
    CHECK_FALSE(predicate_of(net, Formula::fireable(net.find_transition("late"))).has_value());
    CHECK(predicate_of(net, Formula::fireable(net.find_transition("plain"))).has_value());
    CHECK_FALSE(predicate_of(net, Formula::fires(net.find_transition("plain"))).has_value());
    CHECK_FALSE(
        predicate_of(net, Formula::unary(FormulaOp::kNext, Formula::constant(true))).has_value());
    const auto count = [&](const char* p) {
        return Expr::slot(net::slot(net::SlotKind::kCount, net.find_place(p).value),
                          {ValueKind::kInt});
    };
    const Expr product = net::expr(ExprOp::kMultiply, count("P"), count("walk"));
    CHECK_FALSE(linear_sum_of(net, product).has_value());
    CHECK_FALSE(
        linear_sum_of(net, net::expr(ExprOp::kAdd, count("P"), Expr::integer(1))).has_value());
    CHECK(linear_sum_of(net, net::expr(ExprOp::kAdd, count("P"), count("P")))->terms ==
          std::vector<LinearSum::Term>{{net.find_place("P").value, 2}});
}

TEST_CASE("nested equivalences end in no predicate, not in an endless one [hostile]") {
    const net::Net net = example();
    Formula f = Formula::marked({0});
    for (std::uint32_t i = 0; i < 60; ++i) {
        f = Formula::binary(FormulaOp::kIff, std::move(f), Formula::marked({i % kPlaces}, i / 4));
    }
    CHECK_FALSE(predicate_of(net, f).has_value());
}

TEST_CASE("a long chain costs as much as it is long [hostile]") {
    const net::Net net = example();
    const PlainNet plain = example_plain();
    Formula f = Formula::marked({0}, 1);
    for (std::uint32_t i = 0; i < 100000; ++i) {
        Formula::Node atom;
        atom.op = FormulaOp::kMarked;
        atom.index = i % kPlaces;
        atom.count = 2 + i;
        Formula::Node join;
        join.op = i % 2 == 0 ? FormulaOp::kOr : FormulaOp::kAnd;
        join.a = static_cast<std::uint32_t>(f.nodes.size()) - 1;
        join.b = join.a + 1;
        f.nodes.push_back(atom);
        f.nodes.push_back(join);
    }
    const auto p = predicate_of(net, f);
    REQUIRE(p.has_value());
    const CompiledPredicate compiled(plain, *p);
    CHECK_FALSE(compiled.holds(Marking{1, 1, 1, 1}));  // the last link is an `and` with 100001
    CHECK(compiled.places() == std::vector<std::uint32_t>{0, 1, 2, 3});
}

}  // namespace puppetri::proof
