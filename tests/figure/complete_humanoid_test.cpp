// SPDX-License-Identifier: MIT
// Rigs whose feet and hands hang from controllers, or that have no wrists: what is put right moves
// no joint and no skin, and what is not clear is left alone.
#include "puppetri/figure/complete_humanoid.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "doctest/doctest.h"
#include "puppetri/figure/humanoid.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::figure;

namespace {

struct Made {
    const char* name;
    const char* parent;
    Vec3 at;  // model
    const char* bone = "";
};

struct Limbs {
    Skeleton skeleton;
    std::vector<FoundBone> bones;
};

// Joints with axes askew, at these places.
Limbs made(const std::vector<Made>& list) {
    Limbs out;
    std::vector<Transform> model;
    double turn = 0.3;
    for (const Made& m : list) {
        const JointIndex parent = out.skeleton.find(m.parent);
        const Transform here{from_rotation_vector({turn, -turn / 2, 1 - turn}), m.at};
        turn += 0.37;
        Transform local = parent.valid() ? inverse(model[parent.value]) * here : here;
        local.rotation = normalized(local.rotation);
        if (*m.bone != '\0') {
            out.bones.push_back({m.bone, {static_cast<std::uint32_t>(out.skeleton.joints.size())}});
        }
        out.skeleton.joints.push_back({m.name, parent, local, {}});
        model.push_back(here);
    }
    return out;
}

std::vector<Transform> model_of(const Skeleton& skeleton, const Pose& pose) {
    std::vector<Transform> model(skeleton.joints.size());
    to_model_space(skeleton, pose, model);
    return model;
}

std::string parent_of(const CompletedSkeleton& c, const char* joint) {
    const JointIndex j = c.skeleton.find(joint);
    REQUIRE(j.valid());
    const JointIndex parent = c.skeleton.joints[j.value].parent;
    return parent.valid() ? c.skeleton.joints[parent.value].name : "";
}

JointIndex bone_of(const CompletedSkeleton& c, const std::string& bone) {
    for (const FoundBone& b : c.bones) {
        if (b.bone == bone) {
            return b.joint;
        }
    }
    return {};
}

// A leg whose foot hangs from a controller that comes first, with a toe.
std::vector<Made> leg_with_controller(Vec3 foot = {0.1, 0.08, 0}) {
    return {{"root", "", {0, 0, 0}},
            {"Foot", "root", foot, "leftFoot"},
            {"Toe", "Foot", foot + Vec3{0, -0.05, 0.12}, "leftToes"},
            {"Hips", "root", {0, 0.9, 0}, "hips"},
            {"Thigh", "Hips", {0.1, 0.85, 0}, "leftUpperLeg"},
            {"Shin", "Thigh", {0.1, 0.47, 0.02}, "leftLowerLeg"},
            {"Pole", "root", {0.1, 0.5, 0.8}}};
}

std::vector<Made> arm(const std::vector<Made>& hanging) {
    std::vector<Made> list{{"root", "", {0, 0, 0}},
                           {"Upper", "root", {0.2, 1.4, 0}, "leftUpperArm"},
                           {"Fore", "Upper", {0.5, 1.4, 0}, "leftLowerArm"}};
    list.insert(list.end(), hanging.begin(), hanging.end());
    return list;
}

Vec3 skinned(const Mesh& mesh, std::size_t v, const std::vector<Transform>& rest,
             const std::vector<Transform>& model) {
    const Vec3 p{mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]};
    Vec3 sum;
    for (std::size_t k = 0; k < 4; ++k) {
        const std::uint16_t j = mesh.joints[v][k];
        sum = sum + (model[j] * (inverse(rest[j]) * p)) * static_cast<double>(mesh.weights[v][k]);
    }
    return sum;
}

}  // namespace

