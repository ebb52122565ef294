// SPDX-License-Identifier: MIT
// Props and joints that follow quantities.
#include <algorithm>
#include <array>
#include <utility>

#include "puppetri/base/require.h"
#include "take.h"

namespace puppetri::stage {

void Take::drive(const Play& play, std::shared_ptr<const Quantities> from) {
    quantities = std::move(from);
    if (quantities == nullptr) {
        return;
    }
    for (const DrivenProp& d : play.driven_props) {
        driven_props[d.prop.value] = d.position;
    }
    for (const DrivenDof& d : play.driven_dofs) {
        const figure::Figure& f = *actors[d.actor.value].figure;
        const figure::DofIndex dof = f.dofs.find(d.dof);
        PUP_REQUIRE(dof.valid());
        const figure::JointIndex joint = f.dofs.dofs[dof.value].joint;
        std::vector<Joint>& joints = driven_joints[d.actor.value];
        auto of = std::find_if(joints.begin(), joints.end(),
                               [&](const Joint& j) { return j.joint == joint; });
        if (of == joints.end()) {
            joints.push_back({joint, f.dofs.of_joint(joint), {}, {}});
            of = joints.end() - 1;
        }
        of->dofs.push_back(dof.value - of->range.first);
        of->quantities.push_back(d.quantity);
    }
}

// The other degrees of freedom of these joints stay as the pose has them.
void Take::move_driven_joints(ActorIndex actor, SimTime at, figure::Pose& pose) const {
    if (quantities == nullptr || driven_joints[actor.value].empty()) {
        return;
    }
    constexpr std::size_t kMost = 8;
    const figure::Figure& f = *actors[actor.value].figure;
    for (const Joint& j : driven_joints[actor.value]) {
        const auto dofs = std::span(f.dofs.dofs).subspan(j.range.first, j.range.count);
        std::array<double, kMost> all{};
        PUP_REQUIRE(dofs.size() <= kMost);
        const std::span<double> values(all.data(), dofs.size());
        Transform& joint = pose.parent_from_joint[j.joint.value];
        const Transform& rest = f.skeleton.joints[j.joint.value].parent_from_joint_rest;
        figure::values_of(dofs, rest, joint, values);
        for (std::size_t i = 0; i < j.dofs.size(); ++i) {
            const figure::Dof& dof = dofs[j.dofs[i]];
            values[j.dofs[i]] = std::clamp(
                quantities->at(j.quantities[i], std::max(at, SimTime{0})), dof.lo, dof.hi);
        }
        joint = figure::transform_of(dofs, rest, values);
    }
}

}  // namespace puppetri::stage
