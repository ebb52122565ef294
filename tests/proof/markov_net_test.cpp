// SPDX-License-Identifier: MIT
// Exponential nets as Markov chains against closed forms of queueing theory.
#include "puppetri/proof/markov_net.h"

#include <doctest/doctest.h>

#include <cmath>

#include "net/maker.h"

namespace puppetri::proof {
namespace {

using net::exponential;

MarkovNet solve(const net::Net& n) {
    const Budget budget;
    return markov_net({n, {}, {}, 0, kTicksPerSecond, budget});
}

net::Net compiled(const net::Maker& make) {
    auto made = net::compile(make.draft);
    REQUIRE(made.has_value());
    return std::move(*made);
}

// Poisson arrivals that are lost when `room` are in the system, `servers` servers.
net::Net loss_queue(double arrival_mean_s, double service_mean_s, std::uint32_t servers,
                    std::uint32_t room) {
    net::Maker make;
    make.place("free", room);
    make.place("idle", servers);
    make.place("busy", 0, exponential(service_mean_s));
    make.t("arrive", {"free"}, {"queue"}).delay =
        net::DelayDraft{.duration = exponential(arrival_mean_s)};
    make.t("serve", {"queue", "idle"}, {"busy"});
    make.t("leave", {"busy"}, {"idle", "free"});
    return compiled(make);
}

}  // namespace

TEST_CASE("M/M/1/K: the whole distribution") {
    const double rho = 0.8;
    constexpr std::uint32_t kRoom = 6;
    const net::Net n = loss_queue(1 / rho, 1, 1, kRoom);
    const MarkovNet m = solve(n);
    REQUIRE(m.available());
    CHECK(m.chain.size() == kRoom + 1);
    const ChainSolution s = long_run(m.chain);
    CHECK(s.residual < 1e-12);
    const double none = (1 - rho) / (1 - std::pow(rho, kRoom + 1));
    double mean = 0;
    for (std::uint32_t k = 1; k <= kRoom; ++k) {
        mean += k * none * std::pow(rho, k);
    }
    const net::PlaceIndex queue = n.find_place("queue"), busy = n.find_place("busy");
    CHECK(m.mean_tokens(s.values, queue) + m.mean_tokens(s.values, busy) ==
          doctest::Approx(mean).epsilon(1e-10));
    CHECK(m.share_marked(s.values, busy) == doctest::Approx(1 - none).epsilon(1e-10));
    CHECK(m.rate(s.values, n.find_transition("leave")) == doctest::Approx(1 - none).epsilon(1e-10));
    CHECK(m.rate(s.values, n.find_transition("serve")) == doctest::Approx(1 - none).epsilon(1e-10));
    CHECK(m.arrivals(s.values, queue) == doctest::Approx(1 - none).epsilon(1e-10));
}

TEST_CASE("M/M/c/c: Erlang's B; several tokens of a place are as fast as all of them") {
    const double load = 2.5;
    double b = 1;
    for (int k = 1; k <= 4; ++k) {
        b = load * b / (k + load * b);
    }
    const net::Net n = loss_queue(1 / load, 1, 4, 4);
    const MarkovNet m = solve(n);
    const ChainSolution s = long_run(m.chain);
    CHECK(m.mean_tokens(s.values, n.find_place("busy")) ==
          doctest::Approx(load * (1 - b)).epsilon(1e-10));
}

TEST_CASE("ties within an instant go by their odds, and states inside of it are no states") {
    net::Maker make;
    make.place("start", 1, exponential(2));
    make.t("left", {"start"}, {"a"}).odds = Expr::real(1);
    make.t("right", {"start"}, {"b"}).odds = Expr::real(3);
    make.t("on", {"b"}, {"c"});
    make.t("back_a", {"a"}, {"start"}).delay = net::DelayDraft{.duration = exponential(1)};
    make.t("back_c", {"c"}, {"start"}).delay = net::DelayDraft{.duration = exponential(1)};
    const net::Net n = compiled(make);
    const MarkovNet m = solve(n);
    REQUIRE(m.available());
    CHECK(m.chain.size() == 3);
    const ChainSolution s = long_run(m.chain);
    // A cycle takes 3 s on average, 2 in start
    CHECK(m.mean_tokens(s.values, n.find_place("start")) == doctest::Approx(2.0 / 3));
    CHECK(m.mean_tokens(s.values, n.find_place("a")) == doctest::Approx(0.25 / 3));
    CHECK(m.mean_tokens(s.values, n.find_place("c")) == doctest::Approx(0.75 / 3));
    CHECK(m.mean_tokens(s.values, n.find_place("b")) == 0);
    CHECK(m.rate(s.values, n.find_transition("on")) == doctest::Approx(0.75 / 3));
}

TEST_CASE("priorities hold between what is due at one instant") {
    net::Maker make;
    make.place("start", 1, exponential(2));
    make.t("low", {"start"}, {"a"});
    make.t("high", {"start"}, {"b"}).priority = 2;
    const net::Net n = compiled(make);
    const MarkovNet m = solve(n);
    const ChainSolution s = long_run(m.chain);
    CHECK(m.mean_tokens(s.values, n.find_place("b")) == doctest::Approx(1));
    CHECK(m.mean_tokens(s.values, n.find_place("a")) == 0);
}

TEST_CASE("a delay of several servers works as fast as all that are busy") {
    for (const std::uint32_t servers : {1u, 3u, net::DelayDraft::kInfiniteServers}) {
        net::Maker make;
        make.place("jobs", 5);
        make.place("done", 0, exponential(1));
        net::TransitionDraft& work = make.t("work", {"jobs"}, {"done"});
        work.delay = net::DelayDraft{.duration = exponential(2), .servers = servers};
        make.t("again", {"done"}, {"jobs"});
        const net::Net n = compiled(make);
        const MarkovNet m = solve(n);
        REQUIRE(m.available());
        const ChainSolution s = long_run(m.chain);
        // Birth and death: k jobs at work, min(k, c)/2 out, (5 - k)/1 in
        double weight = 1, sum = 1, mean = 0;
        for (std::uint32_t k = 1; k <= 5; ++k) {
            weight *= (5 - (k - 1)) / (std::min(k, servers) / 2.0);
            sum += weight;
            mean += k * weight;
        }
        CHECK(m.mean_tokens(s.values, n.find_place("jobs")) ==
              doctest::Approx(mean / sum).epsilon(1e-10));
    }
}

TEST_CASE("the time until something happens") {
    // Three exponential steps, one after another
    net::Maker make;
    make.place("p0", 1, exponential(1));
    make.place("p1", 0, exponential(2));
    make.place("p2", 0, exponential(3));
    make.t("t0", {"p0"}, {"p1"});
    make.t("t1", {"p1"}, {"p2"});
    make.t("t2", {"p2"}, {"end"});
    const net::Net n = compiled(make);
    const MarkovNet m = solve(n);
    StateBits goal(m.chain.size());
    for (std::uint32_t i = 0; i < m.chain.size(); ++i) {
        if (m.graph.tokens(m.state[i], n.find_place("end")).total != 0) {
            goal.add(i);
        }
    }
    CHECK(mean_time_to(m.chain, goal).values[0] == doctest::Approx(6));
}

TEST_CASE("what is in the way is named") {
    net::Maker make;
    make.place("fixed", 1, net::lasts(2));
    make.t("t", {"fixed"}, {"fixed"});
    make.place("drawn", 1, exponential(1));
    make.t("u", {"drawn"}, {"drawn"});
    const MarkovNet m = solve(compiled(make));
    REQUIRE_FALSE(m.available());
    CHECK(m.why_not[0].find("fixed") != std::string::npos);
    net::Maker uneven;
    uneven.place("uneven", 1,
                 net::drawn(DistributionKind::kUniform,
                            {Expr::time(net::seconds(1)), Expr::time(net::seconds(2))}));
    uneven.t("t", {"uneven"}, {"uneven"});
    CHECK(solve(compiled(uneven)).why_not.at(0).find("uneven") != std::string::npos);
    net::Maker round;
    round.place("a", 1, exponential(1));
    round.t("ab", {"a"}, {"b"});
    round.t("bc", {"b"}, {"c"});
    round.t("cb", {"c"}, {"b"});
    CHECK_FALSE(solve(compiled(round)).available());
}

}  // namespace puppetri::proof
