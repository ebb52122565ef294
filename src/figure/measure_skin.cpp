// SPDX-License-Identifier: MIT
#include "measure_skin.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace puppetri::figure {
namespace {

// For each joint whether it is the given one or below it; all without one.
std::vector<bool> at_or_below(const Skeleton& skeleton, JointIndex joint) {
    std::vector<bool> in(skeleton.joints.size(), !joint.valid());
    for (std::uint32_t j = 0; joint.valid() && j < skeleton.joints.size(); ++j) {
        const JointIndex parent = skeleton.joints[j].parent;
        in[j] = j == joint.value || (parent.valid() && in[parent.value]);
    }
    return in;
}

double share(const Mesh& mesh, std::size_t vertex, const std::vector<bool>& in) {
    double sum = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        sum += in[mesh.joints[vertex][k]] ? static_cast<double>(mesh.weights[vertex][k]) : 0.0;
    }
    return sum;
}

// Linear blend skinning, as every renderer does it.
class Skin {
 public:
    Skin(const Skeleton& skeleton, const Mesh& mesh, std::span<const Transform> model_from_joint)
        : mesh_(mesh), model_from_rest_(skeleton.joints.size()) {
        std::vector<Transform> rest(skeleton.joints.size());
        to_model_space(skeleton, rest_pose(skeleton), rest);
        for (std::size_t j = 0; j < rest.size(); ++j) {
            model_from_rest_[j] = model_from_joint[j] * inverse(rest[j]);
        }
    }
    Vec3 at(std::size_t vertex) const {
        const auto& p = mesh_.positions[vertex];
        const Vec3 rest{p[0], p[1], p[2]};
        Vec3 sum;
        for (std::size_t k = 0; k < 4; ++k) {
            const double w = mesh_.weights[vertex][k];
            if (w > 0) {
                sum = sum + (model_from_rest_[mesh_.joints[vertex][k]] * rest) * w;
            }
        }
        return sum;
    }

 private:
    const Mesh& mesh_;
    std::vector<Transform> model_from_rest_;
};

}  // namespace

SkinBox skin_slice(const Skeleton& skeleton, const Mesh& mesh,
                   std::span<const Transform> model_from_joint, JointIndex joint, double x_one,
                   double x_two) {
    SkinBox box;
    if (mesh.joints.empty()) {
        return box;
    }
    const std::vector<bool> in = at_or_below(skeleton, joint);
    const Skin skin(skeleton, mesh, model_from_joint);
    const double lo = std::fmin(x_one, x_two), hi = std::fmax(x_one, x_two);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (joint.valid() && share(mesh, v, in) <= 0.5) {
            continue;
        }
        const Vec3 p = skin.at(v);
        if (p.x < lo || p.x > hi) {
            continue;
        }
        if (box.empty()) {
            box = {p, p};
        }
        box.low = {std::fmin(box.low.x, p.x), std::fmin(box.low.y, p.y), std::fmin(box.low.z, p.z)};
        box.high = {std::fmax(box.high.x, p.x), std::fmax(box.high.y, p.y),
                    std::fmax(box.high.z, p.z)};
    }
    return box;
}

SkinBox skin_box(const Skeleton& skeleton, const Mesh& mesh,
                 std::span<const Transform> model_from_joint, JointIndex joint) {
    constexpr double kFar = std::numeric_limits<double>::max();
    return skin_slice(skeleton, mesh, model_from_joint, joint, -kFar, kFar);
}

Vec3 skin_ahead(const Skeleton& skeleton, const Mesh& mesh, JointIndex joint, Vec3 from) {
    if (mesh.joints.empty()) {
        return {};
    }
    const std::vector<bool> in = at_or_below(skeleton, joint);
    const auto level = [&](std::size_t v) {
        const auto& p = mesh.positions[v];
        return Vec3{p[0] - from.x, 0, p[2] - from.z};
    };
    double farthest = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        farthest = share(mesh, v, in) > 0.5 ? std::fmax(farthest, length(level(v))) : farthest;
    }
    Vec3 sum;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (share(mesh, v, in) > 0.5 && length(level(v)) > 0.8 * farthest) {
            sum = sum + level(v);
        }
    }
    return sum;
}

}  // namespace puppetri::figure
