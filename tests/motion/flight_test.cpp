// SPDX-License-Identifier: MIT
// A ball flies as Galilei says, and comes to rest on the floor where nobody catches it.
#include "puppetri/motion/flight.h"

#include "doctest/doctest.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {
Flight flight_over(Vec3 from, Vec3 to) {
    Flight f;
    f.start = {3 * kTicksPerSecond};
    f.duration = flight_duration(from, to);
    f.start_world = from;
    f.velocity_world = launch_velocity(from, to, f.duration);
    f.radius_m = 0.11;
    return f;
}
}  // namespace

TEST_CASE("a flight over d lasts sqrt(2 d / g), a whole millisecond rounded up [oracle]") {
    for (double d : {0.5, 2.1, 3.0, 6.0}) {
        const SimTime t = flight_duration({0, 1, 0}, {d * 0.6, 1, d * 0.8});
        CHECK(t.ticks % kTicksPerMillisecond == 0);
        CHECK(t.seconds() >= std::sqrt(2 * d / 9.80665) - 1e-12);
        CHECK(t.seconds() < std::sqrt(2 * d / 9.80665) + 0.001);
        // ... which is 45 degrees between equal heights, with v = sqrt(g d)
        const Vec3 v = launch_velocity({0, 1, 0}, {d * 0.6, 1, d * 0.8}, t);
        CHECK(v.y == doctest::Approx(std::sqrt(v.x * v.x + v.z * v.z)).epsilon(0.005));
        CHECK(length(v) == doctest::Approx(std::sqrt(9.80665 * d)).epsilon(0.005));
    }
    CHECK(flight_duration({1, 1, 1}, {1, 2, 1}).ticks == kTicksPerMillisecond);
}

TEST_CASE("a flight is a parabola that arrives when and where it says [oracle]") {
    const Vec3 from{-1.2, 1.0, 0.3}, to{1.1, 1.2, 0.5};
    const Flight f = flight_over(from, to);
    CHECK(length(f.position(f.start) - from) == 0);
    CHECK(length(f.position(f.start + f.duration) - to) < 1e-9);
    const SimTime tick{kTicksPerSecond / 480};
    const double h = tick.seconds();
    for (SimTime t = f.start + tick; t < f.start + f.duration - tick; t = t + tick) {
        const Vec3 a =
            (f.position(t + tick) - f.position(t) * 2 + f.position(t - tick)) * (1 / (h * h));
        CHECK(length(a - Vec3{0, -9.80665, 0}) < 1e-8);
    }
}

TEST_CASE("a ball that nobody catches bounces lower and lower and lies on the floor [law]") {
    const Flight f = flight_over({-1.2, 1.0, 0}, {1.1, 1.2, 0});
    const SimTime rest = f.rest();
    CHECK(rest > f.start + f.duration);
    CHECK(rest < f.start + SimTime{10 * kTicksPerSecond});
    CHECK(f.position(rest).y == doctest::Approx(0.11));
    CHECK(f.position(rest + SimTime{kTicksPerSecond}) == f.position(rest));
    CHECK(f.velocity(rest) == Vec3{});
    CHECK(f.rotation(rest) == f.rotation(rest + SimTime{kTicksPerSecond}));
    Vec3 before = f.start_world;
    for (std::int64_t ms = 0; ms <= 8000; ++ms) {
        const Vec3 p = f.position(f.start + SimTime{ms * kTicksPerMillisecond});
        CHECK(p.y > 0.11 - 1e-9);
        CHECK(length(p - before) < 0.008);  // 8 m/s: no jump
        before = p;
    }
}
