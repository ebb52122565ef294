// SPDX-License-Identifier: MIT
// Carrying: the ball has a place before the belly, in chest space, and sways a little around it.
#include "arm_state.h"
#include "puppetri/base/elementary.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/grip.h"
#include "swinging_arm.h"

namespace puppetri::motion {
namespace {

constexpr double kBlend_s = 0.5;
constexpr double kSwing_s = 0.7;  // until a ball is where it is carried

// A slow sway that is the same function of absolute time in every movement, so that nothing shows
// where they join.
Vec3 sway(double at_s) {
    return {0.003 * sin(1.1 * at_s), 0.004 * sin(1.7 * at_s + 0.6), 0.002 * sin(0.9 * at_s + 2)};
}

class Carry final : public Movement {
 public:
    Carry(const MotionContext& given, const CarrySpec& spec)
        : figure_(given.figure), grip_(spec.grip), held_(spec.held) {
        const MotionContext context = arms_in_chest_space(given);
        // Hands that have opened come back to what they still have.
        held_ = held_ && hands_hold(context, grip_);
        limbs = kBothArms;
        duration = duration_of(context, spec.duration_s);
        at_s_ = context.at.seconds();
        rest_ = carried_ball_chest(figure_, grip_);
        if (held_) {
            const HeldBall ball = held_ball(context, grip_);
            if (spec.stay) {
                rest_ = ball.chest_from_ball;
                rest_.translation = rest_.translation - sway(at_s_);
            }
            const double h = 1e-4;
            const Vec3 own_velocity = (sway(at_s_ + h) - sway(at_s_)) * (1 / h);
            plan_swing(ball, own_velocity);
            Controls on_ball = context.now;
            lay_hands(figure_, ball.chest_from_ball, grip_, 0, on_ball);
            offsets_ = fading_fingers(context, on_ball, kBlend_s);
        } else {
            offsets_ = ArmOffsets::make(
                context,
                [this](double t, Controls& out) { lay_hands(figure_, own(t), grip_, 0, out); },
                kBlend_s);
        }
    }

    void sample(double t_s, Controls& out) const override {
        lay_hands(figure_, chest_from_ball(t_s), grip_, 0, out);
        offsets_.apply(t_s, out);
    }

 private:
    Transform own(double t_s) const {
        return {rest_.rotation, rest_.translation + sway(at_s_ + t_s)};
    }

    Transform chest_from_ball(double t_s) const {
        if (!held_) {
            return own(t_s);
        }
        Transform ball = swing_.at(t_s);
        ball.translation = ball.translation - rotate(ball.rotation, wrists_ball_) +
                           sway(at_s_ + t_s) - sway(at_s_) + sway_offset_.at(t_s);
        return ball;
    }

    // The middle of the wrists swings about the middle of the shoulders; the ball goes with it.
    void plan_swing(const HeldBall& ball, Vec3 own_velocity) {
        for (const Side side : {Side::kLeft, Side::kRight}) {
            wrists_ball_ = wrists_ball_ + ball_from_hand(figure_, side, grip_).translation * 0.5;
        }
        const auto wrists = [&](const Transform& t) {
            return Transform{t.rotation, t * wrists_ball_};
        };
        const Vec3 left = shoulder_chest(figure_, Side::kLeft),
                   right = shoulder_chest(figure_, Side::kRight);
        const figure::Arm& arm = figure_.arms[0];
        Transform rest = rest_;
        rest.translation = rest.translation + sway(at_s_);
        swing_ =
            SwingingArm({.shoulder = (left + right) * 0.5,
                         .now = wrists(ball.chest_from_ball),
                         .velocity = ball.velocity_chest +
                                     cross(ball.angular_chest,
                                           rotate(ball.chest_from_ball.rotation, wrists_ball_)),
                         .angular = ball.angular_chest,
                         .target = wrists(rest),
                         .longest_m = 0.98 * (arm.upper_m + arm.fore_m),
                         .duration_s = kSwing_s});
        sway_offset_ = InertialOffset3({}, -own_velocity, kBlend_s);
    }

    const figure::Figure& figure_;
    Grip grip_;
    double at_s_ = 0;
    bool held_;
    Transform rest_;
    SwingingArm swing_;
    Vec3 wrists_ball_;
    InertialOffset3 sway_offset_;
    ArmOffsets offsets_;
};

}  // namespace

Transform carried_ball_chest(const figure::Figure& figure, const Grip& grip) {
    const double h = figure.reach_height_m;
    const Vec3 shoulder = shoulder_chest(figure, Side::kLeft);
    const Vec3 place{0, shoulder.y - 0.165 * h, shoulder.z + 0.11 * h + grip.ahead_m};
    return {about_x(easy_pitch(figure, place, grip)), place};
}

MovementPtr make_carry(const MotionContext& context, const CarrySpec& spec) {
    return std::make_shared<Carry>(context, spec);
}

}  // namespace puppetri::motion
