// SPDX-License-Identifier: MIT
// Blocks of equations and sensors as authors write them: what they do to the net and to the stage,
// and what is said of wrong ones. The numbers are closed forms.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "files.h"
#include "puppetri/figure/dof.h"
#include "puppetri/scene/perform.h"

using namespace puppetri;
using namespace puppetri::scene;

namespace {

const char* const kHead =
    "language 1\nscene \"equations\"\nuntil 6 s\ncast {\n ana: mannequin\n ball: sphere { at (0, "
    "2.11, 1) m }\n arm: linkage { at (2, 0, 0) m\n link turret { d 0.4 m, alpha 90 deg, turns "
    "-170 .. 170 deg as pan } }\n}\n";

Checked<Scene> loaded(const std::string& text) {
    MemoryFiles files;
    files.add("scene.pup", kHead + text);
    return load(files, "scene.pup");
}
Diagnostics defects(const std::string& text) {
    MemoryFiles files;
    files.add("scene.pup", kHead + text);
    return check(files, "scene.pup");
}

struct Log final : run::LogSink {
    explicit Log(const Scene& s) : scene(s) {}
    void fired(SimTime at, net::TransitionIndex t) override {
        list.emplace_back(std::string(scene.net.transition(t).path), at);
    }
    std::vector<SimTime> of(const std::string& path) const {
        std::vector<SimTime> out;
        for (const auto& [name, at] : list) {
            if (name == path) {
                out.push_back(at);
            }
        }
        return out;
    }
    const Scene& scene;
    std::vector<std::pair<std::string, SimTime>> list;
};

SimTime up_to_ms(double t_s) {
    return {static_cast<std::int64_t>(std::ceil(t_s * 1000 - 1e-3)) * kTicksPerMillisecond};
}

const char* const kBall =
    "equations bounces(what: prop, flies: place, bounce: transition, kept = 0.8) {\n"
    "  h starts at 2 m\n v starts at 0 m/s\n h.rate = v\n v.rate = -9.81 m/s^2\n"
    "  event impact when h falls through 0 m\n on bounce set v := -kept*v\n while flies\n"
    "  what.position = (0 m, h + 0.11 m, 1 m)\n  sensor high when h > 1 m\n}\n"
    "place flying tokens 1\nbounce: flying -> flying on fall.impact\n"
    "use bounces(ball, flying, bounce) as fall\n";

double height_of_ball(double t, double e) {
    double at = std::sqrt(4 / 9.81), speed = 9.81 * at;
    if (t < at) {
        return 2 - 9.81 / 2 * t * t;
    }
    for (;;) {
        speed *= e;
        const double flight = 2 * speed / 9.81;
        if (t < at + flight) {
            return speed * (t - at) - 9.81 / 2 * (t - at) * (t - at);
        }
        at += flight;
    }
}

}  // namespace

TEST_CASE("a ball bounces in the net and on the stage at its closed-form times [oracle]") {
    const Scene scene = must(loaded(kBall));
    Log log(scene);
    const auto done =
        perform(scene, {.horizon = {.time = SimTime{5 * kTicksPerSecond}}, .sink = &log});
    REQUIRE(done);
    CHECK_FALSE(done->fault.has_value());
    std::vector<SimTime> truth;
    double flight = 2 * std::sqrt(4 / 9.81);
    for (double t = flight / 2; t < 5; flight *= 0.8, t += flight) {
        truth.push_back(up_to_ms(t));
    }
    CHECK(log.of("bounce") == truth);
    for (double t = 0; t < 5; t += 0.0173) {
        const Transform ball = done->performance->world_from_prop(
            {0}, SimTime{static_cast<std::int64_t>(t * kTicksPerSecond)});
        CHECK(std::fabs(ball.translation.y - 0.11 - height_of_ball(t, 0.8)) < 1e-6);
    }
}

TEST_CASE("a sensor of equations and one of figures say the same of the same thing [agree]") {
    // The ball is above 1 m: by its equations, and by where the stage has it.
    const Scene scene = must(loaded(std::string(kBall) +
                                    "data a: 0 .. 50 = 0\ndata b: 0 .. 50 = 0\nplace p tokens 1\n"
                                    "place q\nplace r tokens 1\nplace s\n"
                                    "up: p -> q when fall.high set a := a + 1\n"
                                    "down: q -> p when not fall.high\n"
                                    "rises: r -> s when height(ball) > 1.11 m set b := b + 1\n"
                                    "sinks: s -> r when not (height(ball) > 1.11 m)\n"));
    CHECK(scene.sensors.size() == 1);
    Log log(scene);
    const auto done = perform(scene, {.sink = &log});
    REQUIRE(done);
    const auto up = log.of("up"), down = log.of("down");
    const auto rises = log.of("rises"), sinks = log.of("sinks");
    REQUIRE(up.size() >= 2);
    REQUIRE(up.size() == rises.size());
    REQUIRE(down.size() == sinks.size());
    CHECK(up[0].ticks == 0);
    CHECK(rises[0] == SimTime{kTicksPerMillisecond});  // from the start: a millisecond later
    CHECK(std::equal(up.begin() + 1, up.end(), rises.begin() + 1));
    CHECK(down == sinks);
    CHECK(down[0] == up_to_ms(std::sqrt(2 / 9.81)));
}

