// SPDX-License-Identifier: MIT
// Every movement of the library, prepared with its defaults, keeps what its row in the table
// promises.
#include "puppetri/motion/prepare.h"

#include <cstdlib>
#include <string>

#include "doctest/doctest.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/declared_duration.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/library.h"

using namespace puppetri;
using namespace puppetri::motion;

namespace {

constexpr double kRadius_m = 0.11;

// Two figures that face each other over 3 m; the first holds the ball.
struct Scene {
    figure::Figure figure = figure::make_mannequin(1.75);
    std::vector<ActorState> actors;
    std::vector<PropState> props;
    std::vector<SetState> sets{{{0, 0, 0}, 0.4}};

    Scene() {
        for (int i = 0; i < 2; ++i) {
            const double x = i == 0 ? -1.5 : 1.5;
            actors.push_back(
                {&figure, standing(figure, {x, 0, 0}, i == 0 ? kPi / 2 : -kPi / 2), {}});
        }
        const Transform ball = carried_ball_chest(figure, ball_grip(kRadius_m));
        lay_hands(figure, ball, ball_grip(kRadius_m), 0, actors[0].controls);
        props.push_back({(world_from_chest(figure, actors[0].controls) * ball).translation,
                         ball_grip(kRadius_m), ActorIndex{0}});
    }
    MotionContext context(int who, SimTime duration = {-1}) const {
        return {figure,   actors[static_cast<std::size_t>(who)].controls,
                {},       SimTime{kTicksPerSecond},
                duration, 5};
    }
    Surroundings around(std::uint32_t who) const {
        return {actors, props, sets, ActorIndex{who}, who == 0 ? PropIndex{0} : PropIndex{}};
    }
};

// The call with nothing but what must be given. fly has no actor and is prepared by the stage.
BoundCall call_of(const MovementSignature& signature) {
    BoundCall call;
    call.movement = signature.name;
    call.subject.kind = signature.subject;
    call.subject.actor = ActorIndex{0};
    for (int i = kLimbCount - 1; i >= 0; --i) {
        if (signature.on_limbs.has(static_cast<Limb>(i))) {
            call.subject.limb = static_cast<Limb>(i);
        }
    }
    for (const Parameter& p : signature.parameters) {
        if (p.optional || !p.default_text.empty()) {
            continue;
        }
        ArgumentValue value = Side::kLeft;
        if (p.types.has(ParameterType::kActor)) {
            value = ActorIndex{1};
        } else if (p.types.has(ParameterType::kProp)) {
            value = PropIndex{0};
        }
        call.arguments.push_back({std::string(p.name), value});
    }
    return call;
}

bool holds_ball(const MovementSignature& m) {
    return m.name == "throw" || m.name == "carry" || m.name == "hold" || m.name == "face" ||
           m.name == "step";
}

}  // namespace

TEST_CASE("every movement prepares with its defaults, inside its interval, on its limbs [law]") {
    const Scene scene;
    for (const MovementSignature& m : movement_library()) {
        if (m.subject == SubjectKind::kProp ||
            m.name == "catch") {  // catch needs hands on a flying ball
            continue;
        }
        CAPTURE(m.name);
        const std::uint32_t who = holds_ball(m) ? 0 : 1;
        BoundCall call = call_of(m);
        if (who == 1) {
            for (Argument& a : call.arguments) {
                if (std::holds_alternative<ActorIndex>(a.value)) {
                    a.value = ActorIndex{0};
                }
            }
        }
        const MotionContext context = scene.context(static_cast<int>(who));
        Diagnostics notes;
        const Prepared prepared = prepare(call, context, scene.around(who), notes);
        // These want a thing within reach, or somebody near.
        CHECK((notes.empty() || m.name == "pick_up" || m.name == "hand_over" || m.name == "hug" ||
               m.name == "take" || m.name == "lay"));
        const Movement& movement = *prepared.movement;
        CHECK(movement.duration >= m.shortest);
        CHECK(movement.duration <= m.longest);
        CHECK(movement.duration.ticks % kTicksPerMillisecond == 0);
        const LimbSet expected{static_cast<std::uint8_t>(
            m.limbs.bits |
            (m.subject == SubjectKind::kLimb ? 1 << static_cast<int>(call.subject.limb) : 0))};
        if (m.name == "reach" || m.name == "point" || m.name == "aim" || m.name == "eat" ||
            m.name == "take" || m.name == "lay") {
            CHECK((movement.limbs.bits & ~expected.bits) == 0);  // one hand
        } else {
            CHECK(movement.limbs == expected);
        }
        // It starts where the figure is.
        Controls start = context.now;
        movement.sample(0, start);
        CHECK(length(start.pelvis.position_world - context.now.pelvis.position_world) < 1e-6);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            CHECK(length(world_from_hand(scene.figure, start, side).translation -
                         world_from_hand(scene.figure, context.now, side).translation) < 1e-6);
            CHECK(length(start.legs[index_of(side)].ankle_world -
                         context.now.legs[index_of(side)].ankle_world) < 1e-6);
        }
        for (std::size_t i = 1; i < movement.events.size(); ++i) {
            CHECK(movement.events[i - 1].after_start <= movement.events[i].after_start);
        }
        for (const MovementEvent& event : movement.events) {
            CHECK(event.after_start <= movement.duration);
        }
    }
}