TEST_CASE("a foot that hangs from a controller is hung below its shin; no joint moves [law]") {
    const Limbs leg = made(leg_with_controller());
    Mesh mesh;
    std::mt19937 random(5);
    std::uniform_real_distribution<float> any(-1, 1);
    for (std::uint16_t v = 0; v < 40; ++v) {
        mesh.positions.push_back({any(random), any(random), any(random)});
        mesh.joints.push_back(
            {static_cast<std::uint16_t>(v % 7), static_cast<std::uint16_t>((v + 3) % 7), 0, 0});
        mesh.weights.push_back({0.7f, 0.3f, 0, 0});
    }
    const CompletedSkeleton done = complete_humanoid(leg.skeleton, mesh, leg.bones);
    CHECK(parent_of(done, "Foot") == "Shin");
    CHECK(parent_of(done, "Toe") == "Foot");
    CHECK(parent_of(done, "Pole") == "root");
    REQUIRE(done.notes.size() == 1);
    CHECK(done.notes[0].element == "left_ankle");
    CHECK(done.notes[0].severity == Severity::kNote);
    for (std::size_t j = 0; j < done.skeleton.joints.size(); ++j) {
        const JointIndex parent = done.skeleton.joints[j].parent;
        CHECK((!parent.valid() || parent.value < j));
        CHECK(done.skeleton.joints[j].name == leg.skeleton.joints[done.from[j].value].name);
    }
    CHECK(done.skeleton.joints[bone_of(done, "leftFoot").value].name == "Foot");

    Mesh bound = mesh;
    done.rebind(bound);
    const auto rest = model_of(leg.skeleton, rest_pose(leg.skeleton)),
               rest_now = model_of(done.skeleton, rest_pose(done.skeleton));
    for (int round = 0; round < 20; ++round) {
        Pose pose = rest_pose(leg.skeleton);
        for (Transform& t : pose.parent_from_joint) {
            t.rotation = from_rotation_vector({any(random), any(random), any(random)});
            t.translation = t.translation + Vec3{any(random), any(random), any(random)};
        }
        const auto was = model_of(leg.skeleton, pose),
                   is = model_of(done.skeleton, done.carry(leg.skeleton, pose));
        for (std::size_t j = 0; j < is.size(); ++j) {
            CHECK(length(is[j].translation - was[done.from[j].value].translation) < 1e-12);
            CHECK(angle_between(is[j].rotation, was[done.from[j].value].rotation) < 1e-7);
        }
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            CHECK(length(skinned(mesh, v, rest, was) - skinned(bound, v, rest_now, is)) < 1e-9);
        }
    }
}

TEST_CASE("what cannot be a foot of that leg is left where it hangs [unit]") {
    const auto hung = [](const std::vector<Made>& list) {
        const Limbs leg = made(list);
        const CompletedSkeleton done = complete_humanoid(leg.skeleton, {}, leg.bones);
        CHECK(done.skeleton.joints.size() == list.size());
        for (std::size_t j = 0; j < list.size(); ++j) {
            CHECK(done.from[j] == JointIndex{static_cast<std::uint32_t>(j)});
        }
        return done.notes.size();
    };
    CHECK(hung(leg_with_controller({0.1, 0.08, 1.4})) == 0);  // as far off as a pole target
    CHECK(hung(leg_with_controller({0.1, 0.46, 0})) == 0);    // at the knee
    // The shin hangs from the foot: turned round it would be no tree.
    std::vector<Made> above = leg_with_controller();
    above[4].parent = "Foot";
    CHECK(hung(above) == 0);
    // As it should be.
    std::vector<Made> fine = leg_with_controller();
    std::rotate(fine.begin() + 1, fine.begin() + 3, fine.end());
    fine[5].parent = "Shin";
    CHECK(fine[5].name == std::string("Foot"));
    CHECK(hung(fine) == 0);
}

TEST_CASE("where the legs hang beside the hips, the joint above both is the hips [unit]") {
    std::vector<Made> list{{"root", "", {0, 0, 0}},
                           {"Body", "root", {0, 0.9, 0}},
                           {"Hips", "Body", {0, 0.95, 0}, "hips"},
                           {"Left", "Body", {0.1, 0.85, 0}, "leftUpperLeg"},
                           {"Right", "Body", {-0.1, 0.85, 0}, "rightUpperLeg"}};
    const Limbs limbs = made(list);
    const CompletedSkeleton done = complete_humanoid(limbs.skeleton, {}, limbs.bones);
    CHECK(done.skeleton.joints[bone_of(done, "hips").value].name == "Body");
    CHECK(done.skeleton.joints[bone_of(done, "spine").value].name == "Hips");
    CHECK(done.skeleton.joints.size() == limbs.skeleton.joints.size());
    // The root on the floor is nobody's hips.
    list[2].parent = list[3].parent = list[4].parent = "root";
    const Limbs loose = made(list);
    const CompletedSkeleton left = complete_humanoid(loose.skeleton, {}, loose.bones);
    CHECK(left.skeleton.joints[bone_of(left, "hips").value].name == "Hips");
    CHECK(left.notes.empty());
}

