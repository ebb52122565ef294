// SPDX-License-Identifier: MIT
#include "puppetri/figure/stick_mesh.h"

#include <algorithm>
#include <string_view>

#include "mesh_builder.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

constexpr int kSectors = 12;
constexpr double kShortestBone = 0.004;  // of the height

bool ends_with(std::string_view text, std::string_view tail) {
    return text.size() >= tail.size() && text.substr(text.size() - tail.size()) == tail;
}

std::vector<ProfilePoint> ball(double radius_m, int rings) {
    std::vector<ProfilePoint> p;
    for (int i = 0; i <= rings; ++i) {
        const double a = kPi * (static_cast<double>(i) / rings - 0.5);
        const double c = i == 0 || i == rings ? 0 : puppetri::cos(a), s = puppetri::sin(a);
        p.push_back({radius_m * c, radius_m * s, c, s});
    }
    return p;
}

// A rod along +Y from 0 to length, swelling a little near its root as bones of puppets do.
std::vector<ProfilePoint> rod(double length_m, double radius_m) {
    const double r = radius_m, l = length_m;
    return {{0, 0, 0, -1},
            {0.55 * r, 0.02 * l, 1, -1},
            {1.0 * r, 0.22 * l, 1, 0.02},
            {0.62 * r, 0.85 * l, 1, 0.05},
            {0.45 * r, 0.98 * l, 1, 1},
            {0, l, 0, 1}};
}

}  // namespace

Mesh make_stick_mesh(const Skeleton& skeleton, const Palette& palette) {
    PUP_REQUIRE(skeleton.height_m > 0);
    const double h = skeleton.height_m;
    std::vector<Transform> model_from_joint(skeleton.joints.size());
    to_model_space(skeleton, rest_pose(skeleton), model_from_joint);
    Mesh mesh;
    mesh.materials = {{"bones", palette.main, 0.6f, 0},
                      {"joints", palette.accent, 0.4f, 0},
                      {"head", palette.main, 0.6f, 0}};
    constexpr std::uint32_t kBones = 0, kJoints = 1, kHead = 2;
    const auto left_out = [&](std::size_t j) {
        return !skeleton.joints[j].parent.valid() || ends_with(skeleton.joints[j].name, "Twist");
    };
    const auto bone = [&](std::size_t from, Vec3 tip_model) {
        const Vec3 start = model_from_joint[from].translation, way = tip_model - start;
        const double l = length(way);
        if (l < kShortestBone * h) {
            return;
        }
        const double r = std::clamp(0.14 * l, 0.0034 * h, 0.017 * h);
        const auto joint = static_cast<std::uint16_t>(from);
        const bool thin = r < 0.006 * h;  // fingers are of one colour
        const Transform place{shortest_arc({0, 1, 0}, way * (1 / l), {1, 0, 0}), start};
        append_revolution(mesh, rod(l, r), kSectors, place, kBones, &joint);
        append_revolution(mesh, ball(r * 1.12, 6), kSectors, {{}, start}, thin ? kBones : kJoints,
                          &joint);
    };
    for (std::size_t j = 0; j < skeleton.joints.size(); ++j) {
        const Joint& one = skeleton.joints[j];
        if (left_out(j)) {
            continue;
        }
        if (one.name == "head") {
            // A head as a ball, with a nose that says where it looks.
            const auto joint = static_cast<std::uint16_t>(j);
            const double r = 0.42 * length(one.end_site_joint);
            const Vec3 middle =
                model_from_joint[j].translation + Vec3{0, length(one.end_site_joint) - r, 0.01 * h};
            bone(j, middle);
            append_revolution(mesh, ball(r, 14), 24, {{}, middle}, kHead, &joint);
            const Transform nose{about_x(kPi / 2), middle + Vec3{0, -0.1 * r, 0.9 * r}};
            append_revolution(mesh, rod(0.5 * r, 0.22 * r), kSectors, nose, kJoints, &joint);
        } else if (length(one.end_site_joint) > 0) {
            bone(j, model_from_joint[j] * one.end_site_joint);
        }
        const auto parent = static_cast<std::size_t>(one.parent.value);
        if (!left_out(parent)) {
            bone(parent, model_from_joint[j].translation);
        }
    }
    sort_parts(mesh);
    return mesh;
}

}  // namespace puppetri::figure
