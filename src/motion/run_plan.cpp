// SPDX-License-Identifier: MIT
// Running: between two stances the whole body flies, and the border of two steps lies in the middle
// of the flight. So both feet are in the air when a step is prepared; the support foot lands half a
// stroke ahead of the pelvis. While it flies the pelvis falls freely; on the ground the leg gives
// and pushes it off again with the speed it came with.
#include <array>

#include "gait_plan.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "travel.h"

namespace puppetri::motion {
namespace {

constexpr double kGravity = 9.81;
constexpr double kLandingReach = 0.985,
                 kPushOffReach = 0.988;           // of the leg: knee 20 and 18 degrees
constexpr double kLongestStance = 0.84;           // of the leg, from landing to push off
constexpr double kKick = radians(-68);            // of the foot behind the body
constexpr double kBrake = 5.0, kSetDown_m = 1.2;  // as for walking
// The swing's course from toe off to touch down: parts of its time, and how high the ankle then is
// in parts of the leg.
constexpr std::array<double, 3> kCourse{0.30, 0.60, 0.86};
constexpr std::array<double, 3> kAnkleHeight{0.27, 0.22, 0.07};

class RunPlanner {
 public:
    RunPlanner(const MotionContext& context, const StepSpec& spec)
        : f_(context.figure),
          context_(context),
          spec_(spec),
          support_side_(other(spec.transfer)),
          swing_(foot_state(f_, context, spec.transfer)),
          support_(foot_state(f_, context, support_side_)) {
        T_ = plan_duration_s(context, spec);
        first_ = spec.kind == StepKind::kFirstHalf;
        last_ = spec.kind == StepKind::kLastHalf;
        // A first half step in the air is no start from rest: it goes on as a short whole one.
        const bool flying = first_ && !support_.planted;
        first_ = first_ && !flying;
        n_ = spec.kind == StepKind::kWhole || flying ? T_ : 2 * T_;
        // While a foot stands the body travels by twice the duty factor times the stroke: as far as
        // a leg reaches.
        const double duty = clamp(spec.duty_factor, 0.2, 0.5);
        x_ = std::fmin(spec.stroke_m, longest_run_stroke_m(f_, duty));
        speed_ = x_ / n_;
        lead_ = std::fmin(
            0.1, 0.11 * x_);  // runners land nearly under themselves and push off far behind
        flight_ = (0.5 - duty) * n_;  // half of it
        swing_s_ = 2 * n_ * (1 - duty);
        side_ = support_side_ == Side::kLeft ? 1 : -1;
    }

    StepPlan plan() {
        plan_.runs = true;
        plan_.duration_s = T_;
        plan_.lift_s = first_ ? 0 : -flight_;
        plan_.strike_s = last_ ? T_ - 0.03 * n_ : T_ + flight_;
        plan_.support_strike_s = support_.planted ? -1 : flight_;
        plan_.support_lift_s = last_ ? T_ + 10 : T_ - flight_;
        plan_frame();
        plan_pelvis();
        plan_support_foot();
        plan_transfer_foot();
        return std::move(plan_);
    }

 private:
    double ahead_of_ankles() const { return 0.012 * f_.height_m; }
    Motion3 to_path(Motion3 world) const {
        const Quat q = path_from_world_.rotation;
        return {path_from_world_ * world.position, rotate(q, world.velocity),
                rotate(q, world.acceleration)};
    }

    void plan_frame() {
        plan_.heading_rad = support_.yaw.position;
        floor_y_ = floor_under(f_, context_);
        Vec3 origin;
        if (support_.planted) {
            print_ = footprint_of(f_, support_side_, support_);
            origin = print_.ankle_flat;
        } else {
            origin = context_.now.pelvis.position_world +
                     rotate(about_y(plan_.heading_rad), {side_ * f_.stance_half_width_m, 0,
                                                         x_ / 2 - lead_ - ahead_of_ankles()});
            origin.y = floor_y_ + f_.ankle_height_m;
            print_ = footprint_at(f_, support_side_, origin, plan_.heading_rad);
        }
        origin.y = floor_y_;
        plan_.world_from_path = {about_y(plan_.heading_rad), origin};
        path_from_world_ = inverse(plan_.world_from_path);
    }

