// SPDX-License-Identifier: MIT
// Each handle is what solve_controls.cpp would have needed to arrive here: the same chains, walked
// forwards.
#include "puppetri/motion/controls_from_pose.h"

#include "limb_planes.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/context.h"
#include "trunk.h"

namespace puppetri::motion {
namespace {

using figure::Figure;
using figure::JointIndex;
using figure::Pose;

// The angle about the line from `start` to `end` that takes the side `zero` to the side of
// `middle`; 0 where either is on the line.
double swivel_between(Vec3 start, Vec3 middle, Vec3 end, Vec3 zero) {
    const Vec3 line = normalized(end - start, {0, -1, 0});
    const Vec3 a = zero - line * dot(zero, line);
    const Vec3 b = (middle - start) - line * dot(middle - start, line);
    if (length(a) < 1e-6 || length(b) < 1e-7) {
        return 0;
    }
    return puppetri::atan2(dot(cross(a, b), line), dot(a, b));
}

class Reader {
 public:
    Reader(const Figure& figure, const Pose& pose, Controls& out)
        : f_(figure), pose_(pose), out_(out), world_from_pelvis_(at(f_.root) * at(f_.hips)) {}

    void pelvis() { out_.pelvis = {world_from_pelvis_.translation, world_from_pelvis_.rotation}; }

    // Solving bends spine, chest and upper chest by a third each, and lets the breath bend the last
    // one back; the head keeps its attitude.
    void body() {
        const Quat breath = breath_rotation(out_.body.breath);
        const Quat trunk =
            at(f_.spine).rotation * at(f_.chest).rotation * at(f_.upper_chest).rotation;
        out_.body.pelvis_from_chest = normalized(trunk * conjugate(breath));
        out_.body.chest_from_head =
            normalized(breath * at(f_.neck).rotation * at(f_.head).rotation);
    }

    void leg(int side) {
        const figure::Leg& leg = f_.legs[side];
        LegControl& control = out_.legs[side];
        const Transform pelvis_from_knee = at(leg.hip) * at(leg.knee);
        const Transform pelvis_from_foot = pelvis_from_knee * at(leg.ankle);
        const Transform foot = world_from_pelvis_ * pelvis_from_foot;
        control.ankle_world = foot.translation;
        control.foot_rotation_world = foot.rotation;
        control.toe_bend_rad = -to_swing_twist(at(leg.toes).rotation, {1, 0, 0}).twist_rad;
        const Quat pelvis = world_from_pelvis_.rotation;
        const Vec3 zero = knee_direction(pelvis, knee_ahead_world(foot.rotation, pelvis));
        const double swivel = swivel_between(leg.hip_pelvis, pelvis_from_knee.translation,
                                             pelvis_from_foot.translation, zero);
        control.swivel_rad = side == figure::kLeft ? -swivel : swivel;
    }

    // Solving lays the collar bone as the hand's place says; the swivel is that of the elbow about
    // the shoulder that it then has.
    void arm(int side) {
        const figure::Arm& arm = f_.arms[side];
        ArmControl& control = out_.arms[side];
        const double s = side == figure::kLeft ? 1 : -1;
        const Transform chest_from_elbow = at(arm.clavicle) * at(arm.shoulder) * at(arm.elbow);
        control.chest_from_hand = chest_from_elbow * at(arm.hand);
        control.world_weight = 0;
        const Transform solved{
            clavicle_rotation(f_, side, control.chest_from_hand.translation, out_.body.breath),
            arm.clavicle_chest};
        const Vec3 elbow = inverse(solved) * chest_from_elbow.translation;
        const Vec3 hand = inverse(solved) * control.chest_from_hand.translation;
        const Vec3 direction = normalized(hand - arm.shoulder_clavicle, {0, -1, 0});
        control.swivel_rad =
            s * swivel_between(arm.shoulder_clavicle, elbow, hand, elbow_direction(s, direction));
        fingers(side);
    }

