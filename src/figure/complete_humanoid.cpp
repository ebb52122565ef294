// SPDX-License-Identifier: MIT
// Parents are changed and joints appended first; then all are put into an order in which parents
// come before children, and their rest is taken anew from where they are.
#include "puppetri/figure/complete_humanoid.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "puppetri/figure/humanoid.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

// Of the upper part of the limb: the lower part's length, and what lies at one place.
constexpr double kShortest = 0.4, kLongest = 2.5, kTogether = 0.02;
constexpr double kOuter = 0.8;  // of the forearm: what hangs beyond belongs to the hand

class Completion {
 public:
    Completion(const Skeleton& raw, const Mesh& mesh, std::span<const FoundBone> bones)
        : raw_(raw), mesh_(mesh), joints_(raw.joints), model_(raw.joints.size()) {
        for (const FoundBone& b : bones) {
            joint_[b.bone] = b.joint;
        }
        to_model_space(raw, rest_pose(raw), model_);
    }

    CompletedSkeleton complete() {
        find_pelvis();
        for (const char* side : {"left", "right"}) {
            const auto n = [side](const char* bone) { return std::string(side) + bone; };
            hang(n("UpperLeg"), n("LowerLeg"), n("Foot"));
            hang(n("UpperArm"), n("LowerArm"), n("Hand"));
            make_wrist(n("UpperArm"), n("LowerArm"), n("Hand"));
        }
        lay_out();
        return std::move(out_);
    }

 private:
    JointIndex bone(const std::string& name) const {
        const auto at = joint_.find(name);
        return at == joint_.end() ? JointIndex{} : at->second;
    }
    Vec3 place(JointIndex j) const { return model_[j.value].translation; }
    bool below(JointIndex lower, JointIndex upper) const {
        while (lower.valid() && lower != upper) {
            lower = joints_[lower.value].parent;
        }
        return lower.valid();
    }
    bool fits(double lower_m, double upper_m) const {
        return lower_m >= kShortest * upper_m && lower_m <= kLongest * upper_m;
    }
    void note(const std::string& bone, std::string message) {
        const std::string name = language_bone(bone);
        out_.notes.push_back(
            {Severity::kNote,
             "rehung",
             {},
             name,
             std::move(message),
             "if that is wrong, name its joint: `bones { " + name + ": \"...\" }`"});
    }

    // The legs hang beside what is called hips: what is above them all is the pelvis.
    void find_pelvis() {
        const JointIndex hips = bone("hips"), left = bone("leftUpperLeg"),
                         right = bone("rightUpperLeg");
        if (!hips.valid() || !left.valid() || !right.valid() ||
            (below(left, hips) && below(right, hips))) {
            return;
        }
        JointIndex above = joints_[hips.value].parent;
        while (above.valid() && !(below(left, above) && below(right, above))) {
            above = joints_[above.value].parent;
        }
        const bool taken = std::any_of(joint_.begin(), joint_.end(),
                                       [&](const auto& b) { return b.second == above; });
        if (!above.valid() || above.value == 0 || taken) {
            return;
        }
        joint_.emplace("spine", hips);
        joint_["hips"] = above;
        note("hips", "the legs do not hang from the joint " + joints_[hips.value].name +
                         " but from " + joints_[above.value].name + ", which moves as the hips");
    }

    void hang(const std::string& upper, const std::string& lower, const std::string& end) {
        const JointIndex u = bone(upper), l = bone(lower), e = bone(end);
        if (!u.valid() || !l.valid() || !e.valid() || below(e, l) || below(l, e) || !below(l, u) ||
            !fits(length(place(e) - place(l)), length(place(l) - place(u)))) {
            return;
        }
        const JointIndex was = joints_[e.value].parent;
        joints_[e.value].parent = l;
        note(end, "the joint " + joints_[e.value].name + " hangs from " +
                      (was.valid() ? joints_[was.value].name : std::string("nothing")) +
                      " in the file; here it hangs from " + joints_[l.value].name);
    }

