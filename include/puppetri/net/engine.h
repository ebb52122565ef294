// SPDX-License-Identifier: MIT
// Firing and the advance of time: the one engine, drivable choice by choice. Simulators step it
// with a random chooser, provers with an exhaustive one.
//   Engine engine(net, chooser);
//   engine.start();
//   while (engine.step() == Engine::Outcome::kFired) { ... engine.state().last ... }
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/base/random.h"
#include "puppetri/net/chooser.h"
#include "puppetri/net/host.h"
#include "puppetri/net/net.h"
#include "puppetri/net/state.h"
#include "puppetri/net/tables.h"
#include "puppetri/net/timekeeper.h"

namespace puppetri::net {

// Who hears of firings and occurrences while they happen. Must not touch the engine.
class EngineListener {
 public:
    virtual ~EngineListener() = default;
    virtual void fired(SimTime at, TransitionIndex t) = 0;
    virtual void occurs(SimTime at, EventIndex e) = 0;
    virtual void lost(SimTime at, EventIndex e) = 0;
    // For those who measure. A transition fires: nothing has moved yet, `before` reads the state
    // and the variables that its arcs have bound (SlotKind).
    virtual void fires(SimTime /*at*/, TransitionIndex /*t*/, const Code::Reader& /*before*/) {}
    // A token of a timed place without records arrives, to be ready at that time.
    virtual void arrives(SimTime /*at*/, PlaceIndex /*p*/, SimTime /*ready*/) {}
    // A token of a place with records is taken.
    virtual void leaves(SimTime /*at*/, PlaceIndex /*p*/, SimTime /*arrived*/) {}
};

struct EngineOptions {
    std::uint64_t seed = 1;
    MovementHost* host = nullptr;
    EngineListener* listener = nullptr;
    std::int64_t beat = kTicksPerSecond;  // of paced nets
    std::uint32_t firings_per_instant = 100'000;
    // Free runs, for those who explore: whenever an instant has settled, the chooser is asked
    // whether an outside event occurs (so many at most in the whole run) and what the sensors say
    // that no event sets. Not with RandomChooser.
    bool free = false;
    std::uint32_t free_events = 0;
    // Durations and delays are drawn from 1 - u where they would be drawn from u (antithetic
    // variates). Ties and tokens of `any` places are as without.
    bool antithetic = false;
    // Keeps the clocks instead of the engine. Not with RandomChooser, nor with a host.
    Timekeeper* timekeeper = nullptr;
};

class Engine final : private Code::Reader {
 public:
    enum class Outcome : std::uint8_t {
        kFired,
        kSettled,  // nothing more happens up to the given time; now is that time
        kDead,     // nothing happens any more by itself
        kFault,    // see fault()
    };

    // The net, the chooser, host and listener outlive the engine.
    Engine(const Net& net, Chooser& chooser, const EngineOptions& options = {});

    // The initial marking at time 0. To be called once before anything else, or restore().
    void start();
    // Goes on from a state of the same net.
    void restore(State state);
    const State& state() const { return state_; }  // for looking; to keep it, save()
    State save() const;

    // Lets time pass as needed, but not beyond `until`, and fires one transition.
    Outcome step(std::int64_t until = SimTime::never().ticks);
    // Fires until nothing happens up to `until`, or until so many firings in all.
    Outcome run(std::int64_t until, std::uint64_t firings);

    // For those who explore: what run() would do next, in its smallest steps.
    enum class Turn : std::uint8_t {
        kFired,
        kOffered,     // an occurrence is offered now
        kOfferEnded,  // nobody (else) wants it
        kAsked,       // free runs: the outside has done something
        kPassed,      // time: tokens may be ready now, nothing has fired yet
        kWaits,       // with a timekeeper: nothing happens before pass()
        kDead,        // nothing happens any more by itself
        kFault,
    };
    Turn turn();
    // With a timekeeper: the next instant begins, in which everything that waits under one of these
    // numbers is ready, due, or occurs. Needs an instant that has settled.
    void pass(std::span<const std::int64_t> numbers);

    // An event from outside. Needs at >= now.
    void occur(EventIndex event, SimTime at);
    // The next time at which something happens by itself; now if something can fire at once;
    // never() if nothing.
    std::int64_t next_time();
    // Time passes up to an instant before which nothing happens by itself.
    // Needs next_time() > at.
    void pass_to(SimTime at);
    // In this instant nothing can fire any more and no occurrence is pending.
    bool settled();
    bool fireable(TransitionIndex t) const { return (hot_[t.value].candidate & 3) != 0; }
    bool in_final_marking() const;

    const Diagnostic& fault() const { return fault_; }
    bool faulted() const { return faulted_; }
    const Diagnostics& notes() const { return notes_; }

 private:
    static constexpr std::uint32_t kFresh = 1, kRaced = 2, kStatus = 3;  // of Hot::candidate
    static constexpr std::size_t kAhead = 16;  // so many firings ahead memory is asked for
    // From here on tables lie outside the nearest cache
    static constexpr std::size_t kManyTickets = 1024;

