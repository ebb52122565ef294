// SPDX-License-Identifier: MIT
// Order of planning: footprints and times from the formula; the pelvis's way ahead and aside; the
// feet, which need nothing else; last the pelvis's height, which has to suit the legs that stand.
#include "gait_plan.h"

#include "living.h"
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "travel.h"

namespace puppetri::motion {
namespace {

// The shape of a walk: angles after the averages of slow adult gait in Winter (2009, chapter 3) and
// Perry (1992). What is not from there was found by measuring all heights and step counts against
// the table of good motion (tests/motion/gait_test.cpp); beside each stands what it trades.
constexpr double kSwingPitch = radians(-46);     // of the foot behind: first guess, fitted so that
constexpr double kSwingKnee = radians(60);       //   the knee of the swing bends by this,
constexpr double kHalfStepKnee = radians(51.5);  //   in half steps, which are quick, by this
constexpr double kSteepest = radians(-58);       // pitch of a foot that pushes off
constexpr double kFlatAfterStrike = 0.17;        // of n: longer drags the sole, shorter slaps it
constexpr double kHeelRise = 0.26;               // of n, heel off to border: earlier bends the knee
constexpr double kList = radians(2.5);           // of the pelvis to the free side
constexpr double kSway_m = 0.0205;               // to either side, at any height: 20 to 50 mm wide
constexpr double kBoundaryLead = 0.065;          // of the stroke, ahead of the formula at borders:
                                                 //   more eases stopping, less eases going on
constexpr double kRestLag = 0.01;                // of the stroke: what the living rest makes good
constexpr double kClearance_m = 0.022;
// Accelerations of the ankle just before touch down (back, up) and after toe off (ahead). Without
// them the foot hangs far ahead of the pelvis before it lands and trails behind after it leaves, on
// a leg that is then stretched and snaps.
constexpr double kBrake = 6.0, kLeave = 3.0;  // in units of way / time^2
constexpr double kSetDown_m = 1.6;            // in m / time^2
// Reach of a leg in parts of its length: the longest (knee 8.3 degrees; straighter, a millimetre of
// the pelvis turns it by degrees), when it lands (14), pushes off (20), and the shortest of a leg
// that stands (23.6). From kSlips on a standing foot would leave its print.
constexpr double kLongest = 0.9974, kLanding = 0.9922, kPushing = 0.985, kShortest = 0.9788;
constexpr double kSlips = 0.9981, kStanding = 0.9969;
// Starts and stops of quick walks: swings of half steps shorter than this would bend the knee too
// fast; accelerations of the pelvis above this would be too sharp, so that it may be off the
// formula by so much after the start, at the border before the stop (less where the double support
// is long), and at rest.
constexpr double kEasySwing_s = 0.32, kHurry_s = 0.035, kEasy_m_s2 = 3.2;
constexpr double kMostLag_m = 0.09, kMostSlowLead_m = 0.04, kMostRestLag_m = 0.09;
// Parts of the leg from the ankle to the ball of the foot and back to the heel, at most, for which
// the pitches of half steps are meant.
constexpr double kUsualLever = 0.152, kUsualHeel = 0.072;
constexpr double kLongestStroke = 0.87;  // of the leg; beyond it one foot cannot stay down. Less
constexpr double kLessPerDuty = 1.15;    // for each duty above 0.62: both feet are down that long
// Long feet on short legs: a foot behind is held flat, since its lever would lift the ankle too
// far, and so flat that the ankle of a longer stroke would leave its limits. In parts of the leg
// over the lever in parts of the leg, measured at a robot and at mannequins and rigs with longer
// feet.
constexpr double kLongLever = 0.35, kLessPerLever = 4.0;
constexpr double kLongerLever = 0.433, kLongerStroke = 0.58, kLessPerLongerLever = 1.43;
constexpr double kShortestMost = 0.15;
constexpr double kLongFootClearance_m = 0.013, kLongFoot = 0.54;  // reached at that lever
constexpr double kRollFlat_s = 0.2;                               // of the foot that just landed
constexpr double kHalt_m_s2 = 3.65, kShortestHalt_s = 0.15;  // of a step whose next one is late
constexpr double kCatch_s = 0.16;  // to put down a foot that should already stand

// The longer of the levers from the ankles to where the feet roll, in parts of the leg.
double lever_of(const figure::Figure& figure) {
    return std::fmax(figure.legs[0].ball_foot.z, figure.legs[1].ball_foot.z) / figure.leg_m;
}

class Planner {
 public:
    Planner(const MotionContext& context, const StepSpec& spec)
        : f_(context.figure),
          context_(context),
          spec_(spec),
          support_side_(other(spec.transfer)),
          swing_(foot_state(f_, context, spec.transfer)),
          support_(foot_state(f_, context, support_side_)) {
        plan_.duration_s = plan_duration_s(context, spec);
        whole_ = spec.kind == StepKind::kWhole;
        first_ = spec.kind == StepKind::kFirstHalf;
        last_ = spec.kind == StepKind::kLastHalf;
        n_ = whole_ ? plan_.duration_s : 2 * plan_.duration_s;
        x_ = std::fmin(spec.stroke_m, longest_stroke_m(f_, spec.duty_factor));
        clearance_m_ = lerp(kClearance_m, kLongFootClearance_m,
                            clamp((lever_of(f_) - kLongLever) / (kLongFoot - kLongLever), 0, 1));
        // Long steps for the legs turn the pelvis more.
        yaw_ = clamp(radians(10) * x_ / f_.leg_m, radians(3), radians(10));
        side_ = support_side_ == Side::kLeft ? 1 : -1;
    }

