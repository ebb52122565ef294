// SPDX-License-Identifier: MIT
// Hands on a ball that rests in the world until it is held: more and more of its place is then that
// before the belly.
#include "puppetri/motion/handling.h"

#include <algorithm>

#include "arm_state.h"
#include "compose.h"
#include "living.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/arms.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/posed.h"
#include "puppetri/motion/sitting.h"
#include "puppetri/motion/solve_controls.h"

namespace puppetri::motion {
namespace {

constexpr double kHalfHand = 0.018;  // half a palm's breadth, of the height
constexpr double kOpen_m = 0.07;     // palms from the ball before they close
constexpr double kGrasp = 0.45;      // part of a picking up until the hands have it
constexpr double kRoll_rad = radians(38);

// Whether no joint of the legs is so much beyond its limits that a foot leaves its place; a heel
// that rises does not count.
bool toes_stay(const figure::Figure& figure, const Controls& c) {
    constexpr double kMoved_m = 0.001;
    figure::Pose pose;
    solve_controls(figure, c, pose);
    std::vector<Transform> model(figure.skeleton.joints.size());
    figure::to_model_space(figure.skeleton, pose, model);
    for (std::size_t i = 0; i < 2; ++i) {
        const figure::Leg& leg = figure.legs[i];
        const Vec3 toes =
            Transform{c.legs[i].foot_rotation_world, c.legs[i].ankle_world} * leg.toes_foot;
        if (length(model[leg.toes.value].translation - toes) > kMoved_m) {
            return false;
        }
    }
    return true;
}

// How deep the body goes, and how it bends, for a ball on the floor.
struct Bend {
    // The joints of the trunk alike: then controls know where the chest is to the millimetre.
    double hips_rad = radians(40), spine_rad = radians(19), chest_rad = radians(19),
           upper_rad = radians(19);
    Vec3 pelvis{0, -0.36, -0.16};  // of a figure of 1.75 m
};

// Of that, beyond which thighs would have to come nearer to the belly than hips allow (120
// degrees), and the feet would leave their place; the trunk may bend farther.
constexpr double kDeepest = 1.05;

// Who sits has bent its hips already, and bends over the seat.
constexpr double kSeated = 0.35;

class Stoop final : public PoseSource {
 public:
    // `part` of the trunk's bend, `squat` of the hips'.
    Stoop(double part, double squat, double scale, double grasp_s, double end_s)
        : part_(part), squat_(squat), scale_(scale), grasp_s_(grasp_s), end_s_(end_s) {}
    void sample(double t_s, PoseFrame& frame) const override {
        constexpr double kStill_s = 0.12;  // before and after the hands close
        const double down = smooth_rise(t_s, grasp_s_ - kStill_s) *
                            smooth_rise(end_s_ - t_s, end_s_ - grasp_s_ - kStill_s);
        const double u = part_ * down, squat = squat_ * down;
        const Bend bend;
        frame.dofs[0] = bend.hips_rad * squat * (scale_ > 0 ? 1 : kSeated);
        frame.dofs[1] = bend.spine_rad * u;
        frame.dofs[2] = bend.chest_rad * u;
        frame.dofs[3] = bend.upper_rad * u;
        frame.dofs[4] = -radians(24) * u;
        frame.paths[0] = bend.pelvis * (scale_ * squat);
    }

