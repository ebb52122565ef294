// SPDX-License-Identifier: MIT
// The stage's state while the run goes on. Within one instant the net first takes tokens and then
// gives new ones, several times over; what a movement is prepared from is always the state just
// before the instant, so that the order inside it does not matter. What can be known only when the
// instant is over (a limb that nobody took, two movements on one limb, a ball that was let go
// without a flight) is settled when time advances.
#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "puppetri/base/hash.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/controls_from_pose.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/idle.h"
#include "puppetri/stage/stage.h"
#include "take.h"

namespace puppetri::stage {

using motion::Controls;
using motion::Limb;
using motion::LimbSet;
using motion::MotionContext;
using motion::MovementPtr;

inline constexpr SimTime kMoment{kTicksPerSecond / 10'000};     // over which rates are taken
inline constexpr SimTime kJointFade{kTicksPerSecond * 3 / 10};  // of what joints do beyond controls

// One performance of an action.
struct Activity {
    net::ActionIndex action;
    SimTime start, left = SimTime::never();
    bool cut = false;
    MovementPtr movement;  // null for a prop's
    ActorIndex actor;
    PropIndex releases;   // at its end, unless it is cut before
    std::size_t row = 0;  // of the score
};

struct Stage::Data {
    Play play;
    Take take;
    SimTime now{-1};
    std::vector<Activity> activities;
    std::vector<std::uint32_t> running;  // those of actors that have not left yet
    std::vector<net::RaisedEvent> raised;
    std::uint32_t raised_by = ~0u;
    Diagnostics diagnostics;

    // To be settled when time advances.
    struct Overlap {
        std::uint32_t first, second;
    };
    std::vector<Overlap> overlaps;
    std::vector<std::uint32_t> cuts;  // activities that were cut at `now`
    struct Release {
        SimTime at;
        std::uint32_t activity;
    };
    std::vector<Release> releases;
    // Hands that close on a prop in the middle of a movement: ordered by time.
    struct Grasp {
        SimTime at;
        std::uint32_t activity;
        ActorIndex actor;
        PropIndex prop;
        std::optional<motion::Side> one_hand = {};
        bool lays = false;  // opens and leaves the prop where it is
    };
    std::vector<Grasp> grasps;
    void add_grasp(const Grasp& grasp) {
        grasps.insert(std::upper_bound(grasps.begin(), grasps.end(), grasp,
                                       [](const Grasp& a, const Grasp& b) { return a.at < b.at; }),
                      grasp);
    }

    // Per actor, for the surroundings.
    struct Waiting {
        PropIndex prop;
        Vec3 at_world;
        std::uint32_t owner = ~0u;
    };
    std::vector<Waiting> waiting;

    Data(Play p, std::shared_ptr<const Quantities> quantities) : play(std::move(p)) {
        PUP_REQUIRE(!has_errors(check(play.cast)));
        take.cast = play.cast;
        take.driven_props.resize(play.cast.props.size());
        take.driven_joints.resize(play.cast.actors.size());
        waiting.resize(play.cast.actors.size());
        for (std::uint32_t i = 0; i < play.cast.actors.size(); ++i) {
            place_actor(ActorIndex{i});
        }
        for (std::uint32_t i = 0; i < play.cast.props.size(); ++i) {
            place_prop(PropIndex{i});
        }
        take.drive(play, std::move(quantities));
    }

    // ---- the beginning ----

    PropIndex initially_held_by(ActorIndex actor) const {
        for (std::uint32_t i = 0; i < play.cast.props.size(); ++i) {
            if (play.cast.props[i].held_by == actor) {
                return PropIndex{i};
            }
        }
        return {};
    }

    void place_actor(ActorIndex index) {
        const Actor& actor = play.cast.actors[index.value];
        ActorTake made;
        made.figure = std::make_unique<figure::Figure>(
            actor.body == BodyKind::kCharacter ? actor.character->moved_figure()
                                               : figure::make_mannequin(actor.height_m));
        const figure::Figure& figure = *made.figure;
        MotionContext context{
            figure,      motion::standing(figure, actor.position_world, actor.heading_rad),
            {},          SimTime{0},
            SimTime{-1}, seed(index)};
        const PropIndex held = initially_held_by(index);
        LimbSet idle = motion::kAllLimbs;
        if (held.valid()) {
            const motion::Grip grip = first_grip(held);
            motion::lay_hands(figure, motion::carried_ball_chest(figure, grip), grip, 0,
                              context.now);
            idle = motion::without(idle, motion::kBothArms);
            made.timeline.take(motion::kBothArms, {SimTime{-1}, SimTime{0},
                                                   motion::make_carry(context, {.grip = grip})});
        }
        made.timeline.take(idle,
                           {SimTime{-1}, SimTime{0}, motion::make_idle(context, {.limbs = idle})});
        take.actors.push_back(std::move(made));
    }

    // Of what is held from the beginning: its X goes from hand to hand.
    motion::Grip first_grip(PropIndex index) const {
        const Prop& prop = play.cast.props[index.value];
        return prop.shape == PropShape::kSphere ? motion::ball_grip(take.radius(index))
                                                : motion::box_grip(prop.size_m, 0);
    }

    void place_prop(PropIndex index) {
        const Prop& prop = play.cast.props[index.value];
        PropTimeline line;
        if (prop.held_by.valid()) {
            line.take({.from = SimTime{-1},
                       .kind = Holding::kHands,
                       .actor = prop.held_by,
                       .grip = first_grip(index)});
        } else {
            line.take(
                {.from = SimTime{-1}, .lies = {about_y(prop.heading_rad), prop.position_world}});
        }
        take.props.push_back(std::move(line));
    }

    static std::uint64_t seed(ActorIndex actor) { return mix64(actor.value + 1); }

    // ---- the state just before an instant ----

    MotionContext context_of(ActorIndex actor, SimTime at, SimTime duration) const {
        const ActorTake& a = take.actors[actor.value];
        MotionContext context{*a.figure, {}, {}, at, duration, seed(actor)};
        a.timeline.sample(at, context.now, true);
        if (at >= kMoment) {
            Controls earlier;
            a.timeline.sample(at - kMoment, earlier, true);
            context.rate = motion::rate_between(earlier, context.now, kMoment.seconds());
        }
        return context;
    }

    // What the hands have just before the instant and do not let go at it.
    PropIndex held_by(ActorIndex actor, SimTime at) const {
        for (std::uint32_t i = 0; i < take.props.size(); ++i) {
            const Hold& hold = take.props[i].at(at, true);
            if (hold.kind == Holding::kHands && hold.actor == actor &&
                !lets_go(actor, PropIndex{i}, at)) {
                return PropIndex{i};
            }
        }
        return {};
    }
    bool lets_go(ActorIndex actor, PropIndex prop, SimTime at) const {
        return std::any_of(releases.begin(), releases.end(), [&](const Release& release) {
            const Activity& a = activities[release.activity];
            return release.at <= at && !a.cut && a.actor == actor && a.releases == prop;
        });
    }

    struct Seen {
        std::vector<motion::ActorState> actors;
        std::vector<motion::PropState> props;
        std::vector<motion::SetState> sets;
    };
    Seen look_around(SimTime at, ActorIndex me) const {
        Seen seen;
        for (std::uint32_t i = 0; i < take.actors.size(); ++i) {
            motion::ActorState state{take.actors[i].figure.get(), {}, {}};
            take.actors[i].timeline.sample(at, state.controls, true);
            if (waiting[i].prop.valid()) {
                state.catches_at_world = waiting[i].at_world;
            }
            seen.actors.push_back(std::move(state));
        }
        for (std::uint32_t i = 0; i < take.props.size(); ++i) {
            const Hold& hold = take.props[i].at(at, true);
            const bool one_hand = hold.kind == Holding::kOneHand;
            const Transform where = take.world_from_prop(PropIndex{i}, at, true);
            motion::PropState state{
                where.translation, take.grip(PropIndex{i}, me, at, true),
                hold.kind == Holding::kHands || one_hand ? hold.actor : ActorIndex{}};
            if (one_hand) {
                state.in_hand = hold.hand;
                state.hand_from_thing = hold.hand_from_prop;
            }
            state.rotation_world = where.rotation;
            state.size_m = play.cast.props[i].size_m;
            seen.props.push_back(state);
        }
        for (const Set& set : play.cast.sets) {
            seen.sets.push_back({set.position_world, set.direction_rad});
        }
        return seen;
    }

    // ---- time ----

    void advance(SimTime at) {
        PUP_REQUIRE(at >= now);
        if (at == now) {
            return;
        }
        for (const Overlap& o : overlaps) {
            if (activities[o.first].left > now) {
                warn(activities[o.second].action, "limb-driven-twice",
                     "it takes a limb that " + place_of(o.first) + " is still moving",
                     "leave the arms of one to the other, or let one end first");
            }
        }
        overlaps.clear();
        for (const std::uint32_t number : cuts) {
            rest_after_cut(number);
        }
        cuts.clear();
        join_joints();
        while (!releases.empty() && releases.front().at < at) {
            let_go(releases.front());
            releases.erase(releases.begin());
        }
        while (!grasps.empty() && grasps.front().at < at) {
            close_hands(grasps.front());
            grasps.erase(grasps.begin());
        }
        now = at;
    }

    // Unless the movement was cut before, or the hands are elsewhere.
    void close_hands(const Grasp& grasp) {
        constexpr double kNear_m = 0.02;
        const Activity& activity = activities[grasp.activity];
        if (activity.cut && activity.left < grasp.at) {
            return;
        }
        if (grasp.one_hand) {
            close_one_hand(grasp);
            return;
        }
        const Transform prop = take.world_from_prop(grasp.prop, grasp.at, true);
        const Hold& hold = take.props[grasp.prop.value].at(grasp.at);
        const motion::Grip grip = take.grip(grasp.prop, grasp.actor, activity.start, true);
        const Transform hands = take.between_hands(grasp.actor, grip, grasp.at);
        const bool other = hold.kind == Holding::kHands && hold.actor != activity.actor;
        if (other || length(prop.translation - hands.translation) > kNear_m) {
            warn(activity.action, "out-of-reach", "the hands close on air: the prop is not there",
                 "let nobody else move it, or the one who takes it, meanwhile");
            return;
        }
        take.props[grasp.prop.value].take(
            {.from = grasp.at,
             .kind = Holding::kHands,
             .actor = grasp.actor,
             .hands_from_prop = normalized(conjugate(hands.rotation) * prop.rotation),
             .grip = grip});
    }

    // One hand that takes a prop, or leaves it where it is. The stage has it exactly as it was: so
    // nothing jumps.
    void close_one_hand(const Grasp& grasp) {
        const Hold& hold = take.props[grasp.prop.value].at(grasp.at);
        const bool mine = hold.kind == Holding::kOneHand && hold.actor == grasp.actor &&
                          hold.hand == *grasp.one_hand;
        const bool somebodys = hold.kind == Holding::kOneHand || hold.kind == Holding::kHands;
        const Transform prop = take.world_from_prop(grasp.prop, grasp.at, true);
        if (grasp.lays && mine) {
            take.props[grasp.prop.value].take({.from = grasp.at, .lies = prop});
        } else if (!grasp.lays && !somebodys) {
            take.props[grasp.prop.value].take(
                {.from = grasp.at,
                 .kind = Holding::kOneHand,
                 .actor = grasp.actor,
                 .hand = *grasp.one_hand,
                 .hand_from_prop =
                     inverse(take.world_from_hand(grasp.actor, *grasp.one_hand, grasp.at)) * prop});
        } else {
            warn(activities[grasp.activity].action, "out-of-reach",
                 "somebody else has taken the thing meanwhile", "let one of them wait");
        }
    }

    // Limbs that were cut and that nobody took at that instant come to rest.
    void rest_after_cut(std::uint32_t number) {
        const Activity& activity = activities[number];
        LimbSet free;
        const ActorTimeline& timeline = take.actors[activity.actor.value].timeline;
        for (int i = 0; i < motion::kLimbCount; ++i) {
            const Limb limb = static_cast<Limb>(i);
            if (activity.movement->limbs.has(limb) &&
                timeline.in_charge(limb, now).owner == number) {
                free = free.with(limb);
            }
        }
        if (free.bits == 0) {
            return;
        }
        const MotionContext context = context_of(activity.actor, now, SimTime{-1});
        const PropIndex held = held_by(activity.actor, now);
        if (held.valid() && free.has(Limb::kLeftArm) && free.has(Limb::kRightArm)) {
            free = motion::without(free, motion::kBothArms);
            take_limbs(activity.actor, motion::kBothArms,
                       motion::make_carry(context, {.grip = take.grip(held, activity.actor, now)}),
                       ~0u);
        }
        if (free.bits != 0) {
            take_limbs(activity.actor, free, motion::make_idle(context, {.limbs = free}), ~0u);
        }
    }

    // Movements that pose joints beyond controls: where one follows or is followed, the difference
    // that the controls do not know of fades. Where neither does there is none.
    void join_joints() {
        for (std::uint32_t i = 0; now >= SimTime{0} && i < take.actors.size(); ++i) {
            ActorTimeline& timeline = take.actors[i].timeline;
            if (!timeline.has_overlays()) {
                continue;
            }
            LimbSet joined;
            for (int k = 0; k < motion::kLimbCount; ++k) {
                const Limb limb = static_cast<Limb>(k);
                const Charge& next = timeline.in_charge(limb, now);
                const Charge& last = timeline.in_charge(limb, now, true);
                const bool fades = last.join != nullptr && now - last.from < kJointFade;
                if (next.from == now && (next.poses(limb) || last.poses(limb) || fades)) {
                    joined = joined.with(limb);
                }
            }
            if (joined.bits == 0) {
                continue;
            }
            figure::Pose earlier, last, next, later;
            take.pose(ActorIndex{i}, std::max(now - kMoment, SimTime{0}), earlier, true);
            take.pose(ActorIndex{i}, now, last, true);
            take.pose(ActorIndex{i}, now, next);
            take.pose(ActorIndex{i}, now + kMoment, later);
            for (int k = 0; k < motion::kLimbCount; ++k) {
                const Limb limb = static_cast<Limb>(k);
                if (!joined.has(limb)) {
                    continue;
                }
                auto join = std::make_shared<JointJoin>();
                for (const figure::JointIndex joint :
                     motion::joints_of(*take.actors[i].figure, limb)) {
                    const auto at = [&](const figure::Pose& p) {
                        return p.parent_from_joint[joint.value];
                    };
                    join->joints.emplace_back(
                        joint, motion::InertialJoint(at(earlier), at(last), at(next), at(later),
                                                     kMoment.seconds(), kJointFade.seconds()));
                }
                timeline.join(limb, std::move(join));
            }
        }
    }

    // A ball whose throw ended without a flight in the net flies all the same.
    void let_go(const Release& release) {
        const Activity& activity = activities[release.activity];
        const PropIndex prop = activity.releases;
        const Hold& hold = take.props[prop.value].at(release.at);
        if (activity.cut || hold.kind != Holding::kHands || hold.actor != activity.actor) {
            return;
        }
        const Transform before = take.world_from_prop(prop, release.at - kMoment, true);
        const Transform then = take.world_from_prop(prop, release.at, true);
        motion::Flight flight{
            .start = release.at,
            .duration = {},
            .start_world = then.translation,
            .velocity_world = (then.translation - before.translation) * (1 / kMoment.seconds()),
            .start_rotation_world = then.rotation,
            .spin_world = {},
            .radius_m = take.radius(prop)};
        take.props[prop.value].take({.from = release.at,
                                     .kind = Holding::kFlight,
                                     .actor = activity.actor,
                                     .flight = flight});
    }

    void take_limbs(ActorIndex actor, LimbSet limbs, MovementPtr movement, std::uint32_t owner) {
        take.actors[actor.value].timeline.take(limbs, {now, now, std::move(movement), owner});
    }

    // ---- what goes wrong ----

    std::string place_of(std::uint32_t activity) const {
        return play.actions[activities[activity].action.value].place;
    }
    void warn(net::ActionIndex action, const char* code, std::string message, std::string remedy) {
        const Action& a = play.actions[action.value];
        for (const Diagnostic& d : diagnostics) {  // once per place
            if (d.code == code && d.element == "place " + a.place) {
                return;
            }
        }
        diagnostics.push_back({Severity::kWarning, code, a.where, "place " + a.place,
                               std::move(message), std::move(remedy)});
    }
    // A proof may have relied on the interval: nothing outside it is performed.
    void outside_declared(net::ActionIndex action, SimTime lasts) {
        const Action& a = play.actions[action.value];
        const motion::DurationRange range = motion::declared_duration(a.call);
        const auto ms = [](SimTime t) { return std::to_string(t.ticks / kTicksPerMillisecond); };
        diagnostics.push_back(
            {Severity::kError, "duration-not-declared", a.where, "place " + a.place,
             "it would take " + ms(lasts) + " ms, but " + a.call.movement + " declares " +
                 ms(range.shortest) + " to " + ms(range.longest) + " ms for `takes auto`",
             a.call.movement == "fly" ? "let the actors come closer, or write how long it takes"
                                      : "write how long it takes"});
    }
    void report(net::ActionIndex action, const Diagnostics& warnings) {
        for (const Diagnostic& d : warnings) {
            warn(action, d.code.c_str(), d.message, d.remedy);
        }
    }

    SimTime begin_actor(std::uint32_t number, const motion::BoundCall& call, SimTime duration);
    SimTime begin_flight(std::uint32_t number, const motion::BoundCall& call, SimTime duration);
    void attend(ActorIndex thrower, const motion::BoundCall& call);
    void receive(ActorIndex catcher, PropIndex prop, const motion::Flight& flight);
    void receive_from_hands(const Grasp& grasp, Vec3 meeting_world);
    bool planted(ActorIndex actor) const;
};

}  // namespace puppetri::stage
