// SPDX-License-Identifier: MIT
// Equations coupled to a net, against closed forms: the programs are built by hand, as the scene
// builds them from text.
#include "puppetri/run/equations.h"

#include <doctest/doctest.h>

#include <cmath>

#include "puppetri/base/random.h"
#include "run/equate.h"

namespace puppetri::run {
namespace {

SimTime up_to_ms(double t_s) {
    return {static_cast<std::int64_t>(std::ceil(t_s * 1000 - 1e-3)) * kTicksPerMillisecond};
}

// A ball: h' = v, v' = -g, and the firing `bounce` of every impact.
struct Ball {
    Maker m;
    Equate q;
    explicit Ball(double height, double e) {
        m.event("impact");
        m.place("air", 1);
        m.t("bounce", {"air"}, {"air"}).events = {{0}};
        const auto h = q.variable("h", height), v = q.variable("v", 0);
        q.rate(h, var(v));
        q.rate(v, X(-9.81));
        q.event({0}, var(h), CrossingDirection::kFalls);
        q.s.resets.push_back({{0}, v, q.add(X(-e) * var(v))});
    }
};

TEST_CASE("a bouncing ball hits the floor at its closed-form times, whatever the slices [oracle]") {
    Ball ball(2, 0.8);
    const net::Net n = timed(ball.m);
    Equations equations({ball.q.s});
    const Ran ran = play(n, equations, seconds(5.7));
    CHECK(ran.stop == Stop::kLimit);
    // t0 = sqrt(2 h / g), then intervals 2 t0 e^k.
    const double t0 = std::sqrt(2 * 2 / 9.81);
    double t = t0, flight = 2 * t0;
    std::vector<SimTime> truth;
    for (int k = 0; t <= 5.7 && truth.size() < ran.times.size() + 1; ++k) {
        truth.push_back(up_to_ms(t));
        flight *= 0.8;
        t += flight;
    }
    REQUIRE(ran.times.size() == truth.size());
    CHECK(truth.size() > 15);
    CHECK(ran.times == truth);
    // Between impacts it is where gravity has it.
    CHECK(equations.value(0, 0, seconds(0.3)) == doctest::Approx(2 - 9.81 / 2 * 0.09));
    Equations again({ball.q.s});
    CHECK(play(n, again, seconds(5.7), SimTime{kTicksPerSecond / 33}).hash == ran.hash);
}

TEST_CASE("bounces that pile up are told, with time and state [hostile]") {
    for (const double e : {0.02, 0.5, 0.8, 0.95}) {
        CAPTURE(e);
        Ball ball(2, e);
        const net::Net n = timed(ball.m);
        Equations equations({ball.q.s});
        const Ran ran = play(n, equations, seconds(50));
        REQUIRE(ran.stop == Stop::kFault);
        CHECK(ran.fault.code == "crossings-accumulate");
        // All impacts are over at t0 (1 + 2 e / (1 - e)).
        CHECK(ran.times.back() == up_to_ms(std::sqrt(4 / 9.81) * (1 + 2 * e / (1 - e))));
    }
}

TEST_CASE("what the net does in the instant of a crossing acts at the crossing itself [unit]") {
    // At the impact the ball is put down: it lies where the floor is, not where it would have been
    // when the millisecond was over.
    Ball ball(2, 0.8);
    ball.q.s.enabled_by = {ball.m.p("air")};
    ball.m.draft.transitions[0].outputs.clear();
    const net::Net n = timed(ball.m);
    Equations equations({ball.q.s});
    const Ran ran = play(n, equations, seconds(5));
    CHECK(ran.times.size() == 1);
    CHECK(std::fabs(equations.value(0, 0, seconds(4))) < 1e-9);
}

TEST_CASE("a thermostat switches at the times of its closed form [oracle]") {
    // T' = -(T - 15) + heat * 20, on below 18, off above 22.
    Maker m;
    m.event("cold");
    m.event("warm");
    m.place("off", 1);
    net::DatumDraft heat;
    heat.path = "heat";
    heat.type = {ValueKind::kInt};
    m.draft.data.push_back(heat);
    auto& on = m.t("on", {"off"}, {"heats"});
    on.events = {{0}};
    on.assignments.push_back({{0}, Expr::integer(1), {}});
    auto& off = m.t("off_again", {"heats"}, {"off"});
    off.events = {{1}};
    off.assignments.push_back({{0}, Expr::integer(0), {}});
    Equate q;
    const auto temperature = q.variable("T", 20);
    q.s.data.push_back({{0}, ValueKind::kInt});
    q.rate(temperature, X(15) - var(temperature) + X(20) * slot(EquationSlot::kDatum, 0));
    q.event({0}, var(temperature) - X(18), CrossingDirection::kFalls);
    q.event({1}, var(temperature) - X(22), CrossingDirection::kRises);
    const net::Net n = timed(m);
    Equations equations({q.s});
    const Ran ran = play(n, equations, seconds(10));
    // From 20 to 18 towards 15: ln(5/3); then up towards 35: ln(17/13), down ln(7/3), and so on.
    std::vector<SimTime> truth;
    double t = std::log(5.0 / 3);
    for (bool up = true; t < 10; up = !up) {
        truth.push_back(up_to_ms(t));
        t += up ? std::log(17.0 / 13) : std::log(7.0 / 3);
    }
    CHECK(ran.times == truth);
}

TEST_CASE("a quantity that oscillates while its variable runs straight hides nothing [oracle]") {
    Maker m;
    m.event("beat");
    m.place("p", 1);
    m.t("count", {"p"}, {"p"}).events = {{0}};
    Equate q;
    const auto phase = q.variable("phase", 0.1);
    q.rate(phase, X(2 * 3.14159265358979));
    q.event({0}, one(ExprOp::kSin, var(phase)), CrossingDirection::kRises, false);
    const net::Net n = timed(m);
    Equations equations({q.s});
    const Ran ran = play(n, equations, seconds(100));
    REQUIRE(ran.times.size() == 100);
    CHECK(ran.times[49] == up_to_ms(50 - 0.1 / (2 * 3.14159265358979)));
}

TEST_CASE("touching is no crossing, and a crossing there and back is two [unit]") {
    const auto crossings = [](double depth) {
        Maker m;
        m.event("down");
        m.event("up");
        m.place("p", 1);
        m.t("count", {"p"}, {"p"}).events = {{0}, {1}};
        Equate q;
        const auto x = q.variable("x", 1 - depth), v = q.variable("v", -2);
        q.rate(x, var(v));
        q.rate(v, X(2));  // x = (t - 1)^2 - depth
        q.event({0}, var(x), CrossingDirection::kFalls);
        q.event({1}, var(x), CrossingDirection::kRises);
        const net::Net n = timed(m);
        Equations equations({q.s});
        return play(n, equations, seconds(3)).times;
    };
    CHECK(crossings(-1e-9).empty());
    CHECK(crossings(1e-8) == std::vector<SimTime>{seconds(1), seconds(1.001)});
    CHECK(crossings(0.25) == std::vector<SimTime>{seconds(0.5), seconds(1.5)});
}

TEST_CASE("simultaneous crossings occur in one instant, in order of the events [unit]") {
    Maker m;
    m.event("a");
    m.event("b");
    m.place("p", 1);
    m.t("on_b", {"p"}, {"q"}).events = {{1}};
    m.t("on_a", {"q"}, {"p"}).events = {{0}};
    Equate q;
    const auto x = q.variable("x", -1), y = q.variable("y", 2);
    q.rate(x, X(1));
    q.rate(y, X(-2));
    q.event({0}, var(x), CrossingDirection::kRises);
    q.event({1}, var(y), CrossingDirection::kFalls);
    const net::Net n = timed(m);
    Equations equations({q.s});
    // a comes first and finds nobody; b is taken.
    const Ran ran = play(n, equations, seconds(3));
    CHECK(ran.times == std::vector<SimTime>{seconds(1)});
}

TEST_CASE("difference equations are exact: Fibonacci and the logistic map [oracle]") {
    Maker m;
    m.event("much");
    m.place("p", 1);
    m.t("count", {"p"}, {"p"}).events = {{0}};
    Equate q;
    const auto a = q.variable("a", 0), b = q.variable("b", 1), x = q.variable("x", 0.3);
    q.s.variables[a].next = q.add(var(b));
    q.s.variables[b].next = q.add(var(a) + var(b));
    q.s.variables[x].next = q.add(X(3.9) * var(x) * (X(1) - var(x)));
    for (const auto v : {a, b}) {
        q.s.variables[v].every_ticks = kTicksPerSecond / 10;
    }
    q.s.variables[x].every_ticks = kTicksPerSecond / 24;
    q.event({0}, var(b) - X(1000), CrossingDirection::kRises);
    const net::Net n = timed(m);
    Equations equations({q.s});
    const Ran ran = play(n, equations, seconds(7));
    CHECK(ran.times == std::vector<SimTime>{seconds(1.6)});  // F(17) = 1597 is b after 16 updates
    double f = 0, g = 1;
    for (int k = 1; k <= 70; ++k) {
        const double h = f + g;
        f = g;
        g = h;
        CHECK(equations.value(0, a, SimTime{k * (kTicksPerSecond / 10)}) == f);
    }
    double y = 0.3;
    for (int k = 1; k <= 160; ++k) {
        y = 3.9 * y * (1 - y);
        CHECK(equations.value(0, x, SimTime{k * (kTicksPerSecond / 24)}) == y);
    }
}

TEST_CASE(
    "a delay equation at its Hopf point goes round, below it decays, above it grows [oracle]") {
    const auto amplitude = [](double a, double from, double to) {
        Maker m;
        m.place("p", 1);
        Equate q;
        const auto x = q.variable("x", 1);
        q.rate(x, X(-a) * q.past(x, 1));
        q.s.variables[x].before = q.add(one(ExprOp::kCos, X(3.14159265358979323846 / 2) * time()));
        const net::Net n = timed(m);
        Equations equations({q.s});
        CHECK(play(n, equations, seconds(to)).stop != Stop::kFault);
        // No event asks for it: gone through as far as the run goes.
        net::State state;
        state.counts.resize(1);
        double most = 0;
        for (double t = from; t < to; t += 0.01) {
            most = std::max(most, std::fabs(equations.value(0, x, seconds(t))));
        }
        if (a > 1.57 && a < 1.5708) {  // x = cos(pi t / 2) for ever
            for (double t = 0; t < to; t += 0.37) {
                CHECK(std::fabs(equations.value(0, x, seconds(t)) -
                                std::cos(3.14159265358979323846 / 2 * t)) < 1e-6);
            }
        }
        return most;
    };
    const double hopf = 3.14159265358979323846 / 2;
    CHECK(amplitude(hopf, 36, 40) == doctest::Approx(1).epsilon(1e-5));
    CHECK(amplitude(hopf - 0.1, 36, 40) < 0.5);
    CHECK(amplitude(hopf + 0.1, 36, 40) > 2);
}

TEST_CASE("a delay equation is the polynomials of the method of steps [oracle]") {
    // x' = -x(t - 1), x = 1 before: 1 - t, then 1 - t + (t - 1)^2 / 2, ...
    Maker m;
    m.place("p", 1);
    Equate q;
    const auto x = q.variable("x", 1);
    q.rate(x, X(-1) * q.past(x, 1));
    const net::Net n = timed(m);
    Equations equations({q.s});
    play(n, equations, seconds(6));
    for (double t = 0; t <= 6; t += 0.05) {
        double sum = 1, factorial = 1;
        for (int k = 1; t - (k - 1) > 0; ++k) {
            factorial *= k;
            sum += (k % 2 == 1 ? -1 : 1) * std::pow(t - (k - 1), k) / factorial;
        }
        CHECK(std::fabs(equations.value(0, x, seconds(t)) - sum) < 1e-8);
    }
}

TEST_CASE("an equation that blows up stops the run with time and state [hostile]") {
    Maker m;
    m.place("p", 1, lasts(0.1));
    m.t("tick", {"p"}, {"p"});
    Equate q;
    const auto x = q.variable("x", 1);
    q.rate(x, var(x) * var(x));
    const net::Net n = timed(m);
    Equations equations({q.s});
    const Ran ran = play(n, equations, seconds(5));
    REQUIRE(ran.stop == Stop::kFault);
    CHECK(ran.fault.code == "equations-blow-up");
    CHECK(ran.fault.message.find("x = ") != std::string::npos);
    CHECK(ran.times.size() >= 9);
    CHECK(ran.times.size() <= 10);
}

TEST_CASE("snapshots go on bit for bit, wherever they were taken [law]") {
    // The ball, with a delayed copy of its speed as drag, and ticks that push it.
    Ball ball(2, 0.9);
    ball.m.place("clock", 1, lasts(0.3137));
    ball.m.t("tick", {"clock"}, {"clock"});
    const auto h = 0u, v = 1u;
    ball.q.rate(v, X(-9.81) - X(0.05) * ball.q.past(v, 0.2));
    ball.q.s.resets.push_back({{1}, h, ball.q.add(var(h) + X(0.01))});
    const net::Net n = timed(ball.m);
    Equations whole({ball.q.s});
    Player straight(n, {.coupled = {&whole}});
    straight.run({.until = seconds(4)});
    RandomStream dice{7, 0};
    for (int i = 0; i < 20; ++i) {
        Equations first({ball.q.s}, {.record = i % 2 == 0}), second({ball.q.s});
        Player a(n, {.coupled = {&first}}), b(n, {.coupled = {&second}});
        if (i % 3 == 0) {
            a.run({.firings = 1 + dice.below(15)});
        } else {
            a.run({.until = SimTime{dice.between(0, 3 * kTicksPerSecond)}});
        }
        REQUIRE(b.restore(a.snapshot()));
        CHECK(b.snapshot() == a.snapshot());
        a.run({.until = seconds(4)});
        b.run({.until = seconds(4)});
        CHECK(a.log_hash() == straight.log_hash());
        CHECK(b.log_hash() == straight.log_hash());
        CHECK(second.value(0, h, seconds(4)) == whole.value(0, h, seconds(4)));
        // Damaged bytes change nothing.
        std::vector<std::uint8_t> bytes = a.snapshot();
        bytes.resize(bytes.size() - 1 - dice.below(bytes.size() - 1));
        CHECK_FALSE(b.restore(bytes));
    }
}

TEST_CASE("a sensor is true when its condition is, after jumps and from the start too [unit]") {
    Maker m;
    net::DatumDraft high;
    high.path = "high";
    high.type = {ValueKind::kBool};
    high.sensor = true;
    m.draft.data.push_back(high);
    for (const bool to : {true, false}) {
        m.event(to ? "rises" : "falls");
        m.draft.events.back().sets = {0};
        m.draft.events.back().sets_to = to;
    }
    m.place("clock", 1, lasts(1));
    m.t("kick", {"clock"}, {"clock"});
    Equate q;
    const auto x = q.variable("x", 3);
    q.rate(x, X(-1));  // 3 - t, kicked up by 0.75 each second
    for (const bool rises : {true, false}) {
        q.event({rises ? 0u : 1u}, var(x) - X(2),
                rises ? CrossingDirection::kRises : CrossingDirection::kFalls);
        q.s.events.back().jumps = true;
    }
    q.s.resets.push_back({{0}, x, q.add(var(x) + X(0.75))});
    const net::Net n = timed(m);
    Equations equations({q.s});
    Player p(n, {.coupled = {&equations}});
    for (int i = 1; i < 60; ++i) {
        const SimTime at{i * (kTicksPerSecond / 10) + kTicksPerMillisecond * 7};
        REQUIRE(p.run({.until = at}) == Stop::kLimit);
        CAPTURE(at.seconds());
        CHECK((p.datum({0}) != 0) == (equations.value(0, x, at) > 2));
    }
}

TEST_CASE("van der Pol, stiff, crosses where the explicit method says it does [agree]") {
    const auto times = [](OdeMethod method) {
        Maker m;
        m.event("down");
        m.place("p", 1);
        m.t("count", {"p"}, {"p"}).events = {{0}};
        Equate q;
        const auto x = q.variable("x", 2), y = q.variable("y", 0);
        q.rate(x, var(y));
        q.rate(y, X(50) * (X(1) - var(x) * var(x)) * var(y) - var(x));
        q.event({0}, var(x), CrossingDirection::kFalls);
        q.s.options.method = method;
        q.s.options.relative = 1e-8;
        const net::Net n = timed(m);
        Equations equations({q.s});
        return play(n, equations, seconds(300)).times;
    };
    const auto a = times(OdeMethod::kDormandPrince), b = times(OdeMethod::kRodas);
    REQUIRE(a.size() == 4);  // a period of about 81.4 + ...
    REQUIRE(b.size() == a.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(std::fabs(a[i].seconds() - b[i].seconds()) <= 0.002);
    }
}

}  // namespace
}  // namespace puppetri::run
