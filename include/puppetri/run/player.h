// SPDX-License-Identifier: MIT
// The player of nets: one run from a seed, step by step or until a limit; events from outside go
// in, the log comes out. Same net, seed and outside events: same log, hash for hash.
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/expr.h"
#include "puppetri/base/result.h"
#include "puppetri/base/time.h"
#include "puppetri/net/chooser.h"
#include "puppetri/net/host.h"
#include "puppetri/net/net.h"
#include "puppetri/run/coupled.h"

namespace puppetri::run {

// Who hears of every firing. Called in order; must not call the player back.
class LogSink {
 public:
    virtual ~LogSink() = default;
    virtual void fired(SimTime at, net::TransitionIndex transition) = 0;
    // An occurrence that no transition used.
    virtual void lost(SimTime /*at*/, net::EventIndex /*event*/) {}
    // An occurrence is being offered.
    virtual void occurs(SimTime /*at*/, net::EventIndex /*event*/) {}
};

class Player;

// Who follows a run to measure it. Called in order; must not change the player.
class Observer {
 public:
    // What it wants to hear of; asked once per player.
    struct Wants {
        bool instants = false;  // passed(), which costs a look at each instant
        bool insides = false;   // fires(), arrives(), leaves()
    };
    virtual ~Observer() = default;
    virtual Wants wants() const = 0;

    // A run is being set up: whatever was seen before is another run's.
    virtual void prepare() = 0;
    // The initial marking, at time 0.
    virtual void begins(const Player& player) = 0;
    // One firing has just been made.
    virtual void fired(const Player& player) = 0;
    // An instant has come in which nothing fired: tokens have become ready, events have been lost.
    virtual void passed(const Player& /*player*/) {}

    // A transition is about to fire: `before` reads the state before (net::SlotKind), and the
    // variables that its arcs have bound.
    virtual void fires(SimTime /*at*/, net::TransitionIndex /*t*/, const Code::Reader& /*before*/) {
    }
    // A token of a timed place without records arrives, to be ready at that time; also before
    // begins().
    virtual void arrives(SimTime /*at*/, net::PlaceIndex /*p*/, SimTime /*ready*/) {}
    // A token of a place with records is taken.
    virtual void leaves(SimTime /*at*/, net::PlaceIndex /*p*/, SimTime /*arrived*/) {}
};

// Something that the outside makes happen. The outside makes events occur, never tokens.
struct OutsideEvent {
    SimTime at;
    net::EventIndex event;
    bool operator==(const OutsideEvent&) const = default;
};

struct Limits {
    SimTime until = SimTime::never();  // instants up to and including this one are played
    std::uint64_t firings = std::numeric_limits<std::uint64_t>::max();

    // `frames` frames at so many ticks each: the instants before the end of the last frame and that
    // end.
    static Limits frames(std::int64_t frames, SimTime frame) {
        return {.until = {frames * frame.ticks}};
    }
};

enum class Stop : std::uint8_t {
    kNone,   // not stopped: step() fired
    kLimit,  // a limit is reached
    kDead,   // nothing can happen any more (unless an event comes from outside)
    kFinal,  // the same, in a marking declared final
    kFault,  // the run cannot go on: see fault()
};

struct Options {
    std::uint64_t seed = 1;
    net::MovementHost* host = nullptr;            // for places with actions; outlives the player
    net::Chooser* chooser = nullptr;              // nullptr: random; outlives the player
    LogSink* sink = nullptr;                      // outlives the player
    Observer* observer = nullptr;                 // outlives the player
    SimTime beat = {kTicksPerSecond};             // of paced nets
    std::uint32_t firings_per_instant = 100'000;  // after these the run stops and names the cycle
    bool antithetic = false;                      // net::EngineOptions::antithetic
    // What goes on continuously beside the net, in the order of this list where their crossings
    // come at one time; outlive the player.
    std::vector<Coupled*> coupled = {};
    bool record = false;  // keep the outside events that were taken
};

class Player {
 public:
    // The net outlives the player.
    explicit Player(const net::Net& net, const Options& options = {});
    ~Player();
    Player(Player&&) noexcept;
    Player& operator=(Player&&) noexcept;

    // Events of a file, in its order. Before a run, or during it: then times that have been played
    // become the next tick.
    void schedule(std::span<const OutsideEvent> events);
    // An event from a person or a program, live: it occurs in the first tick that has not been
    // played yet.
    void push(net::EventIndex event);

    // One firing, letting time pass as needed (never beyond limits.until).
    Stop step(const Limits& limits = {});
    // Fires until a limit, the end, or a fault. Afterwards now() is the limit's time if that is
    // what ended the run.
    Stop run(const Limits& limits);
    // Plays everything up to and including this instant: for those who drive a net in real time.
    Stop advance_to(SimTime at);

    SimTime now() const;
    std::uint64_t firings() const;      // so far
    net::TransitionIndex last() const;  // the last firing
    // Over (tick, hash of the transition's path) of every firing so far.
    std::uint64_t log_hash() const;
    // When something happens next by itself; never() if nothing does.
    SimTime next_time() const;
    // What goes on beside the net.
    std::span<Coupled* const> coupled() const;

    std::uint32_t tokens(net::PlaceIndex p) const;  // ready or not
    std::uint32_t ready_tokens(net::PlaceIndex p) const;
    Value datum(net::DatumIndex d) const;
    bool fireable(net::TransitionIndex t) const;
    bool in_final_marking() const;

    // Why a run stopped with kFault: element, time, reason.
    const Diagnostic& fault() const;
    // Lost occurrences, rounded durations: what deserves a word, at most some hundreds.
    const Diagnostics& notes() const;

    // The whole state, at any instant (also between two firings of one), in few bytes, what is
    // coupled included. The host's state is not in it.
    std::vector<std::uint8_t> snapshot() const;
    // Fails  when the bytes are no snapshot of this net; the player is as before then.
    Status restore(std::span<const std::uint8_t> bytes);

    // With Options::record: the outside events in the order taken; scheduling them replays the
    // session.
    const std::vector<OutsideEvent>& recording() const;

 private:
    struct Data;
    std::unique_ptr<Data> data_;
};

}  // namespace puppetri::run