TEST_CASE("a hand crosses a height at the root of its motion, and no frame decides when [unit]") {
    const auto when = [](const char* frames) {
        const Scene scene =
            must(loaded(std::string(frames) +
                        "place a does ana.wave(times: 2) tokens 1\nplace b\n"
                        "data n: 0 .. 99 = 0\nplace low tokens 1\nplace up\n"
                        "done: a -> b\n"
                        "lift: low -> up when height(ana.right_hand) > 1.2 m\n"
                        "sink: up -> low when not (height(ana.right_hand) > 1.2 m)\n"
                        "end { b }\n"));
        Log log(scene);
        const auto done = perform(scene, {.sink = &log});
        REQUIRE(done);
        const auto lift = log.of("lift");
        REQUIRE(lift.size() >= 1);
        // Where the hand is then, on the performance: at the height, to the millisecond.
        figure::Pose pose;
        const auto height = [&](SimTime t) {
            done->performance->pose({0}, t, pose);
            const figure::Skeleton& s = *done->performance->actors()[0].skeleton;
            std::vector<Transform> world(s.joints.size());
            to_model_space(s, pose, world);
            return world[s.find("rightHand").value].translation.y;
        };
        CHECK(height(lift[0]) > 1.2);
        CHECK(height(lift[0] - SimTime{kTicksPerMillisecond}) <= 1.2);
        return lift[0];
    };
    CHECK(when("") == when("frames 60 per second\n"));
}

TEST_CASE("joints of figures follow variables, over whatever else the figure does [unit]") {
    const Scene scene = must(loaded(
        "equations swing(who: actor, machine: actor) {\n phase starts at 0 rad\n phase.rate = 90 "
        "deg/s\n who.right_elbow.flex = 60 deg + 30 deg*sin(phase)\n"
        " machine.turret.pan = phase/2\n}\nuse swing(ana, arm)\n"
        "place a does ana.face(90 deg) takes 2 s tokens 1\nplace b\nab: a -> b\nend { b }\n"));
    const auto done = perform(scene);
    REQUIRE(done);
    figure::Pose pose;
    for (double t = 0; t < 3.7; t += 0.31) {  // then the joint's range ends
        const SimTime at{static_cast<std::int64_t>(t * kTicksPerSecond)};
        const auto value = [&](std::uint32_t actor, const char* name, const figure::DofSet& dofs) {
            done->performance->pose({actor}, at, pose);
            const figure::Skeleton& s = *done->performance->actors()[actor].skeleton;
            const figure::DofIndex dof = dofs.find(name);
            REQUIRE(dof.valid());
            const auto joint = dofs.dofs[dof.value].joint;
            const auto range = dofs.of_joint(joint);
            std::vector<double> values(range.count);
            figure::values_of({dofs.dofs.data() + range.first, range.count},
                              s.joints[joint.value].parent_from_joint_rest,
                              pose.parent_from_joint[joint.value], values);
            return values[dof.value - range.first];
        };
        static const figure::DofSet humanoid = figure::humanoid_dofs(figure::make_mannequin(1.75));
        const double pi = 3.14159265358979;
        CHECK(std::fabs(value(0, "right_elbow.flex", humanoid) -
                        (pi / 3 + pi / 6 * std::sin(pi / 2 * t))) < 1e-6);
        CHECK(std::fabs(value(1, "turret.pan", scene.play.cast.actors[1].character->dofs) -
                        pi / 4 * t) < 1e-6);
    }
}

TEST_CASE("data that firings change are seen from then on [oracle]") {
    const Scene scene = must(loaded(
        "data pull: int = 0\nequations cart(f: data) {\n x starts at 0 m\n v starts at 0 m/s\n"
        " x.rate = v\n v.rate = f*1 m/s^2\n event there when x rises through 1 m\n}\n"
        "use cart(pull) as c\nplace a takes 1.5 s tokens 1\nplace b\nplace d\n"
        "go: a -> b set pull := 2\nstop: b -> d on c.there\nend { d }\n"));
    Log log(scene);
    REQUIRE(perform(scene, {.sink = &log}));
    CHECK(log.of("stop") == std::vector<SimTime>{up_to_ms(1.5 + 1)});
}

