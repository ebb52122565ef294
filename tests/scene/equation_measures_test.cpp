// SPDX-License-Identifier: MIT
// Measures of variables of equations and of their parts, against closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "files.h"
#include "puppetri/run/player.h"
#include "puppetri/scene/beside.h"
#include "puppetri/sim/meter.h"
#include "puppetri/stage/stage.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

constexpr double kG = 9.81;

const char* const kAll = R"(language 1
scene "Everything that goes on"
until 6 s

equations decays {
  x starts at 1
  x.rate = -x/2 s
}
equations swings {
  x starts at 1 m
  v starts at 0 m/s
  x.rate = v
  v.rate = -4*x/1 s^2
  energy = v*v/2 + 2*x*x/1 s^2
  square = x*x
  right  = x > 0 m ? 1 : 0
  wave   = sin(20*t/1 s)
}
equations bounces(flies: place, bounce: transition) {
  h starts at 2 m
  v starts at 0 m/s
  h.rate = v
  v.rate = -9.81 m/s^2
  event impact when h falls through 0 m
  on bounce set v := -0.9*v
  while flies
}
equations doubles {
  x starts at 1
  x.next = 2*x every 1 s
}
equations climbs(up: place) {
  angle starts at 0 rad
  angle.rate = 1 rad/s
  while up
}

place flying tokens 1
bounce: flying -> flying on fall.impact
place up takes 2 s tokens 1
place down
stop: up -> down

use decays                  as d
use swings                  as s
use bounces(flying, bounce) as fall
use doubles                 as twice
use climbs(up)              as climb

measure d_mean    mean of d.x
measure d_total   total of d.x
measure d_final   final of d.x
measure d_most    most of d.x
measure d_least   least of d.x
measure s_mean    mean of s.x
measure s_most    most of s.x
measure s_least   least of s.x
measure energy    mean of s.energy
measure strongest most of s.energy
measure weakest   least of s.energy
measure square    mean of s.square
measure smallest  least of s.square
measure right     mean of s.right
measure wave      mean of s.wave
measure h_mean    mean of fall.h
measure h_most    most of fall.h
measure h_least   least of fall.h
measure fastest   most of fall.v
measure stairs    mean of twice.x
measure top       final of twice.x
measure climbed   mean of climb.angle
measure lifted    total of climb.angle
measure bounces   count of bounce
)";

Scene load_text(const std::string& text) {
    MemoryFiles files;
    files.add("scene.pup", text);
    auto loaded = load(files, "scene.pup");
    REQUIRE_MESSAGE(loaded.has_value(), (loaded ? "" : told(loaded.error())));
    return std::move(*loaded);
}

struct Measured {
    std::map<std::string, double> value;
    std::map<std::string, std::string> unit;
    std::uint64_t hash = 0;
};

// The numbers of from .. 6 s, and of a run that is measured in parts that begin at `cuts`, those of
// the last.
Measured measured(const Scene& scene, SimTime from, std::vector<SimTime> cuts = {}) {
    Beside beside(scene);
    stage::Stage stage(scene.play, beside.quantities());
    const auto metrics = sim::declared_metrics(scene.net);
    sim::Meter meter(scene.net, metrics, {.from = from});
    run::Player player(scene.net,
                       {.host = &stage, .observer = &meter, .coupled = beside.coupled(stage)});
    std::vector<double> values(metrics.size());
    for (const SimTime cut : cuts) {
        player.run({.until = cut});
        meter.finish(cut, values);
    }
    player.run({.until = SimTime{6 * kTicksPerSecond}});
    meter.finish(player.now(), values);
    CHECK_FALSE(meter.fault().has_value());
    Measured out{.hash = player.log_hash()};
    for (std::size_t i = 0; i < metrics.size(); ++i) {
        out.value[sim::name_of(scene.net, metrics[i])] = values[i];
        out.unit[sim::name_of(scene.net, metrics[i])] = sim::unit_of(scene.net, metrics[i]);
    }
    return out;
}

// Height of the ball, summed over a .. b, and the highest.
struct Ball {
    double sum = 0, most = 0;
};
Ball ball(double a, double b) {
    // From a root on, upward with speed v; the first arc began before 0 at its root
    Ball out;
    double v = std::sqrt(2 * kG * 2), at = -v / kG;
    while (at < b) {
        const double end = at + 2 * v / kG, from = std::max(a, at), to = std::min(b, end);
        if (from < to) {
            const auto integral = [&](double t) {
                const double u = t - at;
                return v * u * u / 2 - kG * u * u * u / 6;
            };
            const auto height = [&](double t) {
                return v * (t - at) - kG * (t - at) * (t - at) / 2;
            };
            const double peak = at + v / kG;
            out.sum += integral(to) - integral(from);
            out.most = std::max({out.most, height(from), height(to),
                                 peak >= from && peak <= to ? height(peak) : 0.0});
        }
        at = end;
        v *= 0.9;
    }
    return out;
}

}  // namespace

