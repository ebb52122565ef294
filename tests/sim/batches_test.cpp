// SPDX-License-Identifier: MIT
// Batches of one run, and when it has settled.
#include "puppetri/sim/batches.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <map>

#include "net/maker.h"
#include "puppetri/base/random.h"
#include "puppetri/sim/meter.h"
#include "sim/queue_nets.h"

namespace puppetri::sim {
namespace {

// x' = a x + noise, begun at `start`: its lag-1 correlation is a.
Series autoregressive(double a, double start, std::size_t count, std::uint64_t seed) {
    RandomStream stream{.key = seed};
    Series s{1, count, {}};
    double x = start;
    for (std::size_t i = 0; i < count; ++i) {
        s.values.push_back(x);
        x = a * x + std::sqrt(1 - a * a) * (stream.uniform() - 0.5) * std::sqrt(12.0);
    }
    return s;
}

Outcome batches(const QueueNet& q, std::uint64_t seed, std::uint64_t count, double length_s,
                Journal* journal = nullptr) {
    const NetExperiment::Options options{.warm_up = net::seconds(500)};
    const BatchExperiment experiment(q.net, {{MetricKind::kTokens, q.queue}}, options,
                                     net::seconds(length_s), seed);
    return replicate(experiment,
                     {.seed = seed, .replications = count, .journal = journal, .owner = 0});
}

class Kept final : public Journal {
 public:
    std::map<std::uint64_t, double> rows;
    Known recall(std::uint64_t number, std::span<double> values, Diagnostic&) override {
        const auto found = rows.find(number);
        if (found == rows.end()) {
            return Known::kNo;
        }
        values[0] = found->second;
        return Known::kFinished;
    }
    void keep(std::uint64_t number, std::span<const double> values) override {
        rows[number] = values[0];
    }
    void keep_failure(std::uint64_t, const Diagnostic&) override {}
};

}  // namespace

TEST_CASE("batches are stretches of one run: their mean is that of the whole") {
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const Outcome cut = batches(q, 3, 10, 1000);
    REQUIRE(cut.values.size() == 10);
    // The same run, in one piece
    Meter meter(q.net, std::vector<Metric>{{MetricKind::kTokens, q.queue}},
                {.from = net::seconds(500)});
    run::Player player(q.net, {.seed = replication(3, 0, false).seed, .observer = &meter});
    player.run({.until = net::seconds(10'500)});
    double whole = 0;
    meter.finish(net::seconds(10'500), {&whole, 1});
    CHECK(cut.means[0].mean == doctest::Approx(whole));
}

TEST_CASE("a journal in the middle of a run goes on to the same batches") {
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const Outcome whole = batches(q, 4, 12, 200);
    Kept kept;
    batches(q, 4, 5, 200, &kept);
    CHECK(kept.rows.size() == 5);
    kept.rows.erase(2);  // and one is missing
    CHECK(batches(q, 4, 12, 200, &kept).values == whole.values);
}

TEST_CASE("intervals from batches cover the truth as often as they say") {
    const char* longer = std::getenv("PUPPETRI_LONG");
    const int times = longer != nullptr ? 2000 : 200;
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    int covered = 0;
    for (int i = 0; i < times; ++i) {
        const Outcome o = batches(q, 1000 + static_cast<std::uint64_t>(i), 20, 1000);
        covered += std::abs(o.means[0].mean - 0.5) < o.means[0].half_width;  // rho^2 / (1 - rho)
    }
    const double share = static_cast<double>(covered) / times;
    // 95 % nominal; the binomial spread of `times` trials at four standard deviations
    CHECK(std::abs(share - 0.95) < 4 * std::sqrt(0.95 * 0.05 / times) + 0.01);
}

TEST_CASE(
    "intervals from as many batches as are found, and from more until they are narrow, cover") {
    // The whole way of `--batches auto --until-half-width`: a pilot says how long batches are, then
    // a run of its own is played batch by batch in stages. x' = 0.9 x + noise, and M/M/1 at half
    // its load; each run 1024 stretches long.
    const bool longer = std::getenv("PUPPETRI_LONG") != nullptr;
    const auto check = [&](int times, double truth, double wanted, const auto& play) {
        int covered = 0, trusted = 0;
        for (int i = 0; i < times; ++i) {
            const auto seed = 2 * static_cast<std::uint64_t>(i) + 1;
            const std::uint32_t count = batches_apart(play(seed, 1024, 1));
            if (count == 0) {
                continue;  // too short, and it says so
            }
            ++trusted;
            const std::uint64_t together = 1024 / count;
            Tally tally;
            std::uint64_t needed = count;
            while (tally.count() < needed) {
                const Series run = play(seed + 1, needed, together);
                tally = {};
                for (const double x : run.values) {
                    tally.add(x);
                }
                needed = replications_needed(tally, count, {.half_width = wanted}, 0.95);
            }
            const Confidence c = staged_confidence(tally, count, 0.95);
            covered += std::abs(c.mean - truth) <= c.half_width;
        }
        const double share = static_cast<double>(covered) / trusted;
        CAPTURE(share);
        CAPTURE(trusted);
        if (longer) {
            MESSAGE("of ", trusted, " intervals cover ", share);
        }
        CHECK(trusted > 0.8 * times);
        const double spread = longer ? 0 : 3 * std::sqrt(0.95 * 0.05 / trusted);
        CHECK(share >= 0.935 - spread);
        CHECK(share <= 0.965 + spread);
    };
    // Stretches of 16: the means of 16 384 terms differ by sqrt(19 / 16384)
    const auto series = [](std::uint64_t seed, std::uint64_t count, std::uint64_t together) {
        const Series fine = autoregressive(0.9, 0, count * together * 16, seed);
        Series out{1, count, {}};
        for (std::uint64_t i = 0; i < count; ++i) {
            double sum = 0;
            for (std::uint64_t k = 0; k < together * 16; ++k) {
                sum += fine.values[i * together * 16 + k];
            }
            out.values.push_back(sum / static_cast<double>(together * 16));
        }
        return out;
    };
    const double half_width = 1.96 * std::sqrt(19.0 / 16384);
    check(longer ? 2000 : 100, 0, 100 * half_width, series);
    check(longer ? 2000 : 100, 0, 0.7 * half_width, series);
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const std::vector<Metric> metrics = {{MetricKind::kTokens, q.queue}};
    const auto queue = [&](std::uint64_t seed, std::uint64_t count, std::uint64_t together) {
        Series out;
        Diagnostic fault;
        const double end = 500 + 40.0 * static_cast<double>(count * together);
        REQUIRE(play_series(q.net, metrics, {}, seed, net::seconds(500), net::seconds(end), count,
                            out, fault));
        return out;
    };
    check(longer ? 2000 : 40, 0.5, 100, queue);  // rho^2 / (1 - rho)
    if (longer) {
        check(2000, 0.5, 0.015, queue);
    }
}

TEST_CASE("intervals after a warm-up that was found cover the truth of the long run") {
    // M/M/1 begins empty; ten pilots say when it has settled, thirty runs of their own are measured
    const bool longer = std::getenv("PUPPETRI_LONG") != nullptr;
    const int times = longer ? 2000 : 60;
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const std::vector<Metric> metrics = {{MetricKind::kTokens, q.queue}};
    constexpr int kEnd = 2000;
    int covered = 0, settled = 0;
    for (int i = 0; i < times; ++i) {
        const auto seed = 100 * static_cast<std::uint64_t>(i);
        std::vector<Series> pilots(10);
        Diagnostic fault;
        for (std::uint64_t k = 0; k < pilots.size(); ++k) {
            REQUIRE(play_series(q.net, metrics, {}, seed + k, {}, net::seconds(kEnd), 400,
                                pilots[k], fault));
        }
        const auto after = settled_after(mean_of(pilots));
        if (!after) {
            continue;
        }
        ++settled;
        const SimTime warm_up = net::seconds(kEnd / 400.0 * static_cast<double>(*after));
        Tally tally;
        for (std::uint64_t k = 10; k < 40; ++k) {
            Series run;
            REQUIRE(play_series(q.net, metrics, {}, seed + k, warm_up, net::seconds(kEnd), 1, run,
                                fault));
            tally.add(run.values[0]);
        }
        const Confidence c = confidence(tally, 0.95);
        covered += std::abs(c.mean - 0.5) <= c.half_width;
    }
    const double share = static_cast<double>(covered) / settled;
    CAPTURE(share);
    CAPTURE(settled);
    if (longer) {
        MESSAGE("of ", settled, " intervals cover ", share);
    }
    CHECK(settled > 0.7 * times);
    const double spread = longer ? 0 : 3 * std::sqrt(0.95 * 0.05 / settled);
    CHECK(share >= 0.935 - spread);
    CHECK(share <= 0.965 + spread);
}

TEST_CASE("dependence of neighbours is seen, and batches are made so large that it goes") {
    CHECK(lag_one(autoregressive(0.9, 0, 20'000, 1), 0) == doctest::Approx(0.9).epsilon(0.02));
    CHECK(std::abs(lag_one(autoregressive(0, 0, 20'000, 2), 0)) < 0.03);
    // Independent ones are joined by eight nearly always, dependent ones further: a lag-1
    // correlation of 0.9 is gone in means of some 64 (19 terms of memory), and those by eight
    int apart = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        apart += batches_apart(autoregressive(0, 0, 1024, seed)) == 128;
        CHECK(batches_apart(autoregressive(0.9, 0, 1024, seed)) <= 16);
    }
    CHECK(apart > 175);  // 190 expected
    // A walk that never comes back
    Series line{1, 64, {}};
    for (int i = 0; i < 64; ++i) {
        line.values.push_back(i);
    }
    CHECK(batches_apart(line) == 0);
}

TEST_CASE("the beginning of a series that has to settle is found") {
    int early = 0, late = 0;
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        early += settled_after(autoregressive(0, 0, 400, seed)).value_or(400) < 40;
        // Begun 20 deviations off: after 0.9^n < 1/20, n = 28, it is nearly there
        const auto after = settled_after(autoregressive(0.9, 20, 400, seed));
        late += after && *after >= 10 && *after < 100;
    }
    CHECK(early >= 45);
    CHECK(late >= 45);
    Series growing{1, 100, {}};
    for (int i = 0; i < 100; ++i) {
        growing.values.push_back(i * i);
    }
    CHECK(!settled_after(growing).has_value());
}

}  // namespace puppetri::sim
