// SPDX-License-Identifier: MIT
// A performance by formula, for tests of what reads performances: two puppets of eight joints whose
// axes are askew at rest, a ball, a score that repeats every second. What it answers is known in
// closed form and exact at every time.
#pragma once
#include <cmath>
#include <string>
#include <vector>

#include "puppetri/figure/skeleton.h"
#include "puppetri/math/rotation.h"
#include "puppetri/stage/performance.h"

namespace puppetri::test {

inline figure::Skeleton puppet_skeleton() {
    const auto joint = [](const char* name, std::uint32_t parent, Vec3 at, Quat axes,
                          Vec3 tip = {}) {
        return figure::Joint{name, figure::JointIndex{parent}, {axes, at}, tip};
    };
    constexpr std::uint32_t kNone = figure::JointIndex::kNone;
    figure::Skeleton s;
    s.height_m = 1.8;
    s.joints = {
        joint("root", kNone, {0, 0, 0}, {}),
        joint("hips", 0, {0, 0.95, 0}, {}),
        joint("spine", 1, {0, 0.2, 0.01}, from_axis_angle({0, 1, 0}, 0.3)),
        joint("leftUpperArm", 2, {0.2, 0.3, 0}, from_axis_angle(normalized(Vec3{1, 2, 3}), 1.1)),
        joint("leftLowerArm", 3, {0.1, 0.25, 0.02},
              from_axis_angle(normalized(Vec3{-1, 0, 2}), 0.7)),
        joint("rightUpperArm", 2, {-0.2, 0.3, 0}, from_axis_angle({0, 0, 1}, 1.5), {0, 0.5, 0}),
        joint("leftUpperLeg", 1, {0.1, -0.05, 0}, {}, {0, -0.9, 0}),
        joint("leftHand", 4, {0, 0.25, 0}, {}, {0, 0.1, 0}),
    };
    return s;
}

// A box around every joint's bone would do; two triangles per joint are enough to skin.
inline figure::Mesh puppet_mesh(const figure::Skeleton& skeleton) {
    figure::Mesh mesh;
    mesh.materials = {{"skin", {0.8f, 0.6f, 0.5f}, 0.7f, 0},
                      {"cloth", {0.1f, 0.4f, 0.5f}, 0.9f, 0}};
    std::vector<Transform> model_from_joint(skeleton.joints.size());
    figure::to_model_space(skeleton, figure::rest_pose(skeleton), model_from_joint);
    for (std::uint16_t j = 0; j < skeleton.joints.size(); ++j) {
        const auto first = static_cast<std::uint32_t>(mesh.positions.size());
        const std::uint16_t other =
            j == 0 ? 1 : static_cast<std::uint16_t>(skeleton.joints[j].parent.value);
        for (const Vec3 corner :
             {Vec3{0, 0, 0.1}, Vec3{0.1, 0, 0}, Vec3{0, 0.1, 0}, Vec3{-0.1, 0, 0.05}}) {
            const Vec3 p = model_from_joint[j] * corner;
            mesh.positions.push_back(
                {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)});
            mesh.normals.push_back({0, 0, 1});
            // A slot of weight 0 with a joint, and one joint twice: both are allowed in a mesh.
            mesh.joints.push_back({j, other, j, 3});
            mesh.weights.push_back({0.5f, 0.3f, 0.2f, 0});
        }
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
    }
    mesh.parts = {{0, 0, 6}, {1, 6, static_cast<std::uint32_t>(mesh.triangles.size() - 6)}};
    return mesh;
}

