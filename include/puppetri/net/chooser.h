// SPDX-License-Identifier: MIT
// The one interface of choice. Whatever is not decided by the net is asked here: who wins a tie,
// how long a token or a delay lasts, which token of an `any` place, whether something outside
// happens. Three implementations: random (from streams that each element owns), scripted (a
// witness, a recorded session), exhaustive (all of them, one after another).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "puppetri/base/index.h"
#include "puppetri/base/time.h"

namespace puppetri::net {

enum class ChoiceKind : std::uint8_t {
    kTie,        // which of `options` transitions (in order of path) fires
    kDuration,   // how long a token with a distribution lasts
    kDelay,      // how long a delay with a distribution lasts
    kInterval,   // a duration or delay in [low, high]
    kToken,      // which of `options` tokens (in order of serial) of an `any` place
    kEvent,      // free runs: nothing more here (0), or outside event number i - 1 occurs now
    kFreeGuard,  // free runs: the sensor `element`, which no event sets, is now false (0) or true
                 // (1)
};

struct Choice {
    ChoiceKind kind = ChoiceKind::kTie;
    // Place, transition or sensor; none for ties and events.
    std::uint32_t element = Index<void>::kNone;
    bool of_delay = false;  // kInterval: the element is a transition, not a place
    // How many answers there are: 0 .. options - 1. If 0, the answer is a time in [low, high].
    std::uint32_t options = 0;
    SimTime low, high;
    // Of distributions and intervals: what the element's own stream says.
    SimTime drawn;
    // Of ties: who competes, with which odds.
    std::span<const std::uint32_t> transitions;
    std::span<const double> odds;
};

// An answer: an option, or ticks.
class Chooser {
 public:
    virtual ~Chooser() = default;
    // Gives  an answer within the choice's bounds; the engine aborts the run on any other.
    virtual std::int64_t choose(const Choice& choice) = 0;
    // True: the engine draws by itself from the streams of the elements, fast, and never calls
    // choose().
    virtual bool draws_from_streams() const { return false; }
};

// Ties by the ticket race, everything else from the elements' own streams (docs/semantics.md).
class RandomChooser final : public Chooser {
 public:
    std::int64_t choose(const Choice& choice) override;
    bool draws_from_streams() const override { return true; }
};

// Plays a given list of answers; when it is used up, the first option, or what the stream says.
class ScriptedChooser final : public Chooser {
 public:
    explicit ScriptedChooser(std::vector<std::int64_t> answers) : answers_(std::move(answers)) {}
    std::int64_t choose(const Choice& choice) override;
    std::size_t used() const { return next_; }
    bool exhausted() const { return next_ >= answers_.size(); }
    // An answer of the script was out of bounds and has been replaced by the nearest one.
    bool misfit() const { return misfit_; }

 private:
    std::vector<std::int64_t> answers_;
    std::size_t next_ = 0;
    bool misfit_ = false;
};

// Wraps another chooser and keeps its answers: its script replays the run.
class RecordingChooser final : public Chooser {
 public:
    explicit RecordingChooser(Chooser& inner) : inner_(&inner) {}
    std::int64_t choose(const Choice& choice) override;
    const std::vector<std::int64_t>& answers() const { return answers_; }

 private:
    Chooser* inner_;
    std::vector<std::int64_t> answers_;
};

// All sequences of answers, depth first: run from the same start again and again while next() is
// true.
//   ExhaustiveChooser all;
//   do { engine.restore(start); ... } while (all.next());
// Of intervals it takes some values evenly spread, both ends included; of distributions what the
// stream says, so that runs differ by what is discrete.
class ExhaustiveChooser final : public Chooser {
 public:
    std::int64_t choose(const Choice& choice) override;
    // Moves on to the next sequence. False: all have been taken.
    bool next();
    // How many values of an interval; 2 unless told.
    void interval_points(std::uint32_t points) { interval_points_ = points; }

 private:
    struct Turn {
        std::uint32_t taken = 0, options = 0;
    };
    std::vector<Turn> turns_;
    std::size_t depth_ = 0;
    std::uint32_t interval_points_ = 2;
};

}  // namespace puppetri::net
