// SPDX-License-Identifier: MIT
// Arms that come to hang. The hand moves on a cylinder about the shoulder's lateral axis: an angle
// in the plane of the swing, a distance from the shoulder, a distance to the side. A fast hand so
// swings on along its arc, as after a throw, instead of running into the end of the arm.
#include "arm_state.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/quintic.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/idle.h"

namespace puppetri::motion {
namespace {

constexpr double kSettle_s = 0.7;  // until fast arms hang
constexpr double kWrist_s = 0.2, kStraight_s = 0.25;

// Place of the hand in the shoulder's cylinder: angle 0 hangs down, positive forward.
struct Cylinder {
    double angle_rad = 0, reach_m = 0, side_m = 0;
};
Cylinder to_cylinder(Vec3 from_shoulder) {
    return {atan2(from_shoulder.z, -from_shoulder.y),
            std::sqrt(from_shoulder.y * from_shoulder.y + from_shoulder.z * from_shoulder.z),
            from_shoulder.x};
}
Vec3 from_cylinder(const Cylinder& c) {
    return {c.side_m, -c.reach_m * cos(c.angle_rad), c.reach_m * sin(c.angle_rad)};
}

// From one state to rest: swings on as far as its speed carries it, but no further than `most`
// beyond; longer journeys take longer.
Curve1 settle(double x, double v, double rest, double duration_s) {
    return Curve1({{0, {x, v, 0}}, {duration_s, {rest, 0, 0}}});
}

class SwingingArm {
 public:
    SwingingArm() = default;
    // `target` is where the hand ends, in chest space; the hand turns with the arm.
    SwingingArm(Vec3 shoulder, const Transform& now, const ControlsRate::Arm& rate,
                const Transform& target, double duration_s)
        : shoulder_(shoulder) {
        constexpr double h = 1e-4;
        const Vec3 p = now.translation - shoulder;
        const Cylinder a = to_cylinder(p), b = to_cylinder(p + rate.hand_velocity_chest * h),
                       c = to_cylinder(target.translation - shoulder);
        angle_ = settle(a.angle_rad, (b.angle_rad - a.angle_rad) / h, c.angle_rad, duration_s);
        // An arm that is fast along itself stops soon, and nearly straight.
        const double reach_rate = (b.reach_m - a.reach_m) / h,
                     soon_s = std::fmin(kStraight_s, 0.4 * duration_s);
        const double soon =
            clamp(a.reach_m + 0.3 * soon_s * reach_rate, 0.9 * c.reach_m, 0.99 * c.reach_m);
        reach_ = Curve1({{0, {a.reach_m, reach_rate, 0}},
                         {soon_s, {soon, 0, 0}},
                         {duration_s, {c.reach_m, 0, 0}}});
        side_ = settle(a.side_m, (b.side_m - a.side_m) / h, c.side_m, duration_s);
        target_from_arm_ = about_x(c.angle_rad) * target.rotation;
        // How the hand lies on the arm fades with the swing; how fast it turns against the arm
        // fades at once, since wrists do not go far.
        const Quat arm_from_chest = about_x(a.angle_rad);
        const Vec3 arm_rate{-(b.angle_rad - a.angle_rad) / h, 0, 0};
        lie_ = InertialOffset3(
            to_rotation_vector(arm_from_chest * now.rotation * conjugate(target_from_arm_)), {},
            duration_s);
        wrist_ = InertialOffset3({}, rotate(arm_from_chest, rate.hand_angular_chest - arm_rate),
                                 std::fmin(kWrist_s, duration_s));
    }
    Transform at(double t_s) const {
        const double angle = angle_.at(t_s).position;
        const Quat hand = about_x(-angle) * from_rotation_vector(wrist_.at(t_s)) *
                          from_rotation_vector(lie_.at(t_s)) * target_from_arm_;
        return {normalized(hand), shoulder_ + from_cylinder({angle, reach_.at(t_s).position,
                                                             side_.at(t_s).position})};
    }

 private:
    Vec3 shoulder_;
    Curve1 angle_, reach_, side_;
    Quat target_from_arm_;
    InertialOffset3 lie_, wrist_;
};

// What fades besides the hand's place: fingers and elbow.
class FadingArm {
 public:
    FadingArm() = default;
    FadingArm(const ArmControl& now, const ControlsRate::Arm& rate, const ArmControl& own,
              double blend_s) {
        ArmControl from = now;
        ControlsRate::Arm from_rate = rate;
        from.chest_from_hand = own.chest_from_hand;
        from_rate.hand_velocity_chest = from_rate.hand_angular_chest = {};
        offset_ = InertialArm(from, from_rate, own, {}, blend_s);
    }
    void apply(double t_s, ArmControl& arm) const { offset_.apply(t_s, arm); }

