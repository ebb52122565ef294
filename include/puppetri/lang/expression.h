// SPDX-License-Identifier: MIT
// Expressions of the scene language: names, paths, exact numbers with units, calls, formulas. One
// plain struct for all of them; `kind` says which members mean something.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/base/rational.h"

namespace puppetri::lang {

// A stretch of a file's bytes, [begin, end). `file` is the number that parse() was given.
struct Span {
    std::uint32_t begin = 0, end = 0, file = 0;
    bool operator==(const Span&) const = default;
};

struct Expr;

// One name, as declared or as a step of a path. `fork[i + 1]` has an index; quoted names ('left
// leg') are unquoted here.
struct Name {
    std::string text;
    std::vector<Expr> index;  // usually empty
    Span span;
};

// a.me.left_leg.swing
struct Path {
    std::vector<Name> steps;
    Span span;
    bool empty() const { return steps.empty(); }
};

enum class ExprKind : std::uint8_t {
    kNone,         // not written
    kNumber,       // 0.4 s: number, unit
    kBool,         // yes no true false: number 1 or 0
    kString,       // "text": text
    kPath,         // a.b.c: path
    kCall,         // a.b(x, to: y): path, args
    kList,         // [x, y]: args, perhaps a unit for all
    kTuple,        // (x, y, z) m: args, perhaps a unit for all; always 2 or more
    kUnary,        // op, args[0]
    kBinary,       // op, args[0], args[1], ...: + * and or take two or more, all others two
    kConditional,  // args[0] ? args[1] : args[2]
    kRange,        // args[0] .. args[1]; in `0.4 .. 0.6 s` both have the unit
    kCount,        // #P: path
    kCountReady,   // #ready P: path
    kSymbol,       // only among the values of a block's property: `->`, `:`, `=`, `:=` in text
};

// clang-format off
enum class Op : std::uint8_t {
    kNone, kNegate, kPlus, kNot,                              // the last three are unary
    kAdd, kSubtract, kMultiply, kDivide, kDiv, kMod, kPower,  // div and mod are those of whole numbers
    kEqual, kNotEqual, kLess, kLessEqual, kGreater, kGreaterEqual,
    kAnd, kOr, kImplies,
    kUntil, kWeakUntil, kRelease,                             // in ltl and ctl rules only
};
// clang-format on

struct Argument;

struct Expr {
    ExprKind kind = ExprKind::kNone;
    Op op = Op::kNone;
    Rational number{};  // exactly as written, before the unit
    std::string unit;   // as written without spaces, "m/s^2", one that units.h knows; empty: none
    std::string text;
    Path path;
    std::vector<Argument> args;
    Span span;
    Span unit_span;  // where there is a unit
    explicit operator bool() const { return kind != ExprKind::kNone; }
};

// `value` or `name: value`.
struct Argument {
    Name name;  // text empty when the argument is positional
    Expr value;
};

// name = value, in patterns, attributes and assignments (`name := value`).
struct Binding {
    Path name;
    Expr value;
    Span span;
};

// name: type = default
struct Parameter {
    Name name;
    Expr type;           // kPath, or kRange for a bounded integer; kNone when not written
    Expr default_value;  // kNone when it must be given
    // Of nets from files in other notations: seen from outside, a member of the same name hides it.
    bool hidden = false;
    Span span;
};

// "a.me.left_leg", indices written out.
std::string to_text(const Path& path);

// As fmt would write it; for messages.
std::string to_text(const Expr& expr);

}  // namespace puppetri::lang
