// SPDX-License-Identifier: MIT
// Degrees of freedom: the named numbers by which people, formulas and keyframes pose joints
// ("head.flex", "left_elbow.flex", "link2.turn"). A joint's transform is that of its rest pose
// followed by the product of its DOFs in their order, the first outermost:
//   parent_from_joint = rest * D1(v1 - zero1) * D2(v2 - zero2) * ...
// where D turns about its axis or slides along it, and zero is the value that the rest pose has.
// The zero of a humanoid's DOFs is the anatomical position (arms hanging), as goniometers read it,
// although its rest pose is the T-pose.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

struct Figure;

using DofIndex = Index<struct DofTag>;

enum class DofKind : std::uint8_t { kTurn, kSlide };

struct Dof {
    std::string name;  // unique in its figure: "JOINT.WHAT"
    JointIndex joint;
    DofKind kind = DofKind::kTurn;
    Vec3 axis_joint{0, 0, 1};  // unit; in the joint's space at rest
    double lo = 0, hi = 0;     // range of values, radians or metres; lo <= hi
    double at_rest = 0;        // the value in the rest pose; within the range
};

// The DOFs of a figure, in order of joints; those of one joint are neighbours, the outermost first.
struct DofSet {
    std::vector<Dof> dofs;

    // None when there is no such DOF. Cost: linear; look up once.
    DofIndex find(std::string_view name) const;
    // Those of one joint, maybe none: first index and count.
    struct Range {
        std::uint32_t first = 0, count = 0;
    };
    Range of_joint(JointIndex joint) const;
};

// The transform of a joint whose DOFs have these values, one for each of `dofs` (all of one joint,
// in order). Values are taken as they are: clamp them to the range before.
Transform transform_of(std::span<const Dof> dofs, const Transform& parent_from_joint_rest,
                       std::span<const double> values);

// The values that come nearest to the transform: the inverse of transform_of where that has one. At
// most three turns per joint, the middle one about an axis orthogonal to both others: then the
// rotation is read exactly. Of the two triples that make it, the one within the ranges, then the
// one with the smaller values; where the outer axes fall together, the last turn is that of rest.
// Of fewer or other turns, each as near as it can come after those before it.
// Source  Shuster and Markley, "Generalization of the Euler angles", Journal of the Astronautical
//         Sciences 51 (2003) 123-132.
void values_of(std::span<const Dof> dofs, const Transform& parent_from_joint_rest,
               const Transform& parent_from_joint, std::span<double> values);

// The DOFs of a humanoid. Joints: head neck chest spine hips, and with left_ or right_ clavicle
// shoulder elbow wrist hip knee ankle toes; each has of flex, side and twist what the joint can do.
// Signs   flex bends forward (head, neck, chest, spine: nods; shoulder and hip: the limb swings
//         forward from hanging; elbow, knee: closes; wrist: towards the palm; ankle: raises the
//         toes; toes: lifts them). side leaves the midline (limbs) or leans to the figure's left
//         (trunk, head). twist turns about the bone: trunk and head to the left, limbs inward (the
//         front of the limb towards the midline). hips turn about the same axes as the trunk.
// "spine" and "chest" are those joints of the skeleton; the third of the trunk is "upper_chest".
DofSet humanoid_dofs(const Figure& figure);

// The joint of the normalised humanoid that the language calls so: "left_elbow" is leftLowerArm.
// Empty when there is none.
std::string_view humanoid_joint(std::string_view language_name);

}  // namespace puppetri::figure
