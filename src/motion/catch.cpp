// SPDX-License-Identifier: MIT
// Waiting for a ball, meeting it, taking it.
#include "arm_state.h"
#include "body_accent.h"
#include "puppetri/base/elementary.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/ball_game.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/turn.h"
#include "swinging_arm.h"

namespace puppetri::motion {
namespace {

constexpr double kOpen_m = 0.055;  // how far open hands are off the ball
constexpr double kFastHand_m_s = 2.0;
constexpr double kMeet_s = 0.22;     // the last part of the way to the ball
constexpr double kMeet_m = 0.07;     // how far the hands go to meet it
constexpr double kGiveRatio = 0.28;  // the hands' speed at the catch, in parts of the ball's

double smooth(double x) {
    x = clamp(x, 0, 1);
    return x * x * x * (10 + x * (-15 + 6 * x));
}

// The orientation in which hands wait for a ball at a point of the world.
Quat waiting_rotation(const figure::Figure& figure, const Controls& controls, Vec3 point_world,
                      const Grip& grip) {
    const Transform chest = world_from_chest(figure, controls);
    const Vec3 ahead = rotate(chest.rotation, {0, 0, 1});
    const double level = std::sqrt(ahead.x * ahead.x + ahead.z * ahead.z);
    return about_y(heading_of(ahead)) *
           about_x(easy_pitch(figure, inverse(chest) * point_world, grip) + atan2(-ahead.y, level));
}

Vec3 sway(double at_s) {
    return {0.006 * sin(1.9 * at_s), 0.008 * sin(2.3 * at_s + 1), 0.006 * sin(1.4 * at_s + 2)};
}

class Readiness final : public Movement {
 public:
    Readiness(const MotionContext& given, const ReadySpec& spec, Vec3& catches_at)
        : figure_(given.figure), grip_(spec.grip), at_s_(given.at.seconds()) {
        const MotionContext context = arms_in_chest_space(given);
        limbs = kAllLimbs;
        duration = duration_of(context, spec.duration_s);
        end_s_ = std::fmax(duration.seconds(), 0.05);
        MotionContext fitted = context;
        fitted.duration = duration;
        base_ = make_turn(fitted, {.heading_rad = spec.heading_rad,
                                   .duration_s = end_s_,
                                   .limbs = without(kAllLimbs, kBothArms)});
        phases = base_->phases;
        events = base_->events;
        const double h = crouching_height_m(figure_);
        accent_.ahead_world = {sin(spec.heading_rad), 0, cos(spec.heading_rad)};
        accent_.lift_m = through_rests({{0, 0}, {end_s_, -0.026 * h}});
        accent_.ahead_m = through_rests({{0, 0}, {end_s_, 0.006 * h}});
        accent_.pitch_rad = through_rests({{0, 0}, {end_s_, 0.06}});
        accent_.lean_rad = through_rests({{0, 0}, {end_s_, 0.10}});
        Controls then = context.now;
        body(end_s_, then);
        catches_at_ = catches_at = catching_point(figure_, then);
        rotation_ = waiting_rotation(figure_, then, catches_at_, grip_);
        chest_from_ball_ =
            inverse(world_from_chest(figure_, then)) * Transform{rotation_, catches_at_};
        plan_arms(context);
    }

    void sample(double t_s, Controls& out) const override {
        own(t_s, out);
        if (swings_) {
            for (int i = 0; i < 2; ++i) {
                const Transform swung = swing_[i].at(t_s);
                Transform& hand = out.arms[i].chest_from_hand;
                hand = {normalized(swung.rotation * conjugate(target_[i].rotation) * hand.rotation),
                        hand.translation + swung.translation - target_[i].translation};
            }
        }
        offsets_.apply(t_s, out);
    }

 private:
    void body(double t_s, Controls& out) const {
        base_->sample(t_s, out);
        accent_.apply(t_s, out);
    }
    // Hands that are fast, as after a throw, swing on about the shoulders; others come straight.
    void plan_arms(const MotionContext& context) {
        Controls end = context.now;
        lay_hands(figure_, chest_from_ball_, grip_, kOpen_m, end);
        for (int i = 0; i < 2; ++i) {
            target_[i] = end.arms[i].chest_from_hand;
            swings_ = swings_ || length(context.rate.arms[i].hand_velocity_chest) > kFastHand_m_s;
        }
        if (!swings_) {
            offsets_ = ArmOffsets::make(
                context, [this](double t, Controls& out) { own(t, out); }, 0.95 * end_s_);
            return;
        }
        offsets_ = fading_fingers(context, end, 0.4);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const int i = index_of(side);
            swing_[i] = SwingingArm({.shoulder = shoulder_chest(figure_, side),
                                     .now = context.now.arms[i].chest_from_hand,
                                     .velocity = context.rate.arms[i].hand_velocity_chest,
                                     .angular = context.rate.arms[i].hand_angular_chest,
                                     .target = target_[i],
                                     .longest_m = figure_.arms[i].upper_m + figure_.arms[i].fore_m,
                                     .duration_s = std::fmax(0.7, end_s_)});
        }
    }
    // The open hands are first fixed to the chest, then more and more to the world.
    void own(double t_s, Controls& out) const {
        body(t_s, out);
        const double w = smooth(t_s / end_s_);
        const Transform fixed = inverse(world_from_chest(figure_, out)) *
                                Transform{rotation_, catches_at_ + sway(at_s_ + t_s) * w};
        const Transform at{slerp(chest_from_ball_.rotation, fixed.rotation, w),
                           lerp(chest_from_ball_.translation, fixed.translation, w)};
        lay_hands(figure_, at, grip_, kOpen_m, out);
    }

