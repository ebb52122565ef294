// SPDX-License-Identifier: MIT
// From the top down. First which raw joint plays which bone: of the trunk those between the hips
// and the arms count, since the figure's arms hang from its upper chest. Then every joint gets the
// rotation by which it differs from the rest pose in the T-pose, parents first. Then the measures.
#include "puppetri/figure/fit_humanoid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "finger_names.h"
#include "measure_skin.h"
#include "puppetri/base/require.h"
#include "puppetri/figure/humanoid.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

constexpr double kShortBone = 0.01;  // parts of the height
// A limb that is bent by more than this at rest tells about which axis it bends; less is noise.
constexpr double kLeastToes = 0.5;
constexpr double kTellsHinge = 0.34;  // its sine

Vec3 along(double s) { return {s, 0, 0}; }

class Fit {
 public:
    Fit(const Skeleton& raw, const Mesh& mesh, std::span<const FoundBone> bones)
        : raw_(raw), mesh_(mesh), rest_(raw.joints.size()), turned_(raw.joints.size()) {
        for (const FoundBone& b : bones) {
            joint_[b.bone] = b.joint;
        }
        to_model_space(raw, rest_pose(raw), rest_);
    }

    Checked<Humanoid> fit() {
        find_trunk();
        need_bones();
        if (!defects_.empty()) {
            return Unexpected(std::move(defects_));
        }
        need_order();
        if (!defects_.empty()) {
            return Unexpected(std::move(defects_));
        }
        to_t_pose();
        measure();
        if (!defects_.empty()) {
            return Unexpected(std::move(defects_));
        }
        Humanoid humanoid{make_humanoid(m_), {}};
        humanoid.rig = make_rig(humanoid.figure);
        return humanoid;
    }

 private:
    // ---- bones ----

    JointIndex joint(const std::string& bone) const {
        const auto at = joint_.find(bone);
        return at == joint_.end() ? JointIndex{} : at->second;
    }
    bool has(const std::string& bone) const { return joint(bone).valid(); }
    static std::string named(int side, const char* bone) {
        return (side == kLeft ? "left" : "right") + std::string(bone);
    }
    bool below(JointIndex lower, JointIndex upper) const {
        while (lower.valid() && lower != upper) {
            lower = raw_.joints[lower.value].parent;
        }
        return lower.valid();
    }
    void defect(const char* code, const std::string& bone, std::string message,
                std::string remedy) {
        defects_.push_back({Severity::kError,
                            code,
                            {},
                            language_bone(bone),
                            std::move(message),
                            std::move(remedy)});
    }

    // The joints from above the hips to the one from which the arms hang.
    void find_trunk() {
        const JointIndex hips = joint("hips");
        const std::string first_of_arm =
            has(named(kLeft, "Shoulder")) ? named(kLeft, "Shoulder") : named(kLeft, "UpperArm");
        if (!hips.valid() || !has(first_of_arm) || !below(joint(first_of_arm), hips)) {
            return;
        }
        std::vector<JointIndex> known, all;
        for (JointIndex j = raw_.joints[joint(first_of_arm).value].parent; j.valid() && j != hips;
             j = raw_.joints[j.value].parent) {
            const bool named_so =
                j == joint("spine") || j == joint("chest") || j == joint("upperChest");
            all.insert(all.begin(), j);
            if (named_so || known.empty()) {
                known.insert(known.begin(), j);  // what the arms hang from always counts
            }
        }
        for (const char* bone : {"spine", "chest", "upperChest"}) {
            joint_.erase(bone);
        }
        if (!known.empty()) {
            joint_["spine"] = known.front();
        }
        if (known.size() > 2) {
            joint_["chest"] = known[known.size() - 2];
        }
        if (known.size() > 1) {
            joint_[known.size() > 2 ? "upperChest" : "chest"] = known.back();
        }
    }

