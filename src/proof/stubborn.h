// SPDX-License-Identifier: MIT
// Stubborn sets: which of the enabled transitions are enough, so that every marking that is looked
// for and can be reached can still be reached. A dead marking is one such goal: none is enabled.
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/predicate.h"

namespace puppetri::proof {

// In a state where no goal holds, the set contains
//   W  for each goal, some transition of every firing sequence that reaches it: what can change a
//      part of it that is false;
//   D  with each disabled transition, everything that can repair one of its unsatisfied arcs:
//      producers of what is missing, consumers of what inhibits;
//   C  with each enabled transition t, everything that firing t may disable: what needs a token
//      that t takes, what a token that t gives inhibits.
// Then the first transition of the set on a way to a goal is enabled here (D), and may as well be
// fired first (C): the rest of the way stays possible and ends in the same marking. By induction
// over its length the goal is found. What is enabled in the set may be nothing: then no goal can be
// reached any more. Priorities would break C: never with levels.
// Source  Valmari, Stubborn sets for reduced state space generation, APN 1990, LNCS 483; Schmidt,
//         Stubborn sets for standard properties, ICATPN 1999, LNCS 1639; as conditions R, W, D by
//         Bonneland, Jensen, Larsen, Muniz, Srba, Stubborn set reduction for two-player
//         reachability games, LMCS 17 (2021), with inhibitors.
class Stubborn {
 public:
    // With `dead` the markings in which no transition is enabled that is not optional, and `final`
    // (if there is one) does not hold, are goals too. The net outlives it.
    Stubborn(const PlainNet& net, std::span<const Predicate> goals, bool dead,
             const Predicate* final);
    ~Stubborn();

    // One per thread.
    struct Scratch {
        std::vector<std::uint32_t> in_set;  // per transition: stamp
        std::vector<std::uint32_t> members;
        std::vector<std::uint32_t> best;
        std::vector<std::uint64_t> kept;
        std::uint32_t stamp = 0;
    };
    // Makes the set of enabled transitions smaller where that is possible. The same marking gives
    // the same set.
    void reduce(std::span<const std::uint32_t> marking, std::span<std::uint64_t> enabled,
                Scratch& scratch) const;

 private:
    struct Tables;
    struct Closure;
    std::unique_ptr<const Tables> tables_;
};

}  // namespace puppetri::proof
