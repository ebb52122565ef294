// SPDX-License-Identifier: MIT
// Analytic inverse kinematics of a limb with seven degrees of freedom: a ball joint, a hinge, a
// ball joint, with any rest pose, proportions and hinge axis. A goal fixes the hinge and leaves one
// free parameter, the swivel: the turn of the whole limb about a line through its first joint (for
// a position, the line to the wrist). Under joint limits the swivels that are allowed are known
// exactly, as arcs of the circle: nothing is scanned, nothing iterated.
//
// Read it like this: a LimbShape is compiled to a LimbIk; LimbIk::families solves a goal up to the
// swivel (one family for each sign of the hinge, say); LimbIk::intervals gives the arcs of swivels
// within all limits; a SwivelChoice takes one; LimbIk::solve does all three.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "puppetri/base/diagnostic.h"
#include "puppetri/figure/limits.h"
#include "puppetri/figure/mannequin.h"
#include "puppetri/math/circle.h"
#include "puppetri/motion/controls.h"
#include "puppetri/motion/limb_goal.h"
#include "puppetri/motion/limb_tables.h"

namespace puppetri::motion {

// The first joint's rotation, the hinge's and the end's are those of a figure::Pose: relative to
// the parent, rest rotations included. A hinge that has turned by an angle x has the rotation
// hinge.parent_from_centre * (x about hinge.axis_joint).
struct LimbShape {
    Vec3 start;                      // of the first joint, in the space of its parent
    Vec3 upper;                      // of the hinge, in the space of the first joint
    Vec3 lower;                      // of the end joint, in the space of the hinge
    figure::JointLimit start_limit;  // kFree or kCone
    figure::JointLimit hinge;        // kHinge, or kFree for one that turns all round
    figure::JointLimit end_limit;    // kFree or kCone
};

// Fails   "zero-length-bone", "limit-order" and the other codes of figure::check, "limb-limit"
// where
//         a ball joint is limited like a hinge or a hinge like a ball joint, "stiff-limb" where
//         the hinge cannot change the limb's reach; `element` names the limb.
Status check(const LimbShape& shape, std::string_view element);

struct LimbPose {
    Quat start, hinge, end;
};
// Of the end joint in the space of the first joint's parent.
Transform parent_from_end(const LimbShape& shape, const LimbPose& pose);
Vec3 elbow_parent(const LimbShape& shape, const LimbPose& pose);
// The hinge's angle, in (-pi, pi], from its rotation.
double hinge_angle(const LimbShape& shape, const LimbPose& pose);

// Solutions that differ by their swivel alone. With the swivel x
//   start = (x about axis_parent) * start_zero,
//   end = end_zero, or for goals that fix the hand's rotation what is left of that.
struct LimbFamily {
    Vec3 axis_parent;  // unit
    Quat start_zero;   // at swivel 0: the limb's pole points to the goal's swivel_zero
    Quat hinge, end_zero;
    bool end_turns = false;    // end = conj(start * hinge) * rotation
    bool end_follows = false;  // end takes `axis_end` along `direction_parent`, its twist kept
    Quat rotation_parent;
    Vec3 direction_parent, axis_end;
    double residual_m = 0;  // what bones and hinge leave of the way to the goal
};
inline constexpr int kMaxLimbFamilies = 2;

// An arc of swivels of one family within all limits.
struct SwivelInterval {
    int family = 0;
    Arc arc;
};
struct SwivelIntervals {
    static constexpr int kMost = 6 * kMaxLimbFamilies;  // a family has at most 12 critical angles
    std::array<LimbFamily, kMaxLimbFamilies> families;
    int family_count = 0;
    std::array<SwivelInterval, kMost> intervals;
    int count = 0;
};

enum class SwivelRule : std::uint8_t {
    kNearest,      // to `swivel`
    kMiddle,       // of the longest interval
    kLeastMotion,  // from `from`: the least sum of squared sines of half the joints' angles
    kElbow,        // the hinge joint comes nearest to `elbow_parent`
    kObjective     // the least `cost`
};
struct SwivelChoice {
    SwivelRule rule = SwivelRule::kNearest;
    CirclePoint swivel = {};
    LimbPose from = {};
    Vec3 elbow_parent = {};
    // For kObjective: called with `self`, finite; sampled `samples` times per full circle and then
    // narrowed down around the least to 1e-9 rad by golden section.
    double (*cost)(const void* self, const LimbPose& pose) = nullptr;
    const void* self = nullptr;
    int samples = 90;
    int family = -1;  // only of this one, where it has an arc
};

struct LimbSolution {
    LimbPose pose;
    CirclePoint swivel;
    int family = -1;
    bool within_limits = false;  // all three joints
    double residual_m = 0;       // from the point that was to get there to the goal; pointing: 0
    double residual_rad = 0;     // of the rotation or direction that the goal asks for
};

class LimbIk {
 public:
    LimbIk() = default;
    // Needs   a shape that passes check().
    explicit LimbIk(const LimbShape& shape);

    const LimbShape& shape() const { return shape_; }
    // Distances of the end from the first joint that the hinge allows.
    double nearest_m() const { return nearest_m_; }
    double farthest_m() const { return farthest_m_; }

    // The goal up to the swivel: how many families (0 only for aiming along a ray that misses).
    // Limits of the hinge are kept, those of the ball joints are not looked at.
    // Cost    about 0.1 us each; no allocation.
    int families(const LimbGoal& goal, std::span<LimbFamily, kMaxLimbFamilies> out) const;

    // One family at a swivel.
    LimbPose at(const LimbFamily& family, CirclePoint swivel) const;
    // Where the hinge joint then is, in the space of the first joint's parent, and back: the swivel
    // with which it is nearest to a point. A straight limb has no elbow: the swivel is then 0.
    Vec3 elbow_at(const LimbFamily& family, CirclePoint swivel) const;
    CirclePoint swivel_of_elbow(const LimbFamily& family, Vec3 elbow_parent) const;

    // All swivels within the limits of both ball joints, of all families, exactly: each end of an
    // arc is a root of a trigonometric polynomial of degree 1 (twist, round cones) or 2 (elliptic
    // cones), derived in src/motion/swivel_limits.cpp. Arcs are ordered by family. Single points
    // that limits leave are told only where there is no arc. Cost    0.2 to 0.6 us a family; no
    // allocation.
    void intervals(const LimbGoal& goal, SwivelIntervals& out) const;

    // Takes a swivel out of the intervals. Needs count > 0.
    LimbSolution choose(const SwivelIntervals& intervals, const SwivelChoice& choice) const;

    // The goal within all limits, where there is a way. Otherwise what is left goes, in this order:
    // the rotation of the hand (its joint is clamped; residual_rad), then the position (the end
    // comes as near as the descent of src/motion/limb_blocked.cpp brings it; residual_m). All
    // joints are always within their limits.
    LimbSolution solve(const LimbGoal& goal, const SwivelChoice& choice) const;

    // The first family at a swivel, limits of the ball joints not looked at.
    // Cost    below 0.15 us.
    LimbSolution solve_free(const LimbGoal& goal, CirclePoint swivel) const;

    const LimbTables& tables() const { return tables_; }

 private:
    LimbShape shape_;
    LimbTables tables_;
    double nearest_m_ = 0, farthest_m_ = 0;
};

// A limb of a humanoid: from shoulder to wrist, in the space of the clavicle; from hip to ankle, in
// the space of the pelvis. Needs an arm or a leg.
LimbShape limb_shape(const figure::Figure& figure, Limb limb);
}  // namespace puppetri::motion