    StepPlan plan() {
        plan_times();
        plan_frame();
        plan_travel_of_pelvis();
        plan_turns();
        leave_in_time();
        plan_support_foot();
        swing_pitch_ = kSwingPitch;
        for (int round = 0; round < 4; ++round) {
            plan_swing_foot();
            plan_height_of_pelvis();
            const double wanted =
                whole_ ? lerp(radians(55), kSwingKnee, clamp((x_ / f_.leg_m - 0.35) / 0.3, 0, 1))
                       : kHalfStepKnee;
            const double missing = wanted - swing_knee();
            if (std::fabs(missing) < radians(2)) {
                break;
            }
            swing_pitch_ = clamp(swing_pitch_ - 0.8 * missing, radians(-75), radians(-10));
        }
        if (!last_) {
            plan_halt();
        }
        return std::move(plan_);
    }

 private:
    void plan_times() {
        const double T = plan_.duration_s;
        half_ = (clamp(spec_.duty_factor, 0.2, 0.9) - 0.5) *
                n_;  // half of the double support; negative: of the flight
        // Half steps leave and reach rest, where both feet stand anyway: whatever the duty factor,
        // they keep their swing from becoming a kick, and use a frame of their ends too.
        const double shift = std::fmin(0.049 * n_, std::fmax(half_, 0) * 0.5);
        const double half = std::fmin(half_, 0.14 * n_);
        const double hurry = clamp((kEasySwing_s - (T - half)) / 2, 0, kHurry_s);
        plan_.lift_s = first_ ? std::fmax(shift - hurry, 0.006) : last_ ? half - shift : half_;
        plan_.strike_s = last_    ? T - std::fmax(shift - hurry, 0.006)
                         : first_ ? T - std::fmax(half - shift - hurry, 0.01)
                                  : T - half_;
        plan_.support_strike_s = first_ ? -1 : -half_;
        plan_.support_lift_s = last_ ? T + 10 : T + half_;
        if (!support_.planted) {
            // After a step that was cut: this foot lands before the other leaves.
            plan_.support_strike_s = kCatch_s;
            plan_.lift_s = std::fmax(plan_.lift_s, kCatch_s + 0.02);
            plan_.strike_s = std::fmax(plan_.strike_s, plan_.lift_s + 0.15);
        }
        if (!swing_.planted) {
            plan_.lift_s = 0;
        }
    }

    void plan_frame() {
        plan_.heading_rad = support_.yaw.position;
        floor_y_ = floor_under(f_, context_);
        support_print_ = footprint_of(f_, support_side_, support_);
        Vec3 origin = support_print_.ankle_flat;
        if (!support_.planted) {
            // It lands half a stroke ahead of the pelvis, half a stance beside it.
            const Vec3 p = context_.now.pelvis.position_world;
            origin = p + rotate(about_y(plan_.heading_rad),
                                {side_ * f_.stance_half_width_m, 0, x_ / 2 - ahead_of_ankles()});
            origin.y = floor_y_ + f_.ankle_height_m;
            support_print_ = footprint_at(f_, support_side_, origin, plan_.heading_rad);
        }
        origin.y = floor_y_;
        plan_.world_from_path = {about_y(plan_.heading_rad), origin};
        path_from_world_ = inverse(plan_.world_from_path);
    }

    double ahead_of_ankles() const { return 0.012 * f_.height_m; }
    Motion3 to_path(Motion3 world) const {
        const Quat q = path_from_world_.rotation;
        return {path_from_world_ * world.position, rotate(q, world.velocity),
                rotate(q, world.acceleration)};
    }

