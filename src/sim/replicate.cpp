// SPDX-License-Identifier: MIT
// Threads take the next number each; results are put in order afterwards.
#include "puppetri/sim/replicate.h"

#include <algorithm>
#include <atomic>
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
    return {.number = number,
            .seed = Hash64(seed).add_text("replication").add_u64(luck).value(),
            .antithetic = antithetic_pairs && number % 2 == 1};
}

namespace {

using Known = Journal::Known;

// Numbers begin .. end of one stage, played by several threads.
class Stage {
 public:
    Stage(const Experiment& experiment, const Plan& plan, std::uint64_t begin, std::uint64_t end,
          std::vector<Known>& state, std::vector<double>& values, Outcome& outcome)
        : experiment_(experiment),
          plan_(plan),
          end_(end),
          next_(begin),
          done_(begin),
          state_(state),
          values_(values),
          outcome_(outcome) {}

    void play() {
        const std::size_t count =
            PUP_SIM_THREADS
                ? std::clamp<std::uint64_t>(end_ - next_, 1, std::max(1U, plan_.threads))
                : 1;
        std::vector<std::thread> threads;
        for (std::size_t i = 1; i < count; ++i) {
            threads.emplace_back([this] { work(); });
        }
        work();
        for (std::thread& t : threads) {
            t.join();
        }
    }

 private:
    void work() {
        const std::unique_ptr<Runner> runner = experiment_.runner();
        const std::size_t width = experiment_.width();
        std::vector<double> row(width);
        for (;;) {
            const std::uint64_t number = next_.fetch_add(1, std::memory_order_relaxed);
            if (number >= end_ || stopped_.load(std::memory_order_relaxed)) {
                return;
            }
            const std::uint64_t turn = plan_.antithetic ? number / 2 : number;
            const std::uint64_t player = plan_.owner ? *plan_.owner : turn % plan_.ranks;
            if (state_[number] != Known::kNo || player != plan_.rank) {
                done_.fetch_add(1, std::memory_order_relaxed);
                continue;
            }
            const Replication r = replication(plan_.seed, number, plan_.antithetic);
            Diagnostic fault;
            const bool good = runner->run(r, row, fault);
            const std::lock_guard<std::mutex> lock(mutex_);
            if (good) {
                std::copy(row.begin(), row.end(),
                          values_.begin() + static_cast<std::ptrdiff_t>(number * width));
                state_[number] = Known::kFinished;
                if (plan_.journal != nullptr) {
                    plan_.journal->keep(number, row);
                }
            } else {
                state_[number] = Known::kFailed;
                if (plan_.journal != nullptr) {
                    plan_.journal->keep_failure(number, fault);
                }
                outcome_.failures.push_back({r, std::move(fault)});
            }
            const std::uint64_t done = done_.fetch_add(1, std::memory_order_relaxed) + 1;
            if (plan_.go_on != nullptr && !plan_.go_on(plan_.context, done, end_)) {
                stopped_.store(true, std::memory_order_relaxed);
                outcome_.interrupted = true;
            }
        }
    }

    const Experiment& experiment_;
    const Plan& plan_;
    const std::uint64_t end_;
    std::atomic<std::uint64_t> next_, done_;
    std::atomic<bool> stopped_{false};
    std::mutex mutex_;  // of everything below
    std::vector<Known>& state_;
    std::vector<double>& values_;
    Outcome& outcome_;
};

// The independent observations of one column.
Tally observations(const Plan& plan, std::size_t width, std::size_t column,
                   const std::vector<Known>& state, const std::vector<double>& values) {
    Tally tally;
    const std::uint64_t step = plan.antithetic ? 2 : 1;
    for (std::uint64_t n = 0; n + step <= state.size(); n += step) {
        if (state[n] != Known::kFinished || state[n + step - 1] != Known::kFinished) {
            continue;  // half a pair says nothing
        }
        const double first = values[n * width + column];
        const double x = step == 1 ? first : (first + values[(n + 1) * width + column]) / 2;
        if (!std::isnan(x)) {  // a mean of nothing says nothing
            tally.add(x);
        }
    }
    return tally;
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
    const auto observed = [&](std::size_t column) {
        return observations(plan, width, column, state, values);
    };
    // Independent observations of the first stage: fewer than planned where some failed
    std::vector<std::uint64_t> first_stage(width);
    play_to(first);
    for (std::size_t c = 0; c < width; ++c) {
        first_stage[c] = observed(c).count();
    }
    while (plan.precision.wanted() && !outcome.interrupted && !outcome.missing) {
        std::uint64_t needed = state.size();
        for (const std::size_t c : plan.precise) {
            if (first_stage[c] < 2) {
                continue;
            }
            const Tally so_far = observed(c);
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
    }

    for (std::size_t c = 0; c < width; ++c) {
        const Tally all = observed(c);
        outcome.means.push_back(plan.precision.wanted() && first_stage[c] >= 2
                                    ? staged_confidence(all, first_stage[c], plan.level)
                                    : confidence(all, plan.level));
        if (all.count() == 0) {
            outcome.means.back().mean = std::numeric_limits<double>::quiet_NaN();
        }
    }
    for (std::uint64_t n = 0; n < state.size(); ++n) {
        if (state[n] == Known::kFinished) {
            outcome.numbers.push_back(n);
            const auto row = std::span(values).subspan(n * width, width);
            outcome.values.insert(outcome.values.end(), row.begin(), row.end());
        }
    }
    std::sort(outcome.failures.begin(), outcome.failures.end(),
              [](const Failure& a, const Failure& b) {
                  return a.replication.number < b.replication.number;
              });
    return outcome;
}

}  // namespace puppetri::sim
