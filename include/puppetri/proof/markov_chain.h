// SPDX-License-Identifier: MIT
// Finite Markov chains, solved by numbers: where they are in the long run, at an instant, and how
// soon and with what probability they get somewhere. In continuous time a state lasts an
// exponential time; a chain in steps is one whose states last exactly so long. What counts in the
// long run and for mean times is only how long a state lasts on average: there both are one.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/proof/graph_algorithms.h"

namespace puppetri::proof {

struct Jump {
    std::uint32_t target = 0;
    double rate = 0;  // per second, above 0
    bool operator==(const Jump&) const = default;
};

struct MarkovChain {
    net::Rows<Jump> jumps;  // by state; jumps to itself change nothing
    // By state, in ticks, above 0: how long it lasts, exactly; then the rates of its jumps are
    // their probabilities over this time. Empty: exponential times.
    std::vector<std::int64_t> lasts;
    std::vector<double> initial;  // probabilities, one per state, sum 1
    std::uint32_t size() const { return jumps.size(); }
};

// Probabilities, or times, by state, and how far they are from solving their equations.
struct ChainSolution {
    std::vector<double> values;
    // The largest absolute error of an equation, relative to the largest rate out of a state. What
    // was iterated and has not come to rest has a large one.
    double residual = 0;
};

// The share of time that each state has in the long run, from the initial distribution on; chains
// that fall apart into several classes, and periodic ones, are no exception.
// Cost    classes of at most 500 states: elimination, cubic. Larger ones: sweeps over all jumps
//         until they rest, at most 20 000.
// Source  elimination without subtraction after Grassmann, Taksar and Heyman, "Regenerative
//         analysis and steady state distributions for Markov chains", Operations Research 33
//         (1985); sweeps by Gauss and Seidel (Stewart, "Introduction to the Numerical Solution of
//         Markov Chains", 1994, section 3.2).
ChainSolution long_run(const MarkovChain& chain);

// The distribution at `time_s`. The terms that are left out have less than 1e-13 of the
// probability.
// In steps: what holds once all that is due at this time has happened.
// Needs   time_s >= 0, finite.
// Gives   in steps: a residual above 1 where there were more than 100 million jumps to follow.
// Cost    about max rate * time_s products with all jumps, fewer where the chain comes to rest.
// Source  uniformisation: A. Jensen, "Markoff chains as an aid in the study of Markoff processes",
//         Skandinavisk Aktuarietidskrift 36 (1953).
ChainSolution at_time(const MarkovChain& chain, double time_s);

// The probability of having been in one of these states by `time_s`: initially, or by a jump.
// Needs   goal.size() == chain.size().
ChainSolution reached_by(const MarkovChain& chain, const StateBits& goal, double time_s);

// The probability of ever being in one of these states. One value.
// Needs   goal.size() == chain.size().
ChainSolution ever_reached(const MarkovChain& chain, const StateBits& goal);

// How long it takes from the start until one of these states is reached: the mean; infinite where
// it may never be. One value.
ChainSolution mean_time_to(const MarkovChain& chain, const StateBits& goal);

}  // namespace puppetri::proof