    void need_bones() {
        const auto need = [&](const std::string& bone) {
            if (!has(bone)) {
                defect("no-bone", bone, "the character has no " + language_bone(bone),
                       "name its joint: `bones { " + language_bone(bone) +
                           ": \"...\" }`; or let it be a `creature`, which plays clips of its "
                           "own joints");
            }
        };
        need("hips");
        if (has("hips") && has(named(kLeft, "UpperArm"))) {
            need("spine");
        }
        if (!has("head") && has("neck")) {
            joint_["head"] = joint_["neck"];
            joint_.erase("neck");
        }
        need("head");
        for (const int side : {kLeft, kRight}) {
            for (const char* bone :
                 {"UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot"}) {
                need(named(side, bone));
            }
        }
    }

    void need_order() {
        const auto order = [&](const std::string& lower, const std::string& upper) {
            if (has(lower) && has(upper) &&
                (joint(lower) == joint(upper) || !below(joint(lower), joint(upper)))) {
                defect("wrong-order", lower,
                       "the joint " + raw_.joints[joint(lower).value].name +
                           " does not hang from " + raw_.joints[joint(upper).value].name,
                       "name the joint of " + language_bone(lower) + " in `bones`");
            }
        };
        order("head", "spine");
        for (const int side : {kLeft, kRight}) {
            const auto n = [side](const char* bone) { return named(side, bone); };
            order(n("UpperArm"), has(n("Shoulder")) ? n("Shoulder") : "spine");
            order(n("LowerArm"), n("UpperArm"));
            order(n("Hand"), n("LowerArm"));
            order(n("UpperLeg"), "hips");
            order(n("LowerLeg"), n("UpperLeg"));
            order(n("Foot"), n("LowerLeg"));
            order(n("Toes"), n("Foot"));
        }
    }

    // ---- the T-pose ----

    Vec3 at_rest(const std::string& bone) const { return rest_[joint(bone).value].translation; }

    // The direction from one bone to another at rest, turned by what is above.
    Vec3 way(Quat turned, const std::string& from, const std::string& to) const {
        return normalized(rotate(turned, at_rest(to) - at_rest(from)), {0, 1, 0});
    }

    // Takes the upper part of a limb to `goal`, and if the limb is bent at rest its hinge to
    // `hinge`.
    Quat align(Quat turned, const std::string& upper, const std::string& middle,
               const std::string& lower, Vec3 goal, Vec3 hinge) const {
        const Vec3 a = way(turned, upper, middle), b = way(turned, middle, lower);
        const Quat straight = shortest_arc(a, goal, {0, 0, 1}) * turned;
        if (length(cross(a, b)) < kTellsHinge) {
            return straight;
        }
        const Vec3 bends = normalized(cross(goal, way(straight, middle, lower)));
        return shortest_arc(bends, hinge, goal) * straight;
    }

    // Where the foot points, as a heading: to its toes, or by the vertices of the foot.
    double foot_heading(int side, Quat turned) const {
        const std::string foot = named(side, "Foot"), toes = named(side, "Toes");
        Vec3 ahead = has(toes) ? at_rest(toes) - at_rest(foot)
                               : skin_ahead(raw_, mesh_, joint(foot), at_rest(foot));
        ahead = rotate(turned, ahead);
        // A foot that points straight down or has no length tells nothing.
        return std::sqrt(ahead.x * ahead.x + ahead.z * ahead.z) < 1e-6 ? 0 : heading_of(ahead);
    }

