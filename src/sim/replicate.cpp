// SPDX-License-Identifier: MIT
// Threads take stretches of numbers; each row has its place, and sums have an order of their own.
#include "puppetri/sim/replicate.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <thread>

#include "puppetri/base/hash.h"
#include "puppetri/base/require.h"

#if !defined(__EMSCRIPTEN__) || defined(__EMSCRIPTEN_PTHREADS__)
#define PUP_SIM_THREADS 1
#else
#define PUP_SIM_THREADS 0
#endif

namespace puppetri::sim {

Replication replication(std::uint64_t seed, std::uint64_t number, bool antithetic_pairs) {
    const std::uint64_t luck = antithetic_pairs ? number / 2 : number;
    // One that can be written wherever a seed can
    constexpr std::uint64_t kSigned = ~std::uint64_t{0} >> 1;
    return {.number = number,
            .seed = Hash64(seed).add_text("replication").add_u64(luck).value() & kSigned,
            .antithetic = antithetic_pairs && number % 2 == 1};
}

namespace {

using Known = Journal::Known;

// Work that takes turns on up to so many threads, this one among them.
template <typename Work>
void on_threads(std::uint64_t count, const Work& work) {
    std::vector<std::thread> threads;
    for (std::uint64_t i = 1; PUP_SIM_THREADS && i < count; ++i) {
        threads.emplace_back(work);
    }
    work();
    for (std::thread& t : threads) {
        t.join();
    }
}

// Numbers begin .. end of one stage, played by several threads. Each takes a stretch of numbers at
// a time and writes their rows where they belong; only what others must know (the journal, faults,
// how far it is) waits for its turn, once per stretch. Stretches are as long as keeps a thread busy
// for a millisecond or so: short runs hardly meet, and of long ones a kill costs no more than one.
class Stage {
 public:
    Stage(const Experiment& experiment, const Plan& plan, std::uint64_t begin, std::uint64_t end,
          std::vector<Known>& state, std::vector<double>& values, Outcome& outcome)
        : experiment_(experiment),
          plan_(plan),
          begin_(begin),
          end_(end),
          threads_(std::clamp<std::uint64_t>(end - begin, 1, std::max(1U, plan.threads))),
          width_(experiment.width()),
          state_(state),
          values_(values),
          outcome_(outcome),
          done_(begin),
          next_(begin) {}

    void play() {
        on_threads(threads_, [this] { work(); });
    }

 private:
    using Clock = std::chrono::steady_clock;
    static constexpr Clock::duration kShort = std::chrono::microseconds(500);
    static constexpr Clock::duration kLong = std::chrono::milliseconds(2);

    // By one thread, since it told last.
    struct Played {
        std::vector<std::uint64_t> finished;
        std::vector<Failure> failures;
    };

    void work() {
        const std::unique_ptr<Runner> runner = experiment_.runner();
        // So that all threads end at nearly the same time
        const std::uint64_t longest = std::max<std::uint64_t>(1, (end_ - begin_) / (8 * threads_));
        std::uint64_t length = 1;
        Played played;
        for (;;) {
            std::uint64_t from = next_.fetch_add(length, std::memory_order_relaxed);
            if (from >= end_) {
                return;
            }
            const std::uint64_t to = std::min(end_, from + length);
            const Clock::time_point start = Clock::now();
            Clock::time_point told = start;
            for (std::uint64_t n = from; n < to;) {
                if (stopped_.load(std::memory_order_relaxed)) {
                    tell(n - from, played);
                    return;
                }
                play(*runner, n++, played);
                const Clock::time_point now = Clock::now();
                if (n == to || now - told > kLong) {
                    tell(n - from, played);
                    from = n;
                    told = now;
                }
            }
            const Clock::duration took = told - start;
            length = took < kShort  ? std::min(2 * length, longest)
                     : took > kLong ? std::max<std::uint64_t>(1, length / 2)
                                    : length;
        }
    }

