// SPDX-License-Identifier: MIT
// Reading and writing joints by their DOFs, and the DOFs of humanoids. Of three turns R = R1 R2 R3
// about axes a, b, c with b orthogonal to both others, a . R c = a . R2 c = cos(t2 + u) with u the
// angle from a to c about b: that gives t2 twice, each t2 gives t1 (R1 takes R2 c to R c), and what
// is left is R3.
#include "puppetri/figure/dof.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/math/rotation.h"

namespace puppetri::figure {
namespace {

constexpr std::size_t kMostTurns = 3;
constexpr double kOrthogonal = 1e-9, kSingular = 1e-9;

// By how much to turn about the unit axis to bring the direction of `from` to that of `to`, as seen
// along the axis; 0 where one of them lies on it.
double angle_about(Vec3 axis, Vec3 from, Vec3 to) {
    const Vec3 a = from - axis * dot(axis, from), b = to - axis * dot(axis, to);
    if (dot(a, a) < kSingular * kSingular || dot(b, b) < kSingular * kSingular) {
        return 0;
    }
    return atan2(dot(axis, cross(a, b)), dot(a, b));
}

using Angles = std::array<double, kMostTurns>;

// One triple for the angle of the middle turn.
Angles with_middle(const std::array<const Dof*, kMostTurns>& turns, Quat rotation, double middle) {
    const Vec3 a = turns[0]->axis_joint, b = turns[1]->axis_joint, c = turns[2]->axis_joint;
    const Quat second = from_axis_angle(b, middle);
    const Vec3 aimed = rotate(second, c);
    if (length(cross(a, aimed)) < kSingular) {  // R1 and R3 turn about one line
        return {to_swing_twist(rotation * conjugate(second), a).twist_rad, middle, 0};
    }
    const double first = angle_about(a, aimed, rotate(rotation, c));
    const Quat third = conjugate(from_axis_angle(a, first) * second) * rotation;
    return {first, middle, to_swing_twist(third, c).twist_rad};
}

// How bad: first by how much values are outside their ranges, then how large they are.
std::array<double, 2> badness(const std::array<const Dof*, kMostTurns>& turns,
                              const Angles& angles) {
    std::array<double, 2> bad{};
    for (std::size_t i = 0; i < kMostTurns; ++i) {
        const double value = turns[i]->at_rest + turn_between(0, angles[i]);
        bad[0] += std::fmax(0, std::fmax(turns[i]->lo - value, value - turns[i]->hi));
        bad[1] += value * value;
    }
    // Rounding must not decide between two that are both inside.
    bad[0] = bad[0] < 1e-6 ? 0 : bad[0];
    return bad;
}

Angles three_turns(const std::array<const Dof*, kMostTurns>& turns, Quat rotation) {
    const Vec3 a = turns[0]->axis_joint, b = turns[1]->axis_joint, c = turns[2]->axis_joint;
    const double u = angle_about(b, a, c);
    const double cosine = clamp(dot(a, rotate(rotation, c)), -1, 1);
    const double sine = length(cross(a, rotate(rotation, c)));
    const double angle = atan2(sine, cosine);
    const Angles one = with_middle(turns, rotation, turn_between(u, angle));
    const Angles two = with_middle(turns, rotation, turn_between(u, -angle));
    return badness(turns, two) < badness(turns, one) ? two : one;
}

// The turns one after the other: each brings the axis of the next as near as it can.
Angles in_order(std::span<const Dof* const> turns, Quat rotation) {
    Angles angles{};
    Quat rest = rotation;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        const Vec3 axis = turns[i]->axis_joint;
        const bool last = i + 1 == turns.size();
        angles[i] = last ? to_swing_twist(rest, axis).twist_rad
                         : angle_about(axis, turns[i + 1]->axis_joint,
                                       rotate(rest, turns[i + 1]->axis_joint));
        rest = conjugate(from_axis_angle(axis, angles[i])) * rest;
    }
    return angles;
}

Angles angles_of(std::span<const Dof* const> turns, Quat rotation) {
    if (turns.size() == kMostTurns) {
        const std::array<const Dof*, kMostTurns> three{turns[0], turns[1], turns[2]};
        const Vec3 middle = three[1]->axis_joint;
        if (std::fabs(dot(middle, three[0]->axis_joint)) < kOrthogonal &&
            std::fabs(dot(middle, three[2]->axis_joint)) < kOrthogonal) {
            return three_turns(three, rotation);
        }
    }
    return in_order(turns, rotation);
}

struct Row {
    const char* what;
    Vec3 axis;
    double lo_deg, hi_deg;
    double at_rest_deg = 0;
};

class HumanoidDofs {
 public:
    explicit HumanoidDofs(const Figure& figure) : f_(figure) {}

