// SPDX-License-Identifier: MIT
#include "puppetri/verdict/sample.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

#include "puppetri/base/elementary.h"
#include "puppetri/base/random.h"
#include "puppetri/base/require.h"
#include "run_hosts.h"

namespace puppetri::verdict {
namespace {

double now_s() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

// P(X >= k) for X binomial(n, p), from the greatest term outwards, so that nothing underflows
// before it is negligible.
double upper_tail(std::uint64_t k, std::uint64_t n, double p) {
    if (k == 0) {
        return 1;
    }
    if (p <= 0) {
        return 0;
    }
    if (p >= 1) {
        return 1;
    }
    const double ratio = p / (1 - p);
    const auto mode =
        std::min<std::uint64_t>(n, static_cast<std::uint64_t>(static_cast<double>(n + 1) * p));
    // Terms relative to that of the mode.
    double above = 0, all = 1;
    if (mode >= k) {
        above = 1;
    }
    double term = 1;
    for (std::uint64_t i = mode; i < n; ++i) {
        term *= ratio * static_cast<double>(n - i) / static_cast<double>(i + 1);
        all += term;
        if (i + 1 >= k) {
            above += term;
        }
        if (term < 1e-18 * all && i + 1 >= k) {
            break;
        }
    }
    term = 1;
    for (std::uint64_t i = mode; i > 0; --i) {
        term *= static_cast<double>(i) / (ratio * static_cast<double>(n - i + 1));
        all += term;
        if (i - 1 >= k) {
            above += term;
        }
        if (term < 1e-18 * all && i - 1 <= k) {
            break;
        }
    }
    return above / all;
}

// Answers from a stream of its own, ties by their odds.
class StreamChooser final : public net::Chooser {
 public:
    explicit StreamChooser(std::uint64_t seed)
        : stream_{stream_key(seed, "sample", "choices"), 0} {}
    std::vector<std::int64_t> answers;

    std::int64_t choose(const net::Choice& choice) override {
        answers.push_back(answer(choice));
        return answers.back();
    }

 private:
    std::int64_t answer(const net::Choice& choice) {
        if (choice.options != 0) {
            double sum = 0;
            for (const double w : choice.odds) {
                sum += w;
            }
            if (choice.odds.size() == choice.options && sum > 0) {
                double at = stream_.uniform() * sum;
                for (std::uint32_t i = 0; i < choice.options; ++i) {
                    at -= choice.odds[i];
                    if (at < 0) {
                        return i;
                    }
                }
                return choice.options - 1;
            }
            return static_cast<std::int64_t>(stream_.below(choice.options));
        }
        // Of distributions what the element's stream says, which has the run's own seed.
        return choice.drawn.ticks;
    }
    RandomStream stream_;
};

}  // namespace

Interval clopper_pearson(std::uint64_t kept, std::uint64_t runs, double confidence) {
    PUP_REQUIRE(kept <= runs && runs > 0 && confidence > 0 && confidence < 1);
    const double half = (1 - confidence) / 2;
    constexpr int kSteps = 50;
    Interval out;
    if (kept > 0) {  // the least p with P(X >= kept) >= half
        double low = 0, high = 1;
        for (int i = 0; i < kSteps; ++i) {
            const double middle = (low + high) / 2;
            (upper_tail(kept, runs, middle) < half ? low : high) = middle;
        }
        out.low = low;
    }
    if (kept < runs) {  // the greatest p with P(X <= kept) >= half
        double low = 0, high = 1;
        for (int i = 0; i < kSteps; ++i) {
            const double middle = (low + high) / 2;
            (1 - upper_tail(kept + 1, runs, middle) >= half ? low : high) = middle;
        }
        out.high = high;
    }
    return out;
}

WaldTest::WaldTest(double p_good, double p_bad, double wrong)
    : on_kept_(log(p_good / p_bad)),
      on_broken_(log((1 - p_good) / (1 - p_bad))),
      limit_(log((1 - wrong) / wrong)) {
    PUP_REQUIRE(0 < p_bad && p_bad < p_good && p_good < 1 && 0 < wrong && wrong < 0.5);
}

WaldTest::Says WaldTest::add(bool kept) {
    sum_ += kept ? on_kept_ : on_broken_;
    return sum_ >= limit_ ? Says::kGood : sum_ <= -limit_ ? Says::kBad : Says::kGoOn;
}

Sampled sample(const Theatre& theatre, const Obligation& obligation, const AtomReader& reader,
               const SampleOptions& options) {
    Sampled out;
    if (!Monitor::watches(obligation.kind) || obligation.about_figures ||
        obligation.kind == net::RuleKind::kPossible || options.runs == 0) {
        return out;
    }
    const double until = now_s() + options.seconds;
    for (std::uint64_t i = 0; i < options.runs; ++i) {
        if (now_s() > until) {
            return out;
        }
        Theatre own = theatre;
        own.seed = mix64(theatre.seed + i + 1);
        StreamChooser chooser(own.seed);
        Performers performers(own, chooser);
        run::Player& player = *performers.player;
        RunWatch watch(obligation, reader, player);
        std::vector<Witness::Step> steps;
        bool broken = watch.begin() == RunWatch::Says::kBroken;
        const run::Limits limits{.until = options.horizon, .firings = options.firings};
        while (!broken) {
            performers.listener.occurred.clear();
            run::Stop stop = run::Stop::kLimit;
            if (obligation.when_settled) {
                stop = player.step({.until = player.now()});
                broken =
                    stop == run::Stop::kLimit && watch.time_passes() == RunWatch::Says::kBroken;
                if (broken) {
                    break;
                }
            }
            if (stop == run::Stop::kLimit) {
                stop = player.step(limits);
            }
            if (stop != run::Stop::kNone) {
                const bool rests = stop == run::Stop::kDead || stop == run::Stop::kFinal;
                broken = watch.ended(player.now(), rests) == RunWatch::Says::kBroken;
                break;
            }
            steps.push_back(
                {player.now(), std::string(theatre.net->transition(player.last()).path)});
            broken = watch.fired(performers.listener.occurred) == RunWatch::Says::kBroken;
        }
        if (broken) {
            Witness w;
            w.rule = obligation.rule;
            w.net_hash = theatre.net->hash();
            w.seed = own.seed;
            w.choices = std::move(chooser.answers);
            w.violates_after = static_cast<std::uint32_t>(steps.size());
            w.steps = std::move(steps);
            w.until = player.now();
            out.witness = std::move(w);
            return out;
        }
    }
    const Interval interval = clopper_pearson(options.runs, options.runs, options.confidence);
    out.sample = Verdict::Sample{.runs = options.runs,
                                 .kept = options.runs,
                                 .low = interval.low,
                                 .high = interval.high,
                                 .confidence = options.confidence};
    return out;
}

}  // namespace puppetri::verdict