    bool mine(std::uint64_t number) const {
        const std::uint64_t turn = plan_.antithetic ? number / 2 : number;
        return (plan_.owner ? *plan_.owner : turn % plan_.ranks) == plan_.rank;
    }

    void play(Runner& runner, std::uint64_t number, Played& played) {
        if (state_[number] != Known::kNo || !mine(number)) {
            return;
        }
        const Replication r = replication(plan_.seed, number, plan_.antithetic);
        Diagnostic fault;
        if (runner.run(r, row(number), fault)) {
            state_[number] = Known::kFinished;
            played.finished.push_back(number);
        } else {
            state_[number] = Known::kFailed;
            played.failures.push_back({r, std::move(fault)});
        }
    }

    // So many more numbers are done with, of which some may have been known before.
    void tell(std::uint64_t more, Played& played) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (plan_.journal != nullptr) {
            for (const std::uint64_t n : played.finished) {
                plan_.journal->keep(n, row(n));
            }
        }
        for (Failure& f : played.failures) {
            if (plan_.journal != nullptr) {
                plan_.journal->keep_failure(f.replication.number, f.why);
            }
            outcome_.failures.push_back(std::move(f));
        }
        if (plan_.journal != nullptr) {
            plan_.journal->settle();
        }
        played.finished.clear();
        played.failures.clear();
        done_ += more;
        if (plan_.go_on != nullptr && !plan_.go_on(plan_.context, done_, end_)) {
            stopped_.store(true, std::memory_order_relaxed);
            outcome_.interrupted = true;
        }
    }

    std::span<double> row(std::uint64_t number) {
        return std::span(values_).subspan(number * width_, width_);
    }

    const Experiment& experiment_;
    const Plan& plan_;
    const std::uint64_t begin_, end_, threads_;
    const std::size_t width_;
    std::vector<Known>& state_;  // each number's is of the thread that plays it
    std::vector<double>& values_;
    std::mutex mutex_;  // of the three that follow
    Outcome& outcome_;
    std::uint64_t done_;
    alignas(64) std::atomic<std::uint64_t> next_;
    std::atomic<bool> stopped_{false};
};
// The observations of each column, single runs or means of pairs: block by block of numbers, and
// the blocks in their order, so that threads can share them and rounding is the same however many
// there are.
std::vector<Tally> observations(const Plan& plan, bool pairs, std::size_t width,
                                const std::vector<Known>& state,
                                const std::vector<double>& values) {
    constexpr std::uint64_t kBlock = 4096;  // whole pairs
    const std::uint64_t blocks = (state.size() + kBlock - 1) / kBlock;
    const std::uint64_t step = pairs ? 2 : 1;
    std::vector<Tally> parts(blocks * width);
    std::atomic<std::uint64_t> next{0};
    on_threads(std::clamp<std::uint64_t>(blocks, 1, std::max(1U, plan.threads)), [&] {
        for (std::uint64_t b = next++; b < blocks; b = next++) {
            const std::span<Tally> tallies = std::span(parts).subspan(b * width, width);
            const std::uint64_t end = std::min<std::uint64_t>(state.size(), (b + 1) * kBlock);
            for (std::uint64_t n = b * kBlock; n + step <= end; n += step) {
                if (state[n] != Known::kFinished || state[n + step - 1] != Known::kFinished) {
                    continue;  // half a pair says nothing
                }
                for (std::size_t c = 0; c < width; ++c) {
                    const double first = values[n * width + c];
                    const double x = step == 1 ? first : (first + values[(n + 1) * width + c]) / 2;
                    if (!std::isnan(x)) {  // a mean of nothing says nothing
                        tallies[c].add(x);
                    }
                }
            }
        }
    });
    std::vector<Tally> all(width);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        all[i % width].merge(parts[i]);
    }
    return all;
}

}  // namespace

