// SPDX-License-Identifier: MIT
// Joining arms: the state that a movement of the arms starts from, always in chest space, and the
// offsets that fade.
#pragma once
#include "puppetri/base/elementary.h"
#include "puppetri/math/rotation.h"
#include "puppetri/motion/context.h"
#include "puppetri/motion/gaze.h"
#include "puppetri/motion/inertialize.h"
#include "times.h"

namespace puppetri::motion {

// The context with both arms in chest space and nothing fixed to the world. The rate of a hand that
// was fixed to the world is taken as standing still before the chest.
inline MotionContext arms_in_chest_space(const MotionContext& context) {
    MotionContext c = context;
    const Transform chest_from_world = inverse(world_from_chest(context.figure, context.now));
    for (const Side side : {Side::kLeft, Side::kRight}) {
        ArmControl& arm = c.now.arms[index_of(side)];
        if (arm.world_weight > 0) {
            arm.chest_from_hand =
                chest_from_world * world_from_hand(context.figure, context.now, side);
            arm.world_weight = 0;
            auto& rate = c.rate.arms[index_of(side)];
            rate.hand_velocity_chest = rate.hand_angular_chest = {};
            rate.world_weight_per_s = 0;
        }
    }
    return c;
}

// Offsets of both arms against what `own` writes at time 0 (and, for its rate, a moment later).
struct ArmOffsets {
    std::array<InertialArm, 2> arms;

    template <class Sample>  // void(double t_s, Controls&)
    static ArmOffsets make(const MotionContext& chest_context, const Sample& own, double blend_s) {
        constexpr double kMoment_s = 1e-4;
        Controls first = chest_context.now, later = chest_context.now;
        own(0.0, first);
        own(kMoment_s, later);
        const ControlsRate rate = rate_between(first, later, kMoment_s);
        ArmOffsets offsets;
        for (int i = 0; i < 2; ++i) {
            offsets.arms[i] =
                InertialArm(chest_context.figure, static_cast<Side>(i), chest_context.now.arms[i],
                            chest_context.rate.arms[i], first.arms[i], rate.arms[i], blend_s);
        }
        return offsets;
    }
    void apply(double t_s, Controls& out) const {
        arms[0].apply(t_s, out.arms[0]);
        arms[1].apply(t_s, out.arms[1]);
    }
};

// The rate of the rotation vector r whose rotation turns with the angular velocity w: the inverse
// of the left Jacobian of the exponential map (Bullo and Murray 1995), r' = w - r x w / 2 + k r x
// (r x w).
inline Vec3 rotation_vector_rate(Vec3 r, Vec3 w) {
    const double angle = length(r), half = angle / 2;
    const double k =
        angle < 1e-4 ? 1.0 / 12 : 1 / (angle * angle) - cos(half) / (sin(half) * 2 * angle);
    return w - cross(r, w) * 0.5 + cross(r, cross(r, w)) * k;
}

// The part of the offsets that is not the hands' place (fingers, elbows), for hands whose place is
// a held ball's business. `own`: the arms as the movement has them at its start.
inline ArmOffsets fading_fingers(const MotionContext& chest_context, const Controls& own,
                                 double blend_s) {
    ArmOffsets offsets;
    for (int i = 0; i < 2; ++i) {
        ArmControl now = chest_context.now.arms[i];
        ControlsRate::Arm rate = chest_context.rate.arms[i];
        now.chest_from_hand = own.arms[i].chest_from_hand;
        rate.hand_velocity_chest = rate.hand_angular_chest = {};
        offsets.arms[i] = InertialArm(chest_context.figure, static_cast<Side>(i), now, rate,
                                      own.arms[i], {}, blend_s);
    }
    return offsets;
}

// As Movement::duration wants it: the length that the net prescribes, or the own one.
inline SimTime duration_of(const MotionContext& context, double own_s) {
    return context.duration.ticks >= 0 ? context.duration : whole_milliseconds(own_s);
}

}  // namespace puppetri::motion