TEST_CASE("means, extremes, integrals and ends of what goes on beside the net are closed forms") {
    const Scene scene = load_text(kAll);
    Measured m = measured(scene, SimTime{0});
    const auto near = [&](const char* name, double truth, double within = 1e-8) {
        CAPTURE(name);
        REQUIRE(m.value.count(name) == 1);
        CHECK(std::abs(m.value[name] - truth) <= within * std::max(1.0, std::abs(truth)));
    };
    near("d_mean", 2 * (1 - std::exp(-3)) / 6);
    near("d_total", 2 * (1 - std::exp(-3)));
    near("d_final", std::exp(-3));
    near("d_most", 1);
    near("d_least", std::exp(-3));
    near("s_mean", std::sin(12) / 12);
    near("s_most", 1);
    near("s_least", -1);
    near("energy", 2);
    near("strongest", 2);
    near("weakest", 2);
    near("square", 0.5 + std::sin(24) / 48);
    near("smallest", 0);
    near("right", (kPi / 4 + kPi / 2 + 6 - 7 * kPi / 4) / 6, 1e-6);
    near("wave", (1 - std::cos(120)) / 120);
    near("h_mean", ball(0, 6).sum / 6);
    near("h_most", 2);
    near("h_least", 0);
    near("fastest", 0.9 * std::sqrt(2 * kG * 2));
    near("stairs", 63.0 / 6);
    near("top", 64);
    near("climbed", (2 + 2 * 4) / 6.0);
    near("lifted", 2 + 2 * 4);
    CHECK(m.unit["d_mean"] == "");
    CHECK(m.unit["d_total"] == "s");
    CHECK(m.unit["s_mean"] == "m");
    CHECK(m.unit["energy"] == "m^2/s^2");
    CHECK(m.unit["fastest"] == "m/s");
    CHECK(m.unit["bounces"] == "");
}

TEST_CASE("after a warm-up, and part by part, they are those of the time since") {
    const Scene scene = load_text(kAll);
    const Measured warm = measured(scene, SimTime{kTicksPerSecond}),
                   last = measured(scene, SimTime{0},
                                   {SimTime{kTicksPerSecond / 2}, SimTime{kTicksPerSecond}});
    for (const Measured& m : {warm, last}) {
        CHECK(m.value.at("h_mean") == doctest::Approx(ball(1, 6).sum / 5).epsilon(1e-8));
        CHECK(m.value.at("h_most") == doctest::Approx(2 * 0.81).epsilon(1e-8));
        CHECK(m.value.at("d_mean") ==
              doctest::Approx(2 * (std::exp(-0.5) - std::exp(-3)) / 5).epsilon(1e-8));
        CHECK(m.value.at("climbed") == doctest::Approx((1.5 + 2 * 4) / 5).epsilon(1e-8));
    }
}

TEST_CASE("measuring equations changes nothing of the run") {
    const std::string text = kAll;
    const Scene all = load_text(text), none = load_text(text.substr(0, text.find("measure ")));
    CHECK(all.net.hash() == none.net.hash());
    CHECK(measured(all, SimTime{0}).hash == measured(none, SimTime{0}).hash);
}

TEST_CASE("what cannot be measured of a variable is told with what to write instead") {
    const auto defects = [](const std::string& measure) {
        MemoryFiles files;
        files.add("scene.pup", std::string(kAll) + measure + "\n");
        std::string text;
        for (const Diagnostic& d : check(files, "scene.pup")) {
            text += d.code + ": " + d.message + " " + d.remedy + "\n";
        }
        return text;
    };
    CHECK(defects("measure a share of s.x").find("sensor") != std::string::npos);
    CHECK(defects("measure a count of s.x").find("wrong-form") != std::string::npos);
    CHECK(defects("measure a percentile 90 of s.x").find("wrong-form") != std::string::npos);
    CHECK(defects("measure a mean of s.y").find("unknown") != std::string::npos);
    CHECK(defects("measure a mean of 2*s.x").find("a name in the block") != std::string::npos);
    CHECK(defects("measure a mean of flying.x") != "");
    CHECK(defects("measure a mean of s.x") == "");
}