    const figure::Figure& figure_;
    Grip grip_;
    double at_s_, end_s_ = 0;
    MovementPtr base_;
    BodyAccent accent_;
    Vec3 catches_at_;
    Quat rotation_;
    Transform chest_from_ball_;
    bool swings_ = false;
    std::array<SwingingArm, 2> swing_;
    std::array<Transform, 2> target_;
    ArmOffsets offsets_;
};

class Receive final : public Movement {
 public:
    Receive(const MotionContext& given, const ReceiveSpec& spec)
        : figure_(given.figure),
          base_(spec.base),
          base_age_s_(spec.base_age_s),
          grip_(ball_grip(spec.flight.radius_m)) {
        const MotionContext context = arms_in_chest_space(given);
        const Flight& flight = spec.flight;
        limbs = kAllLimbs;
        duration = flight.duration;
        const double end = std::fmax(duration.seconds(), 0.02),
                     meet = std::fmax(end - kMeet_s, 0.4 * end);
        meeting_ = flight.position(flight.start + flight.duration);
        const Vec3 incoming = flight.velocity(flight.start + flight.duration);
        direction_ = normalized(incoming, {0, -1, 0});
        const double speed = std::fmin(kGiveRatio * length(incoming), 2);
        const double part = (end - meet) / kMeet_s;  // short flights leave less time to meet
        way_ = Curve1({{0, {}},
                       {meet, {-kMeet_m * part, 0, 0}},
                       {end, {0, speed, 0}},
                       {end + 0.3, {0.4 * speed * 0.3, 0, 0}}});
        gap_ = Curve1({{0, {kOpen_m, 0, 0}}, {meet, {kOpen_m + 0.01 * part, 0, 0}}, {end, {}}});
        Controls then = context.now;
        base_->sample(base_age_s_ + end, then);
        rotation_ = waiting_rotation(figure_, then, meeting_, grip_);
        offsets_ = ArmOffsets::make(
            context, [this](double t, Controls& out) { own(t, out); }, 0.8 * end);
    }

    void sample(double t_s, Controls& out) const override {
        own(t_s, out);
        offsets_.apply(t_s, out);
    }

 private:
    void own(double t_s, Controls& out) const {
        base_->sample(base_age_s_ + t_s, out);
        const Transform ball{rotation_, meeting_ + direction_ * way_.at(t_s).position};
        lay_hands(figure_, inverse(world_from_chest(figure_, out)) * ball, grip_,
                  gap_.at(t_s).position, out);
    }

    const figure::Figure& figure_;
    MovementPtr base_;
    double base_age_s_;
    Grip grip_;
    Vec3 meeting_, direction_;
    Quat rotation_;
    Curve1 way_, gap_;
    ArmOffsets offsets_;
};

class Catch final : public Movement {
 public:
    Catch(const MotionContext& given, const CatchSpec& spec) {
        const MotionContext context = arms_in_chest_space(given);
        limbs = kAllLimbs;
        duration = duration_of(context, spec.duration_s);
        events = {{SimTime{0}, "catch", Limb::kPelvis}};
        MotionContext fitted = context;
        fitted.duration = duration;
        base_ = make_idle(
            fitted, {.limbs = without(kAllLimbs, kBothArms), .duration_s = duration.seconds()});
        arms_ = make_carry(fitted, {.grip = spec.grip, .held = spec.held});
        phases = base_->phases;
        events.insert(events.end(), base_->events.begin(), base_->events.end());
        const double h = crouching_height_m(context.figure);
        const Vec3 facing = rotate(context.now.pelvis.rotation_world, {0, 0, 1});
        accent_.ahead_world = normalized(Vec3{facing.x, 0, facing.z}, {0, 0, 1});
        accent_.lift_m = through_rests({{0, 0}, {0.28, -0.022 * h}, {0.8, 0}});
        accent_.ahead_m = through_rests({{0, 0}, {0.25, -0.010 * h}, {0.8, 0}});
        accent_.pitch_rad = through_rests({{0, 0}, {0.22, 0.03}, {0.75, 0}});
        accent_.lean_rad = through_rests({{0, 0}, {0.22, 0.07}, {0.75, 0}});
    }
    void sample(double t_s, Controls& out) const override {
        base_->sample(t_s, out);
        accent_.apply(t_s, out);
        arms_->sample(t_s, out);
    }

 private:
    MovementPtr base_, arms_;
    BodyAccent accent_;
};

}  // namespace

Vec3 catching_point(const figure::Figure& figure, const Controls& controls) {
    if (!figure.humanoid()) {  // nothing catches; it is hit
        return controls.pelvis.position_world + Vec3{0, figure.height_m / 2, 0};
    }
    const Vec3 feet = (controls.legs[0].ankle_world + controls.legs[1].ankle_world) * 0.5;
    const double heading = heading_of(controls.pelvis.rotation_world);
    const double h = figure.reach_height_m;
    const double floor = feet.y - figure.ankle_height_m;
    return {feet.x + 0.24 * h * sin(heading), floor + figure.breast_height_m,
            feet.z + 0.24 * h * cos(heading)};
}

Ready make_ready(const MotionContext& context, const ReadySpec& spec) {
    Ready ready;
    ready.movement = std::make_shared<Readiness>(context, spec, ready.catches_at_world);
    return ready;
}
MovementPtr make_receive(const MotionContext& context, const ReceiveSpec& spec) {
    return std::make_shared<Receive>(context, spec);
}
MovementPtr make_catch(const MotionContext& context, const CatchSpec& spec) {
    return std::make_shared<Catch>(context, spec);
}

}  // namespace puppetri::motion
