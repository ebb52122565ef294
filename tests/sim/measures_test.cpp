// SPDX-License-Identifier: MIT
// Measures that a net declares, by hand and against another way of counting.
#include <doctest/doctest.h>

#include <cmath>

#include "net/maker.h"
#include "puppetri/sim/meter.h"
#include "puppetri/sim/net_experiment.h"

namespace puppetri::sim {
namespace {

using net::Seen;
using net::Statistic;

struct Played {
    std::vector<double> values;
    std::optional<Diagnostic> fault;
};

Played played(const net::Net& net, double until_s, double from_s = 0, std::uint64_t seed = 1) {
    const std::vector<Metric> metrics = declared_metrics(net);
    Meter meter(net, metrics, {.from = net::seconds(from_s)});
    run::Player player(net, {.seed = seed, .observer = &meter});
    player.run({.until = net::seconds(until_s)});
    Played out{std::vector<double>(metrics.size()), meter.fault()};
    meter.finish(net::seconds(until_s), out.values);
    return out;
}

double number(const net::NetDraft& draft, double until_s, double from_s = 0) {
    auto net = net::compile(draft);
    REQUIRE(net.has_value());
    const Played p = played(*net, until_s, from_s);
    REQUIRE(p.values.size() == 1);
    CHECK(!p.fault);
    return p.values[0];
}

Expr count_of(std::uint32_t place, bool ready = false) {
    return Expr::slot(net::slot(ready ? net::SlotKind::kReady : net::SlotKind::kCount, place),
                      {ValueKind::kInt});
}

// One barber, service 3 s; customers are there at 0 (two) and come at 5 (one).
// queue: 1 in 0..3, else 0 (that of 5 waits until 6: 1 in 5..6); chair: 1 in 0..9.
struct Shop {
    net::Maker make;
    std::uint32_t queue = 0, idle = 1, chair = 2;
    Shop() {
        make.place("queue", 2);
        make.place("idle", 1);
        make.place("chair", 0, net::lasts(3));
        make.place("later", 1, net::lasts(5));
        make.t("serve", {"queue", "idle"}, {"chair"});
        make.t("leave", {"chair"}, {"idle"});
        make.t("come", {"later"}, {"queue"});
    }
    net::MeasureDraft& measure(Statistic s, Seen seen) {
        net::MeasureDraft& m = make.draft.measures.emplace_back();
        m.path = "m" + std::to_string(make.draft.measures.size());
        m.statistic = s;
        m.seen = seen;
        return m;
    }
    double state(Statistic s, Expr value, double until, double from = 0) {
        make.draft.measures.clear();
        measure(s, Seen::kState).value = std::move(value);
        return number(make.draft, until, from);
    }
    double stay(Statistic s, std::uint32_t place, double until, double from = 0,
                double percent = 50) {
        make.draft.measures.clear();
        net::MeasureDraft& m = measure(s, Seen::kStays);
        m.place = {place};
        m.percent = percent;
        if (s == Statistic::kShare) {
            m.above = net::seconds(0.5);
        }
        return number(make.draft, until, from);
    }
    double firing(Statistic s, const char* transition, std::optional<Expr> value, double until) {
        make.draft.measures.clear();
        net::Moment moment{make.index(transition), {}, value.has_value()};
        if (value) {
            moment.value = *value;
        }
        measure(s, Seen::kFirings).from.push_back(moment);
        return number(make.draft, until);
    }
    double passage(Statistic s, const char* from, const char* to, double until) {
        make.draft.measures.clear();
        net::MeasureDraft& m = measure(s, Seen::kPassages);
        m.from.push_back({make.index(from), {}, false});
        m.to.push_back({make.index(to), {}, false});
        return number(make.draft, until);
    }
};

}  // namespace

TEST_CASE("what is there all the time: means, extremes, integrals, shares, by hand") {
    Shop shop;
    const Expr waiting = count_of(shop.queue);
    const Expr crowd =
        Expr::binary(ExprOp::kAdd, count_of(shop.queue), count_of(shop.chair)).value();
    const Expr busy =
        Expr::binary(ExprOp::kGreater, count_of(shop.chair), Expr::integer(0)).value();
    CHECK(shop.state(Statistic::kMean, waiting, 10) == doctest::Approx(0.4));
    CHECK(shop.state(Statistic::kMean, crowd, 10) == doctest::Approx(1.3));
    CHECK(shop.state(Statistic::kMost, crowd, 10) == 2);
    CHECK(shop.state(Statistic::kLeast, crowd, 8) == 1);
    CHECK(shop.state(Statistic::kLeast, crowd, 10) == 0);
    CHECK(shop.state(Statistic::kTotal, crowd, 10) == doctest::Approx(13));
    CHECK(shop.state(Statistic::kFinal, crowd, 8) == 1);
    CHECK(shop.state(Statistic::kShare, busy, 10) == doctest::Approx(0.9));
    // After a warm-up of 4 s: the queue has one in 5 .. 6
    CHECK(shop.state(Statistic::kMean, waiting, 10, 4) == doctest::Approx(1.0 / 6));
    CHECK(shop.state(Statistic::kMost, crowd, 10, 4) == 2);
    CHECK(shop.state(Statistic::kMost, crowd, 10, 7) == 1);
}

TEST_CASE("ready tokens change without a firing, and are seen all the same") {
    net::Maker make;
    make.place("kettle", 1, net::lasts(4));  // ready at 4, and nobody takes it
    net::MeasureDraft& m = make.draft.measures.emplace_back();
    m.path = "hot";
    m.value = count_of(0, true);
    CHECK(number(make.draft, 10) == doctest::Approx(0.6));
    CHECK(number(make.draft, 3) == 0);
}

TEST_CASE("stays, firings and passages, by hand") {
    Shop shop;
    // Stays in the queue: 0, 3 (of the two), 1 (of the third)
    CHECK(shop.stay(Statistic::kMean, shop.queue, 10) == doctest::Approx(4.0 / 3));
    CHECK(shop.stay(Statistic::kMost, shop.queue, 10) == 3);
    CHECK(shop.stay(Statistic::kLeast, shop.queue, 10) == 0);
    CHECK(shop.stay(Statistic::kFinal, shop.queue, 10) == doctest::Approx(1));
    CHECK(shop.stay(Statistic::kTotal, shop.queue, 10) == doctest::Approx(4));
    CHECK(shop.stay(Statistic::kCount, shop.queue, 10) == 3);
    CHECK(shop.stay(Statistic::kShare, shop.queue, 10) == doctest::Approx(2.0 / 3));  // over 0.5 s
    CHECK(shop.stay(Statistic::kPercentile, shop.queue, 10, 0, 50) == doctest::Approx(1));
    CHECK(shop.stay(Statistic::kPercentile, shop.queue, 10, 0, 34) == doctest::Approx(1));
    CHECK(shop.stay(Statistic::kPercentile, shop.queue, 10, 0, 33) == 0);
    CHECK(shop.stay(Statistic::kPercentile, shop.queue, 10, 0, 100) == 3);
    CHECK(shop.stay(Statistic::kMean, shop.chair, 10) == doctest::Approx(3));
    CHECK(shop.stay(Statistic::kMean, shop.queue, 10, 5) == doctest::Approx(1));
    CHECK(std::isnan(shop.stay(Statistic::kMean, shop.queue, 10, 7)));

    CHECK(shop.firing(Statistic::kCount, "leave", {}, 10) == 3);
    CHECK(shop.firing(Statistic::kRate, "leave", {}, 10) == doctest::Approx(0.3));
    // Just before: who comes at 5 sees nobody waiting, who is served at 0, 3, 6 waits there
    CHECK(shop.firing(Statistic::kMean, "come", count_of(shop.queue), 10) == 0);
    CHECK(shop.firing(Statistic::kMean, "serve", count_of(shop.queue), 10) ==
          doctest::Approx(4.0 / 3));
    const Expr two = Expr::binary(ExprOp::kEqual, count_of(shop.queue), Expr::integer(2)).value();
    CHECK(shop.firing(Statistic::kShare, "serve", two, 10) == doctest::Approx(1.0 / 3));
    CHECK(shop.firing(Statistic::kCount, "serve", two, 10) == 1);

    CHECK(shop.passage(Statistic::kMean, "serve", "leave", 10) == doctest::Approx(3));
    CHECK(shop.passage(Statistic::kMean, "leave", "leave", 10) == doctest::Approx(3));  // 3, 6, 9
    CHECK(shop.passage(Statistic::kCount, "leave", "leave", 10) == 2);
    CHECK(shop.passage(Statistic::kMean, "come", "leave", 10) == doctest::Approx(1));  // 5 to 6
}

TEST_CASE("who overtakes is told apart by a key, or by the order of readiness") {
    // Two enter at 0 and 1; the first stays 5 s, the second 1 s: out at 2 (of 1) and 5 (of 0)
    net::Maker make;
    make.place("first", 1);
    make.place("second", 1, net::lasts(1));
    make.place("slow", 0, net::lasts(5));
    make.place("fast", 0, net::lasts(1));
    make.t("enter1", {"first"}, {"slow"});
    make.t("enter2", {"second"}, {"fast"});
    make.t("out1", {"slow"}, {});
    make.t("out2", {"fast"}, {});
    const auto passage = [&](bool keyed, Statistic s) {
        make.draft.measures.clear();
        net::MeasureDraft& m = make.draft.measures.emplace_back();
        m.path = "m";
        m.seen = Seen::kPassages;
        m.statistic = s;
        m.from = {{make.index("enter1"), Expr::integer(1), keyed},
                  {make.index("enter2"), Expr::integer(2), keyed}};
        m.to = {{make.index("out1"), Expr::integer(1), keyed},
                {make.index("out2"), Expr::integer(2), keyed}};
        return number(make.draft, 10);
    };
    CHECK(passage(true, Statistic::kMost) == doctest::Approx(5));
    CHECK(passage(true, Statistic::kLeast) == doctest::Approx(1));
    CHECK(passage(false, Statistic::kMost) == doctest::Approx(4));
    CHECK(passage(false, Statistic::kLeast) == doctest::Approx(2));
    CHECK(passage(true, Statistic::kMean) == doctest::Approx(passage(false, Statistic::kMean)));

    // In one place whose tokens last as data say: 5 s, then 1 s
    net::Maker one;
    const net::DatumIndex wait = one.datum("wait", {ValueKind::kTime}, net::seconds(5).ticks);
    one.place("room", 0, net::computed(one.read(wait)));
    one.place("first", 1);
    one.place("second", 1, net::lasts(1));
    one.place("bell", 1, net::lasts(0.5));
    one.t("enter1", {"first"}, {"room"});
    one.t("hurry", {"bell"}, {}).assignments.push_back({wait, Expr::time(net::seconds(1)), {}});
    one.t("enter2", {"second"}, {"room"});
    one.t("out", {"room"}, {});
    net::MeasureDraft& m = one.draft.measures.emplace_back();
    m.path = "m";
    m.seen = Seen::kStays;
    m.place = one.p("room");
    m.statistic = Statistic::kMost;
    CHECK(number(one.draft, 10) == doctest::Approx(5));
    one.draft.measures[0].statistic = Statistic::kLeast;
    CHECK(number(one.draft, 10) == doctest::Approx(1));
}

TEST_CASE("a discipline that takes the newest is followed") {
    // Three wait from 0, 1, 2; one leaves at 3, 6, 9: the newest each time stays 1, 5, 9
    for (const net::Discipline discipline : {net::Discipline::kNewest, net::Discipline::kOldest}) {
        net::Maker make;
        make.place("pile").discipline = discipline;
        make.place("tick", 3);
        make.place("tock", 0, net::lasts(1));
        make.place("gate", 1, net::lasts(3));
        make.t("drop", {"tick", "unless tock"}, {"pile", "tock"});
        make.t("tack", {"tock"}, {});
        make.t("lift", {"gate", "pile"}, {"gate"});
        net::MeasureDraft& m = make.draft.measures.emplace_back();
        m.path = "m";
        m.seen = Seen::kStays;
        m.statistic = Statistic::kMost;
        m.place = make.p("pile");
        const bool newest = discipline == net::Discipline::kNewest;
        CHECK(number(make.draft, 10) == doctest::Approx(newest ? 9 : 7));
    }
}

TEST_CASE("what cannot be computed is a failure that names the measure") {
    Shop shop;
    shop.make.draft.measures.clear();
    shop.measure(Statistic::kMean, Seen::kState).value =
        Expr::binary(ExprOp::kDivide, Expr::integer(1), count_of(shop.queue)).value();
    const net::Net net = net::compile(shop.make.draft).value();
    const Played p = played(net, 10);
    REQUIRE(p.fault.has_value());
    CHECK(p.fault->code == "evaluation-fault");
    CHECK(p.fault->element == "measure m1");
}

TEST_CASE("a queue's measures agree with each other and with theory in a long run") {
    // M/M/1, rho = 0.8, mean service 1 s: wait 4 s, sojourn exponential with mean 5 s
    net::Maker make;
    make.place("queue");
    make.place("idle", 1);
    make.place("chair", 0, net::exponential(1));
    make.t("arrive", {}, {"queue"}).delay = net::DelayDraft{.duration = net::exponential(1.25)};
    make.t("serve", {"queue", "idle"}, {"chair"});
    make.t("leave", {"chair"}, {"idle"});
    const auto add = [&](Statistic s, Seen seen) -> net::MeasureDraft& {
        net::MeasureDraft& m = make.draft.measures.emplace_back();
        m.path = "m" + std::to_string(make.draft.measures.size());
        m.statistic = s;
        m.seen = seen;
        return m;
    };
    add(Statistic::kMean, Seen::kStays).place = make.p("queue");
    for (const Statistic s : {Statistic::kMean, Statistic::kPercentile, Statistic::kShare}) {
        net::MeasureDraft& m = add(s, Seen::kPassages);
        m.percent = 90;
        if (s == Statistic::kShare) {
            m.above = net::seconds(5);
        }
        m.from.push_back({make.index("arrive"), {}, false});
        m.to.push_back({make.index("leave"), {}, false});
    }
    // Poisson arrivals see time averages: a customer finds the server busy with probability rho
    add(Statistic::kShare, Seen::kFirings)
        .from.push_back(
            {make.index("arrive"),
             Expr::binary(ExprOp::kGreater, count_of(make.p("chair").value), Expr::integer(0))
                 .value(),
             true});
    const net::Net net = net::compile(make.draft).value();
    const NetExperiment experiment(
        net, declared_metrics(net),
        {.limits = {.until = net::seconds(30'000)}, .warm_up = net::seconds(500)});
    const Outcome o = replicate(experiment, {.seed = 5, .replications = 20, .level = 0.9999});
    const double truth[] = {4, 5, -5 * std::log(0.1), std::exp(-1.0), 0.8};
    for (std::size_t i = 0; i < 5; ++i) {
        CAPTURE(i);
        CHECK(std::abs(o.means[i].mean - truth[i]) < o.means[i].half_width);
        CHECK(o.means[i].half_width < 0.1 * truth[i]);
    }
}

}  // namespace puppetri::sim
