// SPDX-License-Identifier: MIT
// First the hand's rotation gives way: of the swivels within the limits of the first joint the one
// with the least excess of the end joint. Where the first joint itself cannot, a descent over its
// rotation and the hinge, within their limits, brings the end as near as it gets.
#include "limb_blocked.h"

#include <algorithm>
#include <array>

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

    // Keeps the best few of the poses that it is given.
    void start_from(const LimbPose& pose) {
        Candidate c;
        c.pose = with(pose.start, hinge_angle(shape_, pose));
        c.cost = cost_of(c.pose);
        int k = std::min(count_, kKept - 1);
        if (count_ == kKept && c.cost >= best_[k].cost) {
            return;
        }
        count_ = std::min(count_ + 1, kKept);
        for (; k > 0 && c.cost < best_[k - 1].cost; --k) {
            best_[k] = best_[k - 1];
        }
        best_[k] = c;
    }
    LimbPose run() {
        Candidate best;
        for (int i = 0; i < count_; ++i) {
            descend(best_[i], 0.4, 0.01);
            if (i == 0 || best_[i].cost < best.cost) {
                best = best_[i];
            }
        }
        descend(best, 0.02, 1e-8);
        return best.pose;
    }

 private:
    static constexpr int kKept = 10;
    struct Candidate {
        LimbPose pose;
        double cost = 0;
    };

    LimbPose with(Quat start, double hinge_rad) const {
        LimbPose pose;
        pose.start = figure::clamp_to_limit(shape_.start_limit, start);
        pose.hinge = figure::clamp_to_limit(
            shape_.hinge,
            shape_.hinge.parent_from_centre * from_axis_angle(shape_.hinge.axis_joint, hinge_rad));
        pose.end = clamped_end(shape_, goal_, pose);
        return pose;
    }
    // The position comes first: a radian of the hand is worth a tenth of a millimetre.
    double cost_of(const LimbPose& pose) const {
        const Miss miss = miss_of(shape_, goal_, pose);
        return miss.m + miss.rad * (goal_.kind == LimbGoalKind::kPoint ? 1 : 1e-4);
    }
    // Steps of one angle at a time, and of the hinge together with a turn; halved when none helps.
    // Every pose is brought into the limits, so that steps slide along them.
    void descend(Candidate& c, double first_rad, double last_rad) const {
        int tries = 0;
        for (double step = first_rad; step > last_rad && tries < 3000; step /= 2) {
            for (bool better = true; better && tries < 3000;) {
                better = false;
                for (int i = 0; i < kMoves; ++i, ++tries) {
                    better |= attempt(c, i / 2, i % 2 == 0 ? step : -step);
                }
            }
        }
    }
    // Turns about the axes of the parent, about those of the joint's limit, and the hinge; then the
    // hinge with each of the latter in both senses.
    static constexpr int kMoves = 2 * (3 + 3 + 1 + 6);
    bool attempt(Candidate& c, int coordinate, double by) const {
        const figure::JointLimit& limit = shape_.start_limit;
        const Vec3 local[] = {limit.axis_joint, limit.side_joint,
                              cross(limit.axis_joint, limit.side_joint)};
        const Vec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
        Quat start = c.pose.start;
        double hinge = hinge_angle(shape_, c.pose);
        if (coordinate < 3) {
            start = from_axis_angle(axes[coordinate], by) * start;
        } else if (coordinate < 6) {
            start = start * from_axis_angle(local[coordinate - 3], by);
        } else {
            hinge += by;
            if (coordinate > 6) {
                const int k = coordinate - 7;
                start = start * from_axis_angle(local[k % 3], k < 3 ? by : -by);
            }
        }
        const LimbPose next = with(normalized(start), hinge);
        const double cost = cost_of(next);
        if (!(cost < c.cost - 1e-15)) {
            return false;
        }
        c = {next, cost};
        return true;
    }

    const LimbShape& shape_;
    const LimbGoal& goal_;
    std::array<Candidate, kKept> best_;
    int count_ = 0;
};

// From all round each family, and from all over the first joint's cone; with several bends.
void start_everywhere(Descent& descent, const LimbIk& ik, const SwivelIntervals& families,
                      CirclePoint first) {
    constexpr int kRound = 12;
    const figure::JointLimit &limit = ik.shape().start_limit, &hinge = ik.shape().hinge;
    const auto with_bends = [&](LimbPose pose) {
        descent.start_from(pose);
        for (int n = 0; n < 4; ++n) {
            const double angle = hinge.kind == figure::LimitKind::kHinge
                                     ? lerp(hinge.lo_rad, hinge.hi_rad, n / 3.0)
                                     : n * kPi / 2;
            pose.hinge = hinge.parent_from_centre * from_axis_angle(hinge.axis_joint, angle);
            descent.start_from(pose);
        }
    };
    for (int i = 0; i < families.family_count; ++i) {
        for (int k = 0; k < kRound; ++k) {
            with_bends(ik.at(families.families[i], first * circle_point(2 * kPi * k / kRound)));
        }
    }
    const Vec3 other = cross(limit.axis_joint, limit.side_joint);
    for (int k = 0; k < 3 * kRound; ++k) {
        const double round = 2 * kPi * (k % kRound) / kRound, twist = (k / kRound) / 2.0;
        const Vec3 about = limit.side_joint * puppetri::cos(round) + other * puppetri::sin(round);
        LimbPose pose;  // the hand follows
        pose.start = limit.parent_from_centre * from_axis_angle(about, 1.2) *
                     from_axis_angle(limit.axis_joint, lerp(limit.lo_rad, limit.hi_rad, twist));
        with_bends(pose);
    }
}

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
        if (start_only.count == 0) {
            append_touching(limits, i, start_only);
        }
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
        if (choice.rule == SwivelRule::kLeastMotion) {
            descent.start_from(choice.from);  // from there alone, so that the limb does not leap
        } else {
            start_everywhere(descent, ik, families, choice.swivel);
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
