// SPDX-License-Identifier: MIT
// Characters out of files: bones by the names of all programs, rest poses brought to the T-pose,
// what is missing told by name; the real ones where they are.
#include <doctest/doctest.h>

#include <cmath>
#include <random>
#include <string>

#include "io/scene_files.h"
#include "io/tiny_gltf.h"
#include "puppetri/io/bone_names.h"
#include "puppetri/io/character_reader.h"
#include "puppetri/io/disk_files.h"
#include "puppetri/math/rotation.h"

using namespace puppetri;
using namespace puppetri::io;
using namespace puppetri::io::testing;

namespace {

Checked<figure::Character> read(const std::string& bytes, scene::CharacterRequest request = {}) {
    request.path = "tiny.glb";
    const auto document = GltfDocument::parse(bytes, request.path, nullptr);
    REQUIRE(document.has_value());
    Diagnostics notes;
    return read_character(*document, request, notes);
}

std::vector<Transform> model_of(const figure::Skeleton& skeleton, const figure::Pose& pose) {
    std::vector<Transform> model(skeleton.joints.size());
    figure::to_model_space(skeleton, pose, model);
    return model;
}

std::string joint_of(const figure::Character& c, const std::string& bone) {
    for (const figure::RigBone& b : c.humanoid->rig.bones) {
        if (c.humanoid->figure.skeleton.joints[b.bone.value].name == bone) {
            return c.skeleton.joints[b.joint.value].name;
        }
    }
    return "";
}

std::string code_and_element(const Checked<figure::Character>& c) {
    return c ? "" : c.error().front().code + " " + c.error().front().element;
}

// Joint rotations that are anything: hands and feet must be where the humanoid has them.
void check_same_places(const figure::Character& c) {
    const figure::Figure& f = c.humanoid->figure;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> part(-0.6, 0.6);
    for (int round = 0; round < 20; ++round) {
        figure::Pose pose = figure::rest_pose(f.skeleton), raw, again;
        pose.parent_from_joint[f.root.value] = {about_y(part(random)), {part(random), 0, 1}};
        for (std::size_t j = 1; j < f.skeleton.joints.size(); ++j) {
            // Those that the character has: others would be lost.
            if (!joint_of(c, f.skeleton.joints[j].name).empty()) {
                pose.parent_from_joint[j].rotation =
                    from_rotation_vector({part(random), part(random), part(random)});
            }
        }
        c.carry(pose, raw);
        const auto bones = model_of(f.skeleton, pose), joints = model_of(c.skeleton, raw);
        for (const figure::RigBone& b : c.humanoid->rig.bones) {
            const Transform bone = joints[b.joint.value] * inverse(b.bone_from_joint);
            CHECK(length(bone.translation - bones[b.bone.value].translation) < 1e-6);
            CHECK(angle_between(bone.rotation, bones[b.bone.value].rotation) < 1e-6);
        }
        c.humanoid->rig.to_figure(f, c.skeleton, raw, again);
        const auto back = model_of(f.skeleton, again);
        for (const figure::RigBone& b : c.humanoid->rig.bones) {
            CHECK(length(back[b.bone.value].translation - bones[b.bone.value].translation) < 1e-6);
            CHECK(angle_between(back[b.bone.value].rotation, bones[b.bone.value].rotation) < 1e-6);
        }
    }
}

Checked<scene::LoadedCharacter> load(const char* name, bool humanoid,
                                     std::optional<double> height = {}) {
    DiskFiles files;
    scene::CharacterRequest request;
    request.path = kMotion + name;
    request.humanoid = humanoid;
    request.height_m = height;
    return files.assets()->character(request);
}

}  // namespace

