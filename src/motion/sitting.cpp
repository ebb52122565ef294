// SPDX-License-Identifier: MIT
#include "puppetri/motion/sitting.h"

#include "living.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/controls_from_pose.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/posed.h"
#include "puppetri/motion/solve_controls.h"

namespace puppetri::motion {
namespace {

// The joint of the hips is this part of the height above the seat: the flesh below it.
constexpr double kFlesh = 0.052;
constexpr double kLean_rad = radians(35);

double smooth(double ratio) { return smooth_rise(ratio, 1); }

// Start space and where the pelvis stands in it, as make_posed sees it: origin on the floor below
// the hips, heading with the pelvis.
struct Ground {
    Transform world_from_start;
    Transform start_from_pelvis;
    Vec3 feet;      // midway between the ankles, on the floor
    Vec3 standing;  // of the hips over the feet
};
Ground ground_of(const MotionContext& context) {
    const Controls& c = context.now;
    Ground g;
    const Vec3 p = c.pelvis.position_world;
    const double floor =
        std::fmin(c.legs[0].ankle_world.y, c.legs[1].ankle_world.y) - context.figure.ankle_height_m;
    g.world_from_start = {about_y(heading_of(c.pelvis.rotation_world)), {p.x, floor, p.z}};
    const Transform start_from_world = inverse(g.world_from_start);
    g.start_from_pelvis = start_from_world * Transform{c.pelvis.rotation_world, p};
    g.feet = start_from_world * ((c.legs[0].ankle_world + c.legs[1].ankle_world) * 0.5);
    g.feet.y = 0;
    Controls feet = c;
    for (LegControl& leg : feet.legs) {
        leg.ankle_world.y = floor + context.figure.ankle_height_m;
    }
    g.standing = start_from_world * pelvis_over_feet(context.figure, feet).position_world;
    return g;
}

// The pelvis goes from one place to another, and the trunk leans on the way.
class Going final : public PoseSource {
 public:
    Transform from, to;
    double duration_s = 1, lean_rad = 0;
    bool hands = false;  // come to lie on the thighs
    std::array<Vec3, 2> on_thighs;

    void sample(double t_s, PoseFrame& frame) const override {
        const double r = duration_s > 0 ? clamp(t_s / duration_s, 0, 1) : 1;
        // The lean comes first and goes last; down and back follow each other closely.
        const double along = smooth(clamp((r - 0.08) / 0.84, 0, 1));
        const double lean =
            lean_rad * smooth(clamp(r / 0.5, 0, 1)) * smooth(clamp((1 - r) / 0.45, 0, 1));
        frame.start_from_pelvis = {
            normalized(slerp(from.rotation, to.rotation, along) * about_x(0.55 * lean)),
            lerp(from.translation, to.translation, along)};
        frame.dofs[0] = 0.25 * lean;   // spine
        frame.dofs[1] = 0.20 * lean;   // chest
        frame.dofs[2] = -0.35 * lean;  // head: keeps looking ahead
        if (hands) {
            for (std::size_t i = 0; i < 2; ++i) {
                frame.paths[i] = on_thighs[i];
            }
        }
    }
};

}  // namespace

Vec3 seated_hips(const figure::Figure& figure, double seat_height_m) {
    const figure::Leg& leg = figure.legs[0];
    const double hip_y = leg.hip_pelvis.y;
    const double knee_y = figure.ankle_height_m + 0.995 * leg.shank_m;
    const double lowest = 0.14 * figure.height_m, highest = 0.36 * figure.height_m;
    const double y = clamp(seat_height_m + kFlesh * figure.height_m, lowest, highest);
    const double drop = y + hip_y - knee_y;  // of the hip joint above the knee
    const double back =
        std::sqrt(std::fmax(leg.thigh_m * leg.thigh_m - drop * drop, 0.04 * leg.thigh_m));
    return {0, y, -0.95 * back + 0.06 * leg.shank_m};
}

bool sits(const MotionContext& context) {
    constexpr double kLow = 0.8, kBehind = 0.15, kStill_m_s = 0.1;
    const figure::Figure& figure = context.figure;
    if (!figure.humanoid() || length(context.rate.pelvis_velocity_world) > kStill_m_s) {
        return false;
    }
    const Ground ground = ground_of(context);
    const Vec3 hips = ground.start_from_pelvis.translation;
    return hips.y < kLow * ground.standing.y && hips.z - ground.feet.z < -kBehind * figure.height_m;
}

namespace {

// Where the wrist of a hand on its thigh is, before the chest.
Vec3 wrist_on_thigh(const figure::Figure& figure, Side side) {
    const double s = side == Side::kLeft ? 1 : -1;
    return Vec3{0.15 * s, -0.315, 0.235} * (figure.height_m / 1.75);
}

}  // namespace

ArmControl arm_on_thigh(const figure::Figure& figure, Side side) {
    Controls c = standing(figure, {}, 0);
    const auto i = static_cast<std::size_t>(index_of(side));
    c.arms[i].chest_from_hand.translation = wrist_on_thigh(figure, side);
    // In line with the forearm.
    figure::Pose pose;
    solve_controls(figure, c, pose);
    pose.parent_from_joint[figure.arms[i].hand.value].rotation = {};
    controls_from_pose(figure, pose, limb_set(arm_of(side)), c);
    return c.arms[i];
}

MovementPtr make_sit(const MotionContext& context, const SitSpec& spec) {
    const Ground ground = ground_of(context);
    auto going = std::make_shared<Going>();
    going->from = ground.start_from_pelvis;
    going->to = {{}, ground.feet + seated_hips(context.figure, spec.seat_height_m)};
    going->duration_s = spec.duration_s;
    const double way = length(going->to.translation - going->from.translation);
    going->lean_rad = kLean_rad * clamp(way / (0.35 * context.figure.height_m), 0, 1);
    going->hands = true;
    for (const Side side : {Side::kLeft, Side::kRight}) {
        going->on_thighs[static_cast<std::size_t>(index_of(side))] =
            wrist_on_thigh(context.figure, side);
    }
    const PosedSpec posed{
        .name = "sit",
        .duration_s = spec.duration_s,
        .dofs = {"spine.flex", "chest.flex", "head.flex"},
        .paths = {{Limb::kLeftArm, PathSpace::kChest}, {Limb::kRightArm, PathSpace::kChest}},
        .travels = true,
        .settle_s = 0.7,
        .stretches = false,
        .also = kAllLimbs};
    return make_posed(context, posed, std::move(going));
}

MovementPtr make_stand_up(const MotionContext& context, const StandUpSpec& spec) {
    const Ground ground = ground_of(context);
    auto going = std::make_shared<Going>();
    going->from = ground.start_from_pelvis;
    going->to = {{}, ground.standing};
    going->duration_s = spec.duration_s;
    const double way = length(going->to.translation - going->from.translation);
    going->lean_rad = kLean_rad * clamp(way / (0.35 * context.figure.height_m), 0, 1);
    const PosedSpec posed{.name = "stand_up",
                          .duration_s = spec.duration_s,
                          .dofs = {"spine.flex", "chest.flex", "head.flex"},
                          .travels = true,
                          .settle_s = 0.7,
                          .stretches = false,
                          .also = kAllLimbs,
                          .gets_up = true};
    return make_posed(context, posed, std::move(going));
}

}  // namespace puppetri::motion
