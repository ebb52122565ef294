// SPDX-License-Identifier: MIT
// Bollo's quintic, per channel.
#include "puppetri/motion/inertialize.h"

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/gaze.h"

namespace puppetri::motion {

// x(t) = A t^5 + B t^4 + C t^3 + a0/2 t^2 + v0 t + x0 with x, x', x'' = 0 at t1 and a0 chosen for
// least jerk at the end (Bollo, slide 27): a0 = (-8 v0 t1 - 20 x0) / t1^2, but never against the
// direction of the offset. Bollo shortens t1 when the offset shrinks fast (t1 <= -5 x0 / v0), so
// that it does not overshoot. An offset that grows, or a rate without an offset, must be allowed to
// move; there the quintic with a0 = 0 is used.
InertialOffset::InertialOffset(double x0, double v0, double blend_s)
    : x0_(x0), v0_(v0), end_s_(blend_s) {
    double t = blend_s;
    if (!(t > 0)) {
        x0_ = v0_ = end_s_ = 0;
        return;
    }
    if (x0 * v0 < 0) {
        t = std::fmin(t, std::fmax(-5 * x0 / v0, blend_s / 3));
        const double a0 = (-8 * v0 * t - 20 * x0) / (t * t);
        a0_ = a0 * x0 > 0 ? a0 : 0;
    }
    end_s_ = t;
    const double t2 = t * t, t3 = t2 * t;
    a_ = -(a0_ * t2 + 6 * v0 * t + 12 * x0) / (2 * t3 * t2);
    b_ = (3 * a0_ * t2 + 16 * v0 * t + 30 * x0) / (2 * t3 * t);
    c_ = -(3 * a0_ * t2 + 12 * v0 * t + 20 * x0) / (2 * t3);
}

double InertialOffset::at(double t) const {
    return t >= end_s_ ? 0 : x0_ + t * (v0_ + t * (a0_ / 2 + t * (c_ + t * (b_ + t * a_))));
}

InertialOffset3::InertialOffset3(Vec3 x0, Vec3 v0, double blend_s)
    : x_(x0.x, v0.x, blend_s), y_(x0.y, v0.y, blend_s), z_(x0.z, v0.z, blend_s) {}

Vec3 InertialOffset3::at(double t_s) const { return {x_.at(t_s), y_.at(t_s), z_.at(t_s)}; }

namespace {

// The offset of a rotation is the vector r with now = exp(r) own. Its rate follows from the angular
// velocity w of the offset by the inverse of the left Jacobian of the exponential map (Bullo and
// Murray 1995):
//   r' = w - r x w / 2 + (1 / |r|^2 - cot(|r| / 2) / (2 |r|)) r x (r x w).
InertialOffset3 of_rotation(Quat now, Vec3 now_rate, Quat own, Vec3 own_rate, double blend_s) {
    const Quat offset = now * conjugate(own);
    const Vec3 w = now_rate - rotate(offset, own_rate);
    const Vec3 r = to_rotation_vector(offset);
    const double angle = length(r);
    const double half = angle / 2;
    const double k = angle < 1e-4 ? 1.0 / 12
                                  : 1 / (angle * angle) -
                                        puppetri::cos(half) / (puppetri::sin(half) * 2 * angle);
    return {r, w - cross(r, w) * 0.5 + cross(r, cross(r, w)) * k, blend_s};
}
void turn(Quat& q, Vec3 offset) { q = normalized(from_rotation_vector(offset) * q); }

}  // namespace

InertialBody::InertialBody(const BodyControl& now, const ControlsRate& rate, const BodyControl& own,
                           const ControlsRate& own_rate, double blend_s)
    : chest_(of_rotation(now.pelvis_from_chest, rate.chest_angular_pelvis, own.pelvis_from_chest,
                         own_rate.chest_angular_pelvis, blend_s)),
      head_(of_rotation(now.chest_from_head, rate.head_angular_chest, own.chest_from_head,
                        own_rate.head_angular_chest, blend_s)),
      breath_(now.breath - own.breath, rate.breath_per_s - own_rate.breath_per_s, blend_s) {}

void InertialBody::apply(double t_s, BodyControl& body) const {
    turn(body.pelvis_from_chest, chest_.at(t_s));
    turn(body.chest_from_head, head_.at(t_s));
    body.breath += breath_.at(t_s);
}

InertialArm::Line InertialArm::line_to(Vec3 hand_chest) const {
    const Vec3 way = hand_chest - shoulder_chest_;
    const double far = length(way);
    // No arm points across the body to the other shoulder, where the turn would be undefined.
    return {shortest_arc(outward_, far > 0 ? way * (1 / far) : outward_, {0, 1, 0}), far};
}

InertialArm::InertialArm(const figure::Figure& figure, Side side, const ArmControl& now,
                         const ControlsRate::Arm& rate, const ArmControl& own,
                         const ControlsRate::Arm& own_rate, double blend_s)
    : shoulder_chest_(shoulder_chest(figure, side)),
      outward_{side == Side::kLeft ? 1.0 : -1.0, 0, 0},
      swivel_(turn_between(own.swivel_rad, now.swivel_rad),
              rate.swivel_rad_s - own_rate.swivel_rad_s, blend_s),
      relaxed_(now.relaxed - own.relaxed, rate.relaxed_per_s - own_rate.relaxed_per_s, blend_s),
      spread_(now.spread - own.spread, rate.spread_per_s - own_rate.spread_per_s, blend_s),
      grip_(now.grip - own.grip, rate.grip_per_s - own_rate.grip_per_s, blend_s),
      world_weight_(now.world_weight - own.world_weight,
                    rate.world_weight_per_s - own_rate.world_weight_per_s, blend_s) {
    const Vec3 p = now.chest_from_hand.translation, q = own.chest_from_hand.translation;
    const Vec3 v = rate.hand_velocity_chest, u = own_rate.hand_velocity_chest;
    const auto differ = [](Vec3 a, Vec3 b) { return a.x != b.x || a.y != b.y || a.z != b.z; };
    moves_ = differ(p, q) || differ(v, u) ||
             differ(rate.hand_angular_chest, own_rate.hand_angular_chest) ||
             !(now.chest_from_hand.rotation == own.chest_from_hand.rotation);
    if (moves_) {
        constexpr double kMoment_s = 1e-5;
        const Line from = line_to(p), to = line_to(q);
        const Vec3 from_w = angular_velocity(from.turn, line_to(p + v * kMoment_s).turn, kMoment_s);
        const Vec3 to_w = angular_velocity(to.turn, line_to(q + u * kMoment_s).turn, kMoment_s);
        // A fast arm stops before it is overhead: such an offset grows by a seventh of rate times
        // time.
        constexpr double kMost_rad = 3, kMost_m = 0.7, kSoonest_s = 0.15;
        const auto stops = [&](double rate_per_s, double most) {
            return std::fmin(blend_s, std::fmax(kSoonest_s, most / std::fabs(rate_per_s)));
        };
        const double turns_s = stops(length(from_w - to_w), kMost_rad);
        line_turn_ = of_rotation(from.turn, from_w, to.turn, to_w, turns_s);
        const auto along = [&](Vec3 hand, double far, Vec3 velocity) {
            return far > 0 ? dot(hand - shoulder_chest_, velocity) / far : 0;
        };
        const double slides = along(p, from.length_m, v) - along(q, to.length_m, u);
        length_ = {from.length_m - to.length_m, slides, stops(slides, kMost_m)};
        rotation_ =
            of_rotation(conjugate(from.turn) * now.chest_from_hand.rotation,
                        rotate(conjugate(from.turn), rate.hand_angular_chest - from_w),
                        conjugate(to.turn) * own.chest_from_hand.rotation,
                        rotate(conjugate(to.turn), own_rate.hand_angular_chest - to_w), turns_s);
    }
    holds_world_ = now.world_weight > 0 && !(own.world_weight > 0);
    held_world_ = now.world_from_hand;
    if (now.world_weight > 0 && own.world_weight > 0) {
        world_position_ = {now.world_from_hand.translation - own.world_from_hand.translation,
                           rate.hand_velocity_world - own_rate.hand_velocity_world, blend_s};
        world_rotation_ =
            of_rotation(now.world_from_hand.rotation, rate.hand_angular_world,
                        own.world_from_hand.rotation, own_rate.hand_angular_world, blend_s);
    }
}

void InertialArm::apply(double t_s, ArmControl& arm) const {
    if (moves_) {
        Line line = line_to(arm.chest_from_hand.translation);
        Quat hand = conjugate(line.turn) * arm.chest_from_hand.rotation;
        turn(hand, rotation_.at(t_s));
        turn(line.turn, line_turn_.at(t_s));
        arm.chest_from_hand = {
            normalized(line.turn * hand),
            shoulder_chest_ + rotate(line.turn, outward_) * (line.length_m + length_.at(t_s))};
    }
    if (holds_world_) {
        arm.world_from_hand = held_world_;
    }
    arm.world_from_hand.translation = arm.world_from_hand.translation + world_position_.at(t_s);
    turn(arm.world_from_hand.rotation, world_rotation_.at(t_s));
    arm.swivel_rad += swivel_.at(t_s);
    arm.relaxed += relaxed_.at(t_s);
    arm.spread += spread_.at(t_s);
    arm.grip += grip_.at(t_s);
    arm.world_weight += world_weight_.at(t_s);
}

InertialLeg::InertialLeg(const LegControl& now, const ControlsRate::Leg& rate,
                         const LegControl& own, const ControlsRate::Leg& own_rate, double blend_s)
    : ankle_(now.ankle_world - own.ankle_world,
             rate.ankle_velocity_world - own_rate.ankle_velocity_world, blend_s),
      foot_(of_rotation(now.foot_rotation_world, rate.foot_angular_world, own.foot_rotation_world,
                        own_rate.foot_angular_world, blend_s)),
      toes_(now.toe_bend_rad - own.toe_bend_rad, rate.toe_bend_rad_s - own_rate.toe_bend_rad_s,
            blend_s),
      swivel_(turn_between(own.swivel_rad, now.swivel_rad),
              rate.swivel_rad_s - own_rate.swivel_rad_s, blend_s) {}

void InertialLeg::apply(double t_s, LegControl& leg) const {
    leg.ankle_world = leg.ankle_world + ankle_.at(t_s);
    turn(leg.foot_rotation_world, foot_.at(t_s));
    leg.toe_bend_rad += toes_.at(t_s);
    leg.swivel_rad += swivel_.at(t_s);
}

InertialJoint::InertialJoint(const Transform& now_earlier, const Transform& now,
                             const Transform& own, const Transform& own_later, double dt_s,
                             double blend_s)
    : turn_(of_rotation(now.rotation, angular_velocity(now_earlier.rotation, now.rotation, dt_s),
                        own.rotation, angular_velocity(own.rotation, own_later.rotation, dt_s),
                        blend_s)),
      shift_(now.translation - own.translation,
             ((now.translation - now_earlier.translation) -
              (own_later.translation - own.translation)) *
                 (1 / dt_s),
             blend_s) {}

void InertialJoint::apply(double t_s, Transform& parent_from_joint) const {
    turn(parent_from_joint.rotation, turn_.at(t_s));
    parent_from_joint.translation = parent_from_joint.translation + shift_.at(t_s);
}

namespace {

ControlsRate turning_of_pelvis(const ControlsRate& rate) {
    ControlsRate turning;
    turning.chest_angular_pelvis = rate.pelvis_angular_world;
    return turning;
}

}  // namespace

InertialFigure::InertialFigure(const MotionContext& context, const Controls& own,
                               const Controls& own_later, double blend_s) {
    const Controls& now = context.now;
    const ControlsRate rate = rate_between(own, own_later, kMoment_s);
    body_ = InertialBody(now.body, context.rate, own.body, rate, blend_s);
    pelvis_turn_ =
        InertialBody({now.pelvis.rotation_world, {}, 0}, turning_of_pelvis(context.rate),
                     {own.pelvis.rotation_world, {}, 0}, turning_of_pelvis(rate), blend_s);
    for (int i = 0; i < 2; ++i) {
        arms_[i] = InertialArm(context.figure, static_cast<Side>(i), now.arms[i],
                               context.rate.arms[i], own.arms[i], rate.arms[i], blend_s);
        swivel_[i] = {turn_between(own.legs[i].swivel_rad, now.legs[i].swivel_rad),
                      context.rate.legs[i].swivel_rad_s - rate.legs[i].swivel_rad_s, blend_s};
    }
}

void InertialFigure::apply(double t_s, Controls& c) const {
    BodyControl turn{c.pelvis.rotation_world, {}, 0};
    pelvis_turn_.apply(t_s, turn);
    c.pelvis.rotation_world = turn.pelvis_from_chest;
    body_.apply(t_s, c.body);
    for (int i = 0; i < 2; ++i) {
        arms_[i].apply(t_s, c.arms[i]);
        c.legs[i].swivel_rad += swivel_[i].at(t_s);
    }
}

}  // namespace puppetri::motion
