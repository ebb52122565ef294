// SPDX-License-Identifier: MIT
// The underarm throw with both hands. The middle of the wrists moves on an arc about the middle of
// the shoulders: angle theta from straight down, distance rho. At the release the hands do not
// turn, so that wrists, palms and ball have one velocity v, the one that the flight needs. With the
// velocity s of the shoulders the arms owe v - s; theta is chosen so that this is tangent to the
// arc, for arms are fast across and slow along.
#include "arm_state.h"
#include "body_accent.h"
#include "foot_path.h"
#include "puppetri/base/elementary.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/ball_game.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/idle.h"

namespace puppetri::motion {
namespace {

constexpr double kMoment_s = 1e-4;
// Distances from the shoulders to the wrists, in parts of the height: arms nearly straight, with
// room to swing on.
constexpr double kLowReach = 0.300, kReleaseReach = 0.320;
constexpr double kBentBack_rad = 0.0;  // of the wrists at the release
// How far the arms swing, from before the thighs to the release.
constexpr double kSwing_rad = 0.75;

class Throw final : public Movement {
 public:
    Throw(const MotionContext& given, const ThrowSpec& spec)
        : figure_(given.figure),
          held_(spec.held),
          grip_(spec.grip),
          target_(spec.target_world),
          flight_s_(spec.flight_s) {
        const MotionContext context = arms_in_chest_space(given);
        held_ = held_ && hands_hold(context, grip_);
        limbs = kAllLimbs;
        duration = duration_of(context, spec.duration_s);
        release_s_ = std::fmax(duration.seconds(), 0.05);
        events = {{duration, "release", Limb::kPelvis}};
        base_ =
            make_idle(context, {.limbs = without(kAllLimbs, kBothArms), .duration_s = release_s_});
        phases = base_->phases;
        for (const PhaseSpan& span : phases) {
            if (span.phase == Phase::kSupport) {
                down_s_[span.limb == Limb::kLeftLeg ? 0 : 1] = span.begin.seconds();
            }
        }
        reach_ = KeepReach(figure_, stands(0), context.now);
        for (const MovementEvent& event : base_->events) {
            if (event.after_start <= duration) {
                events.insert(events.end() - 1, event);
            }
        }
        plan_body(context);
        plan_arms(context);
        plan_follow_through(context);
    }

    void sample(double t_s, Controls& out) const override {
        body(t_s, out);
        if (t_s > release_s_) {
            after_->sample(t_s - release_s_, out);
            return;
        }
        hands(t_s, out);
    }

 private:
    void body(double t_s, Controls& out) const {
        base_->sample(t_s, out);
        accent_.apply(t_s, out);
        reach_.apply(stands(t_s), t_s, out);
    }
    std::array<bool, 2> stands(double t_s) const { return {t_s >= down_s_[0], t_s >= down_s_[1]}; }

    Vec3 shoulders(const Controls& controls) const {
        return world_from_chest(figure_, controls) *
               ((shoulder_chest(figure_, Side::kLeft) + shoulder_chest(figure_, Side::kRight)) *
                0.5);
    }

    void plan_body(const MotionContext& context) {
        Controls now = context.now;
        // A target behind the back cannot be thrown at: the throw then goes as far aside as it can.
        const double aside = aside_rad(figure_, now, target_),
                     turn = aside - clamp(aside, -kMostAside_rad, kMostAside_rad);
        const Vec3 centre = now.pelvis.position_world;
        target_ = centre + rotate(about_y(turn), target_ - centre);
        const Vec3 way = target_ - centre;
        const Vec3 facing = rotate(pelvis_over_feet(figure_, now).rotation_world, {0, 0, 1});
        accent_.ahead_world =
            normalized(Vec3{way.x, 0, way.z}, normalized(Vec3{facing.x, 0, facing.z}, {0, 0, 1}));
        const double h = crouching_height_m(figure_), r = release_s_;
        low_s_ = 0.56 * r;
        const double end = r + 0.7, back = 0.85 / r;  // speeds scale with a fitted duration
        accent_.lift_m = Curve1({{0, {}},
                                 {low_s_, {-0.05 * h, 0, 0}},
                                 {r, {-0.012 * h, 0.08 * h * back, 0}},
                                 {end, {}}});
        accent_.ahead_m = Curve1({{0, {}},
                                  {low_s_, {-0.030 * h, 0, 0}},
                                  {r, {0.020 * h, 0.10 * h * back, 0}},
                                  {end, {}}});
        accent_.pitch_rad =
            Curve1({{0, {}}, {low_s_, {0.24, 0, 0}}, {r, {0.02, -0.3 * back, 0}}, {end, {}}});
        accent_.lean_rad =
            Curve1({{0, {}}, {low_s_, {0.42, 0, 0}}, {r, {0.06, -0.7 * back, 0}}, {end, {}}});
        const double twist =
            -clamp(aside, -kMostAside_rad, kMostAside_rad);  // the shoulders face the target
        accent_.twist_rad = through_rests({{0, 0}, {low_s_, twist}, {r, twist}, {end, 0}});
        // Aim from where the shoulders will be.
        Controls then = context.now;
        body(r, then);
        const Vec3 aim = target_ - shoulders(then);
        ahead_ = normalized(Vec3{aim.x, 0, aim.z}, accent_.ahead_world);
        left_ = cross(Vec3{0, 1, 0}, ahead_);
        aim_ = from_basis(left_, {0, 1, 0}, ahead_);
    }