 private:
    double part_, squat_, scale_, grasp_s_, end_s_;
};

// The hands' frame at a ball there, for a chest that is where these controls have it.
Quat hands_at(const figure::Figure& figure, const Controls& c, Vec3 ball_world, const Grip& grip,
              double roll_rad) {
    const Transform chest = world_from_chest(figure, c);
    const Quat pitch = about_x(easy_pitch(figure, inverse(chest) * ball_world, grip));
    if (!grip.flat) {
        return normalized(chest.rotation * pitch * about_z(roll_rad));
    }
    // Palms flat on two faces of the box: only about the line between them may the hands turn.
    const Quat hands = chest.rotation * pitch;
    const Quat box = about_y(grip.yaw_rad);
    const Vec3 fingers = rotate(conjugate(box), rotate(hands, {0, 0, 1}));
    return normalized(box * about_x(-puppetri::atan2(fingers.y, std::fmax(fingers.z, 0.1))) *
                      about_z(roll_rad));
}

class Take final : public Movement {
 public:
    // `then`: where the trunk is about when the hands close.
    Take(const MotionContext& given, const TakeSpec& spec, Quat hands_world, const Controls& then)
        : figure_(given.figure), spec_(spec), world_from_hands_{hands_world, spec.ball_world} {
        grasped_ = inverse(world_from_chest(figure_, then)) * world_from_hands_;
        const MotionContext context = arms_in_chest_space(given);
        limbs = kBothArms;
        duration = duration_of(context, spec.grasps_s + spec.brings_s);
        carried_ = carried_ball_chest(figure_, spec.grip);
        offsets_ = ArmOffsets::make(
            context, [this](double t, Controls& out) { own(t, out); }, 0.75 * spec.grasps_s);
    }
    void sample(double t_s, Controls& out) const override {
        own(t_s, out);
        offsets_.apply(t_s, out);
    }

 private:
    void own(double t_s, Controls& out) const {
        const Transform there = inverse(world_from_chest(figure_, out)) * world_from_hands_;
        const double closing = smooth_rise(t_s - 0.45 * spec_.grasps_s, 0.55 * spec_.grasps_s);
        const double brought = smooth_rise(t_s - spec_.grasps_s, spec_.brings_s);
        // Held, it comes along with the chest: one that stayed behind would stretch the arms.
        const double along = smooth_rise(t_s - spec_.grasps_s, 0.25);
        const Transform held{slerp(there.rotation, grasped_.rotation, along),
                             lerp(there.translation, grasped_.translation, along)};
        // Over the knees, not through them.
        const Vec3 ahead = Vec3{0, 0, 0.07} * (4 * brought * (1 - brought));
        lay_hands(figure_,
                  {slerp(held.rotation, carried_.rotation, brought),
                   lerp(held.translation, carried_.translation, brought) + ahead},
                  spec_.grip, kOpen_m * (1 - closing), out);
        keep_in_reach(smooth_rise(t_s - 0.3 * spec_.grasps_s, 0.7 * spec_.grasps_s), out);
    }

    // A ball is out of reach until the trunk has bent: hands that follow it would stretch the arms
    // at once, and bend the elbows at once when it comes near. They come as near as bent arms let
    // them, and straighten only when it is there.
    void keep_in_reach(double there, Controls& out) const {
        const double most = lerp(0.84, 0.985, there), soft = lerp(0.10, 0.02, there);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const figure::Arm& arm = figure_.arms[index_of(side)];
            const double whole = arm.upper_m + arm.fore_m;
            const Vec3 shoulder = shoulder_chest(figure_, side);
            Vec3& hand = out.arms[index_of(side)].chest_from_hand.translation;
            const double far = length(hand - shoulder) / whole, over = far - (most - soft);
            if (over > 0) {
                const double near = over < 2 * soft ? far - over * over / (4 * soft) : most;
                hand = shoulder + (hand - shoulder) * (near / far);
            }
        }
    }

    const figure::Figure& figure_;
    TakeSpec spec_;
    Transform world_from_hands_, grasped_, carried_;
    ArmOffsets offsets_;
};

class Give final : public Movement {
 public:
    Give(const MotionContext& given, const GiveSpec& spec) : figure_(given.figure), spec_(spec) {
        const MotionContext context = arms_in_chest_space(given);
        limbs = kBothArms;
        duration = duration_of(context, spec.duration_s);
        events = {{to_time(kHandOver_s), "hand_over", Limb::kPelvis}};
        from_ = held_ball(context, spec.grip).chest_from_ball;
        // A box is held out square to the one who takes it.
        Grip grip = spec.grip;
        grip.yaw_rad = heading_of(context.now.pelvis.rotation_world);
        world_from_hands_ = {
            hands_at(figure_, context.now, spec.meeting_world, grip, grip.flat ? 0 : kRoll_rad),
            spec.meeting_world};
        offsets_ = ArmOffsets::make(
            context, [this](double t, Controls& out) { own(t, out); }, 0.5);
    }
    void sample(double t_s, Controls& out) const override {
        own(t_s, out);
        offsets_.apply(t_s, out);
    }