    void make_wrist(const std::string& upper, const std::string& lower, const std::string& hand) {
        const JointIndex u = bone(upper), l = bone(lower);
        if (bone(hand).valid() || !u.valid() || !l.valid() || !below(l, u)) {
            return;
        }
        const Vec3 elbow = place(l);
        const double upper_m = length(elbow - place(u));
        const std::vector<JointIndex> hanging = beyond(l, kShortest * upper_m);
        Vec3 wrist = elbow;
        std::string where;
        CompletedSkeleton::Sleeve sleeve{l, {}, {}, {}};
        if (!hanging.empty()) {
            wrist = meeting_point(hanging, elbow, kTogether * upper_m);
            where = "where its fingers hang from ";
        } else if (const Vec3 far = farthest_skin(l); length(far - elbow) > 0) {
            const HumanoidMeasures like = mannequin_measures(1);
            const HumanoidMeasures::Arm& arm = like.arms[kLeft];
            wrist = elbow + (far - elbow) * (arm.fore_m / (arm.fore_m + arm.hand_m));
            where = "on the skin of ";
            sleeve.wrist_model = wrist;
            sleeve.ahead_model = normalized(far - elbow, {1, 0, 0});
        } else if (mesh_.positions.empty()) {
            wrist = model_[l.value] * raw_.joints[l.value].end_site_joint;
            where = "at the end of ";
        }
        if (where.empty() || !fits(length(wrist - elbow), upper_m)) {
            return;
        }
        const JointIndex made{static_cast<std::uint32_t>(joints_.size())};
        joints_.push_back({free_name(hand), l, {}, {}});
        model_.push_back({model_[l.value].rotation, wrist});
        joint_[hand] = made;
        for (const JointIndex j : hanging) {
            if (length(place(j) - elbow) >= kOuter * length(wrist - elbow)) {
                joints_[j.value].parent = made;
            }
        }
        if (hanging.empty() && !mesh_.positions.empty()) {
            sleeve.wrist = made;
            out_.sleeves.push_back(sleeve);
        }
        note(hand, "there is no joint of it in the file; here one is made " + where +
                       joints_[l.value].name);
    }

    // What hangs from a joint at least so far off; no twist bones.
    std::vector<JointIndex> beyond(JointIndex joint, double least_m) const {
        std::vector<JointIndex> list;
        for (std::uint32_t j = 0; j < raw_.joints.size(); ++j) {
            const bool twist = std::any_of(joint_.begin(), joint_.end(), [&](const auto& b) {
                return b.second == JointIndex{j} && b.first.ends_with("Twist");
            });
            if (joints_[j].parent == joint && !twist &&
                length(place({j}) - place(joint)) >= least_m) {
                list.push_back({j});
            }
        }
        return list;
    }

    Vec3 meeting_point(const std::vector<JointIndex>& joints, Vec3 from, double together_m) const {
        std::size_t most = 0;
        Vec3 best = from;
        for (const JointIndex j : joints) {
            const auto near = static_cast<std::size_t>(std::count_if(
                joints.begin(), joints.end(),
                [&](JointIndex k) { return length(place(j) - place(k)) <= together_m; }));
            if (near > most ||
                (near == most && length(place(j) - from) > length(best - from) + together_m)) {
                most = near;
                best = place(j);
            }
        }
        return best;
    }

    // The joint's place, where it has no skin.
    Vec3 farthest_skin(JointIndex joint) const {
        Vec3 far = place(joint);
        for (std::size_t v = 0; v < mesh_.joints.size(); ++v) {
            float share = 0;
            for (std::size_t k = 0; k < 4; ++k) {
                share += mesh_.joints[v][k] == joint.value ? mesh_.weights[v][k] : 0;
            }
            const Vec3 p{mesh_.positions[v][0], mesh_.positions[v][1], mesh_.positions[v][2]};
            if (share > 0.5f && length(p - place(joint)) > length(far - place(joint))) {
                far = p;
            }
        }
        return far;
    }

    std::string free_name(const std::string& name) const {
        std::string free = name;
        for (int i = 2; std::any_of(joints_.begin(), joints_.end(),
                                    [&](const Joint& j) { return j.name == free; });
             ++i) {
            free = name + "_" + std::to_string(i);
        }
        return free;
    }