    void plan_pelvis() {
        const Motion3 now =
            to_path({context_.now.pelvis.position_world, context_.rate.pelvis_velocity_world, {}});
        Motion1 to{ahead_of_ankles() + x_ / 2 + lead_, speed_, 0};
        if (first_) {
            to.position = now.position.z + speed_ * T_ * 0.55;
        } else if (last_) {
            // Not yet at rest: what is left of the speed dies out in the halt after the step.
            to = {ahead_of_ankles() - 0.07, 0.3 * speed_, 0};
        }
        plan_.pelvis_path.z = plan_travel({now.position.z, now.velocity.z, 0}, to, T_);
        const double midline = -side_ * f_.stance_half_width_m, sway = 0.006 * f_.height_m,
                     rate = sway * kPi / n_;
        plan_.pelvis_path.x = minimum_jerk({0, {now.position.x, now.velocity.x, 0}},
                                           {{T_ / 2, midline + side_ * sway}},
                                           {T_, {midline, last_ ? 0 : -side_ * rate, 0}});
        const double bend = (kPi / n_) * (kPi / n_), yaw = radians(7), list = radians(3);
        plan_.pelvis_yaw =
            minimum_jerk({0, {first_ ? 0 : -side_ * yaw, 0, first_ ? 0 : side_ * yaw * bend}}, {},
                         {T_, {last_ ? 0 : side_ * yaw, 0, last_ ? 0 : -side_ * yaw * bend}});
        const double turn = side_ * list * kPi / n_;
        plan_.pelvis_list = minimum_jerk({0, {0, first_ ? 0 : turn, 0}}, {{T_ / 2, side_ * list}},
                                         {T_, {0, last_ ? 0 : -turn, 0}});
        const double swing = radians(32);
        plan_.arm_swing = minimum_jerk({0, {first_ ? 0 : -side_ * swing, 0, 0}}, {},
                                       {T_, {last_ ? 0 : side_ * swing, 0, 0}});
        plan_.lean_rad = last_ ? radians(-2) : radians(5);
        plan_height(now);
    }

    double hips_over(Side side, Vec3 ankle_path, double t, double reach) const {
        const Vec3 hip = rotate(turn_at(t), f_.legs[index_of(side)].hip_pelvis);
        const Vec3 p = plan_.pelvis_path.at(t).position;
        const double dx = p.x + hip.x - ankle_path.x, dz = p.z + hip.z - ankle_path.z,
                     r = reach * f_.leg_m;
        return ankle_path.y - hip.y + std::sqrt(std::fmax(r * r - dx * dx - dz * dz, 0.04));
    }
    Quat turn_at(double t) const {
        return about_y(plan_.pelvis_yaw.at(t).position) * about_z(plan_.pelvis_list.at(t).position);
    }

    // Free fall at both ends; between landing and take off the leg is a spring: a half wave, whose
    // depth is v t / pi.
    void plan_height(const Motion3& now) {
        const double fall = kGravity * flight_ * flight_ / 2, v = kGravity * flight_,
                     stance = T_ - 2 * flight_;
        // The top of the next flight: so that the next landing leg, half a stroke ahead, just
        // reaches down.
        const double dz = x_ / 2 - lead_ - speed_ * flight_, r = kLandingReach * f_.leg_m;
        const double landing = f_.ankle_height_m - f_.legs[0].hip_pelvis.y +
                               std::sqrt(std::fmax(r * r - dz * dz, 0.04));
        const double top = landing + fall;
        std::vector<Key1> keys;
        keys.push_back({0, {now.position.y, now.velocity.y, support_.planted ? 0 : -kGravity}});
        if (!support_.planted) {
            const double down = now.position.y + now.velocity.y * flight_ - fall;
            keys.push_back({flight_, {down, now.velocity.y - v, -kGravity}});
        }
        if (last_) {
            Controls feet;
            for (const Side side : {Side::kLeft, Side::kRight}) {
                const double s = side == support_side_ ? 0 : -side_ * 2 * f_.stance_half_width_m;
                feet.legs[index_of(side)].ankle_world = {s, f_.ankle_height_m, 0};
            }
            plan_.rest_path = pelvis_over_feet(f_, feet).position_world;
            // Still bent at the knees; the living rest straightens them.
            keys.push_back({T_, {plan_.rest_path.y - 0.025 * f_.height_m, 0.05, 0}});
        } else {
            if (!support_.planted) {
                keys.push_back({T_ / 2, {landing - v * stance / kPi, 0, 3.0 * v / stance}});
            }
            keys.push_back({T_ - flight_, {landing, v, -kGravity}});
            keys.push_back({T_, {top, 0, -kGravity}});
        }
        plan_.pelvis_path.y = Curve1(std::move(keys));
    }