 private:
    void own(double t_s, Controls& out) const {
        const Transform there = inverse(world_from_chest(figure_, out)) * world_from_hands_;
        const double out_there = smooth_rise(t_s, 0.85 * kHandOver_s);
        const double open = smooth_rise(t_s - kHandOver_s - 0.04, 0.3);
        lay_hands(figure_,
                  {slerp(from_.rotation, there.rotation, out_there),
                   lerp(from_.translation, there.translation, out_there)},
                  spec_.grip, kOpen_m * open, out);
        const double down = smooth_rise(t_s - kHandOver_s - 0.15, 0.85);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            ArmControl& arm = out.arms[index_of(side)];
            const ArmControl hangs = hanging_arm(figure_, side);
            arm.chest_from_hand = {
                slerp(arm.chest_from_hand.rotation, hangs.chest_from_hand.rotation, down),
                lerp(arm.chest_from_hand.translation, hangs.chest_from_hand.translation, down)};
            arm.swivel_rad = lerp(arm.swivel_rad, hangs.swivel_rad, down);
            arm.spread = lerp(arm.spread, hangs.spread, down);
            arm.grip = lerp(arm.grip, hangs.grip, down);
            arm.relaxed = lerp(arm.relaxed, hangs.relaxed, down);
        }
    }

    const figure::Figure& figure_;
    GiveSpec spec_;
    Transform from_, world_from_hands_;
    ArmOffsets offsets_;
};

double reach_to(const figure::Figure& figure, const Controls& c, Vec3 ball_world,
                const Grip& grip) {
    const Transform ball{hands_at(figure, c, ball_world, grip, 0), ball_world};
    const Transform chest_from_ball = inverse(world_from_chest(figure, c)) * ball;
    double most = 0;
    for (const Side side : {Side::kLeft, Side::kRight}) {
        const figure::Arm& arm = figure.arms[index_of(side)];
        const Vec3 hand = (chest_from_ball * ball_from_hand(figure, side, grip)).translation;
        most = std::fmax(most,
                         length(hand - shoulder_chest(figure, side)) / (arm.upper_m + arm.fore_m));
    }
    return most;
}

}  // namespace

