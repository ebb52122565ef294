// SPDX-License-Identifier: MIT
#include "puppetri/sim/confidence.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "puppetri/base/distribution.h"
#include "puppetri/base/random.h"

namespace puppetri::sim {
namespace {

// In how many of `repetitions` the interval, stopping rule and all, covers the mean of the
// distribution.
double coverage(DistributionKind kind, const std::vector<double>& parameters,
                const Precision& precision, std::uint64_t first, int repetitions) {
    const double truth = moments(kind, parameters).mean;
    int covered = 0;
    for (int r = 0; r < repetitions; ++r) {
        RandomStream random{stream_key(static_cast<std::uint64_t>(r), "coverage", "test")};
        Tally all;
        for (std::uint64_t n = first; all.count() < n;) {
            while (all.count() < n) {
                all.add(sample(kind, parameters, random));
            }
            n = replications_needed(all, first, precision, 0.95);
        }
        const Confidence c = staged_confidence(all, first, 0.95);
        CHECK(c.half_width <= precision.share_of_mean * std::abs(c.mean) * (1 + 1e-12));
        covered += std::abs(c.mean - truth) <= c.half_width;
    }
    return covered / static_cast<double>(repetitions);
}

}  // namespace

// W. S. Gosset's table as every textbook prints it.
TEST_CASE("Student's t is that of the tables") {
    CHECK(student_t(0.95, 1) == doctest::Approx(12.706).epsilon(1e-4));
    CHECK(student_t(0.95, 4) == doctest::Approx(2.776).epsilon(1e-3));
    CHECK(student_t(0.99, 10) == doctest::Approx(3.169).epsilon(1e-3));
    CHECK(student_t(0.90, 30) == doctest::Approx(1.697).epsilon(1e-3));
    CHECK(student_t(0.95, 1e9) == doctest::Approx(1.959964).epsilon(1e-6));
}

TEST_CASE("an interval from five observations is the textbook's") {
    Tally t;
    for (const double x : {1.0, 2.0, 3.0, 4.0, 5.0}) {
        t.add(x);
    }
    const Confidence c = confidence(t, 0.95);
    CHECK(c.mean == doctest::Approx(3));
    CHECK(c.half_width == doctest::Approx(2.776445 * std::sqrt(2.5 / 5)).epsilon(1e-6));
}

TEST_CASE("fewer than two observations say nothing") {
    Tally t;
    CHECK(std::isinf(confidence(t, 0.95).half_width));
    t.add(1);
    CHECK(std::isinf(confidence(t, 0.95).half_width));
}

TEST_CASE("pairs of opposite luck are one observation each") {
    const double values[] = {1, 3, 0, 4, -2, 6};
    const Confidence c = confidence_of_pairs(values, 0.95);
    CHECK(c.mean == doctest::Approx(2));
    CHECK(c.half_width == doctest::Approx(0));
    CHECK(c.count == 3);
}

TEST_CASE("batch means see through correlation that single values hide") {
    // x' = 0.9 x + noise: the variance of the mean is 19 times that of independent values
    int covered = 0, naive = 0;
    constexpr int kRuns = 400;
    for (int r = 0; r < kRuns; ++r) {
        RandomStream random{stream_key(static_cast<std::uint64_t>(r), "walk", "test")};
        const double normal[] = {0, 1, -INFINITY, INFINITY};
        std::vector<double> values;
        double x = sample(DistributionKind::kNormal, normal, random) / std::sqrt(0.19);
        Tally single;
        for (int i = 0; i < 4000; ++i) {
            x = 0.9 * x + sample(DistributionKind::kNormal, normal, random);
            values.push_back(x);
            single.add(x);
        }
        const Confidence c = batch_means(values, 20, 0.95);
        covered += std::abs(c.mean) <= c.half_width;
        const Confidence n = confidence(single, 0.95);
        naive += std::abs(n.mean) <= n.half_width;
    }
    // 95 % of 400, within four standard deviations
    CHECK(covered > kRuns * 0.95 - 18);
    CHECK(covered < kRuns * 0.95 + 18);
    CHECK(naive < kRuns * 0.6);
}

TEST_CASE("intervals with the stopping rule on cover the truth as often as they say") {
    constexpr int kRepetitions = 2000;
    const std::pair<DistributionKind, std::vector<double>> cases[] = {
        {DistributionKind::kNormal, {10, 3, -INFINITY, INFINITY}},
        {DistributionKind::kUniform, {0, 4}},
        {DistributionKind::kErlang, {4, 2}},
        {DistributionKind::kExponential, {2}}};
    for (const auto& [kind, parameters] : cases) {
        for (const std::uint64_t first : {30, 60}) {
            for (const double precision : {0.1, 0.05}) {
                CAPTURE(std::string(name_of(kind)));
                CAPTURE(first);
                CAPTURE(precision);
                const double share =
                    coverage(kind, parameters, {.share_of_mean = precision}, first, kRepetitions);
                CHECK(share >= 0.935);
                CHECK(share <= 0.965);
            }
        }
    }
}

TEST_CASE("a mean of zero needs more replications than there are, and no division fails") {
    Tally t;
    for (const double x : {-1.0, 1.0, -1.0, 1.0}) {
        t.add(x);
    }
    CHECK(replications_needed(t, 4, {.share_of_mean = 0.01}, 0.95) >= 1'000'000'000'000u);
    Tally constant;
    constant.add(0);
    constant.add(0);
    CHECK(replications_needed(constant, 2, {.share_of_mean = 0.01}, 0.95) == 2);
}

}  // namespace puppetri::sim