TEST_CASE("a missing wrist is made where the fingers hang from the forearm [unit]") {
    const Limbs limbs = made(arm({{"Twist", "Fore", {0.6, 1.4, 0}, "leftLowerArmTwist"},
                                  {"Thumb", "Fore", {0.73, 1.38, 0.03}},
                                  {"Palm1", "Fore", {0.76, 1.4, 0}},
                                  {"Palm2", "Fore", {0.76, 1.401, 0}},
                                  {"Finger", "Palm2", {0.84, 1.4, 0}}}));
    const CompletedSkeleton done = complete_humanoid(limbs.skeleton, {}, limbs.bones);
    const JointIndex wrist = bone_of(done, "leftHand");
    REQUIRE(wrist.valid());
    CHECK_FALSE(done.from[wrist.value].valid());
    CHECK(done.skeleton.joints[wrist.value].name == "leftHand");
    CHECK(parent_of(done, "leftHand") == "Fore");
    for (const char* joint : {"Palm1", "Palm2", "Thumb"}) {
        CHECK(parent_of(done, joint) == "leftHand");
    }
    CHECK(parent_of(done, "Twist") == "Fore");
    CHECK(parent_of(done, "Finger") == "Palm2");
    const auto model = model_of(done.skeleton, rest_pose(done.skeleton));
    CHECK(length(model[wrist.value].translation - Vec3{0.76, 1.4, 0}) < 1e-9);
    CHECK(length(model[done.skeleton.find("Finger").value].translation - Vec3{0.84, 1.4, 0}) <
          1e-9);
}

TEST_CASE(
    "without fingers the forearm's skin tells the wrist, and what is beyond goes with it [unit]") {
    const Limbs limbs = made(arm({}));
    Mesh mesh;
    for (int i = 0; i <= 40; ++i) {
        mesh.positions.push_back({0.5f + 0.01f * static_cast<float>(i), 1.4f, 0});
        mesh.joints.push_back({2, 0, 0, 0});
        mesh.weights.push_back({1, 0, 0, 0});
    }
    const CompletedSkeleton done = complete_humanoid(limbs.skeleton, mesh, limbs.bones);
    const JointIndex wrist = bone_of(done, "leftHand");
    REQUIRE(wrist.valid());
    const auto model = model_of(done.skeleton, rest_pose(done.skeleton));
    const HumanoidMeasures like = mannequin_measures(1.75);
    const double x =
        0.5 + 0.4 * like.arms[kLeft].fore_m / (like.arms[kLeft].fore_m + like.arms[kLeft].hand_m);
    CHECK(model[wrist.value].translation.x == doctest::Approx(x).epsilon(1e-6));
    done.rebind(mesh);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const bool beyond = static_cast<double>(mesh.positions[v][0]) > x;
        CHECK(mesh.joints[v][0] == (beyond ? wrist.value : done.skeleton.find("Fore").value));
    }
}

TEST_CASE("a forearm that ends too early has no wrist: it stays missing [unit]") {
    const Limbs limbs = made(arm({{"Bracelet", "Fore", {0.55, 1.4, 0}}}));
    Mesh mesh;
    mesh.positions.push_back({0.52f, 1.4f, 0});
    mesh.joints.push_back({2, 0, 0, 0});
    mesh.weights.push_back({1, 0, 0, 0});
    CHECK_FALSE(bone_of(complete_humanoid(limbs.skeleton, mesh, limbs.bones), "leftHand").valid());
    // Without a skin a file of motion tells by its end site.
    Limbs ended = made(arm({}));
    ended.skeleton.joints[2].end_site_joint = {0, 0.26, 0};
    const CompletedSkeleton done = complete_humanoid(ended.skeleton, {}, ended.bones);
    REQUIRE(bone_of(done, "leftHand").valid());
    const auto model = model_of(done.skeleton, rest_pose(done.skeleton));
    CHECK(length(model[bone_of(done, "leftHand").value].translation - Vec3{0.5, 1.4, 0}) ==
          doctest::Approx(0.26));
}
