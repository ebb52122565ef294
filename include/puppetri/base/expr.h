// SPDX-License-Identifier: MIT
// Typed expressions: built with static type checks, compiled to flat postfix programs, evaluated
// over 8-byte values without allocation. The one idea: an expression knows nothing of nets; what it
// reads are slots (a kind and an index), and whoever evaluates it says what a slot holds.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/result.h"
#include "puppetri/base/time.h"

namespace puppetri {

enum class ValueKind : std::uint8_t { kBool, kInt, kReal, kTime, kEnum, kActor, kProp };

struct ValueType {
    ValueKind kind = ValueKind::kBool;
    std::uint32_t enumeration = 0;  // of kEnum: which enumeration; else 0
    bool operator==(const ValueType&) const = default;
};

// "bool", "int", "real", "time", "enum", "actor", "prop".
const char* name_of(ValueKind kind);

// A value of any type in 8 bytes: 0 or 1, an integer, ticks, the ordinal of an enumerator, the
// index of an actor or a prop; a real is the bit pattern of its double.
using Value = std::int64_t;
Value value_of_real(double x);
double real_of_value(Value v);

// What an expression reads. Kinds are given by the module that evaluates (see net/draft.h).
struct Slot {
    std::uint32_t kind = 0;
    std::uint32_t index = 0;
    auto operator<=>(const Slot&) const = default;
};

enum class ExprOp : std::uint8_t {
    kLiteral,
    kSlot,
    // one operand
    kNegate,
    kNot,
    kAbs,
    kFloor,
    kCeil,
    kRound,   // floor, ceil and round (ties to even) of a real give an int
    kToReal,  // int -> real; time -> real (seconds)
    kToTime,  // real (seconds) -> time, rounded to a tick, ties to even
    kSqrt,
    kSin,
    kCos,
    kTan,
    kAsin,
    kAcos,
    kExp,
    kLog,
    // two operands
    kAdd,
    kSubtract,
    kMultiply,
    kDivide,       // of ints gives a real; time / time a real; time / number a time
    kFloorDivide,  // ints, towards minus infinity
    kModulo,       // ints, sign of the divisor
    kMin,
    kMax,
    kPow,
    kAtan2,
    kLess,
    kLessEqual,
    kGreater,
    kGreaterEqual,
    kEqual,
    kNotEqual,
    kAnd,
    kOr,
    kImplies,  // the right operand is evaluated only if it decides
    // three operands: condition, then, else; only the chosen branch is evaluated
    kIf,
};

struct ExprError {
    std::string message;  // "cannot add time and int"
};

// An expression as a value. Cheap to move; building costs O(size). Default: the literal `false`.
class Expr {
 public:
    struct Node {
        ExprOp op = ExprOp::kLiteral;
        ValueType type;
        std::uint32_t a = 0, b = 0, c = 0;  // operands, indices of earlier nodes
        Value literal = 0;
        Slot slot;
        bool operator==(const Node&) const = default;
    };

    Expr();
    static Expr boolean(bool b);
    static Expr integer(std::int64_t i);
    static Expr real(double x);
    static Expr time(SimTime t);
    static Expr enumerator(std::uint32_t enumeration, std::int64_t ordinal);
    static Expr actor(std::uint32_t index);
    static Expr prop(std::uint32_t index);
    static Expr literal(ValueType type, Value value);
    static Expr slot(Slot slot, ValueType type);

    // Applies an operator. Ints become reals beside reals; nothing else is converted.
    // Fails  with the reason when the types do not fit the operator.
    static Result<Expr, ExprError> unary(ExprOp op, Expr a);
    static Result<Expr, ExprError> binary(ExprOp op, Expr a, Expr b);
    static Result<Expr, ExprError> conditional(Expr condition, Expr then, Expr otherwise);

    ValueType type() const { return nodes_.back().type; }
    bool is_literal() const { return nodes_.size() == 1 && nodes_[0].op == ExprOp::kLiteral; }
    // Needs is_literal().
    Value literal_value() const;
    // Operands before operators; the root is last.
    std::span<const Node> nodes() const { return nodes_; }
    // Gives every slot another one: `rename(slot)` for composition of nets.
    template <class Rename>
    void rename_slots(Rename&& rename) {
        for (Node& n : nodes_) {
            if (n.op == ExprOp::kSlot) {
                n.slot = rename(n.slot);
            }
        }
    }
    bool operator==(const Expr&) const = default;

 private:
    std::vector<Node> nodes_;
};

enum class EvalFault : std::uint8_t { kNone, kDivisionByZero, kOverflow, kNotANumber };
const char* name_of(EvalFault fault);  // "division by zero"

struct Evaluated {
    Value value = 0;
    EvalFault fault = EvalFault::kNone;
};

// A compiled expression: a stretch of instructions. Regular value; several programs may share one
// Code.
struct ProgramIndex {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};
    std::uint32_t value = kNone;
    bool valid() const { return value != kNone; }
    bool operator==(const ProgramIndex&) const = default;
};

// Many programs in one flat array of 16-byte instructions.
class Code {
 public:
    struct Instruction {
        std::uint8_t op = 0;  // private numbering, see expr.cpp
        std::uint8_t pad = 0;
        std::uint16_t kind = 0;   // slot kind
        std::uint32_t index = 0;  // slot index, or jump target
        Value literal = 0;
        bool operator==(const Instruction&) const = default;
    };
    static constexpr std::uint32_t kMaxDepth = 64;  // of the evaluation stack

    // Fails  when the expression needs a deeper stack than kMaxDepth.
    Result<ProgramIndex, ExprError> add(const Expr& e);
    // What evaluation asks for: one virtual call per slot.
    class Reader {
     public:
        virtual ~Reader() = default;
        virtual Value read(std::uint32_t kind, std::uint32_t index) const = 0;
    };
    // Cost  no allocation. Reals are finite: a NaN or an infinite result is a fault.
    Evaluated evaluate(ProgramIndex program, const Reader& reader) const;
    // The literal, if the whole program is one.
    bool is_constant(ProgramIndex program, Value& value) const;
    // What the program may read, in order, each time that it is mentioned.
    std::vector<Slot> slots(ProgramIndex program) const;
    // The whole program is one slot.
    bool is_slot(ProgramIndex program) const;
    std::uint64_t hash() const;
    bool operator==(const Code&) const = default;

 private:
    std::vector<Instruction> instructions_;
    std::vector<std::uint32_t> starts_;
};

}  // namespace puppetri
