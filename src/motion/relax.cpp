// SPDX-License-Identifier: MIT
// Single arms: coming to hang, swinging to an angle.
#include "arm_state.h"
#include "puppetri/base/elementary.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/idle.h"
#include "swinging_arm.h"

namespace puppetri::motion {
namespace {

constexpr double kSettle_s = 0.7;  // until fast arms hang

// What fades besides the hand's place: fingers and elbow.
class FadingArm {
 public:
    FadingArm() = default;
    FadingArm(const figure::Figure& figure, Side side, const ArmControl& now,
              const ControlsRate::Arm& rate, const ArmControl& own, double blend_s) {
        ArmControl from = now;
        ControlsRate::Arm from_rate = rate;
        from.chest_from_hand = own.chest_from_hand;
        from_rate.hand_velocity_chest = from_rate.hand_angular_chest = {};
        offset_ = InertialArm(figure, side, from, from_rate, own, {}, blend_s);
    }
    void apply(double t_s, ArmControl& arm) const { offset_.apply(t_s, arm); }

 private:
    InertialArm offset_;
};

// From the state of the context to rest at `target`.
SwingingArm swing_to(const MotionContext& context, Side side, const Transform& target,
                     double duration_s) {
    const int i = index_of(side);
    const figure::Arm& arm = context.figure.arms[i];
    return SwingingArm({.shoulder = shoulder_chest(context.figure, side),
                        .now = context.now.arms[i].chest_from_hand,
                        .velocity = context.rate.arms[i].hand_velocity_chest,
                        .angular = context.rate.arms[i].hand_angular_chest,
                        .target = target,
                        .longest_m = arm.upper_m + arm.fore_m,
                        .duration_s = duration_s});
}

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
            swing_[i] = swing_to(context, side, hanging_[i].chest_from_hand, kSettle_s);
            fade_[i] = FadingArm(context.figure, side, context.now.arms[i], context.rate.arms[i],
                                 hanging_[i], 0.4);
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
        swing_ = swing_to(context, spec.side, target, duration_s);
        fade_ = FadingArm(context.figure, static_cast<Side>(i_), context.now.arms[i_],
                          context.rate.arms[i_], own_, duration_s);
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

}  // namespace

MovementPtr make_relax(const MotionContext& context, double duration_s) {
    return std::make_shared<Relax>(context, duration_s);
}
MovementPtr make_arm_swing(const MotionContext& context, const ArmSwingSpec& spec) {
    return std::make_shared<ArmSwing>(context, spec);
}

}  // namespace puppetri::motion
