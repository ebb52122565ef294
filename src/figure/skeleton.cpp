// SPDX-License-Identifier: MIT
// Look-up and forward kinematics.
#include "puppetri/figure/skeleton.h"

#include "puppetri/base/require.h"

namespace puppetri::figure {

JointIndex Skeleton::find(std::string_view name) const {
    for (std::uint32_t i = 0; i < joints.size(); ++i) {
        if (joints[i].name == name) {
            return {i};
        }
    }
    return {};
}

Pose rest_pose(const Skeleton& skeleton) {
    Pose pose;
    pose.parent_from_joint.reserve(skeleton.joints.size());
    for (const Joint& joint : skeleton.joints) {
        pose.parent_from_joint.push_back(joint.parent_from_joint_rest);
    }
    return pose;
}

void to_model_space(const Skeleton& skeleton, const Pose& pose,
                    std::span<Transform> model_from_joint) {
    PUP_REQUIRE(pose.parent_from_joint.size() == skeleton.joints.size() &&
                model_from_joint.size() == skeleton.joints.size());
    for (std::size_t i = 0; i < skeleton.joints.size(); ++i) {
        const JointIndex parent = skeleton.joints[i].parent;
        model_from_joint[i] = parent.valid()
                                  ? model_from_joint[parent.value] * pose.parent_from_joint[i]
                                  : pose.parent_from_joint[i];
    }
}

}  // namespace puppetri::figure