TEST_CASE("`takes auto` is what the call declares, whatever its arguments and the state [law]") {
    Scene scene;
    for (int k = 0; k < 24; ++k) {
        // From any heading and place, with and without the ball.
        const Vec3 place{-1.5 + 0.1 * k, 0, 0.3 * (k % 5)};
        scene.actors[1].controls = standing(scene.figure, place, 0.5 * k);
        for (const MovementSignature& m : movement_library()) {
            if (m.subject == SubjectKind::kProp || m.name == "catch") {
                continue;
            }
            CAPTURE(m.name);
            CAPTURE(k);
            BoundCall call = call_of(m);
            for (const Parameter& p : m.parameters) {
                if (p.name == "by") {
                    call.arguments.push_back({"by", 0.7 * k - 8});
                } else if (p.name == "lasting") {
                    call.arguments.push_back({"lasting", 0.37 * k - 1});
                } else if (p.name == "steps") {
                    call.arguments.push_back({"steps", std::int64_t{k - 1}});
                } else if (p.name == "half") {
                    call.arguments.push_back({"half", k % 2 == 0});
                }
            }
            const DurationRange declared = declared_duration(call);
            CHECK(declared.shortest >= m.shortest);
            CHECK(declared.longest <= m.longest);
            for (const std::uint32_t who : {0u, 1u}) {
                Diagnostics notes;
                const Prepared prepared =
                    prepare(call, scene.context(static_cast<int>(who)), scene.around(who), notes);
                CHECK(declared.has(prepared.movement->duration));
                CHECK(prepared.movement->duration.ticks % kTicksPerMillisecond == 0);
            }
        }
    }
}

TEST_CASE("what always takes the same time declares one number [unit]") {
    auto declared = [](const char* name, std::vector<Argument> arguments) {
        BoundCall call;
        call.movement = name;
        call.arguments = std::move(arguments);
        return declared_duration(call);
    };
    auto ms = [](std::int64_t n) { return SimTime{n * kTicksPerMillisecond}; };
    CHECK(declared("idle", {{"lasting", 2.5}}) == DurationRange{ms(2500), ms(2500)});
    CHECK(declared("walk", {{"steps", std::int64_t{3}}}) == DurationRange{ms(2502), ms(2502)});
    const DurationRange any = declared("walk", {{"steps", TokenAttribute{0}}});
    CHECK(any.has(ms(834)));
    CHECK(any.has(ms(834 * 10'000)));
    for (const char* name : {"throw", "catch", "step", "half_step", "carry", "hold", "reach"}) {
        CAPTURE(name);
        CHECK(declared(name, {}).shortest == declared(name, {}).longest);
    }
}

TEST_CASE("a prescribed duration is kept to the tick by every movement [law]") {
    const Scene scene;
    const SimTime odd{kTicksPerSecond * 61 / 97};
    for (const MovementSignature& m : movement_library()) {
        if (m.subject == SubjectKind::kProp || m.name == "catch") {
            continue;
        }
        CAPTURE(m.name);
        const std::uint32_t who = holds_ball(m) ? 0 : 1;
        Diagnostics notes;
        const Prepared prepared = prepare(call_of(m), scene.context(static_cast<int>(who), odd),
                                          scene.around(who), notes);
        CHECK(prepared.movement->duration == odd);
    }
}

TEST_CASE("defaults as text and as numbers say the same [unit]") {
    for (const MovementSignature& m : movement_library()) {
        for (const Parameter& p : m.parameters) {
            if (p.default_text.empty()) {
                continue;
            }
            CAPTURE(m.name);
            CAPTURE(p.name);
            const std::string text(p.default_text);
            double expected = std::atof(text.c_str());
            if (text.find("deg") != std::string::npos) {
                expected *= kPi / 180;
            } else if (p.types.has(ParameterType::kSide)) {
                expected = text == "right" ? 1 : 0;
            } else if (p.types.has(ParameterType::kBool)) {
                expected = text == "yes" ? 1 : 0;
            }
            CHECK(p.default_value == doctest::Approx(expected));
        }
    }
}

TEST_CASE("the ball stays between the hands whatever movement carries it [law]") {
    const Scene scene;
    for (const char* name : {"throw", "carry", "hold", "face", "step"}) {
        CAPTURE(name);
        Diagnostics notes;
        const Prepared prepared = prepare(call_of(*find_movement(name, SubjectKind::kActor)),
                                          scene.context(0), scene.around(0), notes);
        const double end_s = prepared.movement->duration.seconds();
        for (double t = 0; t <= end_s; t += end_s / 50) {
            Controls c = scene.actors[0].controls;
            prepared.movement->sample(t, c);
            const Vec3 left = world_from_palm(scene.figure, c, Side::kLeft).translation,
                       right = world_from_palm(scene.figure, c, Side::kRight).translation;
            const Vec3 ball =
                ball_between(scene.figure, world_from_hand(scene.figure, c, Side::kLeft),
                             world_from_hand(scene.figure, c, Side::kRight), ball_grip(kRadius_m))
                    .translation;
            CHECK(std::fabs(length(left - ball) - kRadius_m) < 1e-9);
            CHECK(std::fabs(length(right - ball) - kRadius_m) < 1e-9);
        }
    }
}
