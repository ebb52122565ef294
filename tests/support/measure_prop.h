// SPDX-License-Identifier: MIT
// The instrument for held and thrown balls: palms against the ball's surface, velocities, flights.
// It sees transforms over time and nothing else, so that it judges a performance and an exported
// file read back alike.
#pragma once
#include <cmath>
#include <functional>
#include <span>
#include <vector>

#include "puppetri/figure/mannequin.h"

namespace puppetri::test {

struct BallInput {
    const figure::Figure& figure;  // of the actor whose hands are looked at
    std::function<void(double t_s, std::span<Transform> world_from_joint)> sample;
    std::function<Vec3(double t_s)> ball;  // its centre
    double radius_m = 0.11;
};

class BallMeasure {
 public:
    explicit BallMeasure(BallInput input)
        : in_(std::move(input)), world_(in_.figure.skeleton.joints.size()) {}

    // Distance from the palm (0 left, 1 right) to the surface of the ball; negative inside it.
    double palm_to_surface_m(int side, double t_s) {
        return length(palm(side, t_s) - in_.ball(t_s)) - in_.radius_m;
    }
    // The larger of both, as an absolute value.
    double palms_off_m(double t_s) {
        return std::fmax(std::fabs(palm_to_surface_m(0, t_s)),
                         std::fabs(palm_to_surface_m(1, t_s)));
    }

    Vec3 palm(int side, double t_s) {
        in_.sample(t_s, world_);
        const figure::Arm& arm = in_.figure.arms[static_cast<std::size_t>(side)];
        return world_[arm.hand.value] * arm.hand_from_palm.translation;
    }
    Vec3 wrist(int side, double t_s) {
        in_.sample(t_s, world_);
        return world_[in_.figure.arms[static_cast<std::size_t>(side)].hand.value].translation;
    }
    // One-sided, so that it can be asked at the border of two movements; h_s < 0 looks back.
    Vec3 palm_velocity(int side, double t_s, double h_s) {
        return (palm(side, t_s + h_s) - palm(side, t_s)) * (1 / h_s);
    }
    Vec3 wrist_velocity(int side, double t_s, double h_s) {
        return (wrist(side, t_s + h_s) - wrist(side, t_s)) * (1 / h_s);
    }
    Vec3 ball_velocity(double t_s, double h_s) {
        return (in_.ball(t_s + h_s) - in_.ball(t_s)) * (1 / h_s);
    }

    // Largest distance of the path in [begin, end] from the parabola under standard gravity through
    // both of its ends.
    double off_parabola_m(double begin_s, double end_s, double rate_hz) {
        const double gravity = 9.80665, span = end_s - begin_s;
        const Vec3 p0 = in_.ball(begin_s), p1 = in_.ball(end_s);
        Vec3 v = (p1 - p0) * (1 / span);
        v.y += gravity * span / 2;
        double worst = 0;
        for (double t = begin_s; t <= end_s; t += 1 / rate_hz) {
            const double s = t - begin_s;
            Vec3 p = p0 + v * s;
            p.y -= gravity * s * s / 2;
            worst = std::fmax(worst, length(p - in_.ball(t)));
        }
        return worst;
    }

 private:
    BallInput in_;
    std::vector<Transform> world_;
};

inline double degrees_between(Vec3 a, Vec3 b) {
    const double c = dot(a, b) / (length(a) * length(b));
    return std::acos(c > 1 ? 1 : c < -1 ? -1 : c) * 180 / 3.14159265358979323846;
}

}  // namespace puppetri::test
