// SPDX-License-Identifier: MIT
#include "puppetri/sim/tally.h"

#include <doctest/doctest.h>

#include <vector>

#include "puppetri/base/random.h"

namespace puppetri::sim {

TEST_CASE("a tally has the mean, variance and extremes of its observations") {
    Tally t;
    for (const double x : {2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0}) {
        t.add(x);
    }
    CHECK(t.count() == 8);
    CHECK(t.mean() == doctest::Approx(5));
    CHECK(t.variance() == doctest::Approx(32.0 / 7));
    CHECK(t.low() == 2);
    CHECK(t.high() == 9);
}

TEST_CASE("observations far from zero keep their variance") {
    Tally t;
    for (const double x : {1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16}) {
        t.add(x);
    }
    CHECK(t.variance() == doctest::Approx(30).epsilon(1e-12));
}

TEST_CASE("merging is as good as adding one by one") {
    RandomStream random{7};
    Tally whole, left, right, nothing;
    for (int i = 0; i < 1000; ++i) {
        const double x = random.uniform() * 3 - 1;
        whole.add(x);
        (i % 3 == 0 ? left : right).add(x);
    }
    left.merge(nothing);
    left.merge(right);
    nothing.merge(left);
    for (const Tally& t : {left, nothing}) {
        CHECK(t.count() == whole.count());
        CHECK(t.mean() == doctest::Approx(whole.mean()).epsilon(1e-12));
        CHECK(t.variance() == doctest::Approx(whole.variance()).epsilon(1e-12));
        CHECK(t.low() == whole.low());
        CHECK(t.high() == whole.high());
    }
}

}  // namespace puppetri::sim
