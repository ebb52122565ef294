// SPDX-License-Identifier: MIT
// The hips' height is a curve of quintic pieces: crouch, push, flight, give, rise. Both ends of the
// flight have the same height, opposite velocities and the acceleration of gravity, so that the
// quintic between them is the parabola itself. Before the take-off the heels rise over the toes,
// which stand; so the ankles leave with a velocity although no foot slips.
#include "puppetri/motion/jump.h"

#include <algorithm>
#include <utility>

#include "foot_path.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/quintic.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/flight.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/idle.h"
#include "times.h"

namespace puppetri::motion {
namespace {

constexpr double kCrouch_s = 0.62, kPush_s = 0.20, kGive_s = 0.30, kRise_s = 0.62;
constexpr double kHeelUp_rad = radians(30), kToesDown_rad = radians(40);
constexpr double kLongest = 0.985;  // part of a leg's length that the hips are above the ankle

// The pitch of the feet when they leave and land; heels up.
constexpr Motion1 kOff{-kHeelUp_rad, -5, 0}, kOn{-0.8 * kHeelUp_rad, 3.6, 0};

double height_of(double height_m) { return clamp(height_m, 0.02, kHighestJump_m); }

class Jump final : public Movement {
 public:
    Jump(const MotionContext& context, const JumpSpec& spec)
        : figure_(context.figure), base_(make_idle(context, {.duration_s = 2, .gets_up = true})) {
        limbs = kAllLimbs;
        const double height = height_of(spec.height_m);
        duration = context.duration.ticks >= 0 ? context.duration
                                               : whole_milliseconds(jump_duration_s(height));
        const double flight = jump_flight_s(height);
        // What is not flight takes what there is, if that is enough to push off at all.
        const double ground = kCrouch_s + kPush_s + kGive_s + kRise_s;
        const double k = clamp((duration.seconds() - flight) / ground, 0.35, 4);
        const double crouch = k * kCrouch_s;
        leaves_s_ = crouch + kPush_s;
        lands_s_ = leaves_s_ + flight;
        // A leg leaves the floor the more bent the faster the hips are.
        for (double low = 0; low < 0.2; low += 0.02) {
            plan_hips(height, low, crouch, lands_s_ + kGive_s, lands_s_ + kGive_s + k * kRise_s);
            if (ankle_height(context, Side::kLeft).second) {
                break;
            }
        }
        for (const Side side : {Side::kLeft, Side::kRight}) {
            plan_foot(context, side);
        }
        std::stable_sort(events.begin(), events.end(),
                         [](const MovementEvent& a, const MovementEvent& b) {
                             return a.after_start < b.after_start;
                         });
    }

    void sample(double t_s, Controls& out) const override {
        Controls c = out;
        base_->sample(t_s, c);
        const Quat heading = about_y(heading_of(c.pelvis.rotation_world));
        const double lean = lean_.at(t_s).position;
        c.pelvis.position_world = c.pelvis.position_world +
                                  rotate(heading, {0, 0, back_.at(t_s).position}) +
                                  Vec3{0, lift_.at(t_s).position, 0};
        c.pelvis.rotation_world = normalized(c.pelvis.rotation_world * about_x(0.55 * lean));
        c.body.pelvis_from_chest = normalized(about_x(0.45 * lean) * c.body.pelvis_from_chest);
        c.body.chest_from_head = normalized(about_x(-0.8 * lean) * c.body.chest_from_head);
        const Quat swing = about_x(-arms_.at(t_s).position);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const int i = index_of(side);
            Transform& hand = c.arms[i].chest_from_hand;
            const Vec3 shoulder = shoulder_chest(figure_, side);
            // Bent elbows while they swing.
            const double a = arms_.at(t_s).position, shorter = 1 - 0.16 * a * a / (a * a + 0.3);
            hand.translation = shoulder + rotate(swing, hand.translation - shoulder) * shorter;
            hand.rotation = normalized(swing * hand.rotation);
            c.legs[i] = feet_[static_cast<std::size_t>(i)].at(t_s);
        }
        copy_limbs(limbs, c, out);
    }

 private:
    void plan_hips(double height, double low, double crouch_s, double given_s, double up_s) {
        const double h = figure_.height_m / 1.75;
        const double v = std::sqrt(2 * kGravity_m_s2 * height);
        const double deep = clamp(0.5 * height + 0.10 + 0.5 * low, 0.12, 0.28) * h;
        lift_ = Curve1({{0, {}},
                        {crouch_s, {-deep, 0, 4}},
                        {leaves_s_, {-low * h, v, -kGravity_m_s2}},
                        {lands_s_, {-low * h, -v, -kGravity_m_s2}},
                        {given_s, {-0.8 * deep, 0, 4}},
                        {up_s, {}}});
        back_ = Curve1({{0, {}},
                        {crouch_s, {-0.75 * deep, 0, 0}},
                        {leaves_s_, {-0.15 * deep, 1.5 * deep, 0}},
                        {lands_s_, {-0.25 * deep, -1.5 * deep, 0}},
                        {given_s, {-0.75 * deep, 0, 0}},
                        {up_s, {}}});
        const double lean = 2.6 * deep / h;
        lean_ = Curve1({{0, {}},
                        {crouch_s, {lean, 0, 0}},
                        {leaves_s_ + 0.04, {}},
                        {lands_s_ - 0.04, {}},
                        {given_s, {0.8 * lean, 0, 0}},
                        {up_s, {}}});
        arms_ = Curve1({{0, {}},
                        {0.8 * crouch_s, {-radians(34), 0, 0}},
                        {leaves_s_ + 0.14, {radians(56), 0, 0}},
                        {lands_s_ + 0.12, {radians(14), 0, 0}},
                        {up_s, {}}});
    }

