// SPDX-License-Identifier: MIT
#include "foot_path.h"

#include <algorithm>
#include <utility>

#include "living.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"

namespace puppetri::motion {
namespace {

constexpr double kContact_m = 0.004, kContact_m_s = 0.25, kPutDown_s = 0.32, kRollFlat_s = 0.22;

Quat foot_rotation(double yaw, double pitch) { return about_y(yaw) * about_x(-pitch); }

}  // namespace

double floor_under(const figure::Figure& figure, const MotionContext& context) {
    double lowest = 1e300, speed = 0;
    for (int side = 0; side < 2; ++side) {
        const figure::Leg& leg = figure.legs[side];
        const LegControl& c = context.now.legs[side];
        const ControlsRate::Leg& rate = context.rate.legs[side];
        const Transform foot{c.foot_rotation_world, c.ankle_world};
        const Transform toes = foot * Transform{about_x(-c.toe_bend_rad), leg.toes_foot};
        for (const auto& [point, pivot] : {std::pair{foot * leg.heel_foot, leg.heel_foot},
                                           std::pair{toes * leg.ball_toes, leg.toes_foot}}) {
            if (point.y < lowest) {
                lowest = point.y;
                speed =
                    length(rate.ankle_velocity_world +
                           cross(rate.foot_angular_world, rotate(c.foot_rotation_world, pivot)));
            }
        }
    }
    return speed < kContact_m_s ? lowest : 0;
}

FootState foot_state(const figure::Figure& figure, const MotionContext& context, Side side) {
    const figure::Leg& leg = figure.legs[index_of(side)];
    const LegControl& c = context.now.legs[index_of(side)];
    const ControlsRate::Leg& rate = context.rate.legs[index_of(side)];
    const Vec3 ahead = rotate(c.foot_rotation_world, {0, 0, 1});
    FootState s;
    s.ankle = {c.ankle_world, rate.ankle_velocity_world, {}};
    s.yaw = {heading_of(ahead), rate.foot_angular_world.y, 0};
    const Vec3 axis = rotate(about_y(s.yaw.position), {1, 0, 0});
    s.pitch = {puppetri::asin(clamp(ahead.y, -1, 1)), -dot(rate.foot_angular_world, axis), 0};
    s.toe_bend = {c.toe_bend_rad, rate.toe_bend_rad_s, 0};
    const double floor_y = floor_under(figure, context);
    const Transform foot{c.foot_rotation_world, c.ankle_world};
    const Vec3 w = rate.foot_angular_world;
    auto planted = [&](Vec3 point, double height) {
        const Vec3 velocity =
            rate.ankle_velocity_world + cross(w, rotate(c.foot_rotation_world, point));
        return std::fabs((foot * point).y - floor_y - height) < kContact_m &&
               length(velocity) < kContact_m_s;
    };
    const double joint_height = leg.toes_foot.y - leg.ball_foot.y;
    s.planted = planted(leg.heel_foot, 0) || planted(leg.toes_foot, joint_height);
    return s;
}

Footprint footprint_of(const figure::Figure& figure, Side side, const FootState& s) {
    const figure::Leg& leg = figure.legs[index_of(side)];
    const Quat q = foot_rotation(s.yaw.position, s.pitch.position), flat = about_y(s.yaw.position);
    Footprint p;
    p.yaw_rad = s.yaw.position;
    if (s.pitch.position > 0) {
        p.heel = s.ankle.position + rotate(q, leg.heel_foot);
        p.toes_joint = p.heel + rotate(flat, leg.toes_foot - leg.heel_foot);
    } else {
        p.toes_joint = s.ankle.position + rotate(q, leg.toes_foot);
        p.heel = p.toes_joint + rotate(flat, leg.heel_foot - leg.toes_foot);
    }
    p.ankle_flat = p.heel - rotate(flat, leg.heel_foot);
    return p;
}

Footprint footprint_at(const figure::Figure& figure, Side side, Vec3 ankle_flat, double yaw_rad) {
    const figure::Leg& leg = figure.legs[index_of(side)];
    const Quat flat = about_y(yaw_rad);
    return {ankle_flat + rotate(flat, leg.heel_foot), ankle_flat + rotate(flat, leg.toes_foot),
            yaw_rad, ankle_flat};
}

// With the pivot (heel or toes joint) at (y, z) in the foot's sagittal plane and pitch p, the pivot
// seen from the ankle is
//   up = y cos p + z sin p,  ahead = -y sin p + z cos p;   d up / dp = ahead,  d ahead / dp = -up,
// and the ankle is the fixed pivot minus that.
Motion3 ankle_on_print(const figure::Figure& figure, Side side, const Footprint& print,
                       Motion1 pitch) {
    const figure::Leg& leg = figure.legs[index_of(side)];
    const bool on_heel = pitch.position > 0;
    const Vec3 pivot = on_heel ? leg.heel_foot : leg.toes_foot;
    const double s = puppetri::sin(pitch.position), c = puppetri::cos(pitch.position);
    const double up = pivot.y * c + pivot.z * s, ahead = -pivot.y * s + pivot.z * c;
    const double v = pitch.velocity, a = pitch.acceleration;
    const Quat q = about_y(print.yaw_rad);
    Motion3 m;
    m.position = (on_heel ? print.heel : print.toes_joint) - rotate(q, {0, up, ahead});
    m.velocity = rotate(q, {0, -ahead * v, up * v});
    m.acceleration = rotate(q, {0, -ahead * a + up * v * v, up * a + ahead * v * v});
    return m;
}

void FootPath::set_body(const figure::Figure& figure, Side side) {
    heel_foot_ = figure.legs[index_of(side)].heel_foot;
    toes_foot_ = figure.legs[index_of(side)].toes_foot;
}
void FootPath::stand(double begin_s, const Footprint& print) {
    segments_.push_back({begin_s, true, print, {}, {}, {}, {}});
}
void FootPath::swing(double begin_s, const Transform& world_from_path, Curve3 ankle_path,
                     Curve1 yaw, Curve1 toe_bend) {
    segments_.push_back({begin_s,
                         false,
                         {},
                         world_from_path,
                         std::move(ankle_path),
                         std::move(yaw),
                         std::move(toe_bend)});
}

Curve1 roll_flat(Motion1 pitch, double at_ease_s) {
    const double p = pitch.position, v = pitch.velocity;
    if (std::fabs(p) < 1e-9 && std::fabs(v) < 1e-6) {
        return Curve1(std::vector<Key1>{{0, {}}});
    }
    const double R = v * p < 0 ? clamp(-3.2 * p / v, 0.02, 1.25 * at_ease_s) : at_ease_s;
    const double c1 = -(v * R + 3 * p) / (R * R * R * R);
    const double c0 = p / (R * R * R) - c1 * R;
    pitch.acceleration = 6 * R * c0 + 12 * R * R * c1;
    return Curve1(std::vector<Key1>{{0, pitch}, {R, {}}});
}

double drop_below_ankle(const figure::Figure& figure, Side side, double pitch_rad,
                        double toe_bend_rad) {
    const figure::Leg& leg = figure.legs[index_of(side)];
    const Quat foot = about_x(-pitch_rad), toes = about_x(-toe_bend_rad);
    const double heel = rotate(foot, leg.heel_foot).y;
    const double ball = rotate(foot, leg.toes_foot + rotate(toes, leg.ball_toes)).y;
    const double tip = rotate(foot, leg.toes_foot + rotate(toes, leg.toe_tip_toes)).y;
    return -std::fmin(heel, std::fmin(ball, tip));
}

Curve1 clear_of_floor(const figure::Figure& figure, Side side, Key1 from,
                      std::vector<Waypoint1> inner, Key1 to, const Curve1& pitch,
                      const Curve1& toe_bend, double floor_y) {
    constexpr int kSamples = 24, kRounds = 4;
    constexpr double kSunk_m = 0.0005, kLift_m = 0.006;
    const double d = to.t_s - from.t_s;
    Curve1 height = minimum_jerk(from, inner, to);
    for (int round = 0; round < kRounds; ++round) {
        double worst = -kSunk_m, at_s = 0;
        for (int i = 1; i < kSamples; ++i) {
            const double t = from.t_s + d * i / kSamples;
            const double clearance =
                height.at(t).position - floor_y -
                drop_below_ankle(figure, side, pitch.at(t).position, toe_bend.at(t).position);
            if (clearance < worst) {
                worst = clearance;
                at_s = t;
            }
        }
        if (at_s == 0) {
            break;
        }
        const double wanted = height.at(at_s).position - worst + kLift_m;
        auto near = std::find_if(inner.begin(), inner.end(), [&](const Waypoint1& w) {
            return std::fabs(w.t_s - at_s) < 0.08 * d;
        });
        if (near != inner.end()) {
            near->position += kLift_m - worst;
        } else {
            inner.insert(std::find_if(inner.begin(), inner.end(),
                                      [&](const Waypoint1& w) { return w.t_s > at_s; }),
                         {at_s, wanted});
        }
        height = minimum_jerk(from, inner, to);
    }
    return height;
}

const FootPath::Segment& FootPath::segment_at(double t_s) const {
    std::size_t i = segments_.size() - 1;
    while (i > 0 && t_s < segments_[i].begin_s) {
        --i;
    }
    return segments_[i];
}

LegControl FootPath::at(double t_s) const {
    const Segment& segment = segment_at(t_s);
    const double pitch = pitch_.at(t_s).position;
    LegControl leg;
    if (!segment.stands) {
        leg.foot_rotation_world = foot_rotation(segment.yaw.at(t_s).position, pitch);
        leg.ankle_world = segment.world_from_path * segment.ankle_path.at(t_s).position;
        leg.toe_bend_rad = segment.toe_bend.at(t_s).position;
        return leg;
    }
    leg.foot_rotation_world = foot_rotation(segment.print.yaw_rad, pitch);
    leg.ankle_world = pitch > 0
                          ? segment.print.heel - rotate(leg.foot_rotation_world, heel_foot_)
                          : segment.print.toes_joint - rotate(leg.foot_rotation_world, toes_foot_);
    leg.toe_bend_rad = pitch < 0 ? -pitch : 0;
    return leg;
}

namespace {

// Where a foot in the air should land (ankle, flat).
Vec3 landing_place(const figure::Figure& figure, const MotionContext& context, Side side,
                   const FootState& now, double floor_y) {
    const FootState beside = foot_state(figure, context, other(side));
    const double heading = beside.planted ? beside.yaw.position : now.yaw.position;
    const Quat world_from_way = about_y(heading), way_from_world = conjugate(world_from_way);
    const Vec3 stop = rotate(way_from_world, context.now.pelvis.position_world +
                                                 context.rate.pelvis_velocity_world * 0.22);
    const double s = side == Side::kLeft ? 1 : -1, ahead_of_ankles = 0.012 * figure.height_m;
    Vec3 goal{stop.x + s * figure.stance_half_width_m, 0, stop.z - ahead_of_ankles};
    if (beside.planted) {
        const Vec3 stands =
            rotate(way_from_world, footprint_of(figure, other(side), beside).ankle_flat);
        goal.x = stands.x + 2 * s * figure.stance_half_width_m;
        goal.z =
            stands.z + clamp(2 * (goal.z - stands.z), -0.35 * figure.leg_m, 0.55 * figure.leg_m);
    }
    goal = rotate(world_from_way, goal);
    goal.y = floor_y + figure.ankle_height_m;
    return goal;
}

}  // namespace

constexpr double kFromToes_s = 0.75;

Landing put_down(const figure::Figure& figure, const MotionContext& context, Side side) {
    const FootState now = foot_state(figure, context, side);
    const double floor_y = floor_under(figure, context);
    Landing landing;
    landing.path.set_body(figure, side);
    if (now.planted) {
        landing.print = footprint_of(figure, side, now);
        landing.path.stand(0, landing.print);
        if (std::fabs(now.pitch.position) > 1e-9 || std::fabs(now.pitch.velocity) > 1e-9) {
            // A heel that is up waits until the pelvis has come back over the foot: put down at
            // once under a figure that still moves ahead, the ankle would have to bend too far.
            // Such a foot, and one that is flat but for a hair, may leave at once.
            const bool heel_up = now.pitch.position < -radians(1);
            const bool rolls = now.pitch.position > radians(1) || now.pitch.velocity > 0.3;
            // One on its toes behind a step that came to rest has the whole way back to wait for.
            const double steep = clamp((-now.pitch.position - radians(25)) / radians(33), 0, 1);
            const double waits = 0.45 * std::fmin(1, length(context.rate.pelvis_velocity_world));
            const double roll_s =
                kRollFlat_s + (heel_up ? std::fmax(waits, kFromToes_s * steep) : 0);
            landing.flat_s = rolls && !heel_up ? kRollFlat_s : 0;
            landing.path.set_pitch(roll_flat(now.pitch, roll_s));
        }
        return landing;
    }
    const double t = kPutDown_s, yaw = now.yaw.position + now.yaw.velocity * (t * 0.3);
    const Vec3 goal = landing_place(figure, context, side, now, floor_y);
    landing.print = footprint_at(figure, side, goal, yaw);
    landing.down_s = landing.flat_s = t;
    const Curve1 pitch = minimum_jerk({0, now.pitch}, {}, {t, {}});
    const Vec3 p = now.ankle.position, v = now.ankle.velocity;
    const double low = goal.y - figure.ankle_height_m + 0.012 +
                       drop_below_ankle(figure, side, pitch.at(0.6 * t).position, 0);
    const Curve1 toes = minimum_jerk({0, now.toe_bend}, {}, {t, {}});
    Curve3 ankle{minimum_jerk({0, {p.x, v.x, 0}}, {}, {t, {goal.x, 0, 0}}),
                 clear_of_floor(figure, side, {0, {p.y, v.y, 0}},
                                {{0.6 * t, std::fmax(low, lerp(p.y, goal.y, 0.75))}},
                                {t, {goal.y, 0, 0}}, pitch, toes, floor_y),
                 minimum_jerk({0, {p.z, v.z, 0}}, {}, {t, {goal.z, 0, 0}})};
    landing.path.swing(0, {}, std::move(ankle), minimum_jerk({0, now.yaw}, {}, {t, {yaw, 0, 0}}),
                       toes);
    landing.path.stand(t, landing.print);
    landing.path.set_pitch(pitch);
    return landing;
}

constexpr double kFarthest = 0.85;

// With the highest reach h and a margin w the height y becomes y - d^2 / (4 w) for d = y - (h - w)
// in [0, 2 w], which joins y below and h above with a continuous slope. Across the floor, beyond a
// = 0.70 of the leg the distance d becomes a + b (1 - exp(-(d - a) / b)), never more than a + b =
// 0.85 of the leg. Who is found farther off than a has been drawn near already: its own distance is
// a then, so that it stays where it is.
double KeepReach::highest(std::size_t side, Controls& c) const {
    constexpr double kReach = 0.9990;
    const Vec3 hip = rotate(c.pelvis.rotation_world, figure_->legs[side].hip_pelvis);
    Vec3 d = c.pelvis.position_world + hip - c.legs[side].ankle_world;
    const double level = std::sqrt(d.x * d.x + d.z * d.z), a = near_[side] * figure_->leg_m,
                 b = std::fmax(kFarthest - near_[side], 0.02) * figure_->leg_m;
    if (level > a) {
        const double near = (a + b * (1 - puppetri::exp(-(level - a) / b))) / level;
        c.pelvis.position_world = c.pelvis.position_world - Vec3{d.x, 0, d.z} * (1 - near);
        d = {d.x * near, d.y, d.z * near};
    }
    const double r = kReach * figure_->leg_m;
    return c.legs[side].ankle_world.y - hip.y + std::sqrt(r * r - d.x * d.x - d.z * d.z);
}

KeepReach::KeepReach(const figure::Figure& figure, std::array<bool, 2> stands, const Controls& now)
    : figure_(&figure) {
    for (std::size_t side = 0; side < 2; ++side) {
        Controls c = now;
        if (stands[side]) {
            const Vec3 d = now.pelvis.position_world +
                           rotate(now.pelvis.rotation_world, figure.legs[side].hip_pelvis) -
                           now.legs[side].ankle_world;
            const double level = std::sqrt(d.x * d.x + d.z * d.z);
            near_[side] = clamp(level / figure.leg_m, near_[side], kFarthest - 0.01);
            missing_m_[side] = std::fmax(0, now.pelvis.position_world.y - highest(side, c));
        }
    }
}

void KeepReach::apply(std::array<bool, 2> stands, double since_start_s, Controls& c) const {
    constexpr double kLetsGo_s = 0.25;
    const double w = 1e-10 + 0.0009 * smooth_rise(since_start_s, 0.1);
    const double missing = 1 - smooth_rise(since_start_s, kLetsGo_s);
    for (std::size_t side = 0; side < 2; ++side) {
        if (!stands[side]) {
            continue;
        }
        const double most = highest(side, c) + missing_m_[side] * missing;
        const double over = c.pelvis.position_world.y - (most - w);
        if (over > 0) {
            c.pelvis.position_world.y =
                over < 2 * w ? c.pelvis.position_world.y - over * over / (4 * w) : most;
        }
    }
}

}  // namespace puppetri::motion