    void plan_travel_of_pelvis() {
        const double T = plan_.duration_s, speed = x_ / n_;
        const Motion3 now =
            to_path({context_.now.pelvis.position_world, context_.rate.pelvis_velocity_world, {}});
        const double midline = -side_ * f_.stance_half_width_m;
        // A long double support goes slower: the feet are far apart, and legs only so long.
        const double slow = clamp((half_ / n_ - 0.12) / 0.13, 0, 1);
        // It may stop a little short of its place: the living rest goes on to it.
        Motion1 to{ahead_of_ankles() - kRestLag * x_, 0, 0};
        const double stop =
            longest_way_to_rest(now.velocity.z, lerp(1.08, 0.95, slow) * kEasy_m_s2, n_ / 2);
        to.position = clamp(now.position.z + stop, to.position - kMostRestLag_m, to.position);
        if (first_) {
            // A pelvis that lags makes the reach to the landing foot longer: legs that are short
            // for the stroke start a little sharper.
            const double sharp = lerp(0.96, 1.07, clamp((x_ / f_.leg_m - 0.62) / 0.06, 0, 1));
            // A turn may have left it a little short of its place.
            const double wanted = x_ / 2 + clamp(ahead_of_ankles() - now.position.z, 0, 0.02);
            const double lag =
                clamp(wanted - sharp * kEasy_m_s2 * T * T / 2, 0.004 * x_, kMostLag_m);
            const double way = x_ / 2 - lag;
            to = {ahead_of_ankles() + way, std::fmin(1.7 * speed, 1.72 * way / T), 0};
        } else if (whole_) {
            const double border = lerp(1.28, 0.83, slow) * speed;
            const double lead =
                std::fmax(kBoundaryLead * x_ * lerp(0.7, 1, clamp(half_ / (0.1 * n_), 0, 1)),
                          std::fmin(x_ / 2 - longest_way_to_rest(border, kEasy_m_s2, n_ / 2),
                                    lerp(kMostLag_m, kMostSlowLead_m, slow)));
            to = {ahead_of_ankles() + x_ / 2 + lead, border, 0};
        }
        plan_.pelvis_path.z = plan_travel({now.position.z, now.velocity.z, 0}, to, T);
        // Over the support foot in the middle, back over the midline at the border, on the way to
        // the other foot.
        const double sway = kSway_m;
        const double rate = sway * kPi / n_;
        Motion1 aside_now{now.position.x, now.velocity.x, 0};
        Motion1 aside_end{midline, last_ ? 0 : -side_ * rate, 0};
        const double peak = midline + side_ * sway * (whole_ ? 1 : 0.48);
        plan_.pelvis_path.x = minimum_jerk({0, aside_now}, {{T / 2, peak}}, {T, aside_end});
    }

    void plan_turns() {
        // The hip of the foot that goes ahead goes ahead; that of the free leg drops. Right
        // transfer (side_ = 1): yaw from negative to positive.
        const double T = plan_.duration_s, bend = (kPi / n_) * (kPi / n_);
        const Motion1 before{first_ ? 0 : -side_ * yaw_, 0, first_ ? 0 : side_ * yaw_ * bend};
        const Motion1 after{last_ ? 0 : side_ * yaw_, 0, last_ ? 0 : -side_ * yaw_ * bend};
        plan_.pelvis_yaw = minimum_jerk({0, before}, {}, {T, after});
        const double rate = side_ * kList * kPi / n_;
        plan_.pelvis_list = minimum_jerk({0, {0, first_ ? 0 : rate, 0}},
                                         {{(first_ ? 0.6 : 0.5) * T, side_ * kList *
                                                                         (whole_   ? 1
                                                                          : first_ ? 1.5
                                                                                   : 0.8)}},
                                         {T, {0, last_ ? 0 : -rate, 0}});
        const double swing =
            clamp(radians(36) * x_ / (0.41 * f_.height_m), radians(5), radians(30)) * 0.75;
        const Motion1 arm0{first_ ? 0 : -side_ * swing, 0, first_ ? 0 : side_ * swing * bend};
        const Motion1 arm1{last_ ? 0 : side_ * swing, 0, last_ ? 0 : -side_ * swing * bend};
        plan_.arm_swing = minimum_jerk({0, arm0}, {}, {T, arm1});
        plan_.lean_rad = first_ ? radians(4) : last_ ? radians(-3) : 0;
    }

