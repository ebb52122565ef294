// SPDX-License-Identifier: MIT
#include "character_rest.h"

#include <set>
#include <string>
#include <vector>

namespace puppetri::io {

figure::Skeleton with_rest(const figure::Character& character, bool a_pose) {
    const figure::Humanoid& humanoid = *character.humanoid;
    const figure::Pose pose =
        a_pose ? figure::a_pose(humanoid.figure) : figure::rest_pose(humanoid.figure.skeleton);
    figure::Pose raw;
    humanoid.rig.to_raw(humanoid.figure, character.skeleton, pose, raw);
    figure::Skeleton result = character.skeleton;
    for (std::size_t j = 1; j < result.joints.size(); ++j) {
        result.joints[j].parent_from_joint_rest = raw.parent_from_joint[j];
    }
    return result;
}

void name_bones(const figure::Character& character, figure::Skeleton& skeleton) {
    const figure::Humanoid& humanoid = *character.humanoid;
    std::vector<std::string> bones(skeleton.joints.size());
    std::set<std::string> taken;
    for (const figure::RigBone& bone : humanoid.rig.bones) {
        const std::string& name = humanoid.figure.skeleton.joints[bone.bone.value].name;
        if (taken.insert(name).second) {
            bones[bone.joint.value] = name;
        }
    }
    for (std::size_t j = 0; j < bones.size(); ++j) {
        std::string& name = skeleton.joints[j].name;
        if (bones[j].empty()) {
            const std::string own = name;
            for (int i = 2; !taken.insert(name).second; ++i) {
                name = own + "_" + std::to_string(i);
            }
        } else {
            name = bones[j];
        }
    }
}

}  // namespace puppetri::io