    // All that an ordinary firing reads of a transition, in one cache line.
    struct alignas(64) Hot {
        std::uint32_t unsatisfied = 0;  // conditions on counts that do not hold
        std::uint32_t candidate = 0;  // stamp * 4 + 0 no candidate, 1 without ticket, 2 with ticket
        std::uint64_t ticket_key = 0;
        std::uint64_t ticket_draws = 0;
        std::uint64_t path_hash = 0;                  // for the log
        std::uint32_t takes = 0, gives = 0, end = 0;  // copies of the net's row
        std::uint16_t level = 0;
        std::uint8_t flags = 0;
        Weighted few[2];  // its arcs, if they are no more
    };
    static_assert(sizeof(Weighted) == 8);
    struct Fresh {
        std::uint32_t transition, stamp;
    };
    struct Level {
        std::vector<Fresh> fresh;  // may hold stale ones
        std::uint32_t live_fresh = 0, live_raced = 0;
    };
    // Draws of a stream that have been computed before they are asked for, several at a time: a
    // draw is a function of its number alone, and several logarithms at once cost little more than
    // one.
    struct Ahead {
        static constexpr std::uint32_t kMost = 8;
        std::uint64_t count = 0;  // the number of the draw ticks[at]
        std::uint32_t at = 0, size = 0;
        std::int64_t ticks[kMost] = {};
    };
    struct Chosen {  // a token that a binding takes or reads
        std::uint32_t rich, slot;
        ArcKind kind;
    };

    Value read(std::uint32_t kind, std::uint32_t index) const override;

    // engine.cpp, lottery.cpp
    void rebuild();
    void enter(std::uint32_t t);
    void leave(std::uint32_t t);
    void ready_changed(std::uint32_t p, std::uint32_t from, std::uint32_t to);
    void total_changed(std::uint32_t p, std::uint32_t from, std::uint32_t to);
    void change_ready(std::uint32_t p, std::uint32_t from, std::uint32_t to);  // for other files
    void change_total(std::uint32_t p, std::uint32_t from, std::uint32_t to);
    bool somebody_can_fire() const;
    void cross(const Watcher& w, std::uint32_t from, std::uint32_t to);
    void touch_dependents(std::uint32_t p);
    std::uint32_t level_of(std::uint32_t t) const { return hot_[t].level; }
    // Where its arcs lie: takes, then gives.
    const Weighted* arcs_of(const Hot& h) const {
        return h.end - h.takes <= 2 ? h.few : tables_->arcs.data() + h.takes;
    }
    std::span<const Weighted> takes(std::uint32_t t) const {
        const Hot& h = hot_[t];
        return {arcs_of(h), h.gives - h.takes};
    }
    std::span<const Weighted> gives(std::uint32_t t) const {
        const Hot& h = hot_[t];
        return {arcs_of(h) + (h.gives - h.takes), h.end - h.gives};
    }
    std::uint32_t select();
    std::uint32_t race(std::uint32_t level);
    void look_ahead(const Lottery& lottery) const;
    void prefetch_arcs(std::uint32_t t) const;
    void look_ahead(const PendingRing& ring) const;
    std::uint32_t ask_tie(std::uint32_t level);
    static void settle_lottery(Lottery& lottery);
    double ticket(std::uint32_t t);
    void fire(std::uint32_t t);
    void take_plain(std::uint32_t t);
    void give_plain(std::uint32_t t);
    void give_timed(std::uint32_t p, std::uint32_t weight);
    void add_timed(std::uint32_t p, std::int64_t ticks, std::uint32_t fifo);
    void finish_firing(std::uint32_t t);
    void advance_to(std::int64_t at);
    void ripen(const Pending& p);
    bool stale(const Pending& p) const;
    std::int64_t next_pending();

    // special.cpp
    void fire_special(std::uint32_t t);
    void touch(std::uint32_t t);  // looked at again before anything else fires
    void look_again(bool intermediate);
    void gate_closed(std::uint32_t t);
    bool marked(const Special& s, bool intermediate);
    std::uint32_t degree(const Special& s) const;
    void set_clocks(std::uint32_t delay, std::uint32_t wanted);
    bool start_clock(std::uint32_t delay, std::int64_t ticks);
    void look_at_delay(std::uint32_t t, std::uint32_t number, std::uint32_t delay);
    std::uint32_t running_clocks(std::uint32_t delay) const;
    bool offered_to(const Special& s) const;
    double odds(std::uint32_t t);
    bool module_is_clean(const Special& s);
    void resample();

    // events.cpp
    void offer_first();
    void end_offer();
    void push_occurrence(Occurrence o);
    bool occurrence_pending_now() const;
    void use_offer(const Special& s);
    void miss_offer(const Special& s);
    bool ask_outside();
    void forget_activity(std::uint32_t activity);

