// SPDX-License-Identifier: MIT
// Inertialization: the new movement plays at once, and the difference to where the limb really is,
// and how fast, fades out by a polynomial. Unlike cross-fading it never asks the old movement
// again. Source  Bollo, "Inertialization: High-Performance Animation Transitions in Gears of War",
// GDC
//         2018; the quintic of that talk, with rotations as rotation vectors.
#pragma once
#include <array>

#include "puppetri/motion/context.h"

namespace puppetri::motion {

// An offset x0 with rate v0 that reaches 0 with rate 0 and acceleration 0 after blend_s. An offset
// that already shrinks so fast that it would overshoot ends earlier.
class InertialOffset {
 public:
    InertialOffset() = default;
    InertialOffset(double x0, double v0, double blend_s);
    double at(double t_s) const;

 private:
    double x0_ = 0, v0_ = 0, a0_ = 0, a_ = 0, b_ = 0, c_ = 0, end_s_ = 0;
};

// Of a vector, component by component.
class InertialOffset3 {
 public:
    InertialOffset3() = default;
    InertialOffset3(Vec3 x0, Vec3 v0, double blend_s);
    Vec3 at(double t_s) const;

 private:
    InertialOffset x_, y_, z_;
};

// Make one at a movement's start from the state of the context and the movement's own controls and
// rate at 0; apply it to what the movement samples later. With it, the controls are continuous in
// value and rate.
class InertialBody {
 public:
    InertialBody() = default;
    InertialBody(const BodyControl& now, const ControlsRate& rate, const BodyControl& own,
                 const ControlsRate& own_rate, double blend_s);
    void apply(double t_s, BodyControl& body) const;

 private:
    InertialOffset3 chest_, head_;
    InertialOffset breath_;
};

// The part in chest space, fingers and swivel. The hand swings about the shoulder from where it
// was, turned with the arm, so that the elbow does not fold and the wrist does not bend on the way.
// The weight of the world's point fades too: towards a movement that fixes the hand to the world,
// or away from one (the hand then leaves the point where it was).
class InertialArm {
 public:
    InertialArm() = default;
    InertialArm(const figure::Figure& figure, Side side, const ArmControl& now,
                const ControlsRate::Arm& rate, const ArmControl& own,
                const ControlsRate::Arm& own_rate, double blend_s);
    void apply(double t_s, ArmControl& arm) const;

 private:
    // The straight arm from the shoulder to the wrist: its turn from the T-pose, and its length.
    struct Line {
        Quat turn;
        double length_m = 0;
    };
    Line line_to(Vec3 hand_chest) const;

    Vec3 shoulder_chest_, outward_;
    bool moves_ = false;
    InertialOffset3 line_turn_, rotation_, world_position_, world_rotation_;
    InertialOffset length_, swivel_, relaxed_, spread_, grip_, world_weight_;
    Transform held_world_;
    bool holds_world_ = false;
};

// Ankle, foot, toes and knee of a leg that a movement moves without planning it against what it
// finds.
class InertialLeg {
 public:
    InertialLeg() = default;
    InertialLeg(const LegControl& now, const ControlsRate::Leg& rate, const LegControl& own,
                const ControlsRate::Leg& own_rate, double blend_s);
    void apply(double t_s, LegControl& leg) const;

 private:
    InertialOffset3 ankle_, foot_;
    InertialOffset toes_, swivel_;
};

// A joint against what it is otherwise: now = offset * own, in its parent's space. For poses beyond
// controls.
class InertialJoint {
 public:
    InertialJoint() = default;
    // Rates from the transforms a moment of dt_s > 0 earlier (now) and later (own).
    InertialJoint(const Transform& now_earlier, const Transform& now, const Transform& own,
                  const Transform& own_later, double dt_s, double blend_s);
    void apply(double t_s, Transform& parent_from_joint) const;

 private:
    InertialOffset3 turn_, shift_;
};

// Of all in a figure that a movement of the whole body does not plan against what it finds: the
// rotation of the pelvis, trunk and head, arms, the swivels of the knees. The movement itself joins
// the pelvis's place and the feet.
class InertialFigure {
 public:
    // Rates of the own controls are taken over this; sample the own ones at 0 and then.
    static constexpr double kMoment_s = 1e-4;

    InertialFigure() = default;
    InertialFigure(const MotionContext& context, const Controls& own, const Controls& own_later,
                   double blend_s);
    void apply(double t_s, Controls& controls) const;

 private:
    InertialBody body_, pelvis_turn_;  // the pelvis's rotation in the place of a chest's
    std::array<InertialArm, 2> arms_;
    std::array<InertialOffset, 2> swivel_;
};

}  // namespace puppetri::motion
