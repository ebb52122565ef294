// SPDX-License-Identifier: MIT
// Movements as callbacks of the program that embeds Puppetri: a name, parameters, what it drives,
// and a function of the time. Handed to scene::load, they are movements like any other: scenes call
// them by name, with checked arguments, and they join their neighbours.
//
//   auto nod = motion::make_host_movement(
//       {.signature = {.name = "nod", .parameters = {motion::angle_parameter("deep", 0.26)}},
//        .spec = {.duration_s = 1, .dofs = {"head.flex"}},
//        .pose = [](double t_s, const motion::HostArguments& with, motion::PoseFrame& frame) {
//            frame.dofs[0] = with.number("deep") * std::sin(6.283185 * t_s);
//        }});
#pragma once
#include <functional>
#include <map>
#include <string>

#include "puppetri/motion/own_movement.h"
#include "puppetri/motion/posed.h"

namespace puppetri::motion {

// The arguments of one call, by name, in metres, seconds, radians; a bool is 0 or 1, a side 0 left
// or 1 right. Places of things are those when the movement begins.
struct HostArguments {
    std::map<std::string, double, std::less<>> numbers;
    std::map<std::string, Vec3, std::less<>> places;  // points, props (centre), actors (feet)

    // 0 for a name that is none.
    double number(std::string_view name) const;
    Vec3 place(std::string_view name) const;
};

struct HostMovement {
    OwnSignature signature;  // limbs and as_argument are found from the spec
    PosedSpec spec;          // name is taken from the signature
    // Fills the frame for t_s in [0, spec.duration_s]. Called from any thread, in any order of
    // times, many times for one frame: it must depend on its arguments alone. Finite numbers; what
    // is none counts as the DOF's value at rest.
    std::function<void(double t_s, const HostArguments& arguments, PoseFrame& frame)> pose;
};

// Needs   a name, a callback, a duration between a millisecond and a day, and DOFs, joints and
//         paths of humanoids (figure/dof.h).
OwnMovementPtr make_host_movement(HostMovement movement);

// Parameters of usual types, with their defaults.
OwnParameter angle_parameter(std::string name, double default_rad);
OwnParameter length_parameter(std::string name, double default_m);
OwnParameter number_parameter(std::string name, double default_value);
OwnParameter prop_parameter(std::string name);
OwnParameter actor_parameter(std::string name);

}  // namespace puppetri::motion
