// SPDX-License-Identifier: MIT
// The place where the hand meets the thing is solved once, in the world, when the movement is
// prepared; the hand keeps to it whatever breath does to the chest, and comes and goes in an arc.
#include "puppetri/motion/one_hand.h"

#include <algorithm>

#include "arm_state.h"
#include "living.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/arm_goal.h"

namespace puppetri::motion {
namespace {

constexpr double kTouch = 0.6;   // part of the movement until the hand meets the thing
constexpr double kLift_m = 0.1;  // the hand comes from above and goes up again
constexpr double kPalm_m = 0.012;
constexpr double kLong = 1.3;  // a side that is so much longer than the other is what fingers lie
                               // along

// The hand whose fingers point to `fingers` and whose palm faces `palm` (made square to it).
Quat hand_turned(const figure::Figure& figure, Side side, Vec3 fingers, Vec3 palm) {
    const Vec3 own_fingers{side == Side::kLeft ? 1.0 : -1.0, 0, 0};
    const Vec3 own_palm = rotate(figure.arms[index_of(side)].hand_from_palm.rotation, {0, 1, 0});
    const Vec3 f = normalized(fingers - palm * dot(fingers, palm), {0, 0, 1});
    return from_basis(f, palm, cross(f, palm)) *
           conjugate(from_basis(own_fingers, own_palm, cross(own_fingers, own_palm)));
}

// The hand with its palm at this point.
Transform hand_at(const figure::Figure& figure, Side side, Quat hand, Vec3 palm) {
    return {hand, palm - rotate(hand, figure.arms[index_of(side)].hand_from_palm.translation)};
}

// Before the body, forearm level: where a hand holds what it has.
ArmControl ready_hand(const figure::Figure& figure, Side side) {
    const figure::Arm& arm = figure.arms[index_of(side)];
    const double out = side == Side::kLeft ? 1 : -1, reach = arm.upper_m + arm.fore_m;
    ArmControl control;
    control.chest_from_hand = {
        hand_turned(figure, side, {-0.25 * out, -0.1, 1}, normalized(Vec3{-0.5 * out, -1, 0.1})),
        shoulder_chest(figure, side) + Vec3{0.02 * out, -0.42, 0.52} * reach};
    control.swivel_rad = 0.05;
    control.relaxed = 0.3;
    control.grip = 0.7;
    return control;
}

class OneHand final : public Movement {
 public:
    OneHand(const MotionContext& context, Side side, const ArmControl& meets_chest,
            double duration_s, bool takes)
        : figure_(context.figure), i_(index_of(side)), takes_(takes) {
        limbs = limb_set(arm_of(side));
        duration = duration_of(context, duration_s);
        touches_s_ = kTouch * duration.seconds();
        meets_ = meets_chest;
        world_from_meeting_ = world_from_chest(figure_, context.now) * meets_chest.chest_from_hand;
        ready_ = ready_hand(figure_, side);
        offsets_ = ArmOffsets::make(
            context, [this](double t, Controls& out) { own(t, out); }, 0.8 * touches_s_);
        events = {{touches(), takes ? "grasp" : "release", arm_of(side)}};
    }
    SimTime touches() const { return to_time(touches_s_); }
    void sample(double t_s, Controls& out) const override {
        own(t_s, out);
        offsets_.arms[static_cast<std::size_t>(i_)].apply(t_s, out.arms[i_]);
    }

 private:
    void own(double t_s, Controls& out) const {
        const Transform chest_from_world = inverse(world_from_chest(figure_, out));
        Transform there = world_from_meeting_;
        const double rest_s = duration.seconds() - touches_s_;
        const double down = smooth_rise(t_s - 0.3 * touches_s_, 0.7 * touches_s_);
        const double away = smooth_rise(t_s - touches_s_, rest_s);
        const double up = smooth_rise(t_s - touches_s_, 0.6 * rest_s);
        there.translation.y += kLift_m * (1 - down + up);
        there = chest_from_world * there;
        ArmControl& arm = out.arms[i_];
        arm = meets_;
        arm.chest_from_hand = {slerp(there.rotation, ready_.chest_from_hand.rotation, away),
                               lerp(there.translation, ready_.chest_from_hand.translation, away)};
        arm.swivel_rad = lerp(meets_.swivel_rad, ready_.swivel_rad, away);
        // Open before it takes, open after it lays.
        const double closed = takes_ ? smooth_rise(t_s - 0.75 * touches_s_, 0.25 * touches_s_)
                                     : 1 - smooth_rise(t_s - touches_s_, 0.25);
        arm.grip = 0.7 * closed;
        arm.relaxed = 0.3 + 0.3 * (1 - closed);
        arm.spread = 1 - arm.grip - arm.relaxed;
    }

    const figure::Figure& figure_;
    int i_;
    bool takes_;
    double touches_s_ = 0;
    ArmControl meets_, ready_;
    Transform world_from_meeting_;
    ArmOffsets offsets_;
};

OneHandMove meet(const MotionContext& given, Side side, const Transform& world_from_hand_there,
                 double duration_s, bool takes) {
    const MotionContext context = arms_in_chest_space(given);
    const Transform wanted =
        inverse(world_from_chest(context.figure, context.now)) * world_from_hand_there;
    const ArmAnswer answer = solve_arm(context.figure, context.now,
                                       {.side = side,
                                        .goal_chest = {.kind = LimbGoalKind::kPose,
                                                       .position_parent = wanted.translation,
                                                       .rotation_parent = wanted.rotation}});
    auto movement = std::make_shared<OneHand>(context, side, answer.control, duration_s, takes);
    const SimTime touches = movement->touches();
    return {std::move(movement), touches, answer.residual_m, answer.residual_rad};
}

}  // namespace

Transform thing_in_hand(const figure::Figure& figure, Side side, Vec3 size_m) {
    // Below a palm that faces down with fingers along +Z, seen from the thing.
    const Transform thing_from_hand =
        hand_at(figure, side, hand_turned(figure, side, {0, 0, 1}, {0, -1, 0}),
                {0, size_m.y / 2 + kPalm_m, 0});
    return inverse(thing_from_hand);
}

OneHandMove make_take_in_hand(const MotionContext& context, const TakeInHandSpec& spec) {
    const Vec3 centre = spec.world_from_thing.translation;
    // Of a long thing its own axis, +Z or +X, whichever points away from the body; of others the
    // way from the shoulder.
    const Vec3 shoulder =
        world_from_chest(context.figure, context.now) * shoulder_chest(context.figure, spec.side);
    Vec3 along{centre.x - shoulder.x, 0, centre.z - shoulder.z};
    const bool long_z = spec.size_m.z > kLong * spec.size_m.x,
               long_x = spec.size_m.x > kLong * spec.size_m.z;
    if (long_z || long_x) {
        const Vec3 axis =
            rotate(spec.world_from_thing.rotation, long_z ? Vec3{0, 0, 1} : Vec3{1, 0, 0});
        along = dot(axis, along) < 0 ? -axis : axis;
    }
    const Quat hand = hand_turned(context.figure, spec.side, along, {0, -1, 0});
    return meet(
        context, spec.side,
        hand_at(context.figure, spec.side, hand, centre + Vec3{0, spec.size_m.y / 2 + kPalm_m, 0}),
        spec.duration_s, true);
}

OneHandMove make_lay_down(const MotionContext& context, const LayDownSpec& spec) {
    return meet(context, spec.side, spec.world_from_thing * inverse(spec.hand_from_thing),
                spec.duration_s, false);
}

}  // namespace puppetri::motion
