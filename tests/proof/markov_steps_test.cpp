// SPDX-License-Identifier: MIT
// Chains in steps, as nets whose durations are constant, against closed forms and powers of
// matrices; and birth-death chains.
#include <doctest/doctest.h>

#include <cmath>
#include <tuple>

#include "net/maker.h"
#include "puppetri/base/random.h"
#include "puppetri/proof/markov_net.h"
#include "puppetri/run/player.h"

namespace puppetri::proof {
namespace {

using Line = std::tuple<std::string, std::string, double>;

// A place per state that lasts a step, a transition per line; begins in the first line's state.
void add_chain(net::Maker& make, double step_s, const std::vector<Line>& lines) {
    make.place(std::get<0>(lines[0]), 1);
    for (const auto& [from, to, p] : lines) {
        make.place(from).duration = net::lasts(step_s);
        make.t(from + "_" + to, {from}, {to}).odds = Expr::real(p);
    }
}

struct Solved {
    net::Net net;
    MarkovNet markov;

    explicit Solved(const net::NetDraft& draft, const std::vector<std::string>& goals = {})
        : net(net::compile(draft).value()) {
        std::vector<net::Formula> atoms;
        for (const std::string& name : goals) {
            atoms.push_back(net::Formula::marked(net.find_place(name)));
        }
        const Budget budget;
        markov = markov_net({net, atoms, {}, 0, kTicksPerSecond, budget});
        REQUIRE(markov.available());
    }
    double share(const ChainSolution& s, const std::string& place) const {
        CHECK(s.residual < 1e-10);
        return markov.share_marked(s.values, net.find_place(place));
    }
    double share(const std::string& place) const { return share(long_run(markov.chain), place); }
    StateBits goal(std::uint32_t atom = 0) const {
        StateBits bits(markov.chain.size());
        for (std::uint32_t i = 0; i < markov.chain.size(); ++i) {
            if (markov.graph.graph.atoms.must_hold(markov.state[i], atom)) {
                bits.add(i);
            }
        }
        return bits;
    }
};

const std::vector<Line> kWeather = {
    {"sun", "sun", 0.8}, {"sun", "rain", 0.2}, {"rain", "sun", 1 / 3.0}, {"rain", "rain", 2 / 3.0}};

net::NetDraft weather() {
    net::Maker make;
    add_chain(make, 2, kWeather);
    return make.draft;
}

TEST_CASE("two states in steps: the long run is the quotient of the ways out [oracle]") {
    const Solved s(weather());
    CHECK(s.markov.chain.size() == 2);
    CHECK(s.share("sun") == doctest::Approx((1 / 3.0) / (0.2 + 1 / 3.0)).epsilon(1e-12));
    double rate = 0;  // each step fires once: half a firing per second
    for (const char* t : {"sun_sun", "sun_rain", "rain_sun", "rain_rain"}) {
        rate += s.markov.rate(long_run(s.markov.chain).values, s.net.find_transition(t));
    }
    CHECK(rate == doctest::Approx(0.5).epsilon(1e-12));
}

TEST_CASE("two states in steps: at an instant by powers of the second eigenvalue [oracle]") {
    const Solved s(weather());
    const double limit = (1 / 3.0) / (0.2 + 1 / 3.0), lambda = 1 - 0.2 - 1 / 3.0;
    for (const double t : {0.0, 1.9, 2.0, 3.0, 4.0, 20.0, 51.0}) {
        CHECK(s.share(at_time(s.markov.chain, t), "sun") ==
              doctest::Approx(limit + (1 - limit) * std::pow(lambda, std::floor(t / 2)))
                  .epsilon(1e-12));
    }
}

TEST_CASE("a chain that goes round has no limit, but shares; where it is when is certain [unit]") {
    net::Maker make;
    add_chain(make, 1, {{"a", "b", 1}, {"b", "c", 1}, {"c", "a", 1}});
    const Solved s(make.draft);
    for (const char* p : {"a", "b", "c"}) {
        CHECK(s.share(p) == doctest::Approx(1 / 3.0));
    }
    CHECK(s.share(at_time(s.markov.chain, 7.5), "b") == 1);
}

TEST_CASE("the gambler's ruin: probability, mean time, and by when [oracle]") {
    constexpr int kAll = 6, kStart = 2;
    const double p = 0.45, q = 1 - p, r = q / p;
    const auto name = [](int i) { return "s" + std::to_string(i); };
    std::vector<Line> lines = {{name(kStart), name(kStart + 1), p}, {name(kStart), name(1), q}};
    for (int i = 1; i < kAll; ++i) {
        if (i != kStart) {
            lines.emplace_back(name(i), name(i + 1), p);
            lines.emplace_back(name(i), name(i - 1), q);
        }
    }
    net::Maker make;
    add_chain(make, 1, lines);
    const Solved s(make.draft, {"s6", "s0"});
    const double wins = (1 - std::pow(r, kStart)) / (1 - std::pow(r, kAll));
    CHECK(ever_reached(s.markov.chain, s.goal(0)).values[0] == doctest::Approx(wins));
    CHECK(ever_reached(s.markov.chain, s.goal(1)).values[0] == doctest::Approx(1 - wins));
    StateBits either = s.goal(0);
    s.goal(1).for_each([&](std::uint32_t i) { either.add(i); });
    CHECK(mean_time_to(s.markov.chain, either).values[0] ==
          doctest::Approx(kStart / (q - p) - kAll / (q - p) * wins));
    CHECK(std::isinf(mean_time_to(s.markov.chain, s.goal(0)).values[0]));
    std::vector<double> at(kAll + 1, 0);  // by when: fortunes step by step
    at[kStart] = 1;
    for (int t = 1; t <= 30; ++t) {
        std::vector<double> next(kAll + 1, 0);
        next[0] = at[0];
        next[kAll] = at[kAll];
        for (std::size_t i = 1; i < kAll; ++i) {
            next[i + 1] += p * at[i];
            next[i - 1] += q * at[i];
        }
        at = next;
        CHECK(reached_by(s.markov.chain, s.goal(0), t + 0.5).values[0] ==
              doctest::Approx(at[kAll]).epsilon(1e-12));
    }
}

TEST_CASE("chains with different steps beside each other keep their own long runs [law]") {
    net::Maker make;
    add_chain(make, 2, kWeather);
    add_chain(make, 0.7,
              {{"on", "off", 0.5}, {"on", "on", 0.5}, {"off", "on", 0.25}, {"off", "off", 0.75}});
    const Solved s(make.draft);
    CHECK(s.share("sun") == doctest::Approx(0.625));
    CHECK(s.share("on") == doctest::Approx(1 / 3.0));
}

TEST_CASE("random chains in steps: instants are matrix powers, shares their means [oracle]") {
    RandomStream random(stream_key(9, "markov", "test"));
    const auto pick = [&](std::size_t n) { return static_cast<std::size_t>(random.bits() % n); };
    for (int round = 0; round < 20; ++round) {
        const std::size_t n = 2 + pick(5);
        std::vector<std::vector<double>> p(n, std::vector<double>(n, 0));
        std::vector<Line> lines;
        for (std::size_t i = 0; i < n; ++i) {
            for (int k = 0; k < 10; ++k) {
                p[i][pick(n)] += 0.1;
            }
            for (std::size_t j = 0; j < n; ++j) {
                if (p[i][j] != 0) {
                    lines.emplace_back("s" + std::to_string(i), "s" + std::to_string(j), p[i][j]);
                }
            }
        }
        net::Maker make;
        for (std::size_t i = 0; i < n; ++i) {
            make.p("s" + std::to_string(i));
        }
        add_chain(make, 1, lines);
        const Solved s(make.draft);
        std::vector<double> at(n, 0), mean(n, 0);
        at[0] = 1;
        for (int t = 0; t <= 4000; ++t) {
            if (t < 10) {
                const ChainSolution solved = at_time(s.markov.chain, t);
                for (std::size_t i = 0; i < n; ++i) {
                    CHECK(s.share(solved, "s" + std::to_string(i)) ==
                          doctest::Approx(at[i]).epsilon(1e-12));
                }
            }
            std::vector<double> next(n, 0);
            for (std::size_t i = 0; i < n; ++i) {
                mean[i] += at[i] / 4001;
                for (std::size_t j = 0; j < n; ++j) {
                    next[j] += at[i] * p[i][j];
                }
            }
            at = next;
        }
        for (std::size_t i = 0; i < n; ++i) {
            CHECK(std::abs(s.share("s" + std::to_string(i)) - mean[i]) < 0.005);
        }
    }
}

TEST_CASE("a long run of the player is where the solution says [oracle]") {
    const net::Net n = net::compile(weather()).value();
    struct Count final : run::LogSink {
        const net::Net* net = nullptr;
        int sun = 0, all = 0;
        void fired(SimTime, net::TransitionIndex t) override {
            sun += net->transition(t).path.substr(0, 4) == "sun_" ? 1 : 0;
            ++all;
        }
    } count;
    count.net = &n;
    run::Player player(n, {.seed = 5, .sink = &count});
    player.run({.firings = 50'000});
    // Deviation of the share in n steps of a chain of two states: sqrt(pq (1 + l) / (1 - l) / n).
    const double l = 1 - 0.2 - 1 / 3.0;
    const double deviation = std::sqrt(0.625 * 0.375 * (1 + l) / (1 - l) / count.all);
    CHECK(count.all == 50'000);
    CHECK(std::abs(count.sun / static_cast<double>(count.all) - 0.625) < 4 * deviation);
}

TEST_CASE("a birth-death chain in continuous time has its product form [oracle]") {
    constexpr int kStates = 9;
    net::Maker make;
    std::vector<double> weight{1};
    const auto name = [](int i) { return "s" + std::to_string(i); };
    make.place(name(0), 1);
    for (int i = 0; i + 1 < kStates; ++i) {
        const double birth = 1 + (7 * i) % 5, death = 2 + (3 * i) % 4;
        weight.push_back(weight.back() * birth / death);
        make.t("up" + std::to_string(i), {name(i)}, {name(i + 1)}).delay =
            net::DelayDraft{.duration = net::exponential(1 / birth)};
        make.t("down" + std::to_string(i), {name(i + 1)}, {name(i)}).delay =
            net::DelayDraft{.duration = net::exponential(1 / death)};
    }
    double sum = 0;
    for (const double w : weight) {
        sum += w;
    }
    const Solved s(make.draft);
    for (int i = 0; i < kStates; ++i) {
        CHECK(s.share(name(i)) ==
              doctest::Approx(weight[static_cast<std::size_t>(i)] / sum).epsilon(1e-6));
    }
}

TEST_CASE("what mixes steps and exponential times is no chain, and is named [unit]") {
    net::Maker make;
    add_chain(make, 2, kWeather);
    make.t("comes", {"off"}, {"on"}).delay = net::DelayDraft{.duration = net::exponential(1)};
    make.place("off", 1);
    const net::Net n = net::compile(make.draft).value();
    const Budget budget;
    const MarkovNet made = markov_net({n, {}, {}, 0, kTicksPerSecond, budget});
    CHECK_FALSE(made.available());
    REQUIRE_FALSE(made.why_not.empty());
    CHECK(made.why_not[0].find("place ") != std::string::npos);
}

}  // namespace
}  // namespace puppetri::proof
