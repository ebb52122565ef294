// SPDX-License-Identifier: MIT
// Bones by name. A name is taken apart into words: at signs, at the change from small to large
// letters and between letters and numbers; a left or right among them is the side. What is left,
// written together, is looked up in a table. Where names number the joints of a limb instead of
// naming them ("leg_joint_L_2"), the order along the chain tells.
#include <algorithm>
#include <array>
#include <map>

#include "puppetri/io/bone_names.h"
#include "puppetri/io/character_reader.h"

namespace puppetri::io {
namespace {

using figure::FoundBone;
using figure::JointIndex;
using figure::Skeleton;

enum class Of : std::uint8_t { kMiddle, kLeft, kRight };

struct Words {
    Of side = Of::kMiddle;
    std::vector<std::string> words;  // lower case, without side and prefix
    std::string joined;              // letters and numbers
};

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::vector<std::string> split(std::string_view name) {
    std::vector<std::string> words;
    char before = 0;
    for (std::size_t i = 0; i < name.size(); ++i) {
        const char c = name[i], after = i + 1 < name.size() ? name[i + 1] : '\0';
        const bool letter = is_upper(c) || is_lower(c);
        if (letter || is_digit(c)) {
            const bool begins = words.empty() || before == 0 ||
                                (is_upper(c) && (!is_upper(before) || is_lower(after))) ||
                                (is_digit(c) != is_digit(before));
            if (begins) {
                words.emplace_back();
            }
            words.back() += is_upper(c) ? static_cast<char>(c | 0x20) : c;
            before = c;
        } else {
            before = 0;
        }
    }
    return words;
}

Words words_of(std::string_view name) {
    const std::size_t colon = name.rfind(':');
    if (colon != std::string_view::npos) {
        name.remove_prefix(colon + 1);
    }
    Words result;
    bool numbered = false;  // "Bip01": the number of a prefix says nothing
    for (std::string& word : split(name)) {
        const bool prefix = word.starts_with("mixamorig") || word.starts_with("bip");
        if (prefix || (numbered && is_digit(word[0])) || word == "armature" || word == "skeleton" ||
            word == "joint" || word == "jnt" || word == "bone" || word == "bn" || word == "def" ||
            word == "j") {
            numbered = prefix;
            continue;
        }
        numbered = false;
        if (result.side == Of::kMiddle && (word == "l" || word == "left")) {
            result.side = Of::kLeft;
        } else if (result.side == Of::kMiddle && (word == "r" || word == "right")) {
            result.side = Of::kRight;
        } else {
            result.words.push_back(std::move(word));
        }
    }
    // "lfemur": the side grown together with a name that is nothing without it.
    static constexpr std::string_view kGrown[] = {"femur",    "tibia",   "foot",   "toes",
                                                  "clavicle", "humerus", "radius", "hand",
                                                  "wrist",    "thigh",   "calf",   "shin"};
    if (result.side == Of::kMiddle && !result.words.empty()) {
        std::string& first = result.words.front();
        for (const std::string_view word : kGrown) {
            if (first.size() == word.size() + 1 && first.ends_with(word) &&
                (first[0] == 'l' || first[0] == 'r')) {
                result.side = first[0] == 'l' ? Of::kLeft : Of::kRight;
                first.erase(0, 1);
            }
        }
    }
    for (const std::string& word : result.words) {
        result.joined += word;
    }
    return result;
}

struct Name {
    std::string_view joined, bone;  // bone without its side
};

// Of the middle. The first that is there wins.
constexpr Name kMiddle[] = {
    {"hips", "hips"},         {"hip", "hips"},
    {"pelvis", "hips"},       {"spine", "spine"},
    {"spine01", "spine"},     {"lowerback", "spine"},
    {"abdomen", "spine"},     {"spine0", "spine"},
    {"chest", "chest"},       {"spine1", "chest"},
    {"spine02", "chest"},     {"upperback", "chest"},
    {"torso", "chest"},       {"upperchest", "upperChest"},
    {"spine2", "upperChest"}, {"spine03", "upperChest"},
    {"thorax", "upperChest"}, {"neck", "neck"},
    {"neck01", "neck"},       {"lowerneck", "neck"},
    {"head", "head"},
};
constexpr Name kSide[] = {
    {"shoulder", "Shoulder"},
    {"clavicle", "Shoulder"},
    {"collar", "Shoulder"},
    {"upperarm", "UpperArm"},
    {"humerus", "UpperArm"},
    {"lowerarm", "LowerArm"},
    {"forearm", "LowerArm"},
    {"radius", "LowerArm"},
    {"hand", "Hand"},
    {"wrist", "Hand"},
    {"upperleg", "UpperLeg"},
    {"upleg", "UpperLeg"},
    {"thigh", "UpperLeg"},
    {"femur", "UpperLeg"},
    {"lowerleg", "LowerLeg"},
    {"calf", "LowerLeg"},
    {"shin", "LowerLeg"},
    {"tibia", "LowerLeg"},
    {"foot", "Foot"},
    {"ankle", "Foot"},
    {"toes", "Toes"},
    {"toebase", "Toes"},
    {"toe", "Toes"},
    {"toe0", "Toes"},
    {"ball", "Toes"},
    {"upperarmtwist", "UpperArmTwist"},
    {"upperarmtwist01", "UpperArmTwist"},
    {"lowerarmtwist", "LowerArmTwist"},
    {"lowerarmtwist01", "LowerArmTwist"},
    {"forearmtwist", "LowerArmTwist"},
    {"hip", "UpperLeg"},
    {"knee", "LowerLeg"},
    {"elbow", "LowerArm"},
};
// Mixamo, CMU as BVH and 3ds Max call the forearm's parent just arm, the shank leg.
constexpr Name kSideShort[] = {{"arm", "UpperArm"}, {"leg", "LowerLeg"}};

std::string with_side(Of side, std::string_view bone) {
    return (side == Of::kLeft ? "left" : side == Of::kRight ? "right" : "") + std::string(bone);
}

class Finder {
 public:
    explicit Finder(const Skeleton& skeleton) : s_(skeleton), used_(skeleton.joints.size(), false) {
        for (const figure::Joint& joint : s_.joints) {
            words_.push_back(words_of(joint.name));
        }
    }

