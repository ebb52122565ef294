// SPDX-License-Identifier: MIT
// DOFs against the anatomy that they are named after, and against their own inverse.
#include "puppetri/figure/dof.h"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "puppetri/figure/mannequin.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::figure;

namespace {

// The figure with one DOF at a value and the others of its joint at the anatomical zero.
std::vector<Transform> posed(const Figure& f, const DofSet& set, std::string_view name,
                             double value) {
    Pose pose = rest_pose(f.skeleton);
    for (const char* side : {"left_shoulder", "right_shoulder"}) {  // both arms hang
        const DofSet::Range r = set.of_joint(f.skeleton.find(humanoid_joint(side)));
        const std::vector<double> zero(r.count, 0.0);
        const JointIndex joint = set.dofs[r.first].joint;
        pose.parent_from_joint[joint.value] =
            transform_of(std::span(set.dofs).subspan(r.first, r.count),
                         f.skeleton.joints[joint.value].parent_from_joint_rest, zero);
    }
    const DofIndex dof = set.find(name);
    REQUIRE(dof.valid());
    const JointIndex joint = set.dofs[dof.value].joint;
    const DofSet::Range r = set.of_joint(joint);
    std::vector<double> values(r.count, 0.0);
    values[dof.value - r.first] = value;
    pose.parent_from_joint[joint.value] =
        transform_of(std::span(set.dofs).subspan(r.first, r.count),
                     f.skeleton.joints[joint.value].parent_from_joint_rest, values);
    std::vector<Transform> model(f.skeleton.joints.size());
    to_model_space(f.skeleton, pose, model);
    return model;
}

}  // namespace

TEST_CASE("the DOFs of a humanoid move where their names say, alike on both sides [unit]") {
    const Figure f = make_mannequin(1.75);
    const DofSet set = humanoid_dofs(f);
    const double a = radians(30);
    const auto at = [&](const char* joint, const char* dof) {
        return posed(f, set, dof, a)[f.skeleton.find(joint).value];
    };
    const auto zero = [&](const char* joint) {
        return posed(f, set, "head.flex", 0)[f.skeleton.find(joint).value].translation;
    };
    // Hanging arms are the zero.
    CHECK(zero("leftHand").y < zero("leftUpperArm").y - 0.5);
    CHECK(std::fabs(zero("leftHand").x - zero("leftUpperArm").x) < 1e-9);
    for (const std::string side : {"left", "right"}) {
        const double s = side == "left" ? 1 : -1;
        const auto joint = [&](const char* what) { return side + what; };
        const auto moved = [&](const char* what, const char* dof) {
            return at(joint(what).c_str(), (side + dof).c_str()).translation -
                   zero(joint(what).c_str());
        };
        const auto ahead = [&](const char* what, const char* dof) {  // where its +Z goes
            return rotate(at(joint(what).c_str(), (side + dof).c_str()).rotation, {0, 0, 1});
        };
        CHECK(moved("Hand", "_shoulder.flex").z > 0.1);
        CHECK(moved("Hand", "_shoulder.side").x * s > 0.1);
        CHECK(moved("Hand", "_elbow.flex").z > 0.05);
        CHECK(moved("Foot", "_hip.flex").z > 0.1);
        CHECK(moved("Foot", "_hip.side").x * s > 0.1);
        CHECK(moved("Foot", "_knee.flex").z < -0.05);
        CHECK(moved("Toes", "_ankle.flex").y > 0.01);
        CHECK(ahead("Foot", "_hip.twist").x * s < -0.1);
        CHECK(ahead("Foot", "_ankle.twist").x * s < -0.1);
        CHECK(ahead("Toes", "_toes.flex").y > 0.1);
        CHECK(ahead("Hand", "_shoulder.twist").x * s < -0.1);  // a hanging arm turns inward
    }
    CHECK(rotate(at("head", "head.flex").rotation, {0, 0, 1}).y < -0.1);
    CHECK(rotate(at("head", "head.side").rotation, {0, 1, 0}).x > 0.1);
    CHECK(rotate(at("head", "head.twist").rotation, {0, 0, 1}).x > 0.1);
    CHECK(at("head", "spine.flex").translation.z > zero("head").z + 0.1);
}

