// SPDX-License-Identifier: MIT
// Least motion from pose to pose, and a line that does not flip over the first joint.
#include "puppetri/motion/limb_track.h"

#include <algorithm>

#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

// A target nearer to the first joint than the hinge allows is replaced by the nearest point of the
// workspace, as LimbIk does anyway. On a path through the joint that point would leap from one side
// to the other. So the line may lag behind the target's direction, by at most pi (1 - d / d0) at a
// distance d of the joint: by nothing at the rim d0, where it must be exact, and by anything at the
// joint.
Vec3 lagging_line(Vec3 last, Vec3 direction, double distance_m, double rim_m) {
    const double most = kPi * (1 - distance_m / rim_m);
    const double angle = puppetri::atan2(length(cross(direction, last)), dot(direction, last));
    if (angle <= most) {
        return last;
    }
    const Vec3 axis = cross(direction, last);
    const Vec3 any = std::fabs(direction.x) < 0.7 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 unit = length(axis) > 1e-12 ? normalized(axis) : normalized(cross(direction, any));
    return rotate(from_axis_angle(unit, most), direction);
}

double largest_turn(const LimbPose& a, const LimbPose& b) {
    return std::max({angle_between(a.start, b.start), angle_between(a.hinge, b.hinge),
                     angle_between(a.end, b.end)});
}

// An arc that narrows until it is gone would leave a limb at its end no way but a jump, while the
// middle may lead on. So a limb that is near an end of its arc is brought away from it, by no more
// than the goal moves it anyway: at rest it stays.
LimbSolution keep_from_ends(const LimbIk& ik, const SwivelIntervals& arcs,
                            const LimbSolution& least, double moved_rad) {
    constexpr double kOuter = 0.25;  // the part of the arc at each end
    for (int i = 0; i < arcs.count; ++i) {
        const auto& [family, arc] = arcs.intervals[i];
        if (family != least.family || arc.full || !contains(arc, least.swivel)) {
            continue;
        }
        const double length = length_rad(arc), at = length_rad({arc.from, least.swivel});
        const double inner = clamp(at, kOuter * length, (1 - kOuter) * length);
        const double by = clamp(inner - at, -moved_rad, moved_rad);
        if (by == 0 || at > length) {
            return least;
        }
        return ik.choose(arcs, {.swivel = least.swivel * circle_point(by), .family = family});
    }
    return least;
}

}  // namespace

LimbStep follow(const LimbIk& ik, LimbGoal goal, LimbTrack& track) {
    const Vec3 start = ik.shape().start;
    const bool reaches = goal.kind == LimbGoalKind::kPosition || goal.kind == LimbGoalKind::kPose;
    const Vec3 tip_parent =
        goal.kind == LimbGoalKind::kPose ? rotate(goal.rotation_parent, goal.tip_end) : Vec3{};
    const Vec3 target = goal.position_parent - start - tip_parent;
    const double distance = length(target), rim = ik.nearest_m();
    Vec3 line = normalized(target, track.started ? track.line_parent : goal.line_on_root);
    double moved_goal = 0;
    if (reaches && goal.tip_end == Vec3{} && track.started && distance < rim && rim > 0) {
        line = lagging_line(track.line_parent, line, distance, rim);
        moved_goal = length(line * rim - target);
        goal.position_parent = start + line * rim;
    }
    goal.line_on_root = line;
    LimbStep step;
    const SwivelChoice choice =
        track.started ? SwivelChoice{.rule = SwivelRule::kLeastMotion, .from = track.pose}
                      : SwivelChoice{.rule = SwivelRule::kMiddle};
    SwivelIntervals arcs;
    ik.intervals(goal, arcs);
    if (arcs.count == 0) {
        step.solution = ik.solve(goal, choice);
    } else {
        step.solution = ik.choose(arcs, choice);
        if (track.started) {
            step.solution = keep_from_ends(ik, arcs, step.solution,
                                           largest_turn(track.pose, step.solution.pose));
        }
    }
    step.solution.residual_m += moved_goal;
    if (track.started) {
        step.moved_rad = largest_turn(track.pose, step.solution.pose);
    }
    track = {step.solution.pose, line, true};
    return step;
}

}  // namespace puppetri::motion
