// SPDX-License-Identifier: MIT
// Markov chains against closed forms.
#include "puppetri/proof/markov_chain.h"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

#include "puppetri/base/random.h"

namespace puppetri::proof {
namespace {

struct Rate {
    std::uint32_t from, to;
    double rate;
};

MarkovChain chain_of(std::uint32_t size, std::vector<Rate> rates, std::uint32_t start = 0) {
    MarkovChain c;
    c.initial.assign(size, 0);
    c.initial[start] = 1;
    for (std::uint32_t s = 0; s < size; ++s) {
        for (const Rate& r : rates) {
            if (r.from == s) {
                c.jumps.items.push_back({r.to, r.rate});
            }
        }
        c.jumps.starts.push_back(static_cast<std::uint32_t>(c.jumps.items.size()));
    }
    return c;
}

// M/M/1/K: births at `up`, deaths at `down`.
MarkovChain queue(std::uint32_t size, double up, double down) {
    std::vector<Rate> rates;
    for (std::uint32_t n = 0; n + 1 < size; ++n) {
        rates.push_back({n, n + 1, up});
        rates.push_back({n + 1, n, down});
    }
    return chain_of(size, std::move(rates));
}

StateBits only(std::uint32_t size, std::uint32_t state) {
    StateBits bits(size);
    bits.add(state);
    return bits;
}

}  // namespace

TEST_CASE("a queue in the long run is geometric, by elimination and by sweeps") {
    for (const std::uint32_t size : {2u, 30u, 500u, 700u}) {
        CAPTURE(size);
        const double rho = 0.9;
        const ChainSolution s = long_run(queue(size, rho * 3, 3));
        const double none = (1 - rho) / (1 - std::pow(rho, size));
        CHECK(s.residual < 1e-12);
        for (std::uint32_t n = 0; n < size; ++n) {
            const double truth = none * std::pow(rho, n);
            const double off = std::abs(s.values[n] - truth);
            CHECK(off < (size > 500 ? 1e-11 : 1e-10 * truth));
        }
    }
}

TEST_CASE("rates many orders of magnitude apart keep every digit") {
    const ChainSolution s = long_run(queue(4, 1e-9, 1));
    for (std::uint32_t n = 1; n < 4; ++n) {
        CHECK(s.values[n] / s.values[n - 1] == doctest::Approx(1e-9).epsilon(1e-12));
    }
}

TEST_CASE("a periodic chain has a long run all the same") {
    std::vector<Rate> rates;
    for (std::uint32_t s = 0; s < 6; ++s) {
        rates.push_back({s, (s + 1) % 6, 1.0 + s});
    }
    const ChainSolution s = long_run(chain_of(6, rates));
    double sum = 0;
    for (int i = 0; i < 6; ++i) {
        sum += 1.0 / (1 + i);
    }
    for (std::uint32_t i = 0; i < 6; ++i) {
        CHECK(s.values[i] == doctest::Approx(1.0 / (1 + i) / sum));
    }
}

TEST_CASE("a gambler's ruin: where the chain ends, and when") {
    // p up, q down, absorbed in 0 and N: closed form of Feller
    constexpr std::uint32_t kN = 20, kStart = 7;
    const double p = 0.45, q = 0.55;
    std::vector<Rate> rates;
    for (std::uint32_t n = 1; n < kN; ++n) {
        rates.push_back({n, n + 1, p});
        rates.push_back({n, n - 1, q});
    }
    const MarkovChain chain = chain_of(kN + 1, rates, kStart);
    const double rich =
        (1 - std::pow(q / p, kStart)) / (1 - std::pow(q / p, static_cast<double>(kN)));
    const ChainSolution s = long_run(chain);
    CHECK(s.values[kN] == doctest::Approx(rich));
    CHECK(s.values[0] == doctest::Approx(1 - rich));
    CHECK(s.values[5] == 0);
    StateBits ends(kN + 1);
    ends.add(0);
    ends.add(kN);
    CHECK(mean_time_to(chain, ends).values[0] ==
          doctest::Approx(kStart / (q - p) - kN / (q - p) * rich));
    CHECK(std::isinf(mean_time_to(chain, only(kN + 1, kN)).values[0]));
}

TEST_CASE("two states at an instant") {
    const double up = 0.7, down = 0.2;
    const MarkovChain chain = queue(2, up, down);
    for (const double t : {0.0, 1e-6, 0.5, 3.0, 200.0}) {
        const double there = up / (up + down) * (1 - std::exp(-(up + down) * t));
        CHECK(at_time(chain, t).values[1] == doctest::Approx(there).epsilon(1e-10).scale(1e-12));
        CHECK(at_time(chain, t).residual < 1e-12);
    }
}

TEST_CASE("a row of equal steps is reached as Erlang's distribution says") {
    constexpr std::uint32_t kSteps = 5;
    const double rate = 3;
    std::vector<Rate> rates;
    for (std::uint32_t s = 0; s < kSteps; ++s) {
        rates.push_back({s, s + 1, rate});
    }
    rates.push_back({kSteps, 0, rate});  // goes on afterwards: being there once is enough
    const MarkovChain chain = chain_of(kSteps + 1, rates);
    for (const double t : {0.1, 1.0, 2.5, 10.0}) {
        double late = 0, term = std::exp(-rate * t);
        for (std::uint32_t k = 0; k < kSteps; ++k) {
            late += term;
            term *= rate * t / (k + 1);
        }
        CHECK(reached_by(chain, only(kSteps + 1, kSteps), t).values[0] ==
              doctest::Approx(1 - late).epsilon(1e-10).scale(1e-12));
    }
    CHECK(mean_time_to(chain, only(kSteps + 1, kSteps)).values[0] ==
          doctest::Approx(kSteps / rate));
    CHECK(reached_by(chain, only(kSteps + 1, 0), 0).values[0] == 1);
}

TEST_CASE("long horizons are as exact as short ones") {
    // Fast and slow together: 1e6 steps
    const MarkovChain chain = queue(2, 100, 1);
    const ChainSolution s = at_time(chain, 1e4);
    CHECK(s.values[1] == doctest::Approx(100.0 / 101).epsilon(1e-12));
    std::vector<Rate> rates{{0, 1, 1000}, {1, 0, 1000}, {0, 2, 0.001}};
    const double t = 500;
    CHECK(reached_by(chain_of(3, rates), only(3, 2), t).values[0] ==
          doctest::Approx(1 - std::exp(-0.0005 * t)).epsilon(1e-5));
}

TEST_CASE("random chains: elimination and time agree in the long run") {
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        RandomStream random{stream_key(seed, "chain", "test")};
        const auto size = static_cast<std::uint32_t>(2 + random.below(12));
        std::vector<Rate> rates;
        for (std::uint32_t s = 0; s < size; ++s) {
            for (std::uint64_t k = random.below(4); k > 0; --k) {
                rates.push_back(
                    {s, static_cast<std::uint32_t>(random.below(size)), 0.05 + random.uniform()});
            }
        }
        const MarkovChain chain = chain_of(size, rates);
        const ChainSolution rest = long_run(chain), late = at_time(chain, 20'000);
        CHECK(rest.residual < 1e-12);
        for (std::uint32_t s = 0; s < size; ++s) {
            CHECK(rest.values[s] == doctest::Approx(late.values[s]).epsilon(1e-7).scale(1e-9));
        }
        const StateBits goal = only(size, size - 1);
        const double sooner = reached_by(chain, goal, 1).values[0],
                     later = reached_by(chain, goal, 2).values[0];
        CHECK(sooner <= later + 1e-12);
    }
}

}  // namespace puppetri::proof