TEST_CASE("humanoid bones are found by the names of all programs [unit]") {
    const auto check = [](const std::string& what, auto name) {
        CAPTURE(what);
        TinyFile file;
        file.name = name;
        const auto c = read(tiny_glb(file));
        CHECK(code_and_element(c) == "");
        if (!c) {
            return;
        }
        REQUIRE(c->humanoid.has_value());
        for (const TinyBone& bone : tiny_bones()) {
            const bool chest = std::string(bone.name) == "chest";  // carries what upperChest does
            CHECK(joint_of(*c, chest ? "upperChest" : bone.name) == name(bone.name));
        }
    };
    for (const BoneNames names :
         {BoneNames::kVrm, BoneNames::kMixamo, BoneNames::kUnreal, BoneNames::kRigify}) {
        check("set " + std::to_string(static_cast<int>(names)),
              [names](const std::string& b) { return bone_name(names, b); });
    }
    check("Mixamo with its colon", [](const std::string& b) {
        return "mixamorig:" + bone_name(BoneNames::kMixamo, b).substr(9);
    });
    check("CMU", [](const std::string& b) -> std::string {
        static const std::map<std::string, std::string> cmu{
            {"hips", "root"},       {"spine", "lowerback"}, {"chest", "thorax"},
            {"neck", "lowerneck"},  {"head", "head"},       {"UpperArm", "humerus"},
            {"LowerArm", "radius"}, {"Hand", "hand"},       {"UpperLeg", "femur"},
            {"LowerLeg", "tibia"},  {"Foot", "foot"},       {"Toes", "toes"}};
        const bool left = b.starts_with("left"), right = b.starts_with("right");
        const std::string bone = left ? b.substr(4) : right ? b.substr(5) : b;
        return (left ? "l" : right ? "r" : "") + (bone == "hips" ? "hip" : cmu.at(bone));
    });
    check("3ds Max", [](const std::string& b) -> std::string {
        static const std::map<std::string, std::string> max{
            {"hips", "Pelvis"},      {"spine", "Spine"}, {"chest", "Spine1"},
            {"neck", "Neck"},        {"head", "Head"},   {"UpperArm", "UpperArm"},
            {"LowerArm", "Forearm"}, {"Hand", "Hand"},   {"UpperLeg", "Thigh"},
            {"LowerLeg", "Calf"},    {"Foot", "Foot"},   {"Toes", "Toe0"}};
        const bool left = b.starts_with("left"), right = b.starts_with("right");
        const std::string bone = left ? b.substr(4) : right ? b.substr(5) : b;
        return "Bip01 " + std::string(left ? "L " : right ? "R " : "") + max.at(bone);
    });
}

TEST_CASE("VRM files name their bones themselves, whatever the nodes are called [unit]") {
    for (const TinyFile::Vrm vrm : {TinyFile::Vrm::kZero, TinyFile::Vrm::kOne}) {
        TinyFile file;
        file.vrm = vrm;
        file.name = [](const std::string& b) {
            return "x" + std::to_string(b.size()) + b.substr(0, 1) + b.back() +
                   b.substr(b.size() / 2, 2);
        };
        const auto c = read(tiny_glb(file));
        CHECK(code_and_element(c) == "");
        REQUIRE((c && c->humanoid));
        CHECK(joint_of(*c, "leftLowerArm") == file.name("leftLowerArm"));
    }
}

TEST_CASE("a map in the scene names bones that nothing else tells [unit]") {
    TinyFile file;
    file.name = [](const std::string& b) { return b == "leftLowerLeg" ? "zork" : b; };
    CHECK(code_and_element(read(tiny_glb(file))) == "no-bone left_knee");
    scene::CharacterRequest request;
    request.bones = {{"left_knee", "zork", {}}};
    const auto c = read(tiny_glb(file), request);
    REQUIRE(c.has_value());
    CHECK(joint_of(*c, "leftLowerLeg") == "zork");
    request.bones = {{"left_knee", "zorg", {}}};
    CHECK(code_and_element(read(tiny_glb(file), request)) == "unknown-joint left_knee");
}

TEST_CASE("what a humanoid cannot do without is told by its name [unit]") {
    const auto without = [](const std::string& bone) {
        TinyFile file;
        file.name = [bone](const std::string& b) { return b == bone ? "" : b; };
        return code_and_element(read(tiny_glb(file)));
    };
    CHECK(without("rightLowerLeg") == "no-bone right_knee");
    CHECK(without("leftHand") == "no-bone left_wrist");
    CHECK(without("hips").starts_with("no-bone hips"));
    for (const char* bone : {"neck", "leftToes", "chest"}) {
        CHECK(without(bone) == "");
    }
    TinyFile knee;
    knee.move = [](const std::string& b, double&, double& y, double&) {
        y = b == "leftLowerLeg" ? 0.86 : y;
    };
    CHECK(code_and_element(read(tiny_glb(knee))) == "short-bone left_hip");
}

