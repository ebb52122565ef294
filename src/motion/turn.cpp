// SPDX-License-Identifier: MIT
// Turning: in each pair of steps the foot on the side of the turn opens, the other follows.
//
// Feet that turned about the point between them would step on each other's heels. So the feet end
// around a point that lies aside by a few centimetres, across the heading halfway through the turn:
// a turn one way and the same turn back then cancel exactly (the way back is the mirror image at
// the same halfway heading), and nobody drifts.
#include "puppetri/motion/turn.h"

#include <algorithm>

#include "foot_path.h"
#include "living.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/inertialize.h"
#include "times.h"
#include "travel.h"

namespace puppetri::motion {
namespace {

constexpr double kNoStep = radians(3), kPairMost = radians(100), kPairAtAll = radians(125);
constexpr double kStep_s = 0.22;                            // a step at ease
constexpr double kAside = 0.040;                            // of the height, at 90 degrees
constexpr double kClearance_m = 0.028, kUsualLeg_m = 0.73;  // less of shorter legs
constexpr double kGround_s = 0.012;  // both feet stand this long between two steps
constexpr double kBrake_s = 0.18, kStride_m_s = 0.45;
constexpr double kEasy_m_s2 = 3.15, kMostShort_m = 0.014;
constexpr double kLongest = 0.9972;  // reach of the legs, as for walking

class Turn final : public Movement {
 public:
    Turn(const MotionContext& context, const TurnSpec& spec)
        : figure_(context.figure), living_(context.figure, context.seed, 1) {
        limbs = spec.limbs;
        no_step_rad_ = spec.no_step_rad;
        const PelvisControl home = pelvis_over_feet(figure_, context.now);
        from_ = heading_of(home.rotation_world);
        angle_ = turn_between(from_, spec.heading_rad);
        duration =
            context.duration.ticks > 0 ? context.duration : whole_milliseconds(spec.duration_s);
        T_ = std::fmax(duration.seconds(), 0.2);  // a net that allows less cuts the turn there
        plan_feet(context);
        plan_pelvis(context);
        reach_ = KeepReach(figure_, {feet_[0].stands_at(0), feet_[1].stands_at(0)}, context.now);
        join_ = InertialFigure(context, own_at(0), own_at(InertialFigure::kMoment_s),
                               std::fmin(0.8 * T_, 0.6));
    }

    void sample(double t_s, Controls& out) const override {
        Controls c = own_at(t_s);
        join_.apply(t_s, c);
        if (t_s > T_) {
            c.pelvis.position_world = c.pelvis.position_world + rest_ * smooth_rise(t_s - T_, 0.8);
            living_.add(t_s - T_, smooth_rise(t_s - T_, 1.5), c);
        }
        reach_.apply({feet_[0].stands_at(t_s), feet_[1].stands_at(t_s)}, t_s, c);
        copy_limbs(limbs, c, out);
    }

 private:
    struct Swing {
        Side side;
        double begin_s, end_s, yaw_from, yaw_to;
        Vec3 to;  // ankle, flat
    };

    // Where the point between the feet goes for a turn by `angle` from `heading`.
    Vec3 aside(double heading, double angle) const {
        const double way = kAside * figure_.height_m * puppetri::sin(std::fabs(angle) / 2) /
                           puppetri::sin(kPi / 4);
        const double across = heading + angle / 2 + (angle > 0 ? kPi / 2 : -kPi / 2);
        return Vec3{puppetri::sin(across), 0, puppetri::cos(across)} * (1.41421356 * way);
    }

