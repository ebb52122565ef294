// SPDX-License-Identifier: MIT
// From a call to a movement: `prepare` looks a call up, sees the stage as it is at this instant
// (the figure itself in the context, everybody else in the surroundings), and answers a movement
// with what the stage must know about it.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "puppetri/base/diagnostic.h"
#include "puppetri/motion/bound_call.h"
#include "puppetri/motion/context.h"
#include "puppetri/motion/grip.h"
#include "puppetri/motion/movement.h"

namespace puppetri::motion {

// How another actor stands just before this instant.
struct ActorState {
    const figure::Figure* figure = nullptr;
    Controls controls = {};
    std::optional<Vec3> catches_at_world = {};  // where it waits for a ball, if it does
};

struct PropState {
    Vec3 position_world = {};  // of the centre
    Grip grip = {};            // as the hands of the subject take it, or as hands hold it
    ActorIndex held_by = {};   // none: in the air or on the floor
    // In one hand of that actor; otherwise, where there is a holder, in both.
    std::optional<Side> in_hand = {};
    Quat rotation_world = {};
    Vec3 size_m = {};                // a sphere's diameter in x, y and z
    Transform hand_from_thing = {};  // of in_hand
};

struct SetState {
    Vec3 position_world = {};
    double direction_rad = 0;
};

struct Surroundings {
    std::span<const ActorState> actors = {};  // by ActorIndex, the subject too
    std::span<const PropState> props = {};
    std::span<const SetState> sets = {};
    ActorIndex me = {};    // whom the context describes
    PropIndex holds = {};  // what its hands hold before the movement
};

// Where the eyes go while a movement lasts. `own` leaves the head to the movement.
enum class GazeKind : std::uint8_t { kOwn, kActor, kProp, kPoint };
struct Gaze {
    GazeKind kind = GazeKind::kOwn;
    ActorIndex actor = {};
    PropIndex prop = {};
    Vec3 point_world = {};
};

struct Prepared {
    MovementPtr movement = {};
    PropIndex prop = {};      // named by the call, for the score
    bool takes_prop = false;  // from its start both hands hold `prop` (catch)
    // So long after its start both hands of `gives_to` (of itself where that is none) hold `prop`;
    // negative: never. Who is given something takes it at `meeting_world`.
    SimTime grasps_after{-1};
    ActorIndex gives_to = {};
    Vec3 meeting_world = {};
    // So long after its start this hand takes `prop`, or lays it down; negative: never.
    std::optional<Side> one_hand = {};
    SimTime takes_after{-1}, lays_after{-1};
    bool releases_prop = false;                 // at its end the hands let `prop` go (throw)
    std::optional<Vec3> catches_at_world = {};  // it waits there with open hands for `prop` (ready)
    Gaze gaze = {};
};

// Arguments as preparing takes them: 1 to 10 000 steps; 1 ms to a day of standing, in whole
// milliseconds.
std::int64_t walked_steps(double steps);
SimTime standing_time(double lasting_s);

// Prepares a movement of an actor or of one of its limbs.
// Needs   the call fits its signature (scene has checked names and types) and has no token
// attributes left. Gives   a movement that starts at context.at from the controls and rates of the
// context. With a prescribed duration
//         that is its duration, otherwise its own: a whole millisecond, rounded up, inside the
//         interval of declared_duration.h. What a figure cannot do (carry
//         what another holds, catch a ball that is elsewhere, a stroke longer than its legs) it
//         does as well as it can; a warning with the remedy comes in `notes`.
Prepared prepare(const BoundCall& call, const MotionContext& context, const Surroundings& around,
                 Diagnostics& notes);

}  // namespace puppetri::motion
