// SPDX-License-Identifier: MIT
#include "puppetri/motion/look.h"

#include <array>
#include <vector>

#include "arm_state.h"
#include "puppetri/motion/chain_ik.h"
#include "puppetri/motion/controls_from_pose.h"
#include "puppetri/motion/inertialize.h"
#include "puppetri/motion/solve_controls.h"

namespace puppetri::motion {
namespace {

// The part of their ranges that joints use for looking: 45 degrees to the side for the trunk, 80
// for neck and head.
constexpr double kOfTrunk = 0.6, kOfNeck = 0.9;

// Farther to the side or up nobody looks: bending over backwards would get there, too.
constexpr double kSide_rad = radians(115), kUp_rad = radians(60);

class Look final : public Movement {
 public:
    Look(const MotionContext& context, const BodyControl& own, double duration_s) : own_(own) {
        limbs = limb_set(Limb::kBody);
        duration = duration_of(context, duration_s);
        offset_ = InertialBody(context.now.body, context.rate, own_, {}, duration.seconds());
    }
    void sample(double t_s, Controls& out) const override {
        out.body = own_;
        offset_.apply(t_s, out.body);
    }

 private:
    BodyControl own_;
    InertialBody offset_;
};

}  // namespace

LookMovement make_look(const MotionContext& context, const LookSpec& spec) {
    const figure::Figure& f = context.figure;
    // From upright, so that where it looked before does not show in how it looks now.
    Controls controls = context.now;
    controls.body = {};
    figure::Pose pose;
    solve_controls(f, controls, pose);
    std::vector<Transform> world(f.skeleton.joints.size());
    figure::to_model_space(f.skeleton, pose, world);
    const Vec3 eyes = world[f.head.value] * f.eyes_head;
    const Quat ahead = about_y(heading_of(context.now.pelvis.rotation_world));
    const Vec3 way = rotate(conjugate(ahead), spec.target_world - eyes);
    const double level = std::sqrt(way.x * way.x + way.z * way.z);
    const Quat gaze = about_y(clamp(heading_of(way), -kSide_rad, kSide_rad)) *
                      about_x(-clamp(puppetri::atan2(way.y, level), -kUp_rad, kUp_rad));
    const Vec3 seen = rotate(gaze, {0, 0, length(way)});
    const double trunk = clamp(spec.trunk, 0, 1);
    const std::array joints{f.spine, f.chest, f.upper_chest, f.neck, f.head};
    // Of what is left at each joint; the trunk's in equal parts.
    const std::array shares{trunk / 3, trunk / 3 / (1 - trunk / 3), trunk / 3 / (1 - 2 * trunk / 3),
                            0.5, 1.0};
    const LookAtOutcome outcome = look_at(
        {f.skeleton, f.limits, joints},
        {.target_model = eyes + rotate(ahead, seen), .eye_joint = f.eyes_head, .shares = shares},
        pose);
    controls_from_pose(f, pose, limb_set(Limb::kBody), controls);
    return {std::make_shared<Look>(context, controls.body, spec.duration_s),
            outcome.residual_rad + puppetri::atan2(length(cross(way, seen)), dot(way, seen))};
}

}  // namespace puppetri::motion
