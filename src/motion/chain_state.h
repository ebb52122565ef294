// SPDX-License-Identifier: MIT
// The joints of a chain in model space, kept up to date while one after the other turns.
#pragma once
#include <array>

#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/chain_ik.h"

namespace puppetri::motion {

class ChainState {
 public:
    // Needs joints in order from the root to the tip, each an ancestor of the next.
    ChainState(const ChainView& chain, figure::Pose& pose)
        : chain_(chain), pose_(pose), count_(static_cast<int>(chain.joints.size())) {
        PUP_REQUIRE(count_ >= 1 && count_ <= kMaxChainJoints);
        PUP_REQUIRE(chain.limits.empty() || chain.limits.size() == chain.skeleton.joints.size());
        PUP_REQUIRE(pose.parent_from_joint.size() == chain.skeleton.joints.size());
        const auto& joints = chain.skeleton.joints;
        for (figure::JointIndex j = joints[chain.joints[0].value].parent; j.valid();
             j = joints[j.value].parent) {
            base_ = pose.parent_from_joint[j.value] * base_;
        }
        for (int i = 1; i < count_; ++i) {
            // What lies between does not move.
            figure::JointIndex j = joints[chain.joints[i].value].parent;
            for (; j.valid() && j != chain.joints[i - 1]; j = joints[j.value].parent) {
                between_[i] = pose.parent_from_joint[j.value] * between_[i];
            }
            PUP_REQUIRE(j.valid());
        }
        update(0);
    }

    int count() const { return count_; }
    const Transform& model_from_joint(int i) const { return model_[i]; }
    // The parent's rotation, in model space.
    Quat model_from_parent(int i) const {
        return i == 0 ? base_.rotation : model_[i - 1].rotation * between_[i].rotation;
    }

    // Turns joint i by a rotation given in model space, then into its limit. True when it moved.
    bool turn(int i, Quat by_model) {
        const std::uint32_t joint = chain_.joints[i].value;
        const Quat parent = model_from_parent(i);
        Quat& rotation = pose_.parent_from_joint[joint].rotation;
        Quat next = normalized(conjugate(parent) * by_model * parent * rotation);
        if (!chain_.limits.empty()) {
            next = figure::clamp_to_limit(chain_.limits[joint], next);
        }
        if (next == rotation) {
            return false;
        }
        rotation = next;
        update(i);
        return true;
    }
    Quat rotation(int i) const { return pose_.parent_from_joint[chain_.joints[i].value].rotation; }
    void set_rotation(int i, Quat rotation) {
        pose_.parent_from_joint[chain_.joints[i].value].rotation = rotation;
        update(i);
    }

 private:
    void update(int from) {
        for (int i = from; i < count_; ++i) {
            model_[i] = (i == 0 ? base_ : model_[i - 1] * between_[i]) *
                        pose_.parent_from_joint[chain_.joints[i].value];
        }
    }

    const ChainView& chain_;
    figure::Pose& pose_;
    int count_;
    Transform base_;
    std::array<Transform, kMaxChainJoints> between_, model_;
};

}  // namespace puppetri::motion
