// SPDX-License-Identifier: MIT
// Compiling expressions to flat code and evaluating it on a fixed stack.
#include <cmath>
#include <limits>

#include "puppetri/base/elementary.h"
#include "puppetri/base/expr.h"
#include "puppetri/base/hash.h"
#include "puppetri/base/require.h"

namespace puppetri {

namespace {

// The instructions. I: on int64 (also ticks, bools, enumerators), R: on doubles.
enum class Do : std::uint8_t {
    kLiteral,
    kSlot,
    kNegI,
    kNegR,
    kNot,
    kAbsI,
    kAbsR,
    kFloorR,
    kCeilR,
    kRoundR,
    kIToR,
    kTToR,
    kRToT,
    kSqrt,
    kSin,
    kCos,
    kTan,
    kAsin,
    kAcos,
    kExp,
    kLog,
    kAddI,
    kAddR,
    kSubI,
    kSubR,
    kMulI,
    kMulR,
    kMulTR,
    kDivII,
    kDivRR,
    kDivTI,
    kDivTR,
    kFloorDiv,
    kMod,
    kMinI,
    kMinR,
    kMaxI,
    kMaxR,
    kPow,
    kAtan2,
    kLtI,
    kLtR,
    kLeI,
    kLeR,
    kEqI,
    kEqR,
    kNeI,
    kNeR,
    kSwap,
    kAndJump,   // top false: jump and keep it; else drop it
    kOrJump,    // top true: jump and keep it; else drop it
    kElseJump,  // drop the top; jump if it was false
    kJump,
    kEnd,
};

constexpr double kTwo63 = 9223372036854775808.0;

// Rounds to an int64, ties to even (the default rounding mode). False: it does not fit.
bool round_to_int(double x, Value& out) {
    const double r = std::nearbyint(x);
    if (!(r >= -kTwo63 && r < kTwo63)) {
        return false;
    }
    out = static_cast<Value>(r);
    return true;
}

Value floor_divide(Value a, Value b) {
    const Value q = a / b;
    return (a % b != 0 && ((a < 0) != (b < 0))) ? q - 1 : q;
}

// a / b rounded to nearest, ties to even. Needs b != 0 and not (min / -1).
Value divide_to_even(Value a, Value b) {
    const Value q = floor_divide(a, b);
    const Value r = a - q * b;  // same sign as b, |r| < |b|
    const std::uint64_t rest =
        r < 0 ? 0u - static_cast<std::uint64_t>(r) : static_cast<std::uint64_t>(r);
    const std::uint64_t whole =
        b < 0 ? 0u - static_cast<std::uint64_t>(b) : static_cast<std::uint64_t>(b);
    const std::uint64_t other = whole - rest;
    if (rest > other || (rest == other && (q & 1) != 0)) {
        return q + 1;
    }
    return q;
}

struct Emitter {
    std::span<const Expr::Node> nodes;
    std::vector<Code::Instruction>& out;
    std::uint32_t base = 0;
    std::uint32_t depth = 0, deepest = 0;

    std::uint32_t emit(Do op) {
        Code::Instruction i;
        i.op = static_cast<std::uint8_t>(op);
        out.push_back(i);
        return static_cast<std::uint32_t>(out.size()) - 1;
    }
    void push() {
        ++depth;
        deepest = depth > deepest ? depth : deepest;
    }
    void land(std::uint32_t jump) {
        out[jump].index = static_cast<std::uint32_t>(out.size()) - base;
    }