    // The hind foot leaves before its leg is too short for the hips, whatever the duty factor:
    // after a start the pelvis is ahead of where a steady walk with a long double support has it.
    void leave_in_time() {
        if (first_ || !swing_.planted || !support_.planted) {
            return;
        }
        const Footprint print = footprint_of(f_, spec_.transfer, swing_);
        const Vec3 hind = path_from_world_ *
                          ankle_on_print(f_, spec_.transfer, print, {kSteepest, 0, 0}).position;
        const Vec3 front{0, f_.ankle_height_m, 0};
        constexpr double kStep_s = 0.005;
        for (double t = 0.02; t < plan_.lift_s; t += kStep_s) {
            const Vec3 pelvis = plan_.pelvis_path.at(t).position;
            if (hips_height(spec_.transfer, hind, pelvis, turn_at(t), kPushing) <
                hips_height(support_side_, front, pelvis, turn_at(t), kPushing)) {
                plan_.lift_s = t;
                return;
            }
        }
    }

    // Above a duty factor of 0.5 the foot rolls from heel to toe; at 0.5 it just still does.
    bool rolls() const { return half_ > -0.005 * n_; }
    // Heel off to toe off; the state at the border is where the next step takes it up.
    static Quintic heel_rise(double lift_pitch, double length_s) {
        return Quintic::between({}, {lift_pitch, 1.9 * lift_pitch / length_s, 0}, length_s);
    }

    // How high the hips are over an ankle when the leg has the given reach.
    double hips_height(Side side, Vec3 ankle_path, Vec3 pelvis_path, Quat turn,
                       double reach) const {
        const Vec3 hip = rotate(turn, f_.legs[index_of(side)].hip_pelvis);
        const double dx = pelvis_path.x + hip.x - ankle_path.x,
                     dz = pelvis_path.z + hip.z - ankle_path.z;
        const double r = reach * f_.leg_m;
        return ankle_path.y - hip.y + std::sqrt(std::fmax(r * r - dx * dx - dz * dz, 0.01));
    }
    Quat turn_at(double t) const {
        return about_y(plan_.pelvis_yaw.at(t).position) * about_z(plan_.pelvis_list.at(t).position);
    }

    // The pitch in [from, to] at which the leg on this print, with this reach, carries the hips at
    // `height`; a larger pitch either way raises the ankle. The nearer end where there is none.
    double pitch_for(Side side, const Footprint& print, Vec3 pelvis_path, Quat turn, double reach,
                     double height, double from, double to) const {
        for (int i = 0; i < 16; ++i) {
            const double middle = (from + to) / 2;
            const Vec3 ankle =
                path_from_world_ * ankle_on_print(f_, side, print, {middle, 0, 0}).position;
            (hips_height(side, ankle, pelvis_path, turn, reach) < height ? from : to) = middle;
        }
        return to;
    }

    // How far the heel of the hind foot must have risen when it leaves the floor: so that its leg
    // is as long as the height wants that the front leg, bent by some 20 degrees, has.
    double lift_pitch(Side hind, const Footprint& hind_print, Vec3 front_ankle_path,
                      Vec3 pelvis_path, Quat turn) const {
        const double height =
            hips_height(other(hind), front_ankle_path, pelvis_path, turn, kPushing);
        return pitch_for(hind, hind_print, pelvis_path, turn, kPushing, height, radians(-8),
                         kSteepest);
    }

    void plan_support_foot() {
        FootPath& foot = plan_.feet[index_of(support_side_)];
        foot.set_body(f_, support_side_);
        std::vector<Key1> keys;
        double flat_s = 0;
        if (support_.planted) {
            foot.stand(0, support_print_);
            const Curve1 rolls = roll_flat(support_.pitch, kRollFlat_s);
            keys = rolls.keys();
            flat_s = rolls.end_s();
        } else {
            flat_s =
                land(foot, support_side_, support_, support_print_, plan_.support_strike_s, keys);
        }
        if (!last_) {
            const double T = plan_.duration_s;
            const double begin = std::fmax(T - (first_ ? 0.6 : 1) * kHeelRise * n_, flat_s + 0.02);
            const double length_s = plan_.support_lift_s - begin;
            if (length_s > 0.03) {
                // The front foot may still be rolling down from its heel when this one leaves.
                const double rolled = clamp(2 * half_ / (kFlatAfterStrike * n_), 0, 1);
                const Vec3 flat{-side_ * 2 * f_.stance_half_width_m, f_.ankle_height_m, x_};
                const Footprint landing = footprint_at(
                    f_, spec_.transfer, plan_.world_from_path * flat, plan_.heading_rad);
                const Motion1 front_pitch{radians(22) * (1 - rolled) * (1 - rolled), 0, 0};
                const Vec3 front =
                    to_path(ankle_on_print(f_, spec_.transfer, landing, front_pitch)).position;
                const Motion3 end = plan_.pelvis_path.at(T);
                const Quintic rise = heel_rise(
                    lift_pitch(support_side_, support_print_, front,
                               end.position + end.velocity * std::fmax(half_, 0), turn_at(T)),
                    length_s);
                keys.push_back({begin, {}});
                keys.push_back({plan_.support_lift_s, rise.at(length_s)});
            }
        }
        foot.set_pitch(Curve1(std::move(keys)));
    }