    std::vector<FoundBone> find() {
        // A whole set of names first: Rigify calls the hips "spine".
        for (const BoneNames names :
             {BoneNames::kVrm, BoneNames::kMixamo, BoneNames::kUnreal, BoneNames::kRigify}) {
            if (whole_set(names)) {
                break;
            }
        }
        by_words(kMiddle, false);
        by_words(kSide, true);
        by_words(kSideShort, true);
        fingers();
        chains();
        std::vector<FoundBone> list;
        for (const auto& [bone, joint] : bones_) {
            list.push_back({bone, joint});
        }
        return list;
    }

 private:
    void take(const std::string& bone, std::size_t joint) {
        if (!used_[joint] &&
            bones_.emplace(bone, JointIndex{static_cast<std::uint32_t>(joint)}).second) {
            used_[joint] = true;
        }
    }

    // All joints by the names of one program, if it is that one: hips, head, knees and elbows.
    bool whole_set(BoneNames names) {
        const auto plain = [](std::string_view name) {
            std::string text;
            const std::size_t colon = name.rfind(':');
            for (const char c : colon == std::string_view::npos ? name : name.substr(colon + 1)) {
                text += is_upper(c) ? static_cast<char>(c | 0x20) : c;
            }
            return text.starts_with("mixamorig") ? text.substr(9) : text;
        };
        std::map<std::string, std::size_t> joints;
        for (std::size_t j = 0; j < s_.joints.size(); ++j) {
            joints.emplace(plain(s_.joints[j].name), j);
        }
        const auto at = [&](std::string_view bone) {
            return joints.find(plain(bone_name(names, bone)));
        };
        for (const char* bone : {"hips", "head", "leftLowerLeg", "rightLowerLeg", "leftLowerArm",
                                 "rightLowerArm", "leftUpperArm", "rightUpperArm"}) {
            if (at(bone) == joints.end()) {
                return false;
            }
        }
        for (const std::string& bone : humanoid_bones()) {
            const auto found = at(bone);
            if (found != joints.end()) {
                take(bone, found->second);
            }
        }
        return true;
    }

    template <std::size_t N>
    void by_words(const Name (&names)[N], bool sides) {
        for (const Name& name : names) {
            for (std::size_t j = 0; j < words_.size(); ++j) {
                if ((words_[j].side != Of::kMiddle) == sides && words_[j].joined == name.joined) {
                    take(with_side(words_[j].side, name.bone), j);
                }
            }
        }
    }