    // Toe off: the heel has risen so far that the leg has its push-off reach under the planned
    // pelvis.
    double lift_pitch() const {
        const double t = plan_.support_lift_s;
        double from = radians(-15), to = radians(-65);
        for (int i = 0; i < 16; ++i) {
            const double middle = (from + to) / 2;
            const Vec3 ankle = path_from_world_ *
                               ankle_on_print(f_, support_side_, print_, {middle, 0, 0}).position;
            (hips_over(support_side_, ankle, t, kPushOffReach) < plan_.pelvis_path.at(t).position.y
                 ? from
                 : to) = middle;
        }
        return to;
    }

    void plan_support_foot() {
        FootPath& foot = plan_.feet[index_of(support_side_)];
        foot.set_body(f_, support_side_);
        std::vector<Key1> pitch;
        double stands_s = 0;
        if (support_.planted) {
            foot.stand(0, print_);
            pitch.push_back({0, {}});
        } else {
            stands_s = flight_;
            const Vec3 way{0, kSetDown_m, -kBrake * 2 * x_};
            const Motion3 to = to_path(ankle_on_print(f_, support_side_, print_, {}));
            foot.swing(0, plan_.world_from_path,
                       swing_curve(0, to_path(support_.ankle), {}, flight_, to,
                                   way * (1 / (swing_s_ * swing_s_))),
                       minimum_jerk({0, support_.yaw}, {}, {flight_, {print_.yaw_rad, 0, 0}}),
                       minimum_jerk_free_start({0, support_.toe_bend}, {}, {flight_, {}}));
            foot.stand(flight_, print_);
            pitch = minimum_jerk_free_start({0, support_.pitch}, {}, {flight_, {}}).keys();
        }
        if (last_) {
            foot.set_pitch(Curve1(std::move(pitch)));
            return;
        }
        const double lift = plan_.support_lift_s, rise = stands_s + 0.35 * (lift - stands_s),
                     at = lift_pitch();
        const double strike = lift + swing_s_;
        const Curve1 swung = minimum_jerk(
            {rise, {}},
            {{lift, at}, {lift + 0.28 * swing_s_, kKick}, {lift + 0.66 * swing_s_, radians(-24)}},
            {strike, {}});
        const std::vector<Key1>& later = swung.keys();
        pitch.insert(pitch.end(), later.begin(), later.end());
        foot.set_pitch(Curve1(std::move(pitch)));
        const Motion1 at_lift = foot.pitch().at(lift);
        Motion3 to;
        to.position = {0, f_.ankle_height_m, 2 * x_};
        swing_on(support_side_, lift, lift,
                 to_path(ankle_on_print(f_, support_side_, print_, at_lift)),
                 {-at_lift.position, -at_lift.velocity, 0}, {plan_.heading_rad, 0, 0}, strike, to);
    }

    void plan_transfer_foot() {
        const Side side = spec_.transfer;
        FootPath& foot = plan_.feet[index_of(side)];
        foot.set_body(f_, side);
        const double strike = plan_.strike_s;
        const double z =
            last_ ? 0 : plan_.pelvis_path.z.at(T_).position + x_ / 2 - lead_ - ahead_of_ankles();
        const Vec3 landing{-side_ * 2 * f_.stance_half_width_m, f_.ankle_height_m, z};
        const Footprint print =
            footprint_at(f_, side, plan_.world_from_path * landing, plan_.heading_rad);
        Motion3 to;
        to.position = landing;
        if (swing_.planted) {
            // From rest: the heel leaves at once.
            foot.set_pitch(
                minimum_jerk({0, {}}, {{0.45 * strike, 0.42 * kKick}, {0.8 * strike, radians(-8)}},
                             {strike, {}}));
        } else {
            std::vector<Waypoint1> way;
            if (last_ || first_) {
                way = {{0.32 * strike, radians(-40)}, {0.68 * strike, radians(-6)}};
            } else {
                if (0.28 * swing_s_ - flight_ > 0.02) {
                    way.push_back({0.28 * swing_s_ - flight_, kKick});
                }
                way.push_back({0.66 * swing_s_ - flight_, radians(-24)});
            }
            foot.set_pitch(minimum_jerk_free_start({0, swing_.pitch}, way, {strike, {}}));
        }
        swing_on(side, 0, plan_.lift_s, to_path(swing_.ankle), swing_.toe_bend, swing_.yaw, strike,
                 to);
        foot.stand(strike, print);
    }