    // binding.cpp
    // Finds the binding of arcs to tokens; while firing, tokens of `any` places are drawn.
    bool bind(const Special& s, bool firing);
    bool bind_from(const Special& s, std::size_t arc, std::uint32_t copy, std::uint32_t from,
                   bool firing);
    bool bind_any(const Special& s, std::size_t arc, std::uint32_t copy, std::uint32_t from,
                  std::uint32_t end);
    bool try_token(const Special& s, std::size_t arc, std::uint32_t copy, std::uint32_t position,
                   bool firing);
    bool matches(const ArcTable& arc, std::uint32_t slot, std::uint32_t mark);
    void unbind(const ArcTable& arc, std::uint32_t mark);
    bool chosen_before(const ArcTable& arc, std::uint32_t slot) const;
    bool guard_holds(const Special& s);
    std::int64_t time_left(const Token& token) const;

    // tokens.cpp
    void start_marking();
    void add_token(std::uint32_t p, std::span<const Value> attributes, std::int64_t ticks,
                   bool ready);
    void remove_token(std::uint32_t rich, std::uint32_t slot, bool now);
    void ready_token(std::uint32_t rich, std::uint32_t slot);
    void place_in_order(std::uint32_t rich, std::uint32_t slot);
    void take_from_order(std::uint32_t rich, std::uint32_t slot);
    bool comes_before(const RichPlaceTable& r, const Token& a, const Token& b) const;
    void give_special(const OutputTable& out, std::size_t first);
    void make_ready(std::uint32_t p);

    // durations.cpp
    // Ticks of a new token of place p; -1 for open; false: a fault.
    bool draw_place(std::uint32_t p, std::int64_t& ticks);
    // `ahead`: number in ahead_, of exponential durations with a constant mean.
    bool draw(const DurationTable& d, std::uint64_t key, std::uint64_t& count, std::uint32_t ahead,
              ChoiceKind kind, std::uint32_t element, std::int64_t& ticks);
    bool draw_exponential(double mean_s, std::uint64_t key, std::uint64_t& count, Ahead& ahead,
                          std::int64_t& ticks);
    bool evaluate(ProgramIndex program, Value& out);

    // exploring.cpp
    // The keeper's answer as ticks: 0, or a time that is a wait.
    std::int64_t wait(Timekeeper::Kind kind, std::uint32_t element, std::int64_t low,
                      std::int64_t high);
    bool waits(std::int64_t ticks) const {
        return options_.timekeeper != nullptr && is_wait(ticks);
    }
    // When it is over, what lasts so many ticks from now. False: after the end of time.
    bool ends_at(std::int64_t ticks, std::int64_t& at) const {
        if (waits(ticks)) {
            at = ticks;
            return true;
        }
        return ticks != SimTime::never().ticks && !__builtin_add_overflow(state_.now, ticks, &at);
    }
    void collect_unordered();
    std::int64_t held_back(const RichTokens& place) const;
    std::uint32_t unordered_from(std::uint32_t rich, std::uint32_t position) const;

    // faults.cpp
    void fail(const char* code, std::string element, const SourceSpan& where, std::string message,
              std::string remedy);
    void fail_place(std::uint32_t p, const char* code, std::string message, std::string remedy);
    void fail_transition(std::uint32_t t, const char* code, std::string message,
                         std::string remedy);
    void watch_instant(std::uint32_t t);
    void note(const char* code, std::string element, std::string message);

    const Net* net_;
    const NetTables* tables_;
    Chooser* chooser_;
    bool random_;
    EngineOptions options_;
    std::uint64_t flip_;  // RandomStream::flip of durations and delays
    State state_;

    // Scratch: computed from the state, or meaningless between two firings.
    std::vector<Hot> hot_;
    std::vector<Level> levels_;
    std::vector<std::uint64_t> duration_keys_, delay_keys_, token_keys_;
    std::vector<std::uint32_t> duration_ahead_, delay_ahead_;  // numbers in ahead_
    std::vector<Ahead> ahead_;
    std::vector<std::uint8_t> marked_;   // per special
    std::vector<double> last_odds_;      // per special: of its ticket
    std::vector<std::uint8_t> touched_;  // per special
    std::vector<std::uint32_t> touch_list_;
    std::vector<std::uint32_t> outside_events_, free_sensors_;  // of free runs
    std::vector<std::uint32_t> resampled_;                      // specials with memory `resample`
    // Per place with records: which of its waiting tokens comes first is not known (timekeeper).
    std::vector<std::uint8_t> unordered_;
    std::vector<Value> variables_;
    std::vector<std::uint32_t>
        bound_;  // per variable: 0, or 1 + how many tokens were chosen when it was bound
    std::vector<Chosen> chosen_;
    const Value* attributes_ = nullptr;        // of the token in question
    std::vector<std::int64_t> sibling_ticks_;  // per place, of this firing; empty without `as`
    std::vector<Value> assigned_, given_;
    std::vector<std::uint32_t> options_list_;
    std::vector<double> odds_list_;
    bool quiet_ = false;  // faults of evaluation are answers, not faults
    Diagnostic fault_;
    bool faulted_ = false;
    Diagnostics notes_;
    std::vector<std::uint32_t> instant_log_;
    std::vector<Counts> instant_counts_;
};

}  // namespace puppetri::net
