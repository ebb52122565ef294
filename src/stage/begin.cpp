// SPDX-License-Identifier: MIT
// What happens when a token arrives: a movement is prepared and put in charge of its limbs, or a
// prop begins to fly.
#include <algorithm>

#include "puppetri/math/rotation.h"
#include "puppetri/motion/ball_game.h"
#include "puppetri/motion/handling.h"
#include "puppetri/motion/library.h"
#include "puppetri/motion/turn.h"
#include "stage_data.h"

namespace puppetri::stage {
namespace {

constexpr double kFastFlight_m_s = 9, kFarFlight_m = 6;

// The six charges of an actor as one movement, for what goes on below a movement that the stage
// adds.
class Goes final : public motion::Movement {
 public:
    Goes(const ActorTimeline& timeline, SimTime at, bool before = false) : start_(at) {
        limbs = motion::kAllLimbs;
        for (int i = 0; i < motion::kLimbCount; ++i) {
            const Limb limb = static_cast<Limb>(i);
            Charge charge = timeline.in_charge(limb, at, before);
            charge.from = SimTime{-1};
            timeline_.take(motion::limb_set(limb), charge);
            const SimTime age = at - charge.start;
            for (motion::PhaseSpan span : charge.movement->phases) {
                if (span.limb == limb && age < span.end) {
                    span.begin = std::max(span.begin - age, SimTime{0});
                    span.end = span.end - age;
                    phases.push_back(span);
                }
            }
            for (motion::MovementEvent event : charge.movement->events) {
                if (event.limb == limb && age < event.after_start) {
                    event.after_start = event.after_start - age;
                    events.push_back(event);
                }
            }
        }
        std::stable_sort(events.begin(), events.end(),
                         [](const motion::MovementEvent& a, const motion::MovementEvent& b) {
                             return a.after_start < b.after_start;
                         });
    }
    motion::Stride stride_at(double t_s) const override {
        const Charge& hips = timeline_.in_charge(Limb::kPelvis, start_);
        const double age_s = (start_ - hips.start).seconds();
        motion::Stride stride = hips.movement->stride_at(age_s + t_s);
        stride.end_s -= age_s;
        return stride;
    }
    void sample(double t_s, Controls& out) const override {
        timeline_.sample(start_ + SimTime{static_cast<std::int64_t>(t_s * kTicksPerSecond)}, out);
    }