    // A foot in the air comes down on the print at strike_s.
    double land(FootPath& foot, Side side, const FootState& now, const Footprint& print,
                double strike_s, std::vector<Key1>& keys) {
        const double t = std::fmax(strike_s, 0.05);
        keys.push_back({0, now.pitch});
        keys.push_back({t, {}});
        const Motion3 from = to_path(now.ankle), to = to_path(ankle_on_print(f_, side, print, {}));
        auto curve = [t](Motion1 a, Motion1 b) { return minimum_jerk({0, a}, {}, {t, b}); };
        const Curve1 toes = curve(now.toe_bend, {});
        const Curve3 ankle{
            curve({from.position.x, from.velocity.x, 0}, {to.position.x, 0, 0}),
            clear_of_floor(f_, side, {0, {from.position.y, from.velocity.y, 0}}, {},
                           {t, {to.position.y, 0, 0}}, curve(now.pitch, {}), toes, 0),
            curve({from.position.z, from.velocity.z, 0}, {to.position.z, 0, 0})};
        foot.swing(0, plan_.world_from_path, ankle, curve(now.yaw, {print.yaw_rad, 0, 0}), toes);
        foot.stand(t, print);
        return t;
    }

    void plan_swing_foot() {
        const Side side = spec_.transfer;
        FootPath& foot = plan_.feet[index_of(side)];
        foot = FootPath();
        foot.set_body(f_, side);
        const Vec3 landing_path{-side_ * 2 * f_.stance_half_width_m, f_.ankle_height_m,
                                last_ ? 0 : x_};
        const Footprint landing =
            footprint_at(f_, side, plan_.world_from_path * landing_path, plan_.heading_rad);
        const bool planted = swing_.planted;
        const double lift = planted ? std::fmax(plan_.lift_s, 0) : 0,
                     strike = std::fmax(plan_.strike_s, lift + 0.1);
        const double d = strike - lift;
        // Pitch: heel rise, peak after the lift, through level to toes up, roll down. One curve, so
        // that all is smooth.
        const Footprint print = footprint_of(f_, side, swing_);
        const double early = clamp(plan_.lift_s / (0.049 * n_), 0, 1);
        // A long lever from the ankle to where the foot rolls lifts the ankle farther.
        const double lever = f_.legs[index_of(side)].ball_foot.z / f_.leg_m;
        double lift_to =
            radians(-4) * early * early * std::fmin(1, kUsualLever / std::fmax(lever, 1e-3));
        if (first_ && planted) {
            // It may be found on its toes, where a step came to rest half way.
            lift_to = std::fmin(lift_to, swing_.pitch.position + lift * swing_.pitch.velocity);
        } else if (planted) {
            const Vec3 front =
                path_from_world_ * plan_.feet[index_of(support_side_)].at(lift).ankle_world;
            lift_to =
                lift_pitch(side, print, front, plan_.pelvis_path.at(lift).position, turn_at(lift));
            // What is under way cannot change at once.
            const double goes_to = swing_.pitch.position + lift * swing_.pitch.velocity;
            lift_to = lerp(goes_to, lift_to, clamp((lift - 0.015) / 0.05, 0, 1));
        }
        double strike_to = 0;
        if (rolls()) {
            const Vec3 pelvis = plan_.pelvis_path.at(strike).position;
            const Vec3 back =
                path_from_world_ * plan_.feet[index_of(support_side_)].at(strike).ankle_world;
            const double lowest =
                hips_height(support_side_, back, pelvis, turn_at(strike), kShortest) + 0.004;
            const double late = (plan_.duration_s - plan_.strike_s) / (0.049 * n_);
            const double heel = -f_.legs[index_of(side)].heel_foot.z / f_.leg_m;
            const double slow = std::fmin(1, kUsualHeel / std::fmax(heel, 1e-3));
            strike_to = last_ ? radians(5) * late * late * slow
                              : pitch_for(side, landing, pelvis, turn_at(strike), kLanding, lowest,
                                          radians(8), radians(38));
        }
        // Steps shorter than a tenth of a second land late: the net may ask for anything.
        const double flat = last_ ? std::fmax(plan_.duration_s, strike + 0.02)
                                  : strike + kFlatAfterStrike * n_ *
                                                 std::sqrt(std::fmax(strike_to, 0) / radians(22));
        Motion1 start = swing_.pitch;
        if (planted && !first_ && rolls()) {
            const double length_s = kHeelRise * n_ + half_;
            // As far as it rises as it should: after a cut it may still be flat.
            const Motion1 rises = heel_rise(lift_to, length_s).at(length_s - half_);
            start.acceleration =
                rises.acceleration * clamp(start.velocity / std::fmin(rises.velocity, -1e-3), 0, 1);
        }
        std::vector<Waypoint1> way;
        if (lift > 0.01) {
            way.push_back({lift, lift_to});
        }
        const double peak = std::fmin((first_ ? 0.72 : 1) * swing_pitch_, lift_to - radians(2));
        if (planted) {  // one that is in the air already is on its way down
            way.push_back({lift + (first_ ? 0.48 : last_ ? 0.3 : 0.24) * d, peak});
        }
        way.push_back({lift + 0.62 * d, 0.2 * peak});
        way.push_back({lift + 0.86 * d, 1.05 * strike_to});
        Key1 end{strike, {}};
        if (strike_to > 0) {
            way.push_back({strike, strike_to});
            end.t_s = flat;
        }
        const Curve1 pitch = minimum_jerk({0, start}, way, end);
        foot.set_pitch(pitch);

        Motion3 from = to_path(swing_.ankle);
        Motion1 bend = swing_.toe_bend;
        if (planted) {
            foot.stand(0, print);
            const Motion1 at_lift = pitch.at(lift);
            from = to_path(ankle_on_print(f_, side, print, at_lift));
            bend = at_lift.position < 0
                       ? Motion1{-at_lift.position, -at_lift.velocity, -at_lift.acceleration}
                       : Motion1{};
        }
        Motion3 to = to_path(ankle_on_print(f_, side, landing, pitch.at(strike)));
        // The foot comes down while it still brakes: it would otherwise hang far ahead of the
        // pelvis before it lands.
        to.acceleration.z -= kBrake * (to.position.z - from.position.z) / (d * d);
        to.acceleration.y += (first_ ? 0.8 : last_ ? 0.45 : 1) * kSetDown_m / (d * d);
        if (planted && !first_) {
            const double hurry = kLeave + 12 * std::fmax(0, x_ / f_.leg_m - 0.75);
            from.acceleration.z += hurry * (to.position.z - from.position.z) / (d * d);
        }
        const Curve1 toes =
            minimum_jerk({lift, bend}, {{lift + 0.4 * d, radians(6)}}, {strike, {}});
        auto height_at = [&](double part, double clearance) {
            const double t = lift + part * d;
            return Waypoint1{t, clearance + drop_below_ankle(f_, side, pitch.at(t).position,
                                                             toes.at(t).position)};
        };
        const Curve3 ankle{
            minimum_jerk({lift, {from.position.x, from.velocity.x, from.acceleration.x}}, {},
                         {strike, {to.position.x, to.velocity.x, to.acceleration.x}}),
            clear_of_floor(
                f_, side, {lift, {from.position.y, from.velocity.y, from.acceleration.y}},
                {height_at(whole_   ? 0.25
                           : first_ ? 0.38
                                    : 0.3,
                           clearance_m_),
                 height_at(0.5, clearance_m_), height_at(0.78, 0.8 * clearance_m_)},
                {strike, {to.position.y, to.velocity.y, to.acceleration.y}}, pitch, toes, 0),
            minimum_jerk({lift, {from.position.z, from.velocity.z, from.acceleration.z}}, {},
                         {strike, {to.position.z, to.velocity.z, to.acceleration.z}})};
        foot.swing(lift, plan_.world_from_path, ankle,
                   minimum_jerk({lift, {swing_.yaw.position, planted ? 0 : swing_.yaw.velocity, 0}},
                                {}, {strike, {landing.yaw_rad, 0, 0}}),
                   toes);
        foot.stand(strike, landing);
    }