    // The height of an ankle in the air, and whether the leg is never stretched: it is drawn in as
    // far as that needs.
    std::pair<Curve1, bool> ankle_height(const MotionContext& context, Side side) const {
        const auto i = static_cast<std::size_t>(index_of(side));
        const Footprint print = put_down(figure_, context, side).print;
        const Motion3 from = ankle_on_print(figure_, side, print, kOff);
        const Motion3 to = ankle_on_print(figure_, side, print, kOn);
        const double middle = (leaves_s_ + lands_s_) / 2;
        const double hip_y =
            pelvis_over_feet(figure_, context.now).position_world.y + figure_.legs[i].hip_pelvis.y;
        Curve1 curve;
        for (double drawn_in = 0.04; drawn_in < 0.3; drawn_in += 0.01) {
            const double top = hip_y + lift_.at(middle).position - (1 - drawn_in) * figure_.leg_m;
            curve = Curve1({{leaves_s_, {from.position.y, from.velocity.y, from.acceleration.y}},
                            {middle, {top, 0, -kGravity_m_s2}},
                            {lands_s_, {to.position.y, to.velocity.y, to.acceleration.y}}});
            double longest = 0;
            for (int k = 0; k <= 40; ++k) {
                const double t = leaves_s_ + (lands_s_ - leaves_s_) * k / 40;
                longest = std::fmax(longest, hip_y + lift_.at(t).position - curve.at(t).position);
            }
            if (longest < kLongest * figure_.leg_m) {
                return {std::move(curve), true};
            }
        }
        return {std::move(curve), false};
    }

    void plan_foot(const MotionContext& context, Side side) {
        Landing landing = put_down(figure_, context, side);
        FootPath& foot = feet_[static_cast<std::size_t>(index_of(side))];
        foot = std::move(landing.path);
        // Heels up before the take-off, toes down in the air, the ball of the foot lands first.
        const double up_s = 0.17, flight = lands_s_ - leaves_s_;
        std::vector<Key1> pitch;
        for (const Key1& key : foot.pitch().keys()) {
            if (key.t_s < leaves_s_ - up_s - 0.02) {
                pitch.push_back(key);
            }
        }
        pitch.push_back({leaves_s_ - up_s, {}});
        pitch.push_back({leaves_s_, kOff});
        pitch.push_back({leaves_s_ + 0.5 * flight, {-kToesDown_rad, 0, 0}});
        pitch.push_back({lands_s_, kOn});
        pitch.push_back({lands_s_ + 0.26, {}});
        foot.set_pitch(Curve1(std::move(pitch)));
        const Motion3 from = ankle_on_print(figure_, side, landing.print, kOff);
        const Motion3 to = ankle_on_print(figure_, side, landing.print, kOn);
        const double middle = (leaves_s_ + lands_s_) / 2;
        const auto straight = [&](double a, double va, double b, double vb) {
            return Curve1({{leaves_s_, {a, va, 0}}, {lands_s_, {b, vb, 0}}});
        };
        Curve3 ankle{straight(from.position.x, from.velocity.x, to.position.x, to.velocity.x),
                     ankle_height(context, side).first,
                     straight(from.position.z, from.velocity.z, to.position.z, to.velocity.z)};
        const double yaw = landing.print.yaw_rad;
        const Curve1 toes({{leaves_s_, {-kOff.position, -kOff.velocity, 0}},
                           {middle, {radians(8), 0, 0}},
                           {lands_s_, {-kOn.position, -kOn.velocity, 0}}});
        foot.swing(leaves_s_, {}, std::move(ankle),
                   Curve1({{leaves_s_, {yaw, 0, 0}}, {lands_s_, {yaw, 0, 0}}}), toes);
        foot.stand(lands_s_, landing.print);

        const Limb leg = leg_of(side);
        const SimTime down = to_time(landing.down_s), leaves = to_time(leaves_s_),
                      lands = to_time(lands_s_);
        if (landing.down_s > 0) {
            phases.push_back({leg, Phase::kSwing, {}, down});
            events.push_back({down, "foot_strike", leg});
        }
        phases.push_back({leg, Phase::kSupport, down, leaves});
        phases.push_back({leg, Phase::kSwing, leaves, lands});
        phases.push_back({leg, Phase::kSupport, lands, kOpenEnd});
        events.push_back({leaves, "foot_off", leg});
        events.push_back({lands, "foot_strike", leg});
    }

    const figure::Figure& figure_;
    MovementPtr base_;
    double leaves_s_ = 0, lands_s_ = 0;
    Curve1 lift_, back_, lean_, arms_;
    std::array<FootPath, 2> feet_;
};

}  // namespace

double jump_flight_s(double height_m) {
    return 2 * std::sqrt(2 * height_of(height_m) / kGravity_m_s2);
}
double jump_duration_s(double height_m) {
    return kCrouch_s + kPush_s + kGive_s + kRise_s + jump_flight_s(height_m);
}

MovementPtr make_jump(const MotionContext& context, const JumpSpec& spec) {
    return std::make_shared<Jump>(context, spec);
}

}  // namespace puppetri::motion