    void plan_feet(const MotionContext& context) {
        const double floor_y = floor_under(figure_, context);
        std::array<Landing, 2> landing;
        std::array<Vec3, 2> ankle;
        std::array<double, 2> yaw{};
        double ready_s = 0;
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const int i = index_of(side);
            landing[i] = put_down(figure_, context, side);
            ankle[i] = landing[i].print.ankle_flat;
            yaw[i] = landing[i].print.yaw_rad;
            ready_s = std::fmax(ready_s, landing[i].flat_s);
        }
        centre_[0] = (ankle[0] + ankle[1]) * 0.5;
        const bool moves = std::fabs(angle_) >= no_step_rad_ && ready_s < 0.5 * T_;
        // One pair of steps is quicker than two and goes up to 125 degrees; more pairs where there
        // is time for them.
        const int wanted = 1 + static_cast<int>(std::fabs(angle_) / kPairMost);
        const int leisure = std::max(std::fabs(angle_) > kPairAtAll ? 2 : 1,
                                     static_cast<int>((T_ - ready_s) / (2 * kStep_s)));
        const int pairs = moves ? std::min(wanted, leisure) : 0;
        Vec3 centre = centre_[0];
        double heading = from_;
        std::vector<Swing> swings;
        const double window = pairs > 0 ? (T_ - ready_s) / (2 * pairs) : 0;
        for (int k = 0; k < 2 * pairs; ++k) {
            const Side opens = angle_ > 0 ? Side::kLeft : Side::kRight;
            const Side side = k % 2 == 0 ? opens : other(opens);
            if (k % 2 == 0) {
                centre = centre + aside(heading, angle_ / pairs);
                heading += angle_ / pairs;
            }
            const int i = index_of(side);
            const double s = side == Side::kLeft ? 1 : -1;
            Vec3 to = centre + rotate(about_y(heading), {s * figure_.stance_half_width_m, 0, 0});
            to.y = floor_y + figure_.ankle_height_m;
            const double begin = ready_s + k * window;
            const double to_yaw = yaw[i] + turn_between(yaw[i], heading);
            swings.push_back({side, begin + (k == 0 ? 0 : kGround_s / 2),
                              begin + window - kGround_s / 2, yaw[i], to_yaw, to});
            ankle[i] = to;
            yaw[i] = to_yaw;
        }
        centre_[1] = centre;
        to_ = heading;
        for (const Side side : {Side::kLeft, Side::kRight}) {
            feet_[index_of(side)] = std::move(landing[index_of(side)].path);
            double stands_from = landing[index_of(side)].down_s;
            if (stands_from > 0) {
                phases.push_back({leg_of(side), Phase::kSwing, {}, to_time(stands_from)});
                events.push_back({to_time(stands_from), "foot_strike", leg_of(side)});
            }
            for (const Swing& swing : swings) {
                if (swing.side == side) {
                    add_swing(swing);
                    phases.push_back({leg_of(side), Phase::kSupport, to_time(stands_from),
                                      to_time(swing.begin_s)});
                    phases.push_back({leg_of(side), Phase::kSwing, to_time(swing.begin_s),
                                      to_time(swing.end_s)});
                    events.push_back({to_time(swing.begin_s), "foot_off", leg_of(side)});
                    events.push_back({to_time(swing.end_s), "foot_strike", leg_of(side)});
                    stands_from = swing.end_s;
                }
            }
            phases.push_back({leg_of(side), Phase::kSupport, to_time(stands_from), kOpenEnd});
        }
        phases.erase(std::remove_if(phases.begin(), phases.end(),
                                    [](const PhaseSpan& p) { return !(p.begin < p.end); }),
                     phases.end());
        std::stable_sort(events.begin(), events.end(),
                         [](const MovementEvent& a, const MovementEvent& b) {
                             return a.after_start < b.after_start;
                         });
        swings_ = std::move(swings);
    }

    // From rest to rest with an acceleration at both ends: the peak velocity is 1.45 times the mean
    // (1.88 for least jerk).
    static Curve1 quick(double begin_s, double a, double rate, double end_s, double b) {
        const double d = end_s - begin_s, push = 7 * (b - a) / (d * d);
        return minimum_jerk({begin_s, {a, rate, push}}, {}, {end_s, {b, 0, -push}});
    }