    // Wrists relative to the shoulders, as the arc has them.
    struct Arc {
        double theta = 0, rho = 0, side = 0;
    };
    Arc to_arc(Vec3 from_shoulders) const {
        const double z = dot(from_shoulders, ahead_), y = from_shoulders.y;
        return {atan2(z, -y), std::sqrt(y * y + z * z), dot(from_shoulders, left_)};
    }
    Vec3 from_arc(const Arc& a) const {
        return left_ * a.side + Vec3{0, -a.rho * cos(a.theta), 0} + ahead_ * (a.rho * sin(a.theta));
    }

    void plan_arms(const MotionContext& context) {
        const double h = figure_.reach_height_m, r = release_s_;
        for (const Side side : {Side::kLeft, Side::kRight}) {
            wrists_ball_ = wrists_ball_ + ball_from_hand(figure_, side, grip_).translation * 0.5;
        }
        const Transform chest = world_from_chest(figure_, context.now);
        const Vec3 spin =
            context.rate.pelvis_angular_world +
            rotate(context.now.pelvis.rotation_world, context.rate.chest_angular_pelvis);
        const auto &left = context.now.arms[0], &right = context.now.arms[1];
        const Vec3 now =
            chest * ((left.chest_from_hand.translation + right.chest_from_hand.translation) * 0.5) -
            shoulders(context.now);
        const Vec3 rate = rotate(chest.rotation, (context.rate.arms[0].hand_velocity_chest +
                                                  context.rate.arms[1].hand_velocity_chest) *
                                                     0.5) +
                          cross(spin, now);
        const Arc a = to_arc(now), b = to_arc(now + rate * kMoment_s);

        // The release: place and velocity, by iterating the tangent condition.
        Controls before = context.now, then = context.now;
        body(r - kMoment_s, before);
        body(r, then);
        const Vec3 shoulders_then = shoulders(then);
        const Vec3 shoulders_rate = (shoulders_then - shoulders(before)) * (1 / kMoment_s);
        Arc release{0.75, kReleaseReach * h, 0};
        double pitch = 0.8;
        Vec3 owed;
        for (int i = 0; i < 12; ++i) {
            const Vec3 ball =
                shoulders_then + from_arc(release) - rotate(aim_ * about_x(pitch), wrists_ball_);
            const SimTime flight =
                flight_s_ > 0 ? to_time(flight_s_) : flight_duration(ball, target_);
            owed = launch_velocity(ball, target_, flight) - shoulders_rate;
            release.theta = clamp(atan2(owed.y, dot(owed, ahead_)), 0.35, 1.15);
            pitch = easy_pitch_at(then, ball) + kBentBack_rad;
        }
        const Vec3 along{0, -cos(release.theta), sin(release.theta)};  // in left, up, ahead
        const Vec3 across{0, sin(release.theta), cos(release.theta)};
        const Vec3 owed_aim{dot(owed, left_), owed.y, dot(owed, ahead_)};
        const double theta_rate = dot(owed_aim, across) / release.rho,
                     rho_rate = dot(owed_aim, along);

        // From rest to theta_rate a quintic needs about 2.5 times the mean time; a slow throw
        // swings as long as a fast one, but less far.
        const double swing_s = std::fmin(clamp(2.5 * kSwing_rad / theta_rate, 0.12, 0.3), 0.45 * r),
                     low = r - swing_s;
        const double low_theta = release.theta - theta_rate * swing_s / 2.5;
        theta_ = Curve1({{0, {a.theta, (b.theta - a.theta) / kMoment_s, 0}},
                         {low, {low_theta, 0, 0}},
                         {r, {release.theta, theta_rate, 0}}});
        rho_ = Curve1({{0, {a.rho, (b.rho - a.rho) / kMoment_s, 0}},
                       {low, {kLowReach * h, 0, 0}},
                       {r, {release.rho, rho_rate, 0}}});
        side_ = Curve1({{0, {a.side, (b.side - a.side) / kMoment_s, 0}}, {r, {0, owed_aim.x, 0}}});
        plan_hands(context, low, pitch, chest, spin);
    }