    DofSet make() && {
        // Trunk and head: forward, to the left, to the left.
        const Vec3 flex{1, 0, 0}, side{0, 0, -1}, twist{0, 1, 0};
        add(f_.hips, "hips",
            {{"flex", flex, -180, 180}, {"side", side, -90, 90}, {"twist", twist, -180, 180}});
        for (const auto& [joint, name] :
             {std::pair{f_.spine, "spine"}, std::pair{f_.chest, "chest"},
              std::pair{f_.upper_chest, "upper_chest"}}) {
            add(joint, name,
                {{"flex", flex, -35, 35}, {"side", side, -25, 25}, {"twist", twist, -25, 25}});
        }
        for (const auto& [joint, name] : {std::pair{f_.neck, "neck"}, std::pair{f_.head, "head"}}) {
            add(joint, name,
                {{"flex", flex, -40, 40}, {"side", side, -30, 30}, {"twist", twist, -45, 45}});
        }
        for (const int i : {kLeft, kRight}) {
            add_arm(i);
            add_leg(i);
        }
        std::stable_sort(set_.dofs.begin(), set_.dofs.end(),
                         [](const Dof& a, const Dof& b) { return a.joint.value < b.joint.value; });
        return std::move(set_);
    }

 private:
    void add(JointIndex joint, const std::string& name, std::initializer_list<Row> rows) {
        for (const Row& row : rows) {
            set_.dofs.push_back({.name = name + "." + row.what,
                                 .joint = joint,
                                 .axis_joint = row.axis,
                                 .lo = radians(row.lo_deg),
                                 .hi = radians(row.hi_deg),
                                 .at_rest = radians(row.at_rest_deg)});
        }
    }
    static std::string named(int side, const char* name) {
        return (side == kLeft ? "left_" : "right_") + std::string(name);
    }

    // In the T-pose the arm lies along s x. Turning about +x is inward on both sides.
    void add_arm(int i) {
        const double s = i == kLeft ? 1 : -1;
        const Arm& arm = f_.arms[static_cast<std::size_t>(i)];
        const Vec3 ahead{0, -s, 0}, up{0, 0, s}, inward{1, 0, 0};
        add(arm.clavicle, named(i, "clavicle"),
            {{"flex", ahead, -30, 30}, {"side", up, -40, 40}, {"twist", inward, -20, 20}});
        // From hanging: forward about -x, then away from the body; the T-pose is 90 degrees of it.
        add(arm.shoulder, named(i, "shoulder"),
            {{"flex", {-1, 0, 0}, -60, 180},
             {"side", up, -30, 180, 90},
             {"twist", inward, -110, 110}});
        add(arm.elbow, named(i, "elbow"), {{"flex", ahead, 0, 150}});
        add(arm.hand, named(i, "wrist"),
            {{"flex", {0, 0, -s}, -80, 80}, {"side", ahead, -40, 40}, {"twist", inward, -95, 95}});
    }

    void add_leg(int i) {
        const double s = i == kLeft ? 1 : -1;
        const Leg& leg = f_.legs[static_cast<std::size_t>(i)];
        const Vec3 ahead{-1, 0, 0}, away{0, 0, s}, inward{0, -s, 0};
        add(leg.hip, named(i, "hip"),
            {{"flex", ahead, -30, 120}, {"side", away, -45, 45}, {"twist", inward, -45, 45}});
        add(leg.knee, named(i, "knee"), {{"flex", {1, 0, 0}, 0, 150}});
        add(leg.ankle, named(i, "ankle"),
            {{"flex", ahead, -55, 35}, {"side", away, -30, 30}, {"twist", inward, -30, 30}});
        add(leg.toes, named(i, "toes"), {{"flex", ahead, -40, 70}});
    }