    // Recursion is as deep as the expression; parsers bound that, and so does kMaxDepth for right
    // operands.
    void walk(std::uint32_t at, std::uint32_t level) {
        if (level > 64 * Code::kMaxDepth) {
            deepest = Code::kMaxDepth + 1;
            return;
        }
        const Expr::Node& n = nodes[at];
        if (n.op == ExprOp::kLiteral) {
            out[emit(Do::kLiteral)].literal = n.literal;
            push();
            return;
        }
        if (n.op == ExprOp::kSlot) {
            Code::Instruction& i = out[emit(Do::kSlot)];
            i.kind = static_cast<std::uint16_t>(n.slot.kind);
            i.index = n.slot.index;
            push();
            return;
        }
        if (n.op == ExprOp::kIf) {
            walk(n.a, level + 1);
            const std::uint32_t to_else = emit(Do::kElseJump);
            --depth;
            walk(n.b, level + 1);
            const std::uint32_t to_end = emit(Do::kJump);
            --depth;
            land(to_else);
            walk(n.c, level + 1);
            land(to_end);
            return;
        }
        walk(n.a, level + 1);
        if (n.op == ExprOp::kAnd || n.op == ExprOp::kOr || n.op == ExprOp::kImplies) {
            if (n.op == ExprOp::kImplies) {
                emit(Do::kNot);
            }
            const std::uint32_t jump = emit(n.op == ExprOp::kAnd ? Do::kAndJump : Do::kOrJump);
            --depth;
            walk(n.b, level + 1);
            land(jump);
            return;
        }
        const bool real = nodes[n.a].type.kind == ValueKind::kReal;
        const bool is_time = nodes[n.a].type.kind == ValueKind::kTime;
        const ValueKind second = n.op >= ExprOp::kAdd ? nodes[n.b].type.kind : ValueKind::kBool;
        if (n.op >= ExprOp::kAdd) {
            walk(n.b, level + 1);
            --depth;
        }
        switch (n.op) {
            case ExprOp::kNegate:
                emit(real ? Do::kNegR : Do::kNegI);
                break;
            case ExprOp::kNot:
                emit(Do::kNot);
                break;
            case ExprOp::kAbs:
                emit(real ? Do::kAbsR : Do::kAbsI);
                break;
            case ExprOp::kFloor:
                emit(Do::kFloorR);
                break;
            case ExprOp::kCeil:
                emit(Do::kCeilR);
                break;
            case ExprOp::kRound:
                emit(Do::kRoundR);
                break;
            case ExprOp::kToReal:
                emit(is_time ? Do::kTToR : Do::kIToR);
                break;
            case ExprOp::kToTime:
                emit(Do::kRToT);
                break;
            case ExprOp::kSqrt:
                emit(Do::kSqrt);
                break;
            case ExprOp::kSin:
                emit(Do::kSin);
                break;
            case ExprOp::kCos:
                emit(Do::kCos);
                break;
            case ExprOp::kTan:
                emit(Do::kTan);
                break;
            case ExprOp::kAsin:
                emit(Do::kAsin);
                break;
            case ExprOp::kAcos:
                emit(Do::kAcos);
                break;
            case ExprOp::kExp:
                emit(Do::kExp);
                break;
            case ExprOp::kLog:
                emit(Do::kLog);
                break;
            case ExprOp::kAdd:
                emit(real ? Do::kAddR : Do::kAddI);
                break;
            case ExprOp::kSubtract:
                emit(real ? Do::kSubR : Do::kSubI);
                break;
            case ExprOp::kMultiply:
                emit(real                                    ? Do::kMulR
                     : is_time && second == ValueKind::kReal ? Do::kMulTR
                                                             : Do::kMulI);
                break;
            case ExprOp::kDivide:
                emit(real                                    ? Do::kDivRR
                     : is_time && second == ValueKind::kReal ? Do::kDivTR
                     : is_time && second == ValueKind::kInt  ? Do::kDivTI
                                                             : Do::kDivII);
                break;
            case ExprOp::kFloorDivide:
                emit(Do::kFloorDiv);
                break;
            case ExprOp::kModulo:
                emit(Do::kMod);
                break;
            case ExprOp::kMin:
                emit(real ? Do::kMinR : Do::kMinI);
                break;
            case ExprOp::kMax:
                emit(real ? Do::kMaxR : Do::kMaxI);
                break;
            case ExprOp::kPow:
                emit(Do::kPow);
                break;
            case ExprOp::kAtan2:
                emit(Do::kAtan2);
                break;
            case ExprOp::kGreater:
                emit(Do::kSwap);
                [[fallthrough]];
            case ExprOp::kLess:
                emit(real ? Do::kLtR : Do::kLtI);
                break;
            case ExprOp::kGreaterEqual:
                emit(Do::kSwap);
                [[fallthrough]];
            case ExprOp::kLessEqual:
                emit(real ? Do::kLeR : Do::kLeI);
                break;
            case ExprOp::kEqual:
                emit(real ? Do::kEqR : Do::kEqI);
                break;
            case ExprOp::kNotEqual:
                emit(real ? Do::kNeR : Do::kNeI);
                break;
            default:
                break;
        }
    }
};

}  // namespace

Result<ProgramIndex, ExprError> Code::add(const Expr& e) {
    const auto start = static_cast<std::uint32_t>(instructions_.size());
    Emitter emitter{e.nodes(), instructions_, start, 0, 0};
    emitter.walk(static_cast<std::uint32_t>(e.nodes().size()) - 1, 0);
    emitter.emit(Do::kEnd);
    if (emitter.deepest > kMaxDepth) {
        instructions_.resize(start);
        return Unexpected(ExprError{"the expression is nested too deeply"});
    }
    starts_.push_back(start);
    return ProgramIndex{static_cast<std::uint32_t>(starts_.size()) - 1};
}

bool Code::is_constant(ProgramIndex program, Value& value) const {
    const Instruction* i = &instructions_[starts_[program.value]];
    if (static_cast<Do>(i[0].op) != Do::kLiteral || static_cast<Do>(i[1].op) != Do::kEnd) {
        return false;
    }
    value = i[0].literal;
    return true;
}

std::vector<Slot> Code::slots(ProgramIndex program) const {
    std::vector<Slot> list;
    for (const Instruction* i = &instructions_[starts_[program.value]];
         static_cast<Do>(i->op) != Do::kEnd; ++i) {
        if (static_cast<Do>(i->op) == Do::kSlot) {
            list.push_back({i->kind, i->index});
        }
    }
    return list;
}

bool Code::is_slot(ProgramIndex program) const {
    const Instruction* i = &instructions_[starts_[program.value]];
    return static_cast<Do>(i[0].op) == Do::kSlot && static_cast<Do>(i[1].op) == Do::kEnd;
}

std::uint64_t Code::hash() const {
    Hash64 h;
    for (const Instruction& i : instructions_) {
        h.add_u64(i.op).add_u64(i.kind).add_u64(i.index).add_i64(i.literal);
    }
    return h.value();
}

Evaluated Code::evaluate(ProgramIndex program, const Reader& reader) const {
    Value stack[kMaxDepth + 1];
    Value* top = stack;  // one above the uppermost
    const Instruction* const code = &instructions_[starts_[program.value]];
    const auto real = [&](int below) { return real_of_value(top[-below]); };
    const auto fault = [](EvalFault f) { return Evaluated{0, f}; };
    for (const Instruction* i = code;; ++i) {
        double x = 0;  // a real result, checked below
        switch (static_cast<Do>(i->op)) {
            case Do::kLiteral:
                *top++ = i->literal;
                continue;
            case Do::kSlot:
                *top++ = reader.read(i->kind, i->index);
                continue;
            case Do::kNegI:
            case Do::kAbsI:
                if (top[-1] < 0 || static_cast<Do>(i->op) == Do::kNegI) {
                    if (__builtin_sub_overflow(Value{0}, top[-1], &top[-1])) {
                        return fault(EvalFault::kOverflow);
                    }
                }
                continue;
            case Do::kNot:
                top[-1] = top[-1] == 0 ? 1 : 0;
                continue;
            case Do::kFloorR:
            case Do::kCeilR:
            case Do::kRoundR: {
                const double r = static_cast<Do>(i->op) == Do::kFloorR  ? std::floor(real(1))
                                 : static_cast<Do>(i->op) == Do::kCeilR ? std::ceil(real(1))
                                                                        : real(1);
                if (!round_to_int(r, top[-1])) {
                    return fault(EvalFault::kOverflow);
                }
                continue;
            }
            case Do::kRToT:
                if (!round_to_int(real(1) * static_cast<double>(kTicksPerSecond), top[-1])) {
                    return fault(EvalFault::kOverflow);
                }
                continue;
            case Do::kNegR:
                x = -real(1);
                break;
            case Do::kAbsR:
                x = std::fabs(real(1));
                break;
            case Do::kIToR:
                x = static_cast<double>(top[-1]);
                break;
            case Do::kTToR:
                x = static_cast<double>(top[-1]) / static_cast<double>(kTicksPerSecond);
                break;
            case Do::kSqrt:
                x = std::sqrt(real(1));
                break;
            case Do::kSin:
                x = puppetri::sin(real(1));
                break;
            case Do::kCos:
                x = puppetri::cos(real(1));
                break;
            case Do::kTan:
                x = puppetri::tan(real(1));
                break;
            case Do::kAsin:
                x = puppetri::asin(real(1));
                break;
            case Do::kAcos:
                x = puppetri::acos(real(1));
                break;
            case Do::kExp:
                x = puppetri::exp(real(1));
                break;
            case Do::kLog:
                x = puppetri::log(real(1));
                break;
            case Do::kAddI:
                --top;
                if (__builtin_add_overflow(top[-1], top[0], &top[-1])) {
                    return fault(EvalFault::kOverflow);
                }
                continue;
            case Do::kSubI:
                --top;
                if (__builtin_sub_overflow(top[-1], top[0], &top[-1])) {
                    return fault(EvalFault::kOverflow);
                }
                continue;
            case Do::kMulI:
                --top;
                if (__builtin_mul_overflow(top[-1], top[0], &top[-1])) {
                    return fault(EvalFault::kOverflow);
                }
                continue;
            case Do::kMulTR:
            case Do::kDivTR: {
                const double b = real(1);
                --top;
                const double a = static_cast<double>(top[-1]);
                if (static_cast<Do>(i->op) == Do::kDivTR && b == 0) {
                    return fault(EvalFault::kDivisionByZero);
                }
                if (!round_to_int(static_cast<Do>(i->op) == Do::kMulTR ? a * b : a / b, top[-1])) {
                    return fault(EvalFault::kOverflow);
                }
                continue;
            }
            case Do::kDivTI:
            case Do::kFloorDiv:
            case Do::kMod: {
                const Value b = top[-1];
                --top;
                const Value a = top[-1];
                if (b == 0) {
                    return fault(EvalFault::kDivisionByZero);
                }
                if (b == -1 && a == std::numeric_limits<Value>::min()) {
                    return fault(EvalFault::kOverflow);
                }
                top[-1] = static_cast<Do>(i->op) == Do::kDivTI      ? divide_to_even(a, b)
                          : static_cast<Do>(i->op) == Do::kFloorDiv ? floor_divide(a, b)
                                                                    : a - floor_divide(a, b) * b;
                continue;
            }
            case Do::kMinI:
                --top;
                top[-1] = top[0] < top[-1] ? top[0] : top[-1];
                continue;
            case Do::kMaxI:
                --top;
                top[-1] = top[0] > top[-1] ? top[0] : top[-1];
                continue;
            case Do::kLtI:
                --top;
                top[-1] = top[-1] < top[0] ? 1 : 0;
                continue;
            case Do::kLeI:
                --top;
                top[-1] = top[-1] <= top[0] ? 1 : 0;
                continue;
            case Do::kEqI:
                --top;
                top[-1] = top[-1] == top[0] ? 1 : 0;
                continue;
            case Do::kNeI:
                --top;
                top[-1] = top[-1] != top[0] ? 1 : 0;
                continue;
            case Do::kLtR:
                --top;
                top[-1] = real(1) < real(0) ? 1 : 0;
                continue;
            case Do::kLeR:
                --top;
                top[-1] = real(1) <= real(0) ? 1 : 0;
                continue;
            case Do::kEqR:
                --top;
                top[-1] = real(1) == real(0) ? 1 : 0;
                continue;
            case Do::kNeR:
                --top;
                top[-1] = real(1) != real(0) ? 1 : 0;
                continue;
            case Do::kAddR:
                --top;
                x = real(1) + real(0);
                break;
            case Do::kSubR:
                --top;
                x = real(1) - real(0);
                break;
            case Do::kMulR:
                --top;
                x = real(1) * real(0);
                break;
            case Do::kMinR:
                --top;
                x = real(0) < real(1) ? real(0) : real(1);
                break;
            case Do::kMaxR:
                --top;
                x = real(0) > real(1) ? real(0) : real(1);
                break;
            case Do::kPow:
                --top;
                x = puppetri::pow(real(1), real(0));
                break;
            case Do::kAtan2:
                --top;
                x = puppetri::atan2(real(1), real(0));
                break;
            case Do::kDivII:
            case Do::kDivRR: {
                --top;
                const bool ints = static_cast<Do>(i->op) == Do::kDivII;
                const double b = ints ? static_cast<double>(top[0]) : real(0);
                const double a = ints ? static_cast<double>(top[-1]) : real(1);
                if (b == 0) {
                    return fault(EvalFault::kDivisionByZero);
                }
                x = a / b;
                break;
            }
            case Do::kSwap: {
                const Value upper = top[-1];
                top[-1] = top[-2];
                top[-2] = upper;
                continue;
            }
            case Do::kAndJump:
            case Do::kOrJump:
                if ((top[-1] != 0) == (static_cast<Do>(i->op) == Do::kOrJump)) {
                    i = code + i->index - 1;
                } else {
                    --top;
                }
                continue;
            case Do::kElseJump:
                if (*--top == 0) {
                    i = code + i->index - 1;
                }
                continue;
            case Do::kJump:
                i = code + i->index - 1;
                continue;
            case Do::kEnd:
                return {top[-1], EvalFault::kNone};
        }
        if (!std::isfinite(x)) {
            return fault(EvalFault::kNotANumber);
        }
        top[-1] = value_of_real(x);
    }
}

}  // namespace puppetri
