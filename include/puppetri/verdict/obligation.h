// SPDX-License-Identifier: MIT
// A rule made ready for checking: its operands as three-valued expressions over atoms (statements
// about one state, asked of whoever makes the graph or plays the run) and firings. The same
// obligation is checked on graphs and on runs, so that both mean the same by a rule.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/net/formula.h"
#include "puppetri/net/net.h"
#include "puppetri/proof/temporal.h"

namespace puppetri::verdict {

// net::Rule::count of `bounded` without a number: there is some bound.
inline constexpr std::int64_t kNoCount = -1;

// What is known about a statement: it may hold, it must hold. Exact: both are equal.
struct Truth {
    bool may = false, must = false;
    static constexpr Truth of(bool value) { return {value, value}; }
};

// Statements about one state, each once: what generators of graphs are asked to decide per state.
class Atoms {
 public:
    std::uint32_t add(const net::Formula& formula);
    const std::vector<net::Formula>& formulas() const { return formulas_; }

 private:
    std::vector<net::Formula> formulas_;
    std::vector<std::string> keys_;
};

// The atoms' truths in one state: rows of bits as in proof::AtomBits.
struct AtomRow {
    const std::uint64_t* may = nullptr;
    const std::uint64_t* must = nullptr;
    Truth operator[](std::uint32_t atom) const {
        return {((may[atom / 64] >> (atom % 64)) & 1) != 0,
                ((must[atom / 64] >> (atom % 64)) & 1) != 0};
    }
};

// A statement about a moment: a state and the firing or occurrence that led to it.
struct Operand {
    struct Node {
        enum class Op : std::uint8_t { kConstant, kAtom, kFires, kEvent, kNot, kAnd, kOr, kIff };
        Op op = Op::kConstant;
        bool value = false;
        std::uint32_t a = 0, b = 0;  // operands
        // Of kAtom: the atom that holds whenever the statement may hold, and the one that holds
        // only if it must. Equal for statements about the net; statements about figures lie
        // between.
        std::uint32_t may = 0, must = 0;
        std::uint32_t index = 0;  // of transitions and events
    };
    std::vector<Node> nodes;  // operands before operators, the root is last
    bool reads_firings = false;

    // label: as in proof::Edge; kNoFiring at the start.
    static constexpr std::uint32_t kNoFiring = ~std::uint32_t{0};
    Truth at(const AtomRow& row, std::uint32_t label) const;
    // Never true of any moment, whatever the net does.
    bool never() const;
};

// Statements that only the stage knows, told as statements about the net: one that holds whenever
// the statement may, one that holds only if it must.
struct Lowered {
    net::Formula may, must;
};
class HostLowering {
 public:
    virtual ~HostLowering() = default;
    // A formula about one state with host atoms in it.
    virtual Lowered lower(const net::Formula& formula) const = 0;
    // What is taken for granted when statements of this rule are told so, beside durations.
    virtual std::vector<std::string> assumptions(const net::Rule&) const { return {}; }
};

struct Obligation {
    std::string rule;
    net::RuleKind kind = net::RuleKind::kNever;
    std::vector<Operand> operands;
    std::optional<SimTime> within;
    bool when_settled = false;
    bool about_figures = false;  // host atoms were lowered: only the stage can refute it
    std::vector<std::uint32_t> transitions;  // of live, quasi_live: never empty
    std::vector<std::string> subjects;       // of nobody_freezes: per operand, if known
    // Of kFormula: taken apart; operand i is its atom i.
    std::optional<proof::Temporal> temporal;
};

// Operands about places of `bounded` become "more than k tokens". `host` may be null: then host
// atoms may always hold and never must.
Obligation make_obligation(const net::Net& net, const net::Rule& rule, const HostLowering* host,
                           Atoms& atoms);
Operand make_operand(const net::Formula& formula, const HostLowering* host, Atoms& atoms,
                     bool* about_figures = nullptr);

// The transitions and places that a rule reads, and whether it reads the whole net (death, ends).
// Used to find the components that it depends on.
bool reads_whole_net(const net::Rule& rule);

}  // namespace puppetri::verdict
