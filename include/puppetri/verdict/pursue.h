// SPDX-License-Identifier: MIT
// From a suspect to a run. A path of an over-approximation need not be a run; so the player plays,
// on the stage where there is a scene, and at every choice takes what leads nearest to what is
// looked for, as the graph sees it. What it finds is played again, from its script alone, and
// counts only if the rule is broken again.
#pragma once
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "puppetri/proof/budget.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/scene.h"
#include "puppetri/verdict/check_graph.h"
#include "puppetri/verdict/run_watch.h"

namespace puppetri::verdict {

// What runs are made of: a net, and the scene that performs it, if any.
struct Theatre {
    const net::Net* net = nullptr;
    const scene::Scene* scene = nullptr;  // then net is its net
    std::uint64_t seed = 1;
    SimTime beat{kTicksPerSecond};
    // By net::ActionIndex, for nets whose movements nobody performs: how long they take.
    std::vector<proof::TickRange> actions;
    std::uint32_t firings_per_instant = 100'000;
    // Some duration is decided by the stage alone.
    bool auto_durations = false;
};
Theatre theatre_of(const scene::Scene& scene);
Theatre theatre_of(const net::Net& net);

struct PursueLimits {
    std::uint32_t runs = 40;         // attempts
    std::uint64_t firings = 20'000;  // per attempt
    double seconds = 10;
    // Times that are drawn from distributions may coincide exactly, which has probability 0: what
    // is found so refutes nothing.
    bool coincide = false;
    const std::atomic<bool>* cancelled = nullptr;
};

struct Hunt {
    const Obligation* obligation = nullptr;  // of the theatre's net
    const AtomReader* reader = nullptr;      // of its atoms
    const Finding* finding = nullptr;        // kSuspect, or with a lasso of ever-unlucky ties
    // From the theatre's net to the graph's: kNone where the graph does not have it. Empty: the
    // same.
    std::vector<std::uint32_t> transitions, events;
    // Not the rule is broken but the run stops: codes of faults that count (nullptr: none).
    bool (*fault_counts)(const std::string& code) = nullptr;
};

struct Caught {
    std::optional<Witness> witness;
    std::string reason;  // without a witness: why; else what the run shows
};
Caught pursue(const Theatre& theatre, const Hunt& hunt, const PursueLimits& limits);

// Plays a witness from its script.
struct Replayed {
    bool same = false;    // every firing as written, at its time
    bool breaks = false;  // and the rule is broken where it says
    std::string trouble;  // if not
};
Replayed replay(const Theatre& theatre, const Witness& witness, const Hunt& hunt);

// A witness from the script of a path of an exact graph: played again, firing by firing. Nothing if
// the player (the stage) does something else; `trouble` says what.
// rounds: not empty: the path goes round and round, each time after so many firings. Then it counts
// only if one of them ends where another has ended, in the very same state of the net, after some
// time, and nothing has happened between that the performance decides: so it goes on for ever. The
// witness ends there.
std::optional<Witness> witness_of(const Theatre& theatre, const proof::Script& script,
                                  std::string* trouble,
                                  const std::vector<std::uint32_t>& rounds = {});

}  // namespace puppetri::verdict
