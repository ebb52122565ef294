// SPDX-License-Identifier: MIT
#include "puppetri/verdict/sample.h"

#include <doctest/doctest.h>

#include <cmath>

#include "puppetri/base/random.h"

namespace puppetri::verdict {
namespace {

TEST_CASE(
    "the interval of Clopper and Pearson has its closed forms and its published values [oracle]") {
    // All kept: low is (alpha / 2)^(1 / n).
    const Interval all = clopper_pearson(100, 100, 0.95);
    CHECK(all.low == doctest::Approx(std::pow(0.025, 0.01)).epsilon(1e-9));
    CHECK(all.high == 1);
    const Interval none = clopper_pearson(0, 10, 0.95);
    CHECK(none.low == 0);
    CHECK(none.high == doctest::Approx(1 - std::pow(0.025, 0.1)).epsilon(1e-9));
    // The table of the exact 95 % interval for 4 of 20 (0.0573, 0.4366).
    const Interval few = clopper_pearson(4, 20, 0.95);
    CHECK(few.low == doctest::Approx(0.0573).epsilon(2e-3));
    CHECK(few.high == doctest::Approx(0.4366).epsilon(2e-3));
}

TEST_CASE("the interval covers the truth at least as often as it says [law]") {
    RandomStream stream{42, 0};
    for (const double p : {0.03, 0.5, 0.97}) {
        int covered = 0;
        constexpr int kTrials = 2000;
        for (int i = 0; i < kTrials; ++i) {
            std::uint64_t kept = 0;
            for (int k = 0; k < 40; ++k) {
                kept += stream.uniform() < p ? 1 : 0;
            }
            const Interval interval = clopper_pearson(kept, 40, 0.9);
            covered += interval.low <= p && p <= interval.high ? 1 : 0;
        }
        CHECK(covered >= 0.885 * kTrials);
    }
}

TEST_CASE("Wald's test errs as seldom as it says, although it looks after every run [law]") {
    RandomStream stream{7, 0};
    for (const bool good : {true, false}) {
        int wrong = 0;
        constexpr int kTrials = 2000;
        for (int i = 0; i < kTrials; ++i) {
            WaldTest test(0.9, 0.7, 0.05);
            WaldTest::Says says = WaldTest::Says::kGoOn;
            while (says == WaldTest::Says::kGoOn) {
                says = test.add(stream.uniform() < (good ? 0.9 : 0.7));
            }
            wrong += (says == WaldTest::Says::kGood) != good ? 1 : 0;
        }
        CHECK(wrong <= 0.065 * kTrials);
    }
}

}  // namespace
}  // namespace puppetri::verdict
