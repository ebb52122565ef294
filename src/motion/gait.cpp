// SPDX-License-Identifier: MIT
// A step as a movement: the plan of the lower body, a trunk that turns against the pelvis, a head
// that looks ahead and arms that swing against the legs.
#include "puppetri/motion/gait.h"

#include <algorithm>

#include "gait_plan.h"
#include "living.h"
#include "puppetri/base/elementary.h"
#include "puppetri/base/require.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/idle.h"
#include "puppetri/motion/inertialize.h"
#include "times.h"

namespace puppetri::motion {

double step_duration_s(const StepSpec& spec) {
    return spec.kind == StepKind::kWhole ? spec.duration_s : spec.duration_s / 2;
}
LimbSet support_limbs(Side transfer) {
    return limb_set(Limb::kPelvis).with(Limb::kBody).with(leg_of(other(transfer)));
}
LimbSet transfer_limbs(Side transfer) { return limb_set(leg_of(transfer)); }

namespace {

// After its end a step that reaches rest, or runs, slows down to a halt within this time constant,
// along its own curves; others as planned (gait_plan.h).
constexpr double kHalt_s = 0.05;

class Step final : public Movement {
 public:
    Step(const MotionContext& context, const StepSpec& spec)
        : figure_(context.figure),
          spec_(spec),
          plan_(plan_step(context, spec)),
          living_(context.figure, context.seed, 1) {
        limbs = spec.limbs;
        duration = context.duration.ticks > 0 ? context.duration
                                              : whole_milliseconds(step_duration_s(spec));
        tell_phases();
        reach_ = KeepReach(figure_, {plan_.feet[0].stands_at(0), plan_.feet[1].stands_at(0)},
                           context.now);
        join_ = InertialFigure(context, own_at(0), own_at(InertialFigure::kMoment_s),
                               std::fmax(0.8 * plan_.duration_s, 0.33));
    }

    void sample(double t_s, Controls& out) const override {
        const double T = plan_.duration_s, late = std::fmax(t_s - T, 0);
        const bool halts = plan_.halt.length_s > 0;
        const double t = t_s <= T ? t_s
                         : halts  ? T + plan_.halt.past_end_s(late)
                                  : T + kHalt_s * (1 - puppetri::exp(-late / kHalt_s));
        Controls c = own_at(t);
        if (halts && late > 0) {
            const Vec3 level = extended(t);
            c.pelvis.position_world =
                plan_.world_from_path * Vec3{level.x, plan_.halt.height.at(late).position, level.z};
            c.legs[index_of(other(spec_.transfer))] = plan_.halt.support.at(late);
        }
        join_.apply(t, c);
        if (halts && late > 0) {
            living_.add(late, smooth_rise(late, 1.5), c);
        }
        if (t_s > T && spec_.kind == StepKind::kLastHalf) {
            const double settled = smooth_rise(t_s - T, 0.8);
            c.pelvis.position_world =
                lerp(c.pelvis.position_world, plan_.world_from_path * plan_.rest_path, settled);
            living_.add(t_s - T, smooth_rise(t_s - T, 1.5), c);
        }
        reach_.apply({plan_.feet[0].stands_at(t), plan_.feet[1].stands_at(t)}, t, c);
        copy_limbs(limbs, c, out);
    }

    Stride stride_at(double t_s) const override {
        const bool first = spec_.kind == StepKind::kFirstHalf,
                   last = spec_.kind == StepKind::kLastHalf;
        const double T = plan_.duration_s;
        constexpr double kAsGoodAsOver_s = 0.002;
        if (first ? t_s < plan_.lift_s : last && t_s > T - kAsGoodAsOver_s) {
            return {};  // it stands
        }
        return {.under_way = true,
                .end_s = std::fmax(T, t_s),
                .closes = !last,
                .transfer = other(spec_.transfer),
                .stroke_m = spec_.stroke_m,
                .step_s = spec_.kind == StepKind::kWhole ? T : 2 * T,
                .duty_factor = spec_.duty_factor};
    }

