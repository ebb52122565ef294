// SPDX-License-Identifier: MIT
// Liveness and freedom of deadlock by theorem, without looking at a marking but the initial one.
// Each theorem's preconditions are checked here; where none applies the answer is "not known".
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "puppetri/net/net.h"
#include "puppetri/proof/budget.h"
#include "puppetri/proof/plain_net.h"
#include "puppetri/proof/siphons.h"

namespace puppetri::proof {

struct StructuralLiveness {
    bool live = false;           // every transition stays fireable again and again
    bool not_live = false;       // some transition can get dead
    bool deadlock_free = false;  // no reachable marking is dead
    bool bounded = false;        // said only together with `live`
    const char* theorem = "";    // what it rests on, with its source
    PlaceSet unmarked;  // of not_live: the circuit's places or the siphon that can be empty
};

// For the plain untimed net. Inhibitors are told as ordinary arcs where that can be done
// (proof/complement.h). Applies only without levels and optional transitions, on ordinary nets, to
// each independent component:
//   marked graph          live iff every circuit has a token (Commoner, Holt, Even, Pnueli, JCSS 5,
//                         1971); bounded if strongly connected
//   extended free choice  well-formed iff covered by positive flows of places and of transitions
//   and
//                         rank C = clusters - 1 (rank theorem: Desel, Esparza: Free Choice Petri
//                         Nets, 1995, chapter 6); then its minimal siphons are traps too, and it is
//                         live and bounded iff each of them is marked (chapter 5)
//   extended free choice  live iff every siphon contains a marked trap (Commoner's theorem: Hack
//                         1972; chapter 4 there)
//   any                   every siphon contains a marked trap: deadlock-free (chapter 4: the
//   unmarked
//                         places of a dead marking are a siphon)
// The whole is live if all components are, deadlock-free if one is.
// Cost  polynomial but for the last two, which list minimal siphons within the budget.
StructuralLiveness structural_liveness(const PlainNet& net, const Budget& budget);

// The same for a net with durations, chance and priorities: in every reachable state each
// transition can fire again later. The reason: in a bounded, strongly connected, extended free
// choice net every endless run that keeps choosing, in each cluster, the transition that points
// towards t fires t again and again (after Desel, Esparza 1995, chapter 6, pointing allocations;
// the proof, which asks nothing of the run but to be endless, is in src/proof/timed_liveness.cpp).
// The members of a cluster need the same tokens, so they become fireable at the same instant, and
// which one fires is a draw; time, and priorities between clusters, only order the firings of
// different clusters. Runs are endless since durations end and the untimed net, of which the timed
// one is a part, has no deadlock. Needs, checked here: structural_liveness live and bounded; within
// a cluster equal priority, no delay unless alone; nowhere guards, events, assignments, computed
// odds, `now`, `while` or `unless` on timed places; patterns that fit every token; durations that
// are constant, `auto`, distributed or `as` those.
struct TimedLiveness {
    bool live = false;
    std::string theorem;  // or why it does not apply
    // Live unless the run stops with a fault: `live` once these rules are proved too.
    bool live_unless_stopped = false;
    bool needs_time_goes_on = false;  // not each circuit takes time
    bool needs_clean_ends = false;    // some module must be clean when it ends
};
TimedLiveness timed_liveness(const net::Net& net, const Budget& budget);

// In no instant do endlessly many firings happen: every circuit of the net goes through a place
// with a constant duration above 0, or a transition with such a delay, and nothing is a source
// otherwise. Then time goes on, unless a run stops with a fault or nothing is left to happen. Gives
// false where that is not known. Cost  linear.
bool instants_end(const net::Net& net);

// Tokens that carry an actor or a prop are conserved one by one: each firing hands every identity
// that it takes from `places` to exactly one token that it gives to them, and makes none. Then each
// identity of an initial token is for ever in exactly one of the places.
// Needs  `attribute[i]`: which attribute of places[i] is the identity.
struct IdentityAnswer {
    bool conserved = false;
    std::string reason;  // if not: the transition and what it does
};
IdentityAnswer conserves_identity(const net::Net& net, std::span<const std::uint32_t> places,
                                  std::span<const std::uint32_t> attribute);

}  // namespace puppetri::proof