    const Figure& f_;
    DofSet set_;
};

}  // namespace

DofIndex DofSet::find(std::string_view name) const {
    for (std::uint32_t i = 0; i < dofs.size(); ++i) {
        if (dofs[i].name == name) {
            return {i};
        }
    }
    return {};
}

DofSet::Range DofSet::of_joint(JointIndex joint) const {
    Range range;
    while (range.first < dofs.size() && dofs[range.first].joint != joint) {
        ++range.first;
    }
    while (range.first + range.count < dofs.size() &&
           dofs[range.first + range.count].joint == joint) {
        ++range.count;
    }
    return range;
}

Transform transform_of(std::span<const Dof> dofs, const Transform& parent_from_joint_rest,
                       std::span<const double> values) {
    PUP_REQUIRE(values.size() >= dofs.size());
    Transform t = parent_from_joint_rest;
    for (std::size_t i = 0; i < dofs.size(); ++i) {
        const double by = values[i] - dofs[i].at_rest;
        if (dofs[i].kind == DofKind::kTurn) {
            t.rotation = t.rotation * from_axis_angle(dofs[i].axis_joint, by);
        } else {
            t.translation = t.translation + rotate(t.rotation, dofs[i].axis_joint * by);
        }
    }
    t.rotation = normalized(t.rotation);
    return t;
}

void values_of(std::span<const Dof> dofs, const Transform& parent_from_joint_rest,
               const Transform& parent_from_joint, std::span<double> values) {
    PUP_REQUIRE(values.size() >= dofs.size());
    const Transform moved = inverse(parent_from_joint_rest) * parent_from_joint;
    std::array<const Dof*, kMostTurns> turns{};
    std::size_t count = 0;
    for (const Dof& dof : dofs) {
        if (dof.kind == DofKind::kTurn) {
            PUP_REQUIRE(count < kMostTurns);
            turns[count++] = &dof;
        }
    }
    const Angles angles = angles_of(std::span(turns).first(count), moved.rotation);
    Quat before;  // the turns before a slide
    std::size_t turn = 0;
    for (std::size_t i = 0; i < dofs.size(); ++i) {
        if (dofs[i].kind == DofKind::kTurn) {
            values[i] = dofs[i].at_rest + turn_between(0, angles[turn]);
            before = before * from_axis_angle(dofs[i].axis_joint, angles[turn]);
            ++turn;
        } else {
            values[i] =
                dofs[i].at_rest + dot(moved.translation, rotate(before, dofs[i].axis_joint));
        }
    }
}

DofSet humanoid_dofs(const Figure& figure) { return HumanoidDofs(figure).make(); }

std::string_view humanoid_joint(std::string_view language_name) {
    struct Name {
        std::string_view language, joint;
    };
    static constexpr Name kNames[] = {
        {"hips", "hips"},
        {"spine", "spine"},
        {"chest", "chest"},
        {"upper_chest", "upperChest"},
        {"neck", "neck"},
        {"head", "head"},
        {"left_clavicle", "leftShoulder"},
        {"left_shoulder", "leftUpperArm"},
        {"left_elbow", "leftLowerArm"},
        {"left_wrist", "leftHand"},
        {"left_hip", "leftUpperLeg"},
        {"left_knee", "leftLowerLeg"},
        {"left_ankle", "leftFoot"},
        {"left_toes", "leftToes"},
        {"right_clavicle", "rightShoulder"},
        {"right_shoulder", "rightUpperArm"},
        {"right_elbow", "rightLowerArm"},
        {"right_wrist", "rightHand"},
        {"right_hip", "rightUpperLeg"},
        {"right_knee", "rightLowerLeg"},
        {"right_ankle", "rightFoot"},
        {"right_toes", "rightToes"},
    };
    for (const Name& name : kNames) {
        if (name.language == language_name) {
            return name.joint;
        }
    }
    return {};
}

}  // namespace puppetri::figure