    // Also a little past the end, where the pelvis goes on as it is.
    Vec3 pelvis_at(double t) const {
        const double T = plan_.duration_s;
        const Motion3 end = plan_.pelvis_path.at(std::fmin(t, T));
        if (t <= T) {
            return end.position;
        }
        // It slows down from its speed at the border towards the mean.
        Vec3 p = end.position + end.velocity * (t - T);
        p.z -= 0.35 * (end.velocity.z - x_ / n_) * (t - T);
        return p;
    }

    // The band at t: standing legs between their shortest and longest reach, whatever the height of
    // the pelvis.
    HeightBand band(double t) const {
        const double middle = puppetri::sin(kPi * t / plan_.duration_s);
        HeightBand b{t, -1e9, 1e9, 1e9, whole_ ? 0.2 + 0.75 * middle * middle : 0.45};
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const bool transfers = side == spec_.transfer;
            const bool stands = transfers
                                    ? t <= plan_.lift_s || t >= plan_.strike_s
                                    : t >= plan_.support_strike_s && t <= plan_.support_lift_s;
            const LegControl leg = plan_.feet[index_of(side)].at(t);
            const Vec3 ankle = path_from_world_ * leg.ankle_world;
            auto height = [&](double reach) {
                return hips_height(side, ankle, pelvis_at(t), turn_at(t), reach);
            };
            const bool lands = transfers && !last_ && t > plan_.strike_s - 0.1 * n_ &&
                               t < plan_.strike_s + 0.03 * n_;
            const bool leaves =
                transfers && !first_ && t >= plan_.lift_s && t < plan_.lift_s + 0.12 * n_;
            b.highest = std::fmin(b.highest, height(lands || leaves ? kLanding : kLongest));
            if (stands) {
                b.lowest = std::fmax(b.lowest, height(kShortest));
                b.limit = std::fmin(b.limit, height(kSlips));
            }
        }
        return b;
    }