 private:
    InertialArm offset_;
};

double sway(double at_s, int side) { return 0.012 * sin(1.3 * at_s + 1.7 * side); }

class Relax final : public Movement {
 public:
    Relax(const MotionContext& given, double duration_s) : at_s_(given.at.seconds()) {
        const MotionContext context = arms_in_chest_space(given);
        limbs = kBothArms;
        duration = duration_of(context, duration_s);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const int i = index_of(side);
            hanging_[i] = hanging_arm(context.figure, side);
            swing_[i] = SwingingArm(shoulder_chest(context.figure, side),
                                    context.now.arms[i].chest_from_hand, context.rate.arms[i],
                                    hanging_[i].chest_from_hand, kSettle_s);
            fade_[i] = FadingArm(context.now.arms[i], context.rate.arms[i], hanging_[i], 0.4);
        }
    }
    void sample(double t_s, Controls& out) const override {
        for (int i = 0; i < 2; ++i) {
            out.arms[i] = hanging_[i];
            out.arms[i].chest_from_hand = swing_[i].at(t_s);
            out.arms[i].chest_from_hand.translation.z += alive(t_s) * sway(at_s_ + t_s, i);
            fade_[i].apply(t_s, out.arms[i]);
        }
    }

 private:
    static double alive(double t_s) {
        const double x = clamp(t_s / 1.5, 0, 1);
        return x * x * x * (10 + x * (-15 + 6 * x));
    }
    double at_s_;
    std::array<ArmControl, 2> hanging_;
    std::array<SwingingArm, 2> swing_;
    std::array<FadingArm, 2> fade_;
};

class ArmSwing final : public Movement {
 public:
    ArmSwing(const MotionContext& given, const ArmSwingSpec& spec) : i_(index_of(spec.side)) {
        const MotionContext context = arms_in_chest_space(given);
        limbs = limb_set(arm_of(spec.side));
        duration = duration_of(context, spec.duration_s);
        const double duration_s = std::fmax(duration.seconds(), 0.05);
        own_ = hanging_arm(context.figure, spec.side);
        const Vec3 shoulder = shoulder_chest(context.figure, spec.side);
        Cylinder c = to_cylinder(own_.chest_from_hand.translation - shoulder);
        c.angle_rad += spec.angle_rad;
        c.reach_m *= spec.angle_rad > 0 ? 0.97 : 1;  // the elbow bends where the arm swings forward
        const Transform target{about_x(-spec.angle_rad) * own_.chest_from_hand.rotation,
                               shoulder + from_cylinder(c)};
        swing_ = SwingingArm(shoulder, context.now.arms[i_].chest_from_hand, context.rate.arms[i_],
                             target, duration_s);
        fade_ = FadingArm(context.now.arms[i_], context.rate.arms[i_], own_, duration_s);
    }
    void sample(double t_s, Controls& out) const override {
        out.arms[i_] = own_;
        out.arms[i_].chest_from_hand = swing_.at(t_s);
        fade_.apply(t_s, out.arms[i_]);
    }

 private:
    int i_;
    ArmControl own_;
    SwingingArm swing_;
    FadingArm fade_;
};

class Reach final : public Movement {
 public:
    Reach(const MotionContext& given, const ReachSpec& spec) : i_(index_of(spec.side)) {
        const MotionContext context = arms_in_chest_space(given);
        const figure::Figure& figure = context.figure;
        limbs = limb_set(arm_of(spec.side));
        duration = duration_of(context, spec.duration_s);
        const figure::Arm& arm = figure.arms[i_];
        const Vec3 shoulder = shoulder_chest(figure, spec.side);
        const Vec3 way =
            inverse(world_from_chest(figure, context.now)) * spec.target_world - shoulder;
        const Vec3 ahead = normalized(way, {0, 0, 1});
        const double palm_m = std::fabs(arm.hand_from_palm.translation.x);
        const double most = 0.97 * (arm.upper_m + arm.fore_m);
        const double reach = clamp(length(way) - palm_m, 0.3 * most, most);
        const Vec3 along{spec.side == Side::kLeft ? 1.0 : -1.0, 0, 0};
        own_.chest_from_hand = {shortest_arc(along, ahead, {0, 1, 0}), shoulder + ahead * reach};
        own_.relaxed = 0.4;
        own_.spread = 0.6;
        offset_ =
            InertialArm(context.now.arms[i_], context.rate.arms[i_], own_, {}, duration.seconds());
    }
    void sample(double t_s, Controls& out) const override {
        out.arms[i_] = own_;
        offset_.apply(t_s, out.arms[i_]);
    }

 private:
    int i_;
    ArmControl own_;
    InertialArm offset_;
};

}  // namespace

MovementPtr make_relax(const MotionContext& context, double duration_s) {
    return std::make_shared<Relax>(context, duration_s);
}
MovementPtr make_arm_swing(const MotionContext& context, const ArmSwingSpec& spec) {
    return std::make_shared<ArmSwing>(context, spec);
}
MovementPtr make_reach(const MotionContext& context, const ReachSpec& spec) {
    return std::make_shared<Reach>(context, spec);
}

}  // namespace puppetri::motion