    // The rest of a swing that began (or will begin) at lift_s, from `from` at begin_s on.
    void swing_on(Side side, double begin_s, double lift_s, const Motion3& from, Motion1 bend,
                  Motion1 yaw, double strike_s, Motion3 to) {
        FootPath& foot = plan_.feet[index_of(side)];
        const double d = strike_s - lift_s, part = d / swing_s_;
        const double rise = std::fmin(1, part * part);  // a shorter swing rises less
        // While the foot goes down it must stay clear of the floor whatever its pitch.
        auto clear = [&](double t, double clearance_m) {
            return clearance_m + drop_below_ankle(f_, side, foot.pitch().at(t).position, 0);
        };
        std::vector<Waypoint1> heights;
        if (last_) {
            heights = {{0.48 * strike_s, clear(0.48 * strike_s, 0.05)},
                       {0.8 * strike_s, clear(0.8 * strike_s, 0.02)}};
        } else {
            for (std::size_t i = 0; i < kCourse.size(); ++i) {
                const double t = lift_s + kCourse[i] * d;
                if (t > begin_s + 0.02) {
                    heights.push_back(
                        {t, std::fmax(clear(t, i == 2 ? 0.012 : 0.03),
                                      f_.ankle_height_m + kAnkleHeight[i] * f_.leg_m * rise)});
                }
            }
        }
        const Vec3 end = Vec3{0, kSetDown_m, -kBrake * 2 * x_} * (last_ ? 0.35 : 1);
        foot.swing(begin_s, plan_.world_from_path,
                   swing_curve(begin_s, from, heights, strike_s, to,
                               end * (1 / (swing_s_ * swing_s_)), first_ && begin_s == 0),
                   minimum_jerk({begin_s, yaw}, {}, {strike_s, {plan_.heading_rad, 0, 0}}),
                   minimum_jerk_free_start({begin_s, bend}, {}, {strike_s, {}}));
    }

    static Curve3 swing_curve(double begin_s, const Motion3& from,
                              const std::vector<Waypoint1>& heights, double strike_s,
                              const Motion3& to, Vec3 end_acceleration, bool from_rest = false) {
        const auto minimum = from_rest ? minimum_jerk : minimum_jerk_free_start;
        return {minimum({begin_s, {from.position.x, from.velocity.x, 0}}, {},
                        {strike_s, {to.position.x, 0, 0}}),
                minimum({begin_s, {from.position.y, from.velocity.y, 0}}, heights,
                        {strike_s, {to.position.y, 0, end_acceleration.y}}),
                minimum({begin_s, {from.position.z, from.velocity.z, 0}}, {},
                        {strike_s, {to.position.z, 0, end_acceleration.z}})};
    }

    const figure::Figure& f_;
    const MotionContext& context_;
    const StepSpec& spec_;
    Side support_side_;
    FootState swing_, support_;
    bool first_ = false, last_ = false;
    double T_ = 0, n_ = 0, x_ = 0, speed_ = 0, lead_ = 0, flight_ = 0, swing_s_ = 0, side_ = 1,
           floor_y_ = 0;
    Footprint print_;
    Transform path_from_world_;
    StepPlan plan_;
};

}  // namespace

double longest_run_stroke_m(const figure::Figure& figure, double duty_factor) {
    return kLongestStance * figure.leg_m / (2 * clamp(duty_factor, 0.2, 0.5));
}

StepPlan plan_run(const MotionContext& context, const StepSpec& spec) {
    return RunPlanner(context, spec).plan();
}

}  // namespace puppetri::motion