    void lay_out() {
        const auto count = static_cast<std::uint32_t>(joints_.size());
        // Depth first, children in the order in which they were: parents come before them.
        std::vector<std::vector<std::uint32_t>> children(count);
        std::vector<std::uint32_t> open, order;
        for (std::uint32_t j = count; j-- > 0;) {
            auto& list = joints_[j].parent.valid() ? children[joints_[j].parent.value] : open;
            list.push_back(j);
        }
        if (count == raw_.joints.size() &&
            std::equal(joints_.begin(), joints_.end(), raw_.joints.begin(),
                       [](const Joint& a, const Joint& b) { return a.parent == b.parent; })) {
            for (std::uint32_t j = 0; j < count; ++j) {
                order.push_back(j);
            }
            open.clear();
        }
        while (!open.empty()) {
            const std::uint32_t j = open.back();
            open.pop_back();
            order.push_back(j);
            open.insert(open.end(), children[j].begin(), children[j].end());
        }
        std::vector<JointIndex> to(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            to[order[i]] = {i};
        }
        out_.skeleton.height_m = raw_.height_m;
        for (const std::uint32_t j : order) {
            Joint joint = joints_[j];
            const bool as_it_was = j < raw_.joints.size() && joint.parent == raw_.joints[j].parent;
            if (!as_it_was) {
                joint.parent_from_joint_rest = inverse(model_[joint.parent.value]) * model_[j];
                joint.parent_from_joint_rest.rotation =
                    normalized(joint.parent_from_joint_rest.rotation);
            }
            if (joint.parent.valid()) {
                joint.parent = to[joint.parent.value];
                out_.skeleton.joints[joint.parent.value].end_site_joint = {};
            }
            if (j >= raw_.joints.size() && children[j].empty()) {
                joint.end_site_joint = joint.parent_from_joint_rest.translation * 0.5;
            }
            out_.skeleton.joints.push_back(std::move(joint));
            out_.from.push_back(j < raw_.joints.size() ? JointIndex{j} : JointIndex{});
        }
        for (const auto& [bone, j] : joint_) {
            out_.bones.push_back({bone, to[j.value]});
        }
        for (CompletedSkeleton::Sleeve& sleeve : out_.sleeves) {
            sleeve.wrist = to[sleeve.wrist.value];
        }
    }

    const Skeleton& raw_;
    const Mesh& mesh_;
    std::vector<Joint> joints_;     // those given, then those made
    std::vector<Transform> model_;  // of all, at rest
    std::map<std::string, JointIndex> joint_;
    CompletedSkeleton out_;
};

}  // namespace

CompletedSkeleton complete_humanoid(const Skeleton& raw, const Mesh& mesh,
                                    std::span<const FoundBone> bones) {
    return Completion(raw, mesh, bones).complete();
}

Pose CompletedSkeleton::carry(const Skeleton& given, const Pose& pose) const {
    std::vector<Transform> was(given.joints.size()), is(skeleton.joints.size());
    to_model_space(given, pose, was);
    Pose out = rest_pose(skeleton);
    for (std::size_t j = 0; j < is.size(); ++j) {
        const JointIndex parent = skeleton.joints[j].parent;
        const Transform above = parent.valid() ? is[parent.value] : Transform{};
        is[j] = from[j].valid() ? was[from[j].value] : above * out.parent_from_joint[j];
        out.parent_from_joint[j] = inverse(above) * is[j];
        out.parent_from_joint[j].rotation = normalized(out.parent_from_joint[j].rotation);
    }
    return out;
}

void CompletedSkeleton::rebind(Mesh& mesh) const {
    std::vector<std::uint16_t> to(from.size());
    for (std::size_t j = 0; j < from.size(); ++j) {
        if (from[j].valid()) {
            to[from[j].value] = static_cast<std::uint16_t>(j);
        }
    }
    for (std::size_t v = 0; v < mesh.joints.size(); ++v) {
        const Vec3 p{mesh.positions[v][0], mesh.positions[v][1], mesh.positions[v][2]};
        for (std::uint16_t& joint : mesh.joints[v]) {
            const std::uint16_t was = joint;
            joint = to[was];
            for (const Sleeve& sleeve : sleeves) {
                if (sleeve.forearm.value == was &&
                    dot(p - sleeve.wrist_model, sleeve.ahead_model) > 0) {
                    joint = static_cast<std::uint16_t>(sleeve.wrist.value);
                }
            }
        }
    }
}

}  // namespace puppetri::figure