    void add_swing(const Swing& s) {
        // It leaves from wherever it stands, also with its heel up, and comes down flat.
        FootPath& foot = feet_[index_of(s.side)];
        constexpr double h = 1e-4;
        const LegControl from = foot.at(s.begin_s), later = foot.at(s.begin_s + h);
        const Vec3 p = from.ankle_world, v = (later.ankle_world - p) * (1 / h);
        const double bend = from.toe_bend_rad, bend_rate = (later.toe_bend_rad - bend) / h;
        std::vector<Key1> pitch;
        for (const Key1& key : foot.pitch().keys()) {
            if (key.t_s < s.begin_s) {
                pitch.push_back(key);
            }
        }
        pitch.push_back({s.begin_s, foot.pitch().at(s.begin_s)});
        pitch.push_back({s.end_s, {}});
        foot.set_pitch(Curve1(std::move(pitch)));
        const Curve1 toes = minimum_jerk({s.begin_s, {bend, bend_rate, 0}}, {}, {s.end_s, {}});
        const double middle = (s.begin_s + s.end_s) / 2,
                     top = s.to.y + kClearance_m * std::fmin(1, figure_.leg_m / kUsualLeg_m);
        Curve3 ankle{quick(s.begin_s, p.x, v.x, s.end_s, s.to.x),
                     clear_of_floor(figure_, s.side, {s.begin_s, {p.y, v.y, 0}},
                                    {{middle, std::fmax(top, (p.y + s.to.y) / 2)}},
                                    {s.end_s, {s.to.y, 0, 0}}, foot.pitch(), toes,
                                    s.to.y - figure_.ankle_height_m),
                     quick(s.begin_s, p.z, v.z, s.end_s, s.to.z)};
        foot.swing(s.begin_s, {}, std::move(ankle),
                   quick(s.begin_s, s.yaw_from, 0, s.end_s, s.yaw_to), toes);
        foot.stand(s.end_s, footprint_at(figure_, s.side, s.to, s.yaw_to));
    }

    void plan_pelvis(const MotionContext& context) {
        const Vec3 p = context.now.pelvis.position_world, v = context.rate.pelvis_velocity_world;
        Controls end;
        for (int i = 0; i < 2; ++i) {
            end.legs[i] = feet_[i].at(T_);
        }
        const PelvisControl home = pelvis_over_feet(figure_, end);
        const Vec3 brake = v * (-1 / kBrake_s);
        if (v.x * v.x + v.z * v.z < kStride_m_s * kStride_m_s) {
            // Where that would be too sharp it comes short of its place, and goes on to it
            // afterwards.
            const Vec3 way{home.position_world.x - p.x, 0, home.position_world.z - p.z};
            const double distance = length(way);
            const Vec3 ahead = normalized(way, {0, 0, 1});
            const double easy = longest_way_to_rest(dot(v, ahead), kEasy_m_s2, T_);
            rest_ = ahead * clamp(distance - easy, 0, kMostShort_m);
            pelvis_.x = plan_travel({p.x, v.x, 0}, {home.position_world.x - rest_.x, 0, 0}, T_);
            pelvis_.z = plan_travel({p.z, v.z, 0}, {home.position_world.z - rest_.z, 0, 0}, T_);
        } else {
            // Cut in full stride: it stops at once, then goes over the foot that stands.
            std::vector<Waypoint1> x, z;
            for (const Swing& s : swings_) {
                const double t = (s.begin_s + s.end_s) / 2, part = t / T_;
                const Vec3 way = lerp(p, home.position_world, smooth_rise(part, 1));
                const Vec3 stands = feet_[1 - index_of(s.side)].at(t).ankle_world;
                const Vec3 centre = lerp(centre_[0], centre_[1], part);
                x.push_back({t, way.x + 0.08 * (stands.x - centre.x)});
                z.push_back({t, way.z + 0.08 * (stands.z - centre.z)});
            }
            pelvis_.x =
                minimum_jerk({0, {p.x, v.x, brake.x}}, x, {T_, {home.position_world.x, 0, 0}});
            pelvis_.z =
                minimum_jerk({0, {p.z, v.z, brake.z}}, z, {T_, {home.position_world.z, 0, 0}});
        }
        yaw_ = minimum_jerk({0, {from_, 0, 0}}, {}, {T_, {to_, 0, 0}});
        HeightPlan height;
        // One that rises is about to stretch its legs: it stops sooner still.
        height.from = {p.y, v.y, v.y > 0 ? 2.2 * brake.y : brake.y};
        height.duration_s = T_;
        height.to = {home.position_world.y - dot(rest_, rest_) / (2 * figure_.leg_m), 0, 0};
        constexpr int kBands = 16;
        const auto band_at = [&](double t) {
            HeightBand band{t, 0, 1e9, 1e9, 0.5};
            for (int side = 0; side < 2; ++side) {
                const LegControl leg = feet_[side].at(t);
                const Vec3 hip =
                    rotate(about_y(yaw_.at(t).position), figure_.legs[side].hip_pelvis);
                const double dx = pelvis_.x.at(t).position + hip.x - leg.ankle_world.x;
                const double dz = pelvis_.z.at(t).position + hip.z - leg.ankle_world.z;
                auto reach = [&](double part) {
                    const double r = part * figure_.leg_m;
                    return leg.ankle_world.y - hip.y +
                           std::sqrt(std::fmax(r * r - dx * dx - dz * dz, 0.01));
                };
                band.highest = std::fmin(band.highest, reach(kLongest));
            }
            band.lowest = band.highest - 0.012 * figure_.height_m;
            band.wanted = 0.4;
            return band;
        };
        for (int i = 1; i <= kBands; ++i) {
            height.bands.push_back(band_at(T_ * i / kBands));
        }
        rise_slowly(height, band_at(0).lowest);
        pelvis_.y = plan_height(height);
    }

