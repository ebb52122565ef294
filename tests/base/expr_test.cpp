// SPDX-License-Identifier: MIT
#include "puppetri/base/expr.h"

#include <doctest/doctest.h>

#include <cmath>

namespace puppetri {
namespace {

struct Slots final : Code::Reader {
    std::vector<Value> values;
    Value read(std::uint32_t, std::uint32_t index) const override { return values[index]; }
};

Expr i(std::int64_t x) { return Expr::integer(x); }
Expr r(double x) { return Expr::real(x); }
Expr t(std::int64_t ticks) { return Expr::time({ticks}); }
Expr bin(ExprOp op, Expr a, Expr b) { return Expr::binary(op, std::move(a), std::move(b)).value(); }
Expr un(ExprOp op, Expr a) { return Expr::unary(op, std::move(a)).value(); }
Expr x_slot(std::uint32_t k, ValueKind kind = ValueKind::kInt) {
    return Expr::slot({0, k}, {kind, 0});
}

Evaluated run(const Expr& e, std::vector<Value> values = {}) {
    Code code;
    const ProgramIndex p = code.add(e).value();
    Slots slots;
    slots.values = std::move(values);
    return code.evaluate(p, slots);
}
Value whole(const Expr& e, std::vector<Value> values = {}) {
    const Evaluated v = run(e, std::move(values));
    REQUIRE(v.fault == EvalFault::kNone);
    return v.value;
}
double real(const Expr& e) { return real_of_value(whole(e)); }

TEST_CASE("ints stay ints, and become reals beside reals [unit]") {
    CHECK(bin(ExprOp::kAdd, i(2), i(3)).type().kind == ValueKind::kInt);
    CHECK(whole(bin(ExprOp::kAdd, i(2), i(3))) == 5);
    CHECK(real(bin(ExprOp::kMultiply, i(2), r(1.5))) == 3);
    CHECK(real(bin(ExprOp::kSubtract, r(2), i(3))) == -1);
    CHECK(bin(ExprOp::kDivide, i(7), i(2)).type().kind == ValueKind::kReal);
    CHECK(real(bin(ExprOp::kDivide, i(7), i(2))) == 3.5);
}

TEST_CASE("div rounds down and mod has the sign of the divisor [unit]") {
    for (const int a : {-7, -6, 0, 6, 7}) {
        for (const int b : {-3, -1, 1, 2, 3}) {
            const Value q = whole(bin(ExprOp::kFloorDivide, i(a), i(b)));
            const Value m = whole(bin(ExprOp::kModulo, i(a), i(b)));
            CHECK(q == static_cast<Value>(std::floor(static_cast<double>(a) / b)));
            CHECK(q * b + m == a);
        }
    }
}

TEST_CASE("times add, scale with numbers and divide to ratios, rounded ties to even [unit]") {
    CHECK(whole(bin(ExprOp::kAdd, t(5), t(6))) == 11);
    CHECK(whole(bin(ExprOp::kMultiply, t(5), i(3))) == 15);
    CHECK(whole(bin(ExprOp::kMultiply, i(3), t(5))) == 15);
    CHECK(whole(bin(ExprOp::kMultiply, r(0.5), t(5))) == 2);
    CHECK(whole(bin(ExprOp::kMultiply, r(0.5), t(7))) == 4);
    CHECK(whole(bin(ExprOp::kDivide, t(5), i(2))) == 2);
    CHECK(whole(bin(ExprOp::kDivide, t(7), i(2))) == 4);
    CHECK(whole(bin(ExprOp::kDivide, t(-7), i(2))) == -4);
    CHECK(whole(bin(ExprOp::kDivide, t(8), i(3))) == 3);
    CHECK(real(bin(ExprOp::kDivide, t(5), t(2))) == 2.5);
    CHECK(real(un(ExprOp::kToReal, t(kTicksPerSecond / 2))) == 0.5);
    CHECK(whole(un(ExprOp::kToTime, r(0.25))) == kTicksPerSecond / 4);
    CHECK_FALSE(Expr::binary(ExprOp::kAdd, t(1), i(1)));
    CHECK_FALSE(Expr::binary(ExprOp::kMultiply, t(1), t(1)));
    CHECK_FALSE(Expr::binary(ExprOp::kDivide, i(1), t(1)));
}

TEST_CASE("types that do not fit are refused [unit]") {
    CHECK_FALSE(Expr::binary(ExprOp::kAnd, i(1), Expr::boolean(true)));
    CHECK_FALSE(Expr::binary(ExprOp::kLess, Expr::boolean(false), Expr::boolean(true)));
    CHECK_FALSE(Expr::binary(ExprOp::kEqual, Expr::enumerator(0, 1), Expr::enumerator(1, 1)));
    CHECK_FALSE(Expr::unary(ExprOp::kNegate, Expr::actor(0)));
    CHECK_FALSE(Expr::conditional(i(1), i(2), i(3)));
    CHECK_FALSE(Expr::conditional(Expr::boolean(true), t(2), i(3)));
    CHECK(Expr::binary(ExprOp::kLess, Expr::enumerator(2, 0), Expr::enumerator(2, 1)));
    CHECK(Expr::binary(ExprOp::kEqual, Expr::prop(0), Expr::prop(1)));
}

TEST_CASE("comparisons and logic, over all small cases [law]") {
    for (const int a : {-1, 0, 2}) {
        for (const int b : {-1, 0, 2}) {
            CHECK(whole(bin(ExprOp::kLess, i(a), i(b))) == (a < b));
            CHECK(whole(bin(ExprOp::kGreater, i(a), r(b))) == (a > b));
            CHECK(whole(bin(ExprOp::kLessEqual, r(a), i(b))) == (a <= b));
            CHECK(whole(bin(ExprOp::kGreaterEqual, i(a), i(b))) == (a >= b));
            CHECK(whole(bin(ExprOp::kEqual, i(a), i(b))) == (a == b));
            CHECK(whole(bin(ExprOp::kNotEqual, r(a), r(b))) == (a != b));
            CHECK(whole(bin(ExprOp::kMin, i(a), i(b))) == std::min(a, b));
            CHECK(real(bin(ExprOp::kMax, r(a), r(b))) == std::max(a, b));
        }
    }
    for (const bool a : {false, true}) {
        for (const bool b : {false, true}) {
            const auto e = [](bool v) { return Expr::boolean(v); };
            CHECK(whole(bin(ExprOp::kAnd, e(a), e(b))) == (a && b));
            CHECK(whole(bin(ExprOp::kOr, e(a), e(b))) == (a || b));
            CHECK(whole(bin(ExprOp::kImplies, e(a), e(b))) == (!a || b));
            CHECK(whole(Expr::conditional(e(a), i(1), i(2)).value()) == (a ? 1 : 2));
        }
    }
}

TEST_CASE("what does not decide is not evaluated [unit]") {
    const auto inverse = [] {
        return bin(ExprOp::kGreater, bin(ExprOp::kDivide, i(1), x_slot(0)), i(0));
    };
    const Expr guarded = bin(ExprOp::kAnd, bin(ExprOp::kNotEqual, x_slot(0), i(0)), inverse());
    CHECK(whole(guarded, {0}) == 0);
    CHECK(whole(guarded, {2}) == 1);
    CHECK(run(inverse(), {0}).fault == EvalFault::kDivisionByZero);
    CHECK(whole(bin(ExprOp::kOr, bin(ExprOp::kEqual, x_slot(0), i(0)), inverse()), {0}) == 1);
    CHECK(whole(bin(ExprOp::kImplies, bin(ExprOp::kNotEqual, x_slot(0), i(0)), inverse()), {0}) ==
          1);
}

TEST_CASE("overflow, division by zero and what is no number are faults [unit]") {
    const std::int64_t most = std::numeric_limits<std::int64_t>::max();
    const std::int64_t least = std::numeric_limits<std::int64_t>::min();
    CHECK(run(bin(ExprOp::kAdd, i(most), i(1))).fault == EvalFault::kOverflow);
    CHECK(run(bin(ExprOp::kSubtract, i(least), i(1))).fault == EvalFault::kOverflow);
    CHECK(run(bin(ExprOp::kMultiply, i(most), i(2))).fault == EvalFault::kOverflow);
    CHECK(run(un(ExprOp::kNegate, i(least))).fault == EvalFault::kOverflow);
    CHECK(run(un(ExprOp::kAbs, i(least))).fault == EvalFault::kOverflow);
    CHECK(run(bin(ExprOp::kFloorDivide, i(least), i(-1))).fault == EvalFault::kOverflow);
    CHECK(run(un(ExprOp::kRound, r(1e30))).fault == EvalFault::kOverflow);
    CHECK(run(un(ExprOp::kToTime, r(1e12))).fault == EvalFault::kOverflow);
    CHECK(run(bin(ExprOp::kModulo, i(1), i(0))).fault == EvalFault::kDivisionByZero);
    CHECK(run(bin(ExprOp::kDivide, t(1), r(0))).fault == EvalFault::kDivisionByZero);
    CHECK(run(un(ExprOp::kSqrt, r(-1))).fault == EvalFault::kNotANumber);
    CHECK(run(un(ExprOp::kLog, i(0))).fault == EvalFault::kNotANumber);
}

TEST_CASE("rounding of reals: floor, ceil, ties to even [unit]") {
    CHECK(whole(un(ExprOp::kFloor, r(-1.5))) == -2);
    CHECK(whole(un(ExprOp::kCeil, r(-1.5))) == -1);
    CHECK(whole(un(ExprOp::kRound, r(0.5))) == 0);
    CHECK(whole(un(ExprOp::kRound, r(1.5))) == 2);
    CHECK(whole(un(ExprOp::kRound, r(-2.5))) == -2);
}

TEST_CASE("an expression too deep for the stack is refused, a long chain is not [hostile]") {
    Expr right = i(1);
    Expr left = i(1);
    for (int k = 0; k < 200; ++k) {
        right = bin(ExprOp::kAdd, i(1), std::move(right));
        left = bin(ExprOp::kAdd, std::move(left), i(1));
    }
    Code code;
    CHECK_FALSE(code.add(right));
    CHECK(whole(left) == 201);
}

TEST_CASE("slots are read by kind and index and can be renamed [unit]") {
    Expr e = bin(ExprOp::kSubtract, x_slot(0), x_slot(1));
    CHECK(whole(e, {10, 3}) == 7);
    e.rename_slots([](Slot s) { return Slot{s.kind, 1 - s.index}; });
    CHECK(whole(e, {10, 3}) == -7);
}

}  // namespace
}  // namespace puppetri
