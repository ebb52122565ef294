// SPDX-License-Identifier: MIT
// How far a skin reaches around its bones, in any pose of the skeleton.
#pragma once
#include <span>

#include "puppetri/figure/mesh.h"
#include "puppetri/figure/skeleton.h"

namespace puppetri::figure {

struct SkinBox {
    Vec3 low{1, 1, 1}, high{-1, -1, -1};
    bool empty() const { return low.x > high.x; }
};

// The box of the vertices that hang mostly on the joint or on joints below it; of all without one.
SkinBox skin_box(const Skeleton& skeleton, const Mesh& mesh,
                 std::span<const Transform> model_from_joint, JointIndex joint);

// The same of those whose x lies between the two.
SkinBox skin_slice(const Skeleton& skeleton, const Mesh& mesh,
                   std::span<const Transform> model_from_joint, JointIndex joint, double x_one,
                   double x_two);

// From the point to the middle of the farthest vertices of that joint in the floor's plane, at
// rest: where a foot without toes points. Zero without vertices.
Vec3 skin_ahead(const Skeleton& skeleton, const Mesh& mesh, JointIndex joint, Vec3 from);

}  // namespace puppetri::figure
