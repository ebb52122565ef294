// SPDX-License-Identifier: MIT
// A skeleton: a tree of joints, parents before children, with a rest pose. Humanoids use the names
// of VRM 1.0 (docs/conventions.md) below a `root` joint that lies on the floor under the hips and
// carries travel and heading. A Pose says where the joints are now; it means something only beside
// its skeleton.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "puppetri/base/index.h"
#include "puppetri/math/transform.h"

namespace puppetri::figure {

using JointIndex = Index<struct JointTag>;

struct Joint {
    std::string name;   // "hips", "leftUpperLeg"; unique in the skeleton
    JointIndex parent;  // none for the root; otherwise smaller than its own index
    Transform parent_from_joint_rest;
    Vec3 end_site_joint;  // tip of a leaf in its own space (for BVH and drawing); zero where there
                          // are children
};

struct Skeleton {
    std::vector<Joint> joints;
    double height_m = 0;  // sole to crown in the rest pose

    // None when there is no such joint. Cost: linear; look up once.
    JointIndex find(std::string_view name) const;
};

// The state of every joint relative to its parent. Humanoids move only `root` and `hips` by
// translation; the other joints keep the translation of the rest pose.
struct Pose {
    std::vector<Transform> parent_from_joint;  // one per joint
};

Pose rest_pose(const Skeleton& skeleton);

// Fills model_from_joint (one per joint) with the product along the tree; `root` has no parent, so
// that its transform is in world space and so is the result.
void to_model_space(const Skeleton& skeleton, const Pose& pose,
                    std::span<Transform> model_from_joint);

}  // namespace puppetri::figure