PickUp make_pick_up(const MotionContext& context, const PickUpSpec& spec) {
    constexpr double kEasy = 0.93, kFarthest = 0.985;
    const figure::Figure& figure = context.figure;
    const double scale =
        sits(context) ? 0 : figure.height_m / 1.75;  // who sits bends over the seat
    const double own_s = context.duration.ticks > 0 ? context.duration.seconds() : spec.duration_s;
    const double grasp_s = kGrasp * own_s;
    const PosedSpec posed{
        .name = "pick_up",
        .duration_s = own_s,
        .dofs = {"hips.flex", "spine.flex", "chest.flex", "upper_chest.flex", "head.flex"},
        .paths = {{Limb::kPelvis, PathSpace::kStart}}};
    // As deep as the arms need.
    MovementPtr body;
    Controls low = context.now;
    double reach = 2;
    double squat = 0;
    for (double part = 0; part < 1.35 && reach > kEasy; part += 0.1) {
        const auto stoop = [&](double hips) {
            body = make_posed(context, posed,
                              std::make_shared<Stoop>(part, hips, scale, grasp_s, own_s));
            body->sample(grasp_s, low);
        };
        const double deeper = std::fmin(part, kDeepest);
        stoop(deeper);
        // In mid-stride the thigh ahead comes near the belly earlier.
        if (squat < deeper && !toes_stay(figure, low)) {
            stoop(squat);
        } else {
            squat = deeper;
        }
        reach = reach_to(figure, low, spec.ball_world, spec.grip);
    }
    Vec3 at_world = spec.ball_world;
    const double floor_y =
        std::fmin(low.legs[0].ankle_world.y, low.legs[1].ankle_world.y) - figure.ankle_height_m;
    const double lowest_y = floor_y + kHalfHand * figure.height_m;
    const bool too_flat = spec.grip.flat && at_world.y < lowest_y;
    if (too_flat) {
        at_world.y = lowest_y;  // the hands close above it
    }
    if (reach > kFarthest) {  // the hands go towards where it might lie, before the feet
        const Vec3 feet = (low.legs[0].ankle_world + low.legs[1].ankle_world) * 0.5;
        const Vec3 before =
            feet + rotate(about_y(heading_of(low.pelvis.rotation_world)),
                          {0, spec.grip.half_m - figure.ankle_height_m, 0.23 * figure.height_m});
        const Vec3 shoulders =
            world_from_chest(figure, low) *
            ((shoulder_chest(figure, Side::kLeft) + shoulder_chest(figure, Side::kRight)) * 0.5);
        const double arm = figure.arms[0].upper_m + figure.arms[0].fore_m,
                     far = length(before - shoulders);
        at_world = shoulders + (before - shoulders) * std::fmin(1, 0.8 * arm / far);
    }
    const Quat hands = hands_at(figure, low, at_world, spec.grip, 0);
    auto arms = std::make_shared<Take>(context,
                                       TakeSpec{.grip = spec.grip,
                                                .ball_world = at_world,
                                                .grasps_s = grasp_s,
                                                .brings_s = 0.92 * (own_s - grasp_s)},
                                       hands, low);
    arms->events = {{to_time(grasp_s), "grasp", Limb::kPelvis}};
    PickUp made;
    made.movement = side_by_side(std::move(body), std::move(arms));
    made.grasps_after = to_time(grasp_s);
    made.reaches = reach <= kFarthest && 2 * spec.grip.half_m <= kWidestGrip_m;
    made.too_flat = too_flat;
    return made;
}

HandOver meeting_of(const figure::Figure& giver, const Controls& from, const figure::Figure& taker,
                    const Controls& to) {
    const Vec3 a = from.pelvis.position_world, b = to.pelvis.position_world;
    Vec3 meeting = (a + b) * 0.5;
    meeting.y = 0.5 * (0.62 * giver.height_m + 0.62 * taker.height_m);
    const double apart = length(Vec3{b.x - a.x, 0, b.z - a.z});
    const double reach =
        giver.arms[0].upper_m + giver.arms[0].fore_m + taker.arms[0].upper_m + taker.arms[0].fore_m;
    constexpr double kBefore_rad = radians(40);
    const auto faces = [&](const figure::Figure& figure, const Controls& c, Vec3 way) {
        return std::fabs(turn_between(heading_of(way),
                                      heading_of(pelvis_over_feet(figure, c).rotation_world))) <
               kBefore_rad;
    };
    return {meeting, apart > 0.5 && apart < 0.95 * reach && faces(giver, from, b - a) &&
                         faces(taker, to, a - b)};
}

MovementPtr make_give(const MotionContext& context, const GiveSpec& spec) {
    return side_by_side(
        make_idle(context, {.limbs = without(kAllLimbs, kBothArms), .duration_s = spec.duration_s}),
        std::make_shared<Give>(context, spec));
}

MovementPtr make_take(const MotionContext& context, const TakeSpec& spec) {
    return std::make_shared<Take>(
        context, spec,
        hands_at(context.figure, context.now, spec.ball_world, spec.grip, spec.roll_rad),
        context.now);
}

}  // namespace puppetri::motion
