// SPDX-License-Identifier: MIT
// Which swivel of the allowed ones. All rules but the free objective are closed: each is "the
// allowed swivel nearest to p" with a p of its own for every family, and a cost that compares
// families.
#include <array>

#include "limb_blocked.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "swivel_limits.h"

namespace puppetri::motion {
namespace {

double dot(Quat a, Quat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

// The sum of squared sines of half the joints' angles to a pose is m - r cos(x - p) of the swivel
// x: the rotation at x is cos(x/2) q0 + sin(x/2) q1, and its product with another quaternion,
// squared, is (a^2 + b^2) / 2 + (a^2 - b^2) / 2 cos x + a b sin x with a, b the products of q0, q1.
class MotionFrom {
 public:
    MotionFrom(const LimbPose& from, const LimbFamily& family) {
        const Vec3 b = family.axis_parent;
        const Quat turn{b.x, b.y, b.z, 0};
        add(dot(from.start, family.start_zero), dot(from.start, turn * family.start_zero));
        const double hinge = dot(from.hinge, family.hinge);
        least_ += 1 - hinge * hinge;
        if (family.end_turns) {
            const Quat fore = conjugate(family.start_zero * family.hinge);
            add(dot(from.end, fore * family.rotation_parent),
                dot(from.end, fore * (conjugate(turn) * family.rotation_parent)));
        }
    }
    CirclePoint best() const { return circle_direction(c_, s_); }
    double at(CirclePoint x) const { return least_ - c_ * x.cos - s_ * x.sin; }

 private:
    void add(double a, double b) {
        least_ += 1 - 0.5 * (a * a + b * b);
        c_ += 0.5 * (a * a - b * b);
        s_ += a * b;
    }
    double least_ = 0, c_ = 0, s_ = 0;
};

struct Best {
    double cost = 0;
    int family = -1;
    CirclePoint swivel;
    void offer(double other, int of, CirclePoint at) {
        if (family < 0 || other < cost) {
            cost = other;
            family = of;
            swivel = at;
        }
    }
};

// The least cost along an arc: samples, then golden sections around the least one.
void search(const LimbIk& ik, const LimbFamily& family, int index, const Arc& arc,
            const SwivelChoice& choice, Best& best) {
    const double length = length_rad(arc);
    const auto point = [&](double x) { return arc.from * circle_point(x); };
    const auto cost = [&](double x) { return choice.cost(choice.self, ik.at(family, point(x))); };
    const int steps = 2 + static_cast<int>(length / (2 * kPi) * choice.samples);
    int least = 0;
    double least_cost = 0;
    for (int i = 0; i <= steps; ++i) {
        const double c = cost(length * i / steps);
        if (i == 0 || c < least_cost) {
            least = i;
            least_cost = c;
        }
    }
    best.offer(least_cost, index,
               least == 0 ? arc.from
                          : (least == steps ? (arc.full ? arc.from : arc.to)
                                            : point(length * least / steps)));
    constexpr double kGolden = 0.61803398874989484820;
    double lo = length * (least - 1) / steps, hi = length * (least + 1) / steps;
    if (!arc.full) {
        lo = std::fmax(lo, 0);
        hi = std::fmin(hi, length);
    }
    double x1 = hi - kGolden * (hi - lo), x2 = lo + kGolden * (hi - lo);
    double c1 = cost(x1), c2 = cost(x2);
    while (hi - lo > 1e-9) {
        if (c1 < c2) {
            hi = x2;
            x2 = x1;
            c2 = c1;
            x1 = hi - kGolden * (hi - lo);
            c1 = cost(x1);
        } else {
            lo = x1;
            x1 = x2;
            c1 = c2;
            x2 = lo + kGolden * (hi - lo);
            c2 = cost(x2);
        }
    }
    best.offer(std::fmin(c1, c2), index, point(c1 < c2 ? x1 : x2));
}

}  // namespace

LimbSolution LimbIk::choose(const SwivelIntervals& intervals, const SwivelChoice& choice) const {
    PUP_REQUIRE(intervals.count > 0);
    PUP_REQUIRE(choice.rule != SwivelRule::kObjective || choice.cost != nullptr);
    Best best;
    bool has_family = false;
    for (int i = 0; i < intervals.count; ++i) {
        has_family = has_family || intervals.intervals[i].family == choice.family;
    }
    for (int i = 0; i < intervals.count; ++i) {
        const int index = intervals.intervals[i].family;
        if (has_family && index != choice.family) {
            continue;
        }
        const LimbFamily& family = intervals.families[index];
        const Arc& arc = intervals.intervals[i].arc;
        switch (choice.rule) {
            case SwivelRule::kNearest: {
                const CirclePoint at = nearest(arc, choice.swivel);
                best.offer(-puppetri::dot(at, choice.swivel), index, at);
                break;
            }
            case SwivelRule::kMiddle:
                best.offer(-length_order(arc), index, middle(arc));
                break;
            case SwivelRule::kLeastMotion: {
                const MotionFrom motion(choice.from, family);
                const CirclePoint at = nearest(arc, motion.best());
                best.offer(motion.at(at), index, at);
                break;
            }
            case SwivelRule::kElbow: {
                const CirclePoint at = nearest(arc, swivel_of_elbow(family, choice.elbow_parent));
                const Vec3 off = elbow_at(family, at) - choice.elbow_parent;
                best.offer(puppetri::dot(off, off), index, at);
                break;
            }
            case SwivelRule::kObjective:
                search(*this, family, index, arc, choice, best);
                break;
        }
    }
    LimbSolution solution;
    solution.family = best.family;
    solution.swivel = best.swivel;
    solution.pose = at(intervals.families[best.family], best.swivel);
    solution.within_limits = true;
    solution.residual_m = intervals.families[best.family].residual_m;
    return solution;
}

LimbSolution LimbIk::solve(const LimbGoal& goal, const SwivelChoice& choice) const {
    SwivelIntervals found;
    intervals(goal, found);
    if (found.count > 0) {
        return choose(found, choice);
    }
    return solve_blocked(*this, goal, found, choice);
}

}  // namespace puppetri::motion