TEST_CASE("delays and difference equations of the language are their closed forms [oracle]") {
    const Scene scene = must(loaded(
        "equations e() {\n x starts at 1\n x.rate = -1 Hz*past(x, 1 s)\n a starts at 0\n b starts "
        "at 1\n a.next = b every 0.1 s\n b.next = a + b every 0.1 s\n"
        " event zero when x falls through 0\n event big when b rises through 1000\n"
        " event low when x falls through -0.4\n}\n"
        "use e() as q\nplace p tokens 3\nplace r\nz: p -> r on q.zero\nf: p -> r on q.big\n"
        "l: p -> r on q.low\n"));
    Log log(scene);
    REQUIRE(perform(scene, {.sink = &log}));
    CHECK(log.of("z") == std::vector<SimTime>{SimTime{kTicksPerSecond}});  // 1 - t
    CHECK(log.of("f") == std::vector<SimTime>{up_to_ms(1.6)});
    // 1 - t + (t - 1)^2 / 2 = -0.4
    CHECK(log.of("l") == std::vector<SimTime>{up_to_ms(2 - std::sqrt(0.2))});
}

TEST_CASE("the solution that ends stops the run with time and state [hostile]") {
    const Scene scene =
        must(loaded("equations e() {\n x starts at 1\n x.rate = 1 Hz*x^2\n}\nuse e() as q\n"
                    "place p takes 0.3 s tokens 1\nt: p -> p\n"));
    const auto done = perform(scene);
    REQUIRE(done);
    REQUIRE(done->fault.has_value());
    CHECK(done->fault->code == "equations-blow-up");
    CHECK(done->fault->where.line == 10);
    CHECK(done->fault->message.find("x = ") != std::string::npos);
    CHECK_FALSE(done->fault->remedy.empty());
}

TEST_CASE("what is wrong with equations is told at its place, with a remedy [hostile]") {
    const auto refuses = [](const std::string& lines, const char* code,
                            const std::string& more = "") {
        const Diagnostics list =
            defects("place p tokens 1\nt: p -> p on q.hit\nequations e(k = 1 m) {\n" + lines +
                    "\n event hit when k falls through 0 m\n}\nuse e() as q\n" + more);
        const bool found = std::any_of(list.begin(), list.end(), [&](const Diagnostic& d) {
            return d.code == code && d.severity == Severity::kError && d.where.line > 0 &&
                   !d.remedy.empty();
        });
        CHECK_MESSAGE(found, lines << more << " gives " << told(list));
    };
    refuses("x starts at 1 m\n x.rate = 2 m", "wrong-unit");
    refuses("x starts at 1 m\n x.rate = y/1 s", "unknown-name");
    refuses("x.rate = 1 m/s", "no-start");
    refuses("x starts at 1 m\n x.rate = 1 m/s\n x.rate = 2 m/s", "name-twice");
    refuses("x starts at 1 m\n x starts at 2 m", "name-twice");
    refuses("x starts at 1 m\n x.rate = past(x, 0 s)/1 s", "out-of-range");
    refuses("x starts at 1 m\n x.next = x every 0 s", "out-of-range");
    refuses("x starts at 1 m\n event far when x falls through 1 s", "wrong-unit");
    refuses("x starts at 1 m\n on hit set x := 0 m", "wrong-type");
    refuses("x starts at 1 m\n while k", "wrong-unit");
    refuses("x begins at 1 m", "syntax");
    refuses("x starts at 1 m\n ball.position = (1 s, x, x)", "wrong-unit");
    refuses("x starts at 1\n ana.right_wing.flex = x", "unknown-name");
    refuses("x starts at 1\n tolerance 2", "out-of-range");
    refuses("x starts at 1 m\n x.before = k*x/1 m", "wrong-type");
    // Nets speak through crossings.
    refuses("x starts at 1 m\n x.rate = 1 m/s", "continuous-variable",
            "place r tokens 1\nu: r -> r when q.x > 1 after 1 s\n");
    // Sensors.
    refuses("x starts at 1 m", "wrong-unit",
            "place r tokens 1\nplace s\nu: r -> s when height(ball) > 1 s\n");
    refuses("x starts at 1 m", "unknown-name",
            "place r tokens 1\nplace s\nu: r -> s when height(ana.wing) > 1 m\n");
    refuses("x starts at 1 m", "wrong-type",
            "place r tokens 1\nplace s\nu: r -> s when height(ball) = 1 m\n");
    refuses("x starts at 1 m", "missing-argument",
            "place r tokens 1\nplace s\nu: r -> s when distance(ball) < 1 m\n");
}

TEST_CASE(
    "in the example Ana waves at the third bounce, and the ball lies after the twelfth [oracle]") {
    const Scene scene = example("20_equations/bounce.pup");
    Log log(scene);
    const auto done = perform(scene, {.sink = &log});
    REQUIRE(done);
    CHECK_FALSE(done->fault.has_value());
    double t = std::sqrt(4 / 9.81), flight = 2 * t;
    std::vector<SimTime> bounces;
    for (int k = 0; k < 12; ++k, flight *= 0.8, t += flight) {
        bounces.push_back(up_to_ms(t));
    }
    CHECK(log.of("bounce") == bounces);
    CHECK(log.of("greet") == std::vector<SimTime>{bounces[2]});
    CHECK(log.of("settle") == std::vector<SimTime>{bounces[11]});
    // It lies where it was put down, on the floor.
    CHECK(std::fabs(done->performance->world_from_prop({0}, done->end).translation.y - 0.12) <
          1e-9);
}
