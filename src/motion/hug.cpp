// SPDX-License-Identifier: MIT
// The hands go along curves in the space of the other's chest, as it stands when the embrace
// begins.
#include "puppetri/motion/hug.h"

#include "arm_state.h"
#include "compose.h"
#include "living.h"
#include "puppetri/math/quintic.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/posed.h"

namespace puppetri::motion {
namespace {

class Arms final : public Movement {
 public:
    Arms(const MotionContext& given, const HugSpec& spec) : figure_(given.figure) {
        const MotionContext context = arms_in_chest_space(given);
        limbs = kBothArms;
        duration = duration_of(context, spec.duration_s);
        pace_ = duration.ticks > 0 ? spec.duration_s / duration.seconds() : 1;
        world_from_other_ = world_from_chest(spec.other, spec.other_now);
        // Upright: the other sways and breathes.
        world_from_other_.rotation = about_y(heading_of(world_from_other_.rotation));
        const double k = spec.other.height_m / 1.75;
        for (const Side side : {Side::kLeft, Side::kRight}) {
            // My left arm goes around its right side.
            const double s = side == Side::kLeft ? -1 : 1;
            const double y = (side == Side::kLeft ? -0.13 : 0.03) * k;
            const Vec3 open{0.44 * s * k, y, 0.24 * k}, beside{0.36 * s * k, y, -0.07 * k},
                behind{0.20 * s * k, y, -0.150 * k}, on{0.12 * s * k, y, -0.116 * k};
            const auto curve = [&](double Vec3::*axis) {
                return Curve1({{0, {open.*axis, 0, 0}},
                               {0.55, {open.*axis, 0, 0}},
                               {0.95, {beside.*axis, 0.9 * (behind.*axis - open.*axis), 0}},
                               {1.20, {behind.*axis, 0.8 * (on.*axis - beside.*axis), 0}},
                               {1.50, {on.*axis, 0, 0}},
                               {1.95, {on.*axis, 0, 0}},
                               {2.25, {behind.*axis, -0.8 * (on.*axis - beside.*axis), 0}},
                               {2.50, {beside.*axis, -0.9 * (behind.*axis - open.*axis), 0}},
                               {2.85, {open.*axis, 0, 0}}});
            };
            way_[static_cast<std::size_t>(index_of(side))] = {curve(&Vec3::x), curve(&Vec3::y),
                                                              curve(&Vec3::z)};
        }
        offsets_ = ArmOffsets::make(
            context, [this](double t, Controls& out) { own(t, out); }, 0.45);
    }
    void sample(double t_s, Controls& out) const override {
        own(t_s, out);
        offsets_.apply(t_s, out);
    }

 private:
    void own(double t_s, Controls& out) const {
        const double t = t_s * pace_;
        const Transform chest_from_other =
            inverse(world_from_chest(figure_, out)) * world_from_other_;
        // From thumbs up beside the other to palms flat on its back.
        const double around = smooth_rise(t - 0.55, 0.75) * smooth_rise(2.75 - t, 0.7);
        const double down = smooth_rise(t - 2.45, 0.75);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const auto i = static_cast<std::size_t>(index_of(side));
            const double s = side == Side::kLeft ? -1 : 1;
            const Vec3 at = {way_[i].x.at(t).position, way_[i].y.at(t).position,
                             way_[i].z.at(t).position};
            // Fingers towards the middle of the back, palms to it; before that, fingers ahead.
            const Quat on_back = from_basis({1, 0, 0}, {0, 0, -1}, {0, 1, 0});
            const Quat ahead = about_y(-s * radians(80)) * on_back;
            const Transform hand{slerp(ahead, on_back, around), at};
            ArmControl& arm = out.arms[i];
            const ArmControl hangs = hanging_arm(figure_, side);
            const Transform there = chest_from_other * hand;
            arm.chest_from_hand = {
                slerp(there.rotation, hangs.chest_from_hand.rotation, down),
                lerp(there.translation, hangs.chest_from_hand.translation, down)};
            arm.world_weight = 0;
            arm.swivel_rad = lerp(radians(35), hangs.swivel_rad, down);
            arm.relaxed = lerp(0.7, 1, down);
            arm.spread = 1 - arm.relaxed;
            arm.grip = 0;
        }
    }

    const figure::Figure& figure_;
    double pace_ = 1;
    Transform world_from_other_;
    std::array<Curve3, 2> way_;
    ArmOffsets offsets_;
};

// A little towards the other, the head aside.
class Leaning final : public PoseSource {
 public:
    void sample(double t_s, PoseFrame& frame) const override {
        const double u = smooth_rise(t_s - 0.3, 1.0) * smooth_rise(kHug_s - 0.2 - t_s, 1.0);
        frame.dofs[0] = radians(5) * u;
        frame.dofs[1] = radians(5) * u;
        frame.dofs[2] = radians(10) * u;
        frame.paths[0] = Vec3{0, -0.005, 0.02} * u;
    }
};

}  // namespace

double hug_distance_m(double height_m) { return 0.21 * height_m; }

Hug make_hug(const MotionContext& context, const HugSpec& spec) {
    const Vec3 way = spec.other_now.pelvis.position_world - context.now.pelvis.position_world;
    const double apart = length(Vec3{way.x, 0, way.z});
    const double usual = hug_distance_m(0.5 * (context.figure.height_m + spec.other.height_m));
    Hug made;
    const double aside = turn_between(
        heading_of(way), heading_of(pelvis_over_feet(context.figure, context.now).rotation_world));
    constexpr double kBefore_rad = radians(40);
    made.near = apart > 0.75 * usual && apart < 1.3 * usual && std::fabs(aside) < kBefore_rad;
    const PosedSpec posed{.name = "hug",
                          .duration_s = kHug_s,
                          .dofs = {"hips.flex", "chest.flex", "head.side"},
                          .paths = {{Limb::kPelvis, PathSpace::kStart}}};
    made.movement = side_by_side(make_posed(context, posed, std::make_shared<Leaning>()),
                                 std::make_shared<Arms>(context, spec));
    return made;
}

}  // namespace puppetri::motion