 private:
    Controls own_at(double t) const {
        const Quat heading = about_y(plan_.heading_rad);
        const double yaw = plan_.pelvis_yaw.at(t).position;
        const Motion1 lists = plan_.pelvis_list.at(std::fmin(t, plan_.duration_s));
        const double list = lists.position + lists.velocity * std::fmax(t - plan_.duration_s, 0);
        Controls c;
        c.pelvis.position_world = plan_.world_from_path * extended(t);
        c.pelvis.rotation_world = heading * about_y(yaw) * about_z(list);
        const double ratio = clamp(t / plan_.duration_s, 0, 1);
        const double bump = 16 * ratio * ratio * (1 - ratio) * (1 - ratio);
        const double lean = radians(plan_.runs ? 7 : 2.5) + plan_.lean_rad * bump;
        // The chest turns against the pelvis and stays level.
        c.body.pelvis_from_chest = about_z(-1.2 * list) * about_y(-1.7 * yaw) * about_x(lean);
        const Quat path_from_chest = about_y(yaw) * about_z(list) * c.body.pelvis_from_chest;
        c.body.chest_from_head =
            slerp(Quat{}, conjugate(path_from_chest) * about_x(radians(2)), 0.9);
        for (const Side side : {Side::kLeft, Side::kRight}) {
            c.legs[index_of(side)] = plan_.feet[index_of(side)].at(t);
            const double swing = plan_.arm_swing.at(t).position;
            c.arms[index_of(side)] = swung_arm(side, side == Side::kLeft ? swing : -swing);
        }
        return c;
    }

    // Slightly more ahead than behind; the elbow bends as the arm comes forward.
    ArmControl swung_arm(Side side, double angle) const {
        ArmControl arm = hanging_arm(figure_, side);
        const figure::Arm& body = figure_.arms[index_of(side)];
        const Vec3 shoulder = body.clavicle_chest + body.shoulder_clavicle;
        const double ahead = angle + radians(1.5);
        // Runners bend their elbows by a right angle.
        const double bent =
            plan_.runs ? 0.27 : 0.12 * (angle + radians(20)) * (angle + radians(20));
        const Vec3 reach = (arm.chest_from_hand.translation - shoulder) * (1 - bent);
        arm.chest_from_hand.translation = shoulder + rotate(about_x(-ahead), reach);
        arm.chest_from_hand.rotation = about_x(-ahead - (plan_.runs ? radians(65) : 0.35 * angle)) *
                                       arm.chest_from_hand.rotation;
        return arm;
    }

    // Past the end of the plan (while the step halts) the pelvis goes on as it was.
    Vec3 extended(double t) const {
        const double T = plan_.duration_s;
        if (t <= T) {
            return plan_.pelvis_path.at(t).position;
        }
        const Motion3 end = plan_.pelvis_path.at(T);
        return end.position + end.velocity * (t - T);
    }

    void tell_phases() {
        const double T = plan_.duration_s;
        auto time = [](double s) { return to_time(std::fmax(s, 0)); };
        const bool last = spec_.kind == StepKind::kLastHalf;
        for (const Side side : {Side::kLeft, Side::kRight}) {
            const bool transfers = side == spec_.transfer;
            const double down = transfers ? plan_.strike_s : plan_.support_strike_s;
            const double up = transfers ? plan_.lift_s : plan_.support_lift_s;
            const Limb leg = leg_of(side);
            if (transfers) {
                add(leg, Phase::kSupport, {}, time(up));
                add(leg, Phase::kSwing, time(up), down <= T ? time(down) : kOpenEnd);
                if (down <= T) {
                    add(leg, Phase::kSupport, time(down), kOpenEnd);
                }
            } else {
                add(leg, Phase::kSwing, {}, time(down));
                add(leg, Phase::kSupport, time(down), up <= T ? time(up) : kOpenEnd);
                if (up <= T && !last) {
                    add(leg, Phase::kSwing, time(up), kOpenEnd);
                }
            }
            if (up >= 0 && up <= T) {
                events.push_back({time(up), "foot_off", leg});
            }
            if (down > 0 && down <= T) {
                events.push_back({time(down), "foot_strike", leg});
            }
        }
        std::stable_sort(events.begin(), events.end(),
                         [](const MovementEvent& a, const MovementEvent& b) {
                             return a.after_start < b.after_start;
                         });
    }
    void add(Limb limb, Phase phase, SimTime begin, SimTime end) {
        if (begin < end) {
            phases.push_back({limb, phase, begin, end});
        }
    }

    const figure::Figure& figure_;
    StepSpec spec_;
    StepPlan plan_;
    Living living_;
    InertialFigure join_;
    KeepReach reach_;
};

}  // namespace

MovementPtr make_step(const MotionContext& context, const StepSpec& spec) {
    PUP_REQUIRE(spec.stroke_m >= 0 && spec.duration_s > 0);
    return std::make_shared<Step>(context, spec);
}

}  // namespace puppetri::motion
