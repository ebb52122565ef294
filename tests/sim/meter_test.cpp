// SPDX-License-Identifier: MIT
#include "puppetri/sim/meter.h"

#include <doctest/doctest.h>

#include "net/maker.h"
#include "sim/queue_nets.h"

namespace puppetri::sim {
namespace {

double measured(const net::Net& net, const Metric& metric, SimTime until, SimTime from = {}) {
    Meter meter(net, {&metric, 1}, {.from = from});
    run::Player player(net, {.observer = &meter});
    player.run({.until = until});
    double value = -1;
    meter.finish(until, {&value, 1});
    return value;
}

// Two customers stand in the queue, service takes 3 s each, one barber: the first is served in 0 ..
// 3, the second waits until 3 and is served in 3 .. 6.
net::Net two_customers() {
    net::Maker make;
    make.place("queue", 2);
    make.place("barber", 1);
    make.place("chair", 0, net::lasts(3));
    make.t("serve", {"queue", "barber"}, {"chair"});
    make.t("leave", {"chair"}, {"barber"});
    return net::compile(make.draft).value();
}

}  // namespace

TEST_CASE("two customers and a barber, by hand") {
    using enum MetricKind;
    const net::Net net = two_customers();
    const std::uint32_t queue = net.find_place("queue").value,
                        chair = net.find_place("chair").value,
                        leave = net.find_transition("leave").value;
    const SimTime end = net::seconds(10);
    // queue: 1 in 0 .. 3; chair: 1 in 0 .. 6
    CHECK(measured(net, {kTokens, queue}, end) == doctest::Approx(0.3));
    CHECK(measured(net, {kTokens, chair}, end) == doctest::Approx(0.6));
    CHECK(measured(net, {kBusy, chair}, end) == doctest::Approx(0.6));
    CHECK(measured(net, {kStay, queue}, end) == doctest::Approx(1.5));  // 0 and 3
    CHECK(measured(net, {kStay, chair}, end) == doctest::Approx(3));
    CHECK(measured(net, {kMost, queue}, end) == 2);
    CHECK(measured(net, {kRate, leave}, end) == doctest::Approx(0.2));
    CHECK(measured(net, {kFirings, leave}, end) == 2);
}

TEST_CASE("what happens before the warm-up is over does not count") {
    using enum MetricKind;
    const net::Net net = two_customers();
    const std::uint32_t queue = net.find_place("queue").value,
                        chair = net.find_place("chair").value,
                        leave = net.find_transition("leave").value;
    const SimTime end = net::seconds(10), from = net::seconds(2);
    CHECK(measured(net, {kTokens, queue}, end, from) == doctest::Approx(1.0 / 8));
    CHECK(measured(net, {kTokens, chair}, end, from) == doctest::Approx(4.0 / 8));
    CHECK(measured(net, {kStay, queue}, end, from) == doctest::Approx(3));
    CHECK(measured(net, {kMost, queue}, end, from) == 1);
    CHECK(measured(net, {kFirings, leave}, end, from) == 2);
    CHECK(measured(net, {kFirings, leave}, end, net::seconds(4)) == 1);
}

TEST_CASE("arcs that take all, and tokens that go and come in one firing") {
    using enum MetricKind;
    net::Maker make;
    make.place("tick", 1, net::lasts(1));
    make.place("heap");
    make.place("third", 0, net::lasts(3));
    make.t("beat", {"tick"}, {"tick", "heap"});  // at 1, 2, 3, ...
    make.t("start", {"begin"}, {"third"}).priority = 2;
    make.place("begin", 1);
    make.t("sweep", {"third", "all heap"}, {"third"});  // at 3, 6, 9
    const net::Net net = net::compile(make.draft).value();
    const std::uint32_t tick = net.find_place("tick").value, heap = net.find_place("heap").value;
    CHECK(measured(net, {kStay, tick}, net::seconds(9.5)) == doctest::Approx(1));
    CHECK(measured(net, {kTokens, tick}, net::seconds(9.5)) == doctest::Approx(1));
    CHECK(measured(net, {kBusy, tick}, net::seconds(9.5)) == doctest::Approx(1));
    // Those of 1 and 2 stay 2 and 1 s; that of 3 comes in the instant of the sweep: 0 or 3 s
    const double stay = measured(net, {kStay, heap}, net::seconds(9.5));
    CHECK(stay >= 1);
    CHECK(stay <= 2);
    CHECK(measured(net, {kMost, heap}, net::seconds(9.5)) <= 4);
}

TEST_CASE("Little's law holds in every long run") {
    using enum MetricKind;
    const QueueNet q = make_queue(2, 1, net::exponential(1));
    const SimTime end = net::seconds(200'000);
    const double tokens = measured(q.net, {kTokens, q.queue}, end),
                 rate = measured(q.net, {kRate, q.serve}, end),
                 stay = measured(q.net, {kStay, q.queue}, end);
    CHECK(tokens == doctest::Approx(rate * stay).epsilon(0.001));
}

}  // namespace puppetri::sim