 private:
    Transform at(JointIndex joint) const { return pose_.parent_from_joint[joint.value]; }

    // Least squares over the components of all finger joints, with the weights' sum 1: two unknowns
    // v, w, relaxed = 1 - v - w.
    void fingers(int side) {
        const figure::HandPoses& poses = f_.hands[side];
        double vv = 0, vw = 0, ww = 0, v1 = 0, w1 = 0;
        for (int i = 0; i < figure::kFingerJointCount; ++i) {
            const Quat a = poses.relaxed[i], b = poses.spread[i], c = poses.grip[i];
            Quat q = at(f_.arms[side].fingers[i]).rotation;
            if (q.x * a.x + q.y * a.y + q.z * a.z + q.w * a.w < 0) {
                q = {-q.x, -q.y, -q.z, -q.w};
            }
            const double db[4] = {b.x - a.x, b.y - a.y, b.z - a.z, b.w - a.w};
            const double dc[4] = {c.x - a.x, c.y - a.y, c.z - a.z, c.w - a.w};
            const double dq[4] = {q.x - a.x, q.y - a.y, q.z - a.z, q.w - a.w};
            for (int k = 0; k < 4; ++k) {
                vv += db[k] * db[k];
                vw += db[k] * dc[k];
                ww += dc[k] * dc[k];
                v1 += db[k] * dq[k];
                w1 += dc[k] * dq[k];
            }
        }
        const double det = vv * ww - vw * vw;
        ArmControl& control = out_.arms[side];
        control.spread = det > 1e-12 ? (v1 * ww - w1 * vw) / det : 0;
        control.grip = det > 1e-12 ? (w1 * vv - v1 * vw) / det : 0;
        control.relaxed = 1 - control.spread - control.grip;
    }

    const Figure& f_;
    const Pose& pose_;
    Controls& out_;
    Transform world_from_pelvis_;
};

}  // namespace

void controls_from_pose(const Figure& figure, const Pose& pose, LimbSet limbs, Controls& out) {
    PUP_REQUIRE(pose.parent_from_joint.size() == figure.skeleton.joints.size());
    Reader reader(figure, pose, out);
    if (limbs.has(Limb::kPelvis)) {
        reader.pelvis();
    }
    if (limbs.has(Limb::kBody)) {
        reader.body();
    }
    for (const Side side : {Side::kLeft, Side::kRight}) {
        if (limbs.has(leg_of(side))) {
            reader.leg(index_of(side));
        }
        if (limbs.has(arm_of(side))) {
            reader.arm(index_of(side));
        }
    }
}

std::vector<JointIndex> joints_of(const Figure& f, Limb limb) {
    if (!f.humanoid()) {
        std::vector<JointIndex> all;
        for (std::uint32_t j = 1; limb == Limb::kBody && j < f.skeleton.joints.size(); ++j) {
            all.push_back({j});
        }
        return all;
    }
    switch (limb) {
        case Limb::kPelvis:
            return {f.hips};
        case Limb::kBody:
            return {f.spine, f.chest, f.upper_chest, f.neck, f.head};
        case Limb::kLeftLeg:
        case Limb::kRightLeg: {
            const figure::Leg& leg = f.legs[limb == Limb::kLeftLeg ? 0 : 1];
            return {leg.hip, leg.knee, leg.ankle, leg.toes};
        }
        case Limb::kLeftArm:
        case Limb::kRightArm: {
            const figure::Arm& arm = f.arms[limb == Limb::kLeftArm ? 0 : 1];
            std::vector<JointIndex> joints{arm.clavicle, arm.shoulder,    arm.shoulder_twist,
                                           arm.elbow,    arm.elbow_twist, arm.hand};
            joints.insert(joints.end(), arm.fingers.begin(), arm.fingers.end());
            return joints;
        }
    }
    return {};
}

}  // namespace puppetri::motion