    Controls own_at(double t) const {
        Controls c;
        const Motion1 yaw = yaw_.at(t);
        c.pelvis.position_world = pelvis_.at(t).position;
        c.pelvis.rotation_world = about_y(yaw.position);
        // The head turns first, then the chest, then the pelvis.
        const double done = clamp(t / T_, 0, 1),
                     lead = angle_ * 16 * done * done * (1 - done) * (1 - done);
        c.body.pelvis_from_chest = about_y(0.10 * lead) * about_x(radians(1.5));
        c.body.chest_from_head = about_y(0.16 * lead) * about_x(radians(-1.5));
        for (const Side side : {Side::kLeft, Side::kRight}) {
            c.legs[index_of(side)] = feet_[index_of(side)].at(t);
            c.arms[index_of(side)] = hanging_arm(figure_, side);
        }
        return c;
    }

    const figure::Figure& figure_;
    Living living_;
    double from_ = 0, to_ = 0, angle_ = 0, T_ = 0, no_step_rad_ = 0;
    Vec3 centre_[2];
    Vec3 rest_;  // what the pelvis is short of its place at the end
    std::vector<Swing> swings_;
    std::array<FootPath, 2> feet_;
    Curve3 pelvis_;
    Curve1 yaw_;
    InertialFigure join_;
    KeepReach reach_;
};

}  // namespace

MovementPtr make_turn(const MotionContext& context, const TurnSpec& spec) {
    return std::make_shared<Turn>(context, spec);
}

double turn_duration_s(double angle_rad) {
    const double angle = std::fabs(angle_rad);
    return angle < kNoStep ? 0.3 : 0.35 + 0.2 * angle;
}

double heading_to(const Controls& controls, Vec3 target_world) {
    const Vec3 way =
        target_world - (controls.legs[0].ankle_world + controls.legs[1].ankle_world) * 0.5;
    return way.x * way.x + way.z * way.z > 1e-8 ? heading_of(way)
                                                : heading_of(controls.pelvis.rotation_world);
}

}  // namespace puppetri::motion
