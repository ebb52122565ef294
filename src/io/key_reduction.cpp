// SPDX-License-Identifier: MIT
#include "key_reduction.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace puppetri::io {

std::vector<std::uint32_t> reduce_keys(
    std::uint32_t count, std::span<const std::uint32_t> pinned, double tolerance,
    const std::function<double(std::uint32_t, std::uint32_t, std::uint32_t)>& misfit) {
    std::vector<std::uint32_t> kept(pinned.begin(), pinned.end());
    kept.push_back(0);
    kept.push_back(count - 1);
    std::sort(kept.begin(), kept.end());
    kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> open;
    for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
        open.emplace_back(kept[i], kept[i + 1]);
    }
    while (!open.empty()) {
        const auto [from, to] = open.back();
        open.pop_back();
        double worst = tolerance;
        std::uint32_t at = 0;
        for (std::uint32_t key = from + 1; key < to; ++key) {
            const double deviation = misfit(from, to, key);
            if (deviation > worst) {
                worst = deviation;
                at = key;
            }
        }
        if (at != 0) {
            kept.push_back(at);
            open.emplace_back(from, at);
            open.emplace_back(at, to);
        }
    }
    std::sort(kept.begin(), kept.end());
    return kept;
}

Allowance allowance_for(const figure::Skeleton& skeleton, double tolerance_m) {
    const std::size_t joints = skeleton.joints.size();
    std::vector<double> reach_m(joints, 0);
    std::vector<int> depth(joints, 1);
    int deepest = 1;
    for (std::size_t j = 0; j < joints; ++j) {
        const figure::JointIndex parent = skeleton.joints[j].parent;
        depth[j] = parent.valid() ? depth[parent.value] + 1 : 1;
        deepest = std::max(deepest, depth[j]);
    }
    for (std::size_t j = joints; j-- > 0;) {
        const figure::Joint& joint = skeleton.joints[j];
        reach_m[j] = std::max(reach_m[j], length(joint.end_site_joint));
        if (joint.parent.valid()) {
            double& above = reach_m[joint.parent.value];
            above = std::max(above, reach_m[j] + length(joint.parent_from_joint_rest.translation));
        }
    }
    Allowance allowance{std::vector<double>(joints), tolerance_m / (deepest + 2)};
    for (std::size_t j = 0; j < joints; ++j) {
        allowance.rotation_rad[j] = allowance.translation_m / std::max(reach_m[j], 0.01);
    }
    return allowance;
}

}  // namespace puppetri::io