class FakePerformance : public stage::Performance {
 public:
    explicit FakePerformance(double seconds = 4) : seconds_(seconds) {
        const figure::JointIndex hips = skeleton_.find("hips");
        actor_views_ = {{"ana", &skeleton_, &mesh_, hips}, {"rui", &skeleton_, &mesh_, hips}};
        ball_.positions = {{0, 0.11f, 0}, {0.1f, -0.05f, 0}, {-0.1f, -0.05f, 0}, {0, 0, 0.1f}};
        ball_.normals = {{0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
        ball_.triangles = {{0, 1, 2}, {0, 1, 3}, {1, 2, 3}};
        ball_.materials = {{"ball", {0.9f, 0.1f, 0.1f}, 0.5f, 0}};
        stage::PropView ball;
        ball.name = "ball";
        ball.size_m = {0.22, 0.22, 0.22};
        ball.mesh = &ball_;
        prop_views_ = {ball};
        for (int second = 0; second < static_cast<int>(seconds); ++second) {
            const SimTime begin = at(second), middle = at(second + 0.5), end = at(second + 1);
            const motion::LimbSet all{63};
            score_.push_back(
                {begin, middle, middle, "a.walk.P4", "ana", all, "step", "", "a.walk"});
            score_.push_back({begin, end, end, "b.wait", "rui", all, "idle", "", "b"});
            score_.push_back({middle, end, end, "a.walk.P6", "ana", all, "step", "", "a.walk"});
            events_.push_back({at(second + 0.26171875), "foot_strike", "ana", "left_leg", ""});
            events_.push_back({at(second + 0.75), "release", "ana", "right_arm", "ball"});
        }
    }

    static SimTime at(double seconds) {
        return {static_cast<std::int64_t>(std::llround(seconds * kTicksPerSecond))};
    }

    SimTime duration() const override { return at(seconds_); }
    std::span<const stage::ActorView> actors() const override { return actor_views_; }
    std::span<const stage::PropView> props() const override { return prop_views_; }
    std::span<const stage::ScoreEntry> score() const override { return score_; }
    std::span<const stage::StageEvent> events() const override { return events_; }

    void pose(stage::ActorIndex actor, SimTime time, figure::Pose& out) const override {
        const double t = time.seconds(), turn = 2 * kPi * t;
        out = figure::rest_pose(skeleton_);
        auto& joints = out.parent_from_joint;
        const double side = actor.value == 0 ? -1 : 1;
        joints[0] = {about_y(actor.value == 0 ? 0.2 * t : 0), {side, 0, 1.2 * t}};
        joints[1].translation = {0, 0.95 + 0.02 * std::cos(turn), 0.01};
        joints[1].rotation = about_x(0.1 * std::sin(turn));
        // Rolls over once a second: an angle that has to be unwrapped.
        joints[2].rotation =
            joints[2].rotation * from_axis_angle(normalized(Vec3{0.2, 1, 0.1}), turn);
        joints[3].rotation =
            joints[3].rotation * about_x(0.8 * std::sin(turn)) * about_z(0.5 * std::cos(turn));
        joints[4].rotation =
            about_z(0.4) * joints[4].rotation;  // rests, but not where the skeleton says
        joints[6].rotation = about_x(0.5 * std::sin(turn));
        // joints[5] never moves
    }

    Transform world_from_prop(stage::PropIndex, SimTime time) const override {
        const double t = time.seconds();
        return {about_x(3 * t), {0.3 * std::sin(2 * kPi * t), 1.2, t}};
    }
    std::string holder(stage::PropIndex, SimTime time) const override {
        return time.ticks % kTicksPerSecond < at(0.75).ticks ? "floor" : "air";
    }
    motion::Phase phase(stage::ActorIndex, motion::Limb, SimTime) const override {
        return motion::Phase::kSupport;
    }

    const figure::Skeleton& skeleton() const { return skeleton_; }

 private:
    double seconds_ = 4;
    figure::Skeleton skeleton_ = puppet_skeleton();
    figure::Mesh mesh_ = puppet_mesh(skeleton_);
    figure::Mesh ball_;
    std::vector<stage::ActorView> actor_views_;
    std::vector<stage::PropView> prop_views_;
    std::vector<stage::ScoreEntry> score_;
    std::vector<stage::StageEvent> events_;
};

}  // namespace puppetri::test
