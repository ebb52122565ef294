// SPDX-License-Identifier: MIT
// First the hand's rotation gives way: of the swivels within the limits of the first joint the one
// with the least excess of the end joint. Where the first joint itself cannot, a descent over its
// rotation and the hinge, within their limits, brings the end as near as it gets.
#include "limb_blocked.h"

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "swivel_limits.h"

namespace puppetri::motion {
namespace {

double angle_of_directions(Vec3 a, Vec3 b) {
    return puppetri::atan2(length(cross(a, b)), dot(a, b));
}

struct Miss {
    double m = 0, rad = 0;
};
Miss miss_of(const LimbShape& shape, const LimbGoal& goal, const LimbPose& pose) {
    const Transform hand = parent_from_end(shape, pose);
    const Vec3 tip = hand * goal.tip_end, axis = rotate(hand.rotation, normalized(goal.axis_end));
    const Vec3 to = goal.position_parent - tip;
    switch (goal.kind) {
        case LimbGoalKind::kPosition:
            return {length(to), 0};
        case LimbGoalKind::kPose:
            return {length(to), angle_between(hand.rotation, goal.rotation_parent)};
        case LimbGoalKind::kDirection:
            return {length(to), angle_of_directions(axis, normalized(goal.direction_parent))};
        case LimbGoalKind::kAim:
            return {length(to - axis * std::fmax(0, dot(to, axis))), 0};
        case LimbGoalKind::kPoint:
            break;
    }
    return {0, angle_of_directions(axis, normalized(goal.direction_parent))};
}

Quat clamped_end(const LimbShape& shape, const LimbGoal& goal, const LimbPose& pose) {
    Quat end = goal.end_rotation;
    if (goal.kind == LimbGoalKind::kPose) {
        end = conjugate(pose.start * pose.hinge) * goal.rotation_parent;
    } else if (goal.kind == LimbGoalKind::kDirection) {
        end = follow_direction(
            shape.end_limit, normalized(goal.axis_end),
            rotate(conjugate(pose.start * pose.hinge), normalized(goal.direction_parent)));
    }
    return figure::clamp_to_limit(shape.end_limit, end);
}

// The least excess of the end joint, over the swivels that the first joint allows.
struct EndExcess {
    const LimbShape& shape;
    static double cost(const void* self, const LimbPose& pose) {
        return figure::limit_excess_rad(static_cast<const EndExcess*>(self)->shape.end_limit,
                                        pose.end);
    }
};

class Descent {
 public:
    Descent(const LimbShape& shape, const LimbGoal& goal) : shape_(shape), goal_(goal) {}

    void start_from(const LimbPose& pose) {
        const LimbPose inside = with(pose.start, hinge_angle(shape_, pose));
        const double cost = cost_of(inside);
        if (!started_ || cost < cost_) {
            pose_ = inside;
            cost_ = cost;
            started_ = true;
        }
    }
    // Steps of one angle at a time, halved when none of them helps.
    LimbPose run() {
        constexpr double kFirst_rad = 0.4, kLast_rad = 1e-7;
        int tries = 0;
        for (double step = kFirst_rad; step > kLast_rad && tries < 4000; step /= 2) {
            for (bool better = true; better && tries < 4000;) {
                better = false;
                for (int i = 0; i < 8; ++i) {
                    better |= attempt(i / 2, i % 2 == 0 ? step : -step);
                    ++tries;
                }
            }
        }
        return pose_;
    }

 private:
    LimbPose with(Quat start, double hinge_rad) const {
        LimbPose pose;
        pose.start = figure::clamp_to_limit(shape_.start_limit, start);
        pose.hinge = figure::clamp_to_limit(
            shape_.hinge,
            shape_.hinge.parent_from_centre * from_axis_angle(shape_.hinge.axis_joint, hinge_rad));
        pose.end = clamped_end(shape_, goal_, pose);
        return pose;
    }
    // The position comes first: a radian of the hand is worth a thousandth of a limb's length.
    double cost_of(const LimbPose& pose) const {
        const Miss miss = miss_of(shape_, goal_, pose);
        return miss.m + miss.rad * (goal_.kind == LimbGoalKind::kPoint ? 1 : 1e-4);
    }
    bool attempt(int coordinate, double by) {
        const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        const double hinge = hinge_angle(shape_, pose_);
        const LimbPose next =
            coordinate < 3
                ? with(normalized(from_axis_angle(axes[coordinate], by) * pose_.start), hinge)
                : with(pose_.start, hinge + by);
        const double cost = cost_of(next);
        if (!(cost < cost_ - 1e-15)) {
            return false;
        }
        pose_ = next;
        cost_ = cost;
        return true;
    }

    const LimbShape& shape_;
    const LimbGoal& goal_;
    LimbPose pose_;
    double cost_ = 0;
    bool started_ = false;
};

}  // namespace

LimbSolution solve_blocked(const LimbIk& ik, const LimbGoal& goal, const SwivelIntervals& families,
                           const SwivelChoice& choice) {
    const LimbShape& shape = ik.shape();
    SwivelIntervals start_only = families;
    start_only.count = 0;
    for (int i = 0; i < families.family_count; ++i) {
        SwivelConstraints limits;
        limits.add_start(ik.tables().start, families.families[i]);
        append_arcs(limits, i, start_only);
    }
    LimbSolution solution;
    if (start_only.count > 0) {
        const EndExcess excess{shape};
        solution = ik.choose(start_only, {.rule = SwivelRule::kObjective,
                                          .cost = EndExcess::cost,
                                          .self = &excess,
                                          .samples = 48});
        solution.pose.end = figure::clamp_to_limit(shape.end_limit, solution.pose.end);
    } else {
        Descent descent(shape, goal);
        constexpr int kStarts = 12;
        for (int i = 0; i < families.family_count; ++i) {
            for (int k = 0; k < kStarts; ++k) {
                descent.start_from(ik.at(families.families[i],
                                         choice.swivel * circle_point(2 * kPi * k / kStarts)));
            }
        }
        solution.pose = descent.run();
        solution.family = 0;
    }
    const Miss miss = miss_of(shape, goal, solution.pose);
    solution.within_limits = true;
    solution.residual_m = miss.m;
    solution.residual_rad = miss.rad;
    return solution;
}

}  // namespace puppetri::motion
