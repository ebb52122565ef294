// SPDX-License-Identifier: MIT
// A formula taken apart: temporal operators over atoms, where an atom is a largest part without
// any. Atoms are judged elsewhere (a predicate, data, the stage) and come as bits of a graph's
// states; CTL and LTL see numbers only.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/net/formula.h"

namespace puppetri::proof {

// An answer that may be missing.
enum class Truth : std::uint8_t { kFalse, kTrue, kUnknown };
inline Truth truth_of(bool b) { return b ? Truth::kTrue : Truth::kFalse; }
inline Truth opposite(Truth t) {
    return t == Truth::kUnknown ? t : t == Truth::kTrue ? Truth::kFalse : Truth::kTrue;
}

struct Temporal {
    enum class Op : std::uint8_t {
        kFalse,
        kTrue,
        kAtom,  // atoms[index]
        kNot,
        kAnd,
        kOr,
        kSomeNext,
        kSomeGlobally,
        kSomeUntil,
        kNext,
        kUntil,
        kRelease,  // not (not a until not b)
    };
    enum class Logic : std::uint8_t {
        kState,    // no temporal operator: an atom or a constant
        kCtl,      // path quantifiers only
        kLtl,      // linear operators only: about all paths from the initial state
        kNeither,  // both mixed: no method here
    };
    struct Node {
        Op op = Op::kTrue;
        std::uint32_t a = 0, b = 0;  // operands, indices of earlier nodes
        std::uint32_t index = 0;
    };
    std::vector<Node> nodes;  // operands before operators; the root is last; equal nodes are one
    std::vector<net::Formula> atoms;  // no two are equal
    Logic logic = Logic::kState;
    bool has_next = false;  // speaks of single steps: must not be asked of reduced graphs
};

// AX, AF, AG, AU become negations of EX, EG, EU, finally and globally become until and release;
// constants vanish. Never fails; formulas that share operands stay shared.
// Cost  O(size), but for comparing atoms.
Temporal taken_apart(const net::Formula& formula);

}  // namespace puppetri::proof
