// SPDX-License-Identifier: MIT
// Replications of queues against closed forms of queueing theory.
#include "puppetri/sim/replicate.h"

#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <map>

#include "puppetri/sim/net_experiment.h"
#include "sim/queue_nets.h"

namespace puppetri::sim {
namespace {

using enum MetricKind;

// The mean of the metric, where intervals of 99.99 % are asked to cover the truth.
void check_long_run(const QueueNet& q, const Metric& metric, double truth) {
    const NetExperiment experiment(
        q.net, {metric},
        {.limits = {.until = net::seconds(24'000)}, .warm_up = net::seconds(4'000)});
    const Outcome outcome =
        replicate(experiment, {.seed = 11, .replications = 40, .level = 0.9999});
    REQUIRE(outcome.failures.empty());
    CAPTURE(name_of(q.net, metric));
    CAPTURE(truth);
    CAPTURE(outcome.means[0].mean);
    CAPTURE(outcome.means[0].half_width);
    CHECK(std::abs(outcome.means[0].mean - truth) <= outcome.means[0].half_width);
    CHECK(outcome.means[0].half_width < 0.1 * truth);
}

// A. K. Erlang: B with a offered load on c servers, by its recursion; C from B.
double erlang_b(int servers, double load) {
    double b = 1;
    for (int k = 1; k <= servers; ++k) {
        b = load * b / (k + load * b);
    }
    return b;
}
double erlang_c(int servers, double load) {
    const double b = erlang_b(servers, load);
    return b / (1 - load / servers * (1 - b));
}

}  // namespace

TEST_CASE("M/M/1: queue, utilisation, waiting time, throughput") {
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    check_long_run(q, {kTokens, q.queue}, 0.5 * 0.5 / (1 - 0.5));
    check_long_run(q, {kBusy, q.busy}, 0.5);
    check_long_run(q, {kStay, q.queue}, 0.5 / (1 - 0.5));
    check_long_run(q, {kRate, q.leave}, 0.5);
}

TEST_CASE("M/D/1 and M/G/1: Pollaczek and Khinchine") {
    // mean wait = lambda E[S^2] / (2 (1 - rho))
    const QueueNet d = make_queue(2, 1, net::lasts(1.2));
    check_long_run(d, {kStay, d.queue}, 0.5 * 1.2 * 1.2 / (2 * (1 - 0.6)));
    const QueueNet u =
        make_queue(2, 1,
                   net::drawn(DistributionKind::kUniform,
                              {Expr::time(net::seconds(0.5)), Expr::time(net::seconds(1.5))}));
    check_long_run(u, {kStay, u.queue}, 0.5 * (1.0 / 12 + 1) / (2 * (1 - 0.5)));
}

TEST_CASE("M/M/c: Erlang's C") {
    const QueueNet q = make_queue(0.5, 3, net::exponential(1));
    check_long_run(q, {kStay, q.queue}, erlang_c(3, 2) / (3 - 2));
    check_long_run(q, {kTokens, q.busy}, 2);
}

TEST_CASE("M/M/1/K and M/M/c/c: what is lost") {
    // P(n) = (1 - rho) rho^n / (1 - rho^(K + 1))
    const QueueNet k = make_queue(1.25, 1, net::exponential(1), 4);
    const double rho = 0.8, none = (1 - rho) / (1 - std::pow(rho, 5));
    check_long_run(k, {kBusy, k.busy}, 1 - none);
    check_long_run(k, {kRate, k.arrive}, 0.8 * (1 - none * std::pow(rho, 4)));
    const QueueNet c = make_queue(0.5, 3, net::exponential(1), 3);
    check_long_run(c, {kRate, c.arrive}, 2 * (1 - erlang_b(3, 2)));
}

TEST_CASE("the numbers are the same on one thread and on several") {
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const NetExperiment experiment(q.net, all_metrics(q.net),
                                   {.limits = {.until = net::seconds(500)}});
    Plan plan{.seed = 3, .replications = 50};
    const Outcome one = replicate(experiment, plan);
    plan.threads = 3;
    const Outcome three = replicate(experiment, plan);
    CHECK(one.values == three.values);
    CHECK(one.numbers == three.numbers);
    CHECK(one.numbers.size() == 50);
}

namespace {
// Runs that take no time: a number in three columns, of which some are missing and some runs fail.
class Numbers final : public Experiment {
 public:
    class Run final : public Runner {
     public:
        bool run(const Replication& r, std::span<double> values, Diagnostic& fault) override {
            RandomStream stream{.key = r.seed};
            values[0] = stream.uniform();
            values[1] = r.number % 7 == 3 ? std::nan("") : stream.uniform() + 1000;
            values[2] = static_cast<double>(r.number);
            fault.code = "every-hundredth";
            return r.number % 100 != 50;
        }
    };
    std::size_t width() const override { return 3; }
    std::unique_ptr<Runner> runner() const override { return std::make_unique<Run>(); }
};
}  // namespace

TEST_CASE("of many short runs too, each number, mean and interval is the same on any threads") {
    for (const bool pairs : {false, true}) {
        Plan plan{.seed = 3, .replications = 20'001, .antithetic = pairs};
        const Outcome one = replicate(Numbers(), plan);
        for (plan.threads = 2; plan.threads < 9; plan.threads += 3) {
            const Outcome several = replicate(Numbers(), plan);
            CHECK(several.numbers == one.numbers);
            REQUIRE(several.values.size() == one.values.size());
            CHECK(std::memcmp(several.values.data(), one.values.data(),
                              one.values.size() * sizeof(double)) == 0);
            REQUIRE(several.failures.size() == one.failures.size());
            for (std::size_t i = 0; i < one.failures.size(); ++i) {
                CHECK(several.failures[i].replication.number == 100 * i + 50);
            }
            for (std::size_t c = 0; c < 3; ++c) {
                CHECK(several.means[c].mean == one.means[c].mean);
                CHECK(several.means[c].half_width == one.means[c].half_width);
                CHECK(several.means[c].count == one.means[c].count);
            }
        }
        // Two sums over all rows, in long doubles, say the same
        for (std::size_t c = 0; c < 3; ++c) {
            std::vector<long double> seen;
            std::map<std::uint64_t, double> by_number;
            for (std::size_t i = 0; i < one.numbers.size(); ++i) {
                by_number[one.numbers[i]] = one.row(i)[c];
            }
            for (const auto& [number, x] : by_number) {
                const auto partner = by_number.find(number + 1);
                if (!pairs) {
                    seen.push_back(x);
                } else if (number % 2 == 0 && partner != by_number.end()) {
                    seen.push_back((static_cast<long double>(x) + partner->second) / 2);
                }
            }
            std::erase_if(seen, [](long double x) { return std::isnan(x); });
            std::uint64_t singles = 0;
            double most = -INFINITY;
            for (const auto& [number, x] : by_number) {
                singles += !std::isnan(x);
                most = std::isnan(x) ? most : std::max(most, x);
            }
            CHECK(one.tallies[c].count() == singles);
            CHECK(one.tallies[c].high() == most);
            long double sum = 0, squares = 0;
            for (const long double x : seen) {
                sum += x;
            }
            const auto n = static_cast<long double>(seen.size());
            for (const long double x : seen) {
                squares += (x - sum / n) * (x - sum / n);
            }
            const auto half_width = static_cast<double>(std::sqrt(squares / (n - 1) / n)) *
                                    student_t(0.95, static_cast<double>(n - 1));
            CHECK(one.means[c].count == seen.size());
            CHECK(one.means[c].mean ==
                  doctest::Approx(static_cast<double>(sum / n)).epsilon(1e-12));
            CHECK(one.means[c].half_width == doctest::Approx(half_width).epsilon(1e-9));
        }
    }
}

TEST_CASE("a wanted precision decides how many replications there are") {
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const NetExperiment experiment(q.net, {{kBusy, q.busy}, {kStay, q.queue}},
                                   {.limits = {.until = net::seconds(400)}});
    Plan plan{.seed = 3, .replications = 20, .precision = {.share_of_mean = 0.02}, .precise = {0}};
    const Outcome outcome = replicate(experiment, plan);
    CHECK(outcome.numbers.size() > 20);
    CHECK(outcome.precise_enough);
    CHECK(outcome.means[0].half_width <= 0.021 * outcome.means[0].mean);
    plan.at_most = 30;
    const Outcome few = replicate(experiment, plan);
    CHECK(few.numbers.size() == 30);
    CHECK_FALSE(few.precise_enough);
}

TEST_CASE("antithetic pairs share a seed, and make the mean of a monotone quantity more precise") {
    CHECK(replication(5, 6, true).seed == replication(5, 7, true).seed);
    CHECK(replication(5, 7, true).seed != replication(5, 8, true).seed);
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const NetExperiment experiment(q.net, {{kBusy, q.busy}},
                                   {.limits = {.until = net::seconds(300)}});
    const Outcome plain = replicate(experiment, {.seed = 9, .replications = 400});
    const Outcome pairs =
        replicate(experiment, {.seed = 9, .replications = 400, .antithetic = true});
    CHECK(pairs.means[0].count == 200);
    CHECK(pairs.means[0].half_width < 0.8 * plain.means[0].half_width);
    CHECK(std::abs(pairs.means[0].mean - plain.means[0].mean) <=
          pairs.means[0].half_width + plain.means[0].half_width);
}

TEST_CASE("common random numbers: two systems differ less than two runs of one") {
    const QueueNet slow = make_queue(2, 1, net::exponential(1.0)),
                   fast = make_queue(2, 1, net::exponential(0.95));
    const NetExperiment::Options options{.limits = {.until = net::seconds(300)}};
    const NetExperiment a(slow.net, {{kStay, slow.queue}}, options),
        b(fast.net, {{kStay, fast.queue}}, options);
    const Outcome of_a = replicate(a, {.seed = 9, .replications = 200}),
                  of_b = replicate(b, {.seed = 9, .replications = 200}),
                  other_b = replicate(b, {.seed = 10, .replications = 200});
    Tally common, independent;
    for (std::size_t i = 0; i < 200; ++i) {
        common.add(of_a.values[i] - of_b.values[i]);
        independent.add(of_a.values[i] - other_b.values[i]);
    }
    CHECK(common.deviation() < 0.3 * independent.deviation());
}

TEST_CASE("a replication that fails is told with its seed, and the others go on") {
    // A datum leaves its range as soon as there have been more than 20 arrivals
    net::Maker make;
    net::TransitionDraft& arrive = make.t("arrive", {}, {});
    arrive.delay = net::DelayDraft{.duration = net::exponential(1)};
    const net::DatumIndex count = make.integer("count", 0, 0, 20);
    arrive.assignments.push_back(
        {.datum = count, .value = net::expr(ExprOp::kAdd, make.read(count), Expr::integer(1))});
    const net::Net net = net::compile(make.draft).value();
    const NetExperiment experiment(net, {{kFirings, 0}}, {.limits = {.until = net::seconds(20)}});
    const Outcome outcome = replicate(experiment, {.seed = 1, .replications = 100, .threads = 2});
    CHECK(outcome.failures.size() > 20);
    CHECK(outcome.numbers.size() > 20);
    CHECK(outcome.failures.size() + outcome.numbers.size() == 100);
    for (const double firings : outcome.values) {
        CHECK(firings <= 20);
    }
    for (const Failure& f : outcome.failures) {
        run::Player player(net, {.seed = f.replication.seed});
        CHECK(player.run({.until = net::seconds(20)}) == run::Stop::kFault);
        CHECK(f.why.code == player.fault().code);
    }
}

namespace {
class Memory final : public Journal {
 public:
    Known recall(std::uint64_t number, std::span<double> values, Diagnostic& fault) override {
        if (failed.count(number) != 0) {
            fault.code = failed[number];
            return Known::kFailed;
        }
        const auto it = rows.find(number);
        if (it == rows.end()) {
            return Known::kNo;
        }
        std::copy(it->second.begin(), it->second.end(), values.begin());
        return Known::kFinished;
    }
    void keep(std::uint64_t number, std::span<const double> values) override {
        rows[number].assign(values.begin(), values.end());
        ++played;
    }
    void keep_failure(std::uint64_t number, const Diagnostic& fault) override {
        failed[number] = fault.code;
        ++played;
    }
    std::map<std::uint64_t, std::vector<double>> rows;
    std::map<std::uint64_t, std::string> failed;
    int played = 0;
};
}  // namespace

TEST_CASE("an interrupted experiment goes on from its journal to the same numbers") {
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const NetExperiment experiment(q.net, {{kBusy, q.busy}},
                                   {.limits = {.until = net::seconds(100)}});
    Plan plan{.seed = 4, .replications = 30};
    const Outcome whole = replicate(experiment, plan);
    Memory memory;
    plan.journal = &memory;
    plan.go_on = [](void*, std::uint64_t done, std::uint64_t) { return done < 12; };
    const Outcome broken = replicate(experiment, plan);
    CHECK(broken.interrupted);
    CHECK(broken.numbers.size() >= 12);
    CHECK(broken.numbers.size() < 30);
    CHECK(memory.rows.size() == broken.numbers.size());
    plan.go_on = nullptr;
    const Outcome resumed = replicate(experiment, plan);
    CHECK(memory.played == 30);
    CHECK(resumed.values == whole.values);
    CHECK(resumed.means[0].half_width == whole.means[0].half_width);
}

TEST_CASE("several processes that share a journal get the numbers of one") {
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const NetExperiment experiment(q.net, {{kBusy, q.busy}},
                                   {.limits = {.until = net::seconds(100)}});
    Plan plan{.seed = 4, .replications = 31};
    const Outcome whole = replicate(experiment, plan);
    Memory memory;
    plan.journal = &memory;
    plan.ranks = 3;
    Outcome last;
    for (plan.rank = 0; plan.rank < 3; ++plan.rank) {
        last = replicate(experiment, plan);
        CHECK(last.missing == (plan.rank < 2));
    }
    CHECK(memory.played == 31);
    CHECK(last.values == whole.values);
}

}  // namespace puppetri::sim