    // "index_01", "HandIndex1", "f_index.01", "thumb2": a finger and a number from 1 to 3; a finger
    // without a number, above its second joint, is the first.
    void fingers() {
        static constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kFingers{
            {{"thumb", "Thumb"},
             {"index", "Index"},
             {"middle", "Middle"},
             {"ring", "Ring"},
             {"pinky", "Little"},
             {"little", "Little"}}};
        static constexpr std::array<std::string_view, 3> kThumb{"Metacarpal", "Proximal", "Distal"},
            kOther{"Proximal", "Intermediate", "Distal"};
        for (std::size_t j = 0; j < words_.size(); ++j) {
            const Words& w = words_[j];
            if (w.side == Of::kMiddle || w.words.empty()) {
                continue;
            }
            const bool first = w.words.size() == 1 && above_second(j);
            const std::string number = first ? "1" : w.words.back();
            const char digit = number.back();
            if (number.size() > 2 || digit < '1' || digit > '3') {
                continue;
            }
            for (const auto& [word, bone] : kFingers) {
                if (std::find(w.words.begin(), w.words.end(), word) != w.words.end()) {
                    const auto k = static_cast<std::size_t>(digit - '1');
                    take(with_side(w.side, bone) +
                             std::string(word == "thumb" ? kThumb[k] : kOther[k]),
                         j);
                }
            }
        }
    }

    bool above_second(std::size_t joint) const {
        for (std::size_t j = 0; j < words_.size(); ++j) {
            const auto& words = words_[j].words;
            if (s_.joints[j].parent.value == joint && words.size() == 2 &&
                words[0] == words_[joint].words[0] && words[1] == "2") {
                return true;
            }
        }
        return false;
    }

    bool says(std::size_t joint, std::string_view word) const {
        const auto& words = words_[joint].words;
        return std::find(words.begin(), words.end(), word) != words.end();
    }

    // The joints with this word and side, from the root outwards, each hanging from the one before.
    std::vector<std::size_t> chain(std::string_view word, Of side) const {
        std::vector<std::size_t> list;
        for (std::size_t j = 0; j < words_.size(); ++j) {  // parents come first
            if (words_[j].side == side && says(j, word) &&
                (list.empty() || below(j, list.back()))) {
                list.push_back(j);
            }
        }
        return list;
    }
    bool below(std::size_t lower, std::size_t upper) const {
        JointIndex j{static_cast<std::uint32_t>(lower)};
        while (j.valid() && j.value > upper) {
            j = s_.joints[j.value].parent;
        }
        return j.valid() && j.value == upper;
    }

    // Numbered limbs, for those of which nothing was found by name.
    void chains() {
        const auto spread = [&](const std::vector<std::size_t>& joints, Of side,
                                std::initializer_list<std::string_view> bones) {
            std::size_t i = 0;
            for (const std::string_view bone : bones) {
                if (i < joints.size()) {
                    take(with_side(side, bone), joints[i++]);
                }
            }
        };
        for (const Of side : {Of::kLeft, Of::kRight}) {
            if (!bones_.contains(with_side(side, "LowerLeg"))) {
                const auto leg = chain("leg", side);
                if (leg.size() >= 3) {
                    spread(leg, side, {"UpperLeg", "LowerLeg", "Foot", "Toes"});
                }
            }
            if (!bones_.contains(with_side(side, "LowerArm"))) {
                const auto arm = chain("arm", side);
                if (arm.size() == 3) {
                    spread(arm, side, {"UpperArm", "LowerArm", "Hand"});
                } else if (arm.size() > 3) {
                    spread(arm, side, {"Shoulder", "UpperArm", "LowerArm", "Hand"});
                }
            }
        }
        const auto trunk =
            chain(chain("torso", Of::kMiddle).empty() ? "spine" : "torso", Of::kMiddle);
        if (!bones_.contains("hips") && trunk.size() >= 2) {
            spread(trunk, Of::kMiddle, {"hips", "spine", "chest", "upperChest"});
        }
        if (!bones_.contains("head")) {
            const auto neck = chain("neck", Of::kMiddle);
            if (neck.size() >= 2) {
                take("neck", neck.front());
                take("head", neck.back());
            }
        }
    }

    const Skeleton& s_;
    std::vector<Words> words_;
    std::vector<bool> used_;
    std::map<std::string, JointIndex> bones_;
};

}  // namespace

std::vector<FoundBone> find_bones(const Skeleton& skeleton) { return Finder(skeleton).find(); }

}  // namespace puppetri::io
