// SPDX-License-Identifier: MIT
// The mannequin against its published ratios, and its joints against their limits.
#include "puppetri/figure/mannequin.h"

#include <doctest/doctest.h>

#include <cstdint>
#include <string>

#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::figure;

TEST_CASE("the mannequin stands as tall as asked, soles on the floor, at every height [unit]") {
    for (const double height : {1.0, 1.5, 1.75, 1.9}) {
        const Figure f = make_mannequin(height);
        std::vector<Transform> model(f.skeleton.joints.size());
        to_model_space(f.skeleton, rest_pose(f.skeleton), model);
        double top = 0, bottom = 0;
        for (std::size_t i = 0; i < model.size(); ++i) {
            for (const Vec3 p :
                 {model[i].translation, model[i] * f.skeleton.joints[i].end_site_joint}) {
                top = std::fmax(top, p.y);
                bottom = std::fmin(bottom, p.y);
            }
        }
        CHECK(top == doctest::Approx(height).epsilon(1e-12));
        CHECK(std::fabs(bottom) < 1e-12);
        for (const Leg& leg : f.legs) {
            for (const Vec3 p : {leg.heel_foot, leg.ball_foot, leg.toe_tip_foot}) {
                CHECK(std::fabs((model[leg.ankle.value] * p).y) < 1e-12);
            }
            for (const Vec3 p : {leg.ball_toes, leg.toe_tip_toes}) {
                CHECK(std::fabs((model[leg.toes.value] * p).y) < 1e-12);
            }
        }
    }
}

TEST_CASE("segments have the ratios of Drillis and Contini [oracle]") {
    const Figure f = make_mannequin(1.8);
    std::vector<Transform> model(f.skeleton.joints.size());
    to_model_space(f.skeleton, rest_pose(f.skeleton), model);
    auto at = [&](const char* name) { return model[f.skeleton.find(name).value].translation; };
    CHECK(at("leftUpperLeg").y == doctest::Approx(0.530 * 1.8));
    CHECK(at("leftLowerLeg").y == doctest::Approx(0.285 * 1.8));
    CHECK(at("leftFoot").y == doctest::Approx(0.039 * 1.8));
    CHECK(length(at("rightLowerArm") - at("rightUpperArm")) == doctest::Approx(0.186 * 1.8));
    CHECK(length(at("rightHand") - at("rightLowerArm")) == doctest::Approx(0.146 * 1.8));
    CHECK(at("leftUpperArm").x > 0);
    CHECK(at("leftToes").z > 0);
}

TEST_CASE(
    "the skeleton has every VRM 1.0 bone but eyes and jaw, parents first, and is symmetric "
    "[unit]") {
    const Figure f = make_mannequin(1.75);
    for (const char* name : {"root", "hips", "spine", "chest", "upperChest", "neck", "head"}) {
        CHECK(f.skeleton.find(name).valid());
    }
    for (const char* name : {"Shoulder",
                             "UpperArm",
                             "LowerArm",
                             "Hand",
                             "UpperLeg",
                             "LowerLeg",
                             "Foot",
                             "Toes",
                             "ThumbMetacarpal",
                             "ThumbProximal",
                             "ThumbDistal",
                             "IndexProximal",
                             "IndexIntermediate",
                             "IndexDistal",
                             "MiddleProximal",
                             "MiddleIntermediate",
                             "MiddleDistal",
                             "RingProximal",
                             "RingIntermediate",
                             "RingDistal",
                             "LittleProximal",
                             "LittleIntermediate",
                             "LittleDistal",
                             "UpperArmTwist",
                             "LowerArmTwist"}) {
        const JointIndex left = f.skeleton.find("left" + std::string(name));
        const JointIndex right = f.skeleton.find("right" + std::string(name));
        REQUIRE(left.valid());
        REQUIRE(right.valid());
        const Vec3 a = f.skeleton.joints[left.value].parent_from_joint_rest.translation;
        const Vec3 b = f.skeleton.joints[right.value].parent_from_joint_rest.translation;
        CHECK(a == Vec3{-b.x, b.y, b.z});
    }
    for (std::uint32_t i = 1; i < f.skeleton.joints.size(); ++i) {
        CHECK(f.skeleton.joints[i].parent.value < i);
    }
    CHECK(!f.skeleton.find("tail").valid());
}

TEST_CASE("rest pose, A-pose and all hand poses lie inside the limits [unit]") {
    const Figure f = make_mannequin(1.75);
    for (const Pose& pose : {rest_pose(f.skeleton), a_pose(f)}) {
        for (std::size_t i = 0; i < f.limits.size(); ++i) {
            CAPTURE(f.skeleton.joints[i].name);
            CHECK(limit_excess_rad(f.limits[i], pose.parent_from_joint[i].rotation) < 1e-7);
        }
    }
    for (int side : {kLeft, kRight}) {
        for (int i = 0; i < kFingerJointCount; ++i) {
            const JointIndex joint = f.arms[side].fingers[i];
            CAPTURE(f.skeleton.joints[joint.value].name);
            for (const auto* pose :
                 {&f.hands[side].relaxed, &f.hands[side].spread, &f.hands[side].grip}) {
                CHECK(limit_excess_rad(f.limits[joint.value], (*pose)[i]) < 1e-7);
            }
        }
    }
}

TEST_CASE("clamping to a limit gives a rotation on it, and leaves what is inside [law]") {
    const Figure f = make_mannequin(1.75);
    std::uint32_t state = 1;
    auto next = [&] {
        return ((state = state * 1664525u + 1013904223u) >> 8) / double(1 << 24) * 2 - 1;
    };
    for (int i = 0; i < 2000; ++i) {
        const double x = next(), y = next(), z = next(), w = next();
        const Quat q = normalized(Quat{x, y, z, w});
        for (const JointLimit& limit : f.limits) {
            const Quat inside = clamp_to_limit(limit, q);
            CHECK(limit_excess_rad(limit, inside) < 1e-6);
        }
    }
    CHECK(limit_excess_rad(f.limits[f.legs[0].knee.value], about_x(-radians(10))) ==
          doctest::Approx(radians(10)));
    CHECK(limit_excess_rad(f.limits[f.legs[0].knee.value], about_x(radians(160))) ==
          doctest::Approx(radians(10)));
}
