// SPDX-License-Identifier: MIT
// Rotations are carried in model space, so that a bone which the raw skeleton lacks hands its
// rotation to the joints below it, and a joint which the humanoid lacks stays as in the T-pose.
#include "puppetri/figure/rig.h"

#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

// Scratch of one thread: results never depend on what it holds.
struct Scratch {
    std::vector<Transform> bones, joints;
};
Scratch& scratch() {
    static thread_local Scratch s;
    return s;
}

}  // namespace

void Rig::to_raw(const Figure& figure, const Skeleton& skeleton, const Pose& pose,
                 Pose& raw) const {
    PUP_REQUIRE(raw_t_pose.size() == skeleton.joints.size());
    Scratch& s = scratch();
    s.bones.resize(figure.skeleton.joints.size());
    to_model_space(figure.skeleton, pose, s.bones);
    s.joints.resize(skeleton.joints.size());
    raw.parent_from_joint.resize(skeleton.joints.size());
    std::size_t next = 0;
    for (std::uint32_t j = 0; j < skeleton.joints.size(); ++j) {
        const JointIndex parent = skeleton.joints[j].parent;
        Transform local = raw_t_pose[j];
        Transform& world = s.joints[j];
        world = parent.valid() ? s.joints[parent.value] * local : local;
        if (next < bones.size() && bones[next].joint.value == j) {
            const RigBone& bone = bones[next++];
            const Transform& model_from_bone = s.bones[bone.bone.value];
            const Transform follows = model_from_bone * bone.bone_from_joint;
            world.rotation = normalized(follows.rotation);
            if (JointIndex{j} == raw_hips || JointIndex{j} == raw_root) {
                world.translation = follows.translation;
            }
            local = parent.valid() ? inverse(s.joints[parent.value]) * world : world;
            local.rotation = normalized(local.rotation);
            if (JointIndex{j} != raw_hips && JointIndex{j} != raw_root) {
                local.translation = raw_t_pose[j].translation;  // bones do not lengthen
            }
        }
        raw.parent_from_joint[j] = local;
    }
}

void Rig::to_figure(const Figure& figure, const Skeleton& skeleton, const Pose& raw,
                    Pose& pose) const {
    PUP_REQUIRE(raw.parent_from_joint.size() == skeleton.joints.size());
    Scratch& s = scratch();
    s.joints.resize(skeleton.joints.size());
    to_model_space(skeleton, raw, s.joints);
    pose = rest_pose(figure.skeleton);
    s.bones.resize(figure.skeleton.joints.size());
    // Bones that no joint follows move with their parents.
    for (std::uint32_t b = 0; b < figure.skeleton.joints.size(); ++b) {
        const JointIndex parent = figure.skeleton.joints[b].parent;
        Transform local = pose.parent_from_joint[b];
        Transform world = parent.valid() ? s.bones[parent.value] * local : local;
        for (const RigBone& bone : bones) {
            if (bone.bone.value == b) {
                const Transform& joint = s.joints[bone.joint.value];
                const Transform leads = joint * inverse(bone.bone_from_joint);
                world.rotation = normalized(leads.rotation);
                if (bone.joint == raw_hips || bone.joint == raw_root) {
                    world.translation = leads.translation;
                }
                local = parent.valid() ? inverse(s.bones[parent.value]) * world : world;
                local.rotation = normalized(local.rotation);
                break;
            }
        }
        s.bones[b] = world;
        pose.parent_from_joint[b] = local;
    }
}

}  // namespace puppetri::figure
