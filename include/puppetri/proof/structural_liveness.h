// SPDX-License-Identifier: MIT
// Liveness and freedom of deadlock by theorem, without looking at a marking but the initial one.
// Each theorem's preconditions are checked here; where none applies the answer is "not known".
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/siphons.h"

namespace puppetri::proof {

struct StructuralLiveness {
    bool live = false;           // every transition stays fireable again and again
    bool not_live = false;       // some transition can get dead (theorem, both directions)
    bool deadlock_free = false;  // no reachable marking is dead
    const char* theorem = "";    // what it rests on, with its source
    PlaceSet siphon;             // of not_live: one that can be emptied; of marked graphs a circuit
};

// For the plain untimed net. Applies only without inhibitors, levels and optional transitions, on
// ordinary nets:
//   marked graphs      live iff every circuit has a token (Commoner, Holt, Even, Pnueli 1971)
//   state machines     live iff strongly connected and marked, per component
//   free choice nets   (extended) live iff every siphon contains a marked trap (Commoner's theorem;
//                      Hack 1972; Desel, Esparza: Free Choice Petri Nets, 1995, theorem 4.21, 4.27)
//   any ordinary net   Commoner's property: deadlock-free (Desel, Esparza, proposition 4.10 on
//                      ordinary nets)
// Independent components are judged one by one: live if all are, deadlock-free if one is.
StructuralLiveness structural_liveness(const PlainNet& net, const Budget& budget);

// The same for a net with durations, choosers and priorities: from every reachable state each
// transition can fire again. Theorem (docs/proof.md): in a live and bounded extended free choice
// net every infinite run that always chooses the transition of its cluster that points to t fires
// t again and again (Desel, Esparza 1995, chapter 6, pointing allocations). Time, and priorities
// between clusters, only order the firings of different clusters; within a cluster every choice
// remains possible if all its transitions have equal priority, no guard, event or delay, and draw
// their ties with odds above zero. Durations must be finite.
struct TimedLiveness {
    bool live = false;
    std::string theorem;  // or why it does not apply
};
TimedLiveness timed_liveness(const net::Net& net, const Budget& budget);

// Tokens that carry an actor or a prop are conserved one by one: each firing hands every identity
// that it takes from `places` to exactly one token that it gives to them, and makes none.
struct IdentityAnswer {
    bool conserved = false;
    std::string reason;  // if not: the transition and what it does
};
// `attribute[i]`: which attribute of places[i] holds the identity.
IdentityAnswer conserves_identity(const net::Net& net, std::span<const std::uint32_t> places,
                                  std::span<const std::uint32_t> attribute);

}  // namespace puppetri::proof