    double swing_knee() const {
        const Side side = spec_.transfer;
        double shortest = 1e9;
        for (int i = 1; i < 12; ++i) {
            const double t = std::fmin(lerp(std::fmax(plan_.lift_s, 0), plan_.strike_s, i / 12.0),
                                       plan_.duration_s);
            const Vec3 hip = plan_.pelvis_path.at(t).position +
                             rotate(turn_at(t), f_.legs[index_of(side)].hip_pelvis);
            shortest = std::fmin(
                shortest,
                length(hip - path_from_world_ * plan_.feet[index_of(side)].at(t).ankle_world));
        }
        const figure::Leg& leg = f_.legs[index_of(side)];
        const double c =
            (leg.thigh_m * leg.thigh_m + leg.shank_m * leg.shank_m - shortest * shortest) /
            (2 * leg.thigh_m * leg.shank_m);
        return kPi - puppetri::acos(clamp(c, -1, 1));
    }

    void plan_height_of_pelvis() {
        const double T = plan_.duration_s;
        const Motion3 now =
            to_path({context_.now.pelvis.position_world, context_.rate.pelvis_velocity_world, {}});
        const double curvature = 0.010 * f_.height_m * (2 * kPi / n_) * (2 * kPi / n_) * 0.5;
        HeightPlan height;
        height.from = {now.position.y, now.velocity.y, first_ ? 0 : curvature};
        height.duration_s = T;
        height.end_is_free = !last_;
        height.to = {0, last_ ? 0 : 0.2 * x_ / n_, last_ ? 0 : curvature};
        if (last_) {
            Controls feet;
            for (const Side side : {Side::kLeft, Side::kRight}) {
                feet.legs[index_of(side)] = plan_.feet[index_of(side)].at(T);
            }
            plan_.rest_path = path_from_world_ * pelvis_over_feet(f_, feet).position_world;
            // Where it stops short of its place the legs are aslant.
            height.to.position = plan_.rest_path.y;
            for (const Side side : {Side::kLeft, Side::kRight}) {
                const Vec3 ankle = path_from_world_ * feet.legs[index_of(side)].ankle_world;
                height.to.position =
                    std::fmin(height.to.position,
                              hips_height(side, ankle, pelvis_at(T), turn_at(T), kStanding));
            }
        }
        constexpr int kBands = 20;
        for (int i = 1; i <= kBands; ++i) {
            height.bands.push_back(band(T * i / kBands));
        }
        for (const double t : {plan_.lift_s, plan_.strike_s}) {
            if (t > 0 && t < T) {
                height.bands.push_back(band(t));
            }
        }
        // Who is found low (a step that came to rest half way) comes up in its time.
        rise_slowly(height, band(0).lowest);
        // The double support goes on in the next step: what this one leaves has to suit both legs
        // until the hind foot is off.
        for (int i = 1; i <= 3 && !last_ && half_ > 0; ++i) {
            height.bands.push_back(band(T + half_ * i / 3));
            height.bands.back().lowest = -1e9;
            height.bands.back().highest = height.bands.back().limit;
        }
        plan_.pelvis_path.y = plan_height(height);
    }

