// SPDX-License-Identifier: MIT
// Looking with trunk and head.
#pragma once
#include "puppetri/motion/context.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

struct LookSpec {
    Vec3 target_world = {};
    // How much the trunk takes of what there is to turn, in [0, 1]; the neck takes half of the rest
    // and the head what remains.
    double trunk = 0.3;
    double duration_s = 0.6;
};
struct LookMovement {
    MovementPtr movement;
    double residual_rad = 0;  // by how much trunk and neck cannot turn that far
};
// Turns the body to look at a point and stays so; feet, pelvis and arms are left alone.
LookMovement make_look(const MotionContext& context, const LookSpec& spec);

}  // namespace puppetri::motion
