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
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"
#include "puppetri/proof/semiflows.h"

namespace puppetri::proof {

// What has been used to exclude a case: in every reachable marking sum >= limit (the sum has
// factors of both signs). An initially marked trap, or a combination y with y C >= 0.
struct Invariant {
    LinearSum sum;
    std::int64_t limit = 0;
    bool constant = false;  // the sum never changes: sum == limit
    bool trap = false;
};
// "a.has + b.has = 1" or "P1 + P7 >= 1 (a trap)"; of y C >= 0 with only negative factors the
// inequality is turned round: "a + b <= 1".
std::string text(const Invariant& invariant, std::span<const std::string> place_names);

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
    std::vector<Invariant> used;  // of kImpossible: together they exclude all cases; no doubles
    Marking marking;              // of kCandidate
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

// The predicate can never hold, and why; nothing if that is not proved. What rules call: tries
// single semiflows first (the shortest explanation), then the state equation with traps.
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
