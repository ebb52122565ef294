// SPDX-License-Identifier: MIT
// A movement that has been prepared: it knows how long it takes, where it begins and ends, what
// happens inside, and answers its controls at any time. Preparing is what the factories of the
// movement library do (movement_library.h); what is here is the result, immutable, asked in any
// order, from any thread.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "puppetri/base/time.h"
#include "puppetri/figure/skeleton.h"
#include "puppetri/motion/controls.h"

namespace puppetri::motion {

enum class Phase : std::uint8_t { kFree, kSupport, kSwing };

// The limb is in `phase` during [begin, end) after the movement's start. Gaps mean free.
struct PhaseSpan {
    Limb limb = Limb::kPelvis;
    Phase phase = Phase::kFree;
    SimTime begin, end;
};

// Something that happens at an instant inside a movement: "foot_strike", "foot_off", "release",
// "catch". It becomes an occurrence of the event NAME of the place that runs the movement and a
// marker in exported files.
struct MovementEvent {
    SimTime after_start;
    std::string name;
    Limb limb = Limb::kPelvis;
};

// The end of a stride: what a figure on its way still does before it can stand.
struct Stride {
    bool under_way = false;  // otherwise nothing is left to do, and nothing else here counts
    double end_s = 0;        // after the movement's start: when both feet are on the floor
    // Then they are one before the other, and a last half step brings this one beside the other.
    bool closes = false;
    Side transfer = Side::kRight;
    double stroke_m = 0, step_s = 0, duty_factor = 0;
};

class Movement {
 public:
    virtual ~Movement() = default;

    LimbSet limbs;                      // what sample writes
    SimTime duration;                   // what `takes auto` gets; a whole millisecond, rounded up
    std::vector<PhaseSpan> phases;      // ordered by limb, then begin
    std::vector<MovementEvent> events;  // ordered by time

    // The limbs whose joints `overlay` poses; a part of `limbs`. None: the controls say it all.
    LimbSet overlays;

    // Writes the controls of `limbs`, and nothing else, at t seconds after the start. Beyond the
    // duration a movement goes on as a living rest (a standing figure keeps breathing, a carrying
    // hand keeps carrying), since the next may be late. Needs t >= 0. Cost: no allocation.
    virtual void sample(double t_s, Controls& out) const = 0;

    // Changes the joints of `which`, a part of `overlays`, and no others, at t seconds after the
    // start: what controls cannot say. The pose it gets is what the sampled controls were solved
    // into (of a figure without controls: the rest pose), so that what the movement does to a joint
    // goes on top of whatever else is done to the controls. Cost: no allocation.
    virtual void overlay(double t_s, LimbSet which, figure::Pose& pose) const;

    // The stride in which a movement that is cut at t_s leaves the figure; none of movements that
    // stand.
    virtual Stride stride_at(double t_s) const;
};

// Stateful values never change after preparing, so that sharing is safe.
using MovementPtr = std::shared_ptr<const Movement>;

inline void Movement::overlay(double, LimbSet, figure::Pose&) const {}
inline Stride Movement::stride_at(double) const { return {}; }

}  // namespace puppetri::motion