    // The pitch of hands and ball: in line with the forearms at the start and the low point.
    void plan_hands(const MotionContext& context, double low_s, double end, const Transform& chest,
                    Vec3 spin) {
        const HeldBall ball = held_ball(context, grip_);
        const double start = easy_pitch_at(context.now, chest * ball.chest_from_ball.translation);
        Controls low = context.now;
        body(low_s, low);
        const double low_pitch =
            easy_pitch_at(low, wrists_world(low_s, low) + Vec3{0, wrists_ball_.z, 0});
        pitch_ =
            Curve1({{0, {start, 0, 0}}, {low_s, {low_pitch, 0, 0}}, {release_s_, {end, 0, 0}}});
        const Quat now = chest.rotation * ball.chest_from_ball.rotation;
        const Vec3 offset = to_rotation_vector(now * conjugate(aim_ * about_x(start)));
        turn_ = InertialOffset3(
            offset, rotation_vector_rate(offset, spin + rotate(chest.rotation, ball.angular_chest)),
            0.9 * low_s);
        if (!held_) {
            offsets_ = ArmOffsets::make(
                context,
                [this](double t, Controls& out) {
                    body(t, out);
                    hands(t, out);
                },
                0.9 * low_s);
            return;
        }
        Controls on_ball = context.now;
        lay_hands(figure_, ball.chest_from_ball, grip_, 0, on_ball);
        offsets_ = fading_fingers(context, on_ball, 0.9 * low_s);
    }
    double easy_pitch_at(const Controls& controls, Vec3 ball_world) const {
        const Transform chest = world_from_chest(figure_, controls);
        const Vec3 chest_ahead = rotate(chest.rotation, {0, 0, 1});
        return easy_pitch(figure_, inverse(chest) * ball_world, grip_) +
               atan2(-chest_ahead.y, dot(chest_ahead, ahead_));
    }

    Vec3 wrists_world(double t_s, const Controls& controls) const {
        return shoulders(controls) +
               from_arc({theta_.at(t_s).position, rho_.at(t_s).position, side_.at(t_s).position});
    }

    void hands(double t_s, Controls& out) const {
        const Quat rotation = normalized(from_rotation_vector(turn_.at(t_s)) * aim_ *
                                         about_x(pitch_.at(t_s).position));
        const Transform world_from_ball{rotation,
                                        wrists_world(t_s, out) - rotate(rotation, wrists_ball_)};
        lay_hands(figure_, inverse(world_from_chest(figure_, out)) * world_from_ball, grip_, 0,
                  out);
        offsets_.apply(t_s, out);
    }

    // After the release, should nobody else want the arms.
    void plan_follow_through(const MotionContext& context) {
        MotionContext then = context;
        then.at = context.at + duration;
        then.duration = {-1};
        Controls before = context.now;
        body(release_s_ - kMoment_s, before);
        hands(release_s_ - kMoment_s, before);
        then.now = context.now;
        body(release_s_, then.now);
        hands(release_s_, then.now);
        then.rate = rate_between(before, then.now, kMoment_s);
        after_ = make_relax(then, 1);
    }

    const figure::Figure& figure_;
    bool held_;
    Grip grip_;
    double release_s_ = 0, low_s_ = 0;
    Vec3 target_;
    double flight_s_;
    MovementPtr base_, after_;
    BodyAccent accent_;
    std::array<double, 2> down_s_{};
    KeepReach reach_;
    Vec3 ahead_, left_, wrists_ball_;
    Quat aim_;
    Curve1 theta_, rho_, side_, pitch_;
    InertialOffset3 turn_;
    ArmOffsets offsets_;
};

}  // namespace

double aside_rad(const figure::Figure& figure, const Controls& controls, Vec3 target_world) {
    return turn_between(heading_of(target_world - controls.pelvis.position_world),
                        heading_of(pelvis_over_feet(figure, controls).rotation_world));
}

MovementPtr make_throw(const MotionContext& context, const ThrowSpec& spec) {
    return std::make_shared<Throw>(context, spec);
}

}  // namespace puppetri::motion