    void to_t_pose() {
        std::map<std::uint32_t, Quat> own;  // turned_ of joints that are aligned
        for (const int side : {kLeft, kRight}) {
            const double s = side == kLeft ? 1 : -1;
            const auto n = [side](const char* bone) { return named(side, bone); };
            // Feet stay flat as they are and point ahead; the legs turn with them.
            const Quat ahead = about_y(-foot_heading(side, {}));
            Quat thigh = align({}, n("UpperLeg"), n("LowerLeg"), n("Foot"), {0, -1, 0}, {1, 0, 0});
            const Quat carried =
                shortest_arc(way({}, n("UpperLeg"), n("LowerLeg")), {0, -1, 0}, {0, 0, 1});
            if (angle_between(thigh, carried) < 1e-9) {
                thigh = about_y(-foot_heading(side, thigh)) * thigh;
            }
            own[joint(n("UpperLeg")).value] = thigh;
            own[joint(n("LowerLeg")).value] =
                shortest_arc(way(thigh, n("LowerLeg"), n("Foot")), {0, -1, 0}, {1, 0, 0}) * thigh;
            own[joint(n("Foot")).value] = ahead;

            const Quat upper =
                align({}, n("UpperArm"), n("LowerArm"), n("Hand"), along(s), {0, -s, 0});
            const Quat fore =
                shortest_arc(way(upper, n("LowerArm"), n("Hand")), along(s), {0, 1, 0}) * upper;
            own[joint(n("UpperArm")).value] = upper;
            own[joint(n("LowerArm")).value] = fore;
            own[joint(n("Hand")).value] = hand_turned(side, fore);
        }
        for (std::uint32_t j = 0; j < raw_.joints.size(); ++j) {
            const JointIndex parent = raw_.joints[j].parent;
            const auto at = own.find(j);
            turned_[j] = at != own.end()  ? at->second
                         : parent.valid() ? turned_[parent.value]
                                          : Quat{};
        }
        // Every joint turned by its own, in place along the tree.
        pose_ = rest_pose(raw_);
        for (std::uint32_t j = 0; j < raw_.joints.size(); ++j) {
            const JointIndex parent = raw_.joints[j].parent;
            const Quat above =
                parent.valid() ? turned_[parent.value] * rest_[parent.value].rotation : Quat{};
            pose_.parent_from_joint[j].rotation =
                normalized(conjugate(above) * turned_[j] * rest_[j].rotation);
        }
        model_.resize(raw_.joints.size());
        to_model_space(raw_, pose_, model_);
    }

    // Palms face the floor, thumbs ahead: the fingers tell, or it stays as the forearm carries it.
    Quat hand_turned(int side, Quat fore) const {
        const double s = side == kLeft ? 1 : -1;
        const std::string hand = named(side, "Hand");
        const auto first = [&](const char* finger) {
            return named(side, finger) + std::string("Proximal");
        };
        Quat turned = fore;
        if (has(first("Middle"))) {
            turned = shortest_arc(way(fore, hand, first("Middle")), along(s), {0, 1, 0}) * fore;
        }
        const char* last = has(first("Little")) ? "Little" : "Ring";
        if (has(first("Index")) && has(first(last))) {
            Vec3 across = way(turned, first(last), first("Index"));
            across.x = 0;
            if (length(across) > 0.1) {
                turned = shortest_arc(normalized(across), {0, 0, 1}, along(s)) * turned;
            }
        }
        return turned;
    }

    // ---- measures, in the T-pose ----

    Vec3 place(const std::string& bone) const { return model_[joint(bone).value].translation; }

    void measure() {
        const SkinBox whole = skin_box(raw_, mesh_, model_, {});
        std::array<SkinBox, 2> feet;
        double floor = 0;
        for (const int side : {kLeft, kRight}) {
            feet[static_cast<std::size_t>(side)] =
                skin_box(raw_, mesh_, model_, joint(named(side, "Foot")));
            const SkinBox& foot = feet[static_cast<std::size_t>(side)];
            floor += (foot.empty() ? place(named(side, "Foot")).y : foot.low.y) / 2;
        }
        const double top = whole.empty() ? place("head").y : whole.high.y;
        m_.height_m = top - floor;
        if (!(m_.height_m > 0)) {
            defect("no-height", "head", "the character's head is not above its feet",
                   "its bones are named wrongly, or its rest pose lies down: name them in `bones`");
            return;
        }
        // The pelvis is where the mannequin's is, between the hip joints and a little above,
        // wherever the file has put its joint.
        hips_ = (place(named(kLeft, "UpperLeg")) + place(named(kRight, "UpperLeg"))) * 0.5 +
                Vec3{0, -mannequin_measures(1).legs[kLeft].hip.y * m_.height_m, 0};
        m_.hips_height_m = hips_.y - floor;
        measure_trunk(top);
        double ankles = 0;
        for (const int side : {kLeft, kRight}) {
            ankles += (place(named(side, "Foot")).y - floor) / 2;
        }
        m_.ankle_height_m = std::fmax(ankles, 0.005 * m_.height_m);
        for (const int side : {kLeft, kRight}) {
            measure_arm(side);
            measure_leg(side, feet[static_cast<std::size_t>(side)]);
        }
        const auto leg = [&](int side) {
            return m_.legs[static_cast<std::size_t>(side)].thigh_m +
                   m_.legs[static_cast<std::size_t>(side)].shank_m;
        };
        m_.leg_m = std::fmin(leg(kLeft), leg(kRight));
        measure_reach(floor);
        // Feet stand a little closer than the hips, as the mannequin's, but do not overlap.
        const double hip_side = (m_.legs[kLeft].hip.x - m_.legs[kRight].hip.x) / 2;
        double half_foot = 0;
        for (const SkinBox& foot : feet) {
            half_foot =
                foot.empty() ? half_foot : std::fmax(half_foot, (foot.high.x - foot.low.x) / 2);
        }
        m_.stance_half_width_m = std::fmax(0.72 * hip_side, 1.1 * half_foot);
    }

