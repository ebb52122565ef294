// SPDX-License-Identifier: MIT
// The grammar of statements, seen from outside: one statement's tokens go in, a flat tree of nodes
// comes out, or where it went wrong and what could have stood there. Only grammar.cpp knows PEGTL.
#pragma once
#include <bitset>
#include <cstdint>
#include <span>
#include <vector>

#include "token.h"

namespace puppetri::lang {

enum class NodeKind : std::uint8_t {
    // Parts
    kName,    // index expressions as kExpr
    kPath,    // kName...
    kNumber,  // perhaps a kUnit
    kUnit,
    kString,
    kCount,      // kPath; the second token is `ready` for #ready P
    kParen,      // kExpr..., perhaps a kUnit
    kList,       // the same in [ ]
    kArguments,  // kArgument...
    kArgument,   // perhaps a kLabel, a kExpr
    kLabel,
    kOp,
    kExpr,  // kOp* operand (kOp kOp* operand)*, perhaps kExpr kExpr of a conditional
    kSymbol,
    kCaption,
    kWeight,   // an operand
    kArc,      // perhaps kWeight, kPath, kBinding...
    kBinding,  // kPath, kExpr
    kInputs,   // kArc...
    kOutputs,
    kParameter,  // kName, perhaps kType, kDefault
    kType,       // kExpr
    kDefault,    // kExpr
    kGroup,      // of initial tokens: kExpr, kBinding..., perhaps the token `ready`
    kClause,     // by its first token
    kForm,       // of a rule or a question, by its first token unless it begins with a kExpr
    kSettled,
    kMoments,  // kMoment...
    kMoment,   // kPath, perhaps kExpr
    // Statements
    kPlace,
    kTransition,
    kState,
    kMachineState,
    kChannel,
    kData,
    kEnum,
    kToken,
    kEvent,
    kEvents,
    kUse,
    kRule,
    kQuestion,
    kMeasure,
    kFor,
    kNet,
    kCast,
    kEnds,
    kBlock,
    kHeader,
    kImport,
    kProperty,
    kMember,
    kFormula,
    kValue,
};

// Nodes lie in preorder: the children of node i begin at i + 1, each child's `next` is its sibling,
// up to node i's.
struct Node {
    NodeKind kind;
    std::uint32_t begin, end;  // tokens
    std::uint32_t next;
};

enum class Entry : std::uint8_t { kStatement, kProperty, kMember, kFormula, kEnumValue };

struct Reading {
    std::vector<Node> nodes;     // of the last statement; empty when it could not be read
    std::uint32_t furthest = 0;  // the token at which no rule could go on
    std::bitset<256> expected;   // the kinds that could have stood there
    bool too_deep = false;
};

// Reads tokens [begin, end) of `tokens` as one statement. `out` is reused memory. True when all of
// it could be read.
bool read_statement(Entry entry, std::span<const Token> tokens, std::span<const char> kinds,
                    std::uint32_t begin, std::uint32_t end, Reading& out);

}  // namespace puppetri::lang
