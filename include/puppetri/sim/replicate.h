// SPDX-License-Identifier: MIT
// Replications: the same run again and again with other luck, on all cores, until there are enough.
// The numbers do not depend on how many threads, or in which order, they were made.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "puppetri/base/diagnostic.h"
#include "puppetri/sim/confidence.h"

namespace puppetri::sim {

// One replication. Streams of elements come from the seed by their paths, so that the same number
// has the same luck at every point of a sweep (common random numbers).
struct Replication {
    std::uint64_t number = 0;
    std::uint64_t seed = 0;
    bool antithetic = false;  // draws 1 - u where its partner, the number before, draws u
};

// With pairs, the numbers 2k and 2k + 1 share a seed. Seeds are below 2^63, as those in scenes and
// on command lines.
Replication replication(std::uint64_t seed, std::uint64_t number, bool antithetic_pairs);

// Makes runs, one at a time; each thread has one of its own.
class Runner {
 public:
    virtual ~Runner() = default;
    // Plays one replication from its beginning and writes its numbers.
    // Gives   false if it cannot be finished, and why.
    virtual bool run(const Replication& replication, std::span<double> values,
                     Diagnostic& fault) = 0;
};

class Experiment {
 public:
    virtual ~Experiment() = default;
    virtual std::size_t width() const = 0;  // numbers per replication
    // Called from the thread that will use it.
    virtual std::unique_ptr<Runner> runner() const = 0;
};

// What has been played before, here or by other processes, and what is to outlive this one: a
// killed sweep goes on.
class Journal {
 public:
    enum class Known : std::uint8_t { kNo, kFinished, kFailed };
    virtual ~Journal() = default;
    virtual Known recall(std::uint64_t number, std::span<double> values, Diagnostic& fault) = 0;
    // Called as replications end, one at a time, in any order; of runs that take less than a
    // millisecond, a few milliseconds later.
    virtual void keep(std::uint64_t number, std::span<const double> values) = 0;
    virtual void keep_failure(std::uint64_t number, const Diagnostic& fault) = 0;
    // What has been kept so far is to be safe from now on.
    virtual void settle() {}
    // Some replications of others are missing: looks what there is by now, after a while.
    // Gives   false if nobody is to be waited for.
    virtual bool wait() { return false; }
};

struct Plan {
    std::uint64_t seed = 1;
    std::uint64_t replications = 100;  // all, or the first stage where a precision is wanted
    Precision precision;               // of every one of `precise`
    std::vector<std::size_t> precise;  // numbers (columns) whose means must be so precise
    std::uint64_t at_most = 1'000'000;
    double level = 0.95;
    bool antithetic = false;  // even counts; intervals are those of pairs
    unsigned threads = 1;
    // Called now and then, from one thread at a time, with what is done and what is needed as far
    // as known: after a run, or after as many short ones as take some milliseconds. False ends the
    // experiment with what there is.
    bool (*go_on)(void* context, std::uint64_t done, std::uint64_t needed) = nullptr;
    void* context = nullptr;
    Journal* journal = nullptr;
    // One of several processes, each with its share of the numbers (pairs stay together), that tell
    // each other by their journals.
    unsigned rank = 0, ranks = 1;
    // All numbers are the share of this one (batches of one run), in their order.
    std::optional<unsigned> owner;
};

struct Failure {
    Replication replication;
    Diagnostic why;
};

struct Outcome {
    std::uint32_t width = 0;
    // The replications that were finished, in order of number, and their values row by row.
    std::vector<std::uint64_t> numbers;
    std::vector<double> values;
    std::vector<Failure> failures;  // in order of number; left out of all means
    // Per column: of the replications that have a number there. One that has none (a mean wait
    // where nobody waited) is NaN in `values`; a mean of none is NaN.
    std::vector<Confidence> means;
    std::vector<Tally> tallies;  // per column: of the single replications, also of pairs
    bool interrupted = false;    // go_on said so
    bool missing = false;        // shares of other processes are not there yet
    bool precise_enough = true;  // false: at_most came first

    std::span<const double> row(std::size_t i) const {
        return std::span(values).subspan(i * std::size_t{width}, width);
    }
};

// Needs   plan.replications >= 2 (of pairs: 4). Cost: the runs; memory: all values.
Outcome replicate(const Experiment& experiment, const Plan& plan);

}  // namespace puppetri::sim
