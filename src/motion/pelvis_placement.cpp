// SPDX-License-Identifier: MIT
// The hips must be within a ball around each ankle; moved by the hip's offset, both are balls for
// the pelvis.
#include "puppetri/motion/pelvis_placement.h"

#include <cmath>

namespace puppetri::motion {
namespace {

struct Ball {
    Vec3 centre;
    double radius = 0;
    double excess(Vec3 p) const { return std::fmax(0, length(p - centre) - radius); }
    // The nearest point of the ball.
    Vec3 nearest(Vec3 p) const {
        const Vec3 way = p - centre;
        const double d = length(way);
        return d <= radius ? p : centre + way * (radius / d);
    }
    // The highest point below p, straight down, that is in the ball; false where there is none.
    bool lowered(Vec3 p, double& y) const {
        const double dx = p.x - centre.x, dz = p.z - centre.z;
        const double h2 = radius * radius - dx * dx - dz * dz;
        if (h2 < 0) {
            return false;
        }
        y = std::fmin(y, centre.y + std::sqrt(h2));
        return y >= centre.y - std::sqrt(h2);
    }
};

constexpr double kRound = 1e-12;

// Projection onto the intersection: onto one ball, if that is in the other; else onto the circle in
// which the spheres meet; else, where they do not, between them.
Vec3 nearest_in_both(const Ball& a, const Ball& b, Vec3 p) {
    if (const Vec3 q = a.nearest(p); b.excess(q) <= kRound) {
        return q;
    }
    if (const Vec3 q = b.nearest(p); a.excess(q) <= kRound) {
        return q;
    }
    const Vec3 way = b.centre - a.centre;
    const double d = length(way);
    const Vec3 n = normalized(way);
    if (d >= a.radius + b.radius) {
        const double gap = d - a.radius - b.radius;
        return a.centre + n * (a.radius + gap / 2);
    }
    // Neither ball is within the other: that ball's projection would have been in both.
    const double x = (d * d + a.radius * a.radius - b.radius * b.radius) / (2 * d);
    const double r = std::sqrt(std::fmax(0, a.radius * a.radius - x * x));
    const Vec3 middle = a.centre + n * x, off = p - middle, across = off - n * dot(off, n);
    const Vec3 any = std::fabs(n.y) < 0.9 ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    return middle + normalized(across, normalized(any - n * dot(any, n))) * r;
}

}  // namespace

PlacedPelvis place_pelvis(const PelvisPlacement& placement) {
    const Quat turn = placement.wanted_world.rotation;
    const Vec3 wanted = placement.wanted_world.translation;
    std::array<Ball, 2> balls;
    for (int i = 0; i < 2; ++i) {
        const LegReach& leg = placement.legs[i];
        balls[i] = {leg.ankle_world - rotate(turn, leg.hip_pelvis), leg.longest_m};
    }
    PlacedPelvis placed{wanted, {}};
    if (balls[0].excess(wanted) > 0 || balls[1].excess(wanted) > 0) {
        double y = wanted.y;
        const bool down =
            placement.lower_first && balls[0].lowered(wanted, y) && balls[1].lowered(wanted, y);
        // The second ball may have lowered it out of the first.
        const Vec3 lower{wanted.x, y, wanted.z};
        placed.position_world = down && balls[0].excess(lower) <= kRound
                                    ? lower
                                    : nearest_in_both(balls[0], balls[1], wanted);
    }
    for (int i = 0; i < 2; ++i) {
        const double excess = balls[i].excess(placed.position_world);
        placed.residual_m[i] = excess > kRound ? excess : 0;
    }
    return placed;
}

}  // namespace puppetri::motion