    void measure_trunk(double top) {
        const HumanoidMeasures like = mannequin_measures(1);
        Vec3 at = hips_;
        const auto offset = [&](const char* bone, Vec3& out) {
            if (has(bone)) {
                out = place(bone) - at;
                at = place(bone);
            }
        };
        offset("spine", m_.spine);
        offset("chest", m_.chest);
        offset("upperChest", m_.upper_chest);
        chest_ = at;
        if (has("neck")) {
            offset("neck", m_.neck);
            offset("head", m_.head);
        } else {
            offset("head", m_.neck);  // neck and head turn about one point
        }
        m_.head_top = {0, std::fmax(top - place("head").y, 0.02 * m_.height_m), 0};
        m_.eyes_head = like.eyes_head * (m_.head_top.y / like.head_top.y);
    }

    void measure_arm(int side) {
        const double s = side == kLeft ? 1 : -1;
        const auto n = [side](const char* bone) { return named(side, bone); };
        HumanoidMeasures::Arm& arm = m_.arms[static_cast<std::size_t>(side)];
        const Vec3 shoulder = place(n("UpperArm"));
        arm.clavicle = (has(n("Shoulder")) ? place(n("Shoulder")) : shoulder) - chest_;
        arm.shoulder = has(n("Shoulder")) ? shoulder - place(n("Shoulder")) : Vec3{};
        arm.upper_m = bone_length(n("UpperArm"), n("LowerArm"));
        arm.fore_m = bone_length(n("LowerArm"), n("Hand"));
        const Vec3 wrist = place(n("Hand"));
        const SkinBox skin = skin_box(raw_, mesh_, model_, joint(n("Hand")));
        const HumanoidMeasures like =
            mannequin_measures(m_.height_m >= 0.5 && m_.height_m <= 3 ? m_.height_m : 1.75);
        const HumanoidMeasures::Arm& usual = like.arms[static_cast<std::size_t>(side)];
        const double reach =
            skin.empty() ? usual.hand_m : s * ((s > 0 ? skin.high.x : skin.low.x) - wrist.x);
        arm.hand_m = reach > 0.02 * m_.height_m ? reach : usual.hand_m;
        // On the skin below the middle of the palm.
        Vec3 palm = usual.hand_from_palm.translation * (arm.hand_m / usual.hand_m);
        const SkinBox middle =
            skin_slice(raw_, mesh_, model_, joint(n("Hand")), wrist.x + s * 0.3 * arm.hand_m,
                       wrist.x + s * 0.6 * arm.hand_m);
        if (!middle.empty()) {
            palm.y = middle.low.y - wrist.y;
        }
        arm.hand_from_palm = {usual.hand_from_palm.rotation, palm};
        measure_fingers(side, usual);
    }

