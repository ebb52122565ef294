// SPDX-License-Identifier: MIT
// Parabolas and bounces in closed form. After the first touch of the floor a ball keeps
// kRestitution of its vertical and kDrag of its horizontal speed, and lies still after kBounces
// bounces or when they become too small to see.
#include "puppetri/motion/flight.h"

#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

constexpr double kRestitution = 0.62;  // a handball on a wooden floor rebounds 1.2 m from 3 m or so
constexpr double kDrag = 0.7;
constexpr double kSmallest_m_s = 0.25;  // slower rebounds are none: 3 mm high
constexpr int kBounces = 12;

// Where a ball is on its way: on arc number n, or at rest.
struct Arc {
    double begin_s = 0;
    Vec3 start, velocity;
    bool rest = false;
};

// Seconds until a ball thrown from height y (of its lowest point) with vertical speed v touches the
// floor.
double fall_s(double y, double v) {
    const double h = y > 0 ? y : 0;
    return (v + std::sqrt(v * v + 2 * kGravity_m_s2 * h)) / kGravity_m_s2;
}

Vec3 on_arc(const Arc& arc, double t_s) {
    const double dt = t_s - arc.begin_s;
    Vec3 p = arc.start + arc.velocity * dt;
    p.y -= kGravity_m_s2 * dt * dt / 2;
    return p;
}

Arc arc_at(const Flight& flight, double t_s) {
    Arc arc{0, flight.start_world, flight.velocity_world, false};
    for (int n = 0; n <= kBounces; ++n) {
        const double end_s = arc.begin_s + fall_s(arc.start.y - flight.radius_m, arc.velocity.y);
        if (t_s < end_s) {
            return arc;
        }
        const double impact = arc.velocity.y - kGravity_m_s2 * (end_s - arc.begin_s);
        Arc next{end_s, on_arc(arc, end_s), arc.velocity * kDrag, false};
        next.start.y = flight.radius_m;
        next.velocity.y = -impact * kRestitution;
        if (next.velocity.y < kSmallest_m_s || n == kBounces) {
            next.velocity = {};
            next.rest = true;
            return next;
        }
        arc = next;
    }
    return arc;
}

double age_s(const Flight& flight, SimTime at) {
    return at > flight.start ? (at - flight.start).seconds() : 0;
}

}  // namespace

Vec3 Flight::position(SimTime at) const {
    const double t = age_s(*this, at);
    const Arc arc = arc_at(*this, t);
    return arc.rest ? arc.start : on_arc(arc, t);
}

Vec3 Flight::velocity(SimTime at) const {
    const double t = age_s(*this, at);
    const Arc arc = arc_at(*this, t);
    return arc.rest ? Vec3{} : arc.velocity - Vec3{0, kGravity_m_s2 * (t - arc.begin_s), 0};
}

Quat Flight::rotation(SimTime at) const {
    const Arc arc = arc_at(*this, age_s(*this, at));
    const double t = arc.rest ? arc.begin_s : age_s(*this, at);
    return normalized(from_rotation_vector(spin_world * t) * start_rotation_world);
}

SimTime Flight::rest() const {
    const double begin_s = arc_at(*this, 1e6).begin_s;
    return start + SimTime{static_cast<std::int64_t>(std::ceil(begin_s * kTicksPerSecond))};
}

SimTime flight_duration(Vec3 from_world, Vec3 to_world) {
    const Vec3 way{to_world.x - from_world.x, 0, to_world.z - from_world.z};
    const double ms = std::ceil(std::sqrt(2 * length(way) / kGravity_m_s2) * 1000);
    return {static_cast<std::int64_t>(ms < 1 ? 1 : ms) * kTicksPerMillisecond};
}

Vec3 launch_velocity(Vec3 from_world, Vec3 to_world, SimTime duration) {
    const double t = duration.seconds();
    Vec3 v = (to_world - from_world) * (1 / t);
    v.y += kGravity_m_s2 * t / 2;
    return v;
}

}  // namespace puppetri::motion
