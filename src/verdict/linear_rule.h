// SPDX-License-Identifier: MIT
// Formulas of linear time on graphs that know no clocks, or not those of the stage. Proved where no
// path that justice allows breaks the formula. Refuted where a run gets to a state from which the
// formula can be broken whatever lasts how long: a game of two, who chooses winners of ties and
// keeps the outside quiet against who chooses times, movements' events and sensors.
#pragma once
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "moments.h"
#include "puppetri/proof/budget.h"
#include "puppetri/proof/buechi.h"
#include "puppetri/run/player.h"
#include "puppetri/verdict/check_graph.h"
#include "puppetri/verdict/run_watch.h"

namespace puppetri::verdict {

// Who wins where. A node is a moment and a state of the automaton of the negated formula that has
// read what was before this moment.
struct LinearGame {
    Moments moments;
    proof::Buechi automaton;
    std::unordered_map<std::uint64_t, std::uint32_t> node_of;
    Nodes winning;  // the formula can be broken from here
    // Per acceptance set (one if there is none), per node: the less, the nearer is the next edge of
    // the set for who wins.
    std::vector<std::vector<std::uint32_t>> ranks;

    static std::uint64_t key(std::uint32_t moment, std::uint32_t q) {
        return (std::uint64_t{q} << 32) | moment;
    }
    bool wins(std::uint32_t moment, std::uint32_t q) const {
        const auto found = node_of.find(key(moment, q));
        return found != node_of.end() && winning[found->second] != 0;
    }
};

// Needs  obligation.temporal in linear time.
// Gives  kHolds, kSuspect with a game, or kUnknown.
// Cost   the graph times the automaton; the game a few hundred passes over that at most, given up
//        beyond.
// Source generalized Buechi games as nested fixpoints: R. Bloem, S. Galler, B. Jobstmann,
//        N. Piterman, A. Pnueli, Y. Sa'ar, Synthesis of reactive(1) designs (2012), section 3.
Finding check_linear(const net::Net& net, const Obligation& obligation, const GraphView& view,
                     const proof::Budget& budget, std::uint64_t most_edges);

// The automaton on one run: in which states it can be for certain before it reads the present
// moment. Where the run does not tell whether time has passed between an event and a firing, both
// are thought through: the states of each case.
class LinearWatch {
 public:
    // All outlive it.
    LinearWatch(const LinearGame& game, const Obligation& obligation, const AtomReader& reader,
                const run::Player& player);
    void begin();
    // What has happened, in this order; after a firing the player stands behind it.
    void occurred(std::span<const std::uint32_t> events);
    void time_passes();
    void fired();
    const std::vector<std::vector<std::uint32_t>>& cases() const { return cases_; }
    // So many moments have been read before the present one.
    std::size_t moments() const { return word_.size(); }
    // The word of this run, from moment `back` on again and again (back == moments(): it stands
    // still from now on), does not satisfy the formula, for certain.
    bool breaks(std::size_t back) const;

 private:
    std::vector<std::uint32_t> after(const std::vector<std::uint32_t>& states) const;
    void advance();
    void read(std::uint32_t label);
    void judge(std::uint32_t label);

    const LinearGame& game_;
    const Obligation& o_;
    const AtomReader& reader_;
    const run::Player& player_;
    std::vector<std::vector<std::uint32_t>> cases_;
    struct Read {
        std::uint64_t holds = 0;
        bool clear = true;     // all is known
        bool perhaps = false;  // only if time has passed
    };
    std::vector<Read> word_;               // before the present moment
    std::uint64_t holds_ = 0, fails_ = 0;  // of the present moment, for certain
    std::vector<std::uint64_t> may_, must_;
    bool asks_for_events_ = false, at_event_ = false;
};

}  // namespace puppetri::verdict