    // Which mannequin has arms that long; the breast lies as far below the shoulders as its.
    void measure_reach(double floor) {
        const HumanoidMeasures like = mannequin_measures(1);
        const auto arms = [](const HumanoidMeasures& m) {
            double sum = 0;
            for (const HumanoidMeasures::Arm& arm : m.arms) {
                sum += (arm.upper_m + arm.fore_m) / 2;
            }
            return sum;
        };
        m_.reach_height_m = arms(m_) / arms(like);
        const double shoulders =
            (place(named(kLeft, "UpperArm")).y + place(named(kRight, "UpperArm")).y) / 2 - floor;
        m_.breast_height_m =
            shoulders - (shoulder_height(like) - like.breast_height_m) * m_.reach_height_m;
    }
    static double shoulder_height(const HumanoidMeasures& m) {
        return m.hips_height_m + m.spine.y + m.chest.y + m.upper_chest.y +
               m.arms[kLeft].clavicle.y + m.arms[kLeft].shoulder.y;
    }

    void measure_fingers(int side, const HumanoidMeasures::Arm& usual) {
        HumanoidMeasures::Arm& arm = m_.arms[static_cast<std::size_t>(side)];
        const double scale = arm.hand_m / usual.hand_m;
        for (std::size_t f = 0; f < 5; ++f) {
            Vec3 at = place(named(side, "Hand"));
            for (std::size_t k = 0; k < 3; ++k) {
                const std::string bone = named(side, kFingerNames[f * 3 + k]);
                Vec3& offset = arm.fingers[f * 3 + k];
                offset = usual.fingers[f * 3 + k] * scale;
                if (has(bone)) {
                    offset = place(bone) - at;
                }
                at = at + offset;
            }
            arm.finger_tips[f] = usual.finger_tips[f] * scale;
        }
    }

    void measure_leg(int side, const SkinBox& skin) {
        const auto n = [side](const char* bone) { return named(side, bone); };
        HumanoidMeasures::Leg& leg = m_.legs[static_cast<std::size_t>(side)];
        const Vec3 ankle = place(n("Foot"));
        leg.hip = place(n("UpperLeg")) - hips_;
        leg.thigh_m = bone_length(n("UpperLeg"), n("LowerLeg"));
        leg.shank_m = bone_length(n("LowerLeg"), n("Foot"));
        const HumanoidMeasures like = mannequin_measures(1);
        const HumanoidMeasures::Leg& usual = like.legs[static_cast<std::size_t>(side)];
        const double sole = -m_.ankle_height_m;
        const double heel =
            skin.empty() ? usual.heel_foot.z * m_.height_m : std::fmin(skin.low.z - ankle.z, 0);
        double tip = skin.empty() ? usual.toe_tip_foot.z * m_.height_m : skin.high.z - ankle.z;
        if (tip - heel < 0.02 * m_.height_m) {
            tip = heel + usual.toe_tip_foot.z * m_.height_m;
        }
        // A joint of toes in the rear half of the foot bends the instep: nobody rolls over it.
        if (has(n("Toes")) && place(n("Toes")).z - ankle.z < heel + kLeastToes * (tip - heel)) {
            joint_.erase(n("Toes"));
        }
        // A foot without toes rolls over its tip: nothing of it may go into the floor.
        leg.toes =
            has(n("Toes")) ? place(n("Toes")) - ankle : Vec3{0, sole, tip - 0.004 * (tip - heel)};
        leg.toes.z = std::fmin(std::fmax(leg.toes.z, heel + 0.3 * (tip - heel)), tip);
        leg.heel_foot = {0, sole, heel};
        leg.ball_foot = {leg.toes.x, sole, leg.toes.z};
        leg.toe_tip_foot = {leg.toes.x, sole, tip};
    }

    double bone_length(const std::string& from, const std::string& to) {
        const double m = length(place(to) - place(from));
        if (!(m >= kShortBone * m_.height_m)) {
            defect("short-bone", from,
                   "from " + language_bone(from) + " to " + language_bone(to) +
                       " there is no length: the joints " + raw_.joints[joint(from).value].name +
                       " and " + raw_.joints[joint(to).value].name + " lie together",
                   "name the right joints in `bones`, or mend the skeleton");
            return 1;
        }
        return m;
    }