TEST_CASE(
    "any rest pose is brought to the T-pose; joints stay at one place with the humanoid [law]") {
    const auto lowered = [](const std::string& b, double& x, double& y, double&) {
        const bool arm = b.find("Arm") != std::string::npos || b.find("Hand") != std::string::npos;
        if (arm) {  // 45 degrees down
            const double s = x > 0 ? 1 : -1, r = (s * x - 0.15) * 0.70710678;
            x = s * (0.15 + r);
            y = 1.3 - r;
        }
    };
    const auto spread = [](const std::string& b, double& x, double& y, double& z) {
        if (b.find("LowerLeg") != std::string::npos) {
            x *= 1.6;
            z += 0.03;  // knees a little bent
        } else if (b.find("Foot") != std::string::npos || b.find("Toes") != std::string::npos) {
            x *= 2;
            x += b.find("Toes") != std::string::npos ? (x > 0 ? 0.03 : -0.03) : 0;  // turned out
        }
        static_cast<void>(y);
    };
    for (int turned = 0; turned < 4; ++turned) {
        for (int pose = 0; pose < 3; ++pose) {
            CAPTURE(turned);
            CAPTURE(pose);
            TinyFile file;
            file.scale = turned == 1 ? 100 : 1;
            file.move = [&](const std::string& b, double& x, double& y, double& z) {
                if (pose == 1) {
                    lowered(b, x, y, z);
                } else if (pose == 2) {
                    spread(b, x, y, z);
                }
                if (turned == 2) {  // looks along -Z
                    x = -x;
                    z = -z;
                } else if (turned == 3) {  // +Z up, looks along -Y
                    const double up = y;
                    y = -z;
                    z = up;
                }
            };
            if (turned == 3) {
                continue;  // the floor of the test's mesh is y = 0
            }
            scene::CharacterRequest request;
            request.height_m = 1.7;
            const auto c = read(tiny_glb(file), request);
            CHECK(code_and_element(c) == "");
            REQUIRE((c && c->humanoid));
            const figure::Figure& f = c->humanoid->figure;
            CHECK(f.height_m == doctest::Approx(1.7).epsilon(1e-6));
            figure::Pose t_pose;
            c->carry(figure::rest_pose(f.skeleton), t_pose);
            const auto model = model_of(c->skeleton, t_pose);
            const auto at = [&](const char* bone) {
                return model[c->skeleton.find(joint_of(*c, bone)).value].translation;
            };
            CHECK(at("leftHand").x > 0.5);
            for (const char* side : {"left", "right"}) {
                const auto n = [&](const char* b) { return at((side + std::string(b)).c_str()); };
                for (const Vec3 arm : {n("LowerArm") - n("UpperArm"), n("Hand") - n("LowerArm")}) {
                    CHECK(std::fabs(arm.y) + std::fabs(arm.z) < 1e-6);
                }
                for (const Vec3 leg : {n("LowerLeg") - n("UpperLeg"), n("Foot") - n("LowerLeg")}) {
                    CHECK(std::fabs(leg.x) + std::fabs(leg.z) < 1e-6);
                }
                const Vec3 toes = n("Toes") - n("Foot");
                CHECK(toes.z > 0.05);
                CHECK(std::fabs(toes.x) < 1e-6);
            }
            check_same_places(*c);
        }
    }
}

TEST_CASE("a skin's picture, texture coordinates and materials arrive [unit]") {
    TinyFile file;
    file.picture = true;
    const auto c = read(tiny_glb(file));
    REQUIRE(c.has_value());
    REQUIRE(c->mesh.textures.size() == 1);
    CHECK(c->mesh.textures[0].bytes == std::string("\x89PNG\r\n\x1a\nnot a picture", 21));
    REQUIRE(c->mesh.materials.size() == 1);
    CHECK(c->mesh.materials[0].base_colour_texture == 0);
    REQUIRE(c->mesh.uvs.size() == c->mesh.positions.size());
    CHECK(c->mesh.uvs[1] == std::array<float, 2>{1, 0});
}

TEST_CASE("CesiumMan is a humanoid by the words and the order of its joints [oracle]") {
    if (!there("CesiumMan.glb")) {
        return;
    }
    const auto loaded = load("CesiumMan.glb", true, 1.7);
    REQUIRE(loaded.has_value());
    const figure::Character& c = *loaded->character;
    REQUIRE(c.humanoid.has_value());
    CHECK(joint_of(c, "leftUpperArm") == "Skeleton_arm_joint_L__4_");
    CHECK(joint_of(c, "leftHand") == "Skeleton_arm_joint_L__2_");
    CHECK(joint_of(c, "rightLowerLeg") == "leg_joint_R_2");
    CHECK(joint_of(c, "head") == "Skeleton_neck_joint_2");
    CHECK(c.mesh.positions.size() == 3273);
    CHECK(c.mesh.triangles.size() == 4672);
    REQUIRE(c.mesh.textures.size() == 1);
    CHECK(c.mesh.textures[0].mime_type == "image/jpeg");
    check_same_places(c);
}

TEST_CASE("a fox and a minimal skin stand as creatures; neither is a humanoid [oracle]") {
    if (!there("Fox.glb") || !there("SimpleSkin.gltf")) {
        return;
    }
    const auto fox = load("Fox.glb", false, 0.6);
    REQUIRE(fox.has_value());
    CHECK(fox->character->skeleton.joints.size() == 25);  // 24 and the root
    CHECK(fox->character->dofs.find("b_Head_05.z").valid());
    CHECK(!fox->character->humanoid.has_value());
    double low = 1, high = 0;
    for (const auto& p : fox->character->mesh.positions) {
        low = std::fmin(low, p[1]);
        high = std::fmax(high, p[1]);
    }
    CHECK(low == doctest::Approx(0).epsilon(1e-5));
    CHECK(high == doctest::Approx(0.6).epsilon(1e-5));
    CHECK(!load("Fox.glb", true, 0.6).has_value());
    CHECK(load("Fox.glb", false)->notes.front().code == "very-tall");
    CHECK(load("SimpleSkin.gltf", false).has_value());
    CHECK(load("nobody.glb", true).error().front().code == "cannot-read");
}
