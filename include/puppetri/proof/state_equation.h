// SPDX-License-Identifier: MIT
// What the state equation m = m0 + C x, x >= 0, and initially marked traps forbid. A predicate that
// no solution satisfies can never hold: in no timing, with no priorities. Nothing is concluded from
// a solution: it is a hint where to look.
// All arithmetic is exact (proof/linear_program.h): no verdict hangs on rounding.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"
#include "puppetri/proof/semiflows.h"

namespace puppetri::proof {

// A linear relation of token counts that holds in every reachable marking: an initially marked trap
// (at least 1), or a combination y of places with y C <= 0 (y m <= y m0).
struct Invariant {
    enum Kind : std::uint8_t { kEqual, kAtMost, kAtLeast };
    LinearSum sum;
    Kind kind = kAtMost;
    std::int64_t limit = 0;
    bool trap = false;
    bool operator==(const Invariant&) const = default;
};
// "ana.has + rui.has = 1", "P1 + P7 >= 1 (trap)".
std::string text(const Invariant& invariant, std::span<const std::string_view> place_names);

struct StateEquationOptions {
    bool traps = true;             // Esparza and Melzer 2000
    bool integers = true;          // branch on fractional firings; else the rationals only
    std::uint32_t cases = 20'000;  // linear programs at most
    // Places whose tokens an arc may take all at once: nothing is known of them. Empty: none.
    std::span<const std::uint8_t> emptied = {};
};

struct StateEquationAnswer {
    enum Kind : std::uint8_t {
        kImpossible,  // the predicate holds in no reachable marking
        kCandidate,   // marking and firings satisfy everything that was looked at
        kUnknown,     // the budget ended, or numbers passed 63 bits
    };
    Kind kind = kUnknown;
    // Of kImpossible: together (and with upper bounds of single
    // places, where disjunctions are split) they exclude all cases, no doubles; unless the cases
    // also split how often a transition fires, which no invariant tells.
    std::vector<Invariant> used;
    bool split_firings = false;
    Marking marking;                     // of kCandidate
    std::vector<std::uint64_t> firings;  // of kCandidate: how often each transition
    std::uint64_t programs = 0;          // linear programs solved
};

// Can `predicate` hold in a reachable marking? Disjunctions are split into cases, each a linear
// program over whole numbers.
// `enabled` and `none enabled` are read by arcs alone; optional transitions count in both.
// Source  Murata 1989, section VI.B (state equation); Esparza, Melzer: Verification of safety
//         properties using integer programming: beyond the state equation, FMSD 16, 2000 (traps).
StateEquationAnswer solve_state_equation(const PlainNet& net, const Predicate& predicate,
                                         const Budget& budget,
                                         const StateEquationOptions& options = {});

// The predicate can never hold, and why; nothing if that is not proved. What rules call: the state
// equation with traps, without splitting firings, on the part of the net that the predicate reads.
// The dual solutions of the linear programs are the invariants: none has to be listed beforehand.
// never A: A; mutex: two of them; exactly_one: not exactly one; bounded k: a place above k.
std::optional<std::vector<Invariant>> prove_by_invariants(
    const PlainNet& net, const Predicate& must_never_hold, const Budget& budget,
    std::span<const std::uint8_t> emptied = {});

// The greatest value of a sum over all reachable markings is at most this. Nothing: no bound is
// known. Exact: floor of the optimum of the rational program.
std::optional<std::int64_t> upper_bound(const PlainNet& net, const LinearSum& sum,
                                        const Budget& budget,
                                        std::span<const std::uint8_t> emptied = {});

}  // namespace puppetri::proof