    // ---- the rig ----

    Rig make_rig(const Figure& figure) const {
        Rig rig;
        rig.raw_root = {0};
        rig.raw_hips = joint("hips");
        rig.raw_t_pose = pose_.parent_from_joint;
        for (const auto& [bone, raw_joint] : joint_) {
            const JointIndex at = figure.skeleton.find(lowest(bone));
            if (at.valid()) {
                const Transform& model = model_[raw_joint.value];
                rig.bones.push_back(
                    {raw_joint,
                     at,
                     {model.rotation, bone == "hips" ? model.translation - hips_ : Vec3{}}});
            }
        }
        rig.bones.push_back({{0}, figure.root, {model_[0].rotation, {}}});
        std::sort(rig.bones.begin(), rig.bones.end(),
                  [](const RigBone& a, const RigBone& b) { return a.joint.value < b.joint.value; });
        return rig;
    }

    // Of bones at one place the lowest: the joint turns as they do together.
    std::string lowest(const std::string& bone) const {
        if ((bone == "chest" || bone == "spine") && chest_bone() == bone) {
            return "upperChest";
        }
        return bone;
    }
    std::string chest_bone() const {
        return has("upperChest") ? "upperChest" : has("chest") ? "chest" : "spine";
    }

    const Skeleton& raw_;
    const Mesh& mesh_;
    std::map<std::string, JointIndex> joint_;
    std::vector<Transform> rest_, model_;  // model_from_joint at rest and in the T-pose
    std::vector<Quat> turned_;             // from rest to T-pose, in model space
    Pose pose_;                            // the T-pose
    HumanoidMeasures m_;
    Vec3 hips_, chest_;  // the pelvis; from where the arms hang
    Diagnostics defects_;
};

}  // namespace

Quat upright(Vec3 hips, Vec3 top, Vec3 left, Vec3 right) {
    const Vec3 up = normalized(top - hips, {0, 0, 0});
    Vec3 side = left - right;
    side = normalized(side - up * dot(up, side), {0, 0, 0});
    if (dot(up, up) == 0 || dot(side, side) == 0) {
        return {};
    }
    const Quat file_from_model = from_basis(side, up, cross(side, up));
    // The nearest of the 24 rotations that take axes to axes, within 25 degrees.
    const auto nearest_axis = [](Vec3 v) {
        const Vec3 a{std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)};
        return a.x >= a.y && a.x >= a.z ? Vec3{v.x > 0 ? 1.0 : -1.0, 0, 0}
               : a.y >= a.z             ? Vec3{0, v.y > 0 ? 1.0 : -1.0, 0}
                                        : Vec3{0, 0, v.z > 0 ? 1.0 : -1.0};
    };
    const Vec3 y = nearest_axis(up), x = nearest_axis(side);
    if (dot(x, y) == 0) {
        const Quat snapped = from_basis(x, y, cross(x, y));
        if (angle_between(snapped, file_from_model) < radians(25)) {
            return normalized(conjugate(snapped));
        }
    }
    return normalized(conjugate(file_from_model));
}

Checked<Humanoid> fit_humanoid(const Skeleton& raw, const Mesh& mesh,
                               std::span<const FoundBone> bones) {
    PUP_REQUIRE(!raw.joints.empty());
    return Fit(raw, mesh, bones).fit();
}

std::string language_bone(std::string_view vrm_bone) {
    for (const char* name :
         {"hips",           "spine",         "chest",         "upper_chest", "neck",
          "head",           "left_clavicle", "left_shoulder", "left_elbow",  "left_wrist",
          "left_hip",       "left_knee",     "left_ankle",    "left_toes",   "right_clavicle",
          "right_shoulder", "right_elbow",   "right_wrist",   "right_hip",   "right_knee",
          "right_ankle",    "right_toes"}) {
        if (humanoid_joint(name) == vrm_bone) {
            return name;
        }
    }
    return std::string(vrm_bone);
}

}  // namespace puppetri::figure
