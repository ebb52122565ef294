// SPDX-License-Identifier: MIT
// A living stand: slow sums of sines with phases from the seed, plus the fading difference to where
// the figure was.
#include "puppetri/motion/idle.h"

#include "foot_path.h"
#include "living.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/inertialize.h"
#include "puppetri/motion/sitting.h"
#include "times.h"

namespace puppetri::motion {
namespace {

// A standing leg is bent by 9 degrees: cos 4.5 degrees of its length. Standing on locked knees
// looks like a doll, and straight legs leave inverse kinematics no room.
constexpr double kStandingReach = 0.9969;
// Fingers of very long arms hang this part of the height above the floor.
constexpr double kOffFloor = 0.03;
constexpr std::size_t kMiddleTip = 8;  // of the fingers' joints
// The pelvis stands this part of the height ahead of the ankles: the foot reaches ahead of them.
constexpr double kPelvisAhead = 0.012;

// How high the hips may be above an ankle so that the leg keeps the standing reach.
double hips_height_over(const figure::Figure& figure, int side, const LegControl& leg, Vec3 pelvis,
                        Quat rotation) {
    const Vec3 hip = rotate(rotation, figure.legs[side].hip_pelvis);
    const double dx = pelvis.x + hip.x - leg.ankle_world.x,
                 dz = pelvis.z + hip.z - leg.ankle_world.z;
    const double reach = kStandingReach * figure.leg_m;
    return leg.ankle_world.y +
           std::sqrt(std::fmax(reach * reach - dx * dx - dz * dz, 0.04 * reach * reach)) - hip.y;
}

// How far below a standing figure's shoulder its wrist may hang so that the fingers stay off the
// floor: of arms that are longer than the shoulders are high.
double room_below_shoulder(const figure::Figure& figure, Side side) {
    const figure::Arm& arm = figure.arms[index_of(side)];
    const auto& joints = figure.skeleton.joints;
    double room_m = -kOffFloor * figure.height_m;
    for (figure::JointIndex j = arm.shoulder; j.valid(); j = joints[j.value].parent) {
        room_m += joints[j.value].parent_from_joint_rest.translation.y;
    }
    // The axes are parallel at rest.
    const figure::Joint& tip = joints[arm.fingers[kMiddleTip].value];
    double hand_m = std::fabs(tip.end_site_joint.x);
    for (figure::JointIndex j = arm.fingers[kMiddleTip]; j.valid() && j != arm.hand;
         j = joints[j.value].parent) {
        hand_m += std::fabs(joints[j.value].parent_from_joint_rest.translation.x);
    }
    return room_m - hand_m;
}

}  // namespace

ArmControl hanging_arm(const figure::Figure& figure, Side side) {
    const figure::Arm& arm = figure.arms[index_of(side)];
    const double s = side == Side::kLeft ? 1 : -1;
    ArmControl control;
    // Elbow bent by about 20 degrees, hand beside the thigh, thumb ahead and a little inward.
    const Vec3 direction = normalized(Vec3{0.13 * s, -1, 0.11});
    const double reach_m = std::fmin(0.983 * (arm.upper_m + arm.fore_m),
                                     std::fmax(room_below_shoulder(figure, side) / -direction.y,
                                               1.05 * std::fabs(arm.upper_m - arm.fore_m)));
    control.chest_from_hand.translation =
        arm.clavicle_chest + arm.shoulder_clavicle + direction * reach_m;
    control.chest_from_hand.rotation =
        about_x(-radians(14)) * about_y(-s * radians(22)) * about_z(-s * radians(86));
    return control;
}

PelvisControl pelvis_over_feet(const figure::Figure& figure, const Controls& feet) {
    const double left = heading_of(feet.legs[0].foot_rotation_world);
    const double heading =
        left + turn_between(left, heading_of(feet.legs[1].foot_rotation_world)) / 2;
    PelvisControl pelvis;
    pelvis.rotation_world = about_y(heading);
    pelvis.position_world = (feet.legs[0].ankle_world + feet.legs[1].ankle_world) * 0.5 +
                            rotate(pelvis.rotation_world, {0, 0, kPelvisAhead * figure.height_m});
    pelvis.position_world.y = std::fmin(
        hips_height_over(figure, 0, feet.legs[0], pelvis.position_world, pelvis.rotation_world),
        hips_height_over(figure, 1, feet.legs[1], pelvis.position_world, pelvis.rotation_world));
    return pelvis;
}

Controls standing(const figure::Figure& figure, Vec3 position_world, double heading_rad) {
    Controls c;
    const Quat heading = about_y(heading_rad);
    if (!figure.humanoid()) {
        c.pelvis = {position_world, heading};
        return c;
    }
    for (const Side side : {Side::kLeft, Side::kRight}) {
        const double s = side == Side::kLeft ? 1 : -1;
        LegControl& leg = c.legs[index_of(side)];
        leg.foot_rotation_world = heading;
        leg.ankle_world = position_world + rotate(heading, {s * figure.stance_half_width_m,
                                                            figure.ankle_height_m, 0});
        c.arms[index_of(side)] = hanging_arm(figure, side);
    }
    c.pelvis = pelvis_over_feet(figure, c);
    return c;
}

namespace {

class Idle final : public Movement {
 public:
    Idle(const MotionContext& context, const IdleSpec& spec)
        : figure_(context.figure),
          living_(context.figure, context.seed, spec.liveliness),
          seated_(!spec.gets_up && sits(context)) {
        limbs = spec.limbs;
        duration =
            context.duration.ticks >= 0 ? context.duration : whole_milliseconds(spec.duration_s);
        plan_feet(context);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            home_.arms[index_of(side)] =
                seated_ ? arm_on_thigh(figure_, side) : hanging_arm(figure_, side);
        }
        if (seated_) {
            home_.pelvis = {context.now.pelvis.position_world,
                            about_y(heading_of(context.now.pelvis.rotation_world))};
        }
        // The own motion at the start and a moment later, against the state that was found.
        Controls own = home_, later = home_;
        live(0, own);
        live(InertialFigure::kMoment_s, later);
        constexpr double kSettle_s = 0.7;
        // Who is cut in full stride stops before the legs are too short.
        const double speed = length(context.rate.pelvis_velocity_world);
        const double stops_s = lerp(kSettle_s, 0.42, clamp((speed - 0.3) / 0.5, 0, 1));
        const Vec3 velocity = (later.pelvis.position_world - own.pelvis.position_world) *
                              (1 / InertialFigure::kMoment_s);
        pelvis_ = {context.now.pelvis.position_world - own.pelvis.position_world,
                   context.rate.pelvis_velocity_world - velocity, stops_s};
        reach_ = KeepReach(figure_, {feet_[0].stands_at(0), feet_[1].stands_at(0)}, context.now);
        MotionContext found = context;
        const ControlsRate rate = rate_between(own, later, InertialFigure::kMoment_s);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            if (spec.at_home.has(arm_of(side))) {
                found.now.arms[index_of(side)] = own.arms[index_of(side)];
                found.rate.arms[index_of(side)] = rate.arms[index_of(side)];
            }
        }
        join_ = InertialFigure(found, own, later, kSettle_s);
    }