Outcome replicate(const Experiment& experiment, const Plan& plan) {
    const std::size_t width = experiment.width();
    const std::uint64_t pair = plan.antithetic ? 2 : 1;
    PUP_REQUIRE(plan.replications >= 2 * pair);
    Outcome outcome;
    outcome.width = static_cast<std::uint32_t>(width);
    std::vector<Known> state;
    std::vector<double> values;
    // What the journal knows of these numbers. False: something is missing.
    const auto recall = [&](std::uint64_t begin) {
        bool all = true;
        for (std::uint64_t n = begin; n < state.size(); ++n) {
            if (state[n] == Known::kNo && plan.journal != nullptr) {
                Diagnostic fault;
                state[n] =
                    plan.journal->recall(n, std::span(values).subspan(n * width, width), fault);
                if (state[n] == Known::kFailed) {
                    outcome.failures.push_back(
                        {replication(plan.seed, n, plan.antithetic), std::move(fault)});
                }
            }
            all = all && state[n] != Known::kNo;
        }
        return all;
    };
    const auto play_to = [&](std::uint64_t end) {
        const std::uint64_t begin = state.size();
        state.resize(end, Known::kNo);
        values.resize(end * width);
        recall(begin);
        Stage(experiment, plan, begin, end, state, values, outcome).play();
        while (plan.ranks > 1 && !outcome.interrupted && !recall(begin)) {
            if (plan.journal == nullptr || !plan.journal->wait()) {
                outcome.missing = true;
                break;
            }
        }
    };
    const auto whole_pairs = [&](std::uint64_t n) { return (n + pair - 1) / pair * pair; };

    const std::uint64_t first = whole_pairs(plan.replications);
    // Independent observations of the first stage: fewer than planned where some failed
    std::vector<std::uint64_t> first_stage(width);
    play_to(first);
    // What is independent: pairs, where there are any
    std::vector<Tally> observed = observations(plan, plan.antithetic, width, state, values);
    for (std::size_t c = 0; c < width; ++c) {
        first_stage[c] = observed[c].count();
    }
    while (plan.precision.wanted() && !outcome.interrupted && !outcome.missing) {
        std::uint64_t needed = state.size();
        for (const std::size_t c : plan.precise) {
            if (first_stage[c] < 2) {
                continue;
            }
            const Tally& so_far = observed[c];
            // Those that failed do not help: as many more as are missing
            const std::uint64_t missing =
                replications_needed(so_far, first_stage[c], plan.precision, plan.level) -
                so_far.count();
            needed = std::max(needed, state.size() + pair * missing);
        }
        const std::uint64_t limit = std::max<std::uint64_t>(first, whole_pairs(plan.at_most));
        outcome.precise_enough = needed <= limit;
        const std::uint64_t next = std::min(needed, limit);
        if (next <= state.size()) {
            break;
        }
        play_to(next);
        observed = observations(plan, plan.antithetic, width, state, values);
    }

    for (std::size_t c = 0; c < width; ++c) {
        const Tally& all = observed[c];
        outcome.means.push_back(plan.precision.wanted() && first_stage[c] >= 2
                                    ? staged_confidence(all, first_stage[c], plan.level)
                                    : confidence(all, plan.level));
        if (all.count() == 0) {
            outcome.means.back().mean = std::numeric_limits<double>::quiet_NaN();
        }
    }
    outcome.tallies =
        plan.antithetic ? observations(plan, false, width, state, values) : std::move(observed);
    for (std::uint64_t n = 0; n < state.size(); ++n) {
        if (state[n] == Known::kFinished) {
            // Rows move up where some are missing
            const std::uint64_t row = outcome.numbers.size();
            if (row != n) {
                std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(n * width), width,
                            values.begin() + static_cast<std::ptrdiff_t>(row * width));
            }
            outcome.numbers.push_back(n);
        }
    }
    values.resize(outcome.numbers.size() * width);
    outcome.values = std::move(values);
    std::sort(outcome.failures.begin(), outcome.failures.end(),
              [](const Failure& a, const Failure& b) {
                  return a.replication.number < b.replication.number;
              });
    return outcome;
}

}  // namespace puppetri::sim