 private:
    SimTime start_;
    ActorTimeline timeline_;
};

}  // namespace

SimTime Stage::Data::begin_actor(std::uint32_t number, const motion::BoundCall& call,
                                 SimTime duration) {
    Activity& activity = activities[number];
    activity.actor = call.subject.actor;
    PUP_REQUIRE(activity.actor.value < take.actors.size());
    attend(activity.actor, call);
    MotionContext context = context_of(activity.actor, now, duration);
    const ActorTimeline& timeline = take.actors[activity.actor.value].timeline;
    const Charge& hips = timeline.in_charge(Limb::kPelvis, now, true);
    if (hips.movement->stride_at((now - hips.start).seconds()).under_way) {
        context.onward = std::make_shared<Goes>(timeline, now, true);
    }
    const Seen seen = look_around(now, activity.actor);
    const motion::Surroundings around{seen.actors, seen.props, seen.sets, activity.actor,
                                      held_by(activity.actor, now)};
    Diagnostics notes;
    const motion::Prepared prepared = motion::prepare(call, context, around, notes);
    report(activity.action, notes);
    activity.movement = prepared.movement;
    const LimbSet limbs = activity.movement->limbs;
    for (const std::uint32_t other : running) {
        const Activity& a = activities[other];
        if (a.actor == activity.actor && a.movement != nullptr &&
            (a.movement->limbs.bits & limbs.bits) != 0) {
            overlaps.push_back({other, number});
        }
    }
    running.push_back(number);
    take_limbs(activity.actor, limbs, activity.movement, number);
    if (limbs.has(Limb::kBody) || prepared.gaze.kind != motion::GazeKind::kOwn) {
        take.actors[activity.actor.value].gazes.push_back({now, prepared.gaze});
    }
    Waiting& wait = waiting[activity.actor.value];
    if (prepared.catches_at_world) {
        wait = {prepared.prop, *prepared.catches_at_world, number};
    } else if (limbs.has(Limb::kLeftArm) || limbs.has(Limb::kRightArm)) {
        wait = {};
    }
    if (prepared.takes_prop) {
        PropTimeline& line = take.props[prepared.prop.value];
        const Transform prop = take.world_from_prop(prepared.prop, now, true);
        const motion::Grip grip = take.grip(prepared.prop, activity.actor, now, true);
        const Transform hands = take.between_hands(activity.actor, grip, now);
        line.take({.from = now,
                   .kind = Holding::kHands,
                   .actor = activity.actor,
                   .hands_from_prop = normalized(conjugate(hands.rotation) * prop.rotation),
                   .grip = grip});
    }
    if (prepared.grasps_after.ticks >= 0) {
        const bool gives = prepared.gives_to.valid();
        const Grasp grasp{now + prepared.grasps_after, number,
                          gives ? prepared.gives_to : activity.actor, prepared.prop};
        add_grasp(grasp);
        if (gives) {
            receive_from_hands(grasp, prepared.meeting_world);
        }
    }
    for (const auto& [after, lays] :
         {std::pair(prepared.takes_after, false), std::pair(prepared.lays_after, true)}) {
        if (after.ticks >= 0) {
            add_grasp(
                {now + after, number, activity.actor, prepared.prop, prepared.one_hand, lays});
        }
    }
    if (prepared.releases_prop) {
        activity.releases = prepared.prop;
        const Release release{now + activity.movement->duration, number};
        releases.insert(
            std::upper_bound(releases.begin(), releases.end(), release,
                             [](const Release& a, const Release& b) { return a.at < b.at; }),
            release);
    }
    ScoreEntry& row = take.score[activity.row];
    row.actor = play.cast.actors[activity.actor.value].name;
    row.limbs = limbs;
    row.prop = prepared.prop.valid() ? play.cast.props[prepared.prop.value].name : "";
    return activity.movement->duration;
}

// Who is given a ball takes it, whatever trunk and legs do meanwhile.
void Stage::Data::receive_from_hands(const Grasp& grasp, Vec3 meeting_world) {
    const std::uint32_t owner =
        take.actors[grasp.actor.value].timeline.in_charge(Limb::kLeftArm, now).owner;
    constexpr double kRoll_rad = 0.66;  // between the hands of the other
    const Activity& gives = activities[grasp.activity];
    motion::Grip offered = take.grip(grasp.prop, gives.actor, now, true);
    Controls giver;
    take.actors[gives.actor.value].timeline.sample(now, giver, true);
    offered.yaw_rad = heading_of(giver.pelvis.rotation_world) + kPi;  // square to it
    take_limbs(grasp.actor, motion::kBothArms,
               motion::make_take(context_of(grasp.actor, now, SimTime{-1}),
                                 {.grip = offered,
                                  .ball_world = meeting_world,
                                  .grasps_s = (grasp.at - now).seconds(),
                                  .roll_rad = offered.flat ? 0 : kRoll_rad}),
               owner);
}

// No leg will be off the floor from now on.
bool Stage::Data::planted(ActorIndex actor) const {
    const ActorTimeline& timeline = take.actors[actor.value].timeline;
    for (const Limb leg : {Limb::kLeftLeg, Limb::kRightLeg}) {
        const Charge& charge = timeline.in_charge(leg, now);
        for (const motion::PhaseSpan& span : charge.movement->phases) {
            if (span.limb == leg && span.phase == motion::Phase::kSwing &&
                charge.start + span.end > now) {
                return false;
            }
        }
    }
    return true;
}

SimTime Stage::Data::begin_flight(std::uint32_t number, const motion::BoundCall& call,
                                  SimTime duration) {
    Activity& activity = activities[number];
    const PropIndex prop = call.subject.prop;
    PUP_REQUIRE(prop.value < take.props.size());
    const Transform from = take.world_from_prop(prop, now, true);
    const motion::ArgumentValue* to = call.find("to");
    PUP_REQUIRE(to != nullptr);
    const ActorIndex* catcher = std::get_if<ActorIndex>(to);
    Vec3 target;
    if (catcher == nullptr) {
        target = std::get<Vec3>(*to);
    } else if (waiting[catcher->value].prop == prop) {
        target = waiting[catcher->value].at_world;
    } else {
        Controls controls;
        take.actors[catcher->value].timeline.sample(now, controls, true);
        target = motion::catching_point(*take.actors[catcher->value].figure, controls);
    }
    const bool prescribed = duration.ticks > 0;
    motion::Flight flight{
        .start = now,
        .duration = prescribed ? duration : motion::flight_duration(from.translation, target),
        .start_world = from.translation,
        .velocity_world = {},
        .start_rotation_world = from.rotation,
        .spin_world = {},
        .radius_m = take.radius(prop)};
    flight.velocity_world = motion::launch_velocity(from.translation, target, flight.duration);
    const Vec3 level{flight.velocity_world.x, 0, flight.velocity_world.z};
    constexpr double kBackspin_rad_s = 4;  // the fingers roll off below the ball
    flight.spin_world = cross(normalized(level, {0, 0, 1}), Vec3{0, 1, 0}) * kBackspin_rad_s;
    const Vec3 way = target - from.translation;
    if (length(flight.velocity_world) > kFastFlight_m_s) {
        warn(activity.action, "fast-throw", "the ball would fly faster than 9 m/s",
             "give it more time, or come closer");
    }
    if (length(Vec3{way.x, 0, way.z}) > kFarFlight_m) {
        warn(activity.action, "far-throw", "the ball would fly farther than 6 m",
             "let the actors come closer");
    }
    const Hold& before = take.props[prop.value].at(now, true);
    const ActorIndex* named = nullptr;
    if (const motion::ArgumentValue* thrower = call.find("from")) {
        named = std::get_if<ActorIndex>(thrower);
    }
    take.props[prop.value].take({.from = now,
                                 .kind = Holding::kFlight,
                                 .actor = before.kind == Holding::kHands ? before.actor
                                          : named != nullptr             ? *named
                                                                         : ActorIndex{},
                                 .target = catcher != nullptr ? *catcher : ActorIndex{},
                                 .flight = flight});
    if (catcher != nullptr) {
        receive(*catcher, prop, flight);
    }
    take.score[activity.row].prop = play.cast.props[prop.value].name;
    return duration.ticks >= 0 ? duration : flight.duration;
}

// Who waits for a ball turns to its holder as soon as that one turns to it or begins to throw:
// since it got ready, the other may have walked on.
void Stage::Data::attend(ActorIndex thrower, const motion::BoundCall& call) {
    constexpr double kNearEnough_rad = 0.07, kMost_rad = 1.5, kTurning_rad_s = 2.2;
    const motion::ArgumentValue* to = call.find(call.movement == "throw" ? "to" : "toward");
    const ActorIndex* catcher = to != nullptr ? std::get_if<ActorIndex>(to) : nullptr;
    if (catcher == nullptr || *catcher == thrower || !planted(*catcher)) {
        return;
    }
    Waiting& wait = waiting[catcher->value];
    if (!wait.prop.valid() || held_by(thrower, now) != wait.prop) {
        return;
    }
    MotionContext context = context_of(*catcher, now, SimTime{-1});
    Controls other;
    take.actors[thrower.value].timeline.sample(now, other, true);
    const double faces =
        heading_of(motion::pelvis_over_feet(context.figure, context.now).rotation_world);
    const double turn =
        turn_between(faces, motion::heading_to(context.now, other.pelvis.position_world));
    if (std::fabs(turn) < kNearEnough_rad) {
        return;
    }
    const double by = clamp(turn, -kMost_rad, kMost_rad);  // the rest when the throw begins
    motion::Ready ready =
        motion::make_ready(context, {.grip = take.grip(wait.prop, *catcher, now, true),
                                     .heading_rad = faces + by,
                                     .duration_s = std::fmax(0.5, std::fabs(by) / kTurning_rad_s)});
    wait.at_world = ready.catches_at_world;
    const std::uint32_t owner =
        take.actors[catcher->value].timeline.in_charge(Limb::kLeftArm, now).owner;
    take_limbs(*catcher, motion::kAllLimbs, std::move(ready.movement), owner);
}

// The hands of whom the ball flies to go to where it will be, if they are free and it is ready or
// stands.
void Stage::Data::receive(ActorIndex catcher, PropIndex prop, const motion::Flight& flight) {
    const bool waits = waiting[catcher.value].prop == prop;
    if (!take.actors[catcher.value].figure->humanoid() || held_by(catcher, now).valid() ||
        (!waits && !planted(catcher))) {
        return;
    }
    const ActorTimeline& timeline = take.actors[catcher.value].timeline;
    const std::uint32_t owner = timeline.in_charge(Limb::kLeftArm, now).owner;
    auto base = std::make_shared<Goes>(timeline, now);
    MovementPtr movement =
        motion::make_receive(context_of(catcher, now, SimTime{-1}),
                             {.base = std::move(base), .base_age_s = 0, .flight = flight});
    take_limbs(catcher, motion::kBothArms, std::move(movement), owner);
}

}  // namespace puppetri::stage
