// SPDX-License-Identifier: MIT
// Piecewise quintic curves through keys of position, velocity and acceleration: twice continuously
// differentiable by construction, and exact for everything up to polynomials of degree five between
// two keys. Gait and joins are made of them.
#pragma once
#include <array>
#include <vector>

#include "puppetri/math/transform.h"

namespace puppetri {

struct Motion1 {
    double position = 0, velocity = 0, acceleration = 0;
};
struct Motion3 {
    Vec3 position, velocity, acceleration;
};

// The polynomial of degree five with the given motion at 0 and at duration_s > 0.
struct Quintic {
    std::array<double, 6> coefficient{};

    static Quintic between(Motion1 from, Motion1 to, double duration_s);
    Motion1 at(double t_s) const;
};

struct Key1 {
    double t_s = 0;
    Motion1 motion;
};

// Keys in strictly ascending order of time. Before the first and after the last key the curve holds
// its end position, so that it is smooth there only when velocity and acceleration of the end keys
// are 0.
class Curve1 {
 public:
    Curve1() = default;
    explicit Curve1(std::vector<Key1> keys);
    Motion1 at(double t_s) const;
    bool empty() const { return keys_.empty(); }
    const std::vector<Key1>& keys() const { return keys_; }
    double begin_s() const { return keys_.empty() ? 0 : keys_.front().t_s; }
    double end_s() const { return keys_.empty() ? 0 : keys_.back().t_s; }

 private:
    std::vector<Key1> keys_;
    std::vector<Quintic> pieces_;
};

// A curve through points, with given motion at both ends, whose squared third derivative is
// smallest (the natural "minimum jerk" interpolation; Flash and Hogan 1985): velocities and
// accelerations at the inner points are chosen.
struct Waypoint1 {
    double t_s = 0;
    double position = 0;
};
Curve1 minimum_jerk(Key1 from, const std::vector<Waypoint1>& inner, Key1 to);

// The same with the acceleration at the start left free: it starts with zero third derivative.
Curve1 minimum_jerk_free_start(Key1 from, const std::vector<Waypoint1>& inner, Key1 to);

class Curve3 {
 public:
    Curve1 x, y, z;
    Motion3 at(double t_s) const;
};

}  // namespace puppetri
