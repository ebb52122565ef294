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

TEST_CASE("dependence of neighbours is seen, and batches are made so large that it goes") {
    CHECK(lag_one(autoregressive(0.9, 0, 20'000, 1), 0) == doctest::Approx(0.9).epsilon(0.02));
    CHECK(std::abs(lag_one(autoregressive(0, 0, 20'000, 2), 0)) < 0.03);
    // Independent ones stay apart nearly always, dependent ones are joined: a lag-1 correlation of
    // 0.9 is gone in means of some 64 (19 terms of memory)
    int apart = 0;
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        apart += batches_apart(autoregressive(0, 0, 1024, seed)) == 1024;
        CHECK(batches_apart(autoregressive(0.9, 0, 1024, seed)) <= 128);
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