    // Where it stops the legs suit each other as they do when the foot behind leaves the floor.
    void plan_halt() {
        const double T = plan_.duration_s;
        if (!plan_.feet[0].stands_at(T) || !plan_.feet[1].stands_at(T)) {
            return;
        }
        const Motion3 end = plan_.pelvis_path.at(T);
        const double left = std::fmax(x_ + ahead_of_ankles() - end.position.z, 0);
        const double speed = std::fmax(end.velocity.z, 0.1 * x_ / n_);
        plan_.halt.length_s = std::fmax(
            std::fmin(speed / ((1 - Halt::kRamp) * kHalt_m_s2), 2 * left / speed), kShortestHalt_s);
        const double H = plan_.halt.length_s;
        const Vec3 rests = end.position + end.velocity * plan_.halt.past_end_s(H);
        const LegControl front_leg =
            plan_.feet[index_of(spec_.transfer)].at(T + plan_.halt.past_end_s(H));
        const Vec3 front = path_from_world_ * front_leg.ankle_world;
        FootPath& hind = plan_.halt.support;
        hind.set_body(f_, support_side_);
        hind.stand(0, support_print_);
        const double risen =
            std::fmin(lift_pitch(support_side_, support_print_, front, rests, turn_at(T)),
                      plan_.feet[index_of(support_side_)].pitch().at(T).position);
        hind.set_pitch(
            Curve1({{0, plan_.feet[index_of(support_side_)].pitch().at(T)}, {H, {risen, 0, 0}}}));
        const Vec3 hind_ankle = path_from_world_ * hind.at(H).ankle_world;
        const double height =
            std::fmin(hips_height(spec_.transfer, front, rests, turn_at(T), kPushing),
                      hips_height(support_side_, hind_ankle, rests, turn_at(T), kPushing));
        plan_.halt.height = Curve1(
            {{0, {end.position.y, end.velocity.y, end.acceleration.y}}, {H, {height, 0, 0}}});
    }

    const figure::Figure& f_;
    const MotionContext& context_;
    const StepSpec& spec_;
    Side support_side_;
    FootState swing_, support_;
    bool whole_ = false, first_ = false, last_ = false;
    double n_ = 0, x_ = 0, half_ = 0, side_ = 1, floor_y_ = 0, swing_pitch_ = 0, yaw_ = 0,
           clearance_m_ = 0;
    Footprint support_print_;
    Transform path_from_world_;
    StepPlan plan_;
};

}  // namespace

// The pace falls by a slope that itself rises from 0 and falls back to it within kRamp of the
// whole.
double Halt::past_end_s(double late_s) const {
    constexpr double p = kRamp, slope = 1 / (1 - p);
    const double r = clamp(late_s / length_s, 0, 1), left = 1 - r;
    return length_s * (r < p        ? r - slope * r * r * r / (6 * p)
                       : r <= 1 - p ? r - slope * (r * (r - p) / 2 + p * p / 6)
                                    : 0.5 - slope * left * left * left / (6 * p));
}

double longest_stroke_m(const figure::Figure& figure, double duty_factor) {
    if (duty_factor < kRunsBelow) {
        return longest_run_stroke_m(figure, duty_factor);
    }
    const double lever = lever_of(figure);
    const double foot = std::fmax(kLongestStroke - kLessPerLever * (lever - kLongLever),
                                  kLongerStroke - kLessPerLongerLever * (lever - kLongerLever));
    const double most =
        std::fmin(kLongestStroke, foot) - kLessPerDuty * clamp(duty_factor - 0.62, 0, 0.28);
    return std::fmax(most, kShortestMost) * figure.leg_m;
}

double plan_duration_s(const MotionContext& context, const StepSpec& spec) {
    const double T =
        context.duration.ticks > 0 ? context.duration.seconds() : step_duration_s(spec);
    return std::fmax(T, spec.kind == StepKind::kWhole ? 0.15 : 0.1);
}

StepPlan plan_step(const MotionContext& context, const StepSpec& spec) {
    return spec.duty_factor < kRunsBelow ? plan_run(context, spec) : Planner(context, spec).plan();
}

}  // namespace puppetri::motion