    void sample(double t_s, Controls& out) const override {
        Controls c = home_;
        live(t_s, c);
        c.pelvis.position_world = c.pelvis.position_world + pelvis_.at(t_s);
        for (int i = 0; i < 2; ++i) {
            c.legs[i] = feet_[i].at(t_s);
        }
        join_.apply(t_s, c);
        reach_.apply({feet_[0].stands_at(t_s), feet_[1].stands_at(t_s)}, t_s, c);
        copy_limbs(limbs, c, out);
    }

 private:
    void live(double t_s, Controls& c) const {
        seated_ ? living_.add_seated(t_s, c) : living_.add(t_s, 1, c);
    }

    void plan_feet(const MotionContext& context) {
        for (const Side side : {Side::kLeft, Side::kRight}) {
            Landing landing = put_down(figure_, context, side);
            home_.legs[index_of(side)] =
                LegControl{landing.print.ankle_flat, about_y(landing.print.yaw_rad), 0, 0};
            feet_[index_of(side)] = std::move(landing.path);
            const SimTime down = whole_milliseconds(landing.down_s);
            if (landing.down_s > 0) {
                phases.push_back({leg_of(side), Phase::kSwing, {}, down});
                events.push_back({down, "foot_strike", leg_of(side)});
            }
            phases.push_back({leg_of(side), Phase::kSupport, down, kOpenEnd});
        }
        home_.pelvis = pelvis_over_feet(figure_, home_);
    }

    const figure::Figure& figure_;
    Living living_;
    bool seated_;
    Controls home_;
    std::array<FootPath, 2> feet_;
    InertialOffset3 pelvis_;
    InertialFigure join_;
    KeepReach reach_;
};

// A creature stays where it is: what it does alive is for movements that pose its joints.
class Stays final : public Movement {
 public:
    Stays(const MotionContext& context, const IdleSpec& spec) : home_(context.now) {
        limbs = spec.limbs;
        duration =
            context.duration.ticks >= 0 ? context.duration : whole_milliseconds(spec.duration_s);
    }
    void sample(double, Controls& out) const override { copy_limbs(limbs, home_, out); }

 private:
    Controls home_;
};

}  // namespace

MovementPtr make_idle(const MotionContext& context, const IdleSpec& spec) {
    if (!context.figure.humanoid()) {
        return std::make_shared<Stays>(context, spec);
    }
    return std::make_shared<Idle>(context, spec);
}

}  // namespace puppetri::motion