TEST_CASE("every DOF of a humanoid stays within the joint's limits over its range [law]") {
    const Figure f = make_mannequin(1.75);
    const DofSet set = humanoid_dofs(f);
    for (std::size_t i = 0; i < set.dofs.size(); ++i) {
        const Dof& dof = set.dofs[i];
        CHECK(dof.lo <= dof.at_rest);
        CHECK(dof.at_rest <= dof.hi);
        const JointLimit& limit = f.limits[dof.joint.value];
        if (limit.kind != LimitKind::kHinge) {
            continue;  // cones limit several at once
        }
        for (const double value : {dof.lo, dof.hi}) {
            const Transform t = transform_of(
                {&dof, 1}, f.skeleton.joints[dof.joint.value].parent_from_joint_rest, {&value, 1});
            CHECK(limit_excess_rad(limit, t.rotation) < 1e-9);
        }
    }
}

TEST_CASE("values are read back from the transform that they made [law]") {
    const Figure f = make_mannequin(1.75);
    const DofSet set = humanoid_dofs(f);
    std::mt19937 random(7);
    for (std::uint32_t j = 0; j < f.skeleton.joints.size(); ++j) {
        const DofSet::Range r = set.of_joint({j});
        const auto dofs = std::span(set.dofs).subspan(r.first, r.count);
        for (int round = 0; round < 200 && r.count > 0; ++round) {
            std::vector<double> values, again(r.count);
            for (const Dof& dof : dofs) {
                std::uniform_real_distribution<double> in(dof.lo, dof.hi);
                values.push_back(in(random));
            }
            const Transform& rest = f.skeleton.joints[j].parent_from_joint_rest;
            const Transform made = transform_of(dofs, rest, values);
            values_of(dofs, rest, made, again);
            CHECK(angle_between(transform_of(dofs, rest, again).rotation, made.rotation) < 1e-7);
            for (std::size_t i = 0; i < dofs.size(); ++i) {
                CHECK(again[i] >= dofs[i].lo - 1e-6);
                CHECK(again[i] <= dofs[i].hi + 1e-6);
            }
        }
    }
}

TEST_CASE("hanging arms and the rest pose read as themselves, the T-pose without a twist [unit]") {
    const Figure f = make_mannequin(1.75);
    const DofSet set = humanoid_dofs(f);
    const JointIndex joint = f.skeleton.find("leftUpperArm");
    const DofSet::Range r = set.of_joint(joint);
    const auto dofs = std::span(set.dofs).subspan(r.first, r.count);
    const Transform& rest = f.skeleton.joints[joint.value].parent_from_joint_rest;
    std::vector<double> values(3);
    values_of(dofs, rest, rest, values);
    CHECK(values[0] == doctest::Approx(0));
    CHECK(values[1] == doctest::Approx(radians(90)));
    CHECK(values[2] == doctest::Approx(0));
    const std::vector<double> hanging{radians(20), radians(5), radians(-10)};
    values_of(dofs, rest, transform_of(dofs, rest, hanging), values);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(values[i] == doctest::Approx(hanging[i]));
    }
}

TEST_CASE("a joint that slides and turns is read back [unit]") {
    const std::vector<Dof> dofs{
        {.name = "j.turn", .joint = {0}, .lo = -3, .hi = 3},
        {.name = "j.slide",
         .joint = {0},
         .kind = DofKind::kSlide,
         .axis_joint = {1, 0, 0},
         .lo = 0,
         .hi = 2,
         .at_rest = 0.5},
    };
    const Transform rest{about_x(0.7), {1, 2, 3}};
    const std::vector<double> values{1.1, 0.9};
    const Transform made = transform_of(dofs, rest, values);
    // The slide begins after the turn: along the turned x.
    const Vec3 way = made.translation - rest.translation;
    CHECK(length(way) == doctest::Approx(0.4));
    CHECK(length(way - rotate(rest.rotation * about_z(1.1), Vec3{0.4, 0, 0})) < 1e-12);
    std::vector<double> again(2);
    values_of(dofs, rest, made, again);
    CHECK(again[0] == doctest::Approx(1.1));
    CHECK(again[1] == doctest::Approx(0.9));
}
