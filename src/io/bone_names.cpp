// SPDX-License-Identifier: MIT
#include "puppetri/io/bone_names.h"

namespace puppetri::io {
namespace {

struct Row {
    std::string_view vrm, mixamo, unreal, rigify;
};

// Joints of the middle.
constexpr Row kMiddle[] = {
    {"root", "Root", "root", "root"},
    {"hips", "Hips", "pelvis", "spine"},
    {"spine", "Spine", "spine_01", "spine.001"},
    {"chest", "Spine1", "spine_02", "spine.002"},
    {"upperChest", "Spine2", "spine_03", "spine.003"},
    {"neck", "Neck", "neck_01", "spine.004"},
    {"head", "Head", "head", "spine.006"},
    {"jaw", "Jaw", "jaw", "jaw"},
};

// Joints of a side, without left/right, Left/Right, _l/_r, .L/.R.
constexpr Row kSide[] = {
    {"Eye", "Eye", "eye", "eye"},
    {"Shoulder", "Shoulder", "clavicle", "shoulder"},
    {"UpperArm", "Arm", "upperarm", "upper_arm"},
    {"UpperArmTwist", "ArmTwist", "upperarm_twist_01", "upper_arm_twist"},
    {"LowerArm", "ForeArm", "lowerarm", "forearm"},
    {"LowerArmTwist", "ForeArmTwist", "lowerarm_twist_01", "forearm_twist"},
    {"Hand", "Hand", "hand", "hand"},
    {"ThumbMetacarpal", "HandThumb1", "thumb_01", "thumb.01"},
    {"ThumbProximal", "HandThumb2", "thumb_02", "thumb.02"},
    {"ThumbDistal", "HandThumb3", "thumb_03", "thumb.03"},
    {"IndexProximal", "HandIndex1", "index_01", "f_index.01"},
    {"IndexIntermediate", "HandIndex2", "index_02", "f_index.02"},
    {"IndexDistal", "HandIndex3", "index_03", "f_index.03"},
    {"MiddleProximal", "HandMiddle1", "middle_01", "f_middle.01"},
    {"MiddleIntermediate", "HandMiddle2", "middle_02", "f_middle.02"},
    {"MiddleDistal", "HandMiddle3", "middle_03", "f_middle.03"},
    {"RingProximal", "HandRing1", "ring_01", "f_ring.01"},
    {"RingIntermediate", "HandRing2", "ring_02", "f_ring.02"},
    {"RingDistal", "HandRing3", "ring_03", "f_ring.03"},
    {"LittleProximal", "HandPinky1", "pinky_01", "f_pinky.01"},
    {"LittleIntermediate", "HandPinky2", "pinky_02", "f_pinky.02"},
    {"LittleDistal", "HandPinky3", "pinky_03", "f_pinky.03"},
    {"UpperLeg", "UpLeg", "thigh", "thigh"},
    {"LowerLeg", "Leg", "calf", "shin"},
    {"Foot", "Foot", "foot", "foot"},
    {"Toes", "ToeBase", "ball", "toe"},
};

std::string name_of(BoneNames names, const Row& row, std::string_view vrm_side) {
    const bool left = vrm_side == "left";
    const bool middle = vrm_side.empty();
    switch (names) {
        case BoneNames::kMixamo:
            return std::string("mixamorig") +
                   (middle ? ""
                    : left ? "Left"
                           : "Right") +
                   std::string(row.mixamo);
        case BoneNames::kUnreal:
            return std::string(row.unreal) + (middle ? "" : left ? "_l" : "_r");
        case BoneNames::kRigify:
            return std::string(row.rigify) + (middle ? "" : left ? ".L" : ".R");
        case BoneNames::kVrm:
            break;
    }
    return std::string(vrm_side) + std::string(row.vrm);
}

}  // namespace

std::optional<BoneNames> parse_bone_names(std::string_view text) {
    constexpr std::string_view kNames[] = {"vrm", "mixamo", "unreal", "rigify"};
    for (std::uint8_t i = 0; i < 4; ++i) {
        if (text == kNames[i]) {
            return static_cast<BoneNames>(i);
        }
    }
    return std::nullopt;
}

std::string bone_name(BoneNames names, std::string_view vrm_name) {
    for (const Row& row : kMiddle) {
        if (row.vrm == vrm_name) {
            return name_of(names, row, "");
        }
    }
    for (const std::string_view side : {std::string_view("left"), std::string_view("right")}) {
        if (!vrm_name.starts_with(side)) {
            continue;
        }
        for (const Row& row : kSide) {
            if (row.vrm == vrm_name.substr(side.size())) {
                return name_of(names, row, side);
            }
        }
    }
    return std::string(vrm_name);
}

std::vector<std::string> humanoid_bones() {
    std::vector<std::string> list;
    for (const Row& row : kMiddle) {
        if (row.vrm != "root") {
            list.emplace_back(row.vrm);
        }
    }
    for (const char* side : {"left", "right"}) {
        for (const Row& row : kSide) {
            list.push_back(side + std::string(row.vrm));
        }
    }
    return list;
}

}  // namespace puppetri::io
